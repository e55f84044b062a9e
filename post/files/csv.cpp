// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/files/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iostream>
#include <iterator>
#include <limits>

#include "base/error.hpp"
#include "base/units.hpp"
#include "model/store.hpp"

namespace hilo {
namespace {

std::string trimmed(const std::string& text) {
  const auto from = text.find_first_not_of(" \t\r"), to = text.find_last_not_of(" \t\r");
  return from == std::string::npos ? "" : text.substr(from, to - from + 1);
}

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells{""};
  bool quoted = false;
  for (size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
      cells.back() += line[++i];
    else if (c == '"' && (quoted || trimmed(cells.back()).empty()))
      quoted = !quoted;
    else if (c == ',' && !quoted)
      cells.emplace_back();
    else
      cells.back() += c;
  }
  for (auto& cell : cells) cell = trimmed(cell);
  return cells;
}

}  // namespace

std::string without_unit(const std::string& heading) {
  const std::string text = trimmed(heading);
  if (text.ends_with(']')) return trimmed(text.substr(0, text.rfind('[')));
  if (text.ends_with(')') && named_unit(unit_in_heading(text))) return trimmed(text.substr(0, text.rfind('(')));
  return text;
}

std::string csv_cell(const std::string& name) {
  if (name.find_first_of(",\"\n") == name.npos && trimmed(name) == name && !name.starts_with('#')) return name;
  std::string cell = "\"";
  for (const char c : name) cell += c == '"' ? "\"\"" : std::string(1, c);
  return cell + '"';
}

CsvTable read_csv(const std::string& path) {
  CsvTable table;
  table.path = path == "-" ? "<stdin>" : path;
  const std::string text = path == "-" ? std::string(std::istreambuf_iterator<char>(std::cin), {}) : read_text_file(path);
  size_t line_number = 0;
  for (size_t at = 0; at < text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = trimmed(text.substr(at, end - at));
    at = end + 1, ++line_number;
    if (line.empty() || line.front() == '#') continue;
    const auto cells = cells_of(line);
    if (table.header.empty()) {
      table.header = cells;
      table.column.resize(cells.size());
      continue;
    }
    if (cells.size() != table.header.size())
      throw Error(fmt::format("{}:{}", table.path, line_number),
                  fmt::format("{} cells under {} column names", cells.size(), table.header.size()));
    for (size_t c = 0; c < cells.size(); ++c) table.column[c].push_back(cells[c]);
  }
  if (table.rows() == 0) throw Error(table.path, "holds no table", "a line of column names, then rows of numbers with commas");
  return table;
}

size_t CsvTable::find(const std::string& name) const {
  for (size_t c = 0; c < header.size(); ++c)
    if (header[c] == name) return c;
  for (size_t c = 0; c < header.size(); ++c)
    if (without_unit(header[c]) == name) return c;
  size_t k = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), k);
  if (error == std::errc() && end == name.data() + name.size() && k >= 1 && k <= header.size()) return k - 1;
  std::vector<std::string> names;
  for (const auto& h : header) names.push_back(without_unit(h));
  throw Error(path, fmt::format("no column \"{}\"", name), suggest(name, names));
}

std::vector<double> CsvTable::numbers(size_t c, const std::string& hint) const {
  std::vector<double> values;
  for (size_t row = 0; row < rows(); ++row) {
    const std::string& cell = column[c][row];
    double x = std::numeric_limits<double>::quiet_NaN();
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), x);
    if (!cell.empty() && (error != std::errc() || end != cell.data() + cell.size()))
      throw Error(path, fmt::format("\"{}\" in row {} of column \"{}\" is no number", cell, row + 1, header[c]), hint);
    values.push_back(x);
  }
  return values;
}

std::vector<double> CsvTable::numbers_in(const std::string& wanted, size_t c, const std::string& fallback, const std::string& hint) const {
  const std::string word = unit_in_heading(header[c]);
  const auto unit = named_unit(word.empty() ? fallback : word);
  const NamedUnit to = *named_unit(wanted);
  if (!unit || unit->unit != to.unit)
    throw Error(
        path, fmt::format("column \"{}\" has {}", header[c], word.empty() ? "no unit" : fmt::format("a unit that is none of {}", to.unit)),
        hint);
  std::vector<double> values = numbers(c);
  for (double& x : values) x *= unit->si / to.si;
  return values;
}

double unit_factor(const Heading& from, const Heading& to) {
  const auto word_of = [](const std::string& text) {  // "hypot(x, y)" has none
    return text.find('[') == text.npos && text.find(" (") == text.npos ? "" : unit_in_heading(text);
  };
  const std::string a = word_of(from.text), b = word_of(to.text);
  if (a == b || a.empty() || b.empty()) return 1;
  const auto one = named_unit(a), other = named_unit(b);
  if (!one || !other || one->unit != other->unit)
    throw Error(from.path, fmt::format("its abscissa \"{}\" does not fit \"{}\" of {}", from.text, to.text, to.path),
                "choose abscissae of one quantity by -x");
  return one->si / other->si;
}

std::string csv_text(const std::vector<std::string>& header, const std::vector<std::vector<double>>& columns) {
  std::string text;
  for (size_t c = 0; c < header.size(); ++c) text += (c ? "," : "") + csv_cell(header[c]);
  text += '\n';
  for (size_t row = 0; !columns.empty() && row < columns.front().size(); ++row) {
    for (size_t c = 0; c < columns.size(); ++c) {
      if (c) text += ',';
      if (std::isfinite(columns[c][row])) fmt::format_to(std::back_inserter(text), "{}", columns[c][row]);
    }
    text += '\n';
  }
  return text;
}

}  // namespace hilo
