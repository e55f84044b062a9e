// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/QR>
#include <algorithm>

#include "dynamics/redundancy/independence.hpp"

namespace hilo {
namespace {

using ColumnEntry = Eigen::SparseMatrix<double>::InnerIterator;

constexpr double plain = 1e-3;  // what is independent beyond doubt: what the others of its group leave of a unit column

/// Whether columns [first, last) are independent over some rows alone.
bool are_independent(const Eigen::SparseMatrix<double>& A, int first, int last, const std::vector<int>& rows) {
  if (rows.size() < static_cast<size_t>(last - first)) return false;
  Eigen::MatrixXd own = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows.size()), last - first);
  for (int k = first; k < last; ++k)
    for (ColumnEntry it(A, k); it; ++it)
      if (const auto at = std::lower_bound(rows.begin(), rows.end(), static_cast<int>(it.row())); at != rows.end() && *at == it.row())
        own(at - rows.begin(), k - first) = it.value();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(own);
  return std::abs(qr.matrixQR()(last - first - 1, last - first - 1)) > plain;
}

}  // namespace

std::vector<int> columns_in_loops(const Eigen::SparseMatrix<double>& A, const std::vector<int>& group) {
  std::vector<int> first;  // column of each group, and the end
  for (int k = 0; k < A.cols(); ++k)
    if (k == 0 || group[k] != group[k - 1]) first.push_back(k);
  const auto n = static_cast<int>(first.size());
  first.push_back(static_cast<int>(A.cols()));
  std::vector<std::vector<int>> rows(n), groups(A.rows());  // that a group meets, that meet a row
  for (int g = 0; g < n; ++g) {
    for (int k = first[g]; k < first[g + 1]; ++k)
      for (ColumnEntry it(A, k); it; ++it) rows[g].push_back(static_cast<int>(it.row()));
    std::sort(rows[g].begin(), rows[g].end());
    rows[g].erase(std::unique(rows[g].begin(), rows[g].end()), rows[g].end());
    for (const int row : rows[g]) groups[row].push_back(g);
  }
  std::vector<int> meeting(A.rows()), waiting;
  for (Eigen::Index row = 0; row < A.rows(); ++row) meeting[row] = static_cast<int>(groups[row].size());
  std::vector<char> is_gone(n, 0), waits(n, 1);
  for (int g = n; g-- > 0;) waiting.push_back(g);
  std::vector<int> own;
  while (!waiting.empty()) {
    const int g = waiting.back();
    waiting.pop_back(), waits[g] = 0, own.clear();
    for (const int row : rows[g])
      if (meeting[row] == 1) own.push_back(row);
    if (!are_independent(A, first[g], first[g + 1], own)) continue;
    is_gone[g] = 1;
    for (const int row : rows[g]) {
      if (--meeting[row] != 1) continue;
      const int last = *std::find_if(groups[row].begin(), groups[row].end(), [&](int other) { return !is_gone[other]; });
      if (!waits[last]) waits[last] = 1, waiting.push_back(last);
    }
  }
  std::vector<int> out;
  for (int g = 0; g < n; ++g)
    for (int k = first[g]; k < first[g + 1] && !is_gone[g]; ++k) out.push_back(k);
  return out;
}

}  // namespace hilo
