// SPDX-License-Identifier: GPL-3.0-or-later
// The loads of a deck and its initial velocities, as scene lines.
#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "import/inp/equations.hpp"
#include "import/inp/scene.hpp"
#include "import/inp/ties.hpp"
#include "import/links.hpp"

namespace hilo {

void InpScene::gravity() {
  std::vector<Vec3> g(in_.mesh.shape.size(), Vec3::Zero());
  std::map<std::int64_t, Vec3> beside;  // what has mass without being a cell, by element
  for (const auto& [id, point] : d_.points)
    if (point.type == "MASS") beside[id] = Vec3::Zero();
  for (const auto& [id, beam] : d_.beams) beside[id] = Vec3::Zero();
  bool any = false, in_time = false;
  for (const auto& p : d_.distributed) {
    if (p.face != -1) continue;
    any = true, in_time = in_time || !p.amplitude.empty();
    const Vec3 more = p.value * p.direction;
    if (!p.target.empty() || !beside.contains(p.id))
      for (const auto c : inp_cells(d_, p.target, p.id, p.place)) g[static_cast<size_t>(c)] += more;
    for (const auto id : elements_of(p))
      if (const auto one = beside.find(id); one != beside.end()) one->second += more;
  }
  const size_t n_cells = g.size();
  for (const auto& [id, x] : beside) g.push_back(x);
  if (!any) return;
  if (!in_time && std::ranges::all_of(g, [&](const Vec3& x) { return x == g.front(); })) {
    head_ += fmt::format("gravity = {}\n", list(Vec3(g.front() * si("m/s^2"))));
    return;
  }
  // what weighs in parts, or by a history, takes a load for each
  for (const auto& p : d_.distributed) {
    if (p.face != -1) continue;
    if (const auto ids = elements_of(p); std::ranges::any_of(ids, [&](std::int64_t id) { return beside.contains(id); }))
      in_.skip("*DLOAD GRAV on a part of the model, of masses and beams", p.place);
    if (n_cells > 0)
      load_of_mass(p, "acceleration", "gravity", fmt::format("acceleration = {}\n", list(Vec3(p.value * p.direction * si("m/s^2")))));
  }
}

/// Numbers of the elements of a line.
std::vector<std::int64_t> InpScene::elements_of(const InpDistributed& p) const {
  if (p.target.empty()) return {p.id};
  const auto set = d_.elset.find(p.target);
  return set == d_.elset.end() ? std::vector<std::int64_t>{} : set->second.members;
}

void InpScene::centrifugal() {
  for (const auto& p : d_.distributed) {
    if (p.face != -2 || p.value == 0) continue;
    if (const auto ids = elements_of(p); std::ranges::any_of(ids, [&](std::int64_t id) { return d_.beams.contains(id); }))
      in_.skip("*DLOAD CENTRIF on beams", p.place);
    load_of_mass(p, "centrifugal", "centrifugal",
                 fmt::format("at = {}\naxis = {}\nspeed = {}\n", point(p.at), list(p.direction), num(std::sqrt(p.value) / si("s"))));
  }
}

/// On the regions that a line has whole, and on a set of the other cells.
void InpScene::load_of_mass(const InpDistributed& p, const char* kind, const std::string& wish, const std::string& what) {
  auto cells = inp_cells(d_, p.target, p.id, p.place);
  std::string past;
  if (cells.empty() || !history(p.amplitude, "*DLOAD", p.place, past)) return;
  const Mesh& m = in_.mesh;
  std::vector<std::int64_t> of_region(m.region_name.size(), 0), here(m.region_name.size(), 0);
  for (const auto r : m.region) ++of_region[static_cast<size_t>(r)];
  std::ranges::sort(cells);
  cells.erase(std::ranges::unique(cells).begin(), cells.end());
  for (const auto c : cells) ++here[static_cast<size_t>(m.region[static_cast<size_t>(c)])];
  std::vector<std::string> on;
  for (size_t r = 0; r < here.size(); ++r)
    if (here[r] > 0 && here[r] == of_region[r]) on.push_back(m.region_name[r]);
  std::erase_if(cells, [&](std::int64_t c) {
    const auto r = static_cast<size_t>(m.region[static_cast<size_t>(c)]);
    return here[r] == of_region[r];
  });
  if (!cells.empty()) on.push_back(names_.cells(fmt::format("{}_{}", wish, ++made_[wish]), cells));
  for (const std::string& name : on)
    tables_ += fmt::format("\n[[load]]   # {}\nkind = \"{}\"\nname = {}\non = {}\n{}", p.place, kind,
                           toml_text(unique("load", name + "_" + wish)), toml_text(name), what) +
               past;
}

void InpScene::forces() {
  for (const auto& g : nodal_groups(d_, d_.forces, "*CLOAD", true, turned_, in_)) {
    std::string past;
    if (g.value.norm() == 0 || !history(g.amplitude, "*CLOAD", g.place, past)) continue;
    const double share = share_of_pairs(g.nodes, g.place);
    const std::string set = set_of(g.target, g.nodes, "force", true);
    tables_ += fmt::format("\n[[load]]   # {}\nkind = \"force\"\nname = {}\non = {}\nforce = {}\nper_node = true\n", g.place,
                           toml_text(unique("load", set)), toml_text(set), list(Vec3(share * g.value * si("N")))) +
               past;
  }
}

/// 1/2 for nodes of shells that become pairs: each takes half.
double InpScene::share_of_pairs(const Rows& nodes, const std::string& place) const {
  if (!o_.thicken) return 1;
  const auto n = static_cast<size_t>(std::ranges::count_if(nodes, [&](std::int64_t a) { return is_of_shell(in_, a); }));
  if (n > 0 && n < nodes.size()) throw Error(place, "*CLOAD on nodes of shells and of others", "one line for each");
  return n > 0 ? 0.5 : 1;
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
      if (own_axes_.contains(id)) return in_.skip("*CLOAD in axes of *TRANSFORM", f.place);
      Sum& s = sums[{id, f.amplitude}];
      (first > 3 ? s.M : s.F)[(first - 1) % 3] += f.value;
      if (s.place.empty()) s.place = f.place;
    });
  for (const auto& [key, s] : on_slide) {
    const std::string name = slide_name(d_, key.first);
    std::string past;
    if (s.F.norm() > 0 && history(key.second, "*CLOAD", s.place, past))
      tables_ += fmt::format("\n[[load]]   # {}\nkind = \"force\"\nname = {}\non = {}\nforce = {}\n", s.place,
                             toml_text(unique("load", name)), toml_text(name), list(Vec3(s.F * si("N")))) +
                 past;
  }
  for (const auto& [key, s] : sums) {
    std::string past;
    if (!history(key.second, "*CLOAD", s.place, past)) continue;
    if (d_.bodies.contains(key.first)) {
      const std::string name = body_name(d_, key.first);
      if (s.F.norm() > 0)
        tables_ += fmt::format("\n[[load]]   # {}\nkind = \"force\"\nname = {}\non = {}\nforce = {}\nat = {}\n", s.place,
                               toml_text(unique("load", name)), toml_text(name), list(Vec3(s.F * si("N"))),
                               list(Vec3(d_.bodies.at(key.first).X * si("m") * o_.scale))) +
                   past;
      if (s.M.norm() > 0)
        tables_ += fmt::format("\n[[load]]   # {}\nkind = \"torque\"\nname = {}\non = {}\ntorque = {}\n", s.place,
                               toml_text(unique("load", name + "_torque")), toml_text(name), list(Vec3(s.M * si("N m")))) +
                   past;
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
      if ((*shares)[i].norm() > 0) {
        const std::string set = set_of("", {rows[i]}, "share", true);
        tables_ += fmt::format("\n[[load]]   # {}\nkind = \"force\"\nname = {}\non = {}\nforce = {}\nper_node = true\n", s.place,
                               toml_text(unique("load", set)), toml_text(set), list(Vec3((*shares)[i] * si("N")))) +
                   past;
      }
  }
}

