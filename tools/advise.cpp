// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-advise: the cheapest model, rigid and linear regions, that answers to a tolerance.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

#include "about.hpp"
#include "advise/candidates.hpp"
#include "base/args.hpp"
#include "base/error.hpp"
#include "model/store.hpp"

namespace hilo {
namespace {

struct Options {
  std::string scene, mesh, tolerance = "2%", level = "linear", base = "nonlinear", work = "advise.work", apply;
  std::vector<std::string> overrides;
  bool json = false;
};

/// Regions that share nodes with one of those named by quantities of stress, and these themselves.
std::set<size_t> stressed(const Scene& scene, const Mesh& mesh) {
  std::set<size_t> out;
  std::vector<std::vector<std::int64_t>> nodes;
  for (const std::string& name : mesh.region_name) nodes.push_back(mesh.nodes_of(name, scene.path));
  for (auto& list : nodes) std::sort(list.begin(), list.end());
  for (const Entry& q : scene.entries("quantity")) {
    if (!q.has("stress")) continue;
    const auto r =
        static_cast<size_t>(std::find(mesh.region_name.begin(), mesh.region_name.end(), q.text("stress")) - mesh.region_name.begin());
    for (size_t s = 0; s < nodes.size(); ++s) {
      std::vector<std::int64_t> shared;
      std::set_intersection(nodes[r].begin(), nodes[r].end(), nodes[s].begin(), nodes[s].end(), std::back_inserter(shared));
      if (s == r || !shared.empty()) out.insert(s);
    }
  }
  return out;
}

bool wants_raw_acceleration(const Scene& scene) {
  for (const Entry& q : scene.entries("quantity"))
    if (q.kind != "injury" && q.has("sensor") && !q.has("cfc")) return true;
  return false;
}

struct Gates {
  double f_load = 0, jump = 0, theta = 0;
  std::vector<double> f;  // of each region alone  [Hz], 0: none found
};

void run(const Options& o) {
  QuantityTolerance tol;
  try {
    tol = parse_tolerance(o.tolerance, "", "--tol");
  } catch (const Error& e) {
    throw Error(e.where, e.message, e.hint, Exit::usage);
  }
  if (!tol.relative) throw Error("--tol", "is relative", "\"2%\"; a quantity may have its own, with a unit", Exit::usage);
  const Fidelity level = fidelity_of(o.level, "--level");
  if (level == Fidelity::rigid) throw Error("--level", "rigid is what it begins with", "linear or nonlinear", Exit::usage);
  const Fidelity base_level = fidelity_of(o.base, "--base");
  if (base_level == Fidelity::rigid) throw Error("--base", "rigid is what is judged by it", "linear or nonlinear", Exit::usage);
  Candidates all(o.scene, o.mesh, o.overrides, o.work, tol.value);
  const Scene& scene = all.scene();
  const Mesh& mesh = all.mesh().mesh;
  const size_t n = mesh.region_name.size();
  if (scene.table("time").text("analysis") != "dynamic" || !scene.table("time").given("step"))
    throw Error(scene.table("time").place.text(), "only runs in time with a step are advised on", "analysis = \"dynamic\" and step");
  double tightest = tol.value;
  size_t asked = 0;
  for (const Entry& q : scene.entries("quantity")) {
    if (q.kind == "frequency") continue;
    ++asked;
    const QuantityTolerance own =
        q.has("tolerance") ? parse_tolerance(q.text("tolerance"), unit_of(q).value_or(""), q.where("tolerance")) : tol;
    if (own.relative) tightest = std::min(tightest, own.value);
  }
  if (asked == 0) throw Error(scene.path, "the scene asks for no quantity", "write [[quantity]]: what may not change");

  // Linear regions that leave their range judge nothing: in the base they are nonlinear, and it runs again.
  const Assignment rigid(n, Fidelity::rigid), full(n, level);
  Assignment cells(n, base_level);
  for (bool more = true; more;) {
    more = false;
    for (const auto& [r, said] : all.of(cells).beyond)
      if (cells[r] == Fidelity::linear) {
        cells[r] = Fidelity::nonlinear, more = true;
        warn(mesh.region_name[r], said + "; nonlinear in what models are judged by");
      }
  }

  // The base at h and h/2: what a step this long cannot tell no model will.
  const Candidate& base = all.of(cells);
  for (const QuantityValue& v : base.values)
    if (!v.why.empty()) throw Error("", v.why);
  const Candidate& fine = all.of(cells, 0.5);
  std::string worst;
  const double step_part = 4. / 3 * all.difference(base, fine, &worst);
  if (step_part > 0.5) {
    const auto at = std::find_if(base.values.begin(), base.values.end(), [&](const QuantityValue& v) { return v.name == worst; });
    throw Error(scene.table("time").where("step"),
                fmt::format("the step alone makes {:.3g} {} of \"{}\", more than half of the {:.3g} {} allowed", step_part * at->allowed,
                            at->unit, worst, at->allowed, at->unit),
                "a shorter step, or a larger tolerance");
  }

  // The climb.
  Gates gate;
  std::set<size_t> forced = stressed(scene, mesh);
  const bool at_rest = scene.table("time").text("start") == "equilibrium";  // loads of the start are no jump
  const bool raw = wants_raw_acceleration(scene);
  Assignment climbed = raw ? cells : rigid;
  if (!raw) {
    const std::vector<double> modes = all.frequencies(rigid);
    for (size_t r = 0; r < n; ++r) {
      Assignment alone = rigid;
      alone[r] = level;
      gate.f.push_back(elastic_frequency(modes, all.frequencies(alone)));
    }
    for (const size_t r : forced) climbed[r] = level;
    for (bool more = true; more;) {
      more = false;
      gate.f_load = gate.jump = 0;
      for (const LoadHistory& h : all.loads(all.of(climbed)))
        gate.f_load = std::max(gate.f_load, load_frequency(h)), gate.jump = at_rest ? 0 : std::max(gate.jump, load_jump(h));
      gate.theta = forced.empty() ? least_ratio(tightest, gate.jump) : std::max(16., least_ratio(tightest, gate.jump));
      for (size_t r = 0; r < n; ++r)
        if (climbed[r] == Fidelity::rigid && gate.f[r] > 0 && gate.f[r] < gate.theta * gate.f_load) climbed[r] = level, more = true;
    }
  }

  // Real runs decide: all assignments of up to six regions, else one region less at a time.  Where no linear model will do, cells do.
  std::vector<const Candidate*> tried{&base, &all.of(climbed)};
  const auto serves = [&](const Candidate* c) { return all.difference(*c, base) <= 0.5; };
  const auto try_all = [&](Fidelity flexible) {
    for (unsigned k = 0; k < 1u << n; ++k) {
      Assignment a = rigid;
      for (size_t r = 0; r < n; ++r)
        if (k >> r & 1) a[r] = flexible;
      if (std::all_of(forced.begin(), forced.end(), [&](size_t r) { return a[r] == flexible; })) tried.push_back(&all.of(a));
    }
  };
  const auto demote = [&](const Candidate* now) {
    tried.push_back(now);
    for (const Candidate* next = serves(now) ? now : nullptr; next;) {
      next = nullptr;
      for (size_t r = 0; r < n; ++r) {
        if (now->fidelity[r] == Fidelity::rigid || forced.contains(r)) continue;
        Assignment less = now->fidelity;
        less[r] = Fidelity::rigid;
        const Candidate* c = &all.of(less);
        tried.push_back(c);
        if (serves(c) && (!next || c->unknowns < next->unknowns)) next = c;
      }
      if (next) now = next;
    }
  };
  for (const Fidelity flexible : {level, base_level}) {
    if (raw) continue;
    if (n <= 6)
      try_all(flexible);
    else
      demote(&all.of(Assignment(n, flexible)));
    if (flexible == base_level || std::any_of(tried.begin(), tried.end(), [&](const Candidate* c) { return c != &base && serves(c); }))
      break;
  }
  std::sort(tried.begin(), tried.end());
  tried.erase(std::unique(tried.begin(), tried.end()), tried.end());
  std::sort(tried.begin(), tried.end(),
            [](const Candidate* a, const Candidate* b) { return std::pair(a->unknowns, a->seconds) < std::pair(b->unknowns, b->seconds); });
  const Candidate* chosen = *std::find_if(tried.begin(), tried.end(), [&](const Candidate* c) { return all.difference(*c, base) <= 0.5; });

  Table regions{{"region", "level", "base", "f [Hz]", "f over load", "rigid alone: error over allowed"}, {}, 3, 4};
  for (size_t r = 0; r < n; ++r) {
    Assignment less = full;
    less[r] = Fidelity::rigid;
    const auto found = std::find_if(tried.begin(), tried.end(), [&](const Candidate* c) { return c->fidelity == less; });
    const bool known = r < gate.f.size() && gate.f[r] > 0;
    regions.rows.push_back(
        {mesh.region_name[r], std::string(word(chosen->fidelity[r])), std::string(word(cells[r])),
         known ? fmt::format("{:.6g}", gate.f[r]) : "-", known && gate.f_load > 0 ? fmt::format("{:.6g}", gate.f[r] / gate.f_load) : "-",
         found == tried.end() || !std::isfinite(all.difference(**found, base)) ? "-"
                                                                               : fmt::format("{:.6g}", all.difference(**found, base))});
  }
  Table models{{"flexible", "level", "choice", "error over allowed", "largest in", "s", "run"}, {}, 3, 4};
  for (const Candidate* c : tried) {
    std::string in = "-";
    const double d = all.difference(*c, base, &in);
    const auto most = std::find_if(c->fidelity.begin(), c->fidelity.end(), [](Fidelity f) { return f != Fidelity::rigid; });
    models.rows.push_back({all.label(c->fidelity), std::string(word(most == c->fidelity.end() ? Fidelity::rigid : *most)),
                           c == chosen              ? "chosen"
                           : c == &base             ? "base"
                           : c->fidelity == climbed ? "climb"
                                                    : "-",
                           std::isfinite(d) ? fmt::format("{:.6g}", d) : "-", c == &base ? "-" : in, fmt::format("{:.4g}", c->seconds), c->run});
  }
  if (o.json)
    fmt::print(
        "{{\n  \"f_load\": {},\n  \"jump\": {},\n  \"theta\": {},\n  \"step_over_allowed\": {},\n  \"regions\": {},\n  \"models\": "
        "{}\n}}\n",
        json_number(gate.f_load), json_number(gate.jump), json_number(gate.theta), json_number(step_part), regions.json("    "),
        models.json("    "));
  else
    fmt::print("{}\nload {:.4g} Hz, jump {:.3g}, gate {:g}; step (h, h/2): {:.3g} of what is allowed; errors are against the base\n{}",
               regions.text(), gate.f_load, gate.jump, gate.theta, step_part, models.text());
  if (!o.apply.empty()) {
    std::string text = fmt::format("# hilo-advise --tol {}\n", o.tolerance);
    for (const Fidelity f : {Fidelity::rigid, Fidelity::linear, Fidelity::nonlinear}) {
      std::string list;
      for (size_t r = 0; r < n; ++r)
        if (chosen->fidelity[r] == f) list += (list.empty() ? "" : ", ") + json_text(mesh.region_name[r]);
      if (!list.empty()) text += fmt::format("{} = [{}]\n", word(f), list);
    }
    write_text_file(o.apply, text);
  }
}

}  // namespace
}  // namespace hilo

