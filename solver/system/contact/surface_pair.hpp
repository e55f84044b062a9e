// SPDX-License-Identifier: GPL-3.0-or-later
// Two surfaces that meet: points of both against the facets of the other one (physics/contact/facet_contact).
//
// A list of pairs of facets that are near each other is the structure of the matrix.  It lasts while it has all pairs within half of the
// margin of the way that they are about to go.  Within a step a point has one triangle: the one that it crosses first, else the nearest one
// in the mean of the step.  It is chosen at the beginning and again when Newton's method has converged (`revise`).
//
// Surfaces of what hangs together, and one that meets itself, have facets side by side and back to back, which never meet:
// self_contact.cpp.
#pragma once
#include <optional>

#include "system/contact/contact_surface.hpp"
#include "system/contribution.hpp"

namespace hilo {

/// Sums of a contact over the run.
struct ContactSums {
  static constexpr int resolved = 5;  // steps of an impact, below which it is told
  double slip = 0, dissipated = 0;    // [m, J]
  double way = 0;                     // slip on the way to the answer of the load step at work, in steps from rest [m]
  double share = 0;                   // largest depth, as a share of the cell
  int steps = 0;                      // that the contact lasts by now
  int impacts = 0, shortest = 0;      // that have ended; steps of the shortest, 0: none has
  int outside = 0;                    // most points that were past the border of a height field at once
  /// A step with this force [N] and this slip times force [N m].
  void add(double pressing, double slid);
  /// What is dissipated in such a step [J].  Pressures on the way are none of the answer: there the slip is kept, for friction's force
  /// mu p of the answer to work along it.
  void add_work(double work, double friction, double pressing, double slid, bool on_the_way);
};

/// On rank 0, which has all nodes of both; the other ranks know its name.
class SurfacePair {
 public:
  explicit SurfacePair(const Points& points) : points_(points) {}
  std::string name, told;  // `told`: what the stiffness is and from what
  ContactSurface side[2];
  double margin = 0;       // [m]
  bool is_static = false;  // load steps: forces at their end, of the gap itself
  double factor = 1;       // of the stiffness
  double most = HUGE_VAL;  // of E over the depth of the cells, on the way to an answer
  bool sticks = false;     // whatever pulls, on the way to an answer
  bool loses = false;      // by restitution
  bool hangs = false;      // both hang together: they may have nodes in common
  bool itself = false;     // both are one: side 0 has the points, side 1 the facets that they meet
  ContactSums sums, next;

  size_t n_points() const { return side[0].points.size() + side[1].points.size(); }
  /// After both sides are filled.
  void prepare();
  void number(Layout& layout);
  bool search(const Config& q, const Config* v, double h);
  bool revise(const Stage& s);
  void evaluate(Pass& p) const;
  double energy() const;
  double dissipated(const Stage& s) const;
  /// From now on, small motions about q.
  void hold(const Config& q);
  /// Why the step cannot be, or "".
  std::string advance(const Stage& s);
  void commit(const Config& q) {
    if (n_points() > 0) committed_ = q.x;
  }
  void settle(bool accepted);
  void archive(Archive& a);
  /// Force on side 1, in the step, zero where a surface meets itself; the sum of the sizes of the normal forces of all points [N].
  struct Pressing {
    Vec3 on_b = Vec3::Zero();
    double sum = 0;
  };
  Pressing force(const Stage& s) const;
  /// Of the points that face the other side in the step at work, as a share of the cell.
  double depth(const Config& q) const;
  /// Largest depth [m], and as a share of the cell, of what `state` is.
  std::pair<double, double> depth() const;
  /// The point that starts deepest in the other side; its depth [m], or nothing.
  struct Deep {
    double depth, cell;
    Vec3 at;
    double sag = 0;  // by which the depth differs within a facet, as facets are flat [m]
  };
  std::optional<Deep> deepest_start(const Config& q);
  /// Over the points that face the other side, less what counts as touching [m]; 1e300: none does.
  double least_gap(const Config& q) const;
  /// A point of side s that starts within the other side, as far from its facets as may be; that side is closed.
  std::optional<Vec3> starts_inside(int s, const Config& q) const;
  /// A point of a surface that meets itself starts behind another part of it.
  std::optional<Vec3> starts_inside_itself(const Config& q) const;
  /// Where surfaces of what hangs together start crossed.
  std::optional<Vec3> starts_crossed(const Config& q) const;

