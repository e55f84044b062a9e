// SPDX-License-Identifier: GPL-3.0-or-later
// What must be true of a scene of data/, from the Python file beside it: the tables of data/ and the tests share one closed form.
#pragma once
#include <sstream>
#include <string>

#include "verify/verify.hpp"

namespace hilo::test {

/// Numbers of the CSV that a command prints, without its header  (rows x columns).
inline Eigen::MatrixXd truth_table(const Workplace& place, const std::string& command) {
  const Ran ran = place.run(command);
  if (ran.exit != 0) throw std::runtime_error(command + ": " + ran.err);
  std::vector<std::vector<double>> rows;
  std::istringstream text(ran.out);
  std::string line, cell;
  std::getline(text, line);
  while (std::getline(text, line)) {
    rows.emplace_back();
    for (std::istringstream cells(line); std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
  }
  Eigen::MatrixXd table(static_cast<Eigen::Index>(rows.size()), rows.empty() ? 0 : static_cast<Eigen::Index>(rows[0].size()));
  for (size_t i = 0; i < rows.size(); ++i)
    for (size_t j = 0; j < rows[i].size(); ++j) table(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = rows[i][j];
  return table;
}

}  // namespace hilo::test
