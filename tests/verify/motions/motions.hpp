// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes and runs of what moves by a law.
#pragma once
#include "model/scene.hpp"
#include "verify/verify.hpp"

namespace hilo::test {

inline const std::vector<std::string>& integrators() {
  static const std::vector<std::string> words = choices("time", "integrator");
  return words;
}

inline std::string with(const std::string& integrator) { return "--set 'time.integrator=\"" + integrator + "\"' "; }

/// A cart of 1 kg moved at 1 m/s from t = 0, a bob of 1 kg on a spring of 100 N/m before it.
inline std::string cart(const std::string& history) {
  return R"([[body]]
name = "cart"
mass = 1
com = [0, 0, 0]
inertia = [1, 1, 1]
[[body]]
name = "bob"
mass = 1
com = [1, 0, 0]
inertia = [1, 1, 1]
[[spring]]
kind = "axial"
name = "k"
a = "cart"
b = "bob"
at_a = [0, 0, 0]
at_b = [1, 0, 0]
stiffness = 100
[[motion]]
kind = "translation"
name = "drive"
on = "cart"
displacement = [1, 0, 0]
history = )" +
         history + R"(
[[probe]]
name = "cart"
on = "cart"
[[probe]]
name = "bob"
on = "bob"
[time]
end = 0.15
step = 0.01
)";
}

/// A crank of 1 kg, its centre 0.5 m from the axis, turned by a motion; a bob of 1 kg pinned to it at 1 m, with the right velocity.
inline std::string crank(const std::string& history) {
  return R"([[body]]
name = "crank"
mass = 1
com = [0.5, 0, 0]
inertia = [0.1, 0.1, 0.1]
[[body]]
name = "bob"
mass = 1
com = [1, 0, 0]
inertia = [0.1, 0.1, 0.1]
[[motion]]
kind = "rotation"
name = "drive"
on = "crank"
at = [0, 0, 0]
axis = [0, 0, 1]
angle = 1
history = )" +
         history + R"(
[[joint]]
kind = "spherical"
name = "pin"
a = "crank"
b = "bob"
at = [1, 0, 0]
[[probe]]
name = "bob"
on = "bob"
[[probe]]
name = "crank"
on = "crank"
[time]
end = 0.1
step = 0.01
)";
}

class Motions : public Workplace, public testing::Test {
 protected:
  Results solved(const std::string& options = "", const std::string& mesh = "") {
    const Ran ran = run("hilo-solve scene.toml " + mesh + " " + options + " -o run.h5");
    err = ran.err;
    if (ran.exit != 0) throw std::runtime_error("hilo-solve: " + ran.err);
    return Results(*this / "run.h5");
  }
  double reported(const std::string& key) const {
    const std::string text = text_of(*this / "run.json");
    const auto at = text.find("\"" + key + "\": ");
    return at == std::string::npos ? std::nan("") : std::stod(text.substr(at + key.size() + 4));
  }
  std::string err;
};

}  // namespace hilo::test
