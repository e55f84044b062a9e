// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/modal_damping.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "base/joined.hpp"
#include "linear/tangent_reader.hpp"
#include "system/linear_regions.hpp"

namespace hilo {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr Index most_unknowns = 2000;  // of what hangs together

/// Takes the entries of some unknowns, and of constraint rows over them, from an evaluation.
class Entries final : public TangentReader {
 public:
  /// `place`: of the first of three unknowns of a block, or -1.
  Entries(const System& system, const std::vector<Index>& place, Index n)
      : system_(system), place_(place), matrix(Matrix::Zero(n, n)), rows(Matrix::Zero(3 * system.n_joint_blocks(), n)) {}
  void add(int clique, const double* K) override {
    const auto blocks = system_.layout.cliques[clique];
    const size_t n = blocks.size();
    const int first_row = system_.first_joint_block();
    for (size_t j = 0; j < n; ++j) {
      if (blocks[j] < 0 || blocks[j] >= first_row || place_[static_cast<size_t>(blocks[j])] < 0) continue;
      const Index to = place_[static_cast<size_t>(blocks[j])];
      for (size_t i = 0; i < n; ++i) {
        if (blocks[i] < 0) continue;
        const bool is_row = blocks[i] >= first_row;
        const Index at = is_row ? 3 * (blocks[i] - first_row) : place_[static_cast<size_t>(blocks[i])];
        if (at < 0) continue;
        for (size_t r = 0; r < 3; ++r)
          for (size_t c = 0; c < 3; ++c)
            (is_row ? rows : matrix)(at + static_cast<Index>(r), to + static_cast<Index>(c)) += K[(3 * i + r) * 3 * n + 3 * j + c];
      }
    }
  }

 private:
  const System& system_;
  const std::vector<Index>& place_;

 public:
  Matrix matrix, rows;
};

}  // namespace

void ModalDamping::number(Layout& layout) {
  if (!std::exchange(found_, true)) find_groups(layout.cliques);
  for (Group& group : groups_) {
    std::vector<int> blocks;
    for (const int k : group.regions)
      for (int i = 0; i < system_.modes[static_cast<size_t>(k)].n_blocks; ++i)
        blocks.push_back(system_.modes[static_cast<size_t>(k)].block + i);
    group.clique = layout.cliques.add(blocks);
  }
}

void ModalDamping::find_groups(const Cliques& cliques) {
  if (std::none_of(ratio.begin(), ratio.end(), [](double zeta) { return zeta > 0; })) return;
  const size_t n = system_.bodies.size();
  std::vector<int> of_block(static_cast<size_t>(system_.first_joint_block()), -1);
  for (size_t b = 0; b < n; ++b)
    for (int k = 0; k < 2 && system_.body_block[b] >= 0; ++k)
      of_block[static_cast<size_t>(system_.body_block[b] + k)] = static_cast<int>(b);
  std::vector<double> meet(n * n, 0.0);
  for (int c = 0; c < cliques.size(); ++c) {
    int first = -1;
    for (const int block : cliques[c])
      if (const int b = block >= 0 && block < system_.first_joint_block() ? of_block[static_cast<size_t>(block)] : -1; b >= 0) {
        if (first < 0) first = b;
        meet[static_cast<size_t>(first) * n + static_cast<size_t>(b)] = 1;
      }
  }
  system_.comm->sum(meet);  // cells are on their ranks
  Joined joined(n);
  for (size_t a = 0; a < n; ++a)
    for (size_t b = 0; b < n; ++b)
      if (meet[a * n + b] > 0) joined.join(static_cast<int>(a), static_cast<int>(b));
  for (int b = 0; b < static_cast<int>(n); ++b) {
    if (joined.root(b) != b) continue;
    Group group;
    bool damps = false;
    for (int k = 0; k < static_cast<int>(n); ++k)
      if (joined.root(k) == b) group.bodies.push_back(k);
    for (size_t k = 0; k < system_.modes.size(); ++k) {
      const Modes& m = system_.modes[k];
      if (joined.root(m.body) != b) continue;
      group.regions.push_back(static_cast<int>(k)), damps = damps || (ratio[k] > 0 && m.n_modes > 0);
    }
    if (!damps) continue;
    groups_.push_back(std::move(group));
  }
}

