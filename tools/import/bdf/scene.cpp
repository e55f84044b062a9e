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
    if (!in.cases.empty()) made_.insert("set/" + name), made_.insert("facets/" + name);  // of the subcases before
  Eigen::AlignedBox3d box;
  for (const auto a : in.mesh.nodes) box.extend(X(a));
  for (const auto& b : deck.beams)
    for (const auto grid : b.nodes) box.extend(X(row(grid, b.place, b.card)));
  size_ = box.diagonal().norm();
  for (std::int64_t c = 0; c < in.mesh.n_cells() && in.sheets; ++c)
    if (info(in.mesh.shape[c]).dimension != 2) of_solids_.insert(in.mesh.cell(c).begin(), in.mesh.cell(c).end());
}

std::string BdfScene::text() {
  choose_loads();
  hold();
  find_masses();
  find_bodies();
  gravity();
  rotation();
  materials();
  bodies();
  beams();
  rotation_of_bodies();
  rigid();
  springs();
  supports();
  varying_pressures();
  nodal_loads();
  pressures();
  line_loads();
  pairs();
  time();
  if (tables_.empty() && head_.empty()) return "";
  std::string s = "units = \"m-kg-s\"\n";
  if (!deck_.chosen.title.empty()) s = fmt::format("title = {}\n", toml_text(deck_.chosen.title)) + s;
  return s + head_ + tables_;
}

std::string BdfScene::unique(const std::string& section, const std::string& wish) {
  std::string name = wish;
  for (int i = 2; !made_.insert(section + "/" + name).second; ++i) name = fmt::format("{}_{}", wish, i);
  return name;
}

