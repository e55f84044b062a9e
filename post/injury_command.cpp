// hilo-post injury: what the loads at the sensors do to people, as a table or JSON.
#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "base/args.hpp"
#include "base/error.hpp"
#include "base/table.hpp"
#include "post/cfc.hpp"
#include "post/commands.hpp"
#include "post/injury.hpp"
#include "post/output.hpp"
#include "post/run_file.hpp"

namespace hilo {
namespace {

struct Options {
  std::string run;
  std::vector<std::string> sensors{"*"};
  bool json = false;
};

std::vector<std::string> row_of(const RunFile& run, const std::string& name) {
  const Series series = run.series("sensor." + name);
  const std::string where = fmt::format("{}: sensor \"{}\"", run.path, name);
  // proper acceleration as the seat exerts it; the model starts at rest under gravity, so what it felt then is taken out
  std::array<std::vector<double>, 3> change;
  std::array<std::vector<double>, 3> head, chest;  // CFC 1000 and CFC 180
  std::vector<double> uniform;
  const auto class_of = [&](double wanted) {  // the highest class the record holds
    double longest = 0;
    for (size_t i = 1; i < series.t.size(); ++i) longest = std::max(longest, series.t[i] - series.t[i - 1]);
    return longest <= 0.1 / wanted * (1 + 1e-9);
  };
  const bool fine = class_of(1000), enough = class_of(180);
  for (size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> raw;
    for (size_t i = 0; i < series.rows(); ++i) raw.push_back(series.at(i, axis));
    for (double x : raw) change[axis].push_back(x - raw.front());
    if (fine) head[axis] = cfc_filtered(series.t, raw, 1000, where).x;
    if (enough) {
      Filtered f = cfc_filtered(series.t, raw, 180, where);
      chest[axis] = std::move(f.x), uniform = std::move(f.t);
    }
  }
  const auto resultant = [](const std::array<std::vector<double>, 3>& a) {
    std::vector<double> r;
    for (size_t i = 0; i < a[0].size(); ++i) r.push_back(std::hypot(a[0][i], a[1][i], a[2][i]));
    return r;
  };
  std::vector<std::string> row{name};
  const auto add = [&](double x, int digits) { row.push_back(std::isfinite(x) ? fmt::format("{:.{}f}", x, digits) : "-"); };
  add(dynamic_response_index(series.t, change[2]), 3);
  const std::vector<double> h = resultant(head), c = resultant(chest);
  add(fine ? head_injury(uniform, h, 0.015).value : NAN, 2);
  add(fine ? head_injury(uniform, h, 0.036).value : NAN, 2);
  add(enough ? clip_level(uniform, c) : NAN, 3);
  add(fine ? severity_index(uniform, h) : NAN, 2);
  const Brinkley b = brinkley(series.t, {change[0], change[1], change[2]});
  for (const ModelResponse& r : b.axis) add(r.highest > -r.lowest ? r.highest : r.lowest, 3);
  for (double beta : b.beta) add(beta, 3);
  return row;
}

void run(const Options& o) {
  const RunFile file(o.run);
  Table table;
  table.header = {"sensor", "DRI", "HIC15", "HIC36", "clip_3ms", "SI", "DR_x", "DR_y", "DR_z", "beta_low", "beta_moderate", "beta_high"};
  for (const std::string& name : sensor_names(file, o.sensors)) table.rows.push_back(row_of(file, name));
  write_out("-", o.json ? table.json("") + "\n" : table.text());
  if (!is_quiet() && !o.json)
    fmt::print(
        stderr,
        "DRI: spine model along the sensor's z, from rest, what was felt at the start (1 g) taken out; 17.7: 10 % risk (STANAG 4569).\n"
        "HIC, SI: resultant, CFC 1000; clip_3ms: cumulative, CFC 180 [g]; - where the record is too coarse for the class.\n"
        "DR, beta: Brinkley's model per axis [g] and its combined measure, 1 at the limit of low, moderate, high risk; the limits were\n"
        "not checked against their source and do not replace it.{}\n",
        file.complete ? "" : "  The run is not complete.");
}

}  // namespace

Command injury_command(CLI::App& app) {
  auto* sub = app.add_subcommand("injury", "what the sensors' loads do to people: DRI, HIC, 3 ms clip, severity, Brinkley");
  const auto o = std::make_shared<Options>();
  sub->add_option("run", o->run, "run.h5 of hilo-solve")->required();
  sub->add_option("--sensor", o->sensors, "sensors by name or glob")->allow_extra_args(false)->default_str("*");
  sub->add_flag("--json", o->json, "the table as JSON");
  example(*sub, "  hilo-post injury run.h5");
  return {sub, [o] { run(*o); }};
}

}  // namespace hilo
