// SPDX-License-Identifier: GPL-3.0-or-later
// Materials, supports and the analysis of a Nastran file as scene lines.
#include "import/bdf/scene.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "base/error.hpp"

namespace hilo {

BdfScene::BdfScene(const BdfDeck& deck, Imported& in, SetNames& names, const ImportOptions& options)
    : deck_(deck), in_(in), names_(names), options_(options), used_(deck.X.size(), 0) {
  for (const auto a : in.mesh.nodes) used_[static_cast<size_t>(a)] = 1;
  for (const auto& name : in.mesh.all_names())
    if (!in.cases.empty()) scene_.take("set", name), scene_.take("facets", name);  // of the subcases before
  for (const auto& s : deck.shells) shell_.try_emplace(s.id, &s);
  Eigen::AlignedBox3d box;
  for (const auto a : in.mesh.nodes) box.extend(X(a));
  const auto add = [&](std::int64_t grid) {
    if (const auto a = deck.row.find(grid); a != deck.row.end()) box.extend(X(a->second));
  };
  for (const auto& b : deck.beams) std::ranges::for_each(b.nodes, add);
  for (const auto& r : deck.rigid) add(r.hub), std::ranges::for_each(r.grids, add);
  for (const auto& s : deck.springs) std::ranges::for_each(s.grids, add);
  for (const auto& m : deck.masses) add(m.grid);
  if (!box.isEmpty() && box.diagonal().norm() > 0) size_ = box.diagonal().norm();
  for (std::int64_t c = 0; c < in.mesh.n_cells() && in.sheets; ++c)
    if (info(in.mesh.shape[c]).dimension != 2) of_solids_.insert(in.mesh.cell(c).begin(), in.mesh.cell(c).end());
}

SceneWriter BdfScene::write() {
  choose_loads();
  hold();
  find_masses();
  find_bodies();
  gravity();
  each(BdfLoad::Kind::rotation, &BdfScene::rotation);
  materials();
  bodies();
  beams();
  rotation_of_bodies();
  rigid();
  springs();
  supports();
  each(BdfLoad::Kind::pressure, &BdfScene::varying_pressure);
  nodal_loads();
  pressures();
  each(BdfLoad::Kind::line, &BdfScene::line_load);
  pairs();
  time();
  scene_.begin(deck_.chosen.title, gravity_);
  return scene_;
}

std::string BdfScene::set_of(Rows nodes, const std::string& wish, bool listed) {
  sort_unique(nodes);
  const bool apart = listed && (options_.order == 2 || options_.merge || (options_.thicken && is_divided(in_)));
  if (set_by_rows_.empty())
    for (const auto& [name, set] : in_.mesh.node_sets) {
      Rows of_cells;
      for (const auto a : set)
        if (used_[static_cast<size_t>(a)]) of_cells.push_back(a);
      if (!of_cells.empty()) set_by_rows_.try_emplace(of_cells, name);
    }
  if (const auto known = set_by_rows_.find(nodes); known != set_by_rows_.end() && !apart) return known->second;
  const std::string name = names_.nodes(scene_.unique("set", wish), nodes);
  if (apart)
    in_.as_listed.insert(name);
  else
    set_by_rows_[nodes] = name;
  return name;
}

std::int64_t BdfScene::row(std::int64_t grid, const std::string& place, const std::string& who) const {
  const auto a = deck_.row.find(grid);
  if (a == deck_.row.end()) throw Error(place, fmt::format("{}: no GRID {}", who, grid));
  return a->second;
}

BdfScene::End BdfScene::end(std::int64_t row) const {
  if (row < 0) return End::ground;
  if (body_.contains(row)) return End::body;
  if (mean_.contains(row)) return End::mean;
  return used_[static_cast<size_t>(row)] ? End::node : End::nothing;
}

void BdfScene::materials() {
  const Mesh& m = in_.mesh;
  std::map<std::int64_t, std::int64_t> property_of;  // region -> its first property
  for (size_t c = 0; c < deck_.cells.size(); ++c) property_of.try_emplace(m.region[c], deck_.cells[c].property);
  if (in_.sheets) {  // shells that become solids
    for (size_t c = deck_.cells.size(); c < m.cell_id.size(); ++c)
      if (const auto s = shell_.find(m.cell_id[c]); s != shell_.end()) property_of.try_emplace(m.region[c], s->second->property);
  }
  std::set<std::int64_t> used, told_shear;
  SceneWriter regions;
  for (const auto& [r, property] : property_of) {
    const std::string& name = m.region_name[static_cast<size_t>(r)];
    const auto* mat = deck_.material(property);
    if (!mat) {
      const auto mid = deck_.material_of.find(property);
      in_.notes.push_back(mid == deck_.material_of.end()
                              ? fmt::format("region {}: no property {}, so no material", toml_text(name), property)
                              : fmt::format("region {}: no material {}", toml_text(name), mid->second));
      continue;
    }
    const DeckMaterial& law = mat->second;
    const auto area = deck_.area_of.find(property);
    const bool has_area = area != deck_.area_of.end() && area->second > 0, turned = law.no_law.empty() && law.kind == "orthotropic",
               told = law.no_law.empty() && !turned && !law.elastic();
    if (const auto G = deck_.other_shear.find(mat->first); G != deck_.other_shear.end() && !has_area && told_shear.insert(G->first).second)
      in_.skip("MAT1: a shear modulus that is not that of E and NU", G->second);
    if (!law.no_law.empty())
      regions.comment(fmt::format("\n# region {}: material {} has no law here ({}), give it one", toml_text(name), mat->first, law.no_law));
    if (!has_area && !turned && !told) continue;
    SceneTable& region = regions.add("region", name, "");
    if (turned) turned_material(property, law, region);
    if (told) {
      used.insert(mat->first);
      region.set("material", law.name);
      in_.notes.push_back(fmt::format("region {}: its material \"{}\" ({}) stands in the scene lines alone (--scene-out)", toml_text(name),
                                      law.name, law.kind));
    }
    if (has_area) region.set("area", area->second * options_.scale * options_.scale * si("m^2"));
  }
  for (const auto id : used) deck_.materials.at(id).write(scene_, options_);
  scene_.append(regions);
}

/// MAT8 of shells that lie in one plane, with its axes there; without a law where they or the layers turn.
void BdfScene::turned_material(std::int64_t property, const DeckMaterial& m, SceneTable& region) {
  const auto none = [&](const std::string& what, const std::string& place) {
    in_.skip(what, place);
    region.comment(fmt::format("material {} has no law here ({}, {})", m.name, what, place));
  };
  const auto thin = deck_.thin.find(property);
  if (thin == deck_.thin.end()) return none("MAT8 of cells that are no shells", "");
  if (!thin->second.turned_layers.empty()) return none("MAT8: layers of several directions", thin->second.turned_layers);
  Vec3 first = Vec3::Zero(), up = first;
  for (const auto& s : deck_.shells) {
    if (s.property != property) continue;
    std::vector<Vec3> x;
    for (const auto grid : s.nodes) x.push_back(X(row(grid, s.place, "shell")));
    const Vec3 normal = (x.size() == 3 ? (x[1] - x[0]).cross(x[2] - x[0]) : (x[2] - x[0]).cross(x[3] - x[1])).normalized();
    Vec3 along = s.material_system < 0 ? Vec3(x[1] - x[0]) : Vec3(axes_at(deck_, s.material_system, x[0], s.place).col(0));
    along = (along - normal * normal.dot(along)).normalized();
    const double turn = (s.theta + thin->second.angle) * std::numbers::pi / 180;
    along = std::cos(turn) * along + std::sin(turn) * normal.cross(along);
    if (first == Vec3::Zero()) first = along, up = normal;
    if (std::abs(along.dot(first)) < 1 - 1e-6 || std::abs(normal.dot(up)) < 1 - 1e-6)
      return none("MAT8: shells whose directions differ within a property", s.place);
  }
  DeckMaterial law = m;
  const Vec3 second = up.cross(first);
  law.name = fmt::format("{}_pid_{}", m.name, property);
  law.set({"axis_1", {first.x(), first.y(), first.z()}, "1", true});
  law.set({"axis_2", {second.x(), second.y(), second.z()}, "1", true});
  law.write(scene_, options_);
  region.set("material", clean_name(law.name));
}

/// What the supports of the subcase hold.
void BdfScene::hold() {
  const BdfCase& chosen = deck_.chosen;
  const auto& all = deck_.supports;
  if (chosen.spc >= 0 && !all.has(chosen.spc)) in_.skip(fmt::format("SPC = {}, of which there is none", chosen.spc), "case control");
  const auto take = chosen.spc < 0 && chosen.load < 0 && !chosen.any ? all.only() : chosen.spc;
  const BdfSum* sum = all.sum(take);
  const BdfSum taken = sum ? *sum : BdfSum{1, {{1, take}}, ""};
  for (const auto& [id, lines] : all.lines)
    if (std::ranges::find(taken.parts, std::pair(1., id)) == taken.parts.end())
      in_.skip("SPC of a set that the subcase does not use", lines.front().place, static_cast<std::int64_t>(lines.size()));

  for (size_t a = 0; a < deck_.grids.size(); ++a)
    if (const std::string& always = deck_.grids[a].held; !always.empty()) {
      Held& h = held_[static_cast<std::int64_t>(a)];
      h.place = deck_.grids[a].place;
      for (const char c : always)
        if (c >= '1' && c <= '6') h.bits |= 1u << (c - '1');
    }
  for (const auto& [factor, id] : taken.parts) {
    const auto lines = all.lines.find(id);
    if (lines == all.lines.end()) {
      if (sum) in_.skip(fmt::format("SPCADD of set {}, of which there is none", id), sum->place);
      continue;
    }
    for (const BdfSupport& s : lines->second)
      for (const auto grid : s.grids) {
        const auto a = deck_.row.find(grid);
        if (a == deck_.row.end())
          in_.skip("SPC on a grid that is not there", s.place);
        else
          held_[a->second].hold(s.components, s.value, s.place);
      }
  }
  std::map<std::int64_t, unsigned> driven;  // components by row
  for (const auto& [factor, l] : loads_) {
    if (l->kind != BdfLoad::Kind::displacement) continue;
    const auto h = held_.find(row(l->grid, l->place, "SPCD"));
    if (h == held_.end() || (l->components & ~h->second.bits)) {
      in_.skip("SPCD of a component that no SPC holds", l->place);
      continue;
    }
    if (auto& bits = driven[h->first]; bits & l->components)
      in_.skip("SPCD of a component that another one drives: the last holds", l->place);
    else
      bits |= l->components;
    h->second.hold(l->components, factor * l->size, l->place);
  }
}

void BdfScene::supports() {
  equations();
  struct Group {
    Rows rows;
    std::string place;
  };
  struct Askew {
    std::int64_t row;
    Vec3 axis;
    std::string place;
  };
  std::vector<Askew> askew;  // held along an axis that is none of the basic system
  std::map<unsigned, Group> fixed;
  std::map<std::pair<unsigned, std::array<double, 3>>, Group> moved;
  for (const auto& [a, h] : held_) {
    const End what = end(a);
    if (what == End::body) {
      HeldBody& body = body_held_[a];
      body.bits |= h.bits;
      int turns = 0;
      for (size_t k = 0; k < 6; ++k)
        if (h.bits >> k & 1) {
          (k < 3 ? body.by.way : body.by.turn) +=
              h.value[k] * (k < 3 ? options_.scale * si("m") : 1) * axes(a).col(static_cast<Eigen::Index>(k % 3));
          turns += k > 2 && h.value[k] != 0;
        }
      if (turns > 1) throw Error(h.place, "SPC turns the grid of a body about more than one axis, which is not read", "about one");
      continue;
    }
    if (what != End::node) {
      in_.skip(what == End::mean ? "SPC on the grid of an RBE3" : "SPC on a grid of no element", h.place);
      continue;
    }
    if (is_of_shell(a)) in_.held[a] = h.bits;
    const Mat3 own = axes(a);
    unsigned still = 0, moves = 0;
    std::array<double, 3> by{};
    const bool whole = (h.bits & 7) == 7 && h.value[0] == 0 && h.value[1] == 0 && h.value[2] == 0;
    for (Eigen::Index k = 0; k < 3 && !whole; ++k) {
      if (!(h.bits >> k & 1)) continue;
      Eigen::Index along;
      own.col(k).cwiseAbs().maxCoeff(&along);
      if (std::abs(own(along, k)) < 1 - 1e-12) {
        if (h.value[static_cast<size_t>(k)] == 0 && !is_of_shell(a))
          askew.push_back({a, own.col(k), h.place});
        else
          in_.skip("SPC along axes that are not those of the basic system", h.place);
        continue;
      }
      const double value = h.value[static_cast<size_t>(k)];
      (value == 0 ? still : moves) |= 1u << along;
      by[static_cast<size_t>(along)] = value * (own(along, k) < 0 ? -1 : 1);
    }
    if (whole) still = 7;
    const auto add = [&, a = a, &h = h](Group& g) {
      if (g.rows.empty()) g.place = h.place;
      g.rows.push_back(a);
    };
    if (still) add(fixed[still]);
    if (moves) add(moved[{moves, by}]);
  }
  for (const auto& [bits, g] : fixed) hold_set(scene_, set_of(g.rows, "support"), bits, {}, "", g.place);
  for (const auto& [key, g] : moved) hold_set(scene_, set_of(g.rows, "moved"), key.first, point(Vec3(key.second.data())), "", g.place);
  for (const Askew& h : askew) {
    const std::string node = node_set(h.row);
    joint_to_slide(scene_, node + "_support", "", node, h.axis, point(X(h.row)), h.place);
  }
  for (const auto& [a, h] : body_held_)
    hold_body(scene_, end_name(a), h.bits, axes(a), h.by, point(X(a)), "", deck_.grids[static_cast<size_t>(a)].place);
}

void BdfScene::time() {
  const BdfCase& c = deck_.chosen;
  const auto is = [&](std::initializer_list<const char*> words) {
    return std::any_of(words.begin(), words.end(), [&](const char* w) { return c.solution == w; });
  };
  const auto n = deck_.modes.find(c.method);
  const SceneValue modes = n != deck_.modes.end() && n->second > 0 ? SceneValue(n->second) : SceneValue();
  if (c.is_static()) {
    const bool linear = !c.solution.starts_with("106") && !c.solution.starts_with("NL");
    scene_.add("time", "", linear ? "linear in the deck; here displacements may be large, and loads act on the deformed shape" : "",
               {{"analysis", "static"}});
  } else if (c.finds_modes()) {
    scene_.add("time", "", "",
               {{"analysis", "modes"}, {"modes", modes}, {"start", c.loaded_at_rest ? SceneValue("equilibrium") : SceneValue()}});
  } else if (is({"109", "9", "SEDTRAN", "129", "NLTRAN"}) && deck_.steps.contains(c.step)) {
    const auto& [end, step] = deck_.steps.at(c.step);
    if (end > 0 && step > 0) scene_.add("time", "", "", {{"end", end * si("s")}, {"step", step * si("s")}});
  } else if (c.buckles()) {
    scene_.add("time", "", "", {{"analysis", "buckling"}, {"modes", modes}});
  } else if (!c.solution.empty())
    in_.skip("SOL " + c.solution.substr(0, 20), "executive control");
}

void write_bdf_scene(const BdfDeck& deck, Imported& in, SetNames& names, const ImportOptions& options) {
  in.scene = BdfScene(deck, in, names, options).write();
}

}  // namespace hilo
