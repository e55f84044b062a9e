// SPDX-License-Identifier: GPL-3.0-or-later
// run.json: what a run says of itself.
#include <fmt/format.h>

#include <set>
#include <stdexcept>

#include "dynamics/profile.hpp"
#include "dynamics/run_parts.hpp"
#include "model/left_out.hpp"

namespace hilo {

namespace {

/// Of positions, in metres and as a share of the motion.
Json error_json(const RunParts& run) {
  const ErrorEstimate& e = run.estimate;
  Json out = Json::object(Json::In::lines);
  const auto add = [&](const char* key, double x) { out.add(key, {x, 6}); };
  if (e.is_there()) {
    out.add("by", e.is_sum() ? "steps" : "a second solution");
    add("end", e.end()), add("end_share", e.share(e.end()));
    add("largest", e.largest()), add("largest_t", e.largest_t()), add("largest_share", e.share(e.largest()));
    add("motion", e.motion());
    if (run.figures.local > 0) add("amplification", e.end() / run.figures.local);
    if (!e.is_sum()) out.add("chaotic", e.is_chaotic()), add("meaningless_from", e.meaningless_from());
  } else {
    out.add("why_not", !e.why().empty() ? e.why() : run.report.steps > 0 ? "too few steps were taken" : "no step was taken");
  }
  if (run.plan.asked > 0) {
    add("asked", run.plan.asked);
    out.add("met", run.report.complete && run.plan.unmet.empty() && e.is_there());
    out.add("passes", Json::list_of(run.plan.passes, [](const StepPlan::Pass& p) -> Json {
              return {{"integrator", p.method}, {"steps", p.steps}, {"end", {p.error, 6}}};
            }));
    if (const std::string why = run.why_better(); !why.empty()) out.add("why_better", why);
  }
  return out;
}

}  // namespace

void write_run_json(const RunParts& run, const Profile& profile, double peak_memory) {
  const System& system = run.system;
  const RunReport& report = run.report;
  const RunFigures& figures = run.figures;
  const Phases& p = phases();
  Json j = Json::object(Json::In::lines);
  j.add("complete", report.complete);
  if (!report.complete) j.add("reason", report.reason);
  j.add("t", {report.t, 12});
  j.add("steps", report.steps);
  j.add("newton_iterations", report.iterations);
  j.add("cuts", report.cuts);
  j.add("length", {system.length, 12});
  j.add("unknowns", 3 * system.layout.map.n_global);
  j.add("bodies", system.bodies.size() - 1);
  j.add("joint_rows", run.redundancy.rows);
  j.add("redundant_rows", run.redundancy.rows - run.redundancy.rank);
  j.add("ranks", system.comm->size);
  j.add("solver", run.solver->name());
  j.add("integrator", run.analysis == Analysis::dynamic ? run.integrator->name() : run.scene.table("time").text("analysis"));
  j.add("clocks", Json::list_of(run.integrator->timed()));
  if (run.analysis == Analysis::dynamic) j.add("error_estimate", error_json(run));
  if (run.plan.asked > 0) j.add("rejected_steps", figures.rejected);
  for (const auto& [key, list] : run.lists) j.add(key, list);
  if (figures.unstable >= 0) j.add("unstable_states", figures.unstable);
  const double det = run.audit->least_det();
  j.add("energy_balance", {run.audit->balance(), 6});
  j.add("constraint_violation", {run.audit->violation(), 6});
  j.add("least_det_F", det < 1e299 ? Json(det, 6) : nullptr);
  j.add("audit", run.audit->json(report.complete ? "" : report.reason));
  for (const Observer* part : system.all<Observer>()) part->add_to_report(j);
  if (report.complete && run.options.more) run.options.more(j);
  j.add("position_change", {figures.assembled, 6});
  j.add("velocity_change", {figures.projected, 6});
  j.add("impulses", run.impulses.json());
  j.add("seconds", {{"all", {profile.rows.back().seconds, 6}},
                    {"assembly", {p.assembly.seconds, 6}},
                    {"solve", {p.solve.seconds, 6}},
                    {"output", {p.output.seconds, 6}}});
  j.add("counts",
        {{"evaluations", p.evaluations}, {"tangents", p.tangents}, {"solves", p.solves}, {"linear_iterations", p.linear_iterations}});
  profile.tell(j);
  j.add("peak_memory_bytes", {peak_memory, 15});
  j.add("left_out", left_out_json(run.scene));
  j.add("mesh", run.options.mesh);
  j.add("scene", run.scene.path);
  j.add("provenance", Json::list_of(run.options.provenance));
  std::set<std::string> keys;
  for (const auto& [key, value] : j.members())
    if (!keys.insert(key).second) throw std::logic_error(fmt::format("run.json has {} twice", key));
  write_text_file(stem(run.options.output) + ".json", j.text() + "\n");
}

}  // namespace hilo
