// SPDX-License-Identifier: GPL-3.0-or-later
// Curved shells that end at a plane of symmetry: their pairs of nodes lie in it, as those of the whole shell do.
#include <cmath>

#include "../scene_parts.hpp"
#include "import_case.hpp"

namespace hilo::test::curved_borders_test {
namespace {

constexpr double R = 0.1, length = 0.05;

class CurvedBorders : public Import {
 protected:
  /// Quarter of a pipe about z from x to y.
  Mesh quarter(double t, int cells) {
    return imported_deck(
        "quarter.geo",
        fmt::format("Point(1) = {{0, 0, 0}}; Point(2) = {{{0}, 0, 0}}; Point(3) = {{0, {0}, 0}}; Circle(1) = {{2, 1, 3}};\n"
                    "Transfinite Curve{{1}} = {1}; s() = Extrude {{0, 0, {2}}} {{ Curve{{1}}; Layers{{3}}; Recombine; }};\n"
                    "Physical Surface(\"pipe\") = {{s(1)}}; Physical Curve(\"x\") = {{s(3)}}; Physical Curve(\"y\") = {{s(2)}};\n"
                    "Physical Curve(\"z\") = {{1}};\n",
                    R, cells + 1, length),
        fmt::format("--thickness {}", t));
  }
  /// How far the nodes next to a plane are from it at most.
  static double off_plane(const Mesh& m, int axis, double near) {
    double most = 0;
    for (const Vec3& X : m.X)
      if (std::abs(X[axis]) < near) most = std::max(most, std::abs(X[axis]));
    return most;
  }
};

// Its tube widens by Lame's formula; pairs that leaned by half a cell bent it: 13 to 60 % off.
TEST_F(CurvedBorders, OfAQuarterPipeLieInThePlanesOfSymmetry) {
  constexpr double E = 2.1e11, nu = 0.3;
  for (const double t : {R / 50, R / 200}) {
    const Mesh m = quarter(t, 12);
    EXPECT_LT(std::max(off_plane(m, 0, t), off_plane(m, 1, t)), 1e-9 * R);
    const double a = R - t / 2, b = R + t / 2, p = 1e7 * t / R;
    const Vec3& X = m.X[static_cast<size_t>(m.facet_nodes(m.facet_sets.at("pipe_top").front())[0])];
    const std::string inner = std::hypot(X.x(), X.y()) < R ? "pipe_top" : "pipe_bottom";
    place.write("press.toml", solid(E, nu, 7850) + held("y", "x") + held("x", "y") + held("z", "z") +
                                  load("pressure", "p", inner, fmt::format("pressure = {}", p)) + probe("x") + probe("y") + in_steps(1));
    succeeded(place.run("hilo-solve --quiet press.toml out.h5 -o run.h5"));
    const auto at_x = last("probe/x", 9), at_y = last("probe/y", 9);
    const double want = p * a * a / (b * b - a * a) / E * ((1 - nu) * R + (1 + nu) * b * b / R);
    std::printf("R/t %.0f: %.4f, %.4f of Lame\n", R / t, (at_x[0] - R) / want, (at_y[1] - R) / want);
    EXPECT_NEAR((at_x[0] - R) / want, 1, 0.01);
    EXPECT_NEAR((at_y[1] - R) / want, 1, 0.01);
  }
}

// A bend of 30 degrees in one line is a corner of flat plates, and their pairs stand upright.
TEST_F(CurvedBorders, OfFlatPlatesStandUprightBesideABend) {
  const double c = std::cos(M_PI / 6), s = std::sin(M_PI / 6);
  for (const int n : {1, 2, 3}) {
    const Mesh m = imported_deck(
        "bent.geo",
        fmt::format("Point(1) = {{-1, 0, 0}}; Point(2) = {{0, 0, 0}}; Point(3) = {{{0}, 0, {1}}}; Line(1) = {{1, 2}}; Line(2) = {{2, 3}};\n"
                    "Transfinite Curve{{1, 2}} = {2}; s() = Extrude {{0, 1, 0}} {{ Curve{{1, 2}}; Layers{{2}}; Recombine; }};\n"
                    "Physical Surface(\"bent\") = {{s(1), s(5)}};\n",
                    c, s, n + 1),
        "--thickness 0.01");
    EXPECT_LT(std::abs(off_plane(m, 2, 0.006) - 0.005), 1e-12);
    int upright = 0;
    for (const Vec3& X : m.X) upright += std::abs(X.x() + 1) < 1e-12;
    EXPECT_EQ(upright, 6) << n;
  }
}

}  // namespace
}  // namespace hilo::test::curved_borders_test
