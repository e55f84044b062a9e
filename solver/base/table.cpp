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

Json Table::json() const {
  return Json::list_of(
      rows,
      [this](const std::vector<std::string>& row) {
        Json out = Json::object();
        for (size_t j = 0; j < header.size(); ++j)
          out.add(header[j], j >= n_text && is_number(row[j]) ? Json::number(row[j])
                             : j >= n_text && row[j] == "-"   ? Json(nullptr)
                                                              : Json(row[j]));
        return out;
      },
      Json::In::lines);
}

}  // namespace hilo
