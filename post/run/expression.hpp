// SPDX-License-Identifier: GPL-3.0-or-later
// Formulas over columns of numbers: "hypot(joint.pin.Fx, joint.pin.Fy)/1e3", "d(momentum.Lz)".  A value is a whole column, so that a
// formula can speak of its rate and of its start; the usual parsers of formulas know one row at a time, which is why this one is ours.
#pragma once
#include <functional>
#include <string>
#include <vector>

namespace hilo {

/// The column that a name stands for, as long as the times; throws Error when there is none.
using ColumnOf = std::function<std::vector<double>(const std::string& name)>;

/// Numbers, names, + - * / ^, parentheses and the functions of `expression_functions`.  A name holds letters, digits, _ and dots; one with
/// other signs stands in double quotes.  Error (exit 1) with the column where the text is no formula.
std::vector<double> evaluate(const std::string& formula, const std::vector<double>& t, const ColumnOf& column);

/// The functions there are, for --help: "abs sqrt ... d start".
std::string expression_functions();

}  // namespace hilo
