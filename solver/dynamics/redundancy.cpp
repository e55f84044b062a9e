#include "dynamics/redundancy.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <Eigen/SparseCore>
#include <set>

#include "physics/rolling.hpp"

namespace hilo {
namespace {

/// Joint rows over the unknowns of bodies and of nodes that carry ends, rotations in units of the scene's length.
struct Rows {
  Eigen::SparseMatrix<double> G;
  std::vector<std::pair<int, int>> row;  // joint, measure
};

Rows joint_rows(const System& s, const Stage& stage) {
  Rows out;
  std::vector<int> column(s.n_blocks(), -1);
  int n = 0;
  for (size_t j = 0; j < s.joints.size(); ++j) {
    const Connector& c = s.joints[j];
    for (int m = 0; m < c.n_rows(); ++m) out.row.emplace_back(static_cast<int>(j), m);
    for (const Carrier& end : c.ends()) {
      const int first = end.body >= 0 ? s.body_block[end.body] : s.node_block[end.node];
      for (int k = 0; first >= 0 && k < (end.body >= 0 ? 2 : 1); ++k)
        if (column[first + k] < 0) column[first + k] = n, n += 3;
    }
  }
  std::vector<Eigen::Triplet<double>> entries;
  ConnectorGradient g;
  RowLaw::Gradient law;
  for (size_t r = 0; r < out.row.size(); ++r) {
    const auto [joint, row] = out.row[r];
    const Connector& c = s.joints[joint];
    if (r == 0 || joint != out.row[r - 1].first) {
      gradient(c, *stage.left, g);
      if (c.rows) row_gradient(c, stage, g, law);
    }
    Eigen::Matrix<double, 1, max_directions> G = Eigen::Matrix<double, 1, max_directions>::Zero();
    if (row >= c.n_position_rows()) {
      G.head<12>() = Slip(c, *stage.left, nullptr).A.row(row - c.n_position_rows());
    } else if (!c.rows) {
      G = g.G.row(row);
    } else {
      for (size_t m = 0; m < c.measures.size(); ++m)
        if (law.d[row][m] != 0) G += law.d[row][m] * g.G.row(m);
    }
    for (int k = 0; k < c.n_ends; ++k) {
      const Carrier& end = c.end[k];
      const int first = end.body >= 0 ? s.body_block[end.body] : s.node_block[end.node];
      if (first < 0) continue;
      for (int i = 0; i < 3; ++i) {
        entries.emplace_back(static_cast<int>(r), column[first] + i, G[6 * k + i]);
        if (end.body >= 0) entries.emplace_back(static_cast<int>(r), column[first + 1] + i, G[6 * k + 3 + i] / s.length);
      }
    }
  }
  out.G.resize(static_cast<Eigen::Index>(out.row.size()), n);
  out.G.setFromTriplets(entries.begin(), entries.end());
  return out;
}

}  // namespace

Redundancy drop_redundant_rows(System& system, const Config& q) {
  Redundancy report;
  const Rows rows = joint_rows(system, stage_at(q, 0));
  report.rows = static_cast<int>(rows.row.size());
  if (report.rows == 0) return report;
  Eigen::MatrixXd A = Eigen::MatrixXd(rows.G).transpose();
  for (int r = 0; r < A.cols(); ++r) {
    const double norm = A.col(r).norm();
    if (norm > 0) A.col(r) /= norm;
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(A);
  qr.setThreshold(1e-9);
  report.rank = static_cast<int>(qr.rank());
  for (Connector& j : system.joints) j.active.fill(true);
  if (report.rank == report.rows) return report;
  const auto& order = qr.colsPermutation().indices();
  const Eigen::MatrixXd R = qr.matrixR().topRows(report.rank).template triangularView<Eigen::Upper>();
  const Eigen::MatrixXd depends =
      R.leftCols(report.rank).triangularView<Eigen::Upper>().solve(R.rightCols(report.rows - report.rank));  // dropped = kept * depends
  for (int k = report.rank; k < report.rows; ++k) {
    const auto [joint, measure] = rows.row[order[k]];
    system.joints[joint].active[measure] = false;
    std::set<std::string> others;
    for (int i = 0; i < report.rank; ++i)
      if (std::abs(depends(i, k - report.rank)) > 1e-6 && rows.row[order[i]].first != joint)
        others.insert(system.joints[rows.row[order[i]].first].name);
    report.dropped.push_back(
        fmt::format("joint \"{}\" row {}{}", system.joints[joint].name, measure + 1,
                    others.empty() ? " (depends on the joint's own rows)" : fmt::format(" (depends on {})", fmt::join(others, ", "))));
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

std::vector<double> MinimumNorm::operator()(const Stage& stage, std::span<const double> lambda) {
  const Rows rows = joint_rows(system_, stage);
  const int first = system_.first_joint_block();
  Eigen::VectorXd kept(rows.G.rows());
  for (size_t r = 0; r < rows.row.size(); ++r) {
    const auto [j, m] = rows.row[r];
    kept[r] = system_.joints[j].active[m] ? lambda[3 * (system_.joint_block[j] - first) + m] : 0;
  }
  Eigen::SparseMatrix<double> A = rows.G.transpose() * rows.G;
  const Eigen::VectorXd f = rows.G.transpose() * kept;
  const double shift = 1e-10 * A.diagonal().maxCoeff();
  Eigen::SparseMatrix<double> shifted = A;
  shifted.diagonal().array() += shift;
  if (!analyzed_) factors_.analyzePattern(shifted), analyzed_ = true;
  factors_.factorize(shifted);
  Eigen::VectorXd y = Eigen::VectorXd::Zero(f.size()), r = f;
  for (int pass = 0; pass < 8 && r.norm() > 1e-14 * f.norm(); ++pass) {
    y += factors_.solve(r);
    r = f - A * y;
  }
  const Eigen::VectorXd full = rows.G * y;
  std::vector<double> out(lambda.size(), 0.0);
  for (size_t i = 0; i < rows.row.size(); ++i) out[3 * (system_.joint_block[rows.row[i].first] - first) + rows.row[i].second] = full[i];
  return out;
}

}  // namespace hilo