int main(int argc, char** argv) {
  using namespace hilo;
  return guarded("hilo-advise", [&] {
    const auto app =
        make_app({"hilo-advise", "The cheapest model, rigid and linear regions, that keeps the quantities of a scene to a tolerance.",
                  "hilo-advise scene.toml tags.h5 --tol 2% --apply tags.toml", about()});
    Options o;
    app->add_option("scene", o.scene, "scene file (TOML) with [[quantity]]")->required();
    app->add_option("mesh", o.mesh, "mesh.h5 or tags.h5; its own tags do not matter")->required();
    app->add_option("--tol", o.tolerance, "tolerance of quantities that say none")->capture_default_str();
    app->add_option("--level", o.level, "of regions that deform: linear or nonlinear")->capture_default_str();
    app->add_option("--base", o.base,
                    "what all models are judged by: the run with all regions nonlinear, or, where that is out of reach, linear")
        ->capture_default_str();
    app->add_option("--set", o.overrides, "override a key of the scene (repeatable)")->allow_extra_args(false);
    app->add_option("--work", o.work, "folder of the runs; those that are there are not run again")->capture_default_str();
    app->add_option("--apply", o.apply, "write the choice as rules for hilo-tag: tags.toml")->type_name("FILE");
    app->add_flag("--json", o.json, "the tables as JSON");
    if (parse(*app, argc, argv)) run(o);
  });
}
