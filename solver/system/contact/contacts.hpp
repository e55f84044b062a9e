// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts: points of regions and bodies against obstacles that the ground or a body carries, and surfaces against each other
// (system/surface_pair).  No rows, no events: forces of gaps that are closed at either end of the step (physics/contact).
#pragma once
#include "system/contact/ball_heap.hpp"
#include "system/contact/contact_pair.hpp"
#include "system/contact/surface_pair.hpp"
#include "system/contribution.hpp"
#include "system/revising.hpp"
#include "system/touching.hpp"

namespace hilo {

/// Of the stiffness of facets of regions that bend, in load steps.
constexpr double static_factor = 100;

/// Nodes of regions that bend, of a contact: on each rank those of the facets that it evaluates, local.
struct TouchedNodes {
  std::string contact;
  std::vector<int> nodes;
};
class System;
/// Of each contact, in the same order on all ranks.
std::vector<TouchedNodes> touched_nodes(const System& system);

class Contacts final : public Contribution, public Equations, public Stateful, public Observer, public Revising, public Touching {
 public:
  Contacts(const Points& points, bool is_static) : points_(points), is_static_(is_static) {}
  std::vector<ContactPair> list;
  std::vector<SurfacePair> surfaces;
  std::vector<BallHeap> heaps;
  bool plain = false;  // of methods that take the force of a gap at an instant

  Traits traits() const override;
  std::string count() const override;
  void number(Layout& layout) override;
  bool search(const Config& q, const Config* v, double h) override;
  bool revise(const Stage& stage) override;
  bool chooses() const override { return touches(); }
  void evaluate(Pass& p) const override;
  void add_energy(const Config& q, const Config& v, Energy& sum) const override;
  void add_work(const Moment& m, Work& sum) const override;
  std::string fault(const Config& q) const override;
  void advance(const Stage& stage) override;
  void commit(const Config& q, const Config* v) override;
  void settle(bool accepted) override;
  void archive(Archive& a) override;
  std::vector<Output> outputs() const override;
  void observe(const Sight& at) override;
  void add_to_report(Json& run) const override;
  void tie(Ties& ties) const override;
  bool touches() const override { return !list.empty() || !surfaces.empty() || !heaps.empty(); }
  bool has_facets() const override;
  std::string apart(const Config& q) const override;
  void hold(const Config& q) override;
  void soften(double most) override;
  void stick(bool on) override;
  double depth(const Config& q) const override;
  void each_facet(const Config& q, const std::function<void(const Pressed&)>& visit) const override;
  /// Points that are past the border of a height field, on this rank.
  int outside(const ContactPair& pair, const Config& q) const;
  /// The gap of a point, below zero where it is closed [m].
  double gap(const ContactPair& pair, const ContactPoint& point, const Config& q) const;

 private:
  /// Where a point stands within a step.
  struct Place {
    Mat3 A0, A1, Am, turn0 = Mat3::Zero(), turn1 = Mat3::Zero(), turn = Mat3::Zero();  // axes of the obstacle; of the points' body
    Vec3 x0, x1, way = Vec3::Zero();               // measures; `way` of the material point beyond theirs
    Vec3 arm = Vec3::Zero(), arm1 = Vec3::Zero();  // of the point's body, to the point
    Vec3 lowest = Vec3::Zero();                    // from the centre of a ball, body axes
    Vec3 rel, rel1;                                // from the obstacle's body to the point
    PointForce<double> force;
    Vec3 normal, tangential;  // on the left [N]
    Vec3 low = Vec3::Zero();  // from the point to that which slides
  };
  Place place(const ContactPair& pair, const ContactPoint& point, const Stage& s) const;
  template <class T>
  PointForce<T> force(const ContactPair& pair, const ContactPoint& point, const Vec3& x0, const Triple<T>& x1, const Triple<T>& way,
                      const Stage& s, bool fixed = false) const;
  Vec3 position(const ContactPair& pair, const ContactPoint& point, const Config& q) const;
  Vec3 measures(const ContactPair& pair, const Vec3& x, const Config& q) const;
  void add_tangent(Pass& p, const ContactPair& pair, const ContactPoint& point, const Place& at) const;
  /// What a pair did in a step.
  struct Did {
    double pressing = 0, slid = 0, dissipated = 0;  // [N, N m, J]
    std::string why;                                // the step cannot be
  };
  Did advance(ContactPair& pair, const Stage& s);
  Did look_at_way(const ContactPair& pair, const Stage& s) const;
  std::string gone_through(const ContactPair& pair, const ContactPoint& point, const Vec3& x0, const Vec3& x1) const;
  template <class Visit>
  void each_pair(Visit&& visit) {
    for (ContactPair& pair : list) visit(pair);
    for (BallHeap& heap : heaps)
      for (ContactPair& pair : heap.near) visit(pair);
  }
  template <class Visit>
  void each_pair(Visit&& visit) const {
    for (const ContactPair& pair : list) visit(pair);
    for (const BallHeap& heap : heaps)
      for (const ContactPair& pair : heap.near) visit(pair);
  }
  /// Load steps begin where what touches holds [m].
  static double touch(const ContactPoint& point) { return point.parts ? 0 : 1e-8 * point.cell; }
  /// The beginning of the step.
  const Config& begin(const Stage& s) const { return holds() ? about_ : (is_static_ || settles(s)) && !begin_.R.empty() ? begin_ : *s.e0; }
  /// Whether a state of equilibrium is sought from which steps in time are to start: forces as of load steps.
  bool settles(const Stage& s) const { return !is_static_ && !s.conserving() && s.elapsed > 1e300; }
  /// Whether motions are small ones about a state.
  bool holds() const { return !about_.R.empty(); }
  /// Of a start, not of a step.
  bool is_start(const Stage& s) const { return is_static_ == s.conserving() && !settles(s); }
  const Points& points_;
  const bool is_static_;      // load steps: forces at their end
  Config about_;              // in small motions: the state
  Config committed_, begin_;  // the state accepted last; of load steps: where the step began
  double most_ = HUGE_VAL;    // of E over the depth of the cells, on the way to an answer
  bool sticks_ = false;       // friction holds whatever pulls, on the way to an answer
  std::string jumped_;        // what the step tried last went through
};

class System;
/// What may meet something else: bodies, and a node of each facet.
struct Meeting {
  std::vector<int> bodies, nodes;
};
Meeting what_may_meet(const System& system);

}  // namespace hilo
