// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace hilo {
namespace {

bool is_number(const std::string& cell) {
  double x;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), x);
  return error == std::errc() && end == cell.data() + cell.size() && std::isfinite(x);
}

/// Characters of a UTF-8 text.
size_t width(const std::string& text) {
  return static_cast<size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

}  // namespace

std::string json_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += '\\', out += c;
    else if (c == '\n')
      out += "\\n";
    else if (c == '\t')
      out += "\\t";
    else if (static_cast<unsigned char>(c) < 0x20)
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      out += c;
  }
  return out + '"';
}

std::string json_number(double x) { return std::isfinite(x) ? fmt::format("{}", x) : "null"; }

std::string Table::text() const {
  if (rows.empty()) return "";
  std::vector<std::vector<std::string>> shown = rows;
  if (digits > 0)
    for (auto& row : shown)
      for (size_t j = n_text; j < row.size(); ++j)
        if (is_number(row[j])) row[j] = fmt::format("{:.{}g}", std::stod(row[j]), digits);
  std::vector<size_t> wide(header.size());
  std::vector<char> numeric(header.size(), 1);
  for (size_t j = 0; j < header.size(); ++j) {
    wide[j] = width(header[j]);
    for (const auto& row : shown) {
      wide[j] = std::max(wide[j], width(row[j]));
      numeric[j] = j >= n_text && numeric[j] && (is_number(row[j]) || row[j] == "-" || row[j].empty());
    }
  }
  std::string out;
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string text;
    for (size_t j = 0; j < cells.size(); ++j) {
      const std::string blank(wide[j] - width(cells[j]), ' ');
      text += (j ? "  " : "") + (numeric[j] ? blank + cells[j] : cells[j] + blank);
    }
    out += text.substr(0, text.find_last_not_of(' ') + 1) + '\n';
  };
  line(header);
  for (const auto& row : shown) line(row);
  return out;
}

std::string Table::json(std::string_view indent) const {
  std::string out = "[";
  for (size_t i = 0; i < rows.size(); ++i) {
    out += fmt::format("{}\n{}  {{", i ? "," : "", indent);
    for (size_t j = 0; j < header.size(); ++j) {
      const std::string& cell = rows[i][j];
      out += fmt::format("{}{}: {}", j ? ", " : "", json_text(header[j]),
                         j < n_text        ? json_text(cell)
                         : is_number(cell) ? cell
                         : cell == "-"     ? "null"
                                           : json_text(cell));
    }
    out += "}";
  }
  return out + (rows.empty() ? "]" : fmt::format("\n{}]", indent));
}

}  // namespace hilo
