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
    : rigid_(rigid), M_rigid_(M_rigid), free_(in.rigid.empty() && in.free.empty()) {
  block_.assign(in.X.size(), 0);
  for (const auto& set : in.rigid)
    for (const int i : set) block_[i] = -1;
  for (const int i : in.free) block_[i] = -1;
  for (int& b : block_)
    if (b == 0) b = n_blocks_++;
  if (n_blocks_ == 0) return;
  Cliques cliques;
  std::vector<int> list;
  for (const SolidBatch& b : in.cells)
    for (size_t at = 0; at < b.nodes.size(); at += static_cast<size_t>(info(b.shape).n_nodes)) {
      list.clear();
      for (int a = 0; a < info(b.shape).n_nodes; ++a) list.push_back(block_[b.nodes[at + a]]);
      cliques.add(list);
    }
  BlockCsr K;
  K.structure(cliques, n_blocks_);
  int clique = 0;
  double stiff = 0;
  cells.each(RegionCells::stiffness, [&](std::span<const int> nodes, const double* Ke) {
    K.add(clique++, Ke);
    for (size_t i = 0; i < 3 * nodes.size(); ++i) stiff = std::max(stiff, Ke[i * (3 * nodes.size() + 1)]);
  });
  if (free_)
    for (const int dof : determinate_support(in.X)) {
      double spring[3] = {};
      spring[dof % 3] = stiff;
      K.add_diagonal(block_[dof / 3], spring);
    }
  factors_ = make_cholesky(std::vector<char>(static_cast<size_t>(n_blocks_), 0));
  factors_->sharpen();
  if (!factors_->factor(K)) throw Error("", "the cells of the region do not hold together", "one piece, with no hinges of single nodes");
}

Flexibility::Matrix Flexibility::solve(Matrix F) const {
  if (free_) F -= M_rigid_ * (rigid_.transpose() * F);
  Matrix z(n_unknowns(), F.cols());
  for (size_t i = 0; i < block_.size(); ++i)
    if (block_[i] >= 0) z.middleRows<3>(3 * block_[i]) = F.middleRows<3>(3 * static_cast<Index>(i));
  if (n_blocks_ > 0) factors_->solve_columns(z.data(), n_unknowns(), static_cast<int>(z.cols()));
  F.setZero();
  for (size_t i = 0; i < block_.size(); ++i)
    if (block_[i] >= 0) F.middleRows<3>(3 * static_cast<Index>(i)) = z.middleRows<3>(3 * block_[i]);
  if (free_) F -= rigid_ * (M_rigid_.transpose() * F);
  return F;
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