void ModalDamping::find(const Config& q) {
  for (Group& group : groups_) group.C = damping_of(group, q);
}

Matrix ModalDamping::damping_of(const Group& group, const Config& q) const {
  // unknowns of bodies, then amplitudes; each in metres
  std::vector<Index> place(static_cast<size_t>(system_.first_joint_block()), -1);
  std::vector<double> scale;
  Index n = 0;
  const auto has = [&](const auto& list, int item) { return std::find(list.begin(), list.end(), item) != list.end(); };
  std::vector<int> blocks_of_modes;
  for (const int r : group.regions)
    for (int i = 0; i < system_.modes[r].n_blocks; ++i) blocks_of_modes.push_back(system_.modes[r].first + i);
  for (const UnknownField& f : system_.unknowns)
    for (size_t k = 0; k < f.size(); ++k) {
      if (f.array == &Config::x || !has(f.array == &Config::eta ? blocks_of_modes : group.bodies, f.item[k])) continue;
      place[static_cast<size_t>(f.block(k))] = n, n += 3;
      scale.insert(scale.end(), 3, 1 / f.scale(k));
    }
  if (n > most_unknowns)
    throw Error(
        "", fmt::format("modal_damping: connected regions and bodies have {} unknowns, more than the {} it can treat", n, most_unknowns),
        "fewer modes: [region.NAME] modes or up_to; or damping by stiffness and mass");
  Vector share = Vector::Zero(n);  // stiffness of amplitudes, times the root of the ratio
  double slowest = 1e300;
  for (const LinearRegion& r : system_.part<LinearRegions>().regions) {
    const Modes& m = system_.modes[r.modes];
    if (!has(group.regions, r.modes) || m.n_modes == 0) continue;
    const Index at = place[static_cast<size_t>(m.block)];
    share.segment(at, m.n_modes) = std::sqrt(ratio[static_cast<size_t>(r.modes)]) * r.stiffness;
    for (Index j = 0; j < 3 * m.n_blocks; ++j)
      if (j >= m.n_modes) scale[static_cast<size_t>(at + j)] = 0;  // padding
    slowest = std::min(slowest, r.stiffness[0]);
  }
  const Eigen::Map<const Vector> by(scale.data(), n);

  Config still = q;
  for (auto* list : {&still.x, &still.c, &still.eta}) std::fill(list->begin(), list->end(), Vec3::Zero());
  for (auto* list : {&still.R, &still.Y}) std::fill(list->begin(), list->end(), Mat3::Zero());
  const std::vector<double> none(3 * static_cast<size_t>(system_.n_joint_blocks()), 0.0);
  Stage s = stage_at(q, 0);
  s.a = &still, s.load_factor = 0;
  Residual r;
  Entries stiffness(system_, place, n), mass(system_, place, n);
  system_.evaluate(s, none, r, &stiffness);
  stiffness.rows /= r.sigma;
  s.slope = 0, s.chain = 1e-30, s.mass_slope = 1, s.rates_alone = true;  // mass alone
  system_.evaluate(s, none, r, &mass);
  for (Matrix* M : {&stiffness.matrix, &stiffness.rows, &mass.matrix}) system_.comm->sum({M->data(), static_cast<size_t>(M->size())});
  const auto scaled = [&](const Matrix& M) { return Matrix(by.asDiagonal() * (M + M.transpose()) / 2 * by.asDiagonal()); };
  const Matrix K = scaled(stiffness.matrix), M = scaled(mass.matrix), G = stiffness.rows * by.asDiagonal();

  // what the rows leave free, padding left out
  Matrix held = Matrix::Zero(n, G.rows() + n);
  Index count = 0;
  for (Index i = 0; i < G.rows(); ++i)
    if (G.row(i).squaredNorm() > 0) held.col(count++) = G.row(i).transpose();
  for (Index i = 0; i < n; ++i)
    if (by[i] == 0) held(i, count++) = 1;
  Matrix free = Matrix::Identity(n, n);
  if (count > 0) {
    Eigen::ColPivHouseholderQR<Matrix> qr(held.leftCols(count));
    qr.setThreshold(1e-8);
    free = Matrix(qr.householderQ()).rightCols(n - qr.rank());
  }
  Matrix out = Matrix::Zero(n, n);
  if (free.cols() > 0) {
    // M phi = (K + s M) phi/(omega^2 + s): massless motions have 0 there, and are left out as those without strain are
    const Matrix Mf = free.transpose() * M * free;
    Matrix shifted = free.transpose() * K * free + slowest * Mf;
    shifted.diagonal().array() += 1e-14 * shifted.diagonal().maxCoeff();
    const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> modes((Mf + Mf.transpose()) / 2, (shifted + shifted.transpose()) / 2);
    if (modes.info() != Eigen::Success)
      throw Error("", "modal_damping: the modes of what hangs together were not found", "damping by stiffness and mass",
                  Exit::not_converged);
    const Vector& mu = modes.eigenvalues();
    for (Index i = 0; i < mu.size(); ++i) {
      if (!(mu[i] > 1e-13 * mu[mu.size() - 1])) continue;
      const double omega2 = 1 / mu[i] - slowest;
      if (!(omega2 > 1e-9 * slowest)) continue;
      const Vector f = share.cwiseProduct(by.cwiseProduct(free * modes.eigenvectors().col(i))) / std::sqrt(mu[i]);
      out += 2 / (omega2 * std::sqrt(omega2)) * f * f.transpose();
    }
  }
  const Index first = place[static_cast<size_t>(system_.modes[group.regions.front()].block)];
  return out.bottomRightCorner(n - first, n - first);
}