std::string BdfScene::set_of(Rows nodes, const std::string& wish, bool listed) {
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  const bool apart = listed && (options_.order == 2 || (options_.thicken && is_divided(in_)));
  if (set_by_rows_.empty())
    for (const auto& [name, set] : in_.mesh.node_sets) {
      Rows of_cells;
      for (const auto a : set)
        if (used_[static_cast<size_t>(a)]) of_cells.push_back(a);
      if (!of_cells.empty()) set_by_rows_.try_emplace(of_cells, name);
    }
  if (const auto known = set_by_rows_.find(nodes); known != set_by_rows_.end() && !apart) return known->second;
  const std::string name = names_.nodes(unique("set", wish), nodes);
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

void BdfScene::joint(unsigned components, const Mat3& axes, const std::string& name, const std::string& a, const std::string& b,
                     const Vec3& at, const std::string& place) {
  tables_ += joints_that_hold(components, axes, name, a, b, point(at), place,
                              [this](const std::string& section, const std::string& wish) { return unique(section, wish); });
}

void BdfScene::materials() {
  const Mesh& m = in_.mesh;
  std::map<std::int64_t, std::int64_t> property_of;  // region -> its first property
  for (size_t c = 0; c < deck_.cells.size(); ++c) property_of.try_emplace(m.region[c], deck_.cells[c].property);
  if (in_.sheets) {  // shells that become solids
    std::unordered_map<std::int64_t, std::int64_t> of_shell;
    for (const auto& s : deck_.shells) of_shell.try_emplace(s.id, s.property);
    for (size_t c = deck_.cells.size(); c < m.cell_id.size(); ++c)
      if (const auto s = of_shell.find(m.cell_id[c]); s != of_shell.end()) property_of.try_emplace(m.region[c], s->second);
  }
  std::set<std::int64_t> used;
  std::string lines;
  for (const auto& [r, property] : property_of) {
    const std::string region = toml_text(m.region_name[static_cast<size_t>(r)]);
    const auto mid = deck_.material_of.find(property);
    const auto mat = mid == deck_.material_of.end() ? deck_.materials.end() : deck_.materials.find(mid->second);
    if (mat == deck_.materials.end()) {
      in_.notes.push_back(mid == deck_.material_of.end() ? fmt::format("region {}: no property {}, so no material", region, property)
                                                         : fmt::format("region {}: no material {}", region, mid->second));
      continue;
    }
    const auto area = deck_.area_of.find(property);
    std::string keys = area != deck_.area_of.end() && area->second > 0
                           ? fmt::format("area = {}\n", number(area->second * options_.scale * options_.scale, "m^2"))
                           : "";
    if (!mat->second.no_law.empty()) {
      lines += fmt::format("\n# region {}: material {} has no law here ({}), give it one\n", region, mat->first, mat->second.no_law);
    } else if (mat->second.kind == "orthotropic") {
      keys = turned_material(property, mat->second) + keys;
    } else if (!mat->second.elastic()) {
      used.insert(mat->first);
      keys = fmt::format("material = {}\n", toml_text(mat->second.name)) + keys;
      in_.notes.push_back(fmt::format("region {}: its material \"{}\" ({}) stands in the scene lines alone (--scene-out)", region,
                                      mat->second.name, mat->second.kind));
    }
    if (!keys.empty()) lines += fmt::format("\n[region.{}]\n", region) + keys;
  }
  for (const auto id : used) tables_ += deck_.materials.at(id).table(deck_.materials.at(id).name, options_.units);
  tables_ += lines;
}

/// MAT8 of shells that lie in one plane, with its axes there; without a law where they or the layers turn.
std::string BdfScene::turned_material(std::int64_t property, const DeckMaterial& m) {
  const auto none = [&](const std::string& what, const std::string& place) {
    in_.skip(what, place);
    return fmt::format("# material {} has no law here ({}, {})\n", m.name, what, place);
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
  tables_ += law.table(law.name, options_.units);
  return fmt::format("material = {}\n", toml_text(clean_name(law.name)));
}

/// What the supports of the subcase hold.
void BdfScene::hold() {
  std::vector<std::int64_t> sets;
  const BdfCase& chosen = deck_.chosen;
  const auto is_there = [&](std::int64_t id) { return deck_.supports.contains(id) || deck_.support_sums.contains(id); };
  if (chosen.spc >= 0 && !is_there(chosen.spc)) in_.skip(fmt::format("SPC = {}, of which there is none", chosen.spc), "case control");
  std::int64_t take = chosen.spc;
  if (take < 0 && chosen.load < 0 && !chosen.any) {  // no case control: one set is meant
    if (deck_.support_sums.size() == 1)
      take = deck_.support_sums.begin()->first;
    else if (deck_.supports.size() == 1)
      take = deck_.supports.begin()->first;
  }
  if (const auto sum = deck_.support_sums.find(take); sum != deck_.support_sums.end())
    sets = sum->second.sets;
  else if (take >= 0)
    sets = {take};
  for (const auto& [id, lines] : deck_.supports)
    if (std::find(sets.begin(), sets.end(), id) == sets.end())
      in_.skip("SPC of a set that the first subcase does not use", lines.front().place, static_cast<std::int64_t>(lines.size()));

  for (size_t a = 0; a < deck_.grids.size(); ++a)
    if (const std::string& always = deck_.grids[a].held; !always.empty()) {
      Held& h = held_[static_cast<std::int64_t>(a)];
      h.place = deck_.grids[a].place;
      for (const char c : always)
        if (c >= '1' && c <= '6') h.bits |= 1u << (c - '1');
    }
  for (const auto id : sets) {
    const auto lines = deck_.supports.find(id);
    if (lines == deck_.supports.end()) {
      if (const auto sum = deck_.support_sums.find(take); sum != deck_.support_sums.end())
        in_.skip(fmt::format("SPCADD of set {}, of which there is none", id), sum->second.place);
      continue;
    }
    for (const BdfSupport& s : lines->second)
      for (const auto grid : s.grids) {
        const auto a = deck_.row.find(grid);
        if (a == deck_.row.end()) {
          in_.skip("SPC on a grid that is not there", s.place);
          continue;
        }
        Held& h = held_[a->second];
        if (h.place.empty()) h.place = s.place;
        h.bits |= s.components;
        for (size_t k = 0; k < 6; ++k)
          if (s.components >> k & 1) h.value[k] = s.value;
      }
  }
  for (const auto& [factor, l] : loads_) {
    if (l->kind != BdfLoad::Kind::displacement) continue;
    const auto h = held_.find(row(l->grid, l->place, "SPCD"));
    if (h == held_.end() || (l->components & ~h->second.bits)) {
      in_.skip("SPCD of a component that no SPC holds", l->place);
      continue;
    }
    for (size_t k = 0; k < 6; ++k)
      if (l->components >> k & 1) h->second.value[k] = factor * l->size;
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
          (k < 3 ? body.by.way : body.by.turn) += h.value[k] * (k < 3 ? si("m") : 1) * axes(a).col(static_cast<Eigen::Index>(k % 3));
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
  const auto parts = [](unsigned bits) {
    std::string s;
    for (unsigned k = 0; k < 3; ++k)
      if (bits >> k & 1) s += fmt::format("{}\"{}\"", s.empty() ? "" : ", ", "xyz"[k]);
    return s;
  };
  for (const auto& [bits, g] : fixed) {
    const std::string set = set_of(g.rows, "support");
    tables_ += fmt::format("\n[[motion]]   # {}\nkind = \"fixed\"\nname = {}\non = {}\ncomponents = [{}]\n", g.place,
                           toml_text(unique("motion", set)), toml_text(set), parts(bits));
  }
  for (const auto& [key, g] : moved) {
    const std::string set = set_of(g.rows, "moved");
    tables_ += fmt::format("\n[[motion]]   # {}\nkind = \"translation\"\nname = {}\non = {}\ncomponents = [{}]\ndisplacement = {}\n",
                           g.place, toml_text(unique("motion", set)), toml_text(set), parts(key.first),
                           list(Vec3(key.second[0], key.second[1], key.second[2]), "m"));
  }
  for (const Askew& h : askew) {
    const std::string node = node_set(h.row);
    tables_ += fmt::format("\n[[joint]]   # {}\nkind = \"in-plane\"\nname = {}\nb = {}\nat = {}\naxis = {}\n", h.place,
                           toml_text(unique("joint", node + "_support")), toml_text(node), point(X(h.row)), direction(h.axis));
  }
  supports_of_bodies();
}

/// A body is held by a joint to the ground, or whole.
void BdfScene::supports_of_bodies() {
  for (const auto& [a, held] : body_held_) {
    const std::string name = end_name(a), place = deck_.grids[static_cast<size_t>(a)].place;
    std::string to = "ground";
    if (held.bits == 63) {
      tables_ += motion_of_body(unique("motion", name), name, held.by, point(X(a)), "", place);
      continue;
    }
    if (held.by.any()) tables_ += moving_body(to = unique("body", name + "_moved"), held.by, point(X(a)), "", place);
    joint(held.bits, axes(a), name + "_support", to, name, X(a), place);
  }
}

void BdfScene::time() {
  const BdfCase& c = deck_.chosen;
  const auto is = [&](std::initializer_list<const char*> words) {
    return std::any_of(words.begin(), words.end(), [&](const char* w) { return c.solution == w; });
  };
  if (c.is_static()) {
    const bool linear = !c.solution.starts_with("106") && !c.solution.starts_with("NL");
    tables_ += fmt::format("\n[time]{}\nanalysis = \"static\"\n",
                           linear ? "   # linear in the deck; here displacements may be large, and loads act on the deformed shape" : "");
  } else if (is({"103", "3", "SEMODES", "MODES", "NORMAL"})) {
    tables_ += "\n[time]\nanalysis = \"modes\"\n";
    const auto n = deck_.modes.find(c.method);
    if (n != deck_.modes.end() && n->second > 0) tables_ += fmt::format("modes = {}\n", n->second);
  } else if (is({"109", "9", "SEDTRAN", "129", "NLTRAN"}) && deck_.steps.contains(c.step)) {
    const auto& [end, step] = deck_.steps.at(c.step);
    if (end > 0 && step > 0) tables_ += fmt::format("\n[time]\nend = {}\nstep = {}\n", number(end, "s"), number(step, "s"));
  } else if (c.buckles()) {
    tables_ += "\n[time]\nanalysis = \"buckling\"\n";
    const auto n = deck_.modes.find(c.method);
    if (n != deck_.modes.end() && n->second > 0) tables_ += fmt::format("modes = {}\n", n->second);
  } else if (!c.solution.empty())
    in_.skip("SOL " + c.solution.substr(0, 20), "executive control");
}

void write_bdf_scene(const BdfDeck& deck, Imported& in, SetNames& names, const ImportOptions& options) {
  in.mesh.deck_scene = BdfScene(deck, in, names, options).text();
}

}  // namespace hilo
