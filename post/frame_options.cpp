#include "post/frame_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "base/error.hpp"
#include "post/colour.hpp"
#include "post/view.hpp"

namespace hilo {

void add_frame_options(CLI::App& sub, FrameOptions& o) {
  sub.add_option("run", o.run, "run.h5 of hilo-solve")->required();
  sub.add_option("--field", o.field,
                 "von_mises, acceleration, displacement, velocity (or .x .y .z of these), stress.xx, region, fidelity, partition")
      ->capture_default_str();
  sub.add_option("--beside", o.beside, "another run, drawn beside the first at the same instants, camera and colours; may be repeated")
      ->allow_extra_args(false);
  sub.add_option("--minus", o.minus, "a run on the same mesh: its field is subtracted, the difference is drawn");
  sub.add_option("--label", o.label, "caption of each run, in their order; names of the files by default")->allow_extra_args(false);
  sub.add_option("--camera", o.camera, fmt::format("{}, or x,y,z towards the camera", fmt::join(view_names(), ", ")))
      ->capture_default_str();
  sub.add_option("--scale", o.scale, "factor on the displacements")->capture_default_str();
  sub.add_option("--range", o.range, "LOW,HIGH of the colours in the shown unit; by default the range over all that is drawn");
  sub.add_option("--unit", o.unit, "unit shown: MPa, mm, g, ...; a handy one by default");
  sub.add_option("--colours", o.colours,
                 "viridis, cividis (both keep their order in grey print), diverging (blue, white, orange, for signs); auto: diverging "
                 "where values of both signs are drawn")
      ->check(CLI::IsMember({"auto", "viridis", "cividis", "diverging"}))
      ->capture_default_str();
  sub.add_option("--size", o.size, "size of the picture, WIDTHxHEIGHT")->capture_default_str();
  sub.add_option("--edges", o.edges, "none, feature or all")->check(CLI::IsMember({"none", "feature", "all"}))->capture_default_str();
  sub.add_option("--show", o.show, "regions to draw, by name or glob; all by default")->allow_extra_args(false);
  sub.add_option("--hide", o.hide, "regions not to draw")->allow_extra_args(false);
  sub.add_option("--zoom", o.zoom, "regions that fill the picture")->allow_extra_args(false);
  sub.add_option("--title", o.title, "title instead of the scene's");
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
