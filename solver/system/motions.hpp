// SPDX-License-Identifier: GPL-3.0-or-later
// What is held or moves by a law: bodies, and single components of nodes.
#pragma once
#include <functional>

#include "physics/motion_law.hpp"
#include "system/contribution.hpp"

namespace hilo {

/// Prescribed motion of a body (fixed, translation, rotation) or of single components of nodes.
struct Motion {
  std::string name;
  int body = -1;            // the driven body, or -1: components of nodes
  std::vector<int> nodes;   // nodes of the components, or followers of the driven body
  std::vector<int> joints;  // that hold the components of nodes of blocks, by number
  std::array<bool, 3> component{true, true, true};
  Vec3 displacement = Vec3::Zero();  // at law 1 [m]
  Vec3 at = Vec3::Zero(), axis = Vec3::Zero();
  double angle = 0;     // at law 1 [rad]
  bool moving = false;  // fixed: the law rests at 0
  MotionLaw law;
};

class Beams;

/// Where joints hold components of points, and the forces they hold them with; by number of the joint.
using HeldPoints = std::function<std::vector<std::array<Vec3, 2>>(const Moment&, int)>;

class Motions final : public Contribution, public Equations, public Prescribing, public Jumping, public Stateful, public Observer {
 public:
  Motions(const Points& points, const Beams& beams, HeldPoints held) : points_(points), beams_(beams), held_(std::move(held)) {}
  std::vector<Motion> list;

  Traits traits() const override;
  void prepare() override;
  void evaluate(Pass&) const override {}  // what is held has no equations
  void add_work(const Moment& m, Work& sum) const override;
  bool moves() const override;
  void prescribe(Config& q, double t, double ramp) const override;
  void prescribe_rates(double t, Side side, Config* v, Config* a) const override;
  void copy_prescribed(const Config& from, Config& to) const override;
  std::string too_far(double t0, double t1) const override;
  /// What is fixed and is not where it was.
  std::string fault(const Config& q) const override;
  void add_jumps(double t, const Config& before, const Config& after, std::span<const double> slack,
                 std::vector<Jump>& jumps) const override;
  std::vector<Output> outputs() const override;
  void observe(const Sight& at) override;
  void tie(Ties&) const override {}  // what a moving body is joined to says so (Body::moving)

 private:
  Vec6 reaction(const Motion& m, const Moment& at) const;
  const Points& points_;
  const Beams& beams_;     // whose inertia is not in that of a body
  const HeldPoints held_;  // nodes of blocks
};

}  // namespace hilo