/// What the amplitudes change by over the pair of the rate terms.
Vector ModalDamping::way(const Group& group, const Stage& s) const {
  Vector out(group.C.rows());
  Index at = 0;
  for (const int r : group.regions)
    for (int i = 0; i < system_.modes[r].n_blocks; ++i, at += 3)
      out.segment<3>(at) = s.w1->eta[system_.modes[r].first + i] - s.w0->eta[system_.modes[r].first + i];
  return out;
}

void ModalDamping::evaluate(Pass& p) const {
  const Stage& s = p.s;
  for (const Group& group : groups_) {
    if (group.C.size() == 0 || !(s.h > 0) || !system_.counts(group.bodies.front())) continue;
    const Vector f = group.C * way(group, s) / s.h;
    Index at = 0;
    for (const int r : group.regions) {
      const Modes& m = system_.modes[r];
      for (int j = 0; j < 3 * m.n_blocks; ++j) p.out.r[static_cast<size_t>(3 * m.block + j)] += f[at++];
    }
    if (!p.K) continue;
    const Matrix K = (s.slope1() - s.slope0()) / s.h * group.C;  // symmetric
    p.K->add(group.clique, K.data());
  }
}

void ModalDamping::add_work(const Moment& m, Work& sum) const {
  for (const Group& group : groups_) {
    if (group.C.size() == 0 || !(m.s.h > 0) || !system_.counts(group.bodies.front())) continue;
    const Vector x = way(group, m.s);
    sum.dissipated += m.s.share() * x.dot(group.C * x) / m.s.h;
  }
}

void ModalDamping::archive(Archive& a) {
  std::vector<std::vector<double>> kept;
  for (const Group& group : groups_) kept.emplace_back(group.C.data(), group.C.data() + group.C.size());
  a("modal damping", kept);
  if (!a.restores()) return;
  for (size_t k = 0; k < groups_.size(); ++k) {
    const auto n = static_cast<Index>(std::lround(std::sqrt(static_cast<double>(kept[k].size()))));
    groups_[k].C = Eigen::Map<const Matrix>(kept[k].data(), n, n);
  }
}

void find_modal_damping(System& system, const Config& q) { system.part<ModalDamping>().find(q); }

}  // namespace hilo
