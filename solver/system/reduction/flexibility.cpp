// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/reduction/flexibility.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <chrono>

#include "base/free_memory.hpp"

namespace hilo {
namespace {

using Eigen::Index;

/// Three nodes far from one line.
std::array<int, 3> spread_nodes(const std::vector<Vec3>& X, const std::vector<char>& not_these) {
  std::array<int, 3> out{};
  const auto far = [&](auto&& distance) {
    int best = -1;
    for (size_t i = 0; i < X.size(); ++i)
      if (!not_these[i] && (best < 0 || distance(X[i]) > distance(X[best]))) best = static_cast<int>(i);
    return std::max(best, 0);
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
    : in_(in),
      cells_(cells),
      factor_(factor),
      rigid_(rigid),
      M_rigid_(M_rigid),
      free_(in.rigid.empty() && in.free.empty() && in.tied.empty()) {
  number(in);
  if (n_blocks_ == 0) return;
  add_cells();
  if (free_ && std::ranges::all_of(is_of_block_, [](char of_block) { return of_block != 0; })) {
    double arm = 0;
    for (size_t i = 0; i < block_.size(); ++i)
      if (block_[i] == block_[0]) arm = std::max(arm, arm_[i].norm());
    for (const int k : {0, 1}) {
      const double stiff = stiff_ * (k == 0 ? 1 : arm * arm), springs[3] = {stiff, stiff, stiff};
      factor_.add_diagonal(block_[0] + k, springs);
      for (int i = 0; i < 3; ++i) springs_.emplace_back(3 * (block_[0] + k) + i, stiff);
    }
  } else if (free_) {
    for (const int dof : determinate_support(in.X)) {
      double spring[3] = {};
      spring[dof % 3] = stiff_;
      factor_.add_diagonal(block_[dof / 3], spring);
      springs_.emplace_back(3 * block_[dof / 3] + dof % 3, stiff_);
    }
  }
  if (!factor_.factor(single_, folder_, time_left(in.progress, "factor")))
    throw Error("", "the cells of the region do not hold together", "one piece, with no hinges of single nodes");
}

void Flexibility::number(const ReductionInput& in) {
  block_.assign(in.X.size(), 0), is_of_block_.assign(in.X.size(), 0), arm_.assign(in.X.size(), Vec3::Zero());
  for (const auto& set : in.rigid)
    for (const int i : set) block_[i] = -1;
  for (const int i : in.free) block_[i] = -1;
  for (const auto& set : in.tied)
    for (const int i : set) block_[i] = -1;
  std::vector<const std::vector<int>*> first(in.X.size(), nullptr);
  for (const auto& set : in.blocks) {
    const auto n = std::ranges::count_if(set, [&](int i) { return block_[i] < 0; });
    if (n > 0 && n < std::ssize(set)) throw Error("", "nodes that move as one are held in part", "a set that has all of them");
    if (n > 0) continue;
    for (const int i : set) is_of_block_[i] = 1;
    first[set.front()] = &set;
  }
  for (size_t i = 0; i < block_.size(); ++i) {
    if (block_[i] == 0 && !is_of_block_[i]) block_[i] = n_blocks_++;
    if (!first[i]) continue;
    const auto& set = *first[i];
    Vec3 mean = Vec3::Zero();
    for (const int k : set) mean += in.X[k] / static_cast<double>(set.size());
    Mat3 spread = Mat3::Zero();
    for (const int k : set) {
      block_[k] = n_blocks_, arm_[k] = in.X[k] - mean;
      spread += arm_[k] * arm_[k].transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(spread);
    if (eigen.eigenvalues()[1] < 1e-6 * eigen.eigenvalues()[2])
      lines_.push_back({n_blocks_ + 1, eigen.eigenvectors().col(2), eigen.eigenvalues()[2]});
    n_blocks_ += 2;
  }
}

/// The sum of T^T K T over the cells.
void Flexibility::add_cells() {
  Cliques cliques;
  std::vector<int> list;
  const auto blocks_of = [&](std::span<const int> nodes) {
    list.clear();
    const auto add = [&](int block) {
      if (block < 0 || std::ranges::find(list, block) == list.end()) list.push_back(block);
    };
    for (const int i : nodes) {
      add(block_[i]);
      if (is_of_block_[i]) add(block_[i] + 1);
    }
  };
  for (const SolidBatch& b : in_.cells) {
    const auto n = static_cast<size_t>(info(b.shape).n_nodes);
    for (size_t at = 0; at < b.nodes.size(); at += n) blocks_of({b.nodes.data() + at, n}), cliques.add(list);
  }
  for (const PointCell& c : in_.points) blocks_of(c.nodes), cliques.add(list);
  const int first_line = cliques.size();
  for (const Line& line : lines_) cliques.add(std::array{line.block});
  factor_.structure(std::move(cliques), n_blocks_);
  find_room();
  int clique = 0;
  double stiff = 0;
  cells_.each(RegionCells::stiffness, [&](std::span<const int> nodes, const double* Ke) {
    const auto n = 3 * static_cast<Index>(nodes.size());
    for (Index i = 0; i < n; ++i) stiff = std::max(stiff, Ke[i * (n + 1)]);
    if (std::ranges::none_of(nodes, [&](int i) { return is_of_block_[i] != 0; })) return factor_.add(clique++, Ke);
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    blocks_of(nodes);
    Rows T = Rows::Zero(n, 3 * std::ssize(list));
    for (Index a = 0; a < std::ssize(nodes); ++a) {
      const int i = nodes[a];
      const auto column = [&](int block) { return 3 * (std::ranges::find(list, block) - list.begin()); };
      if (block_[i] < 0) continue;
      T.block<3, 3>(3 * a, column(block_[i])).setIdentity();
      if (is_of_block_[i]) T.block<3, 3>(3 * a, column(block_[i] + 1)) = -skew(arm_[i]);
    }
    const Rows K = T.transpose() * Eigen::Map<const Rows>(Ke, n, n) * T;
    factor_.add(clique++, K.data());
  });
  for (size_t k = 0; k < lines_.size(); ++k) {
    Line& line = lines_[k];
    line.stiff *= 1e-6 * stiff;
    const Mat3 K = line.stiff * line.along * line.along.transpose();
    factor_.add(first_line + static_cast<int>(k), K.data());
  }
  stiff_ = stiff;
}

Flexibility::Matrix Flexibility::on_unknowns(const Matrix& F) const {
  Matrix z = Matrix::Zero(n_unknowns(), F.cols());
  for (size_t i = 0; i < block_.size(); ++i) {
    if (block_[i] < 0) continue;
    const auto force = F.middleRows<3>(3 * static_cast<Index>(i));
    z.middleRows<3>(3 * block_[i]) += force;
    if (is_of_block_[i]) z.middleRows<3>(3 * block_[i] + 3) += skew(arm_[i]) * force;
  }
  return z;
}

Flexibility::Matrix Flexibility::at_nodes(const Matrix& z) const {
  Matrix x = Matrix::Zero(3 * static_cast<Index>(block_.size()), z.cols());
  for (size_t i = 0; i < block_.size(); ++i) {
    if (block_[i] < 0) continue;
    auto at = x.middleRows<3>(3 * static_cast<Index>(i));
    at = z.middleRows<3>(3 * block_[i]);
    if (is_of_block_[i]) at -= skew(arm_[i]) * z.middleRows<3>(3 * block_[i] + 3);
  }
  return x;
}

/// Where the factor goes: into memory in double precision, or in single, or into a file.
void Flexibility::find_room() {
  const double GB = 1e9, whole = 8 * factor_.entries(), half = 4 * factor_.entries();
  // the modes, and what is computed with them, in turn
  size_t n_moved = std::min(in_.free.size(), most_free);
  for (const auto& set : in_.tied) n_moved += std::min(set.size(), most_free);
  const double vectors = static_cast<double>(6 * in_.rigid.size() + 3 * n_moved + 12 + in_.loads.size());
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
  const Vector whole = F.colwise().norm();
  if (free_) F -= M_rigid_ * (rigid_.transpose() * F);
  Matrix z = on_unknowns(F);
  for (Index k = 0; k < F.cols(); ++k)  // it moves the region as a rigid body, or acts on what is held: what is left is rounding
    if (free_ ? F.col(k).norm() < 1e-10 * whole[k] : z.col(k).norm() < 1e-10 * whole[k]) z.col(k).setZero();
  const auto tell = time_left(in_.progress, "answers to loads");
  const Index width = factor_.columns_at_once();
  for (Index k = 0; n_blocks_ > 0 && k < z.cols(); k += width) {
    const auto some = std::min(width, z.cols() - k);
    single_ ? mend(z.middleCols(k, some)) : factor_.solve(z.middleCols(k, some));
    tell(static_cast<double>(k + some) / static_cast<double>(z.cols()));
  }
  F = at_nodes(z);
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
  Matrix out = on_unknowns(cells_.times(RegionCells::stiffness, at_nodes(x)));
  for (const Line& line : lines_)
    out.middleRows<3>(3 * line.block) += line.stiff * line.along * (line.along.transpose() * x.middleRows<3>(3 * line.block));
  for (const auto& [unknown, stiff] : springs_) out.row(unknown) += stiff * x.row(unknown);
  return out;
}

/// Six unknowns of three nodes that hold the region and no more.
std::array<int, 6> Flexibility::determinate_support(const std::vector<Vec3>& X) const {
  const auto nodes = spread_nodes(X, is_of_block_);
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
