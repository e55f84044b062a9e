// SPDX-License-Identifier: GPL-3.0-or-later
// The scene lines that a deck's materials, supports and loads become, and the sets that those lines name.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.hpp"
#include "base/param.hpp"
#include "import/inp/groups.hpp"
#include "import/inp/ties.hpp"
#include "import/links.hpp"

namespace hilo {
namespace {

constexpr std::array<const char*, 3> axes{"x", "y", "z"};

std::string num(double x) { return toml_number(x); }
std::string list(const std::vector<double>& v) { return toml_list(v); }
std::string list(const Vec3& v) { return list(std::vector<double>{v.x(), v.y(), v.z()}); }

/// Writes the lines in the order of a scene file.
class Writer {
 public:
  Writer(const InpDeck& d, Imported& in, SetNames& names, const std::map<std::string, std::string>& node_set,
         const std::map<std::string, std::string>& surface, const ImportOptions& o)
      : d_(d), in_(in), names_(names), node_set_(node_set), surface_(surface), o_(o), turned_(turned_nodes(d, in.mesh)) {
    for (const auto& key : d.transformed)
      if (const auto set = d.nset.find(key); set != d.nset.end()) own_axes_.insert(set->second.members.begin(), set->second.members.end());
    for (const auto& [turns, reference] : d.turns_of)
      if (own_axes_.contains(turns)) own_axes_.insert(reference);
  }

  std::string text() {
    gravity();
    materials();
    tables_ += write_ties(d_, in_, names_, o_);
    tables_ += write_beams(d_, in_, names_, o_);
    supports();
    supports_of_ties();
    forces();
    forces_of_ties();
    pressures();
    tied();
    velocities();
    histories();
    time();
    if (tables_.empty() && head_.empty()) return "";
    std::string s = "units = \"m-kg-s\"\n";
    if (!d_.title.empty()) s = fmt::format("title = {}\n", toml_text(d_.title)) + s;
    return s + head_ + tables_;
  }

 private:
  double si(const char* unit) const { return to_si(unit, o_.units); }

  std::string unique(const std::string& section, const std::string& wish) {
    std::string name = wish;
    for (int i = 2; !used_.insert(section + "/" + name).second; ++i) name = fmt::format("{}_{}", wish, i);
    return name;
  }

  /// The set that holds just these nodes: the one named in the deck where it is that, else a new one.
  std::string set_of(const std::string& target, Rows nodes, const std::string& wish, bool each) {
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    const bool as_listed =
        each && (o_.order == 2 || (o_.thicken && is_divided(in_)));  // a force per node stays on the nodes it was given for
    if (!target.empty() && !as_listed) {
      const auto& name = node_set_.at(target);
      if (!name.empty() && in_.mesh.nodes_of(name, name) == nodes) return name;
    }
    const std::string name = names_.nodes(
        target.empty() ? fmt::format("{}_{}", wish, ++made_[wish]) : d_.nset.at(target).name + (as_listed ? "_load" : "_part"), nodes);
    if (as_listed) in_.as_listed.insert(name);
    return name;
  }

  /// " history" line of an amplitude, or false when the deck's amplitude was not read.
  bool history(const std::string& amplitude, const std::string& what, const std::string& place, std::string& line) {
    line.clear();
    if (amplitude.empty()) return true;
    const auto a = d_.amplitudes.find(amplitude);
    if (a == d_.amplitudes.end() || a->second.t.empty()) {
      in_.skip(fmt::format("{} with *AMPLITUDE {}", what, amplitude), place);
      return false;
    }
    wanted_.insert(amplitude);
    line = fmt::format("history = {}\n", toml_text(clean_name(a->second.name)));
    return true;
  }

  void gravity() {
    std::vector<Vec3> g(in_.mesh.shape.size(), Vec3::Zero());
    std::map<std::int64_t, Vec3> beside;  // what has mass without being a cell, by element
    for (const auto& [id, point] : d_.points)
      if (point.type == "MASS") beside[id] = Vec3::Zero();
    for (const auto& [id, beam] : d_.beams) beside[id] = Vec3::Zero();
    bool any = false;
    std::string place;
    for (const auto& p : d_.distributed) {
      if (p.face != -1) continue;
      place = p.place;
      if (!p.amplitude.empty()) {
        in_.skip("*DLOAD GRAV with AMPLITUDE", p.place);
        continue;
      }
      any = true;
      const Vec3 more = p.value * p.direction;
      if (!p.target.empty() || !beside.contains(p.id))
        for (const auto c : inp_cells(d_, p.target, p.id, p.place)) g[static_cast<size_t>(c)] += more;
      const auto set = d_.elset.find(p.target);
      const std::vector<std::int64_t> alone{p.id}, none;
      for (const auto id : p.target.empty() ? alone : set == d_.elset.end() ? none : set->second.members)
        if (const auto one = beside.find(id); one != beside.end()) one->second += more;
    }
    for (const auto& [id, x] : beside) g.push_back(x);
    if (std::ranges::any_of(g, [&](const Vec3& x) { return x != g.front(); }))
      in_.skip("*DLOAD GRAV on a part of the model", place);
    else if (any)
      head_ += fmt::format("gravity = {}\n", list(Vec3(g.front() * si("m/s^2"))));
  }

