// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of numbers and text with named columns: CSV in and out.
#pragma once
#include <string>
#include <vector>

namespace hilo {

/// Columns by name; cells are text, so that a column of names is kept.
struct CsvTable {
  std::vector<std::string> header;               // "t [s]", ...        (n_columns)
  std::vector<std::vector<std::string>> column;  // cells of each       (n_columns x n_rows)
  std::string path;                              // where it was read, for errors
  size_t rows() const { return column.empty() ? 0 : column.front().size(); }
  /// Column of a name, with or without its unit, or of a number from 1; Error with a suggestion.
  size_t find(const std::string& name) const;
  /// A column as numbers; an empty cell is NaN, any other text an Error with its line.
  std::vector<double> numbers(size_t column, const std::string& hint = "") const;
  /// The same in the unit `wanted`, from that of its heading, or from `fallback` where that has none; Error where it does not fit.
  std::vector<double> numbers_in(const std::string& wanted, size_t column, const std::string& fallback, const std::string& hint) const;
};

/// Read CSV with one header line; quotes as usual, lines that start with # are skipped.
CsvTable read_csv(const std::string& path);

/// A heading, and the file that has it.
struct Heading {
  std::string text, path;
};
/// What one of the unit of `from` is in that of `to`, as 0.001 for "t [ms]" and "t [s]"; 1 where either has none.  Error where they differ
/// in more than a factor.
double unit_factor(const Heading& from, const Heading& to);

/// "x_low" of "x_low [g]", "x_low[g]" and "x_low (g)".
std::string without_unit(const std::string& heading);

/// A name as a cell: in quotes where commas, quotes, a # or blanks at its ends ask for them (RFC 4180).
std::string csv_cell(const std::string& name);
/// CSV of columns of numbers, written so that they read back as the same doubles.
std::string csv_text(const std::vector<std::string>& header, const std::vector<std::vector<double>>& columns);

}  // namespace hilo
