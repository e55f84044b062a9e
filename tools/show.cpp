// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-show: what is in a file.
#include <fmt/format.h>

#include "about.hpp"
#include "base/args.hpp"
#include "base/error.hpp"
#include "show/summary.hpp"

namespace {

bool is_scene(const std::string& path) { return path == "-" || path.ends_with(".toml"); }

/// One line on stdout for each file that is whole, one on stderr for each that is not.
void check(const std::vector<std::string>& paths) {
  std::vector<hilo::Error> wrong;
  for (const auto& path : paths) try {
      if (is_scene(path))
        hilo::summary_of_scene(path), fmt::print("{}: ok\n", path);
      else
        fmt::print("{}: {}\n", path, hilo::check_file(path));
    } catch (const hilo::Error& e) {
      wrong.push_back(e);
    }
  for (size_t i = 0; i + 1 < wrong.size(); ++i) fmt::print(stderr, "hilo-show: {}\n", wrong[i].what());
  if (!wrong.empty()) throw wrong.back();
}

}  // namespace

int main(int argc, char** argv) {
  using namespace hilo;
  return guarded("hilo-show", [&] {
    const auto app = make_app({"hilo-show", "Show what a mesh, tags, parts, modes or results file or a scene holds.",
                               "hilo-show mesh.h5\nhilo-show --check mesh.h5", about()});
    std::vector<std::string> paths;
    bool json = false, only_check = false, schema = false;
    app->add_option("files", paths, "mesh.h5, tags.h5, parts-N.h5, reduced.h5, run.h5, scene.toml or - (a scene on stdin)");
    app->add_flag("--check", only_check,
                  "read everything; exit 2 when a file is truncated, damaged or does not fit the files it links to; of a run on its way "
                  "how far it is");
    app->add_flag("--json", json, "as JSON");
    app->add_flag("--schema", schema, "print every array and every key of a scene: what docs/tools/format.py makes docs/format.md of");
    if (!parse(*app, argc, argv)) return;
    if (schema) {
      fmt::print("{}", format_page());
      return;
    }
    if (paths.empty()) throw Error("", "files are required", "see hilo-show --help", Exit::usage);
    if (only_check) return check(paths);
    if (json && paths.size() > 1) throw Error("", "--json is for one file", "", Exit::usage);
    for (size_t i = 0; i < paths.size(); ++i) {
      const Summary s = is_scene(paths[i]) ? summary_of_scene(paths[i]) : summary_of_file(paths[i]);
      fmt::print("{}{}", i ? "\n" : "", json ? s.json() : s.text());
    }
  });
}
