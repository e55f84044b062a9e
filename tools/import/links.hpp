// SPDX-License-Identifier: GPL-3.0-or-later
// What decks tie together, as the scene says it: shared by the readers of .bdf and .inp.
#pragma once
#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "import/scene_writer.hpp"

namespace hilo {

/// Joints, one after the other from a to b, that hold components along `axes` (columns) and leave the others free: one joint where there
/// is one that does, else slides on bodies of no mass between.
void joints_that_hold(SceneWriter& scene, unsigned components, const Mat3& axes, const std::string& name, const std::string& a,
                      const std::string& b, const Vec3& at, const std::string& place);

/// What a deck prescribes of a body beside components that it holds.
struct Prescribed {
  Vec3 way = Vec3::Zero(), turn = Vec3::Zero();  // [m], [rad]
  bool any() const { return way != Vec3::Zero() || turn != Vec3::Zero(); }
};
/// [[motion]] of the body `on`: held, moved, or turned about an axis through `at`.  Error at `place` where it moves and turns.
void motion_of_body(SceneWriter& scene, const std::string& name, const std::string& on, const Prescribed& by, const Vec3& at,
                    const std::string& history, const std::string& place);
/// Nodes of a set that are held along some of x, y, z (bits), or moved by this.
void hold_set(SceneWriter& scene, const std::string& set, unsigned components, const std::optional<Vec3>& displacement,
              const std::string& history, const std::string& place);
/// A body at `at` whose components along `axes` are held or go this way: whole, or by joints to the ground or to a body that goes so.
void hold_body(SceneWriter& scene, const std::string& name, unsigned components, const Mat3& axes, const Prescribed& by, const Vec3& at,
               const std::string& history, const std::string& place);

/// What a weighted mean of points makes of a force and a moment at a point of it: f = w (F/W + (T^-1 (M + (x - c) x F)) x r), with r from
/// the weighted mean c, W = sum w and T = sum w (r.r I - r r^T) + sum v, where v are weights of the turns of points: the moment on each is
/// v times `turn`.  Nothing where the points cannot carry the moment.
struct MeanShares {
  std::vector<Vec3> forces;
  Vec3 turn = Vec3::Zero();
};
std::optional<MeanShares> shares_of_mean(const std::vector<Vec3>& X, const std::vector<double>& w, const Vec3& at, const Vec3& F,
                                         const Vec3& M, const std::vector<double>& v = {});

/// A term of a sum of displacements that is zero: what moves, at which point, and its axis times its factor.
struct SumTerm {
  std::string end;  // a set of one node or a body of the scene
  Vec3 at, way;
};
/// Terms of a small turn of a body at a point, times `way` of a point `beside` it: what that point goes more than the body's own.
void add_turn(SceneWriter& scene, std::vector<SumTerm>& terms, const std::string& body, const Vec3& at, const Vec3& beside, const Vec3& way,
              const std::string& place);
/// Joints that keep the sum at zero; those of more than three terms by bodies of no mass that move as sums of the first ones.
void joints_of_sum(SceneWriter& scene, const std::vector<SumTerm>& terms, const std::string& name, const std::string& place);

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

/// A body of no mass; returns its name.
std::string massless_body(SceneWriter& scene, const std::string& name, const Vec3& at, const std::string& place);
/// The same with a joint that lets it slide along an axis.
std::string sliding_body(SceneWriter& scene, const std::string& name, const Vec3& axis, const Vec3& at, const std::string& place);
/// What keeps a node in the plane of that body across the axis; `body` "": of the ground.
void joint_to_slide(SceneWriter& scene, const std::string& name, const std::string& body, const std::string& node, const Vec3& axis,
                    const Vec3& at, const std::string& place);

}  // namespace hilo
