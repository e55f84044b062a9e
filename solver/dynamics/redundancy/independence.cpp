// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/redundancy/independence.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>
#include <queue>
#include <set>

#include "base/joined.hpp"
#include "linear/sparse_qr.hpp"

namespace hilo {
namespace {

using ColumnEntry = Eigen::SparseMatrix<double>::InnerIterator;
using Column = std::vector<std::pair<int, double>>;

constexpr Eigen::Index dense_at_most = 48, dense_in_doubt = 600;  // columns
constexpr double nothing = 1e-13, little = 1e-6;                  // of a factor: round-off, and what bears a column
constexpr size_t many = 1'000'000;                                // factors, 16 MB of them

void take(Independence& out, const Column& factors) {
  for (const auto& [i, value] : factors) {
    out.largest = std::max(out.largest, std::abs(value));
    if (std::abs(value) > little) out.bears[i] = 1;
  }
}

Independence by_dense_qr(const Eigen::MatrixXd& A, double dependent) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A.rows(), A.cols());
  qr.setThreshold(dependent);
  qr.compute(A);
  const Eigen::Index rank = qr.rank();
  Independence out{qr.colsPermutation().indices(), rank, {}, std::vector<char>(rank, 0)};
  Eigen::MatrixXd factors = qr.matrixQR().topRightCorner(rank, A.cols() - rank);
  if (factors.size() > 0) qr.matrixQR().topLeftCorner(rank, rank).triangularView<Eigen::Upper>().solveInPlace(factors);
  for (Eigen::Index k = 0; k < factors.cols(); ++k) {
    out.depends.emplace_back();
    for (Eigen::Index i = 0; i < rank; ++i)
      if (std::abs(factors(i, k)) > nothing) out.depends.back().emplace_back(static_cast<int>(i), factors(i, k));
    take(out, out.depends.back());
  }
  return out;
}

/// The least entry on the diagonal of R: how far from dependent those are that count as independent.
double least_pivot(const SparseQr& qr) {
  double least = 1;
  for (Eigen::Index k = 0; k < qr.rank; ++k) least = std::min(least, std::abs(qr.R.coeff(k, k)));
  return least;
}

/// Factors by R x = b, over the entries that b reaches alone; lists of columns until there are `most` factors.
Independence from(const SparseQr& qr, size_t most) {
  Independence out{qr.order, qr.rank, {}, std::vector<char>(qr.rank, 0)};
  std::vector<double> x(static_cast<size_t>(qr.rank), 0.0);
  std::vector<char> is_met(x.size(), 0);
  std::priority_queue<int> next;
  const auto add = [&](int i, double value) {
    if (!is_met[i]) is_met[i] = 1, next.push(i);
    x[i] += value;
  };
  Column factors;
  size_t n_factors = 0;
  for (Eigen::Index k = qr.rank; k < qr.R.cols(); ++k) {
    factors.clear();
    for (ColumnEntry it(qr.R, k); it; ++it) add(static_cast<int>(it.row()), it.value());
    while (!next.empty()) {
      const int j = next.top();
      next.pop();
      double value = 0;
      for (ColumnEntry it(qr.R, j); it; ++it)
        if (it.row() == j) value = x[j] / it.value();
      if (std::abs(value) > nothing) {
        for (ColumnEntry it(qr.R, j); it && it.row() < j; ++it) add(static_cast<int>(it.row()), -value * it.value());
        factors.emplace_back(j, value);
      }
      x[j] = 0, is_met[j] = 0;
    }
    take(out, factors);
    if (n_factors += factors.size(); n_factors <= most || out.depends.empty()) out.depends.emplace_back(factors.rbegin(), factors.rend());
  }
  return out;
}

/// Nets have a factor for each joint around a mesh or within it: what a few of ten cost in digits is not worth maps of them all.
constexpr double most_in_nets = 10;

/// Exchanges of a column for one that depends on it, until no factor is far above one: what the motion leaves of the others' rows is
/// round-off times these factors.  Each enlarges the volume of those kept.
void exchange(Independence& found) {
  size_t n_factors = 0;
  for (const Column& column : found.depends) n_factors += column.size();
  const double enough = n_factors > 100000 ? most_in_nets : 1.01;
  if (found.largest < enough) return;
  std::vector<std::map<int, double>> columns;  // of factors, and which columns have one at a place
  std::vector<std::set<int>> places(static_cast<size_t>(found.rank));
  for (size_t k = 0; k < found.depends.size(); ++k) {
    columns.emplace_back(found.depends[k].begin(), found.depends[k].end());
    for (const auto& [i, value] : found.depends[k]) places[i].insert(static_cast<int>(k));
  }
  std::vector<int> waiting(columns.size());
  std::iota(waiting.begin(), waiting.end(), 0);
  bool any = false;
  for (size_t exchanges = 0; !waiting.empty() && exchanges < 100 * columns.size();) {
    const int k = waiting.back();
    const auto most = std::max_element(columns[k].begin(), columns[k].end(),
                                       [](const auto& a, const auto& b) { return std::abs(a.second) < std::abs(b.second); });
    if (most == columns[k].end() || std::abs(most->second) < enough) {
      waiting.pop_back();
      continue;
    }
    ++exchanges, any = true;
    const int i = most->first;
    const double pivot = most->second;
    std::swap(found.order[i], found.order[found.rank + k]);
    columns[k].erase(most);
    const std::set<int> others = places[i];
    for (const int l : others) {
      if (l == k) continue;
      double& own = columns[l][i];
      own /= pivot;
      for (const auto& [j, value] : columns[k]) {
        double& changed = columns[l][j];
        changed -= own * value;
        if (std::abs(changed) > nothing) {
          places[j].insert(l);
        } else {
          columns[l].erase(j), places[j].erase(l);
        }
      }
      waiting.push_back(l);
    }
    for (auto& [j, value] : columns[k]) value /= -pivot;
    columns[k][i] = 1 / pivot;
  }
  if (!any) return;
  found.largest = 0, found.bears.assign(found.bears.size(), 0);
  for (size_t k = 0; k < columns.size(); ++k) {
    found.depends[k].assign(columns[k].begin(), columns[k].end());
    take(found, found.depends[k]);
  }
}

