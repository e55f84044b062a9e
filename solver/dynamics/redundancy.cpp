#include "dynamics/redundancy.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <Eigen/SparseCore>
#include <Eigen/SparseQR>
#include <algorithm>
#include <numeric>
#include <set>

#include "physics/rolling.hpp"

namespace hilo {
namespace {

/// The unknown blocks that a joint's rows act on: of bodies two, displacement and rotation; of nodes one.
std::vector<int> joint_blocks(const System& s, const Connector& joint) {
  std::vector<int> blocks;
  for (const Carrier& end : joint.ends()) {
    const int first = end.body >= 0 ? s.body_block[end.body] : s.node_block[end.node];
    for (int k = 0; first >= 0 && k < (end.body >= 0 ? 2 : 1); ++k) blocks.push_back(first + k);
  }
  return blocks;
}

using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, max_directions, max_directions>;
using DenseRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, 6, max_directions>;

/// A joint's rows over its blocks (n_rows x 3 n_blocks), rotations in units of the scene's length.
DenseRows joint_rows(const System& s, const Connector& c, const Stage& stage) {
  ConnectorGradient g;
  RowLaw::Gradient law;
  gradient(c, *stage.left, g);
  if (c.rows) row_gradient(c, stage, g, law);
  DenseRows out(c.n_rows(), max_directions);
  const bool slips = c.n_rows() > c.n_position_rows();
  if (slips) out.bottomRows(c.n_rows() - c.n_position_rows()).setZero();
  for (int row = 0; row < c.n_position_rows(); ++row) {
    if (!c.rows) {
      out.row(row) = g.G.row(row);
    } else {
      out.row(row).setZero();
      for (size_t m = 0; m < c.measures.size(); ++m)
        if (law.d[row][m] != 0) out.row(row) += law.d[row][m] * g.G.row(m);
    }
  }
  if (slips)
    out.bottomRows(c.n_rows() - c.n_position_rows()).leftCols<12>() =
        Slip(c, *stage.left, nullptr).A.topRows(c.n_rows() - c.n_position_rows());  // of a, then of b
  int used = 0;                                                                     // columns of what cannot move drop out
  for (int k = 0; k < c.n_ends; ++k) {
    const Carrier& end = c.end[k];
    if ((end.body >= 0 ? s.body_block[end.body] : s.node_block[end.node]) < 0) continue;
    out.middleCols<3>(used) = out.middleCols<3>(6 * k).eval(), used += 3;
    if (end.body >= 0) out.middleCols<3>(used) = (out.middleCols<3>(6 * k + 3) / s.length).eval(), used += 3;
  }
  out.conservativeResize(Eigen::NoChange, used);
  return out;
}

/// Columns of a matrix sorted: `rank` independent ones come first.  Of A P = Q R, the part of R that they and the others have.
struct Independence {
  Eigen::VectorXi order;
  Eigen::Index rank = 0;
  Eigen::SparseMatrix<double> kept, others;
  /// Column rank + k is the independent ones times these.
  Eigen::VectorXd depends(Eigen::Index k) const { return kept.triangularView<Eigen::Upper>().solve(Eigen::VectorXd(others.col(k))); }
};

constexpr size_t dense_at_most = 600;  // rows
constexpr double dependent = 1e-9;     // what others leave of a unit row

/// Independent columns, by dense QR with column pivoting; then exchanges, until no other column is more than their sum with factors of
/// about one: what the motion leaves of the others' rows is round-off times these factors.  Each exchange enlarges the volume of those
/// kept.
Independence choose_dense(const Eigen::SparseMatrix<double>& sparse) {
  const Eigen::MatrixXd A(sparse);
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
Independence choose_sparse(const Eigen::SparseMatrix<double>& A) {
  Eigen::SparseQR<Eigen::SparseMatrix<double>, Eigen::COLAMDOrdering<int>> qr;
  qr.setPivotThreshold(dependent);
  qr.compute(A);
  const Eigen::Index rank = qr.rank();
  const Eigen::SparseMatrix<double> R = qr.matrixR();
  return {qr.colsPermutation().indices(), rank, R.topLeftCorner(rank, rank), R.topRightCorner(rank, A.cols() - rank)};
}

/// Columns that share no row, directly or through others, tell nothing of each other: lists of those that do.
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

/// The columns of a list, over the rows that they meet.  `number`: of each row of A, anything.
Eigen::SparseMatrix<double> part(const Eigen::SparseMatrix<double>& A, const std::vector<int>& columns, std::vector<int>& number) {
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

}  // namespace

Redundancy drop_redundant_rows(System& system, const Config& q) {
  Redundancy report;
  std::vector<std::pair<int, int>> rows;        // joint, row
  std::vector<Eigen::Triplet<double>> entries;  // of unit rows, as columns
  for (size_t j = 0; j < system.joints.size(); ++j) {
    Connector& joint = system.joints[j];
    joint.active.fill(true);
    const DenseRows G = joint_rows(system, joint, stage_at(q, 0));
    const auto blocks = joint_blocks(system, joint);
    for (int r = 0; r < joint.n_rows(); ++r) {
      const double norm = G.row(r).norm();
      for (Eigen::Index c = 0; c < G.cols(); ++c)
        if (const double x = norm > 0 ? G(r, c) / norm : 0; std::abs(x) > 1e-14)
          entries.emplace_back(3 * blocks[c / 3] + static_cast<int>(c % 3), static_cast<int>(rows.size()), x);
      rows.emplace_back(static_cast<int>(j), r);
    }
  }
  report.rows = static_cast<int>(rows.size());
  if (report.rows == 0) return report;
  Eigen::SparseMatrix<double> A(3 * static_cast<Eigen::Index>(system.n_blocks()), report.rows);
  A.setFromTriplets(entries.begin(), entries.end());
  std::vector<int> number(A.rows());
  for (const auto& group : connected_columns(A)) {
    const Eigen::SparseMatrix<double> own = part(A, group, number);
    const Independence found = group.size() <= dense_at_most ? choose_dense(own) : choose_sparse(own);
    report.rank += static_cast<int>(found.rank);
    for (Eigen::Index k = found.rank; k < own.cols(); ++k) {
      const auto [joint, measure] = rows[group[found.order[k]]];
      system.joints[joint].active[measure] = false;
      const Eigen::VectorXd depends = found.depends(k - found.rank);
      std::set<std::string> others;
      for (Eigen::Index i = 0; i < found.rank; ++i)
        if (const int other = rows[group[found.order[i]]].first; std::abs(depends[i]) > 1e-6 && other != joint)
          others.insert(system.joints[other].name);
      report.dropped.push_back(
          fmt::format("joint \"{}\" row {}{}", system.joints[joint].name, measure + 1,
                      others.empty() ? " (depends on the joint's own rows)" : fmt::format(" (depends on {})", fmt::join(others, ", "))));
    }
  }
  return report;
}

bool recheck_redundant_rows(System& system, const Config& q, const Redundancy& before) {
  std::vector<decltype(Connector::active)> kept;
  for (const Connector& j : system.joints) kept.push_back(j.active);
  const Redundancy now = drop_redundant_rows(system, q);
  bool changed = false;
  for (size_t j = 0; j < kept.size(); ++j) changed = changed || kept[j] != system.joints[j].active;
  if (now.rank == before.rank) return changed;
  for (size_t j = 0; j < kept.size(); ++j) system.joints[j].active = kept[j];
  return false;
}

MinimumNorm::MinimumNorm(const System& system) : system_(system) {
  std::vector<int> number(system.n_blocks(), -1);
  int n = 0;
  for (const Connector& joint : system.joints) {
    auto blocks = joint_blocks(system, joint);
    for (int& block : blocks) {
      if (number[block] < 0) number[block] = n++;
      block = number[block];
    }
    cliques_.add(blocks);
  }
  A_.structure(cliques_, n);
  factors_ = make_klu();
}

std::vector<double> MinimumNorm::operator()(const Stage& stage, std::span<const double> lambda) {
  const int first = system_.first_joint_block();
  const auto n_joints = static_cast<int>(system_.joints.size());
  A_.zero();
  std::vector<DenseRows> G(n_joints);
  Eigen::VectorXd f = Eigen::VectorXd::Zero(A_.n());
  double largest = 0;
  for (int j = 0; j < n_joints; ++j) {
    const Connector& joint = system_.joints[j];
    G[j] = joint_rows(system_, joint, stage);
    Square K = Square::Zero(G[j].cols(), G[j].cols());
    for (Eigen::Index r = 0; r < G[j].rows(); ++r)
      for (Eigen::Index i = 0; i < G[j].cols(); ++i)
        if (G[j](r, i) != 0) K.row(i) += G[j](r, i) * G[j].row(r);
    largest = std::max(largest, K.diagonal().maxCoeff());
    A_.add(j, K.data());
    for (int r = 0; r < joint.n_rows(); ++r) {
      if (!joint.active[r]) continue;
      const auto blocks = cliques_[j];
      for (size_t k = 0; k < blocks.size(); ++k)
        f.segment<3>(3 * blocks[k]) +=
            lambda[3 * (system_.joint_block[j] - first) + r] * G[j].row(r).segment<3>(3 * static_cast<Eigen::Index>(k)).transpose();
    }
  }
  const double shift = 1e-10 * largest;
  const double d[3] = {shift, shift, shift};
  for (int i = 0; i < A_.n_blocks(); ++i) A_.add_diagonal(i, d);
  if (!factors_->refactor(A_)) factors_->factor(A_);
  Eigen::VectorXd y = Eigen::VectorXd::Zero(f.size()), r = f, product(f.size());
  for (int pass = 0; pass < 8 && r.norm() > 1e-14 * f.norm(); ++pass) {
    factors_->solve(r.data(), product.data());
    y += product;
    A_.multiply(y.data(), product.data());
    r = f - product + shift * y;
  }
  std::vector<double> out(lambda.size(), 0.0);
  Eigen::Matrix<double, max_directions, 1> own;
  for (int j = 0; j < n_joints; ++j) {
    const auto blocks = cliques_[j];
    for (size_t k = 0; k < blocks.size(); ++k) own.segment<3>(3 * static_cast<Eigen::Index>(k)) = y.segment<3>(3 * blocks[k]);
    Eigen::Map<Eigen::VectorXd>(&out[3 * (system_.joint_block[j] - first)], G[j].rows()) = G[j] * own.head(G[j].cols());
  }
  return out;
}

}  // namespace hilo
