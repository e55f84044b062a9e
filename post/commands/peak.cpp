// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-post peak: the largest value of a field in every region over all steps of a run, with its place and time.
#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "base/args.hpp"
#include "base/error.hpp"
#include "base/table.hpp"
#include "post/charts/ticks.hpp"
#include "post/commands/commands.hpp"
#include "post/files/output.hpp"
#include "post/run/field_peak.hpp"
#include "post/scene/shown_field.hpp"

namespace hilo {
namespace {

struct PeakOptions {
  std::string run, field = "von_mises", steps = "all", times, unit;
  std::vector<std::string> show, hide;
  bool json = false;
};

void run(const PeakOptions& o) {
  RunFile run = judged_run(o.run);
  const bool of_beams = !run.beams().empty() && (o.field == "von_mises" || o.field == "axial_stress");
  if (of_beams && !run.has_mesh()) run.stand_in_bodies();
  const size_t n_own = of_beams || run.has_mesh() ? run.mesh_file().mesh.region_name.size() : 0;  // before the beams
  if (of_beams) run.draw_beams();
  const MeshFile& file = run.mesh_file();
  const Mesh& mesh = file.mesh;
  const auto steps = run.select_steps(o.steps, o.times);
  if (is_named_field(o.field)) throw Error("--field", fmt::format("{} is a name, not a number", o.field), "", Exit::usage);
  const bool of_cells = o.field.starts_with("cell_");
  ShownField field = shown_field(o.field.substr(of_cells ? 5 : 0), run.fields(steps.front()));
  if (of_cells) field.array = o.field;
  std::vector<bool> shown = shown_regions(mesh, o.show, o.hide);
  const bool own = !of_beams || run.store().has("/field/" + steps.front().key + "/" + field.array);  // of the mesh too
  for (size_t r = 0; r < shown.size(); ++r)
    if ((r < n_own && !own) || (field.flexible_only && file.fidelity[r] == Fidelity::rigid) || !run.gives(r, field.array)) shown[r] = false;
  // over all steps of the run, where it has that and nothing less was asked for
  const std::string envelope = o.field + "_envelope";
  const bool of_all = o.steps == "all" && o.times.empty() && run.has_field(steps.back(), envelope);
  const auto of_steps = [&](const std::vector<bool>& regions) {
    return field_peaks(
        run, steps, regions, [&](const Step& step, int r) { return reduced(run.field_in(r, step, field.array), field, run.path); },
        of_cells);
  };
  const auto largest_of_all = [&](const Step& step, int r) {
    auto value = run.field(step, envelope).value;
    if (o.field == "von_mises")
      for (const std::int64_t n : run.own_nodes(r)) value.at(static_cast<size_t>(n)) = 0;  // it is that of another region
    return value;
  };
  const std::vector<bool> sharing = warn_of_envelope(run, shown, of_all ? envelope : o.field);
  for (size_t r = 0; r < shown.size() && !of_all; ++r)
    if (sharing[r]) shown[r] = false;  // it would be that of another region
  auto peaks = of_all ? field_peaks(run, {steps.back()}, shown, largest_of_all) : of_steps(shown);
  if (of_all) {
    const auto t = run.field(steps.back(), envelope + "_time").value;
    for (FieldPeak& p : peaks)
      if (p.place >= 0) p.t = t.at(static_cast<size_t>(p.place));
    std::vector<bool> others = shown;  // that no envelope has: beams, and nodes of which it has the stress of another region
    for (size_t r = 0; r < n_own; ++r) others[r] = sharing[r];
    const auto theirs = of_steps(others);
    for (size_t r = 0; r < shown.size(); ++r)
      if (others[r] && (r >= n_own || std::abs(theirs[r].value) > std::abs(peaks[r].value))) peaks[r] = theirs[r];
  }
  double largest = 0;
  for (const FieldPeak& p : peaks) largest = std::max(largest, std::abs(p.value));
  const ShownUnit unit = o.unit.empty() ? handy_unit(field.unit, largest) : wanted_unit(field.unit, o.unit);
  Table table{
      {"region", fmt::format("{} [{}]", o.field, unit.name), "t [s]", of_cells ? "cell" : "node", "X [m]", "Y [m]", "Z [m]"}, {}, 1};
  if (of_all) table.header.emplace_back("over");
  for (size_t r = 0; r < shown.size(); ++r) {
    if (peaks[r].place < 0) continue;
    Vec3 X = Vec3::Zero();
    const auto nodes = of_cells ? mesh.cell(peaks[r].place) : std::span<const std::int64_t>(&peaks[r].place, 1);
    for (const std::int64_t n : nodes) X += mesh.X[static_cast<size_t>(n)] / static_cast<double>(nodes.size());
    table.rows.push_back({mesh.region_name[r], fmt::format("{:.6g}", peaks[r].value * unit.factor), fmt::format("{:.6g}", peaks[r].t),
                          of_beams && r >= n_own ? "-" : fmt::format("{}", peaks[r].place), fmt::format("{:.5g}", X[0]),
                          fmt::format("{:.5g}", X[1]), fmt::format("{:.5g}", X[2])});
    if (of_all) table.rows.back().emplace_back(r >= n_own || sharing[r] ? "steps written" : "all steps");
  }
  if (table.rows.empty())
    throw Error(run.path,
                fmt::format("all regions asked for are rigid{}: they have no {}",
                            std::ranges::count(sharing, true) ? " or share their nodes" : "", field.label),
                "try --field acceleration");
  write_out("-", o.json ? table.json().text() + "\n" : table.text());
}

}  // namespace

Command peak_command(CLI::App& app) {
  auto* sub = app.add_subcommand(
      "peak",
      "largest value of a field in every region over the steps written, with place and time; over all steps where the run has "
      "output.envelope; of beams von_mises and axial_stress, with the place on the section before the run");
  const auto o = std::make_shared<PeakOptions>();
  sub->add_option("run", o->run, "run.h5 of hilo-solve")->required();
  sub->add_option("--field", o->field,
                  "von_mises, axial_stress (of beams), stress_error, plastic_strain, contact_pressure, acceleration, displacement, "
                  "velocity (or .x .y .z of these), cell_von_mises, cell_plastic_strain, "
                  "stress.xx, "
                  "shell_moment.m11")
      ->capture_default_str();
  sub->add_option("--steps", o->steps, "all, first, last or numbers: 0,5,10:20")->capture_default_str();
  sub->add_option("--times", o->times, "times in s, or FROM:TO, instead of --steps: the nearest ones");
  sub->add_option("--show", o->show, "regions, by name or glob; all by default")->allow_extra_args(false);
  sub->add_option("--hide", o->hide, "regions to leave out")->allow_extra_args(false);
  sub->add_option("--unit", o->unit, "unit shown: MPa, mm, g, ...; a handy one by default");
  sub->add_flag("--json", o->json, "the table as JSON");
  example(*sub, "  hilo-post peak run.h5 --field von_mises --unit MPa");
  return {sub, [o] { run(*o); }};
}

}  // namespace hilo
