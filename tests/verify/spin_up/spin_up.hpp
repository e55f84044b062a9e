// SPDX-License-Identifier: GPL-3.0-or-later
// Simo and Vu-Quoc's beam, whose root turns from rest to 6 rad/s in 15 s: its angle, and u2 of the tip in the frame of the hub.
#pragma once
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test {

struct SpinUpBeam {
  static double psi(double t) {
    return t < 15 ? 0.4 * (t * t / 2 + std::pow(7.5 / M_PI, 2) * (std::cos(2 * M_PI * t / 15) - 1)) : 6 * t - 45;
  }
  /// Turns the root `on` by the table spin.csv, which is written to the place.
  static std::string turned(const Workplace& place, const std::string& on) {
    std::string csv = "t,psi\n";
    for (int i = 0; i <= 900; ++i) csv += fmt::format("{:.17g},{:.17g}\n", 0.02 * i, psi(0.02 * i));
    place.write("spin.csv", csv);
    return motion("rotation", "hub", on,
                  "at = [0, 0, 0]\naxis = [0, 0, 1]\nangle = 1\nhistory = \"psi\"\n[history.psi]\nfile = \"spin.csv\"");
  }
  /// Displacement of the tip of 10 m in the frame of the hub.
  static Vec3 in_hub(double t, const Vec3& tip) { return Eigen::AngleAxisd(-psi(t), Vec3::UnitZ()) * tip - Vec3(10, 0, 0); }
  static constexpr double u2[] = {0,        -0.02054, -0.10238, -0.21726, -0.34227, -0.46846, -0.54360, -0.57133,
                                  -0.54288, -0.46032, -0.36287, -0.25740, -0.15093, -0.06924, -0.02030};  // at 0, 1 ... 14 s
};

}  // namespace hilo::test
