// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies whose nodes lie on a line: how much of a tangent holds their turn about it, which cells do not resist.
#include <Eigen/Dense>

#include "linear/tangent_reader.hpp"
#include "system/bodies.hpp"
#include "system/system.hpp"

namespace hilo {
namespace {

/// Takes a tangent, and of the bodies with a line sums what resists their turns.  Marks those whose turn about it is resisted: by moments
/// about it alone, as of a beam along the line, which turns with them, or by more.
class Turns final : public TangentReader {
 public:
  explicit Turns(const System& system)
      : system_(system), sum(9 * system.bodies.size()), twisted(system.bodies.size()), braced(system.bodies.size()) {
    of_.assign(static_cast<size_t>(system.first_joint_block()), -1), turns_.assign(of_.size(), 0);
    for (size_t b = 0; b < system.bodies.size(); ++b) {
      if (system.body_block[b] < 0) continue;
      const auto block = static_cast<size_t>(system.body_block[b]) + 1;
      turns_[block] = 1;
      if (!system.bodies[b].line.isZero(0)) of_[block] = static_cast<int>(b);
    }
  }
  void add(int clique, const double* dense) override {
    const auto list = system_.layout.cliques[clique];
    const auto n = static_cast<Eigen::Index>(list.size());
    const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> K(dense, 3 * n, 3 * n);
    for (Eigen::Index i = 0; i < n; ++i) {
      if (list[i] < 0 || list[i] >= system_.first_joint_block() || of_[static_cast<size_t>(list[i])] < 0) continue;
      const auto b = static_cast<size_t>(of_[static_cast<size_t>(list[i])]);
      const Body& body = system_.bodies[b];
      Eigen::Map<Mat3>(sum.data() + 9 * b) += K.block<3, 3>(3 * i, 3 * i);
      const Vec3 line = system_.start.R[b] * body.line;
      Eigen::VectorXd force = K.middleCols<3>(3 * i) * line;
      const double rounding = 1e-9 * body.size * K.norm(), most = force.norm();
      if (!(most > rounding)) continue;
      twisted[b] = 1;
      for (Eigen::Index k = 0; k < n; ++k)
        if (list[k] >= 0 && list[k] < system_.first_joint_block() && turns_[static_cast<size_t>(list[k])] != 0)
          force.segment<3>(3 * k) -= line * line.dot(force.segment<3>(3 * k));
      if (force.norm() > rounding + 1e-6 * most) braced[b] = 1;
    }
  }

 private:
  const System& system_;
  std::vector<int> of_;      // of a block of turns of a body with a line, the body
  std::vector<char> turns_;  // blocks that are turns

 public:
  std::vector<double> sum, twisted, braced;
};

}  // namespace

void Bodies::look_at_lines(const System& system) {
  at_rest_.clear(), moving_.clear();
  if (std::ranges::all_of(system.bodies, [](const Body& b) { return b.line.isZero(0); })) return;
  Config still;
  Config::each_array([&](auto array) { (still.*array).resize((system.start.*array).size()); });
  for (auto* list : {&still.x, &still.c, &still.eta}) std::ranges::fill(*list, Vec3::Zero());
  for (auto* list : {&still.R, &still.Y}) std::ranges::fill(*list, Mat3::Zero());
  const std::vector<double> none(3 * static_cast<size_t>(system.n_joint_blocks()), 0.0);
  Turns turns(system);
  const auto resisted = [&](const Stage& s) {
    std::vector<Vec3> node(system.start.x.size(), Vec3::Zero());
    std::vector<Vec6> body(system.bodies.size(), Vec6::Zero());
    Residual unused;
    unused.r.assign(3 * static_cast<size_t>(system.n_blocks()), 0.0);
    turns.sum.assign(9 * system.bodies.size(), 0.0);
    Pass pass{s, none, unused, &turns, node, body, 1, false};
    for (const Equations* part : system.all<Equations>()) part->evaluate(pass);
    std::vector<double> sum = turns.sum, out;
    system.comm->sum(sum);
    for (size_t b = 0; b < system.bodies.size(); ++b) out.push_back(Eigen::Map<Mat3>(sum.data() + 9 * b).norm());
    return out;
  };
  Stage s = stage_at(system.start, 0);
  s.a = &still, s.load_factor = 0;
  const std::vector<double> stiffness = resisted(s);
  s.slope = 0, s.chain = 1e-30, s.mass_slope = 1, s.rates_alone = true;  // mass alone
  const std::vector<double> mass = resisted(s);
  system.comm->max(turns.twisted), system.comm->max(turns.braced);
  constexpr double least = 1e-11;  // over what resists other turns
  const double length2 = system.length * system.length;
  for (size_t b = 0; b < system.bodies.size(); ++b) {
    const Line free{1e-6 * system.stiffness * length2, 1e-9 * system.mass * length2}, held{least * stiffness[b], least * mass[b]};
    at_rest_.push_back(turns.braced[b] > 0 ? held : free), moving_.push_back(turns.twisted[b] > 0 ? held : free);
  }
}

/// Without a force.  Where nothing else resists the turn it moves nothing, and the answer is the same whatever its tangent.  Where
/// something does, the share is as small as leaves a matrix regular: the tangent serves modes and buckling as it is.  A beam along the line
/// turns with it for nothing but its mass: at rest it is held as if alone.
void Bodies::stiffen_line(Pass& p, size_t b) const {
  const std::vector<Line>& lines = p.s.mass_slope == 0 ? at_rest_ : moving_;
  if (points_.body_block[b] < 0 || b >= lines.size()) return;
  const double slope = lines[b].stiffness * p.s.slope + lines[b].inertia * p.s.mass_slope;
  const Vec3 line = p.s.end->R[b] * points_.bodies[b].line;
  Eigen::Matrix<double, 6, 6, Eigen::RowMajor> K = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>::Zero();
  K.bottomRightCorner<3, 3>() = slope * line * line.transpose();
  p.K->add(points_.body_clique[b], K.data());
}

}  // namespace hilo
