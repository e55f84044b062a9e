// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/flexibility.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <chrono>

#include "base/free_memory.hpp"

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

/// Tells part and time left of a stage, every ten seconds.
SharedCholesky::Told time_left(const std::function<void(const std::string&)>& progress, const std::string& stage) {
  using Clock = std::chrono::steady_clock;
  const auto began = Clock::now();
  return [=, told = began](double part) mutable {
    const auto now = Clock::now();
    if (!progress || now - told < std::chrono::seconds(10) || !(part > 0) || part >= 1) return;
    told = now;
    const double seconds = std::chrono::duration<double>(now - began).count();
    progress(fmt::format("{}: {:.0f} %, {:.0f} s left", stage, 100 * part, seconds * (1 - part) / part));
  };
}

}  // namespace

Flexibility::Flexibility(const ReductionInput& in, const RegionCells& cells, const Matrix& rigid, const Matrix& M_rigid,
                         SharedCholesky& factor)
    : in_(in), cells_(cells), factor_(factor), rigid_(rigid), M_rigid_(M_rigid), free_(in.rigid.empty() && in.free.empty()) {
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
  factor_.structure(std::move(cliques), n_blocks_);
  find_room();
  int clique = 0;
  double stiff = 0;
  cells.each(RegionCells::stiffness, [&](std::span<const int> nodes, const double* Ke) {
    factor_.add(clique++, Ke);
    for (size_t i = 0; i < 3 * nodes.size(); ++i) stiff = std::max(stiff, Ke[i * (3 * nodes.size() + 1)]);
  });
  if (free_)
    for (const int dof : determinate_support(in.X)) {
      double spring[3] = {};
      spring[dof % 3] = stiff;
      factor_.add_diagonal(block_[dof / 3], spring);
      springs_.emplace_back(3 * block_[dof / 3] + dof % 3, stiff);
    }
  if (!factor_.factor(single_, folder_, time_left(in.progress, "factor")))
    throw Error("", "the cells of the region do not hold together", "one piece, with no hinges of single nodes");
}

/// Where the factor goes: into memory in double precision, or in single, or into a file.
void Flexibility::find_room() {
  const double GB = 1e9, whole = 8 * factor_.entries(), half = 4 * factor_.entries();
  // the modes, and what is computed with them, in turn
  const double vectors = static_cast<double>(6 * in_.rigid.size() + 3 * std::min(in_.free.size(), most_free) + 12 + in_.loads.size());
  const double beside =
      24 * static_cast<double>(in_.X.size()) * std::max(3 * vectors + 4.0 * in_.n_vibrations, vectors + 60 + 3.0 * in_.n_vibrations);
  const double room = in_.memory >= 0 ? in_.memory : 0.9 * free_memory() - beside;
  single_ = whole > room;
  if (in_.progress)
    in_.progress(fmt::format("{} unknowns, a factor of {:.3g} GB{}, {:.3g} GB beside it", n_unknowns(), (single_ ? half : whole) / GB,
                             single_ ? " in single precision" : "", beside / GB));
  if (half <= room) return;
  folder_ = in_.scratch;
  if (folder_.empty())
    throw Error("",
                fmt::format("its stiffness has a factor of {:.4g} GB, of {:.4g} GB in single precision, and there is memory for {:.3g} GB",
                            whole / GB, half / GB, std::max(0.0, room) / GB),
                "hilo-reduce --scratch FOLDER keeps it in a file; or a coarser mesh", Exit::resources);
}

Flexibility::Matrix Flexibility::solve(Matrix F) const {
  if (free_) F -= M_rigid_ * (rigid_.transpose() * F);
  Matrix z(n_unknowns(), F.cols());
  for (size_t i = 0; i < block_.size(); ++i)
    if (block_[i] >= 0) z.middleRows<3>(3 * block_[i]) = F.middleRows<3>(3 * static_cast<Index>(i));
  const auto tell = time_left(in_.progress, "answers to loads");
  const Index width = factor_.columns_at_once();
  for (Index k = 0; n_blocks_ > 0 && k < z.cols(); k += width) {
    const auto some = std::min(width, z.cols() - k);
    single_ ? mend(z.middleCols(k, some)) : factor_.solve(z.middleCols(k, some));
    tell(static_cast<double>(k + some) / static_cast<double>(z.cols()));
  }
  F.setZero();
  for (size_t i = 0; i < block_.size(); ++i)
    if (block_[i] >= 0) F.middleRows<3>(3 * static_cast<Index>(i)) = z.middleRows<3>(3 * block_[i]);
  if (free_) F -= rigid_ * (M_rigid_.transpose() * F);
  return F;
}

/// b := K^-1 b by conjugate gradients, each column with its own steps, preconditioned by the factor in single precision.
void Flexibility::mend(Eigen::Ref<Matrix> b) const {
  constexpr double tolerance = 1e-11;  // in the norm of energy
  constexpr int most = 60;
  Matrix r = b, z = b, p;
  b.setZero();
  Eigen::ArrayXd before, enough;
  for (int k = 0; k < most; ++k) {
    factor_.solve(z);
    const Eigen::ArrayXd now = r.cwiseProduct(z).colwise().sum();
    if (k == 0) enough = tolerance * tolerance * now;
    const Eigen::Array<bool, Eigen::Dynamic, 1> open = now > enough;
    if (!now.allFinite()) break;
    if (!open.any()) return;
    p = k == 0 ? z : Matrix(z + p * open.select(now / before, 0).matrix().asDiagonal());
    z = times(p);
    const Eigen::ArrayXd step = open.select(now / p.cwiseProduct(z).colwise().sum().transpose().array(), 0);
    b += p * step.matrix().asDiagonal(), r -= z * step.matrix().asDiagonal();
    z = r, before = now;
  }
  throw Error("", "a factor in single precision does not serve: the stiffness of the cells is too different",
              "hilo-reduce on a machine with more memory", Exit::not_converged);
}

/// K x of what is not held.
Flexibility::Matrix Flexibility::times(const Matrix& x) const {
  Matrix all = Matrix::Zero(3 * static_cast<Index>(block_.size()), x.cols()), out(x.rows(), x.cols());
  for (size_t i = 0; i < block_.size(); ++i)
    if (block_[i] >= 0) all.middleRows<3>(3 * static_cast<Index>(i)) = x.middleRows<3>(3 * block_[i]);
  all = cells_.times(RegionCells::stiffness, all);
  for (size_t i = 0; i < block_.size(); ++i)
    if (block_[i] >= 0) out.middleRows<3>(3 * block_[i]) = all.middleRows<3>(3 * static_cast<Index>(i));
  for (const auto& [unknown, stiff] : springs_) out.row(unknown) += stiff * x.row(unknown);
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
