// SPDX-License-Identifier: GPL-3.0-or-later
// hilo as a library: a scene, its run, a number from its results.  A bob swings down from the horizontal; its pin carries at most
// m g (1 + 2 m L^2/(J + m L^2)), which the program asks for.
#include <cmath>
#include <cstdio>

#include "base/error.hpp"
#include "dynamics/run.hpp"
#include "model/store.hpp"

int main() {
  return hilo::guarded("pendulum", [] {
    const auto scene = hilo::Scene::parse(R"(gravity = [0, 0, -9.81]
      [[body]]
      name = "bob"
      mass = 2
      com = [0.5, 0, 0]
      inertia = [0.01, 0.02, 0.02]
      [[joint]]
      kind = "revolute"
      name = "pin"
      b = "bob"
      at = [0, 0, 0]
      axis = [0, 1, 0]
      [time]
      end = 0.6
      step = 1e-3)",
                                          "pendulum");
    const auto system = hilo::build_system(scene, nullptr, hilo::Comm::world());
    const hilo::RunReport report = hilo::run(scene, *system, {.output = "pendulum.h5", .quiet = true});
    const auto pin = hilo::Store::open("pendulum.h5").read<double>("/history/joint/pin");  // n_t x 6: force [N], moment [N m]
    double largest = 0;
    for (size_t i = 0; i < pin.size(); i += 6) largest = std::max(largest, std::hypot(pin[i], pin[i + 1], pin[i + 2]));
    const double exact = 2 * 9.81 * (1 + 2 * 0.5 / (0.02 + 0.5));
    std::printf("%ld steps, the pin carries %.3f N, exact %.3f N\n", report.steps, largest, exact);
    if (!report.complete || std::abs(largest / exact - 1) > 1e-4) throw hilo::Error("", "is wrong");
  });
}
