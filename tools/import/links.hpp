// SPDX-License-Identifier: GPL-3.0-or-later
// What decks tie together, as the scene says it: shared by the readers of .bdf and .inp.
#pragma once
#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/math.hpp"

namespace hilo {

/// The joint that holds components (bits 0 to 5: displacements and turns along three axes), and which of the axes is its own, or -1.
struct HoldingJoint {
  const char* kind;
  int axis;
};
std::optional<HoldingJoint> joint_that_holds(unsigned components);

/// Joints of the scene, one after the other from a to b, that hold components along `axes` (columns) and leave the others free: one joint
/// where there is one that does, else slides on bodies of no mass between.  `unique` gives a name of a section of the scene that is free.
std::string joints_that_hold(unsigned components, const Mat3& axes, const std::string& name, const std::string& a, const std::string& b,
                             const std::string& at, const std::string& place,
                             const std::function<std::string(const std::string& section, const std::string& wish)>& unique);

/// What a deck prescribes of a body beside components that it holds.
struct Prescribed {
  Vec3 way = Vec3::Zero(), turn = Vec3::Zero();  // [m], [rad]
  bool any() const { return way != Vec3::Zero() || turn != Vec3::Zero(); }
};
/// [[motion]] of the body `on`: held, moved, or turned about an axis through `at`; `past`: its history.  Error at `place` where it moves
/// and turns, or turns about more than one axis.
std::string motion_of_body(const std::string& name, const std::string& on, const Prescribed& by, const std::string& at,
                           const std::string& past, const std::string& place);
/// A body of no mass at `at` that goes this way: what holds another to it moves that.
std::string moving_body(const std::string& name, const Prescribed& by, const std::string& at, const std::string& past,
                        const std::string& place);

/// What a weighted mean of points makes of a force and a moment at a point of it: f = w (F/W + (T^-1 (M + (x - c) x F)) x r), with r from
/// the weighted mean c, W = sum w and T = sum w (r.r I - r r^T).  Nothing where the points cannot carry the moment.
std::optional<std::vector<Vec3>> shares_of_mean(const std::vector<Vec3>& X, const std::vector<double>& w, const Vec3& at, const Vec3& F,
                                                const Vec3& M);

/// A term of a sum of displacements that is zero: what moves, at which point, and its axis times its factor.
struct SumTerm {
  std::string end, at;  // a set of one node or a body of the scene; "[1, 2, 3]"
  Vec3 way;
};
/// Joints of the scene that keep the sum at zero; those of more than three terms by bodies of no mass that move as sums of the first ones.
std::string joints_of_sum(const std::vector<SumTerm>& terms, const std::string& name, const std::string& place,
                          const std::function<std::string(const std::string& section, const std::string& wish)>& unique);

/// Whether points lie on a line, or at one place.
bool on_a_line(const std::vector<Vec3>& points);
/// Whether they lie in a plane.
bool in_a_plane(const std::vector<Vec3>& points);

/// A displacement of a node: its number, and its component.
using Displacement = std::pair<std::int64_t, int>;
/// Displacements that are equal, each with the least of those that it equals.
class EqualDisplacements {
 public:
  Displacement root(Displacement x) {
    auto& up = up_.try_emplace(x, x).first->second;
    return up == x ? x : up = root(up);
  }
  void unite(Displacement a, Displacement b) {
    a = root(a), b = root(b);
    up_[std::max(a, b)] = std::min(a, b);
  }
  const std::map<Displacement, Displacement>& all() const { return up_; }

 private:
  std::map<Displacement, Displacement> up_;
};
/// A body of no mass, with the joint of this name that lets it slide along an axis; `joint` "": without one.
std::string sliding_body(const std::string& name, const std::string& joint, const std::string& axis, const std::string& at,
                         const std::string& place);
/// What keeps a node at the place of that body along the axis.
std::string joint_to_slide(const std::string& name, const std::string& body, const std::string& node, const std::string& axis,
                           const std::string& at, const std::string& place);

}  // namespace hilo
