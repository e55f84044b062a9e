// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-advise: the cheapest model, rigid and linear regions, that answers to a tolerance.
#include <fmt/format.h>

#include <algorithm>

#include "about.hpp"
#include "advise/report.hpp"
#include "base/args.hpp"
#include "base/error.hpp"
#include "base/interrupt.hpp"
#include "model/inputs.hpp"
#include "post/files/output.hpp"

namespace hilo {
namespace {

struct Options {
  std::string scene, mesh, finer, tolerance = "2%", work = "advise.work", apply, csv, regions;
  std::vector<std::string> overrides, kept_rigid, kept;
  double at_most = 3;
  int at_once = 1;
  bool json = false, full = false, no_full = false;
};

/// The tightest relative tolerance of what is asked; the share of one in units is known after the first run.
double tightest(const Scene& scene, const QuantityTolerance& tol) {
  double least = tol.value;
  bool asked = false;
  for (const Entry& q : scene.entries("quantity")) {
    if (is_of_shapes(q.kind)) continue;
    asked = true;
    const QuantityTolerance own =
        q.has("tolerance") ? parse_tolerance(q.text("tolerance"), unit_of(q).value_or(""), q.where("tolerance")) : tol;
    if (own.relative) least = std::min(least, own.value);
  }
  if (!asked) throw Error(scene.path, "the scene asks for no quantity", "write [[quantity]]: what may not change");
  return least;
}

std::map<size_t, Level> kept_levels(const Options& o, const Candidates& all) {
  const std::vector<std::string>& regions = all.names();
  std::map<size_t, Level> out;
  const auto keep = [&](const char* option, const std::string& name, Level level) {
    const auto at = std::find(regions.begin(), regions.end(), name);
    if (at == regions.end()) throw Error(option, fmt::format("no region \"{}\"", name), suggest(name, regions), Exit::usage);
    const auto r = static_cast<size_t>(at - regions.begin());
    if (all.is_beam(r) && level == Level::stiffening)
      throw Error(option, fmt::format("beam \"{}\" cannot stiffen", name), fmt::format("--keep '{}=linear'", name), Exit::usage);
    if (!out.emplace(r, level).second)
      throw Error(option, fmt::format("says twice how region \"{}\" is kept", name), "once is enough", Exit::usage);
  };
  for (const std::string& name : o.kept_rigid) keep("--keep-rigid", name, Level::rigid);
  for (const std::string& text : o.kept) {
    const size_t equals = text.rfind('=');
    if (equals == std::string::npos) throw Error("--keep", fmt::format("\"{}\" has no level", text), "NAME=LEVEL", Exit::usage);
    keep("--keep", text.substr(0, equals), level_of(text.substr(equals + 1), "--keep"));
  }
  return out;
}

void run(const Options& o) {
  QuantityTolerance tol;
  try {
    tol = parse_tolerance(o.tolerance, "", "--tol");
  } catch (const Error& e) {
    throw Error(e.where, e.message, e.hint, Exit::usage);
  }
  if (!tol.relative) throw Error("--tol", "must be a percentage", "\"2%\"; a quantity may have its own, with a unit", Exit::usage);
  if (o.full && o.no_full) throw Error("--full", "contradicts --no-full", "", Exit::usage);
  for (const std::string& file : {o.apply, o.csv, o.regions})
    if (!file.empty()) check_output(file);
  const std::string mesh = o.mesh.empty() ? Scene::load(o.scene, o.overrides).mesh_path() : o.mesh;
  if (mesh.empty() && !o.finer.empty())
    throw Error("--finer", "there is no mesh", "hilo-advise scene.toml tags.h5 --finer fine.h5", Exit::usage);
  Candidates all({o.scene, mesh, o.finer, o.work, o.overrides, tol.value, o.at_once});
  const Entry& time = all.scene().table("time");
  if (time.text("analysis") != "dynamic" || !time.given("step"))
    throw Error(time.place.text(), "only runs in time with a step are advised on", "analysis = \"dynamic\" and step");
  SearchOptions search;
  search.tightest = tightest(all.scene(), tol);
  search.kept = kept_levels(o, all);
  search.check = o.full ? Check::always : o.no_full ? Check::never : Check::where_in_doubt;
  search.at_most = o.at_most;
  search.each_region = !o.regions.empty();
  const Advice advice = advise(all, search);
  fmt::print("{}", o.json ? report_json(all, advice) : report_text(all, advice));
  if (!o.csv.empty()) write_out(o.csv, models_csv(all, advice));
  if (!o.regions.empty()) write_out(o.regions, regions_csv(all, advice));
  if (!o.apply.empty()) write_out(o.apply, rules(all, advice, "hilo-advise --tol " + o.tolerance));
}

}  // namespace
}  // namespace hilo

int main(int argc, char** argv) {
  using namespace hilo;
  return guarded("hilo-advise", [&] {
    const auto app =
        make_app({"hilo-advise",
                  "The cheapest fidelity of each region (rigid, linear, stiffening, nonlinear) and beam (rigid, linear, nonlinear) "
                  "that keeps the quantities of a scene to a tolerance.",
                  "hilo-advise scene.toml tags.h5 --tol 2% --apply tags.toml", about()});
    Options o;
    app->add_option("scene", o.scene, "scene file (TOML) with [[quantity]]")->required();
    app->add_option("mesh", o.mesh, "mesh.h5 or tags.h5; its own tags do not matter; none of a scene of beams alone");
    app->add_option("--tol", o.tolerance, "tolerance of quantities that say none")->capture_default_str();
    app->add_option("--keep-rigid", o.kept_rigid, "a region that stays rigid (repeatable)")->type_name("NAME")->allow_extra_args(false);
    app->add_option("--keep", o.kept, "a region or beam that stays as given: rigid, linear, stiffening or nonlinear (repeatable)")
        ->type_name("NAME=LEVEL")
        ->allow_extra_args(false);
    app->add_option("--finer", o.finer, "the same regions in smaller cells: the chosen model runs on it too, for the error of the mesh")
        ->type_name("MESH");
    app->add_flag("--full", o.full, "judge by all cells, not only by those of regions whose linear strains are in doubt");
    app->add_flag("--no-full", o.no_full, "never run cells to judge by; the report says what is then unknown");
    app->add_option("--at-most", o.at_most, "what the advice may cost, in runs of all cells; the report has what is found by then")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    app->add_option("-j,--jobs", o.at_once, "runs at a time")->capture_default_str()->check(CLI::PositiveNumber);
    app->add_option("--set", o.overrides, "override a key of the scene (repeatable)")->allow_extra_args(false);
    app->add_option("--work", o.work, "folder of the runs; those that are there are not run again")->capture_default_str();
    app->add_option("--apply", o.apply, "write the choice as rules for hilo-tag: tags.toml")->type_name("FILE");
    app->add_option("--csv", o.csv, "cost and error of every model that ran, for hilo-post chart")->type_name("FILE");
    app->add_option("--regions", o.regions, "error of each region if it were rigid, for hilo-post model --values")->type_name("FILE");
    app->add_flag("--json", o.json, "the tables as JSON");
    if (!parse(*app, argc, argv)) return;
    note_signals();
    run(o);
  });
}
