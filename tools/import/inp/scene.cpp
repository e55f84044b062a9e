// SPDX-License-Identifier: GPL-3.0-or-later
// The scene lines that a deck's materials, supports and loads become, and the sets that those lines name.
#include "import/inp/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hilo {

InpScene::InpScene(const InpDeck& d, Imported& in, SetNames& names, const std::map<std::string, std::string>& node_set,
                   const std::map<std::string, std::string>& surface, const ImportOptions& o)
    : d_(d), in_(in), names_(names), node_set_(node_set), surface_(surface), o_(o), turned_(turned_nodes(d, in.mesh)) {
  for (const InpTransform& t : d.transformed)
    for (const auto id : numbers_in(d.nset, t)) own_axes_.insert(id);
  for (const auto& [turns, reference] : d.turns_of)
    if (own_axes_.contains(turns)) own_axes_.insert(reference);
  masses_ = masses_of(d);
  for (const auto& [id, b] : d.beams) of_beams_.insert(b.nodes.begin(), b.nodes.end());
  for (std::int64_t c = 0; c < in.mesh.n_cells() && in.sheets; ++c)
    if (info(in.mesh.shape[c]).dimension != 2) of_solids_.insert(in.mesh.cell(c).begin(), in.mesh.cell(c).end());
}

/// Nothing else would say that such a line does nothing.
void InpScene::tell_empty_sets() {
  const auto tell = [&](const char* card, const InpTarget& t, const std::map<std::string, InpSet>& sets) {
    if (!t.target.empty() && numbers_in(sets, t).empty()) in_.skip(fmt::format("{} on an empty set", card), t.place);
  };
  for (const InpNodal& l : d_.supports) tell("*BOUNDARY", l, d_.nset);
  for (const InpNodal& l : d_.forces) tell("*CLOAD", l, d_.nset);
  for (const InpNodal& l : d_.velocities) tell("*INITIAL CONDITIONS", l, d_.nset);
  for (const InpDistributed& l : d_.distributed)
    if (l.face != 0) tell("*DLOAD", l, d_.elset);
}

SceneWriter InpScene::write() {
  tell_empty_sets();
  gravity();
  materials();
  write_ties(d_, in_, names_, o_, scene_);
  write_beams(d_, in_, names_, o_, scene_);
  supports();
  supports_of_ties();
  slides();
  sums();
  mpcs();
  forces();
  forces_of_ties();
  pressures();
  line_loads();
  centrifugal();
  tied();
  contacts();
  velocities();
  histories();
  time();
  scene_.begin(d_.title, gravity_);
  return scene_;
}

std::string InpScene::set_of(const std::string& target, Rows nodes, const std::string& wish, bool each) {
  sort_unique(nodes);
  const bool as_listed =
      each && (o_.order == 2 || o_.merge || (o_.thicken && is_divided(in_)));  // a force per node stays on the nodes it was given for
  if (!target.empty() && !as_listed) {
    const auto& name = node_set_.at(target);
    if (!name.empty() && in_.mesh.nodes_of(name, name) == nodes) return name;
  }
  const std::string name = names_.nodes(
      target.empty() ? fmt::format("{}_{}", wish, ++made_[wish]) : d_.nset.at(target).name + (as_listed ? "_load" : "_part"), nodes);
  if (as_listed) in_.as_listed.insert(name);
  return name;
}

std::optional<std::string> InpScene::history(const std::string& amplitude, const std::string& what, const std::string& place) {
  if (amplitude.empty()) return "";
  if (const auto a = d_.amplitudes.find(amplitude); a != d_.amplitudes.end() && !a->second.t.empty()) {
    wanted_.insert(amplitude);
    return clean_name(a->second.name);
  }
  in_.skip(fmt::format("{} with *AMPLITUDE {}", what, amplitude), place);
  return std::nullopt;
}

void InpScene::materials() {
  std::set<std::string> used;
  const Mesh& m = in_.mesh;
  std::vector<SceneWriter> regions(m.region_name.size());
  std::vector<int> seen(m.region_name.size(), 0);
  const auto of_cell = section_of_cells(d_);
  for (std::int64_t c = 0; c < m.n_cells(); ++c) {
    const auto r = m.region[c];
    if (!of_cell[c] || seen[r]++) continue;
    const auto& s = *of_cell[c];
    const auto& mat = d_.laws.at(s.law);
    if (!mat.no_law.empty() || (mat.kind == "stvk" && std::isnan(mat.data.E))) {
      const std::string why = mat.no_law.empty() ? "no *ELASTIC" : mat.no_law;
      regions[r].comment(fmt::format("\n# region {}: {} has no law here ({}), give it one", toml_text(m.region_name[r]),
                                     mat.name.empty() ? "it" : "material " + toml_text(mat.name), why));
      in_.skip(fmt::format("*MATERIAL of region {}: no law of hilo ({})", toml_text(m.region_name[r]), why), s.place, 1, false,
               "give it one in the scene");
      continue;
    }
    used.insert(s.law);
    const double alpha = d_.plan.modal ? d_.plan.alpha : mat.alpha, beta = d_.plan.modal ? d_.plan.beta : mat.beta;
    regions[r]
        .add("region", m.region_name[r], "", {{"material", clean_name(mat.name)}})
        .set_if(static_cast<Shape>(m.shape[c]) == Shape::bar2 && s.area > 0, "area", s.area * o_.scale * o_.scale * si("m^2"))
        .set_if(alpha != 0, "mass_damping", alpha / si("s"))
        .set_if(beta != 0, "damping", beta * si("s"))
        .set_if(d_.plan.ratio > 0, "modal_damping", d_.plan.ratio);
  }
  if (!d_.beams.empty() && (d_.plan.alpha != 0 || d_.plan.beta != 0 || d_.plan.ratio > 0)) in_.skip("*MODAL DAMPING of beams", "", 1);
  for (const auto& key : used) d_.laws.at(key).write(scene_, o_);
  for (const auto& region : regions) scene_.append(region);
}

