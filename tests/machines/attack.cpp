// Runs random machines by hand: `machines --family loop --seeds 1-100`, `machines --family loop --seed 7 --write /tmp/x`.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>

#include "folder.hpp"
#include "machines/judge.hpp"

using namespace hilo::test;

int main(int argc, char** argv) {
  CLI::App app("Random machines against the solver, judged from outside.");
  std::string family = "all", write, keep;
  std::uint64_t first = 1, last = 20;
  double coarse = 1;
  int steps = 100;
  std::string more;
  bool verbose = false;
  Limits limits;
  app.add_option("--family", family, "a family, or all");
  app.add_option("--from", first), app.add_option("--to", last);
  app.add_option("--coarse", coarse, "times the sensible step");
  app.add_option("--steps", steps);
  app.add_option("--time", more, "further lines of [time], such as integrator = \"radau\"");
  app.add_option("--write", write, "write the scenes of these seeds into this folder and run nothing");
  app.add_option("--keep", keep, "write scenes that are wrong into this folder");
  app.add_option("--energy", limits.energy, "largest change of energy in a run, over the energies at hand; 0: not judged");
  app.add_option("--turn", limits.turn, "largest turn of a body in one step [rad]");
  app.add_flag("--verbose", verbose);
  CLI11_PARSE(app, argc, argv);
  int runs = 0, wrong = 0, stopped = 0, refused = 0;
  for (const Family& f : families()) {
    if (family != "all" && family != f.name) continue;
    for (std::uint64_t seed = first; seed <= last; ++seed) {
      Folder folder;
      const Machine m = random_machine(f.name, seed);
      const double h = coarse * sensible_step(m, folder.path().string());
      const TimeAxis time{h, steps * h, more.empty() ? "" : more + "\n"};
      const std::string label = fmt::format("{}-{}-x{:g}", f.name, seed, coarse);
      if (!write.empty()) {
        std::filesystem::create_directories(write + "/" + label);
        write_machine(m, time, write + "/" + label);
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
