// SPDX-License-Identifier: GPL-3.0-or-later
// Runs random machines by hand: `machines --family loop --from 1 --to 100`, `machines --family loop --from 7 --to 7 --write /tmp/x`.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>

#include "folder.hpp"
#include "machines/judge.hpp"

using namespace hilo::test;
using hilo::Vec3;

namespace {

/// The largest distance of two ends [m].
double apart(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double worst = 0;
  for (size_t i = 0; i < a.size(); ++i) worst = std::max(worst, (a[i] - b[i]).norm());
  return worst;
}

/// The default at h and h/2 and Radau at h/2 come to the same place: where the default converges, it converges to what Radau finds.
std::string compared(const Machine& m, double h, int steps, const std::string& folder) {
  std::vector<std::vector<Vec3>> end;
  for (const auto& [times, method] : {std::pair<int, std::string>{1, "energy-momentum"}, {2, "energy-momentum"}, {2, "radau"}}) {
    const Outcome o = run_machine(m, {h / times, steps * h, "integrator = \"" + method + "\"\n"}, folder);
    if (!o.complete) return fmt::format("{} at h/{}: exit {} at t = {:.4g} of {:.4g}: {}", method, times, o.exit, o.t, steps * h, o.reason);
    end.push_back(end_positions(m, folder));
  }
  const double step = apart(end[0], end[1]), method = apart(end[1], end[2]);
  if (method <= std::max(2 * step, 1e-6 * m.length())) return "";
  return fmt::format("h to h/2 {:.3g} m, default to radau {:.3g} m", step, method);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Random machines against the solver, judged from outside.");
  std::string family = "all", write, keep;
  std::uint64_t first = 1, last = 20;
  double coarse = 1;
  int steps = 100;
  std::string more, sections;
  bool verbose = false, compare = false;
  Limits limits;
  app.add_option("--family", family, "a family, or all");
  app.add_option("--from", first), app.add_option("--to", last);
  app.add_option("--coarse", coarse, "times the sensible step");
  app.add_option("--steps", steps);
  app.add_option("--time", more, "further lines of [time], such as integrator = \"radau\"");
  app.add_option("--scene", sections, "further sections of the scene, such as [solver]");
  app.add_option("--write", write, "write the scenes of these seeds into this folder and run nothing");
  app.add_option("--keep", keep, "write scenes that are wrong into this folder");
  app.add_option("--energy", limits.energy, "largest change of energy in a run, over the energies at hand; 0: not judged");
  app.add_option("--turn", limits.turn, "largest turn of a body in one step [rad]");
  app.add_flag("--verbose", verbose);
  app.add_flag("--compare", compare, "the end of the default at h and h/2 and of Radau, instead of the judge");
  CLI11_PARSE(app, argc, argv);
  int runs = 0, wrong = 0, stopped = 0, refused = 0;
  for (const Family& f : families()) {
    if (family != "all" && family != f.name) continue;
    for (std::uint64_t seed = first; seed <= last; ++seed) {
      Folder folder;
      Machine m = random_machine(f.name, seed);
      m.more += sections + "\n";
      const double h = coarse * sensible_step(m, folder.path().string());
      const TimeAxis time{h, steps * h, more.empty() ? "" : more + "\n"};
      const std::string label = fmt::format("{}-{}-x{:g}", f.name, seed, coarse);
      if (!write.empty()) {
        std::filesystem::create_directories(write + "/" + label);
        write_machine(m, time, write + "/" + label);
        continue;
      }
      if (compare) {
        const std::string differs = compared(m, h, steps, folder.path().string());
        ++runs, wrong += !differs.empty();
        if (!differs.empty()) fmt::print("{}: {}\n", label, differs);
        continue;
      }
      const Outcome o = run_machine(m, time, folder.path().string(), limits);
      ++runs, wrong += o.complete && !o.verdict.right(), stopped += o.exit == 3, refused += o.exit != 0 && o.exit != 3;
      if (o.complete && !o.verdict.right() && !keep.empty()) {
        std::filesystem::create_directories(keep + "/" + label);
        write_machine(m, time, keep + "/" + label);
      }
      if (verbose || o.exit != 0 || !o.verdict.right())
        fmt::print("{}: exit {} steps {} cuts {} {}\n", label, o.exit, o.steps, o.cuts,
                   o.complete ? o.verdict.text() : fmt::format("t = {:.4g} of {:.4g}: {}", o.t, time.end, o.reason));
      std::fflush(stdout);
    }
  }
  fmt::print("runs {} wrong {} stopped {} refused {}\n", runs, wrong, stopped, refused);
  return wrong ? 1 : 0;
}