void InpScene::histories() {
  for (const auto& key : wanted_) {
    const auto& a = d_.amplitudes.at(key);
    std::vector<double> t = a.t;
    for (auto& x : t) x *= si("s");
    SceneTable& out = scene_.add("history", clean_name(a.name), "", {{"t", t}, {"value", a.value}});
    if (!a.slopes.empty())
      out.set("interpolation", "spline").set("ends", "clamped").set("slopes", {a.slopes[0] / si("s"), a.slopes[1] / si("s")});
  }
}

/// The step of a dynamic deck.  Where it leaves the step to the program, as without DIRECT, its increment is but the first: a fifth of
/// the time in which a wave runs along the model makes 20 steps of its longest wave, and bending is slower.  1000 steps are enough.
double InpScene::dynamic_step(double end) {
  const double given = d_.plan.increment > 0 ? d_.plan.increment : end;
  if (d_.plan.direct) return given;
  double fastest = 0;
  for (const RegionData& r : in_.mesh.region_data)
    if (r.E > 0 && r.density > 0) fastest = std::max(fastest, std::sqrt(r.E / r.density));
  if (!d_.beams.empty())
    for (const auto& [name, m] : d_.laws)
      if (m.data.E > 0 && m.data.density > 0) fastest = std::max(fastest, std::sqrt(m.data.E / m.data.density));
  const double wave = fastest > 0 ? size_of(d_, in_.mesh) / fastest / 5 : end / 100;
  const double step = std::min({given, std::max(wave, end / 1000), end / 20});
  in_.notes.push_back(fmt::format(
      "*DYNAMIC without DIRECT: a step of {:g}{}", step * si("s"),
      wave < step ? " s, in which waves run on: a shorter one, or a tolerance, resolves them" : " s, which resolves the longest wave"));
  return step;
}

void InpScene::time() {
  const InpPlan& plan = d_.plan;
  const double deck_end = plan.end > 0 ? plan.end : 1, end = deck_end * si("s");
  const std::string start = plan.from_equilibrium ? "equilibrium" : "";
  if (plan.procedure == "*STATIC") {
    int steps = plan.steps;
    const bool yields = std::ranges::any_of(d_.laws, [](const auto& law) { return law.second.kind == "j2"; });
    if ((yields || !d_.contacts.empty() || !d_.every_pair.empty()) &&
        plan.increment > 0)  // what yields or rubs remembers how it came there
      steps = std::max(steps, static_cast<int>(std::ceil(std::min(100., deck_end / plan.increment - 1e-9))));
    scene_.add("time", "", "", {{"analysis", "static"}}).set_if(!wanted_.empty(), "end", end).set_if(steps > 1, "steps", steps);
  } else if (plan.procedure == "*DYNAMIC") {
    scene_.add("time", "", "", {{"end", end}, {"step", dynamic_step(deck_end) * si("s")}, {"start", start}});
  } else if (plan.procedure == "*BUCKLE") {
    scene_.add("time", "", "", {{"analysis", "buckling"}})
        .set_if(!wanted_.empty(), "end", end)
        .set_if(plan.n_modes > 0, "modes", plan.n_modes);
  } else if (plan.procedure == "*FREQUENCY") {
    scene_.add("time", "", "", {{"analysis", "modes"}, {"start", start}}).set_if(plan.n_modes > 0, "modes", plan.n_modes);
    if (const InpSweep& sweep = plan.sweep; sweep.points > 0) {
      const double hertz = 1 / si("s");
      std::string then = fmt::format("hilo-post response modes.h5 --loads --at PROBE.AXIS --from {:g} --to {:g} --points {}",
                                     sweep.from * hertz, sweep.to * hertz, sweep.points);
      if (sweep.ratio > 0) then += fmt::format(" --damping {:g}", sweep.ratio);
      in_.notes.push_back(fmt::format("{}: *STEADY STATE DYNAMICS becomes an analysis of modes, and then `{}`", plan.place, then));
      scene_.comment("# then: " + then);
      std::set<std::string> done;
      for (const std::string& set : d_.printed)
        if (const auto name = node_set_.find(set); name != node_set_.end() && !name->second.empty() && done.insert(set).second)
          scene_.add("probe", name->second, "", {{"on", name->second}});
    }
  }
}

void write_inp_scene(const InpDeck& d, Imported& in, SetNames& names, const std::map<std::string, std::string>& node_set,
                     const std::map<std::string, std::string>& surface, const ImportOptions& options) {
  in.scene = InpScene(d, in, names, node_set, surface, options).write();
}

}  // namespace hilo
