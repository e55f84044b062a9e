// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/region_support.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>

#include "system/linear_regions.hpp"
#include "system/welds.hpp"

namespace hilo {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr size_t most_bodies = 16;  // that hang together with a region; those beyond stand still

/// The bodies that a region hangs together with, nearest first, itself the first.
std::vector<int> connected(const System& system, int region) {
  std::vector<int> of_block(static_cast<size_t>(system.first_joint_block()), -1);
  for (size_t b = 0; b < system.bodies.size(); ++b)
    if (const int first = system.body_block[b]; first >= 0)
      of_block[static_cast<size_t>(first)] = of_block[static_cast<size_t>(first) + 1] = static_cast<int>(b);
  std::vector<std::vector<int>> ties;
  for (const Weld& w : system.part<Welds>().list)
    if (!w.yields) ties.push_back({system.modes[w.modes].body, w.body});
  for (const auto& c : system.constraints()) {
    auto& tie = ties.emplace_back();
    for (const int block : c->blocks()) tie.push_back(of_block[static_cast<size_t>(block)]);
  }
  std::vector<int> out{region};
  const auto has = [&](int b) { return std::find(out.begin(), out.end(), b) != out.end(); };
  for (size_t at = 0; at < out.size(); ++at)
    for (const auto& tie : ties) {
      if (std::find(tie.begin(), tie.end(), out[at]) == tie.end()) continue;
      for (const int b : tie)
        if (b >= 0 && out.size() < most_bodies && system.body_block[b] >= 0 && !has(b)) out.push_back(b);
    }
  return out;
}

Mat3 inertia(const Body& b, const Mat3& R) { return R * (b.J.trace() * Mat3::Identity() - b.J) * R.transpose(); }

}  // namespace

