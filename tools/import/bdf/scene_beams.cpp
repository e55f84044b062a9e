// SPDX-License-Identifier: GPL-3.0-or-later
// CBAR and CBEAM as beams of the scene between the bodies of their grids.
#include <Eigen/Geometry>

#include "base/error.hpp"
#include "import/bdf/scene.hpp"
#include "import/links.hpp"

namespace hilo {
namespace {

bool have_scene_material(const std::array<DeckSection, 2>& ends, const DeckMaterial& m) {
  return has_scene_material(ends[0], m) && has_scene_material(ends[1], m);
}

}  // namespace

/// Sections and materials, the beams, and a common point of each grid that is a node of solids too, which does not turn.
void BdfScene::beams() {
  for (const auto& [factor, l] : loads_)
    if (l->kind == BdfLoad::Kind::line) by_beam_.emplace(l->elements.front(), l);
  std::set<std::int64_t> properties, materials;
  for (const auto& b : deck_.beams) {
    if (properties.insert(b.property).second) {
      const BdfThin& p = section_of_beam(deck_, b);
      const auto* mat = deck_.material(b.property);
      if (!mat) throw Error(p.place, fmt::format("property {} of beams has no material", b.property), "MAT1");
      const DeckMaterial& m = mat->second;
      if (m.kind != "stvk" || !m.no_law.empty()) in_.skip("MATS1 of beams, which are linear elastic", p.place);
      std::array<DeckSection, 2> ends{p.section, p.end.given() ? p.end : p.section};
      bool twistless = false;
      const bool alone = nothing_twists(b.property);
      for (DeckSection& s : ends)
        if (const SectionArea a = s.area(0.3, p.place); s.kind == "general" && !(a.J > 0)) {
          twistless = true;
          if (alone) std::ranges::find(s.sizes, "J", &std::pair<std::string, double>::first)->second = a.I1 + a.I2;
        }
      if (twistless)
        in_.notes.push_back(alone ? fmt::format("{}: property {} has no J, and its beams meet beams along their line alone: they do not "
                                                "twist (J = I1 + I2)",
                                                p.place, b.property)
                                  : fmt::format("{}: property {} has no J: a millionth of I1 + I2 is taken", p.place, b.property));
      sections_.emplace(b.property, ends);
      if (have_scene_material(ends, m) && materials.insert(mat->first).second) m.write(scene_, options_);
      for (size_t k = 0; k < (p.end.given() ? 2 : 1); ++k)
        write_section(scene_, clean_name(deck_.name_of(b.property)) + (k == 0 ? "" : "_end"), ends[k], ends[1 - k], m, options_, p.place);
    }
    beam(b);
  }
  for (const auto& [a, place] : on_beam_)
    if (used_[static_cast<size_t>(a)] && !is_of_shell(a))
      joint(7, Mat3::Identity(), end_name(a) + "_node", end_name(a), node_set(a), X(a), place);
}

/// Whether the beams of a property meet beams along their own line alone: a twist that no J resists is held there by Nastran (AUTOSPC).
bool BdfScene::nothing_twists(std::int64_t property) const {
  std::multimap<std::int64_t, Vec3> along;  // grid -> directions of its beams
  const auto direction = [&](const BdfDeck::Thin& b) {
    return Vec3(X(row(b.nodes[1], b.place, b.card)) - X(row(b.nodes[0], b.place, b.card))).normalized();
  };
  for (const auto& b : deck_.beams)
    for (const auto grid : b.nodes) along.emplace(grid, direction(b));
  for (const auto& b : deck_.beams)
    for (const auto grid : b.nodes)
      for (auto [it, end] = along.equal_range(grid); it != end && b.property == property; ++it)
        if (it->second.cross(direction(b)).norm() > 1e-6) return false;
  return true;
}

size_t BdfScene::MadeBeam::section(double s) const {
  return static_cast<size_t>(std::ranges::min_element(sections, {}, [&](double x) { return std::abs(x - s); }) - sections.begin());
}

/// The body that a section is.
std::string BdfScene::MadeBeam::body(size_t section) const {
  if (section == 0) return ends[0].empty() ? name + ".0" : ends[0];
  if (section + 1 == sections.size()) return ends[1].empty() ? name + ".end" : ends[1];
  return fmt::format("{}.{}", name, section);
}

/// Both ends, and between them where a PLOAD1 begins, ends or acts at a point.
std::vector<double> BdfScene::sections_of(const BdfDeck::Thin& b, double length) const {
  std::vector<double> out{0, length};
  const auto [first, behind] = by_beam_.equal_range(b.id);
  for (auto it = first; it != behind; ++it) {
    const BdfLoad* l = it->second;
    for (const double x : l->from_to) {
      const double s = l->as_share ? x * length : x, least = 1e-6 * length;
      if (!(s >= -least && s <= length + least))
        throw Error(l->place, fmt::format("PLOAD1: {:g} is not on the beam, which is {:g} long", x, l->as_share ? 1 : length));
      if (std::ranges::none_of(out, [&](double y) { return std::abs(y - s) <= least; })) out.push_back(s);
    }
  }
  std::ranges::sort(out);
  return out;
}

void BdfScene::beam(const BdfDeck::Thin& b) {
  const BdfBeamPlace at = place_of_beam(deck_, b);
  const double length = (at.b - at.a).norm();
  const std::vector<double> sections = sections_of(b, length);
  const DeckMaterial& m = deck_.material(b.property)->second;
  const std::string name = scene_.unique("beam", fmt::format("{}_{}", b.card, b.id)), section = clean_name(deck_.name_of(b.property));
  std::vector<Vec3> points;
  for (const double s : sections) points.push_back(point(s == length ? at.b : Vec3(at.a + s / length * (at.b - at.a))));
  std::array<std::string, 2> grids, ends;  // bodies; an end with a pin has a section of its own
  for (size_t k = 0; k < 2; ++k) {
    grids[k] = end_name(row(b.nodes[k], b.place, b.card));
    if (!b.pins[k]) ends[k] = grids[k];
  }
  scene_.add("beam", name, b.place,
             {{"points", points},
              {"cells", std::vector{1}},
              {"section", section},
              {"section_end", section_of_beam(deck_, b).end.given() ? section + "_end" : ""},
              {"material", have_scene_material(sections_.at(b.property), m) ? clean_name(m.name) : ""},
              {"orientation", at.up},
              {"a", ends[0]},
              {"b", ends[1]}});
  Mat3 own;  // x along, plane 1 holds y
  own.col(0) = (at.b - at.a).normalized();
  own.col(2) = own.col(0).cross(at.up).normalized();
  own.col(1) = own.col(2).cross(own.col(0));
  made_beams_[b.id] = {name, own, at.a, sections, ends, section_of_beam(deck_, b).section.shear_centre != std::array{0., 0.}};
  for (size_t k = 0; k < 2; ++k)
    if (b.pins[k])
      joint(63 & ~b.pins[k], own, name + (k == 0 ? "_pin_a" : "_pin_b"), grids[k], name + (k == 0 ? ".0" : ".end"), k == 0 ? at.a : at.b,
            b.place);
}

}  // namespace hilo
