// SPDX-License-Identifier: GPL-3.0-or-later
// Loads of a Nastran file as scene lines: forces by node, moments on bodies, pressures and tractions on facets, gravity.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "import/bdf/scene.hpp"
#include "import/links.hpp"

namespace hilo {
namespace {

struct Vec3Order {
  bool operator()(const Vec3& a, const Vec3& b) const { return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end()); }
};

const char* name_of(BdfLoad::Kind kind) {
  switch (kind) {
    case BdfLoad::Kind::force:
      return "FORCE";
    case BdfLoad::Kind::moment:
      return "MOMENT";
    case BdfLoad::Kind::gravity:
      return "GRAV";
    case BdfLoad::Kind::rotation:
      return "RFORCE";
    case BdfLoad::Kind::pressure:
      return "PLOAD";
    case BdfLoad::Kind::displacement:
      return "SPCD";
    case BdfLoad::Kind::line:
      return "PLOAD1";
  }
  return "";
}

/// The integrals of N_a p over a triangle or a quadrilateral, along its normal, or along `way` where that is given.
std::vector<Vec3> forces_of_pressure(const std::vector<Vec3>& x, const std::vector<double>& p, const Vec3& way) {
  std::vector<Vec3> f(x.size(), Vec3::Zero());
  const auto add = [&](const std::vector<double>& N, const Vec3& area) {
    double here = 0;
    for (size_t a = 0; a < x.size(); ++a) here += N[a] * p[a];
    const Vec3 push = here * (way.norm() > 0 ? Vec3(area.norm() * way.normalized()) : area);
    for (size_t a = 0; a < x.size(); ++a) f[a] += N[a] * push;
  };
  if (x.size() == 3) {
    const Vec3 third = (x[1] - x[0]).cross(x[2] - x[0]) / 6;
    for (size_t i = 0; i < 3; ++i) {
      std::vector<double> N(3, 0.5);
      N[i] = 0;
      add(N, third);
    }
    return f;
  }
  for (const double u : {-1 / std::numbers::sqrt3, 1 / std::numbers::sqrt3})
    for (const double v : {-1 / std::numbers::sqrt3, 1 / std::numbers::sqrt3}) {
      constexpr double at[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
      std::vector<double> N(4);
      Vec3 along_u = Vec3::Zero(), along_v = Vec3::Zero();
      for (size_t a = 0; a < 4; ++a) {
        N[a] = (1 + at[a][0] * u) * (1 + at[a][1] * v) / 4;
        along_u += at[a][0] * (1 + at[a][1] * v) / 4 * x[a], along_v += (1 + at[a][0] * u) * at[a][1] / 4 * x[a];
      }
      add(N, along_u.cross(along_v));
    }
  return f;
}

}  // namespace

void BdfScene::choose_loads() {
  const BdfCase& chosen = deck_.chosen;
  const auto& all = deck_.loads;
  if (chosen.load >= 0 && !all.has(chosen.load)) in_.skip(fmt::format("LOAD = {}, of which there is none", chosen.load), "case control");
  const auto take = chosen.load < 0 && chosen.spc < 0 && !chosen.any ? all.only() : chosen.load;
  std::set<std::int64_t> taken;
  const auto add = [&](double factor, std::int64_t id) {
    const auto set = all.lines.find(id);
    if (set == all.lines.end()) return false;
    taken.insert(id);
    for (const BdfLoad& l : set->second) loads_.emplace_back(factor, &l);
    return true;
  };
  add(1, take);
  if (const BdfSum* sum = all.sum(take))
    for (const auto& [factor, id] : sum->parts)
      if (!add(sum->factor * factor, id)) in_.skip(fmt::format("LOAD of set {}, of which there is none", id), sum->place);
  for (const auto& [id, lines] : all.lines)
    if (!taken.contains(id))
      for (const BdfLoad& l : lines) in_.skip(fmt::format("{} of a set that the subcase does not use", name_of(l.kind)), l.place);
}

void BdfScene::gravity() {
  Vec3 g = Vec3::Zero();
  for (const auto& [factor, l] : loads_)
    if (l->kind == BdfLoad::Kind::gravity) g += factor * l->size * (axes_at(deck_, l->system, Vec3::Zero(), l->place) * l->direction);
  if (g.norm() > 0) gravity_ = g * si("m/s^2");
}

/// Of all solids, by load; the angular velocity is that of the entry times the length of its direction.
void BdfScene::rotation(double factor, const BdfLoad& l) {
  if (factor < 0) return in_.skip("RFORCE times a factor of LOAD below zero", l.place);
  const Vec3 at = l.grid ? X(row(l.grid, l.place, "RFORCE")) : Vec3(Vec3::Zero());
  const Vec3 axis = axes_at(deck_, l.system, at, l.place) * l.direction;
  std::vector<char> has(in_.mesh.region_name.size(), 0);
  for (std::int64_t c = 0; c < in_.mesh.n_cells(); ++c)
    if (info(in_.mesh.shape[static_cast<size_t>(c)]).dimension != 2) has[static_cast<size_t>(in_.mesh.region[static_cast<size_t>(c)])] = 1;
  if (std::ranges::find(has, 0) != has.end()) in_.skip("RFORCE on shells", l.place);
  const double omega = 2 * std::numbers::pi * l.size * axis.norm() * std::sqrt(factor), speed = omega / si("s");
  if (speed == 0) return;
  spins_.push_back({at, omega * axis.normalized(), l.place});
  for (size_t r = 0; r < has.size(); ++r)
    if (has[r])
      scene_.add_unique({"load", "centrifugal"}, in_.mesh.region_name[r] + "_centrifugal", l.place,
                        {{"on", in_.mesh.region_name[r]}, {"at", point(at)}, {"axis", axis.normalized()}, {"speed", std::abs(speed)}});
}

/// The same on masses at grids, and along beams, where it varies evenly: the force of their mass as drawn.
void BdfScene::rotation_of_bodies() {
  for (const Spin& spin : spins_) {
    const auto pull = [&](const Vec3& x) -> Vec3 { return -options_.scale * spin.omega.cross(spin.omega.cross(x - spin.at)); };
    for (const BdfMass& m : masses_) {
      const auto a = row(m.grid, m.place, "CONM2");
      if (end(a) == End::mean) {
        in_.skip("RFORCE on the mass of an RBE3", spin.place);
        continue;
      }
      const Mat3 own = axes_at(deck_, std::max<std::int64_t>(m.system, 0), X(a), m.place);
      const Vec3 arm = end(a) != End::body ? Vec3(Vec3::Zero()) : m.system < 0 ? Vec3(m.offset - X(a)) : Vec3(own * m.offset);
      const Vec3 F = m.mass * pull(X(a) + arm);
      force_[a].add(F, spin.place);
      const Mat3 J = own * m.inertia * own.transpose();
      if (const Vec3 M = options_.scale * arm.cross(F) - spin.omega.cross(J * spin.omega); end(a) == End::body && M.norm() > 0)
        moment_[a].add(M, spin.place);
    }
    for (const auto& b : deck_.beams) {
      const DeckSection& s = section_of_beam(deck_, b).section;
      const double rho = deck_.material(b.property)->second.data.density;
      const double mass = (rho > 0 ? rho * s.area(0.3, b.place).A * options_.scale * options_.scale : 0) + s.line_mass;
      const MadeBeam& beam = made_beams_.at(b.id);
      const Vec3 from = mass * pull(beam.start), to = mass * pull(beam.start + beam.length() * beam.axes.col(0));
      if (from.norm() + to.norm() == 0) continue;
      scene_.add_unique({"load", "line"}, beam.name + "_centrifugal", spin.place,
                        {{"on", beam.name}, {"force_per_length", from * si("N/m")}, {"force_per_length_end", to * si("N/m")}});
    }
  }
}

void BdfScene::distribute(const BdfMean& m, const Vec3& F, const Vec3& M, const std::string& place) {
  const Vec3 at = X(row(m.grid, m.place, "RBE3"));
  std::vector<std::int64_t> rows;
  std::vector<Vec3> points;
  std::vector<double> weights, of_turns;
  double mean = 0;  // of the distances
  for (const auto& of : m.of) {
    rows.push_back(row(of.grid, m.place, "RBE3")), points.push_back(X(rows.back())), weights.push_back(of.weight);
    mean += (points.back() - at).norm() / static_cast<double>(m.of.size());
  }
  bool solids = false;
  for (size_t i = 0; i < rows.size(); ++i) {
    of_turns.push_back(m.of[i].turns && end(rows[i]) == End::body ? weights[i] * mean * mean : 0);
    solids = solids || (m.of[i].turns && end(rows[i]) == End::node && !is_of_shell(rows[i]));
    if (m.of[i].turns && is_of_shell(rows[i]) && end(rows[i]) == End::node)
      in_.skip("RBE3 of 123456 at grids of shells: the share of their turns", m.place);
  }
  if (solids) in_.notes.push_back(fmt::format("{}: RBE3 of 123456: nodes of solids do not turn, they take forces alone", m.place));
  const auto shares = shares_of_mean(points, weights, at, F, M / options_.scale, of_turns);
  if (!shares) return in_.skip("load on an RBE3 that its grids cannot carry", place);
  for (size_t i = 0; i < points.size(); ++i) {
    force_[rows[i]].add(shares->forces[i], place);
    if (of_turns[i] > 0) moment_[rows[i]].add(options_.scale * of_turns[i] * shares->turn, place);
  }
}

/// A pressure that varies evenly over a shell, as forces of its grids: the integrals of N_a p over the element as drawn.
void BdfScene::varying_pressure(double factor, const BdfLoad& l) {
  if (l.at_corners.empty()) return;
  for (const auto element : l.elements) {
    const auto s = shell_.find(element);
    if (s == shell_.end() || info(s->second->shape).n_corners != info(s->second->shape).n_nodes) {
      in_.skip("PLOAD4 that varies over the face", l.place);
      continue;
    }
    Rows rows;
    std::vector<Vec3> x;
    for (const auto grid : s->second->nodes) rows.push_back(row(grid, l.place, "PLOAD4")), x.push_back(X(rows.back()));
    const Vec3 way = axes_at(deck_, l.system, x[0], l.place) * l.direction;
    const std::vector<Vec3> f = forces_of_pressure(x, l.at_corners, way);
    for (size_t i = 0; i < rows.size(); ++i) force_[rows[i]].add(factor * options_.scale * options_.scale * f[i], l.place);
  }
  in_.notes.push_back(fmt::format("{}: PLOAD4 that varies becomes forces of the grids, which do not turn with the shell", l.place));
}

void BdfScene::nodal_loads() {
  struct Pair {
    Vec3 F = Vec3::Zero(), M = Vec3::Zero();
    std::string place;
  };
  std::map<std::int64_t, Pair> on_mean;
  for (const auto& [factor, l] : loads_) {
    const bool force = l->kind == BdfLoad::Kind::force;
    if (!force && l->kind != BdfLoad::Kind::moment) continue;
    const std::string what = force ? "FORCE" : "MOMENT";
    const auto a = row(l->grid, l->place, what);
    Vec3 v = factor * l->size * (axes_at(deck_, l->system, X(a), l->place) * l->direction);
    if (l->towards[0] != 0) {
      const Vec3 d = X(row(l->towards[1], l->place, what)) - X(row(l->towards[0], l->place, what));
      if (!(d.norm() > 0)) throw Error(l->place, what + "1: its two grids are at one place");
      v = factor * l->size * d.normalized();
    }
    switch (end(a)) {
      case End::mean: {
        const Mat3 own = axes(a);
        for (int k = 0; k < 3; ++k)  // along components that the mean leaves free the grid has no stiffness
          if (!(mean_.at(a)->components >> (force ? k : k + 3) & 1)) {
            if (std::abs(own.col(k).dot(v)) > 1e-9 * v.norm()) in_.skip("load on an RBE3 along a component that it leaves free", l->place);
            v -= own.col(k) * own.col(k).dot(v);
          }
        Pair& p = on_mean[a];
        (force ? p.F : p.M) += v;
        if (p.place.empty()) p.place = l->place;
        break;
      }
      case End::node:
        if (!force) {
          in_.skip("MOMENT on a node of solids, which does not turn", l->place);
          break;
        }
        [[fallthrough]];
      case End::body:
        (force ? force_ : moment_)[a].add(v, l->place);
        break;
      default:
        in_.skip(what + " on a grid of no element", l->place);
    }
  }
  for (const auto& [a, p] : on_mean) distribute(*mean_.at(a), p.F, p.M, p.place);

  std::map<Vec3, std::pair<Rows, std::string>, Vec3Order> equal;
  std::string on_divided;  // place of the first force at a grid of shells that become several
  const bool divided = options_.thicken && is_divided(in_);
  for (const auto& [a, f] : force_) {
    const auto& [v, place] = f;
    if (v.norm() == 0) continue;
    const End what = end(a);
    if (what == End::body) {
      scene_.add_unique({"load", "force"}, end_name(a), place, {{"on", end_name(a)}, {"force", v * si("N")}, {"at", point(X(a))}});
    } else if (what == End::node) {
      Vec3 each = v;
      if (is_of_shell(a)) {  // each node of its pairs takes its share
        in_.nodes_counted[a] = count_nodes(sheets(a), of_solids_.contains(a));
        each /= static_cast<double>(in_.nodes_counted[a]);
        if (divided && on_divided.empty()) on_divided = place;
      }
      auto& [rows, first] = equal[each];
      if (rows.empty()) first = place;
      rows.push_back(a);
    } else
      in_.skip("RBE3 of a grid that is no node of a cell", place);
  }
  if (!on_divided.empty())
    in_.notes.push_back(
        fmt::format("{}: forces at grids of shells act as point forces on the divided mesh, which gives way more beside them "
                    "(a pressure or a finer mesh of quadrangles alone does not)",
                    on_divided));
  for (const auto& [v, group] : equal) {
    const std::string set = set_of(group.first, "force", true);
    scene_.add_unique({"load", "force"}, set, group.second, {{"on", set}, {"force", v * si("N")}, {"per_node", true}});
  }
  for (auto& [a, m] : moment_) {
    if (is_of_shell(a) && !on_beam_.contains(a) && is_flat(sheets(a)) && drop_drilling(sheets(a), m.value))
      in_.skip("MOMENT about the normal of a shell, which does not resist it", m.place);
    if (m.value.norm() > 0)
      scene_.add_unique({"load", "torque"}, end_name(a) + "_torque", m.place, {{"on", end_name(a)}, {"torque", m.value * si("N m")}});
  }
}

/// PLOAD1: over a beam or a part of it, or at a point.
void BdfScene::line_load(double factor, const BdfLoad& l) {
  const auto made = made_beams_.find(l.elements.front());
  if (made == made_beams_.end()) return in_.skip("PLOAD1 on an element that is no beam of the scene", l.place);
  const MadeBeam& beam = made->second;
  if (beam.apart) return in_.skip("PLOAD1 on a beam whose neutral axis is off its shear centre", l.place);
  const double whole = beam.length(), unit = l.as_share ? whole : 1;
  const size_t from = beam.section(l.from_to[0] * unit), to = beam.section(l.from_to[1] * unit);
  const Vec3 way = l.own_axes ? Vec3(beam.axes * l.direction) : l.direction;
  if (factor == 0 || (l.size == 0 && l.size_end == 0)) return;
  if (from == to) {  // at a point
    const Vec3 value = factor * l.size * way;
    SceneTable& load = scene_.add_unique({"load", l.turns ? "torque" : "force"}, beam.name + "_point", l.place, {{"on", beam.body(from)}});
    if (l.turns)
      load.set("torque", value * si("N m"));
    else
      load.set("force", value * si("N")).set("at", point(beam.start + beam.sections[from] * beam.axes.col(0)));
    return;
  }
  const Vec3 one = factor * (l.projected ? beam.axes.col(0).cross(way).norm() : 1) * way;
  if (one.norm() == 0) return;
  scene_.add_unique({"load", "line"}, beam.name + "_line", l.place, {{"on", beam.name}, {"force_per_length", l.size * one * si("N/m")}})
      .set_if(l.size_end != l.size, "force_per_length_end", l.size_end * one * si("N/m"))
      .set_if(from > 0, "from", beam.sections[from] * options_.scale * si("m"))
      .set_if(to + 1 < beam.sections.size(), "to", beam.sections[to] * options_.scale * si("m"));
}

/// The facet of a solid that PLOAD4 names by one or two of its corners.
Facet BdfScene::face_of_solid(const BdfLoad& l, std::int64_t element) const {
  const auto c = deck_.cell_row.at(element);
  if (deck_.pyramids.contains(element)) throw Error(l.place, fmt::format("a pressure on a face of CPYRAM {} is not read", element));
  const ShapeInfo& s = info(in_.mesh.shape[static_cast<size_t>(c)]);
  const auto nodes = in_.mesh.cell(c);
  const auto local = [&](std::int64_t grid) {  // which corner of the cell
    const auto a = grid ? row(grid, l.place, "PLOAD4") : -1;
    for (int i = 0; i < s.n_corners; ++i)
      if (nodes[static_cast<size_t>(i)] == a) return i;
    return -1;
  };
  const int one = local(l.face[0]), other = local(l.face[1]);
  for (size_t i = 0; i < s.facets.size() && s.dimension == 3 && one >= 0 && (other >= 0 || !l.face[1]); ++i) {
    const std::vector<int> of = facet_corners(s, i);
    const auto has = [&](int a) { return std::find(of.begin(), of.end(), a) - of.begin(); };
    const auto n = static_cast<std::ptrdiff_t>(of.size());
    if (has(one) == n) continue;
    const bool it = s.n_corners == 4 ? other >= 0 && has(other) == n                    // G4 is off the face
                    : n == 3         ? other < 0                                        // a triangle of a wedge: G1 alone
                                     : has(other) < n && (has(other) - has(one) + n) % n == 2;  // G1 and G3 across
    if (it) return {c, static_cast<std::int64_t>(i)};
  }
  throw Error(l.place, fmt::format("PLOAD4: element {} has no face of grids {} and {}", element, l.face[0], l.face[1]));
}

void BdfScene::pressures() {
  struct Pushed {
    double factor;
    const BdfLoad* l;
    Facet f;
    double sign;  // 1 where a positive pressure pushes inwards
  };
  std::vector<Pushed> pushed;
  std::vector<std::vector<std::int64_t>> corners;  // of shells and faces by their grids
  std::vector<size_t> open;                        // their places in `pushed`
  for (const auto& [factor, l] : loads_) {
    if (l->kind != BdfLoad::Kind::pressure || !l->at_corners.empty()) continue;
    std::int64_t missing = 0;
    const auto by_grids = [&, factor = factor, l = l](const std::vector<std::int64_t>& grids) {
      corners.emplace_back();
      for (const auto grid : grids) corners.back().push_back(row(grid, l->place, "PLOAD"));
      open.push_back(pushed.size());
      pushed.push_back({factor, l, {-1, -1}, 1});
    };
    if (!l->corners.empty()) by_grids(l->corners);
    for (const auto element : l->elements)
      if (deck_.cell_row.contains(element))
        pushed.push_back({factor, l, face_of_solid(*l, element), 1});
      else if (const auto s = shell_.find(element); s != shell_.end())
        by_grids(s->second->nodes);
      else
        ++missing;
    if (missing > 0) in_.skip("PLOAD on elements that are not there", l->place, missing);
  }
  const auto found = match_facets(in_.mesh, corners);
  for (size_t i = 0; i < open.size(); ++i) {
    Pushed& p = pushed[open[i]];
    const auto& c = corners[i];
    p.f = found[i];
    if (p.f.cell < 0) continue;
    const Vec3 normal = c.size() == 3 ? (X(c[1]) - X(c[0])).cross(X(c[2]) - X(c[0])) : (X(c[2]) - X(c[0])).cross(X(c[3]) - X(c[1]));
    p.sign = (normal.dot(facet_area(in_.mesh, p.f)) > 0) == is_mirrored(in_.mesh, p.f.cell) ? 1 : -1;
  }

  using Key = std::pair<std::int64_t, std::int64_t>;
  std::map<Key, std::pair<double, std::string>> pressure;
  std::map<Key, Sum> traction;
  std::set<const BdfLoad*> curved;  // said to be so
  for (const auto& [factor, l, f, sign] : pushed) {
    const Key key{f.cell, f.facet};
    if (f.cell < 0) {
      in_.skip("PLOAD on a face of no solid", l->place);
    } else if (l->direction.norm() > 0) {
      const auto nodes = in_.mesh.facet_nodes(f);
      Vec3 at = Vec3::Zero();
      for (const auto a : nodes) at += X(a) / static_cast<double>(nodes.size());
      if (l->system != 0 && deck_.systems.contains(l->system) && deck_.systems.at(l->system).kind != BdfSystem::Kind::rectangular &&
          curved.insert(l).second)
        in_.notes.push_back(
            fmt::format("{}: PLOAD4 in a curved system: its direction on each facet is that at the facet's centre", l->place));
      traction[key].add(factor * l->size * (axes_at(deck_, l->system, at, l->place) * l->direction).normalized(), l->place);
    } else {
      pressure.try_emplace(key, 0, l->place).first->second.first += factor * l->size * sign;
    }
  }
  std::map<double, std::pair<std::vector<Facet>, std::string>> by_pressure;
  for (const auto& [key, p] : pressure)
    if (p.first != 0) by_pressure[p.first].first.push_back({key.first, key.second}), by_pressure[p.first].second = p.second;
  std::map<Vec3, std::pair<std::vector<Facet>, std::string>, Vec3Order> by_traction;
  for (const auto& [key, p] : traction)
    if (p.value.norm() > 0) by_traction[p.value].first.push_back({key.first, key.second}), by_traction[p.value].second = p.place;
  const auto write = [&](const std::vector<Facet>& facets, const std::string& place, const char* kind, const SceneValue& value) {
    const std::string set = names_.facets(scene_.unique("facets", kind), facets);
    scene_.add_unique({"load", kind}, set, place, {{"on", set}, {kind, value}});
  };
  for (const auto& [p, g] : by_pressure) write(g.first, g.second, "pressure", p * si("Pa"));
  for (const auto& [v, g] : by_traction) write(g.first, g.second, "traction", v * si("Pa"));
}

}  // namespace hilo
