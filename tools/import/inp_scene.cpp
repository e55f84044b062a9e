// The scene lines that a deck's materials, supports and loads become, and the sets that those lines name.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/error.hpp"
#include "base/param.hpp"
#include "import/inp_deck.hpp"

namespace hilo {
namespace {

using Rows = std::vector<std::int64_t>;
constexpr std::array<const char*, 3> axes{"x", "y", "z"};

std::string quoted(const std::string& s) {
  std::string q(1, '"');
  for (const char c : s) {
    if (c == '"' || c == '\\') q += '\\';
    q += static_cast<unsigned char>(c) < 32 ? ' ' : c;
  }
  q += '"';
  return q;
}

std::string num(double x) {
  std::string s = fmt::format("{}", x == 0 ? 0.0 : x);
  return s.find_first_of(".en") == std::string::npos ? s + ".0" : s;
}
std::string list(const std::vector<double>& v) {
  std::string s = "[";
  for (size_t i = 0; i < v.size(); ++i) s += (i ? ", " : "") + num(v[i]);
  return s + "]";
}
std::string list(const Vec3& v) { return list(std::vector<double>{v.x(), v.y(), v.z()}); }

/// Writes the lines in the order of a scene file.
class Writer {
 public:
  Writer(const InpDeck& d, Imported& in, SetNames& names, const std::map<std::string, std::string>& node_set,
         const std::map<std::string, std::string>& surface, const ImportOptions& o)
      : d_(d), in_(in), names_(names), node_set_(node_set), surface_(surface), o_(o), turned_(in.mesh.X.size(), 0) {
    for (const auto& key : d.transformed)
      if (d.nset.count(key))
        for (const auto a : inp_nodes(d, key, 0, "")) turned_[a] = 1;
  }

  std::string text() {
    gravity();
    materials();
    supports();
    forces();
    pressures();
    velocities();
    histories();
    time();
    if (tables_.empty() && head_.empty()) return "";
    std::string s = "units = \"m-kg-s\"\n";
    if (!d_.title.empty()) s = fmt::format("title = {}\n", quoted(d_.title)) + s;
    s += head_ + tables_;
    for (const auto& n : in_.not_read)
      if (!n.output) s += fmt::format("# not read: {} ({}, {})\n", n.what, n.count, n.place);
    return s;
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
    const bool as_listed = each && o_.order == 2;   // a force per node stays on the nodes it was given for
    if (!target.empty() && !as_listed) {
      const auto& name = node_set_.at(target);
      if (!name.empty() && in_.mesh.nodes_of(name, name) == nodes) return name;
    }
    const std::string name = names_.nodes(target.empty() ? fmt::format("{}_{}", wish, ++made_[wish]) : d_.nset.at(target).name + (as_listed ? "_load" : "_part"), nodes);
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
    line = fmt::format("history = {}\n", quoted(clean_name(a->second.name)));
    return true;
  }

  void gravity() {
    std::vector<Vec3> g;
    bool odd = false;
    std::string place;
    for (const auto& p : d_.distributed) {
      if (p.face != -1) continue;
      place = p.place;
      if (!p.amplitude.empty()) {
        in_.skip("*DLOAD GRAV with AMPLITUDE", p.place);
        continue;
      }
      g.resize(in_.mesh.shape.size(), Vec3::Zero());
      for (const auto c : inp_cells(d_, p.target, p.id, p.place)) g[c] += p.value * p.direction;
    }
    for (const auto& x : g) odd = odd || x != g[0];
    if (odd) in_.skip("*DLOAD GRAV on a part of the model", place);
    else if (!g.empty()) head_ += fmt::format("gravity = {}\n", list(Vec3(g[0] * si("m/s^2"))));
  }

  void materials() {
    std::map<std::string, const InpMaterial*> used;
    const Mesh& m = in_.mesh;
    std::vector<std::string> lines(m.region_name.size());
    std::vector<int> seen(m.region_name.size(), 0);
    for (const auto& s : d_.sections) {
      const auto& mat = d_.materials.at(s.material);
      for (const auto id : d_.elset.at(s.elset).members) {
        const auto c = d_.cell.find(id);
        if (c == d_.cell.end() || seen[m.region[c->second]]++) continue;
        const auto r = m.region[c->second];
        if (std::isnan(mat.data.E)) {
          lines[r] = fmt::format("# region {}: material {} is not linear and isotropic, give it one\n", quoted(m.region_name[r]), quoted(mat.name));
          continue;
        }
        used[s.material] = &mat;
        lines[r] = fmt::format("[region.{}]\nmaterial = {}\n", quoted(m.region_name[r]), quoted(clean_name(mat.name)));
        if (static_cast<Shape>(m.shape[c->second]) == Shape::bar2 && s.area > 0) lines[r] += fmt::format("area = {}\n", num(s.area * si("m^2")));
      }
    }
    for (const auto& [key, mat] : used) {
      tables_ += fmt::format("\n[material.{}]\nkind = \"stvk\"\nE = {}\nnu = {}\n", quoted(clean_name(mat->name)), num(mat->data.E * si("Pa")), num(mat->data.nu));
      if (!std::isnan(mat->data.density)) tables_ += fmt::format("density = {}\n", num(mat->data.density * si("kg/m^3")));
    }
    for (const auto& l : lines)
      if (!l.empty()) tables_ += "\n" + l;
  }