void InpScene::pressures() {
  struct Group {
    std::string wish, name, amplitude, place;
    double value;
    std::vector<Facet> facets;
    std::set<std::pair<std::int64_t, int>> has = {};
  };
  std::vector<Group> groups;  // what is said twice counts twice
  const auto add = [&](const Group& g, const Facet& f) {
    Group* to = nullptr;
    for (auto& old : groups)
      if (old.name.empty() && old.wish == g.wish && old.amplitude == g.amplitude && old.value == g.value &&
          !old.has.contains({f.cell, f.facet}))
        to = &old;
    if (!to) to = &groups.emplace_back(g);
    to->facets.push_back(f), to->has.insert({f.cell, f.facet});
  };
  for (const auto& p : d_.distributed) {
    if (p.face < 0) continue;
    if (p.face == 0) {
      const auto s = surface_.find(p.target);
      if (s == surface_.end()) throw Error(p.place, fmt::format("*DSLOAD: no element surface \"{}\"", p.target));
      if (s->second.empty())
        in_.skip("*DSLOAD on a surface of no face", p.place);
      else
        groups.push_back({"", s->second, p.amplitude, p.place, p.value, {}});
      continue;
    }
    const auto cells = inp_cells(d_, p.target, p.id, p.place);
    const auto set = d_.elset.find(p.target);
    const bool has_beams =
        set != d_.elset.end() && std::ranges::any_of(set->second.members, [&](auto id) { return d_.beams.contains(id); });
    if (cells.empty() || has_beams) in_.skip("*DLOAD on elements that are no cells", p.place);
    const Group g{p.target.empty() ? std::string() : fmt::format("{}_P{}", d_.elset.at(p.target).name, p.face),
                  "",
                  p.amplitude,
                  p.place,
                  p.value,
                  {}};
    for (const auto c : cells) {
      if (d_.pyramids.contains(in_.mesh.cell_id[c]))
        throw Error(p.place, fmt::format("*DLOAD: element {} is a pyramid, whose faces by number are not read", in_.mesh.cell_id[c]));
      const int f = inp_facet(static_cast<Shape>(in_.mesh.shape[c]), p.face);
      if (f < 0) throw Error(p.place, fmt::format("*DLOAD: element {} has no face P{}", in_.mesh.cell_id[c], p.face));
      add(g, {c, f});
    }
  }
  for (auto& g : groups) {
    std::string past;
    if (!history(g.amplitude, "*DLOAD", g.place, past)) continue;
    if (g.name.empty()) g.name = names_.facets(g.wish.empty() ? fmt::format("pressure_{}", ++made_["pressure"]) : g.wish, g.facets);
    if (g.name.empty()) continue;
    tables_ += fmt::format("\n[[load]]   # {}\nkind = \"pressure\"\nname = {}\non = {}\npressure = {}\n", g.place,
                           toml_text(unique("load", g.name)), toml_text(g.name), num(g.value * si("Pa"))) +
               past;
  }
}

void InpScene::velocities() {
  for (const auto& g : nodal_groups(d_, d_.velocities, "*INITIAL CONDITIONS, TYPE=VELOCITY", false, turned_, in_)) {
    const std::string set = set_of(g.target, g.nodes, "velocity", false);
    tables_ += fmt::format("\n[[initial]]   # {}\non = [{}]\nvelocity = {}\n", g.place, toml_text(set), list(Vec3(g.value * si("m/s"))));
  }
}
}  // namespace hilo
