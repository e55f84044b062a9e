// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes of stability.md with their truth, written as a user would write them.
#pragma once
#include <sstream>

#include "dynamics/truth.hpp"
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test {

inline std::string integrator(const std::string& kind) { return "--set 'time.integrator=\"" + kind + "\"' "; }

/// A scene, the names of its probe and joint, instants, two steps, and the truth at the instants.
struct OrderCase {
  std::string scene, probe, joint;
  std::array<double, 3> t;
  double coarse, fine;
  std::array<Truth, 3> truth;
  bool by_norm = false;  // force: the joint's frame is not the inertial one
};

struct Errors {
  double x, v, a, force;
};

/// Root of the sum of squares over the instants: a single one may be where an error changes sign.
inline Errors errors(const Workplace& w, const OrderCase& c, const std::string& options, double h) {
  succeeded(w.run("hilo-solve --quiet " + c.scene + " -o run.h5 --set time.step=" + std::to_string(h) +
                  " --set time.end=" + std::to_string(c.t[2] + 10 * h) + " --set solver.tolerance=1e-12 " + options));
  const Results r(w / "run.h5");
  Errors e{};
  for (int i = 0; i < 3; ++i) {
    const auto p = r.at("probe/" + c.probe, c.t[i]);
    const Vec3 force = r.at("joint/" + c.joint, c.t[i]).head<3>();
    const Truth& truth = c.truth[i];
    e.x += (p.head<3>() - truth.x).squaredNorm(), e.v += (p.segment<3>(3) - truth.v).squaredNorm();
    e.a += (p.tail<3>() - truth.a).squaredNorm();
    e.force += c.by_norm ? std::pow(force.norm() - truth.force.norm(), 2) : (force - truth.force).squaredNorm();
  }
  return {std::sqrt(e.x), std::sqrt(e.v), std::sqrt(e.a), std::sqrt(e.force)};
}

/// A number of a run's JSON file.
inline double number_of(const Workplace& w, const std::string& file, const std::string& key) {
  const std::string text = text_of(w / file);
  const auto at = text.find("\"" + key + "\": ");
  return at == std::string::npos ? std::nan("") : std::stod(text.substr(at + key.size() + 4));
}

inline OrderCase pend3d(const Workplace& w) {
  const Vec3 J(0.13333333333333333, 0.77333333333333333, 0.69333333333333333);
  w.write("pend3d.toml", "gravity = [0, 0, -9.81]\n" + body("brick", 8, {0.5, 0.1, 0.2}, J) +
                             joint("spherical", "corner", "ground", "brick", Vec3::Zero()) +
                             "[[initial]]\non = [\"brick\"]\nspin = [0.5, 1, 2]\nabout = [0, 0, 0]\n"
                             "[[probe]]\nname = \"far\"\non = \"brick\"\nat = [1, 0.2, 0.4]\n[[sensor]]\nname = \"seat\"\non = "
                             "\"brick\"\nat = [1, 0.2, 0.4]\n[time]\nend = 1\n");
  const FixedPoint truth{8, {0.5, 0.1, 0.2}, J.asDiagonal(), {0.5, 1, 2}, {0, 0, -9.81}, {1, 0.2, 0.4}};
  return {"pend3d.toml", "far", "corner", {0.3, 0.4, 0.5}, 2e-3, 5e-4, {truth.at(0.3, 6000), truth.at(0.4, 8000), truth.at(0.5, 10000)}};
}

inline OrderCase top(const Workplace& w) {
  const Vec3 J(0.234375, 0.46875, 0.234375), spin(0, 150, -4.61538);
  w.write("top.toml", "gravity = [0, 0, -9.81]\n" + body("top", 15, {0, 1, 0}, J) +
                          joint("spherical", "pivot", "ground", "top", Vec3::Zero()) +
                          "[[initial]]\non = [\"top\"]\nspin = [0, 150, -4.61538]\nabout = [0, 0, 0]\n"
                          "[[probe]]\nname = \"tip\"\non = \"top\"\n[time]\nend = 1\n");
  const FixedPoint truth{15, {0, 1, 0}, J.asDiagonal(), spin, {0, 0, -9.81}, {0, 1, 0}};
  return {"top.toml", "tip", "pivot", {0.06, 0.08, 0.1}, 2e-4, 5e-5, {truth.at(0.06, 12000), truth.at(0.08, 16000), truth.at(0.1, 20000)}};
}

inline OrderCase slider(const Workplace& w) {
  const SliderCrank m;
  const double c = std::cos(m.theta), s = std::sin(m.theta), d = std::sqrt(m.l * m.l - m.r * m.r * s * s);
  const Vec3 pin(m.r * c, m.r * s, 0), wrist(m.r * c + d, 0, 0);
  const auto rod = [](double mass, double length) { return Vec3(1e-3, mass * length * length / 12, mass * length * length / 12); };
  const auto axes = [](const Vec3& u) {
    std::ostringstream o;
    o.precision(17);
    o << "axes = [" << u[0] << ", " << u[1] << ", 0, " << -u[1] << ", " << u[0] << ", 0, 0, 0, 1]\n";
    return o.str();
  };
  const std::string z = "axis = [0, 0, 1]\n";
  w.write("slider.toml", body("crank", m.m1, pin / 2, rod(m.m1, m.r), axes(pin / m.r)) +
                             body("rod", m.m2, (pin + wrist) / 2, rod(m.m2, m.l), axes((wrist - pin) / m.l)) +
                             body("block", m.m3, wrist, Vec3(1e-3, 1e-3, 1e-3)) +
                             joint("revolute", "main", "ground", "crank", Vec3::Zero(), z) +
                             joint("revolute", "pin", "crank", "rod", pin, z) + joint("spherical", "wrist", "rod", "block", wrist) +
                             joint("prismatic", "guide", "ground", "block", wrist, "axis = [1, 0, 0]\n") +
                             "[[initial]]\non = [\"crank\"]\nspin = [0, 0, 6]\nabout = [0, 0, 0]\n"
                             "[[probe]]\nname = \"block\"\non = \"block\"\n[time]\nend = 1\n");
  OrderCase out{"slider.toml", "block", "guide", {0.16, 0.2, 0.24}, 4e-3, 1e-3, {}, true};
  // the start: velocities of rod and block are found by the projection, in the mass norm, from the crank's alone, m1 r^2/3 of the
  // inertia M(theta); the crank slows down
  SliderCrank truth = m;
  truth.rate = m.rate * m.m1 * m.r * m.r / 3 / m.inertia(m.theta);
  for (int i = 0; i < 3; ++i) out.truth[i] = truth.at(out.t[i], 20000);
  return out;
}

/// stability.md's DPSMOOTH: a rod and a soft beam of four hexahedra, from rest, loads ramped up with three continuous derivatives.
inline OrderCase dpsmooth(const Workplace& w) {
  const Vec3 along(0.8, 0, -0.6), up(0.6, 0, 0.8);
  const BlockOptions o{.n = {4, 1, 1},
                       .low = {1, -0.05, -0.05},
                       .high = {2, 0.05, 0.05},
                       .map = [&](const Vec3& x) { return Vec3(x[0] * along + x[1] * Vec3::UnitY() + x[2] * up); },
                       .regions = {"beam"}};
  write_mesh(w / "beam.h5", block_mesh(o), {"test"});
  w.write("dpsmooth.toml",
          "mesh = \"beam.h5\"\n[material.soft]\nE = 5e6\nnu = 0.3\ndensity = 500\n[region.beam]\nmaterial = \"soft\"\n" +
              body("rod", 2, along / 2, Vec3(0.01, 1. / 6, 1. / 6), "axes = [0.8, 0, -0.6, 0, 1, 0, 0.6, 0, 0.8]\n") +
              joint("spherical", "pin", "ground", "rod", Vec3::Zero()) + joint("spherical", "middle", "rod", "xmin", along) +
              "[[load]]\nkind = \"force\"\nname = \"of rod\"\non = \"rod\"\nforce = [3, 8, -19.62]\nhistory = \"ramp\"\n"
              "[[load]]\nkind = \"force\"\nname = \"of beam\"\non = \"surface\"\nforce = [5, -5, -49.05]\nhistory = \"ramp\"\n"
              "[history.ramp]\nt = [0, 0.5]\nvalue = [0, 1]\ninterpolation = \"smoother\"\n"
              "[[probe]]\nname = \"tip\"\non = \"xmax\"\n[time]\nend = 1\n");
  OrderCase out{"dpsmooth.toml", "tip", "middle", {0.36, 0.38, 0.4}, 1e-3, 5e-4, {}, true};
  static const std::array<Truth, 3> truth = [&] {
    const Ran ran =
        w.run("hilo-solve --quiet dpsmooth.toml -o truth.h5 --set time.step=5e-4 --set time.end=0.42 --set solver.tolerance=1e-12 " +
              integrator("radau"));
    EXPECT_EQ(ran.exit, 0) << ran.err;
    const Results r(w / "truth.h5");
    std::array<Truth, 3> list;
    for (int i = 0; i < 3; ++i) {
      const auto p = r.at("probe/tip", out.t[i]);
      list[i] = {p.head<3>(), p.segment<3>(3), p.tail<3>(), r.at("joint/middle", out.t[i]).head<3>(), Mat3::Identity()};
    }
    return list;
  }();
  out.truth = truth;
  return out;
}

}  // namespace hilo::test