/// Turns are taken times the scene's length, amplitudes over the root of the mass: as metres, so that the rows are of one size.
/// A patch or rigid neighbour moves with the region that its first weld names, x = T y: rows of joints and of other welds are left.
RegionSupport support_of(const System& system, const LinearRegion& region, const Config& q) {
  const Modes& modes = system.modes[region.modes];
  const std::vector<int> bodies = connected(system, modes.body);
  const auto n_bodies = static_cast<Index>(bodies.size()), S = region.soft.cols(), at_shapes = 6 * n_bodies, n = at_shapes + S;
  std::vector<Index> column(static_cast<size_t>(system.first_joint_block()), -1);  // of a block
  std::vector<Index> of_body(system.bodies.size(), -1);
  const double length = system.length, amplitude = std::sqrt(system.bodies[modes.body].mass);
  Matrix M = Matrix::Zero(n, n);
  for (Index k = 0; k < n_bodies; ++k) {
    const int b = bodies[static_cast<size_t>(k)];
    const auto first = static_cast<size_t>(system.body_block[b]);
    of_body[static_cast<size_t>(b)] = column[first] = 6 * k, column[first + 1] = 6 * k + 3;
    M.block<3, 3>(6 * k, 6 * k).diagonal().setConstant(system.bodies[b].mass);
    M.block<3, 3>(6 * k + 3, 6 * k + 3) = inertia(system.bodies[b], q.R[b]) / (length * length);
  }
  M.bottomRightCorner(S, S).diagonal().setConstant(amplitude * amplitude);

  std::vector<Vector> rows;
  Matrix T = Matrix::Identity(n, n);
  std::vector<bool> follows(static_cast<size_t>(n), false);  // a column
  for (const Weld& w : system.part<Welds>().list) {
    const int body = system.modes[w.modes].body;
    const Index a = of_body[static_cast<size_t>(body)], b = of_body[static_cast<size_t>(w.body)];
    if ((a < 0 && b < 0) || w.yields) continue;  // nonlinear neighbours hold nothing
    const Matrix G = system.part<Welds>().gradient(w, q);
    const Index most = body == modes.body ? G.rows() : 6;  // others are rigid, they have no stretches
    Matrix its = Matrix::Zero(most, n);
    const auto add = [&](Index to, Index from) {
      if (to < 0) return;
      its.middleCols(to, 3) += G.block(0, from, most, 3), its.middleCols(to + 3, 3) += G.block(0, from + 3, most, 3) / length;
    };
    add(a, 0), add(b, G.cols() - 6);
    if (body == modes.body) its.rightCols(S) = amplitude * G.block(0, 6, most, modes.n_modes) * region.soft;
    Index first = 0;
    if (b >= 0 && a != b && !follows[static_cast<size_t>(b)] && !system.bodies[w.body].linear) {
      const Eigen::FullPivLU<Matrix> own(its.block(0, b, 6, 6));
      if (own.rcond() > 1e-9) {
        const Matrix inverse = own.inverse();
        T.block(b, b, 6, 6).setZero();
        if (a >= 0) T.block(b, a, 6, 6) = -inverse * its.block(0, a, 6, 6);
        if (body == modes.body) T.block(b, at_shapes, 6, S) = -inverse * its.topRightCorner(6, S);
        std::fill_n(follows.begin() + b, 6, true), first = 6;
      }
    }
    for (Index r = first; r < most; ++r) rows.emplace_back(its.row(r).transpose());
  }
  const Stage stage = stage_at(q, 0);
  for (const auto& c : system.constraints()) {
    const std::vector<int> blocks = c->blocks();
    if (std::none_of(blocks.begin(), blocks.end(), [&](int block) { return column[static_cast<size_t>(block)] >= 0; })) continue;
    const DenseRows G = c->gradient(stage);
    for (int r = 0; r < c->n_position_rows(); ++r) {
      if (!c->active()[r]) continue;
      Vector row = Vector::Zero(n);
      for (size_t k = 0; k < blocks.size(); ++k)
        if (const Index to = column[static_cast<size_t>(blocks[k])]; to >= 0)
          row.segment<3>(to) += G.row(r).segment<3>(3 * static_cast<Index>(k)).transpose();
      rows.push_back(std::move(row));
    }
  }

  Index own = 0;  // columns that follow no others
  for (Index k = 0; k < n; ++k)
    if (!follows[static_cast<size_t>(k)]) T.col(own++) = Vector(T.col(k));
  Matrix free = T.leftCols(own);
  if (!rows.empty()) {
    Matrix G(n, static_cast<Index>(rows.size()));
    for (size_t r = 0; r < rows.size(); ++r) G.col(static_cast<Index>(r)) = rows[r];
    Eigen::ColPivHouseholderQR<Matrix> qr(free.transpose() * G);
    qr.setThreshold(1e-8);
    free *= Matrix(qr.householderQ()).rightCols(own - qr.rank());
  }
  RegionSupport out;
  if (free.cols() == 0 || S == 0) {  // held from all sides, or nothing of it is soft
    out.free.setZero(3 + S, 0), out.compliance.setZero(S, S);
    return out;
  }
  const Matrix stiffness = region.soft.transpose() * region.stiffness.asDiagonal() * region.soft, s = amplitude * free.bottomRows(S);
  const Eigen::SelfAdjointEigenSolver<Matrix> strained(s.transpose() * stiffness * s);
  Index still = 0;  // motions without strain
  while (still < free.cols() && !(strained.eigenvalues()[still] > 1e-11 * strained.eigenvalues()[free.cols() - 1])) ++still;
  const Index strains = free.cols() - still;
  const Matrix rigid = free * strained.eigenvectors().leftCols(still);
  Matrix X =
      free * strained.eigenvectors().rightCols(strains) * strained.eigenvalues().tail(strains).cwiseSqrt().cwiseInverse().asDiagonal();
  if (still > 0 && strains > 0)
    X -= rigid * (rigid.transpose() * M * rigid).completeOrthogonalDecomposition().solve(rigid.transpose() * (M * X));
  out.free.resize(3 + S, strains);
  out.free.topRows(3) = q.R[modes.body].transpose() * X.middleRows(3, 3) / length;
  out.free.bottomRows(S) = amplitude * X.bottomRows(S);
  out.compliance = out.free.bottomRows(S) * out.free.bottomRows(S).transpose();
  return out;
}

}  // namespace hilo
