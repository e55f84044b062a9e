// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.hpp"
#include "dynamics/run.hpp"
#include "machines/judge.hpp"
#include "model/store.hpp"

namespace hilo::test {
namespace {

Outcome solve(const std::string& scene_path, const std::string& results) {
  Outcome out;
  quiet_warnings(true);
  try {
    Comm& comm = Comm::world();
    const Scene scene = Scene::load(scene_path);
    RunOptions options;
    options.output = results, options.quiet = true;
    std::unique_ptr<LocalMesh> mesh;
    if (const Entry& top = scene.table("scene"); top.given("mesh")) {
      options.mesh = (std::filesystem::path(scene.folder) / top.text("mesh")).string();
      mesh = std::make_unique<LocalMesh>(read_local_mesh(options.mesh, comm));
    }
    const auto system = build_system(scene, mesh.get(), comm);
    const RunReport report = run(scene, *system, options);
    out.complete = report.complete, out.reason = report.reason, out.t = report.t;
    out.steps = report.steps, out.cuts = report.cuts;
    out.exit = report.complete ? 0 : 3;
  } catch (const Error& e) {
    out.exit = static_cast<int>(e.exit), out.reason = e.what();
  } catch (const std::exception& e) {
    out.exit = 5, out.reason = e.what();
  }
  return out;
}

}  // namespace

Outcome run_machine(const Machine& m, const TimeAxis& time, const std::string& folder, const Limits& limits) {
  Outcome out = solve(write_machine(m, time, folder), folder + "/run.h5");
  out.step = time.step;
  if (out.complete) out.verdict = judge(m, folder + "/run.h5", limits);
  return out;
}

std::vector<Vec3> end_positions(const Machine& m, const std::string& folder) {
  std::vector<Vec3> out;
  const Store file = Store::open(folder + "/run.h5");
  for (size_t b = 0; b < m.bodies.size(); ++b)
    for (int k = 0; k < 4; ++k) {
      const auto rows = file.read<double>(fmt::format("/history/probe/b{}p{}", b, k));
      const double* last = rows.data() + rows.size() - 9;
      out.emplace_back(last[0], last[1], last[2]);
    }
  return out;
}

double sensible_step(const Machine& m, const std::string& folder) {
  const double g = m.gravity.norm(), size = std::max(0.3, 0.25 * m.length());
  double rate = std::sqrt(g / size) + 0.1;
  Machine still = m;
  const TimeAxis first{1e-7, 1e-7, ""};
  if (solve(write_machine(still, first, folder, "first"), folder + "/first.h5").complete) {
    Limits none;
    none.energy = 0;
    rate = std::max(rate, judge(still, folder + "/first.h5", none).fastest);
  }
  for (const MachineBlock& b : m.blocks) rate = std::max(rate, b.spin.norm());
  for (const MachineSpring& s : m.springs) {
    double lightest = 1e300;
    for (const Side* side : {&s.a, &s.b})
      if (side->of == Side::Of::body) lightest = std::min(lightest, m.bodies[side->body].mass);
    if (s.kind == "axial") rate = std::max(rate, std::sqrt(s.stiffness / lightest) / 2);
  }
  return 0.05 / rate;
}

}  // namespace hilo::test
