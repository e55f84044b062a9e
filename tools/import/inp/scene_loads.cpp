// SPDX-License-Identifier: GPL-3.0-or-later
// The loads of a deck and its initial velocities, as scene lines.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/error.hpp"
#include "import/inp/scene.hpp"
#include "import/links.hpp"
#include "import/sheets.hpp"

namespace hilo {

void InpScene::gravity() {
  std::vector<Vec3> g(in_.mesh.shape.size(), Vec3::Zero());
  std::map<std::int64_t, Vec3> beside;  // what has mass without being a cell, by element
  for (const auto& [id, mass] : masses_)
    if (!turns(id)) beside[id] = Vec3::Zero();
  for (const auto& [id, beam] : d_.beams) beside[id] = Vec3::Zero();
  bool any = false, in_time = false;
  for (const auto& p : d_.distributed) {
    if (p.face != -1) continue;
    tell_turns(p);
    any = true, in_time = in_time || !p.amplitude.empty();
    const Vec3 more = p.value * p.direction;
    if (!p.target.empty() || !beside.contains(p.id))
      for (const auto c : inp_cells(d_, p)) g[static_cast<size_t>(c)] += more;
    for (const auto id : numbers_in(d_.elset, p))
      if (const auto one = beside.find(id); one != beside.end()) one->second += more;
  }
  const size_t n_cells = g.size();
  for (const auto& [id, x] : beside) g.push_back(x);
  if (!any || g.empty()) return;
  if (!in_time && std::ranges::all_of(g, [&](const Vec3& x) { return x == g.front(); })) {
    gravity_ = g.front() * si("m/s^2");
    return;
  }
  // what weighs in parts, or by a history, takes a load for each
  for (const auto& p : d_.distributed) {
    if (p.face != -1) continue;
    if (const auto ids = numbers_in(d_.elset, p); std::ranges::any_of(ids, [&](std::int64_t id) { return d_.beams.contains(id); }))
      in_.skip("*DLOAD GRAV on a part of the model, of beams", p.place);
    load_of_points(p, [&](const Vec3&) -> Vec3 { return p.value * p.direction; });
    if (n_cells > 0) load_of_mass(p, "acceleration", "gravity", {{"acceleration", p.value * p.direction * si("m/s^2")}});
  }
}

void InpScene::centrifugal() {
  std::map<std::int64_t, const InpDistributed*> spun;  // elements, by the first line that turns them
  for (const auto& p : d_.distributed) {
    if (p.face != -2 || p.value == 0) continue;
    const auto& first = *std::ranges::find_if(d_.distributed, [&](const InpDistributed& q) {
      return q.face == -2 && q.target == p.target && (!p.target.empty() || q.id == p.id);
    });
    if (!is_same_axis(first, p)) {  // as CalculiX does
      in_.skip("*DLOAD CENTRIF about another axis than the one before it, on the same elements", p.place);
      continue;
    }
    const auto ids = numbers_in(d_.elset, p);
    bool again = false;  // by another set
    for (const auto id : ids) again = spun.try_emplace(id, &first).first->second != &first || again;
    if (again) {
      in_.skip("*DLOAD CENTRIF on elements that one before it turns", p.place);
      continue;
    }
    if (std::ranges::any_of(ids, [&](std::int64_t id) { return d_.beams.contains(id); })) in_.skip("*DLOAD CENTRIF on beams", p.place);
    if (d_.plan.procedure == "*FREQUENCY") in_.skip("spin softening of *DLOAD CENTRIF in *FREQUENCY", p.place);
    tell_turns(p);
    load_of_mass(p, "centrifugal", "centrifugal", {{"at", point(p.at)}, {"axis", p.direction}, {"speed", std::sqrt(p.value) / si("s")}});
    load_of_points(p, [&](const Vec3& x) -> Vec3 {
      const Vec3 arm = x - p.at;
      return o_.scale * p.value * (arm - p.direction * p.direction.dot(arm));
    });
  }
}

/// A mass on a ROT NODE is an inertia, which has no weight.
bool InpScene::turns(std::int64_t mass) const { return d_.turns_of.contains(d_.points.at(mass).nodes[0]); }
void InpScene::tell_turns(const InpDistributed& p) {
  const auto ids = numbers_in(d_.elset, p);
  if (std::ranges::any_of(ids, [&](std::int64_t id) { return masses_.contains(id) && turns(id); }))
    in_.skip("*DLOAD GRAV or CENTRIF on a MASS of a ROT NODE", p.place);
}

/// On the masses among its elements: forces at their nodes, which such accelerations of theirs are.
void InpScene::load_of_points(const InpDistributed& p, const std::function<Vec3(const Vec3&)>& acceleration) {
  for (const auto id : numbers_in(d_.elset, p)) {
    const auto mass = masses_.find(id);
    if (mass == masses_.end() || turns(id)) continue;
    const auto node = d_.points.at(id).nodes[0];
    const Vec3 F = mass->second * acceleration(*point_of(d_, in_.mesh, node)) * si("N");
    const auto past = F.norm() == 0 ? std::nullopt : history(p.amplitude, "*DLOAD", p.place);
    if (!past || (!d_.bodies.contains(node) && !d_.node.contains(node))) continue;
    if (d_.bodies.contains(node)) {
      const std::string name = body_name(d_, node);
      scene_.add_unique({"load", "force"}, name, p.place,
                        {{"on", name}, {"force", F}, {"at", point(d_.bodies.at(node).X)}, {"history", *past}});
      continue;
    }
    const Rows row{d_.node.at(node)};
    const std::string set = set_of("", row, "force", true);
    scene_.add_unique(
        {"load", "force"}, set, p.place,
        {{"on", set}, {"force", F / static_cast<double>(by_number_of_nodes(row).begin()->first)}, {"per_node", true}, {"history", *past}});
  }
}

/// On the regions that a line has whole, and on a set of the other cells.
void InpScene::load_of_mass(const InpDistributed& p, const char* kind, const std::string& wish, std::initializer_list<SceneKey> keys) {
  auto cells = inp_cells(d_, p);
  const auto past = cells.empty() ? std::nullopt : history(p.amplitude, "*DLOAD", p.place);
  if (!past) return;
  const Mesh& m = in_.mesh;
  std::vector<std::int64_t> of_region(m.region_name.size(), 0), here(m.region_name.size(), 0);
  for (const auto r : m.region) ++of_region[static_cast<size_t>(r)];
  sort_unique(cells);
  for (const auto c : cells) ++here[static_cast<size_t>(m.region[static_cast<size_t>(c)])];
  std::vector<std::string> on;
  for (size_t r = 0; r < here.size(); ++r)
    if (here[r] > 0 && here[r] == of_region[r]) on.push_back(m.region_name[r]);
  std::erase_if(cells, [&](std::int64_t c) {
    const auto r = static_cast<size_t>(m.region[static_cast<size_t>(c)]);
    return here[r] == of_region[r];
  });
  if (!cells.empty()) on.push_back(names_.cells(fmt::format("{}_{}", wish, ++made_[wish]), cells));
  for (const std::string& name : on) {
    SceneTable& load = scene_.add_unique({"load", kind}, name + "_" + wish, p.place, {{"on", name}});
    for (const auto& [key, value] : keys) load.set(key, value);
    load.set("history", *past);
  }
}

void InpScene::forces() {
  for (const auto& g : nodal_groups(d_, d_.forces, "*CLOAD", true, turned_, in_)) {
    const auto past = g.value.norm() == 0 ? std::nullopt : history(g.amplitude, "*CLOAD", g.place);
    if (!past) continue;
    for (const auto& [n, nodes] : by_number_of_nodes(g.nodes)) {
      const std::string set = set_of(g.target, nodes, "force", true);
      scene_.add_unique({"load", "force"}, set, g.place,
                        {{"on", set}, {"force", g.value * si("N") / static_cast<double>(n)}, {"per_node", true}, {"history", *past}});
    }
  }
}

/// Nodes by how many they become: one of shells a pair for each sheet, each of which takes its share.
std::map<size_t, Rows> InpScene::by_number_of_nodes(const Rows& nodes) {
  std::map<size_t, Rows> out;
  for (const auto a : nodes) {
    size_t n = 1;
    if (const auto& sheets = sheets_at(in_, a); !sheets.empty()) n = in_.nodes_counted[a] = count_nodes(sheets, of_solids_.contains(a));
    out[n].push_back(a);
  }
  return out;
}

/// Forces and moments at reference nodes: on the body, or shared by the nodes of a distributing coupling.
void InpScene::forces_of_ties() {
  struct Sum {
    Vec3 F = Vec3::Zero(), M = Vec3::Zero();
    std::string place;
  };
  std::map<std::pair<std::int64_t, std::string>, Sum> sums;  // of node and amplitude
  std::map<std::pair<int, std::string>, Sum> on_slide;
  for (const auto& f : d_.forces)
    tied_lines(d_, f, [&](std::int64_t id, int first, int) {
      if (const int slide = is_slide(d_, id) ? slide_of(d_, id, first) : -1; slide >= 0) {
        Sum& s = on_slide[{slide, f.amplitude}];
        s.F[first - 1] += f.value;
        if (s.place.empty()) s.place = f.place;
        return;
      }
      if (is_slide(d_, id)) return in_.skip("*CLOAD on a node of no cell", f.place);
      Mat3 axes = Mat3::Identity();
      if (d_.bodies.contains(id))
        axes = axes_of(id);
      else if (own_axes_.contains(id))
        axes.setZero();
      if (axes.isZero()) return in_.skip("*CLOAD in axes of *TRANSFORM", f.place);
      Sum& s = sums[{id, f.amplitude}];
      (first > 3 ? s.M : s.F) += f.value * axes.col((first - 1) % 3);
      if (s.place.empty()) s.place = f.place;
    });
  for (const auto& [key, s] : on_slide) {
    const std::string name = slide_name(d_, key.first);
    if (const auto past = s.F.norm() > 0 ? history(key.second, "*CLOAD", s.place) : std::nullopt)
      scene_.add_unique({"load", "force"}, name, s.place, {{"on", name}, {"force", s.F * si("N")}, {"history", *past}});
  }
  for (const auto& [key, s] : sums) {
    const auto past = history(key.second, "*CLOAD", s.place);
    if (!past) continue;
    if (d_.bodies.contains(key.first)) {
      const std::string name = body_name(d_, key.first);
      if (s.F.norm() > 0)
        scene_.add_unique({"load", "force"}, name, s.place,
                          {{"on", name}, {"force", s.F * si("N")}, {"at", point(d_.bodies.at(key.first).X)}, {"history", *past}});
      Vec3 M = s.M;
      if (is_of_pairs(d_, in_, key.first) && !of_beams_.contains(key.first))
        if (const auto& sheets = sheets_at(in_, d_.node.at(key.first)); is_flat(sheets) && drop_drilling(sheets, M))
          in_.skip("*CLOAD: a moment about the normal of a shell, which does not resist it", s.place);
      if (M.norm() > 0)
        scene_.add_unique({"load", "torque"}, name + "_torque", s.place, {{"on", name}, {"torque", M * si("N m")}, {"history", *past}});
      continue;
    }
    const InpMean& mean = d_.means.at(key.first);
    std::vector<Vec3> points;
    std::vector<double> weights;
    Rows rows;
    for (const auto& [a, w] : mean.of) rows.push_back(a), points.push_back(in_.mesh.X[a]), weights.push_back(w);
    const auto shares = shares_of_mean(points, weights, mean.X, s.F, s.M / o_.scale);  // the moment stays, lengths are scaled
    if (!shares) {
      in_.skip("*CLOAD that the nodes of a distributing coupling cannot carry", s.place);
      continue;
    }
    for (size_t i = 0; i < rows.size(); ++i)
      if (shares->forces[i].norm() > 0) {
        const auto n = static_cast<double>(by_number_of_nodes({rows[i]}).begin()->first);
        const std::string set = set_of("", {rows[i]}, "share", true);
        scene_.add_unique({"load", "force"}, set, s.place,
                          {{"on", set}, {"force", shares->forces[i] * si("N") / n}, {"per_node", true}, {"history", *past}});
      }
  }
}

/// PX, PY, PZ: forces per length of beams.
void InpScene::line_loads() {
  for (const auto& p : d_.distributed) {
    if (p.face != -4 || p.value == 0) continue;
    const auto past = history(p.amplitude, "*DLOAD", p.place);
    if (!past) continue;
    std::int64_t others = 0;
    for (const auto id : numbers_in(d_.elset, p)) {
      const auto b = d_.beams.find(id);
      if (b == d_.beams.end()) {
        ++others;
        continue;
      }
      const std::string name = fmt::format("{}_{}", b->second.type, id);
      const bool halves = b->second.nodes.size() == 3;
      for (const char* half : {"a", "b"})
        if (halves || *half == 'a')
          scene_.add_unique(
              {"load", "line"}, name + "_line", p.place,
              {{"on", halves ? name + half : name}, {"force_per_length", p.value * p.direction * si("N/m")}, {"history", *past}});
    }
    if (others > 0) in_.skip("*DLOAD PX, PY, PZ on elements that are no beams of the scene", p.place, others);
  }
}

namespace {
/// Of facets in planes that are parallel; a shell is a facet itself.
std::optional<Vec3> normal_of(const Mesh& mesh, const std::vector<Facet>& facets) {
  std::optional<Vec3> out;
  for (const Facet& f : facets) {
    const auto cell = mesh.cell(f.cell);
    const auto X = [&](int a) { return mesh.X[static_cast<size_t>(cell[static_cast<size_t>(a)])]; };
    const ShapeInfo& shape = info(mesh.shape[static_cast<size_t>(f.cell)]);
    const Vec3 area = shape.dimension == 2 ? Vec3((X(1) - X(0)).cross(X(2) - X(0))) : facet_area(mesh, f),
               n = (is_mirrored(mesh, f.cell) ? -1 : 1) * area.normalized();
    if (out && !((n - *out).norm() < 1e-6)) return std::nullopt;
    out = n;
  }
  return out;
}
}  // namespace

void InpScene::pressures() {
  struct Group {
    std::string wish, name, amplitude, place;
    double value;
    std::vector<Facet> facets;
    bool below = false;  // of shells: against their normals
    std::set<std::pair<std::int64_t, int>> has = {};
  };
  std::vector<Group> groups;  // what is said twice counts twice
  const auto add = [&](const Group& g, const Facet& f) {
    Group* to = nullptr;
    for (auto& old : groups)
      if (old.name.empty() && old.wish == g.wish && old.amplitude == g.amplitude && old.value == g.value && old.below == g.below &&
          !old.has.contains({f.cell, f.facet}))
        to = &old;
    if (!to) to = &groups.emplace_back(g);
    to->facets.push_back(f), to->has.insert({f.cell, f.facet});
  };
  for (const auto& p : d_.distributed) {
    if (p.face == -1 || p.face == -2 || p.face == -4) continue;
    if (p.face == 0) {
      const auto s = surface_.find(p.target);
      if (s == surface_.end()) throw Error(p.place, fmt::format("*DSLOAD: no element surface \"{}\"", p.target));
      if (s->second.empty())
        in_.skip("*DSLOAD on a surface of no face", p.place);
      else
        groups.push_back({"", s->second, p.amplitude, p.place, p.value, {}});
      continue;
    }
    const auto cells = inp_cells(d_, p);
    const bool has_beams =
        !p.target.empty() && std::ranges::any_of(numbers_in(d_.elset, p), [&](auto id) { return d_.beams.contains(id); });
    if (cells.empty() || has_beams) in_.skip("*DLOAD on elements that are no cells", p.place);
    const std::string of_set = p.target.empty() ? std::string() : d_.elset.at(p.target).name + "_P";
    const auto is_shell = [&](auto c) { return info(in_.mesh.shape[static_cast<size_t>(c)]).dimension == 2; };
    const auto on_shell = [&](auto c) {  // along its normal: half of it on each face is that on the middle
      const double half = in_.sheets ? 0.5 : 1;
      add({of_set, "", p.amplitude, p.place, -half * p.value, {}}, {c, 0});
      if (in_.sheets) add({of_set.empty() ? "" : of_set + "_below", "", p.amplitude, p.place, half * p.value, {}, true}, {c, 0});
    };
    if (p.face == -3) {
      for (const auto c : cells) {
        if (!is_shell(c))
          throw Error(p.place, fmt::format("*DLOAD: element {} is no shell", in_.mesh.cell_id[static_cast<size_t>(c)]),
                      "P1 to P6 of a solid");
        on_shell(c);
      }
      continue;
    }
    const Group g{of_set.empty() ? "" : fmt::format("{}{}", of_set, p.face), "", p.amplitude, p.place, p.value, {}};
    for (const auto c : cells) {
      if (is_shell(c)) {  // CalculiX takes P1 to P6 of a shell as P
        on_shell(c);
        continue;
      }
      if (d_.pyramids.contains(in_.mesh.cell_id[c]))
        throw Error(p.place, fmt::format("*DLOAD: element {} is a pyramid, whose faces by number are not read", in_.mesh.cell_id[c]));
      const int f = inp_facet(static_cast<Shape>(in_.mesh.shape[c]), p.face);
      if (f < 0) throw Error(p.place, fmt::format("*DLOAD: element {} has no face P{}", in_.mesh.cell_id[c], p.face));
      add(g, {c, f});
    }
  }
  for (auto& g : groups) {
    const auto past = history(g.amplitude, "*DLOAD", g.place);
    if (!past) continue;
    if (g.name.empty()) g.name = names_.facets(g.wish.empty() ? fmt::format("pressure_{}", ++made_["pressure"]) : g.wish, g.facets);
    if (g.name.empty()) continue;
    if (g.below) in_.below.insert(g.name);
    if (d_.plan.sweep.points > 0) {  // what shakes follows no face: with a stiffness of its own it would change the modes
      if (const std::optional<Vec3> n = normal_of(in_.mesh, g.facets)) {
        scene_.add_unique({"load", "traction"}, g.name, g.place,
                          {{"on", g.name}, {"traction", (g.below ? g.value : -g.value) * si("Pa") * *n}, {"history", *past}});
        continue;
      }
      in_.notes.push_back(fmt::format("{}: a pressure on faces that are not plane follows them, which changes the modes", g.place));
    }
    scene_.add_unique({"load", "pressure"}, g.name, g.place, {{"on", g.name}, {"pressure", g.value * si("Pa")}, {"history", *past}});
  }
}

/// A later [[initial]] has all three components of its nodes: where lines overlap, each node has one of all of them.
void InpScene::velocities() {
  for (const auto& g : nodal_groups(d_, apart(d_, d_.velocities, 0, true), "*INITIAL CONDITIONS, TYPE=VELOCITY", false, turned_, in_))
    scene_.add("initial", "", g.place,
               {{"on", std::vector{set_of(g.target, g.nodes, "velocity", false)}}, {"velocity", g.value * si("m/s")}});
}
}  // namespace hilo