 private:
  using Positions = std::span<const Vec3>;
  static constexpr double aside = 0.5;     // of what hangs together: largest cosine between normals of what can meet
  static constexpr double shallow = 0.25;  // and depth of what meets, as a share of the cell
  struct Target {
    int face = -1, triangle = -1;
    bool crossed = false, inside = false;  // inside: over the triangle and behind it
  };
  struct Ball {  // about a facet and its way
    Vec3 centre, normal;
    double radius;
  };
  OverTriangle<double> over(int side, const SurfacePoint& point, const FacetState& at, Positions x) const;
  FacetForce<double> force_of(int side, const SurfacePoint& point, const Stage& s) const;
  Target target_of(int side, const SurfacePoint& point, Positions x0, Positions x1) const;
  Target faced(int side, const SurfacePoint& point, const Target& met, const Vec3& p1, Positions x1) const;
  FacetState begun(int side, const SurfacePoint& point, const Target& target, Positions x0) const;
  /// Load steps begin where what touches holds [m].
  double touch(const SurfacePoint& point) const { return (is_static || settles_) && !point.parts ? 1e-8 * point.cell : 0; }
  /// Whether a state of equilibrium is sought from which steps in time are to start: forces as of load steps.
  bool settles(const Stage& s) const { return !is_static && !s.conserving() && s.elapsed > 1e300; }
  /// By the end of a step alone, as load steps choose.
  bool at_end_alone() const { return is_static || settles_; }
  double share() const { return std::min(1., most / factor); }
  /// The depth at which the pressure is the modulus of what lies behind [m].
  double deep(const SurfacePoint& point) const { return point.cell / (factor * share()); }
  Positions begin(const Stage& s) const {
    if (!about_.empty()) return about_;
    return s.conserving() || begin_.empty() ? s.e0->x : begin_;
  }
  template <class T>
  FacetForce<T> force(const SurfacePoint& point, const Stage& s, const OverTriangle<double>& z0, const OverTriangle<T>& z1) const;
  bool would_act(int side, const SurfacePoint& point, const FacetState& now, Positions x0, Positions x1) const;
  Ball ball_of(int side, int face, Positions x0, Positions x1) const;
  void look(Positions x0, Positions x1);
  bool meets_unlisted(const std::pair<int, int>& pair, Positions x0, Positions x1) const;
  std::vector<std::pair<int, int>> near(Positions x0, Positions x1, double within) const;
  std::vector<std::pair<int, int>> near_by_boxes(Positions x0, Positions x1, double within) const;
  bool is_closed(int s) const;
  double solid_angle(int s, const Vec3& at, Positions x) const;
  bool is_beside(int s, int f, int g) const;
  void find_back_to_back(Positions x);
  void leave_out_what_cannot_meet(std::vector<std::pair<int, int>>& list, Positions x0, Positions x1, bool loosely) const;
  bool may_meet(int s, const SurfacePoint& point, int face) const;
  bool may_meet_there(int s, const SurfacePoint& point, int face, double distance, double gap) const;
  void list_partners();
  /// What a point that leaves the border of a surface in the step had stored [J].
  double released(const SurfacePoint& point) const { return point.now.face < 0 ? stored(point, point.state.past) : 0; }
  static double stored(const SurfacePoint& point, const FacetPast& past) {
    return point.law.potential(past.gap) + point.law.kt / 2 * (past.bent[0] * past.bent[0] + past.bent[1] * past.bent[1]);
  }
  void add_tangent(Pass& p, int side, const SurfacePoint& point) const;

  const Points& points_;
  double unevenness(const Config& q) const;
  std::vector<std::pair<int, int>> near_;   // facets of side 0 and 1, ascending
  std::vector<std::pair<int, int>> never_;  // of what hangs together: back to back in the reference, ascending
  std::vector<int> clique_;                 // of these
  struct Partner {
    int face, pair;  // of the other side; place in near_
  };
  std::vector<std::vector<Partner>> partners_[2];  // of each facet
  std::vector<int> listed_[2];                     // points of facets that have partners: what the others remember is nothing
  /// Each of them, of both sides.
  template <class Visit>
  void each_listed(Visit&& visit) {
    for (int s = 0; s < 2; ++s)
      for (const int i : listed_[s]) visit(s, side[s].points[i]);
  }
  template <class Visit>
  void each_listed(Visit&& visit) const {
    for (int s = 0; s < 2; ++s)
      for (const int i : listed_[s]) visit(s, side[s].points[i]);
  }
  std::vector<Ball> ball_[2];    // of the last look
  bool settles_ = false;         // in the stage that was chosen for last
  std::vector<Vec3> about_;      // in small motions: where nodes are in the state
  std::vector<Vec3> committed_;  // of the state accepted last
  std::vector<Vec3> begin_;      // where nodes are at the beginning of the step
  std::vector<Vec3> foreseen_;   // where nodes were to go in the step at work
  std::vector<int> nodes_[2];    // of both sides
};

}  // namespace hilo
