// SPDX-License-Identifier: GPL-3.0-or-later
// What a deck holds, moves and ties, as scene lines.
#include <fmt/format.h>

#include <Eigen/Geometry>

#include "base/error.hpp"
#include "import/inp/scene.hpp"
#include "import/links.hpp"

namespace hilo {

void InpScene::supports() {
  std::vector<HeldAskew> askew;
  for (const auto& h : held_groups(d_, turned_, in_, askew)) hold(h);
  for (const HeldAskew& h : askew) {
    const std::string set = set_of("", {h.node}, "support", true);
    joint_to_slide(scene_, set, "", set, h.axis, point(in_.mesh.X[h.node]), h.place);
  }
}

void InpScene::hold(const Held& h) {
  const auto past = history(h.amplitude, "*BOUNDARY", h.place);
  if (!past) return;
  unsigned bits = 0;
  for (int k = 0; k < 3; ++k) bits |= static_cast<unsigned>(h.on[k]) << k;
  hold_set(scene_, set_of(h.target, h.nodes, "support", false), bits, h.moved ? std::optional<Vec3>(point(h.value)) : std::nullopt, *past,
           h.place);
}

/// What a joint of a node of cells names: its body, or the set of it.
std::string InpScene::end_of(std::int64_t row, const std::string& wish) {
  const auto body = in_.body_of_node.find(row);
  return body != in_.body_of_node.end() ? body->second : set_of("", {row}, wish, true);
}

/// Equal displacements: a body of no mass that slides along their axis, held or moved as a node of no cell among them is, and in whose
/// plane each node of a cell stays.
void InpScene::slides() {
  struct Held {
    bool is = false;
    double by = 0;
    std::string amplitude, place;
  };
  std::map<int, Held> held;
  for (const InpNodal& b : d_.supports)
    tied_lines(d_, b, [&](std::int64_t id, int first, int last) {
      for (int k = first; k <= std::min(last, 3); ++k)
        if (const int slide = is_slide(d_, id) ? slide_of(d_, id, k) : -1; slide >= 0)
          held[slide] = {true, b.value, b.value == 0 ? "" : b.amplitude, b.place};
    });
  for (size_t i = 0; i < d_.slides.size(); ++i) {
    const InpSlide& s = d_.slides[i];
    const std::string name = scene_.unique("body", slide_name(d_, static_cast<int>(i)));
    const Vec3 at = point(s.X), axis = Vec3::Unit(s.component - 1);
    Held& h = held[static_cast<int>(i)];
    if (const auto past = h.is ? history(h.amplitude, "*BOUNDARY", h.place) : std::nullopt) {
      massless_body(scene_, name, at, s.place);
      motion_of_body(scene_, scene_.unique("motion", name), name, {point(h.by * axis)}, at, *past, h.place);
    } else
      sliding_body(scene_, name, axis, at, s.place);
    for (const auto a : s.rows) {
      const std::string set = end_of(a, "equal");
      joint_to_slide(scene_, set, name, set, axis, point(in_.mesh.X[a]), s.place);
    }
  }
}

void InpScene::sums() {
  for (const InpSum& s : d_.sums) {
    std::vector<SumTerm> terms;
    if (std::ranges::any_of(s.bodies, [&](const auto& b) { return !d_.bodies.contains(b.id); })) {
      in_.skip("*EQUATION of a reference node of which nothing is made", s.place);
      continue;
    }
    bool turns = false;
    for (const auto& b : s.bodies) {
      const Vec3 X = d_.bodies.at(b.id).X, e = Vec3::Unit((b.component - 1) % 3);
      if (b.component > 3) {  // a small turn is what a point beside goes, over its distance
        const Vec3 beside = Vec3::Unit(b.component % 3);
        const double L = size_of(d_, in_.mesh);
        add_turn(scene_, terms, body_name(d_, b.id), point(X), point(X + L * beside), b.factor / L * e.cross(beside), s.place);
        turns = true;
      } else {
        terms.push_back({body_name(d_, b.id), point(X), b.factor * e});
      }
    }
    if (turns) in_.notes.push_back(fmt::format("{}: *EQUATION of turns holds for small ones: it has their sines", s.place));
    for (const auto& [a, way] : s.rows)
      if (way != Vec3::Zero()) terms.push_back({end_of(a, "equation"), point(in_.mesh.X[a]), way});
    for (const auto& [slide, factor] : s.slides) {
      const InpSlide& of = d_.slides[static_cast<size_t>(slide)];
      if (factor != 0) terms.push_back({slide_name(d_, slide), point(of.X), factor * Vec3::Unit(of.component - 1)});
    }
    joints_of_sum(scene_, terms, "equation", s.place);
  }
}

/// Of a body's supports and forces, as columns; zero where they are not read.
Mat3 InpScene::axes_of(std::int64_t id) const {
  if (!own_axes_.contains(id)) return Mat3::Identity();
  for (const auto& [turns, reference] : d_.turns_of)
    if (reference == id) return Mat3::Zero();  // its turns may have other axes than its displacements
  const InpTransform* of = nullptr;
  for (const InpTransform& t : d_.transformed)
    if (std::ranges::count(numbers_in(d_.nset, t), id)) of = &t;
  return of ? of->axes(d_.bodies.at(id).X) : Mat3(Mat3::Zero());
}

/// Reference nodes are held by joints to the ground or to what moves them, or whole.
void InpScene::supports_of_ties() {
  struct HeldBody {
    unsigned bits = 0;
    bool moves = false;
    std::string place, amplitude;  // of what moves it
    Prescribed by;
  };
  std::map<std::int64_t, HeldBody> held;
  for (const auto& b : d_.supports)
    tied_lines(d_, b, [&](std::int64_t id, int first, int last) {
      if (is_slide(d_, id)) return;
      if (!d_.bodies.contains(id)) return in_.skip("*BOUNDARY on the node of a distributing coupling", b.place);
      if (axes_of(id).isZero()) return in_.skip("*BOUNDARY in axes of *TRANSFORM", b.place);
      HeldBody& h = held[id];
      for (int k = first; k <= last; ++k) {
        h.bits |= 1u << (k - 1);
        (k > 3 ? h.by.turn : h.by.way)[(k - 1) % 3] = b.value * (k > 3 ? 1 : o_.scale * si("m"));
      }
      if ((h.by.turn.array() != 0).count() > 1)
        throw Error(b.place, "*BOUNDARY turns a reference node about more than one axis, which is not read", "about one");
      if (b.value != 0 && h.moves && h.amplitude != b.amplitude)
        throw Error(b.place, "*BOUNDARY moves a reference node by two amplitudes, which is not read", "one for all its components");
      if (b.value != 0) h.moves = true, h.amplitude = b.amplitude;
      if (h.place.empty()) h.place = b.place;
    });
  // a node of springs, dampers and masses alone has no turns
  std::set<std::int64_t> turning = of_beams_;
  for (const auto& [turns, reference] : d_.turns_of) turning.insert(reference);
  for (const auto& [id, b] : d_.bodies) {
    if (!b.carries.empty() || !b.bodies.empty()) turning.insert(id);
    for (const auto& [other, components] : b.bodies) turning.insert(other);
  }
  for (const auto& f : d_.forces)
    tied_lines(d_, f, [&](std::int64_t id, int first, int) {
      if (first > 3) turning.insert(id);
    });
  std::set<std::int64_t> of_points;
  for (const auto& [element, p] : d_.points) of_points.insert(p.nodes.begin(), p.nodes.end());
  for (const auto& [id, b] : d_.bodies)
    if (of_points.contains(id) && !turning.contains(id) && !d_.node.contains(id)) {
      HeldBody& h = held[id];
      h.bits |= 56;
      if (h.place.empty()) h.place = b.place;
    }
  for (auto& [id, h] : held) {
    const Mat3 axes = axes_of(id);
    h.by.way = axes * h.by.way, h.by.turn = axes * h.by.turn;
    if (const auto past = history(h.by.any() ? h.amplitude : "", "*BOUNDARY", h.place))
      hold_body(scene_, body_name(d_, id), h.bits, axes, h.by, point(d_.bodies.at(id).X), *past, h.place);
  }
}

}  // namespace hilo
