#include "system/flexibility.hpp"

#include <Eigen/QR>
#include <algorithm>

namespace hilo {
namespace {

using Eigen::Index;

/// Three nodes far from one line.
std::array<int, 3> spread_nodes(const std::vector<Vec3>& X) {
  std::array<int, 3> out{};
  const auto far = [&](auto&& distance) {
    int best = 0;
    for (size_t i = 0; i < X.size(); ++i)
      if (distance(X[i]) > distance(X[best])) best = static_cast<int>(i);
    return best;
  };
  out[1] = far([&](const Vec3& x) { return (x - X[0]).norm(); });
  out[0] = far([&](const Vec3& x) { return (x - X[out[1]]).norm(); });
  const Vec3 along = (X[out[1]] - X[out[0]]).normalized();
  out[2] = far([&](const Vec3& x) { return (x - X[out[0]]).cross(along).norm(); });
  return out;
}

}  // namespace

Flexibility::Flexibility(const ReductionInput& in, const RegionCells& cells, const Matrix& rigid, const Matrix& M_rigid)
    : solver_(make_light_solver()), rigid_(rigid), M_rigid_(M_rigid), free_(in.rigid.empty() && in.free.empty()) {
  const int n = static_cast<int>(in.X.size());
  block_.assign(n, 0);
  for (const auto& set : in.rigid)
    for (const int i : set) block_[i] = -1;
  for (const int i : in.free) block_[i] = -1;
  for (int& b : block_)
    if (b == 0) b = n_blocks_++;
  BlockMap map;
  map.n_owned = map.n_global = map.first_dense = n_blocks_;
  for (int i = 0; i < n_blocks_; ++i) map.global.push_back(i);
  map.X.resize(3 * static_cast<size_t>(n_blocks_));
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < 3 && block_[i] >= 0; ++k) map.X[3 * static_cast<size_t>(block_[i]) + k] = in.X[i][k];
  Cliques cliques;
  std::vector<int> list;
  for (const SolidBatch& b : in.cells)
    for (size_t at = 0; at < b.nodes.size(); at += static_cast<size_t>(info(b.shape).n_nodes)) {
      list.clear();
      for (int a = 0; a < info(b.shape).n_nodes; ++a) list.push_back(block_[b.nodes[at + a]]);
      cliques.add(list);
    }
  if (n_blocks_ == 0) return;
  solver_->structure(cliques, map);
  solver_->zero();
  int clique = 0;
  double stiff = 0;
  cells.each(RegionCells::stiffness, [&](std::span<const int> nodes, const double* Ke) {
    solver_->add(clique++, Ke);
    for (size_t i = 0; i < 3 * nodes.size(); ++i) stiff = std::max(stiff, Ke[i * (3 * nodes.size() + 1)]);
  });
  if (free_)
    for (const int dof : determinate_support(in.X)) {
      double spring[3] = {};
      spring[dof % 3] = stiff;
      solver_->add_diagonal(block_[dof / 3], spring);
    }
  b_.resize(3 * static_cast<size_t>(n_blocks_)), z_.resize(b_.size());
}

Eigen::VectorXd Flexibility::solve(Vector f) const {
  if (free_) f -= M_rigid_ * (rigid_.transpose() * f);
  Vector out = Vector::Zero(f.size());
  if (n_blocks_ == 0) return out;
  for (size_t i = 0; i < block_.size(); ++i)
    for (int k = 0; k < 3 && block_[i] >= 0; ++k) b_[3 * static_cast<size_t>(block_[i]) + k] = f[3 * static_cast<Index>(i) + k];
  const SolveReport report = solver_->solve(b_, z_);
  if (!report.ok)
    throw Error("", "the cells of the region do not hold together: " + report.message, "one piece, with no hinges of single nodes");
  for (size_t i = 0; i < block_.size(); ++i)
    for (int k = 0; k < 3 && block_[i] >= 0; ++k) out[3 * static_cast<Index>(i) + k] = z_[3 * static_cast<size_t>(block_[i]) + k];
  if (free_) out -= rigid_ * (M_rigid_.transpose() * out);
  return out;
}

/// Six unknowns of three nodes that hold the region and no more.
std::array<int, 6> Flexibility::determinate_support(const std::vector<Vec3>& X) const {
  const auto nodes = spread_nodes(X);
  Eigen::Matrix<double, 6, 9> motions;
  for (int k = 0; k < 9; ++k) motions.col(k) = rigid_.row(3 * nodes[k / 3] + k % 3).transpose();
  const Eigen::ColPivHouseholderQR<Eigen::Matrix<double, 6, 9>> qr(motions);
  std::array<int, 6> out{};
  for (int k = 0; k < 6; ++k) {
    const int which = qr.colsPermutation().indices()[k];
    out[k] = 3 * nodes[which / 3] + which % 3;
  }
  return out;
}

}  // namespace hilo