  /// A group of nodes held in the same components to the same values.
  struct Held {
    std::string target, amplitude, place;
    std::array<bool, 3> on{};
    Vec3 value = Vec3::Zero();
    bool moved = false;
    Rows nodes = {};
  };

  void supports() {
    // the last line that speaks of a component of a node holds it
    std::unordered_map<std::int64_t, size_t> claim;
    for (size_t i = 0; i < d_.supports.size(); ++i) {
      const auto& b = d_.supports[i];
      if (b.target.empty() && d_.unused.count(b.id)) in_.skip("*BOUNDARY on a node of no cell", b.place);
      for (const auto a : inp_nodes(d_, b.target, b.id, b.place))
        for (int k = b.first - 1; k < b.last; ++k) claim[3 * a + k] = i;
    }
    const auto fixed = [&](std::int64_t a, int k) {
      const auto c = claim.find(3 * a + k);
      return c != claim.end() && d_.supports[c->second].value == 0;
    };
    std::int64_t lost = 0;
    for (std::int64_t a = 0; a < in_.mesh.n_nodes(); ++a)
      if (turned_[a] && !(fixed(a, 0) && fixed(a, 1) && fixed(a, 2)))
        for (int k = 0; k < 3; ++k) lost += static_cast<std::int64_t>(claim.erase(3 * a + k));
    if (lost) in_.skip("*BOUNDARY in axes of *TRANSFORM", "", lost);

    std::vector<Held> groups;
    std::map<std::tuple<std::string, std::string, int, double>, size_t> of_set;   // target, amplitude, component, value
    std::map<std::int64_t, std::array<std::int64_t, 3>> of_node;                   // single nodes: line of each component
    for (size_t i = 0; i < d_.supports.size(); ++i) {
      const auto& b = d_.supports[i];
      const std::string amplitude = b.value == 0 ? "" : b.amplitude;
      for (int k = b.first - 1; k < b.last; ++k)
        for (const auto a : inp_nodes(d_, b.target, b.id, b.place)) {
          const auto c = claim.find(3 * a + k);
          if (c == claim.end() || c->second != i) continue;
          if (b.target.empty()) {
            of_node.try_emplace(a, std::array<std::int64_t, 3>{-1, -1, -1}).first->second[k] = static_cast<std::int64_t>(i);
            continue;
          }
          const auto [it, fresh] = of_set.try_emplace({b.target, amplitude, k, b.value}, groups.size());
          if (fresh) {
            Held h{b.target, amplitude, b.place};
            h.on[k] = true, h.value[k] = b.value, h.moved = b.value != 0;
            groups.push_back(h);
          }
          groups[it->second].nodes.push_back(a);
        }
    }
    for (const auto& [a, line] : of_node)
      for (const bool moved : {false, true}) {   // the held and the moved components of one node are two groups
        std::map<std::string, Held> by_amplitude;
        for (int k = 0; k < 3; ++k) {
          if (line[k] < 0) continue;
          const auto& b = d_.supports[line[k]];
          if ((b.value != 0) != moved) continue;
          auto& h = by_amplitude[moved ? b.amplitude : ""];
          h.on[k] = true, h.value[k] = b.value, h.moved = moved, h.place = b.place, h.amplitude = moved ? b.amplitude : "";
        }
        for (auto& [amplitude, h] : by_amplitude) {
          const auto same = std::find_if(groups.begin(), groups.end(), [&, &h = h](const Held& g) {
            return g.target.empty() && g.moved == moved && g.on == h.on && g.value == h.value && g.amplitude == h.amplitude;
          });
          if (same == groups.end()) groups.push_back(h), groups.back().nodes = {a};
          else same->nodes.push_back(a);
        }
      }
    merge_components(groups);
    for (const auto& h : groups) write(h);
  }

