// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid bodies: inertia and weight in natural coordinates, and the positions of their points.
#pragma once
#include "system/contribution.hpp"

namespace hilo {

class Bodies final : public Contribution, public Equations, public Turning, public Observer, public Clocked {
 public:
  explicit Bodies(const Points& points) : points_(points) {}
  /// Mass-proportional damping of a body: int alpha rho b b^T, b = (1, X - Xc); none of those beyond the list [kg/s, kg m/s, kg m^2/s].
  std::vector<Eigen::Matrix4d> drag;

  /// How much of a tangent holds the turns that cells do not resist; once, after everything is numbered.  Collective.
  void look_at_lines(const System& system);

  Traits traits() const override;
  std::string count() const override;
  std::string owner(int block) const override;
  void evaluate(Pass& p) const override;
  void add_energy(const Config& q, const Config& v, Energy& sum) const override;
  void add_work(const Moment& m, Work& sum) const override;
  void look_at_turn(const Config& q0, const Config& q1, int part, Turned& most) const override;
  std::string name(int item) const override { return "body \"" + points_.bodies[item].name + "\""; }
  std::vector<Output> outputs() const override;
  void observe(const Sight& at) override;
  void tie(Ties&) const override {}  // each is alone
  void add_inertia(std::span<const int> group, const Config& v, const Config& w, std::span<double> sum) const override;
  void add_taken(std::span<const int> group, const Stage& s, std::span<const double> lambda, std::span<double> sum) const override;

 private:
  bool brakes(size_t b) const { return b < drag.size() && !drag[b].isZero(0) && !points_.bodies[b].linear; }
  void add_drag(Pass& p, size_t b) const;
  void stiffen_line(Pass& p, size_t b) const;
  struct Line {
    double stiffness, inertia;  // [N m], [kg m^2]
  };
  const Points& points_;
  std::vector<Line> at_rest_, moving_;     // of each body, without and with inertia; none where no body has a line
  std::vector<std::array<Vec3, 4>> arms_;  // to the four points of each body, when first asked for
};

/// Four points of a body from its centre and directors: the centre, and one along each principal axis, in the order of rising moments of
/// inertia (falling ones of the Euler tensor J).
std::array<Vec3, 4> body_arms(const Body& b);

}  // namespace hilo