  void materials() {
    std::set<std::string> used;
    const Mesh& m = in_.mesh;
    std::vector<std::string> lines(m.region_name.size());
    std::vector<int> seen(m.region_name.size(), 0);
    std::vector<const InpSection*> of_cell(m.shape.size(), nullptr);  // the last section that has it, as in region_materials()
    for (const auto& s : d_.sections)
      for (const auto id : d_.elset.at(s.elset).members)
        if (const auto c = d_.cell.find(id); c != d_.cell.end()) of_cell[c->second] = &s;
    for (std::int64_t c = 0; c < m.n_cells(); ++c) {
      const auto r = m.region[c];
      if (!of_cell[c] || seen[r]++) continue;
      const auto& s = *of_cell[c];
      const auto& mat = d_.laws.at(s.law);
      if (!mat.no_law.empty() || (mat.kind == "stvk" && std::isnan(mat.data.E))) {
        const std::string why = mat.no_law.empty() ? "no *ELASTIC" : mat.no_law;
        lines[r] = fmt::format("# region {}: {} has no law here ({}), give it one\n", toml_text(m.region_name[r]),
                               mat.name.empty() ? "it" : "material " + toml_text(mat.name), why);
        in_.skip(fmt::format("*MATERIAL of region {}: no law of hilo ({})", toml_text(m.region_name[r]), why), s.place, 1, false,
                 "give it one in the scene");
        continue;
      }
      used.insert(s.law);
      lines[r] = fmt::format("[region.{}]\nmaterial = {}\n", toml_text(m.region_name[r]), toml_text(clean_name(mat.name)));
      if (static_cast<Shape>(m.shape[c]) == Shape::bar2 && s.area > 0)
        lines[r] += fmt::format("area = {}\n", num(s.area * o_.scale * o_.scale * si("m^2")));
    }
    for (const auto& key : used) tables_ += d_.laws.at(key).table(d_.laws.at(key).name, o_.units);
    for (const auto& l : lines)
      if (!l.empty()) tables_ += "\n" + l;
  }

  void supports() {
    for (const auto& h : held_groups(d_, turned_, in_)) write(h);
  }

  void write(const Held& h) {
    std::string past, parts;
    if (!history(h.amplitude, "*BOUNDARY", h.place, past)) return;
    for (int k = 0; k < 3; ++k)
      if (h.on[k]) parts += fmt::format("{}\"{}\"", parts.empty() ? "" : ", ", axes[k]);
    const std::string set = set_of(h.target, h.nodes, "support", false);
    tables_ += fmt::format("\n[[motion]]   # {}\nkind = \"{}\"\nname = {}\non = {}\ncomponents = [{}]\n", h.place,
                           h.moved ? "translation" : "fixed", toml_text(unique("motion", set)), toml_text(set), parts);
    if (h.moved) tables_ += fmt::format("displacement = {}\n", list(Vec3(h.value * si("m")))) + past;
  }