  /// Components of one set, held on the same nodes in the same way, are one motion.
  static void merge_components(std::vector<Held>& groups) {
    for (auto& h : groups) std::sort(h.nodes.begin(), h.nodes.end());
    for (size_t i = 0; i < groups.size(); ++i)
      for (size_t j = i + 1; j < groups.size();) {
        Held &a = groups[i], &b = groups[j];
        const bool apart = !(a.on[0] && b.on[0]) && !(a.on[1] && b.on[1]) && !(a.on[2] && b.on[2]);
        if (a.target.empty() || a.target != b.target || a.amplitude != b.amplitude || a.moved != b.moved || !apart || a.nodes != b.nodes) {
          ++j;
          continue;
        }
        for (int k = 0; k < 3; ++k)
          if (b.on[k]) a.on[k] = true, a.value[k] = b.value[k];
        groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(j));
      }
  }

  void write(const Held& h) {
    std::string past, parts;
    if (!history(h.amplitude, "*BOUNDARY", h.place, past)) return;
    for (int k = 0; k < 3; ++k)
      if (h.on[k]) parts += fmt::format("{}\"{}\"", parts.empty() ? "" : ", ", axes[k]);
    const std::string set = set_of(h.target, h.nodes, "support", false);
    tables_ += fmt::format("\n[[motion]]   # {}\nkind = \"{}\"\nname = {}\non = {}\ncomponents = [{}]\n", h.place, h.moved ? "translation" : "fixed",
                           quoted(unique("motion", set)), quoted(set), parts);
    if (h.moved) tables_ += fmt::format("displacement = {}\n", list(Vec3(h.value * si("m")))) + past;
  }

  /// Nodal values: by set, or equal vectors of single nodes together.
  struct Nodal {
    std::string target, amplitude, place;
    Vec3 value = Vec3::Zero();
    Rows nodes;
  };
  std::vector<Nodal> nodal(const std::vector<InpNodal>& lines, const char* what, bool add) {
    std::vector<Nodal> groups;
    std::map<std::pair<std::string, std::string>, size_t> of_set;
    std::map<std::pair<std::int64_t, std::string>, Nodal> of_node;
    for (const auto& f : lines) {
      if (f.target.empty() && d_.unused.count(f.id)) in_.skip(fmt::format("{} on a node of no cell", what), f.place);
      Rows nodes = inp_nodes(d_, f.target, f.id, f.place);
      const auto turned = std::count_if(nodes.begin(), nodes.end(), [&](std::int64_t a) { return turned_[a]; });
      if (turned) {
        in_.skip(fmt::format("{} in axes of *TRANSFORM", what), f.place, turned);
        continue;
      }
      if (nodes.empty()) continue;
      Nodal* n;
      if (f.target.empty())
        n = &of_node[{nodes[0], f.amplitude}];
      else {
        const auto [it, fresh] = of_set.try_emplace({f.target, f.amplitude}, groups.size());
        if (fresh) groups.push_back({f.target, f.amplitude, f.place, Vec3::Zero(), nodes});
        n = &groups[it->second];
      }
      n->amplitude = f.amplitude;
      if (n->place.empty()) n->place = f.place;
      n->value[f.first - 1] = f.value + (add ? n->value[f.first - 1] : 0);
    }
    for (const auto& [key, n] : of_node) {
      const auto same = std::find_if(groups.begin(), groups.end(), [&, &n = n](const Nodal& g) { return g.target.empty() && g.value == n.value && g.amplitude == n.amplitude; });
      if (same == groups.end()) groups.push_back(n), groups.back().nodes = {key.first};
      else same->nodes.push_back(key.first);
    }
    return groups;
  }

  void forces() {
    for (const auto& g : nodal(d_.forces, "*CLOAD", true)) {
      std::string past;
      if (g.value.norm() == 0 || !history(g.amplitude, "*CLOAD", g.place, past)) continue;
      const std::string set = set_of(g.target, g.nodes, "force", true);
      tables_ += fmt::format("\n[[load]]   # {}\nkind = \"force\"\nname = {}\non = {}\nforce = {}\nper_node = true\n", g.place, quoted(unique("load", set)),
                             quoted(set), list(Vec3(g.value * si("N")))) + past;
    }
  }

