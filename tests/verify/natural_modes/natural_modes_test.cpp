// SPDX-License-Identifier: GPL-3.0-or-later
// Natural frequencies against closed forms: `analysis = "modes"` of bodies, cells, linear regions, preloads and what nothing holds.
#include <complex>
#include <numbers>
#include <sstream>
#include <tuple>

#include "verify/verify.hpp"

namespace hilo::test {
namespace {

constexpr double pi = std::numbers::pi;
const std::string steel = "[material.m]\nE = 2e11\nnu = 0\ndensity = 8000\n[region.\"*\"]\nmaterial = \"m\"\n";

class NaturalModes : public testing::Test {
 protected:
  /// Rows of /history/mode, the state of rest left out.
  Eigen::MatrixXd modes(const std::string& scene, int wanted, const std::string& options = "") {
    work.write("scene.toml", scene + "[time]\nanalysis = \"modes\"\nmodes = " + std::to_string(wanted) + "\n");
    ran = work.run("hilo-solve scene.toml " + mesh + " -o run.h5 " + options);
    EXPECT_EQ(ran.exit, 0) << ran.err;
    if (ran.exit != 0) return Eigen::MatrixXd::Zero(wanted, 10);
    const Eigen::MatrixXd all = Results(work / "run.h5").history("mode");
    EXPECT_LT(all.col(8).maxCoeff(), 1e-5) << "shapes satisfy the equations";
    return all.bottomRows(all.rows() - 1);
  }
  Eigen::VectorXd frequencies(const std::string& scene, int wanted) { return modes(scene, wanted).col(0); }
  void use(const Mesh& m, const std::vector<Fidelity>& fidelity = {}) {
    write_mesh(work / "mesh.h5", m, {"test"});
    mesh = "mesh.h5";
    if (fidelity.empty()) return;
    write_tags(work / "tags.h5", work / "mesh.h5", fidelity, {"test"});
    mesh = "tags.h5";
  }
  Workplace work;
  std::string mesh;
  Ran ran;
};

std::string body(const std::string& name, double mass, const Vec3& com, const Vec3& inertia) {
  return "[[body]]\nname = \"" + name + "\"\nmass = " + std::to_string(mass) + "\ncom = [" + std::to_string(com[0]) + ", " +
         std::to_string(com[1]) + ", " + std::to_string(com[2]) + "]\ninertia = [" + std::to_string(inertia[0]) + ", " +
         std::to_string(inertia[1]) + ", " + std::to_string(inertia[2]) + "]\n";
}

Mesh beam(const Vec3& size, int n) {
  BlockOptions o;
  o.shape = Shape::hex20r;
  o.n[0] = n;
  o.high = size;
  return block_mesh(o);
}

/// Timoshenko's beam by its two bending branches would be more than a slender one needs: corrections of order (r/L)^2 are below 2e-4 here.
const double r_z = 0.01 / std::sqrt(12), r_y = 0.015 / std::sqrt(12), wave = std::sqrt(2e11 / 8000);  // radii of gyration [m], bar speed
double bending(double beta_l, double r) { return beta_l * beta_l * r * wave / (2 * pi); }             // of a beam 1 m long  [Hz]

TEST_F(NaturalModes, OfACantileverAreThoseOfItsBeam) {
  use(beam({1, 0.015, 0.01}, 30));
  const auto f = frequencies(steel + "[[motion]]\nkind = \"fixed\"\nname = \"wall\"\non = \"xmin\"\n", 4);
  EXPECT_NEAR(f[0] / bending(1.87510407, r_z), 1, 1e-3);
  EXPECT_NEAR(f[1] / bending(1.87510407, r_y), 1, 1e-3);
  EXPECT_NEAR(f[2] / bending(4.69409113, r_z), 1, 2e-3);
  EXPECT_NEAR(f[3] / bending(4.69409113, r_y), 1, 3e-3);
}

TEST_F(NaturalModes, OfAFreeBeamAreSixRigidMotionsAndThoseOfItsBeam) {
  use(beam({1, 0.015, 0.01}, 30));
  const auto m = modes(steel, 9);
  for (int k = 0; k < 6; ++k) EXPECT_LT(std::pow(m(k, 0) / m(6, 0), 2), 1e-8) << k << ", of omega^2: what rounding makes of K";
  EXPECT_NEAR(m(6, 0) / bending(4.73004074, r_z), 1, 2e-3);
  EXPECT_NEAR(m(7, 0) / bending(4.73004074, r_y), 1, 2e-3);
  for (int k = 2; k < 5; ++k)
    EXPECT_NEAR(m.col(k).head(6).sum(), 8000 * 0.015 * 0.01, 1e-9 * 1.2) << "rigid modes carry all of the mass along an axis";
  EXPECT_LT(m.col(2).tail(3).cwiseAbs().maxCoeff(), 1e-12) << "and vibrations none";
}

// All nodes of a face move along its normal alone: Navier's plate, with Mindlin's shear and rotary inertia.
TEST_F(NaturalModes, OfASupportedPlateAreNavierAndMindlins) {
  BlockOptions o;
  o.shape = Shape::hex20r;
  o.n[0] = o.n[1] = 8;
  o.high = Vec3(1, 1, 0.02);
  use(block_mesh(o));
  std::string held;
  for (const char* face : {"xmin", "xmax", "ymin", "ymax"})
    held += std::string("[[motion]]\nkind = \"fixed\"\nname = \"") + face + "\"\non = \"" + face + "\"\ncomponents = [\"" +
            (face[0] == 'x' ? 'y' : 'x') + "\", \"z\"]\n";
  const auto f = frequencies(steel + held, 3);
  const auto mindlin = [](int m, int n) {
    const double E = 2e11, nu = 0, rho = 8000, h = 0.02, k2 = pi * pi * (m * m + n * n), D = E * h * h * h / (12 * (1 - nu * nu)),
                 S = 5. / 6 * E / (2 * (1 + nu)) * h, I = rho * h * h * h / 12;
    // (D k^4 - w^2 (rho h + k^2 (I + rho h D/S)) + w^4 I rho h/S = 0
    const double a = I * rho * h / S, b = rho * h + k2 * (I + rho * h * D / S), c = D * k2 * k2;
    return std::sqrt((b - std::sqrt(b * b - 4 * a * c)) / (2 * a)) / (2 * pi);
  };
  EXPECT_NEAR(f[0] / mindlin(1, 1), 1, 1e-3);
  EXPECT_NEAR(f[1] / mindlin(1, 2), 1, 3e-3);
  EXPECT_NEAR(f[2] / f[1], 1, 1e-6) << "twice, by symmetry";
}

TEST_F(NaturalModes, OfARingAreHoppes) {
  const double R = 1, h = 0.02;
  const int n = 48;
  BlockOptions o;
  o.shape = Shape::hex20r;
  o.n[0] = n;
  o.low = Vec3(0, R - h / 2, 0), o.high = Vec3(2 * pi, R + h / 2, 2 * h);  // out of its plane it is stiffer
  Mesh m = block_mesh(o);
  for (Vec3& x : m.X) x = Vec3(x[1] * std::cos(x[0]), -x[1] * std::sin(x[0]), x[2]);
  // the last face is the first
  std::vector<std::int64_t> same(m.X.size());
  for (size_t i = 0; i < m.X.size(); ++i) {
    same[i] = static_cast<std::int64_t>(i);
    for (size_t j = 0; j < i; ++j)
      if ((m.X[i] - m.X[j]).norm() < 1e-9) same[i] = static_cast<std::int64_t>(j);
  }
  std::vector<std::int64_t> row(m.X.size(), -1);
  std::vector<Vec3> X;
  for (size_t i = 0; i < m.X.size(); ++i)
    if (same[i] == static_cast<std::int64_t>(i)) row[i] = static_cast<std::int64_t>(X.size()), X.push_back(m.X[i]);
  for (auto& node : m.nodes) node = row[same[node]];
  m.X = X, m.node_id.resize(X.size());
  m.facet_sets.clear();
  use(m);
  const auto f = frequencies(steel, 10);
  const auto hoppe = [&](int k) {  // bending in the plane
    return k * (k * k - 1) / std::sqrt(k * k + 1.) * wave * h / std::sqrt(12) / (R * R) / (2 * pi);
  };
  int seen = 0;
  for (int j = 6; j < 10; ++j) seen += std::abs(f[j] / hoppe(2) - 1) < 2e-3;
  EXPECT_EQ(seen, 2) << "two of a kind\n" << f;
}

TEST_F(NaturalModes, OfPendulumsAreSmallSwings) {
  const std::string hung = "gravity = [0, 0, -9.81]\n" + body("arm", 2, {0, 0, -0.5}, {0.1, 0.2, 0.15}) +
                           "[[joint]]\nkind = \"revolute\"\nname = \"pin\"\nb = \"arm\"\nat = [0, 0, 0]\naxis = [0, 1, 0]\n";
  auto m = modes(hung, 10);
  ASSERT_EQ(m.rows(), 1) << "one freedom, one mode";
  EXPECT_NEAR(m(0, 0), std::sqrt(2 * 9.81 * 0.5 / (0.2 + 2 * 0.25)) / (2 * pi), 1e-10);
  // upside down it falls
  m = modes("gravity = [0, 0, 9.81]\n" + hung.substr(hung.find('\n') + 1), 10);
  EXPECT_NEAR(m(0, 0), -std::sqrt(2 * 9.81 * 0.5 / (0.2 + 2 * 0.25)) / (2 * pi), 1e-10);
  // two equal points on equal threads: omega^2 = (2 -+ sqrt 2) g/l
  m = modes("gravity = [0, 0, -9.81]\n" + body("a", 1, {0, 0, -1}, {1e-6, 1e-6, 1e-6}) + body("b", 1, {0, 0, -2}, {1e-6, 1e-6, 1e-6}) +
                "[[joint]]\nkind = \"revolute\"\nname = \"pin\"\nb = \"a\"\nat = [0, 0, 0]\naxis = [0, 1, 0]\n"
                "[[joint]]\nkind = \"revolute\"\nname = \"link\"\na = \"a\"\nb = \"b\"\nat = [0, 0, -1]\naxis = [0, 1, 0]\n",
            10);
  ASSERT_EQ(m.rows(), 2);
  for (int k = 0; k < 2; ++k) EXPECT_NEAR(m(k, 0), std::sqrt((2 + (k ? 1 : -1) * std::sqrt(2)) * 9.81) / (2 * pi), 1e-5);
}

TEST_F(NaturalModes, OfAStringOfBeadsAreLagranges) {
  // beads on springs that pull with T: transverse omega = 2 sqrt(T/(m a)) sin(k pi/(2 (n + 1))), each in two planes
  const int n = 5;
  const double T = 100, a = 0.2, m = 0.1, stiffness = 1e5;
  std::string scene;
  for (int i = 1; i <= n; ++i) scene += body("b" + std::to_string(i), m, {i * a, 0, 0}, {1e-6, 1e-6, 1e-6});
  for (int i = 0; i <= n; ++i) {
    scene += "[[spring]]\nkind = \"axial\"\nname = \"s" + std::to_string(i) + "\"\n";
    scene += i == 0 ? "a = \"ground\"\n" : "a = \"b" + std::to_string(i) + "\"\n";
    scene += i == n ? "b = \"ground\"\n" : "b = \"b" + std::to_string(i + 1) + "\"\n";
    scene += "at_a = [" + std::to_string(i * a) + ", 0, 0]\nat_b = [" + std::to_string((i + 1) * a) +
             ", 0, 0]\nstiffness = " + std::to_string(stiffness) + "\nlength = " + std::to_string(a - T / stiffness) + "\n";
  }
  const auto f = frequencies(scene, 3 * n + 2 * n + n);  // turns of the beads too: all there are
  std::vector<double> bent;
  for (const double x : f)
    if (x > 0.1) bent.push_back(x);
  for (int k = 1; k <= n; ++k) {
    const double exact = 2 * std::sqrt(T / (m * a)) * std::sin(k * pi / (2 * (n + 1))) / (2 * pi);
    const auto near = std::count_if(bent.begin(), bent.end(), [&](double x) { return std::abs(x / exact - 1) < 1e-9; });
    EXPECT_EQ(near, 2) << exact;
  }
}

TEST_F(NaturalModes, OfAVehicleOnSpringsAreBounceAndPitch) {
  const double m = 1000, J = 1500, kf = 3e4, kr = 4e4, a = 1.2, b = 1.6;
  const auto corner = [](const std::string& name, double x, double k, double c) {
    return "[[spring]]\nkind = \"bushing\"\nname = \"" + name + "\"\nb = \"car\"\nat = [" + std::to_string(x) +
           ", 0, 0]\nstiffness = [0, 0, " + std::to_string(k) + "]\ndamping = [0, 0, " + std::to_string(c) + "]\n";
  };
  const std::string plane = "[[joint]]\nkind = \"planar\"\nname = \"road\"\nb = \"car\"\nat = [0, 0, 0]\naxis = [0, 1, 0]\n";
  const auto all = modes(body("car", m, {0, 0, 0}, {J, J, J}) + corner("front", a, kf, 300) + corner("rear", -b, kr, 400) + plane, 3);
  const double A = (kf + kr) / m, B = (kf * a * a + kr * b * b) / J, C = (kf * a - kr * b) / std::sqrt(m * J);
  EXPECT_NEAR(all(0, 0), 0, 1e-6) << "it rolls along";
  for (int k = 0; k < 2; ++k) {
    const double omega = std::sqrt((A + B) / 2 + (k ? 1 : -1) * std::sqrt((A - B) * (A - B) / 4 + C * C));
    EXPECT_NEAR(all(1 + k, 0), omega / (2 * pi), 1e-9);
    EXPECT_NEAR(all(1 + k, 1), 0.01 * omega / 2, 1e-6) << "damping is .01 s times stiffness";
  }
}

// Fifteen equal oscillators: each copy of a frequency is found.
TEST_F(NaturalModes, CountEveryCopy) {
  std::string scene;
  for (int i = 0; i < 15; ++i) {
    const std::string name = "b" + std::to_string(i), at = "[" + std::to_string(i) + ", 0, 0]";
    scene += body(name, 1, {double(i), 0, 0}, {1, 1, 1}) + "[[joint]]\nkind = \"prismatic\"\nname = \"j" + name + "\"\nb = \"" + name +
             "\"\nat = " + at + "\naxis = [0, 0, 1]\n[[spring]]\nkind = \"bushing\"\nname = \"s" + name + "\"\nb = \"" + name +
             "\"\nat = " + at + "\nstiffness = [0, 0, " + (i < 12 ? "100" : "400") + "]\n";
  }
  const auto f = frequencies(scene, 20);
  ASSERT_EQ(f.size(), 15);
  for (int i = 0; i < 15; ++i) EXPECT_NEAR(f[i], (i < 12 ? 10 : 20) / (2 * pi), 1e-9);
}

// Held, on a hinge with a spring, with a body on a joint, with a mass on its end, under a load: linear regions are what their cells are.
TEST_F(NaturalModes, OfLinearRegionsAreThoseOfTheirCells) {
  const std::string base = steel + "modes = 20\nup_to = 1e5\n", end = "at = [1, 0.1, 0.05]\n";
  const std::string wall = "[[motion]]\nkind = \"fixed\"\nname = \"wall\"\non = \"xmin\"\n";
  const std::string spring = "[[spring]]\nkind = \"bushing\"\nname = \"s\"\nb = \"xmax\"\n" + end + "stiffness = [1e7, 2e7, 3e7]\n";
  const std::string hinge = "[[joint]]\nkind = \"revolute\"\nname = \"h\"\nb = \"xmin\"\nat = [0, 0.1, 0.05]\naxis = [0, 1, 0]\n";
  const std::string bob = body("bob", 50, {1.3, 0.1, 0.05}, {1, 1, 1}) +
                          "[[joint]]\nkind = \"spherical\"\nname = \"ball\"\na = \"xmax\"\nb = \"bob\"\n" + end +
                          "[[spring]]\nkind = \"bushing\"\nname = \"s\"\na = \"xmax\"\nb = \"bob\"\n" + end +
                          "stiffness = [0, 0, 0]\nangular_stiffness = [1e5, 1e5, 1e5]\n";
  const std::string mass = "[[point_mass]]\nname = \"m\"\non = \"xmax\"\nmass = 50\n";
  const std::string load = "[[load]]\nkind = \"traction\"\nname = \"l\"\non = \"zmax\"\ntraction = [1e6, 2e5, 1e5]\n";
  for (const std::string& more : {wall, hinge + spring, wall + spring, wall + bob, wall + mass, wall + load}) {
    use(beam({1, 0.2, 0.1}, 10), {Fidelity::nonlinear});
    const auto cells = frequencies(base + more, 5);
    use(beam({1, 0.2, 0.1}, 10), {Fidelity::linear});
    const auto linear = frequencies(base + more, 5);
    EXPECT_LT(((linear - cells).array() / cells.array()).abs().maxCoeff(), 1e-2) << more << linear << "\n\n" << cells;
  }
}

// A force at the front shakes a vehicle of two freedoms; its damping is .01 s times its stiffness.
TEST_F(NaturalModes, GiveTheResponseToAHarmonicForce) {
  const double m = 1000, J = 1500, kf = 3e4, kr = 4e4, a = 1.2, b = 1.6;
  const auto corner = [](const std::string& name, double x, double k) {
    return "[[spring]]\nkind = \"bushing\"\nname = \"" + name + "\"\nb = \"car\"\nat = [" + std::to_string(x) +
           ", 0, 0]\nstiffness = [0, 0, " + std::to_string(k) + "]\ndamping = [0, 0, " + std::to_string(0.01 * k) + "]\n" +
           "[[probe]]\nname = \"at_" + name + "\"\non = \"car\"\nat = [" + std::to_string(x) + ", 0, 0]\n";
  };
  modes(body("car", m, {0, 0, 0}, {J, J, J}) + corner("front", a, kf) + corner("rear", -b, kr) +
            "[[joint]]\nkind = \"planar\"\nname = \"road\"\nb = \"car\"\nat = [0, 0, 0]\naxis = [0, 1, 0]\n",
        3);
  const Ran response =
      work.run("hilo-post response run.h5 --force at_front.z --at at_front.z --at at_rear.z --from 0.2 --to 5 --points 50");
  ASSERT_EQ(response.exit, 0) << response.err;
  std::istringstream rows(response.out);
  std::string line;
  std::getline(rows, line);
  EXPECT_NE(line.find("at_rear.z [m/N]"), line.npos) << line;
  int n = 0;
  for (; std::getline(rows, line); ++n) {
    double f = 0, front = 0, front_phase = 0, rear = 0, rear_phase = 0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf", &f, &front, &front_phase, &rear, &rear_phase), 5) << line;
    using C = std::complex<double>;
    const double w = 2 * pi * f;
    const C visco(1, 0.01 * w), zz = (kf + kr) * visco - m * w * w, zp = -(kf * a - kr * b) * visco,
                                pp = (kf * a * a + kr * b * b) * visco - J * w * w, det = zz * pp - zp * zp;
    // under 1 N at x = a: heave u and pitch p, with z at x of u - x p
    const C u = (pp + zp * a) / det, p = (-zp - zz * a) / det;
    for (const auto& [at, size, phase] : {std::tuple{u - a * p, front, front_phase}, std::tuple{u + b * p, rear, rear_phase}}) {
      EXPECT_NEAR(size / std::abs(at), 1, 1e-4) << f;
      EXPECT_LT(std::abs(at / std::abs(at) - std::polar(1.0, phase * pi / 180)), 1e-4) << f;
    }
  }
  EXPECT_EQ(n, 50);
}

// Rows of a response: frequency, amplitude and phase.
struct Answer {
  double f, size, phase;
};
std::vector<Answer> answers(const Ran& ran) {
  EXPECT_EQ(ran.exit, 0) << ran.err;
  std::istringstream rows(ran.out);
  std::string line;
  std::getline(rows, line);
  std::vector<Answer> out;
  for (Answer a{}; std::getline(rows, line); out.push_back(a))
    EXPECT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf", &a.f, &a.size, &a.phase), 3) << line;
  return out;
}

TEST_F(NaturalModes, GiveTheTransmissibilityOfAMassOnASpring) {
  const double m = 3, k = 1200, c = 20, w0 = std::sqrt(k / m), zeta = c / (2 * std::sqrt(k * m));
  modes(body("mass", m, {0, 0, 0}, {1, 1, 1}) +
            "[[joint]]\nkind = \"prismatic\"\nname = \"guide\"\nb = \"mass\"\nat = [0, 0, 0]\naxis = [0, 0, 1]\n" +
            "[[spring]]\nkind = \"bushing\"\nname = \"s\"\nb = \"mass\"\nat = [0, 0, 0]\nstiffness = [0, 0, 1200]\ndamping = [0, 0, 20]\n"
            "[[probe]]\nname = \"top\"\non = \"mass\"\nat = [0, 0, 0]\n",
        3);
  const std::string command = "hilo-post response run.h5 --base z --at top.z --from 0.3 --to 30 --points 40 ";
  for (const bool relative : {false, true})
    for (const Answer& a : answers(work.run(command + (relative ? "--relative" : "--of acceleration")))) {
      const double r = 2 * pi * a.f / w0;
      const std::complex<double> bottom(1 - r * r, 2 * zeta * r),
          exact = relative ? -1.0 / (w0 * w0 * bottom) : std::complex<double>(1, 2 * zeta * r) / bottom;
      EXPECT_LT(std::abs(std::polar(a.size, a.phase * pi / 180) / exact - 1.0), 1e-5) << a.f;
    }
  EXPECT_EQ(work.run("hilo-post response run.h5 --at top.z").exit, 1) << "nothing swings";
  EXPECT_EQ(work.run("hilo-post response run.h5 --base z --force top.z").exit, 1) << "two things swing";
  EXPECT_EQ(work.run("hilo-post response run.h5 --base z").exit, 1) << "no probe";
  EXPECT_NE(work.run("hilo-post response run.h5 --base wall.z --at top.z").exit, 0) << "no such motion";
}

// The tip of a cantilever whose wall swings: (cos bL + cosh bL)/(1 + cos bL cosh bL), by all that stands still and by the motion's name.
TEST_F(NaturalModes, GiveTheSwingOfACantileverOnItsWall) {
  use(beam({1, 0.015, 0.01}, 30));
  modes(steel + "[[motion]]\nkind = \"fixed\"\nname = \"wall\"\non = \"xmin\"\n[[probe]]\nname = \"tip\"\non = \"xmax\"\n", 20);
  for (const std::string base : {"z", "wall.z"}) {
    int n = 0;
    for (const Answer& a :
         answers(work.run("hilo-post response run.h5 --of acceleration --at tip.z --from 0.5 --to 80 --points 60 --base " + base))) {
      const double bl = std::sqrt(2 * pi * a.f / (r_z * wave)), top = std::cos(bl) + std::cosh(bl),
                   bottom = 1 + std::cos(bl) * std::cosh(bl);
      if (std::abs(bottom) < 0.2 * std::abs(top)) continue;  // near a resonance
      EXPECT_NEAR(a.size * (std::abs(a.phase) > 90 ? -1 : 1), top / bottom, 0.02 * std::abs(top / bottom)) << base << " " << a.f;
      ++n;
    }
    EXPECT_GT(n, 30);
  }
}

// A rod between two ends of which one swings along it: the middle by 1/(2 cos(k L/2)); of both it is 1/cos(k L/2).
TEST_F(NaturalModes, GiveTheSwingOfARodOnOneOfItsEnds) {
  BlockOptions o;
  o.n[0] = 10;
  o.high = Vec3(1, 0.05, 0.05);
  use(block_mesh(o));
  modes(
      steel +
          "[[motion]]\nkind = \"fixed\"\nname = \"left\"\non = \"xmin\"\n[[motion]]\nkind = \"fixed\"\nname = \"right\"\non = \"xmax\"\n" +
          "[[probe]]\nname = \"middle\"\non = \"block\"\nat = [0.5, 0, 0]\n",
      108);
  const std::string command = "hilo-post response run.h5 --of acceleration --at middle.x --from 10 --to 1500 --points 20 ";
  for (const auto& [base, ends] : {std::pair{"--base left.x", 1}, std::pair{"--base left.x --base right.x", 2}, std::pair{"--base x", 2}})
    for (const Answer& a : answers(work.run(command + base))) {
      const double kl = 2 * pi * a.f / wave;
      EXPECT_NEAR(a.size, ends / (2 * std::cos(kl / 2)), 5e-3 * a.size) << base << " " << a.f;
    }
}

// A disc on two bearings whirls: J w^2 -+ Omega Jp w - 2 k L^2 = 0 backward and forward, and sqrt(2 k/m) along.
TEST_F(NaturalModes, OfARotorAreItsWhirls) {
  const double m = 10, J = 0.4, Jp = 0.6, k = 1e5, L = 0.3, spin = 200;
  std::string scene = body("disc", m, {0, 0, 0}, {J, J, Jp});
  for (const double at : {-L, L})
    scene += "[[spring]]\nkind = \"bushing\"\nname = \"" + std::string(at < 0 ? "low" : "high") + "\"\nb = \"disc\"\nat = [0, 0, " +
             std::to_string(at) + "]\nstiffness = [" + std::to_string(k) + ", " + std::to_string(k) + ", " + std::to_string(k) + "]\n";
  const std::string turning = "[[initial]]\non = [\"disc\"]\nspin = [0, 0, " + std::to_string(spin) + "]\n";
  const double half = spin * Jp / (2 * J), root = std::sqrt(half * half + 2 * k * L * L / J), along = std::sqrt(2 * k / m);
  std::vector<double> exact{root - half, along, along, along, root + half};
  std::sort(exact.begin(), exact.end());
  const auto f = modes(scene + turning, 10);
  ASSERT_EQ(f.rows(), 5) << f;
  for (int j = 0; j < 5; ++j) EXPECT_NEAR(f(j, 0) * 2 * pi / exact[static_cast<size_t>(j)], 1, 1e-6) << f;
  // All that moves is carried by the modes.  Pushed about x, the disc answers with (s^2 + w0^2)/((s^2 + w0^2)^2 + s^2 (spin Jp/J)^2), whose
  // shares of 1/(s^2 + w^2) are those of the two whirls.
  const double w0 = 2 * k * L * L / J, low = std::pow(root - half, 2), high = std::pow(root + half, 2);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(f.col(2 + axis).sum(), m, 1e-6 * m) << f;
  for (int axis = 0; axis < 2; ++axis) {
    EXPECT_NEAR(f(0, 5 + axis), J * (w0 - low) / (high - low), 1e-6 * J) << f;
    EXPECT_NEAR(f(4, 5 + axis), J * (high - w0) / (high - low), 1e-6 * J) << f;
  }
  // a disc that is not round has no constant coefficients
  work.write("scene.toml", body("disc", m, {0, 0, 0}, {J, 0.5, Jp}) + scene.substr(scene.find("[[spring]]")) + turning +
                               "[time]\nanalysis = \"modes\"\n");
  const Ran uneven = work.run("hilo-solve scene.toml -o run.h5");
  EXPECT_EQ(uneven.exit, 2);
  EXPECT_NE(uneven.err.find("the same all around"), std::string::npos) << uneven.err;
}

// Stiffness that turns with the disc, seen from space, is not constant where it differs across the axis; where it does not, all is well.
TEST_F(NaturalModes, OfASpringThatARotorCarriesAreRefusedWhereItIsUneven) {
  const auto scene = [](const std::string& stiffness, const std::string& ends, const std::string& more = "") {
    return body("disc", 3, {0, 0, 0}, {0.02, 0.02, 0.035}) + "[[spring]]\nkind = \"bushing\"\nname = \"mount\"\n" + ends +
           "at = [0, 0, 0]\naxis = [0, 0, 1]\nstiffness = " + stiffness + "\n" + more +
           "[[initial]]\non = [\"disc\"]\nspin = [0, 0, 300]\n";
  };
  const std::string carried = "a = \"disc\"\nb = \"ground\"\n", stands = "a = \"ground\"\nb = \"disc\"\n";
  for (const auto& [stiffness, more] : {std::pair{"[2e5, 5e4, 2e5]", ""}, std::pair{"[2e5, 2e5, 2e5]", "damping = [300, 0, 0]\n"},
                                        std::pair{"[2e5, 2e5, 2e5]", "angular_damping = [1, 0, 0]\n"}}) {
    work.write("scene.toml", scene(stiffness, carried, more) + "[time]\nanalysis = \"modes\"\n");
    const Ran ran = work.run("hilo-solve scene.toml -o run.h5");
    EXPECT_EQ(ran.exit, 2) << stiffness << more;
    EXPECT_NE(ran.err.find("\"mount\""), std::string::npos) << ran.err;
  }
  const auto even = modes(scene("[2e5, 2e5, 1e5]", carried), 8);
  for (const double omega : {std::sqrt(2e5 / 3), std::sqrt(1e5 / 3)})
    EXPECT_LT((even.col(0).array() * 2 * pi - omega).abs().minCoeff(), 1e-4);
  const auto still = modes(scene("[2e5, 5e4, 2e5]", stands), 8);
  for (const double omega : {std::sqrt(2e5 / 3), std::sqrt(5e4 / 3)})
    EXPECT_LT((still.col(0).array() * 2 * pi - omega).abs().minCoeff(), 1e-4);
  // a spring that winds up does not let the disc turn steadily
  work.write("scene.toml", scene("[2e5, 2e5, 2e5]", stands) +
                               "[[spring]]\nkind = \"torsion\"\nname = \"winds\"\nb = \"disc\"\naxis = [0, 0, 1]\nstiffness = 3\n" +
                               "[time]\nanalysis = \"modes\"\n");
  EXPECT_EQ(work.run("hilo-solve scene.toml -o run.h5").exit, 2);
}

// Two masses with a damper between them: the quadratic pencil of 2 x 2 by its own complex arithmetic here.
TEST_F(NaturalModes, WithADamperThatCouplesThemAreComplex) {
  using C = std::complex<double>;
  const double m1 = 2, m2 = 3, k1 = 4000, k2 = 3000, c = 100;
  std::string scene = body("m1", m1, {1, 0, 0}, {1, 1, 1}) + body("m2", m2, {2, 0, 0}, {1, 1, 1});
  for (const char* name : {"1", "2"})
    scene += std::string("[[joint]]\nkind = \"prismatic\"\nname = \"g") + name + "\"\nb = \"m" + name + "\"\nat = [" + name +
             ", 0, 0]\naxis = [1, 0, 0]\n";
  scene +=
      "[[spring]]\nkind = \"axial\"\nname = \"k1\"\nb = \"m1\"\nat_a = [0, 0, 0]\nat_b = [1, 0, 0]\nstiffness = 4000\n"
      "[[spring]]\nkind = \"axial\"\nname = \"k2\"\na = \"m1\"\nb = \"m2\"\nat_a = [1, 0, 0]\nat_b = [2, 0, 0]\nstiffness = 3000\ndamping "
      "= 100\n[[probe]]\nname = \"p1\"\non = \"m1\"\n";
  const auto found = modes(scene, 2);
  ASSERT_EQ(found.rows(), 2);
  const auto pencil = [&](C s) {
    const C a = m1 * s * s + c * s + k1 + k2, b = -c * s - k2, d = m2 * s * s + c * s + k2;
    return std::pair{a * d - b * b, d};
  };
  for (int j = 0; j < 2; ++j) {
    const double w = 2 * pi * found(j, 0), zeta = found(j, 1);
    const C s(-zeta * w, w * std::sqrt(1 - zeta * zeta));
    EXPECT_LT(std::abs(pencil(s).first), 1e-6 * std::norm(s) * std::norm(s) * m1 * m2) << "a pole of the pencil";
  }
  EXPECT_NEAR(found(1, 1), 0.657, 1e-3);
  int n = 0;
  for (const Answer& a : answers(work.run("hilo-post response run.h5 --force p1.x --from 1 --to 20 --points 60"))) {
    const auto [det, d] = pencil(C(0, 2 * pi * a.f));
    EXPECT_LT(std::abs(std::polar(a.size, a.phase * pi / 180) * det / d - 1.0), 1e-6) << a.f;
    ++n;
  }
  EXPECT_EQ(n, 60);
}

// Beyond critical damping, and upside down: real poles in pairs.
TEST_F(NaturalModes, ThatCreepHaveRatiosAboveOne) {
  const std::string scene =
      body("mass", 3, {0, 0, 0}, {1, 1, 1}) +
      "[[joint]]\nkind = \"prismatic\"\nname = \"guide\"\nb = \"mass\"\nat = [0, 0, 0]\naxis = [0, 0, 1]\n"
      "[[spring]]\nkind = \"bushing\"\nname = \"s\"\nb = \"mass\"\nat = [0, 0, 0]\nstiffness = [0, 0, 1200]\ndamping = [0, 0, 300]\n";
  const auto found = modes(scene, 1);
  EXPECT_NEAR(found(0, 0), std::sqrt(400.) / (2 * pi), 1e-8);
  EXPECT_NEAR(found(0, 1), 300 / (2 * std::sqrt(1200. * 3)), 1e-8);
  const auto falls = modes("gravity = [0, 0, 9.81]\n" + body("arm", 2, {0, 0, -0.5}, {0.1, 0.2, 0.15}) +
                               "[[joint]]\nkind = \"revolute\"\nname = \"pin\"\nb = \"arm\"\nat = [0, 0, 0]\naxis = [0, 1, 0]\n"
                               "[[spring]]\nkind = \"torsion\"\nname = \"d\"\nb = \"arm\"\naxis = [0, 1, 0]\nstiffness = 0\ndamping = 2\n",
                           1);
  const double J = 0.2 + 2 * 0.25, g = 2 * 9.81 * 0.5;
  EXPECT_NEAR(-falls(0, 0) * 2 * pi, (-2 + std::sqrt(4 + 4 * J * g)) / (2 * J), 1e-6);
}

// A cantilever with a damper at its tip, by the beam's own equation.  Its modes without damping do not span the shape: what the equations
// leave on all unknowns tells so, and the span grows.
TEST_F(NaturalModes, OfACantileverWithADamperAtItsTip) {
  using C = std::complex<double>;
  use(beam({1, 0.015, 0.01}, 30));
  const double EI = 2e11 * 0.015 * std::pow(0.01, 3) / 12, rho_A = 8000 * 0.015 * 0.01, c = 8;
  const auto f = modes(steel +
                           "[[motion]]\nkind = \"fixed\"\nname = \"wall\"\non = \"xmin\"\n[[spring]]\nkind = \"bushing\"\nname = \"d\"\nb "
                           "= \"xmax\"\nat = [1, 0.0075, 0.005]\nstiffness = [0, 0, 0]\ndamping = [0, 0, 8]\n",
                       2);
  // w = A (cosh bx - cos bx) + B (sinh bx - sin bx), b^4 = -rho A s^2/(E I); no moment at the tip, and its shear is the damper's force
  const auto left = [&](C s) {
    const C b = std::pow(-rho_A * s * s / EI, 0.25), ch = std::cosh(b), sh = std::sinh(b), co = std::cos(b), si = std::sin(b);
    const C A = -(sh + si), B = ch + co;
    return EI * b * b * b * (A * (sh - si) + B * (ch + co)) - c * s * (A * (ch - co) + B * (sh - si));
  };
  C s(-5, 50);
  for (int i = 0; i < 100; ++i) {
    const C d = 1e-6 * s;
    s -= left(s) * d / (left(s + d) - left(s));
  }
  EXPECT_LT(s.real(), 0);
  EXPECT_NEAR(f(0, 0) * 2 * pi / std::abs(s), 1, 2e-3);
  EXPECT_NEAR(f(0, 1) / (-s.real() / std::abs(s)), 1, 5e-3);
}

// Mass-proportional damping is a drag against space, which a base that swings pulls its parts through.
TEST_F(NaturalModes, OnABaseThatSwingsFeelTheDragOfSpace) {
  BlockOptions o;
  use(block_mesh(o));
  const double E = 1e6, moves = 1000, shared = 500,
               alpha = 6;  // one cell that is stretched: its tip has a third of 3000 kg, a sixth with the wall
  modes(
      "[material.m]\nE = 1e6\nnu = 0\ndensity = 3000\n[region.block]\nmaterial = \"m\"\nmass_damping = 6\n[[motion]]\nkind = "
      "\"fixed\"\nname = \"wall\"\non = \"xmin\"\n[[probe]]\nname = \"tip\"\non = \"xmax\"\n",
      10);
  for (const std::string base : {"x", "wall.x"})
    for (const Answer& a :
         answers(work.run("hilo-post response run.h5 --of acceleration --at tip.x --from 2 --to 10 --points 9 --base " + base))) {
      const std::complex<double> s(0, 2 * pi * a.f), inertia = s * s + alpha * s;
      const std::complex<double> exact = (E - shared * inertia) / (E + moves * inertia);
      EXPECT_LT(std::abs(std::polar(a.size, a.phase * pi / 180) / exact - 1.0), 1e-4) << base << " " << a.f;
    }
}

TEST_F(NaturalModes, AreRefusedWhereTheyHaveNoMeaning) {
  const std::string arm = body("arm", 2, {0, 0, -0.5}, {0.1, 0.2, 0.15});
  work.write("scene.toml", arm + "[[initial]]\non = [\"arm\"]\nvelocity = [1, 0, 0]\n[time]\nanalysis = \"modes\"\n");
  const Ran moving = work.run("hilo-solve scene.toml -o run.h5");
  EXPECT_EQ(moving.exit, 2);
  EXPECT_NE(moving.err.find("something moves along"), std::string::npos) << moving.err;
}

}  // namespace
}  // namespace hilo::test
