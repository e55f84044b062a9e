// SPDX-License-Identifier: GPL-3.0-or-later
// run.json: what a run says of itself.
#include <fmt/format.h>

#include <cmath>
#include <set>
#include <stdexcept>

#include "base/table.hpp"
#include "dynamics/profile.hpp"
#include "dynamics/run_parts.hpp"
#include "model/left_out.hpp"

namespace hilo {

namespace {

/// Of positions, in metres and as a share of the motion.
std::string error_json(const RunParts& run) {
  const ErrorEstimate& e = run.estimate;
  std::string out = "{";
  const auto add = [&](const char* key, const std::string& value) {
    out += fmt::format("{}\n    \"{}\": {}", out == "{" ? "" : ",", key, value);
  };
  const auto number = [](double x) { return std::isfinite(x) ? fmt::format("{:.6g}", x) : "null"; };
  if (e.is_there()) {
    add("by", e.is_sum() ? "\"steps\"" : "\"a second solution\"");
    add("end", number(e.end())), add("end_share", number(e.share(e.end())));
    add("largest", number(e.largest())), add("largest_t", number(e.largest_t())), add("largest_share", number(e.share(e.largest())));
    add("motion", number(e.motion()));
    if (run.figures.local > 0) add("amplification", number(e.end() / run.figures.local));
    if (!e.is_sum()) add("chaotic", e.is_chaotic() ? "true" : "false");
    if (!e.is_sum()) add("meaningless_from", number(e.meaningless_from()));
  } else {
    add("why_not", json_text(!e.why().empty() ? e.why() : run.report.steps > 0 ? "too few steps were taken" : "no step was taken"));
  }
  if (run.plan.asked > 0) {
    add("asked", number(run.plan.asked)), add("met", run.report.complete && run.plan.unmet.empty() && e.is_there() ? "true" : "false");
    std::string passes;
    for (const StepPlan::Pass& p : run.plan.passes)
      passes += fmt::format("{}{{\"integrator\": {}, \"steps\": {}, \"end\": {}}}", passes.empty() ? "" : ", ", json_text(p.method),
                            p.steps, number(p.error));
    add("passes", "[" + passes + "]");
    if (const std::string why = run.why_better(); !why.empty()) add("why_better", json_text(why));
  }
  return out + "\n  }";
}

}  // namespace

void write_run_json(const RunParts& run, const Profile& profile, double peak_memory) {
  const System& system = run.system;
  const RunReport& report = run.report;
  const RunFigures& figures = run.figures;
  const Phases& p = phases();
  std::string j = "{\n";
  std::set<std::string> keys;
  const auto add = [&](const char* key, const std::string& value) {
    if (!keys.insert(key).second) throw std::logic_error(fmt::format("run.json has {} twice", key));
    j += fmt::format("  \"{}\": {},\n", key, value);
  };
  add("complete", report.complete ? "true" : "false");
  if (!report.complete) add("reason", json_text(report.reason));
  add("t", fmt::format("{:.12g}", report.t));
  add("steps", fmt::format("{}", report.steps));
  add("newton_iterations", fmt::format("{}", report.iterations));
  add("cuts", fmt::format("{}", report.cuts));
  add("length", fmt::format("{:.12g}", system.length));
  add("unknowns", fmt::format("{}", 3 * system.layout.map.n_global));
  add("bodies", fmt::format("{}", system.bodies.size() - 1));
  add("joint_rows", fmt::format("{}", run.redundancy.rows));
  add("redundant_rows", fmt::format("{}", run.redundancy.rows - run.redundancy.rank));
  add("ranks", fmt::format("{}", system.comm->size));
  add("solver", json_text(run.solver->name()));
  add("integrator", json_text(run.analysis == Analysis::dynamic ? run.integrator->name() : run.scene.table("time").text("analysis")));
  std::string clocks;
  for (const auto& mechanism : run.integrator->timed()) clocks += (clocks.empty() ? "" : ", ") + json_text(mechanism);
  add("clocks", "[" + clocks + "]");
  if (run.analysis == Analysis::dynamic) add("error_estimate", error_json(run));
  if (run.plan.asked > 0) add("rejected_steps", fmt::format("{}", figures.rejected));
  if (!figures.modes.empty()) add("modes", figures.modes);
  if (!figures.buckling.empty()) add("load_factors", figures.buckling);
  if (!figures.path.empty()) add("turns", figures.path);
  if (!figures.jumps.empty()) add("jumps", "[" + figures.jumps + "\n  ]");
  if (figures.unstable >= 0) add("unstable_states", fmt::format("{}", figures.unstable));
  const double balance = run.audit->balance(), det = run.audit->least_det();
  add("energy_balance", std::isnan(balance) ? "null" : fmt::format("{:.6g}", balance));
  add("constraint_violation", fmt::format("{:.6g}", run.audit->violation()));
  add("least_det_F", det < 1e299 ? fmt::format("{:.6g}", det) : "null");
  add("audit", run.audit->json(report.complete ? "" : report.reason));
  std::vector<std::pair<std::string, std::string>> said;
  for (const Observer* part : system.all<Observer>()) part->add_to_report(said);
  for (const auto& [key, value] : said) add(key.c_str(), value);
  if (report.complete && run.options.more)
    for (const auto& [key, value] : run.options.more()) add(key.c_str(), value);
  add("position_change", fmt::format("{:.6g}", figures.assembled));
  add("velocity_change", fmt::format("{:.6g}", figures.projected));
  add("impulses", run.impulses.json());
  add("seconds", fmt::format("{{\"all\": {:.6g}, \"assembly\": {:.6g}, \"solve\": {:.6g}, \"output\": {:.6g}}}",
                             profile.rows.back().seconds, p.assembly.seconds, p.solve.seconds, p.output.seconds));
  add("counts", fmt::format("{{\"evaluations\": {}, \"tangents\": {}, \"solves\": {}, \"linear_iterations\": {}}}", p.evaluations,
                            p.tangents, p.solves, p.linear_iterations));
  j += profile.json();
  add("peak_memory_bytes", fmt::format("{:.0f}", peak_memory));
  add("left_out", left_out_json(run.scene));
  add("mesh", json_text(run.options.mesh));
  add("scene", json_text(run.scene.path));
  std::string list;
  for (const auto& line : run.options.provenance) list += (list.empty() ? "" : ", ") + json_text(line);
  j += fmt::format("  \"provenance\": [{}]\n}}\n", list);
  write_text_file(stem(run.options.output) + ".json", j);
}

}  // namespace hilo