  void pressures() {
    struct Group {
      std::string wish, name, amplitude, place;
      double value;
      std::vector<Facet> facets;
    };
    std::vector<Group> groups;
    const auto group = [&](const Group& g) -> Group& {
      for (auto& old : groups)
        if (old.wish == g.wish && old.name == g.name && old.amplitude == g.amplitude && old.value == g.value) return old;
      groups.push_back(g);
      return groups.back();
    };
    for (const auto& p : d_.distributed) {
      if (p.face < 0) continue;
      if (p.face == 0) {
        const auto s = surface_.find(p.target);
        if (s == surface_.end()) throw Error(p.place, fmt::format("*DSLOAD: no element surface \"{}\"", p.target));
        if (!s->second.empty()) group({"", s->second, p.amplitude, p.place, p.value, {}});
        continue;
      }
      const auto cells = inp_cells(d_, p.target, p.id, p.place);
      auto& g = group({p.target.empty() ? std::string() : fmt::format("{}_P{}", d_.elset.at(p.target).name, p.face), "", p.amplitude, p.place, p.value, {}});
      for (const auto c : cells) {
        const int f = inp_facet(static_cast<Shape>(in_.mesh.shape[c]), p.face);
        if (f < 0) throw Error(p.place, fmt::format("*DLOAD: element {} has no face P{}", in_.mesh.cell_id[c], p.face));
        g.facets.push_back({c, f});
      }
    }
    for (auto& g : groups) {
      std::string past;
      if (!history(g.amplitude, "*DLOAD", g.place, past)) continue;
      if (g.name.empty()) g.name = names_.facets(g.wish.empty() ? fmt::format("pressure_{}", ++made_["pressure"]) : g.wish, g.facets);
      if (g.name.empty()) continue;
      tables_ += fmt::format("\n[[load]]   # {}\nkind = \"pressure\"\nname = {}\non = {}\npressure = {}\n", g.place, quoted(unique("load", g.name)),
                             quoted(g.name), num(g.value * si("Pa"))) + past;
    }
  }

  void velocities() {
    for (const auto& g : nodal(d_.velocities, "*INITIAL CONDITIONS, TYPE=VELOCITY", false)) {
      const std::string set = set_of(g.target, g.nodes, "velocity", false);
      tables_ += fmt::format("\n[[initial]]   # {}\non = [{}]\nvelocity = {}\n", g.place, quoted(set), list(Vec3(g.value * si("m/s"))));
    }
  }

  void histories() {
    for (const auto& key : wanted_) {
      const auto& a = d_.amplitudes.at(key);
      std::vector<double> t = a.t;
      for (auto& x : t) x *= si("s");
      tables_ += fmt::format("\n[history.{}]\nt = {}\nvalue = {}\n", quoted(clean_name(a.name)), list(t), list(a.value));
    }
  }

  void time() {
    const double end = (d_.step_end > 0 ? d_.step_end : 1) * si("s");
    if (d_.procedure == "*STATIC") {
      tables_ += "\n[time]\nanalysis = \"static\"\n";
      if (!wanted_.empty()) tables_ += fmt::format("end = {}\n", num(end));
    } else if (d_.procedure == "*DYNAMIC") {
      tables_ += fmt::format("\n[time]\nend = {}\n", num(end));
      if (d_.step_increment > 0) tables_ += fmt::format("step = {}\n", num(d_.step_increment * si("s")));
    }
  }

  const InpDeck& d_;
  Imported& in_;
  SetNames& names_;
  const std::map<std::string, std::string>&node_set_, &surface_;
  const ImportOptions& o_;
  std::vector<char> turned_;              // nodes with axes of their own (n_nodes)
  std::set<std::string> used_, wanted_;   // names given; amplitudes that a line scales by
  std::map<std::string, int> made_;       // sets made of single nodes or elements
  std::string head_, tables_;
};

}  // namespace

std::vector<std::int64_t> inp_nodes(const InpDeck& d, const std::string& target, std::int64_t id, const std::string& place) {
  Rows rows;
  if (target.empty()) {
    if (const auto a = d.node.find(id); a != d.node.end()) rows.push_back(a->second);
    else if (!d.unused.count(id)) throw Error(place, fmt::format("no node {}", id));
    return rows;
  }
  const auto set = d.nset.find(target);
  if (set == d.nset.end()) {
    throw Error(place, fmt::format("no node set \"{}\"", target), suggest_name(target, d.nset));
  }
  for (const auto i : set->second.members)
    if (const auto a = d.node.find(i); a != d.node.end()) rows.push_back(a->second);
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

std::vector<std::int64_t> inp_cells(const InpDeck& d, const std::string& target, std::int64_t id, const std::string& place) {
  Rows rows;
  if (target.empty()) {
    const auto c = d.cell.find(id);
    if (c == d.cell.end()) throw Error(place, fmt::format("no element {}", id));
    return {c->second};
  }
  const auto set = d.elset.find(target);
  if (set == d.elset.end()) {
    throw Error(place, fmt::format("no element set \"{}\"", target), suggest_name(target, d.elset));
  }
  for (const auto i : set->second.members)
    if (const auto c = d.cell.find(i); c != d.cell.end()) rows.push_back(c->second);
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

void write_inp_scene(const InpDeck& d, Imported& in, SetNames& names, const std::map<std::string, std::string>& node_set,
                     const std::map<std::string, std::string>& surface, const ImportOptions& options) {
  in.mesh.deck_scene = Writer(d, in, names, node_set, surface, options).text();
}

}  // namespace hilo
