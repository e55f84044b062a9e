#include "dynamics/independence.hpp"

#include <Eigen/QR>
#include <Eigen/SparseQR>
#include <algorithm>
#include <numeric>

namespace hilo {
namespace {

constexpr size_t dense_at_most = 600;  // rows

/// Independent columns, by dense QR with column pivoting; then exchanges, until no other column is more than their sum with factors of
/// about one: what the motion leaves of the others' rows is round-off times these factors.  Each exchange enlarges the volume of those
/// kept.
Independence choose_dense(const Eigen::MatrixXd& A, double dependent) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> pivoted(A.rows(), A.cols());
  pivoted.setThreshold(dependent);
  pivoted.compute(A);
  Independence out{pivoted.colsPermutation().indices(), pivoted.rank(), {}, {}};
  for (Eigen::Index exchanges = 0;; ++exchanges) {
    const Eigen::MatrixXd sorted = A * Eigen::PermutationMatrix<Eigen::Dynamic>(out.order);
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(sorted.leftCols(out.rank));
    const Eigen::MatrixXd kept = qr.matrixQR().topRows(out.rank).template triangularView<Eigen::Upper>(),
                          others = (qr.householderQ().transpose() * sorted.rightCols(A.cols() - out.rank)).topRows(out.rank);
    out.kept = kept.sparseView(), out.others = others.sparseView();
    if (others.size() == 0 || exchanges == A.cols()) return out;
    const Eigen::MatrixXd factors = kept.triangularView<Eigen::Upper>().solve(others);
    Eigen::Index i, k;
    if (factors.cwiseAbs().maxCoeff(&i, &k) < 1.01) return out;
    std::swap(out.order[i], out.order[out.rank + k]);
  }
}

/// Independent columns in the order of least fill, for what a dense matrix would take minutes.
template <class Ordering>
Independence choose_sparse(const Eigen::SparseMatrix<double>& A, double dependent) {
  Eigen::SparseQR<Eigen::SparseMatrix<double>, Ordering> qr;
  qr.setPivotThreshold(dependent);
  qr.compute(A);
  const Eigen::Index rank = qr.rank();
  const Eigen::SparseMatrix<double, Eigen::RowMajor> sorted = qr.matrixR();  // matrixR() has the entries of a column in any order, and
  const Eigen::SparseMatrix<double> R = sorted;                              // a part of it would lose some of them
  return {qr.colsPermutation().indices(), rank, R.topLeftCorner(rank, rank), R.topRightCorner(rank, A.cols() - rank)};
}

}  // namespace

Independence independent_columns(const Eigen::SparseMatrix<double>& A, Eigen::Index n_plain, double dependent) {
  const bool dense = A.cols() <= static_cast<Eigen::Index>(dense_at_most);
  const auto among = [&](const Eigen::SparseMatrix<double>& columns) {
    return dense ? choose_dense(Eigen::MatrixXd(columns), dependent) : choose_sparse<Eigen::COLAMDOrdering<int>>(columns, dependent);
  };
  if (n_plain == 0 || n_plain == A.cols()) return among(A);
  const Independence first = among(A.leftCols(n_plain));
  // in the order found, drives behind those kept: a QR without pivoting but for dependent columns, which go to the end
  Eigen::VectorXi order(A.cols());
  order.head(first.rank) = first.order.head(first.rank);
  for (Eigen::Index k = n_plain; k < A.cols(); ++k) order[first.rank + k - n_plain] = static_cast<int>(k);
  order.tail(n_plain - first.rank) = first.order.tail(n_plain - first.rank);
  Eigen::SparseMatrix<double> sorted = A * Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>(order);
  sorted.makeCompressed();
  Independence out = choose_sparse<Eigen::NaturalOrdering<int>>(sorted, dependent);
  for (int& k : out.order) k = order[k];
  return out;
}

std::vector<std::vector<int>> connected_columns(const Eigen::SparseMatrix<double>& A) {
  std::vector<int> parent(A.cols()), first(A.rows(), -1);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int k) {
    while (parent[k] != k) k = parent[k] = parent[parent[k]];
    return k;
  };
  for (int k = 0; k < A.cols(); ++k)
    for (Eigen::SparseMatrix<double>::InnerIterator it(A, k); it; ++it)
      if (int& other = first[it.row()]; other < 0)
        other = k;
      else
        parent[root(k)] = root(other);
  std::vector<std::vector<int>> groups(A.cols());
  for (int k = 0; k < A.cols(); ++k) groups[root(k)].push_back(k);
  std::erase_if(groups, [](const auto& g) { return g.empty(); });
  return groups;
}

Eigen::SparseMatrix<double> part_of(const Eigen::SparseMatrix<double>& A, const std::vector<int>& columns, std::vector<int>& number) {
  using Entry = Eigen::SparseMatrix<double>::InnerIterator;
  std::vector<int> met;
  for (const int column : columns)
    for (Entry it(A, column); it; ++it) met.push_back(static_cast<int>(it.row()));
  std::sort(met.begin(), met.end());
  met.erase(std::unique(met.begin(), met.end()), met.end());
  for (size_t i = 0; i < met.size(); ++i) number[met[i]] = static_cast<int>(i);
  std::vector<Eigen::Triplet<double>> entries;
  for (size_t k = 0; k < columns.size(); ++k)
    for (Entry it(A, columns[k]); it; ++it) entries.emplace_back(number[it.row()], static_cast<int>(k), it.value());
  Eigen::SparseMatrix<double> out(static_cast<Eigen::Index>(met.size()), static_cast<Eigen::Index>(columns.size()));
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

}  // namespace hilo