/// By dense QR with column pivoting where there are few; by sparse QR in the order of least fill, unless its last pivots leave doubt,
/// where there are many.
Independence among(const Eigen::SparseMatrix<double>& A, double dependent) {
  Independence out;
  if (A.cols() <= dense_at_most) {
    out = by_dense_qr(Eigen::MatrixXd(A), dependent);
  } else {
    const SparseQr qr = sparse_qr(A, dependent, ColumnOrder::least_fill);
    const bool in_doubt = least_pivot(qr) < 1e3 * dependent;
    out = in_doubt && A.cols() <= dense_in_doubt ? by_dense_qr(Eigen::MatrixXd(A), dependent) : from(qr, many);
    if (out.largest >= most_in_nets && out.rank + static_cast<Eigen::Index>(out.depends.size()) < A.cols()) out = from(qr, SIZE_MAX);
  }
  exchange(out);
  return out;
}

}  // namespace

Independence independent_columns(const Eigen::SparseMatrix<double>& A, Eigen::Index n_plain, double dependent) {
  if (n_plain == 0 || n_plain == A.cols()) return among(A, dependent);
  const Independence first = among(A.leftCols(n_plain), dependent);
  // drives behind the plain columns kept, in the order found
  const Eigen::Index n_drives = A.cols() - n_plain;
  Eigen::VectorXi order(first.rank + n_drives);
  order.head(first.rank) = first.order.head(first.rank);
  std::iota(order.begin() + first.rank, order.end(), static_cast<int>(n_plain));
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index k = 0; k < order.size(); ++k)
    for (ColumnEntry it(A, order[k]); it; ++it) entries.emplace_back(it.row(), k, it.value());
  Eigen::SparseMatrix<double> sorted(A.rows(), order.size());
  sorted.setFromTriplets(entries.begin(), entries.end());
  Independence out = from(sparse_qr(sorted, dependent, ColumnOrder::given), SIZE_MAX);
  std::vector<int> place(static_cast<size_t>(order.size()));  // of each of these columns in the new order
  for (Eigen::Index k = 0; k < order.size(); ++k) place[out.order[k]] = static_cast<int>(k);
  for (int& k : out.order) k = order[k];
  // the plain ones that depend on others
  out.order.conservativeResize(A.cols());
  out.order.tail(n_plain - first.rank) = first.order.tail(n_plain - first.rank);
  for (Column factors : first.depends) {
    for (auto& [i, value] : factors) i = place[i];
    out.depends.push_back(std::move(factors));
  }
  for (Eigen::Index i = 0; i < first.rank; ++i)
    if (first.bears[i]) out.bears[place[i]] = 1;
  return out;
}

std::vector<std::vector<int>> connected_columns(const Eigen::SparseMatrix<double>& A, const std::vector<int>& columns) {
  Joined joined(columns.size());
  std::vector<int> first(A.rows(), -1);
  for (int k = 0; k < static_cast<int>(columns.size()); ++k)
    for (ColumnEntry it(A, columns[k]); it; ++it)
      if (int& other = first[it.row()]; other < 0)
        other = k;
      else
        joined.join(k, other);
  std::vector<std::vector<int>> groups(columns.size());
  for (int k = 0; k < static_cast<int>(columns.size()); ++k) groups[joined.root(k)].push_back(columns[k]);
  std::erase_if(groups, [](const auto& g) { return g.empty(); });
  return groups;
}

Eigen::SparseMatrix<double> part_of(const Eigen::SparseMatrix<double>& A, const std::vector<int>& columns, std::vector<int>& number) {
  std::vector<int> met;
  for (const int column : columns)
    for (ColumnEntry it(A, column); it; ++it) met.push_back(static_cast<int>(it.row()));
  std::sort(met.begin(), met.end());
  met.erase(std::unique(met.begin(), met.end()), met.end());
  for (size_t i = 0; i < met.size(); ++i) number[met[i]] = static_cast<int>(i);
  std::vector<Eigen::Triplet<double>> entries;
  for (size_t k = 0; k < columns.size(); ++k)
    for (ColumnEntry it(A, columns[k]); it; ++it) entries.emplace_back(number[it.row()], static_cast<int>(k), it.value());
  Eigen::SparseMatrix<double> out(static_cast<Eigen::Index>(met.size()), static_cast<Eigen::Index>(columns.size()));
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

}  // namespace hilo
