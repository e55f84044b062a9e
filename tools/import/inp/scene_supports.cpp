// SPDX-License-Identifier: GPL-3.0-or-later
// What a deck holds, moves and ties, as scene lines.
#include <fmt/format.h>

#include "base/error.hpp"
#include "import/inp/equations.hpp"
#include "import/inp/scene.hpp"
#include "import/inp/ties.hpp"
#include "import/links.hpp"

namespace hilo {

void InpScene::supports() {
  std::vector<HeldAskew> askew;
  for (const auto& h : held_groups(d_, turned_, in_, askew)) write(h);
  for (const HeldAskew& h : askew) {
    const std::string set = set_of("", {h.node}, "support", true);
    tables_ += fmt::format("\n[[joint]]   # {}\nkind = \"in-plane\"\nname = {}\nb = {}\nat = {}\naxis = {}\n", h.place,
                           toml_text(unique("joint", set)), toml_text(set), point(in_.mesh.X[h.node]), list(h.axis));
  }
}

void InpScene::write(const Held& h) {
  std::string past, parts;
  if (!history(h.amplitude, "*BOUNDARY", h.place, past)) return;
  for (int k = 0; k < 3; ++k)
    if (h.on[k]) parts += fmt::format("{}\"{}\"", parts.empty() ? "" : ", ", "xyz"[k]);
  const std::string set = set_of(h.target, h.nodes, "support", false);
  tables_ += fmt::format("\n[[motion]]   # {}\nkind = \"{}\"\nname = {}\non = {}\ncomponents = [{}]\n", h.place,
                         h.moved ? "translation" : "fixed", toml_text(unique("motion", set)), toml_text(set), parts);
  if (h.moved) tables_ += fmt::format("displacement = {}\n", list(Vec3(h.value * si("m")))) + past;
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
    const std::string name = unique("body", slide_name(d_, static_cast<int>(i)));
    const std::string at = point(s.X), axis = list(Vec3(Vec3::Unit(s.component - 1)));
    Held& h = held[static_cast<int>(i)];
    std::string past;
    const bool is_held = h.is && history(h.amplitude, "*BOUNDARY", h.place, past);
    tables_ += sliding_body(name, is_held ? "" : unique("joint", name), axis, at, s.place);
    if (is_held) {
      Prescribed by;
      by.way[s.component - 1] = h.by * si("m");
      tables_ += motion_of_body(unique("motion", name), name, by, at, past, h.place);
    }
    for (const auto a : s.rows) {
      const std::string set = end_of(a, "equal");
      tables_ += joint_to_slide(unique("joint", set), name, set, axis, point(in_.mesh.X[a]), s.place);
    }
  }
}

void InpScene::sums() {
  for (const InpSum& s : d_.sums) {
    std::vector<SumTerm> terms;
    for (const auto& [a, way] : s.rows)
      if (way != Vec3::Zero()) terms.push_back({end_of(a, "equation"), point(in_.mesh.X[a]), way});
    for (const auto& [slide, factor] : s.slides) {
      const InpSlide& of = d_.slides[static_cast<size_t>(slide)];
      if (factor != 0) terms.push_back({slide_name(d_, slide), point(of.X), factor * Vec3::Unit(of.component - 1)});
    }
    tables_ += joints_of_sum(terms, "equation", s.place,
                             [this](const std::string& section, const std::string& wish) { return unique(section, wish); });
  }
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
      if (own_axes_.contains(id)) return in_.skip("*BOUNDARY in axes of *TRANSFORM", b.place);
      HeldBody& h = held[id];
      for (int k = first; k <= last; ++k) {
        h.bits |= 1u << (k - 1);
        (k > 3 ? h.by.turn : h.by.way)[(k - 1) % 3] = b.value * (k > 3 ? 1 : si("m"));
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
  for (const auto& [id, h] : held) {
    const std::string name = body_name(d_, id), at = list(Vec3(d_.bodies.at(id).X * si("m") * o_.scale));
    std::string past, to = "ground";
    if (h.by.any() && !history(h.amplitude, "*BOUNDARY", h.place, past)) continue;
    if (h.bits == 63) {
      tables_ += motion_of_body(unique("motion", name), name, h.by, at, past, h.place);
      continue;
    }
    if (h.by.any()) tables_ += moving_body(to = unique("body", name + "_moved"), h.by, at, past, h.place);
    tables_ += joints_that_hold(h.bits, Mat3::Identity(), name + "_support", to, name, at, h.place,
                                [this](const std::string& section, const std::string& wish) { return unique(section, wish); });
  }
}

void InpScene::tied() {
  for (const InpTied& t : d_.tied) {
    const auto a = surface_.find(t.master), b = surface_.find(t.slave);
    if (a == surface_.end() || b == surface_.end()) {
      in_.skip(fmt::format("*TIE: no surface \"{}\"", a == surface_.end() ? t.master : t.slave), t.place);
      continue;
    }
    if (a->second.empty() || b->second.empty()) {
      in_.skip("*TIE of a surface of no face", t.place);
      continue;
    }
    if (!t.adjust)
      in_.notes.push_back(fmt::format("{}: *TIE, ADJUST=NO: nodes off the other surface are moved onto it all the same", t.place));
    tables_ += fmt::format("\n[[tie]]   # {}\nname = {}\na = {}\nb = {}\n", t.place, toml_text(unique("tie", clean_name(t.name))),
                           toml_text(a->second), toml_text(b->second));
    if (t.tolerance > 0) tables_ += fmt::format("gap = {}\n", num(t.tolerance * si("m") * o_.scale));
  }
}
}  // namespace hilo
