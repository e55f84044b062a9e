// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes and runs of what moves by a law.
#pragma once
#include "model/scene.hpp"
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test {

inline const std::vector<std::string>& integrators() {
  static const std::vector<std::string> words = choices("time", "integrator");
  return words;
}

inline std::string with(const std::string& integrator) { return "--set 'time.integrator=\"" + integrator + "\"' "; }

/// A cart of 1 kg moved at 1 m/s from t = 0, a bob of 1 kg on a spring of 100 N/m before it.
inline std::string cart(const std::string& history) {
  return body("cart", 1, Vec3::Zero(), {1, 1, 1}) + body("bob", 1, {1, 0, 0}, {1, 1, 1}) +
         spring("axial", "k", "cart", "bob", "at_a = [0, 0, 0]\nat_b = [1, 0, 0]\nstiffness = 100") +
         motion("translation", "drive", "cart", "displacement = [1, 0, 0]\nhistory = " + history) + probe("cart") + probe("bob") +
         in_time(0.15, 0.01);
}

/// A crank of 1 kg, its centre 0.5 m from the axis, turned by a motion; a bob of 1 kg pinned to it at 1 m, with the right velocity.
inline std::string crank(const std::string& history) {
  return body("crank", 1, {0.5, 0, 0}, {0.1, 0.1, 0.1}) + body("bob", 1, {1, 0, 0}, {0.1, 0.1, 0.1}) +
         motion("rotation", "drive", "crank", "at = [0, 0, 0]\naxis = [0, 0, 1]\nangle = 1\nhistory = " + history) +
         joint("spherical", "pin", "crank", "bob", {1, 0, 0}) + probe("bob") + probe("crank") + in_time(0.1, 0.01);
}

class Motions : public Workplace, public testing::Test {
 protected:
  Results solved(const std::string& options = "", const std::string& mesh = "") {
    const Ran ran = run("hilo-solve scene.toml " + mesh + " " + options + " -o run.h5");
    err = ran.err;
    if (ran.exit != 0) throw std::runtime_error("hilo-solve: " + ran.err);
    return Results(*this / "run.h5");
  }
  double reported(const std::string& key) const { return reported_in(*this, key); }
  std::string err;
};

}  // namespace hilo::test
