// SPDX-License-Identifier: GPL-3.0-or-later
// Solid-shells against published vibrations of plates, vibrations of a cylinder, and loads at which cylinders, strips and columns buckle:
// by the frequency that vanishes, and where the path of equilibrium parts.
#include <Eigen/Eigenvalues>
#include <numbers>

#include "verify/shells/shell_scene.hpp"

namespace hilo::test::shells_benchmarks_test {
namespace {

constexpr double pi = std::numbers::pi;

class ShellBenchmarks : public ShellPlace {
 protected:
  void near(const Eigen::VectorXd& f, std::initializer_list<double> published, double limit, int rigid = 0) {
    Eigen::Index k = rigid;
    for (const double p : published) {
      std::printf("%.3f of %.3f: %+.4f\n", f[k], p, f[k] / p - 1);
      EXPECT_NEAR(f[k++] / p, 1, limit) << p;
    }
  }
  /// Share of the load at which the lowest frequency about the equilibrium vanishes: its square is nearly linear just below.
  double by_frequency(const std::function<std::string(double)>& scene, double a, double b) {
    const auto square = [&](double load) {
      const double f = frequencies(scene(load), 1, "start = \"equilibrium\"\n")[0];
      return std::copysign(f * f, f);
    };
    const double fa = square(a), fb = square(b);
    return b + fb * (b - a) / (fa - fb);
  }
  /// The factor of the loads that is the smallest in size.
  double by_factor(const std::string& scene) {
    return solved(scene + "[time]\nanalysis = \"buckling\"\nmodes = 1\n").history("buckling").bottomRows(1)(0, 0);
  }
  /// Share of the load at which the path of equilibrium is told to lose its stability.
  double by_path(const std::string& scene, int steps = 4) {
    work.write("scene.toml", scene + fmt::format("[time]\nanalysis = \"path\"\nsteps = {}\n", steps));
    ran = work.run("hilo-solve scene.toml " + mesh + " -o run.h5");
    const std::string all = ran.out + ran.err, told = "stability is lost at ";
    const size_t at = all.find(told);
    if (ran.exit != 0 || at == all.npos) throw std::runtime_error(all);
    return std::stod(all.substr(at + told.size()));
  }
};

// FV12 and FV16 of [nafems-1990]: a square plate of 10 m, 0.05 m thick, free and clamped at one edge; FV15: a rhombus of 45 degrees,
// clamped.
TEST_F(ShellBenchmarks, ThinPlatesOfNafemsVibrate) {
  const std::string scene = shell_of(2e11, 0.3, "density = 8000");
  use(shell_mesh(plate(10, 10), 16, 16, 0.05));
  near(frequencies(scene, 12), {1.622, 2.360, 2.922, 4.233, 4.233, 7.416}, 0.015, 6);
  near(frequencies(scene + held("xmin"), 6), {0.421, 1.029, 2.582, 3.306, 3.753, 6.555}, 0.015);
  const double c = std::sqrt(0.5);
  Mesh rhombus =
      shell_mesh([=](double u, double v) { return std::pair(Vec3(10 * u + 10 * c * v, 10 * c * v, 0), Vec3(0, 0, 1)); }, 24, 24, 0.05);
  for (int i = 0; i <= 24; ++i)
    for (int j = 0; j <= 24; ++j)
      if (i % 24 == 0 || j % 24 == 0) add_stack(rhombus, "edge", i, j, 24, 24);
  use(rhombus);
  near(frequencies(scene + held("edge"), 6), {7.938, 12.835, 17.941, 19.133, 24.009, 27.922}, 0.03);
}

// Ends that keep round and may move along the axis, R/h 100, L/R 2: Love's three equations [leissa-1973] for a
// wave around and half a wave along.  A
// quarter between planes of symmetry has the even ones.
TEST_F(ShellBenchmarks, ACylinderVibratesAsLovesDoes) {
  const double E = 2e11, nu = 0.3, rho = 7800, R = 1, L = 2, h = 0.01, k = h * h / (12 * R * R);
  const auto love = [&](int m, int n) {
    const double l = m * pi * R / L, l2 = l * l, n2 = n * n;
    Eigen::Matrix3d S;
    S << l2 + (1 - nu) / 2 * n2, -(1 + nu) / 2 * l * n, -nu * l,  //
        0, (1 - nu) / 2 * l2 + n2 + k * (2 * (1 - nu) * l2 + n2), n + k * n * (n2 + (2 - nu) * l2), 0, 0, 1 + k * (l2 + n2) * (l2 + n2);
    S(1, 0) = S(0, 1), S(2, 0) = S(0, 2), S(2, 1) = S(1, 2);
    const double w2 = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(S).eigenvalues()[0];
    return std::sqrt(w2 * E / (rho * (1 - nu * nu))) / R / (2 * pi);
  };
  std::vector<double> expected;
  for (int m = 1; m < 4; ++m)
    for (int n = 0; n < 14; n += 2) expected.push_back(love(m, n));
  std::sort(expected.begin(), expected.end());
  use(shell_mesh(cylinder(R, pi / 2, L), 24, 18, h));
  const Eigen::VectorXd f =
      frequencies(shell_of(E, nu, "density = 7800") + held("ymin", "xz") + held("ymax", "xz") + held("xmin", "x") + held("xmax", "z"), 5);
  near(f, {expected[0], expected[1], expected[2], expected[3]}, 0.035, 1);
}

// Raasch's hook, clamped at one end, sheared across at the other by 1: 4.9352 [knight-1997].
TEST_F(ShellBenchmarks, RaaschsHook) {
  const auto hook = [](double u, double v) -> std::pair<Vec3, Vec3> {
    const double a1 = pi / 3, a2 = 5 * pi / 6, join = 0.125;
    const Vec3 corner(14 * std::sin(a1), 14 * (1 - std::cos(a1)), 0), out(-std::sin(a1), std::cos(a1), 0), centre = corner - 46 * out;
    const double a = u <= join ? a1 * u / join : a1 - a2 * (u - join) / (1 - join);
    const Vec3 n(-std::sin(a), std::cos(a), 0), at = u <= join ? Vec3(14 * std::sin(a), 14 * (1 - std::cos(a)), 0) : Vec3(centre + 46 * n);
    return {at + (20 * v - 10) * Vec3::UnitZ(), -n};
  };
  use([&] {
    Mesh m = shell_mesh(hook, 40, 10, 2);
    add_stack(m, "tip", 40, 5, 40, 10);
    return m;
  }());
  const double P = 1e-3,
               off = way(solved(shell_of(3300, 0.35) + held("xmin") + push("xmax", Vec3(0, 0, P)) + probe("tip") + in_steps(1)), "tip")[2] /
                         (P * 4.9352) -
                     1;
  std::printf("40 x 10: %+.4f\n", off);
  EXPECT_LT(std::abs(off), 0.006);
}

// [sze-2004] 3.3: a ring with a slit, 6 and 10 m in radius, 0.03 m thick, one edge of the slit held, the other lifted by 3.2 N: 13.891 m
// inside and 17.528 outside.
class ShellRing : public ShellBenchmarks {
 protected:
  /// The ways of the inner and the outer corner, of the published ones.
  std::pair<double, double> lifted(int across, int around) {
    use([&] {
      Mesh m = shell_mesh(
          [](double u, double v) {
            const double a = 2 * pi * u;
            return std::pair(Vec3((10 - 4 * v) * Vec3(std::cos(a), std::sin(a), 0)), Vec3(0, 0, 1));
          },
          around, across, 0.03);
      add_stack(m, "out", around, 0, around, across), add_stack(m, "in", around, across, around, across);
      return m;
    }());
    const Results r = solved(shell_of(21e6, 0) + held("xmin") + push("xmax", Vec3(0, 0, 3.2)) + probe("in") + probe("out") + in_steps(5));
    std::printf("%.3f %.3f of 13.891 17.528\n", way(r, "in")[2], way(r, "out")[2]);
    return {way(r, "in")[2] / 13.891, way(r, "out")[2] / 17.528};
  }
};
TEST_F(ShellRing, WithASlitIsLifted) {
  const auto [in, out] = lifted(6, 32);
  EXPECT_NEAR(in, 1, 0.025);
  EXPECT_NEAR(out, 1, 0.02);
}

class DISABLED_LongThinRing : public ShellRing {};
TEST_F(DISABLED_LongThinRing, WithASlitIsLifted) {
  const auto [in, out] = lifted(10, 80);
  EXPECT_NEAR(in, 1, 0.015);
  EXPECT_NEAR(out, 1, 0.015);
}

// Pressed along its axis: sigma = E h/(R sqrt 3) without nu [timoshenko-gere-1961], R/h 100; a quarter, from a plane of symmetry to an end
// that keeps round, as long as three half waves of the ring-shaped mode and a half.
TEST_F(ShellBenchmarks, ACylinderBucklesUnderItsEndLoad) {
  const double E = 2e11, R = 1, h = 0.01, half = pi * std::sqrt(R * h) / std::pow(12, 0.25), critical = E * h / (R * std::sqrt(3));
  use(shell_mesh(cylinder(R, pi / 2, 1.5 * half), 8, 18, h));
  const auto scene = [&](double share) {
    return shell_of(E, 0, "density = 7800") + held("ymin", "y") + held("ymax", "xz") + held("xmin", "x") + held("xmax", "z") +
           fmt::format("[[load]]\nkind = \"traction\"\nname = \"p\"\non = \"ymax\"\ntraction = [0, {}, 0]\n", -share * critical);
  };
  const double vanishes = by_frequency(scene, 0.97, 0.985), parts = 1.2 * by_path(scene(1.2));
  std::printf("axial: %.4f by frequency, %.4f by path, %.4f by factor\n", vanishes, parts, by_factor(scene(1)));
  EXPECT_NEAR(by_factor(scene(1)) / vanishes, 1, 0.02);
  EXPECT_NEAR(vanishes, 1, 0.02);
  EXPECT_NEAR(parts / vanishes, 1, 0.01);
}

// A long one under pressure from outside, one cell of its length: E h^3/(4 (1 - nu^2) R^3) [timoshenko-gere-1961], oval.
TEST_F(ShellBenchmarks, ALongCylinderBucklesUnderPressure) {
  const double E = 2e11, nu = 0.3, R = 1, h = 0.01, critical = E * h * h * h / (4 * (1 - nu * nu) * R * R * R);
  use(shell_mesh(cylinder(R, pi / 2, 0.1), 24, 1, h));
  const auto scene = [&](double share) {
    return shell_of(E, nu, "density = 7800") + held("ymin", "y") + held("ymax", "y") + held("xmin", "x") + held("xmax", "z") +
           fmt::format("[[load]]\nkind = \"pressure\"\nname = \"p\"\non = \"zmax\"\npressure = {}\n", share * critical);
  };
  const double vanishes = by_frequency(scene, 0.8, 0.95), parts = 1.3 * by_path(scene(1.3));
  std::printf("pressure: %.4f by frequency, %.4f by path, %.4f by factor\n", vanishes, parts, by_factor(scene(1)));
  EXPECT_NEAR(by_factor(scene(1)) / vanishes, 1, 0.02);
  EXPECT_NEAR(vanishes, 1, 0.02);
  EXPECT_NEAR(parts / vanishes, 1, 0.01);
}

// A narrow strip loaded across at its end, in its plane, turns out of it at 4.013 sqrt(EI GJ)/L^2 [timoshenko-gere-1961].  Plates have
// J = b h^3/3; the held root, where it cannot warp, makes it 1 to 3 % stiffer.
TEST_F(ShellBenchmarks, AStripBucklesSideways) {
  const double E = 2e11, L = 1, b = 0.05, h = 0.004, EI = E * b * h * h * h / 12, GJ = E / 2 * b * h * h * h / 3,
               critical = 4.013 * std::sqrt(EI * GJ) / (L * L);
  use(shell_mesh(plate(L, b), 40, 4, h));
  const auto scene = [&](double share) {
    return shell_of(E, 0, "density = 7800") + held("xmin") + push("xmax", Vec3(0, -share * critical, 0));
  };
  const double vanishes = by_frequency(scene, 0.98, 0.995), parts = 1.2 * by_path(scene(1.2));
  std::printf("sideways: %.4f by frequency, %.4f by path, %.4f by factor\n", vanishes, parts, by_factor(scene(1)));
  EXPECT_NEAR(std::abs(by_factor(scene(1))) / vanishes, 1, 0.02);
  EXPECT_NEAR(vanishes, 1, 0.035);
  EXPECT_NEAR(parts / vanishes, 1, 0.003);
}

// Pressed at its end: Euler's load.  With 1/1000 of its length, the load shortens it by less than round-off of positions, times the
// stiffness across, bends it; so the frequency vanishes on the way with 1/200 alone.  The path is told whatever that round-off is: it is
// another with two numbers at a time.
TEST_F(ShellBenchmarks, AStripBucklesAsEulersHoweverThin) {
  for (const auto& [h, limit] : {std::pair{0.005, 0.002}, std::pair{0.001, 0.02}}) {
    const double E = 2e11, b = 0.05, critical = pi * pi * E * b * h * h * h / 48;
    use(shell_mesh(plate(1, b), 40, 4, h));
    const auto scene = [&, h = h](double share) {
      return shell_of(E, 0, "density = 7800") + held("xmin") + push("xmax", Vec3(-share * critical, 0, 0));
    };
    const double parts = 1.2 * by_path(scene(1.2)), factor = 1.2 * by_factor(scene(1.2));
    setenv("HILO_LANES", "2", 1);
    const double otherwise = 1.2 * by_path(scene(1.2));
    unsetenv("HILO_LANES");
    std::printf("L/h %.0f: %.4f and %.4f by path, %.4f by factor\n", 1 / h, parts, otherwise, factor);
    EXPECT_NEAR(parts, 1, limit);
    EXPECT_NEAR(otherwise, 1, limit);
    EXPECT_NEAR(factor, 1, limit);
    if (h < 0.005) continue;
    const double vanishes = by_frequency(scene, 0.98, 0.995);
    std::printf("%.4f by frequency\n", vanishes);
    EXPECT_NEAR(vanishes, 1, limit);
  }
}

}  // namespace
}  // namespace hilo::test::shells_benchmarks_test
