// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/integrator/director_columns.hpp"

#include "dynamics/integrator/stage_directors.hpp"
#include "dynamics/profile.hpp"
#include "dynamics/state.hpp"
#include "system/solids.hpp"

namespace hilo {
namespace {

std::array<Mat3, 3> make_bases() {
  Mat3 signs = Mat3::Zero(), cycle = Mat3::Zero();
  signs.diagonal() << 1, -1, 0;
  cycle(0, 2) = cycle(1, 0) = cycle(2, 1) = 1;
  return {Mat3::Identity(), signs, cycle};
}

}  // namespace

const std::array<Mat3, 3> director_bases = make_bases();

DirectorSums director_sums(const std::array<Mat3, 3>& N) {
  static const Mat9 inverse = [] {
    Mat9 B;
    for (int a = 0; a < 3; ++a)
      for (int k = 0; k < 3; ++k) {
        const Mat3 S = skew(Vec3::Unit(k)) * director_bases[a];
        B.col(3 * a + k) = Eigen::Map<const Vec9>(S.data());
      }
    return Mat9(B.inverse());
  }();
  DirectorSums out;
  for (int c = 0; c < 3; ++c) {
    const Vec9 factors = inverse * Eigen::Map<const Vec9>(N[c].data());
    for (int a = 0; a < 3; ++a) out[a].col(c) = factors.segment<3>(3 * a);
  }
  return out;
}

void DirectorColumns::add(int clique, const double* K) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto blocks = system_.layout.cliques[clique];
  const int n = static_cast<int>(blocks.size()), width = 3 * n, first_joint = system_.first_joint_block();
  const Eigen::Map<const Rows> from(K, width, width);
  const double scale = sigma_ / sigma_here_;
  for (int j = 0; j < n_stages; ++j) {
    part_.assign(static_cast<size_t>(width) * width, 0.0);
    Eigen::Map<Rows> to(part_.data(), width, width);
    for (int k = 0; k < n; ++k) {
      const int block = blocks[k];
      if (block >= first_joint) {
        if (with_multipliers_ && j == row_) to.middleCols<3>(3 * k) = scale * from.middleCols<3>(3 * k);
      } else if (block >= 0 && body_of_[block] >= 0) {
        to.middleCols<3>(3 * k) = from.middleCols<3>(3 * k) * (*change_.directors[j])[body_of_[block]][base_];
      } else if (block >= 0 && base_ == 0) {
        to.middleCols<3>(3 * k) = change_.factor[j] * from.middleCols<3>(3 * k);
      }
      if (block < first_joint)
        for (int r = 0; r < n; ++r)
          if (blocks[r] >= first_joint) to.block<3, 3>(3 * r, 3 * k) *= scale;
    }
    whole_.add_part(clique, n * row_, n * j, n, part_.data());
  }
}

void DirectorColumns::add_diagonal(int block, const double d[3]) {  // of held components, once for each stage
  const double scale = sigma_ / sigma_here_, own[3] = {scale * d[0], scale * d[1], scale * d[2]};
  if (with_multipliers_) whole_.add_diagonal(block + row_ * system_.n_blocks(), own);
}

void CoupledTangent::add(const System& system, SerialKktSolver& whole, const Stage (&stages)[3], const std::vector<double> (&lambda)[3],
                         const Residual (&r)[3], const Eigen::Matrix3d& W, const std::function<Moves(int)>& moves) {
  const double h = stages[0].h;
  const std::array<Eigen::Matrix3d, 3> by{Eigen::Matrix3d::Identity(), W, W * W / (h * h)};  // positions, velocities, accelerations
  for (int a = 0; a < 3; ++a) {
    combine(bases_[a], {{0, stages[0].a}});
    for (Mat3& R : bases_[a].R) R = director_bases[a];
    system.follow(bases_[a]);
  }
  find_changes(system, by, moves);
  for (int i = 0; i < 3; ++i)
    for (int kind = 0; kind < 3; ++kind)
      for (int base = 0; base < 3; ++base) {
        Stage s = stages[i];
        s.end = &bases_[base];
        s.slope = s.chain = kind == 0, s.alpha_slope = kind == 1 ? 1 / h : 0, s.mass_slope = kind == 2;
        s.rates_alone = kind > 0;
        if (kind == 2) s.h = 0, s.step = nullptr, s.v = nullptr;
        DirectorColumns::Change change;
        for (int j = 0; j < 3; ++j) change.factor[j] = by[kind](i, j), change.directors[j] = &changes_[kind][i][j];
        DirectorColumns columns(whole, system, body_of_, i, change, base, kind == 0 && base == 0, r[i].sigma, unused_.sigma);
        system.evaluate(s, lambda[i], unused_, &columns);
      }
  phases().evaluations += 27, phases().tangents += 27;
  if (system.part<Solids>().batches.empty()) return;
  // strains of cells at stage i follow the positions of all stages; of another one, its pair of rate terms says which
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      for (int base = 0; base < 3 && k != i; ++base) {
        Stage s = stages[i];
        s.end = &bases_[base], s.w0 = stages[k].w0, s.w1 = stages[k].w1;
        s.slope = s.chain = s.alpha_slope = s.mass_slope = s.h = 0;
        s.v = nullptr, s.rates_alone = true;
        DirectorColumns::Change change;
        for (int j = 0; j < 3; ++j) change.factor[j] = j == k, change.directors[j] = &changes_[0][k][j];
        DirectorColumns columns(whole, system, body_of_, i, change, base, false, r[i].sigma, unused_.sigma);
        system.evaluate(s, lambda[i], unused_, &columns);
      }
  phases().evaluations += 18, phases().tangents += 18;
}

/// Changes of directors, of their ways and second derivatives at stage i by turns of stage j.
void CoupledTangent::find_changes(const System& system, const std::array<Eigen::Matrix3d, 3>& by, const std::function<Moves(int)>& moves) {
  for (auto& kind : changes_)
    for (auto& row : kind)
      for (auto& part : row) part.resize(system.bodies.size());
  body_of_.assign(system.first_joint_block(), -1);
  for (const UnknownField& f : system.unknowns)
    for (size_t k = 0; k < f.size() && f.turns(); ++k) {
      const int b = body_of_[f.block(k)] = f.item[k];
      const Moves N = moves(b);
      for (int kind = 0; kind < 3; ++kind)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) {
            std::array<Mat3, 3> change;
            for (int c = 0; c < 3; ++c)
              change[c] = by[kind](i, 0) * N[0][3 * j + c] + by[kind](i, 1) * N[1][3 * j + c] + by[kind](i, 2) * N[2][3 * j + c];
            changes_[kind][i][j][b] = director_sums(change);
          }
    }
}

}  // namespace hilo
