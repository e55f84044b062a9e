// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/scene/frame_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <set>
#include <type_traits>

#include "base/error.hpp"
#include "post/scene/shown_field.hpp"
#include "post/scene/view.hpp"

namespace hilo {

void add_frame_options(CLI::App& sub, FrameOptions& o) {
  sub.add_option("run", o.run, "run.h5 of hilo-solve")->required();
  const auto add = [&](const char* group, const char* name, auto& value, const std::string& meaning) {
    auto* option = sub.add_option(name, value, meaning)->group(group);
    if constexpr (requires { value.push_back(std::string()); } && !std::is_same_v<std::decay_t<decltype(value)>, std::string>)
      option->allow_extra_args(false);
    return option;
  };
  const char *what = "What is drawn", *camera = "Camera", *colours = "Colours and picture";
  add(what, "--field", o.field,
      "von_mises, axial_stress (of beams), stress_error, plastic_strain, contact_pressure, acceleration, displacement, velocity (or .x .y "
      ".z of these), "
      "stress.xx, shell_force.n11, shell_moment.m11, shell_stress.s11, region, fidelity, "
      "partition")
      ->capture_default_str();
  add(what, "--show", o.show, "regions to draw, by name or glob; all by default");
  add(what, "--hide", o.hide, "regions not to draw");
  add(what, "--cut", o.cut,
      "x=0.1 (y, z) or normal and point, 1,0,1@0,0,0.5: what is before this plane is taken away. The plane is that of the positions before "
      "the run, the section moves with the material");
  add(what, "--iso", o.iso, "50,100: surfaces on which the field has these values, in the shown unit, in a transparent model");
  add(what, "--forces", o.forces, "joints, springs, stops, motors, held sets, by name or glob: an arrow of the force on b at its point");
  add(what, "--force-scale", o.force_scale, "force in N of an arrow as long as a tenth of the picture's height; a handy one by default")
      ->check(CLI::PositiveNumber);
  add(what, "--trace", o.trace, "a probe, sensor, region, set, body or x,y,z (the nearest node) whose way is drawn");
  add(what, "--deformed", o.deformed,
      "factor on deformations: what is no rigid motion, of each connected part by itself; of a mode on its whole shape")
      ->capture_default_str();
  add(what, "--scale", o.scale, "factor on whole displacements")->capture_default_str();
  add(what, "--edges", o.edges, "none, feature or all")->check(CLI::IsMember({"none", "feature", "all"}))->capture_default_str();
  add(what, "--beside", o.beside, "another run, drawn beside the first at the same instants, camera and colours");
  add(what, "--minus", o.minus, "a run on the same mesh: its field is subtracted, the difference is drawn");
  add(what, "--label", o.label, "caption of each run, in their order; names of the files by default");
  add(camera, "--camera", o.camera, fmt::format("{}, or x,y,z towards the camera", fmt::join(view_names(), ", ")))->capture_default_str();
  add(camera, "--zoom", o.zoom, "regions that fill the picture");
  add(camera, "--track", o.track, "the camera moves with the centre of this region, set, probe, sensor or body");
  add(camera, "--ride", o.ride, "the camera moves and turns with it");
  add(colours, "--range", o.range, "LOW,HIGH of the colours in the shown unit; by default the range over all that is drawn");
  add(colours, "--unit", o.unit, "unit shown: MPa, mm, g, ...; a handy one by default");
  add(colours, "--colours", o.colours,
      "viridis, cividis (both keep their order in grey print) or diverging (blue, white, orange); auto chooses diverging for values of "
      "both "
      "signs")
      ->check(CLI::IsMember({"auto", "viridis", "cividis", "diverging"}))
      ->capture_default_str();
  add(colours, "--size", o.size, "size of the picture, WIDTHxHEIGHT; letters grow with it")->capture_default_str();
  add(colours, "--title", o.title, "title instead of the scene's");
}

void check(const FrameOptions& o) {
  const auto refuse = [](bool wrong, const char* option, const std::string& what, const char* hint) {
    if (wrong) throw Error(option, what, hint, Exit::usage);
  };
  const bool named = is_named_field(o.field), enlarged = o.scale != 1 || o.deformed != 1;
  refuse(named && !o.minus.empty(), "--minus", fmt::format("{} has no differences", o.field), "choose a field of numbers");
  refuse(named && !o.iso.empty(), "--iso", fmt::format("{} has no values", o.field), "choose a field of numbers");
  refuse(!o.iso.empty() && !o.cut.empty(), "--iso", "and --cut do not go together", "give one");
  refuse(o.scale != 1 && o.deformed != 1, "--deformed", "and --scale both enlarge", "give one");
  refuse(!o.track.empty() && !o.ride.empty(), "--ride", "and --track both move the camera", "give one");
  refuse(enlarged && !o.trace.empty(), "--trace", "needs true positions", "leave --scale or --deformed out");
  refuse(enlarged && !o.forces.empty(), "--forces", "need true positions", "leave --scale or --deformed out");
  refuse(o.label.size() > 1 + o.beside.size(), "--label", fmt::format("{} captions for {} runs", o.label.size(), 1 + o.beside.size()),
         "one for each run");
}

std::pair<double, double> parse_range(const std::string& text) {
  double low = 0, high = 0;
  char comma = 0, rest = 0;
  if (std::sscanf(text.c_str(), "%lf%c%lf%c", &low, &comma, &high, &rest) != 3 || comma != ',' || !(low < high))
    throw Error("--range", fmt::format("\"{}\" is no range", text), "write LOW,HIGH in the shown unit, such as 0,250", Exit::usage);
  return {low, high};
}

std::vector<std::string> distinct_names(const std::vector<std::string>& paths) {
  namespace fs = std::filesystem;
  std::vector<fs::path> rest;
  std::vector<std::string> names;
  for (const auto& p : paths) {
    const fs::path whole = fs::absolute(p).lexically_normal();
    names.push_back(whole.stem().string());
    rest.push_back(whole.parent_path());
  }
  if (std::set<std::string>(paths.begin(), paths.end()).size() < paths.size()) return names;
  // Folders come in front until all differ; out/rigid/run.h5 and out/soft/run.h5 are rigid and soft.
  bool named_by_folder = false;
  while (std::set<std::string>(names.begin(), names.end()).size() < names.size()) {
    bool moved = false;
    const bool same = std::all_of(names.begin(), names.end(), [&](const auto& n) { return n == names.front(); });
    for (size_t i = 0; i < names.size(); ++i) {
      if (!rest[i].has_filename()) continue;  // the root
      const std::string folder = rest[i].filename().string();
      names[i] = same && !named_by_folder ? folder : folder + "/" + names[i];
      rest[i] = rest[i].parent_path();
      moved = true;
    }
    named_by_folder = true;
    if (!moved) break;
  }
  return names;
}

}  // namespace hilo
