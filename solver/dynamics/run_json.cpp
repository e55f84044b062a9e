// SPDX-License-Identifier: GPL-3.0-or-later
// run.json: what a run says of itself.
#include <fmt/format.h>

#include <cmath>

#include "base/table.hpp"
#include "dynamics/profile.hpp"
#include "dynamics/run_parts.hpp"
#include "model/left_out.hpp"

namespace hilo {

void write_run_json(const RunParts& run, const Profile& profile, double peak_memory) {
  const System& system = run.system;
  const RunReport& report = run.report;
  const RunFigures& figures = run.figures;
  if (system.comm->rank != 0) return;
  const Phases& p = phases();
  std::string j = "{\n";
  const auto add = [&](const char* key, const std::string& value) { j += fmt::format("  \"{}\": {},\n", key, value); };
  add("complete", report.complete ? "true" : "false");
  if (!report.complete) add("reason", json_text(report.reason));
  add("t", fmt::format("{:.12g}", report.t));
  add("steps", fmt::format("{}", report.steps));
  add("newton_iterations", fmt::format("{}", report.iterations));
  add("cuts", fmt::format("{}", report.cuts));
  add("length", fmt::format("{:.12g}", system.length));
  add("unknowns", fmt::format("{}", 3 * system.map.n_global));
  add("bodies", fmt::format("{}", system.bodies.size() - 1));
  add("joint_rows", fmt::format("{}", run.redundancy.rows));
  add("redundant_rows", fmt::format("{}", run.redundancy.rows - run.redundancy.rank));
  add("ranks", fmt::format("{}", system.comm->size));
  add("solver", json_text(run.solver->name()));
  add("integrator", json_text(run.analysis == Analysis::dynamic ? run.integrator->name() : run.scene.table("time").text("analysis")));
  std::string clocks;
  for (const auto& mechanism : run.integrator->timed()) clocks += (clocks.empty() ? "" : ", ") + json_text(mechanism);
  add("clocks", "[" + clocks + "]");
  if (figures.estimated >= 0) {
    add("estimated_position_error", fmt::format("{:.6g}", figures.estimated));
    add("rejected_steps", fmt::format("{}", figures.rejected));
  }
  if (!figures.modes.empty()) add("modes", figures.modes);
  if (!figures.path.empty()) add("turns", figures.path);
  const double balance = run.audit->balance(), det = run.audit->least_det();
  add("energy_balance", std::isnan(balance) ? "null" : fmt::format("{:.6g}", balance));
  add("constraint_violation", fmt::format("{:.6g}", run.audit->violation()));
  add("least_det_F", det < 1e299 ? fmt::format("{:.6g}", det) : "null");
  add("audit", run.audit->json(report.complete ? "" : report.reason));
  std::vector<std::pair<std::string, std::string>> said;
  for (const auto& part : system.parts()) part->add_to_report(said);
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