  void forces() {
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
  double share_of_pairs(const Rows& nodes, const std::string& place) const {
    if (!o_.thicken) return 1;
    const auto n = static_cast<size_t>(std::ranges::count_if(nodes, [&](std::int64_t a) { return is_of_shell(in_, a); }));
    if (n > 0 && n < nodes.size()) throw Error(place, "*CLOAD on nodes of shells and of others", "one line for each");
    return n > 0 ? 0.5 : 1;
  }

  /// Reference nodes are held by joints to the ground or to what moves them, or whole.
  void supports_of_ties() {
    struct HeldBody {
      unsigned bits = 0;
      bool moves = false;
      std::string place, amplitude;  // of what moves it
      Prescribed by;
    };
    std::map<std::int64_t, HeldBody> held;
    for (const auto& b : d_.supports)
      tied_lines(d_, b, [&](std::int64_t id, int first, int last) {
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

  /// Forces and moments at reference nodes: on the body, or shared by the nodes of a distributing coupling.
  void forces_of_ties() {
    struct Sum {
      Vec3 F = Vec3::Zero(), M = Vec3::Zero();
      std::string place;
    };
    std::map<std::pair<std::int64_t, std::string>, Sum> sums;  // of node and amplitude
    for (const auto& f : d_.forces)
      tied_lines(d_, f, [&](std::int64_t id, int first, int) {
        if (own_axes_.contains(id)) return in_.skip("*CLOAD in axes of *TRANSFORM", f.place);
        Sum& s = sums[{id, f.amplitude}];
        (first > 3 ? s.M : s.F)[(first - 1) % 3] += f.value;
        if (s.place.empty()) s.place = f.place;
      });
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

  void pressures() {
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

  void tied() {
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

  void velocities() {
    for (const auto& g : nodal_groups(d_, d_.velocities, "*INITIAL CONDITIONS, TYPE=VELOCITY", false, turned_, in_)) {
      const std::string set = set_of(g.target, g.nodes, "velocity", false);
      tables_ += fmt::format("\n[[initial]]   # {}\non = [{}]\nvelocity = {}\n", g.place, toml_text(set), list(Vec3(g.value * si("m/s"))));
    }
  }

  void histories() {
    for (const auto& key : wanted_) {
      const auto& a = d_.amplitudes.at(key);
      std::vector<double> t = a.t;
      for (auto& x : t) x *= si("s");
      tables_ += fmt::format("\n[history.{}]\nt = {}\nvalue = {}\n", toml_text(clean_name(a.name)), list(t), list(a.value));
    }
  }

  /// The step of a dynamic deck.  Where it leaves the step to the program, as without DIRECT, its increment is but the first: a fifth of
  /// the time in which a wave runs along the model makes 20 steps of its longest wave, and bending is slower.  1000 steps are enough.
  double dynamic_step(double end) {
    const double given = d_.step_increment > 0 ? d_.step_increment : end;
    if (d_.direct) return given;
    Eigen::AlignedBox3d box;
    for (const Vec3& x : in_.mesh.X) box.extend(x);
    for (const auto& [id, body] : d_.bodies) box.extend(body.X);
    double fastest = 0;
    for (const RegionData& r : in_.mesh.region_data)
      if (r.E > 0 && r.density > 0) fastest = std::max(fastest, std::sqrt(r.E / r.density));
    if (!d_.beams.empty())
      for (const auto& [name, m] : d_.laws)
        if (m.data.E > 0 && m.data.density > 0) fastest = std::max(fastest, std::sqrt(m.data.E / m.data.density));
    const double wave = fastest > 0 ? box.diagonal().norm() / fastest / 5 : end / 100;
    const double step = std::min({given, std::max(wave, end / 1000), end / 20});
    in_.notes.push_back(fmt::format(
        "*DYNAMIC without DIRECT: a step of {:g}{}", step * si("s"),
        wave < step ? " s, in which waves run on: a shorter one, or a tolerance, resolves them" : " s, which resolves the longest wave"));
    return step;
  }

  void time() {
    const double end = (d_.step_end > 0 ? d_.step_end : 1) * si("s");
    if (d_.procedure == "*STATIC") {
      tables_ += "\n[time]\nanalysis = \"static\"\n";
      if (!wanted_.empty()) tables_ += fmt::format("end = {}\n", num(end));
    } else if (d_.procedure == "*DYNAMIC") {
      tables_ += fmt::format("\n[time]\nend = {}\n", num(end));
      tables_ += fmt::format("step = {}\n", num(dynamic_step(d_.step_end > 0 ? d_.step_end : 1) * si("s")));
    } else if (d_.procedure == "*FREQUENCY") {
      tables_ += "\n[time]\nanalysis = \"modes\"\n";
      if (d_.n_modes > 0) tables_ += fmt::format("modes = {}\n", d_.n_modes);
    }
  }

  const InpDeck& d_;
  Imported& in_;
  SetNames& names_;
  const std::map<std::string, std::string>&node_set_, &surface_;
  const ImportOptions& o_;
  std::set<std::int64_t> own_axes_;      // the same by number, nodes of no cell too
  std::vector<char> turned_;             // nodes with axes of their own (n_nodes)
  std::set<std::string> used_, wanted_;  // names given; amplitudes that a line scales by
  std::map<std::string, int> made_;      // sets made of single nodes or elements
  std::string head_, tables_;
};

}  // namespace

void write_inp_scene(const InpDeck& d, Imported& in, SetNames& names, const std::map<std::string, std::string>& node_set,
                     const std::map<std::string, std::string>& surface, const ImportOptions& options) {
  in.mesh.deck_scene = Writer(d, in, names, node_set, surface, options).text();
}

}  // namespace hilo
