// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/modes/turning_frame.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "system/uneven.hpp"

namespace hilo {
namespace {

double fastest_of(const std::vector<Vec3>& rates) {
  double out = 0;
  for (const Vec3& w : rates) out = std::max(out, w.norm());
  return out;
}

}  // namespace

Mat3 turned_further(const Vec3& w, const std::vector<Vec3>& all) {
  if (w.norm() == 0) return Mat3::Identity();
  return Eigen::AngleAxisd(0.5 + 0.5 * w.norm() / fastest_of(all), w.normalized()).toRotationMatrix();
}

TurningFrame::TurningFrame(std::vector<Vec3> rates, const std::vector<Vec3>& all)
    : rates_(std::move(rates)), stands_(fastest_of(rates_) == 0) {
  for (const Vec3& w : rates_) turn_.push_back(turned_further(w, all));
}

Eigen::VectorXd TurningFrame::across(const Eigen::VectorXd& x) const {
  Eigen::VectorXd out(x.size());
  for (size_t k = 0; k < rates_.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(3 * k);
    out.segment<3>(at) = rates_[k].cross(x.segment<3>(at));
  }
  return out;
}

Eigen::MatrixXd TurningFrame::turned(Eigen::MatrixXd shapes) const {
  for (size_t k = 0; k < turn_.size() && !stands_; ++k) {
    auto rows = shapes.middleRows<3>(static_cast<Eigen::Index>(3 * k));
    rows = (turn_[k] * rows).eval();
  }
  return shapes;
}

std::string TurningFrame::broken_row(const System& system, const Config& q, const Eigen::MatrixXd& shapes) const {
  Eigen::MatrixXd z = turned(shapes);
  for (const UnknownField& f : system.unknowns)
    for (size_t k = 0; k < f.size(); ++k) {
      auto rows = z.middleRows<3>(static_cast<Eigen::Index>(3 * f.block(k)));
      const double size = rows.cwiseAbs().maxCoeff();
      for (int i = 0; i < 3; ++i)
        if (f.held_of(k)[static_cast<size_t>(i)] && rows.row(i).cwiseAbs().maxCoeff() > 1e-6 * size) return "what a motion holds";
      if (f.turns()) rows *= system.length;
    }
  const Eigen::RowVectorXd largest = z.colwise().norm();
  for (const auto& c : system.constraints()) {
    const DenseRows G = c->gradient(stage_at(q, 0));
    const std::vector<int> blocks = c->blocks();
    Eigen::MatrixXd own(G.cols(), z.cols());
    for (size_t k = 0; k < blocks.size(); ++k)
      own.middleRows<3>(static_cast<Eigen::Index>(3 * k)) = z.middleRows<3>(static_cast<Eigen::Index>(3 * blocks[k]));
    const Eigen::MatrixXd gap = G * own;
    for (int r = 0; r < c->n_rows(); ++r)
      if (c->active()[r] &&
          (gap.row(r).cwiseAbs().array() > G.row(r).norm() * (1e-6 * own.colwise().norm() + 1e-9 * largest).array()).any())
        return c->label();
  }
  return {};
}

std::vector<TurningFrame> turning_frames(const System& system, const State& state) {
  const std::vector<Vec3> spin = spins(system, state.q, state.v);
  const Vec3 some = *std::ranges::max_element(spin, {}, [](const Vec3& w) { return w.norm(); });
  const bool is_one = std::ranges::all_of(spin, [&](const Vec3& w) { return w.norm() == 0 || (w - some).norm() < 1e-9 * some.norm(); });
  const auto n = static_cast<size_t>(system.first_joint_block());
  std::vector<Vec3> own(n, Vec3::Zero());
  for (const UnknownField& f : system.unknowns)
    for (size_t k = 0; k < f.size(); ++k)
      if (f.turns() || f.array == &Config::c) own[static_cast<size_t>(f.block(k))] = spin[static_cast<size_t>(f.item[k])];
  std::vector<TurningFrame> out{{std::vector<Vec3>(n, Vec3::Zero()), spin}, {own, spin}};
  if (is_one) out.emplace_back(std::vector<Vec3>(n, some), spin);
  return out;
}

}  // namespace hilo
