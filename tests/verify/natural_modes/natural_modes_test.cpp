// SPDX-License-Identifier: GPL-3.0-or-later
// Natural frequencies against closed forms: `analysis = "modes"` of bodies, cells, linear regions, preloads and what nothing holds.
#include "verify/natural_modes/natural_modes.hpp"

namespace hilo::test::natural_modes_test {
namespace {

TEST_F(NaturalModes, OfACantileverAreThoseOfItsBeam) {
  use(beam({1, 0.015, 0.01}, 30));
  const auto f = frequencies(steel + held("xmin"), 4);
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
  use(block_mesh({.shape = Shape::hex20r, .n = {8, 8, 1}, .high = {1, 1, 0.02}}));
  std::string edges;
  for (const char* face : {"xmin", "xmax", "ymin", "ymax"}) edges += held(face, face[0] == 'x' ? "yz" : "xz");
  const auto f = frequencies(steel + edges, 3);
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
  BlockOptions o{.shape = Shape::hex20r, .n = {n, 1, 1}};
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
  const std::string hung =
      "gravity = [0, 0, -9.81]\n" + body("arm", 2, {0, 0, -0.5}, {0.1, 0.2, 0.15}) + pin("pin", "ground", "arm", Vec3::Zero());
  auto m = modes(hung, 10);
  ASSERT_EQ(m.rows(), 1) << "one freedom, one mode";
  EXPECT_NEAR(m(0, 0), std::sqrt(2 * 9.81 * 0.5 / (0.2 + 2 * 0.25)) / (2 * pi), 1e-10);
  // upside down it falls
  m = modes("gravity = [0, 0, 9.81]\n" + hung.substr(hung.find('\n') + 1), 10);
  EXPECT_NEAR(m(0, 0), -std::sqrt(2 * 9.81 * 0.5 / (0.2 + 2 * 0.25)) / (2 * pi), 1e-10);
  // two equal points on equal threads: omega^2 = (2 -+ sqrt 2) g/l
  m = modes("gravity = [0, 0, -9.81]\n" + body("a", 1, {0, 0, -1}, {1e-6, 1e-6, 1e-6}) + body("b", 1, {0, 0, -2}, {1e-6, 1e-6, 1e-6}) +
                pin("pin", "ground", "a", Vec3::Zero()) + pin("link", "a", "b", {0, 0, -1}),
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
  const auto end = [&](int i) { return i == 0 || i == n + 1 ? std::string("ground") : fmt::format("b{}", i); };
  for (int i = 0; i <= n; ++i)
    scene += spring(
        "axial", fmt::format("s{}", i), end(i), end(i + 1),
        fmt::format("at_a = [{}, 0, 0]\nat_b = [{}, 0, 0]\nstiffness = {}\nlength = {}", i * a, (i + 1) * a, stiffness, a - T / stiffness));
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
    return bushing(name, "car", {x, 0, 0}, {0, 0, k}, "damping = " + list({0, 0, c}));
  };
  const std::string plane = axial("planar", "road", "ground", "car", Vec3::Zero(), Vec3::UnitY());
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
    const std::string name = fmt::format("b{}", i);
    const Vec3 at(i, 0, 0);
    scene += body(name, 1, at, {1, 1, 1}) + axial("prismatic", "j" + name, "ground", name, at, Vec3::UnitZ()) +
             bushing("s" + name, name, at, {0, 0, i < 12 ? 100. : 400.});
  }
  const auto f = frequencies(scene, 20);
  ASSERT_EQ(f.size(), 15);
  for (int i = 0; i < 15; ++i) EXPECT_NEAR(f[i], (i < 12 ? 10 : 20) / (2 * pi), 1e-9);
}

// Held, on a hinge with a spring, with a body on a joint, with a mass on its end, under a load: linear regions are what their cells are.
TEST_F(NaturalModes, OfLinearRegionsAreThoseOfTheirCells) {
  const std::string base = steel + "modes = 20\nup_to = 1e5\n", wall = held("xmin"),
                    mass = "[[point_mass]]\nname = \"m\"\non = \"xmax\"\nmass = 50\n",
                    load = test::load("traction", "l", "zmax", "traction = [1e6, 2e5, 1e5]"),
                    hinge = pin("h", "ground", "xmin", {0, 0.1, 0.05});
  const Vec3 end(1, 0.1, 0.05);
  const std::string spring = bushing("s", "xmax", end, {1e7, 2e7, 3e7});
  const std::string bob =
      body("bob", 50, {1.3, 0.1, 0.05}, {1, 1, 1}) + joint("spherical", "ball", "xmax", "bob", end) +
      test::spring("bushing", "s", "xmax", "bob", "at = [1, 0.1, 0.05]\nstiffness = [0, 0, 0]\nangular_stiffness = [1e5, 1e5, 1e5]");
  for (const std::string& more : {wall, hinge + spring, wall + spring, wall + bob, wall + mass, wall + load}) {
    use(beam({1, 0.2, 0.1}, 10), {Fidelity::nonlinear});
    const auto cells = frequencies(base + more, 5);
    use(beam({1, 0.2, 0.1}, 10), {Fidelity::linear});
    const auto linear = frequencies(base + more, 5);
    EXPECT_LT(((linear - cells).array() / cells.array()).abs().maxCoeff(), 1e-2) << more << linear << "\n\n" << cells;
  }
}

// A mass on few nodes pulls at them as a load does: with the modes that a region has of itself.
TEST_F(NaturalModes, OfALinearRegionWithAMassAtItsCornerAreThoseOfTheCells) {
  const std::string scene = solid(7e10, 0.3, 2700) + held("xmin") +
                            "[set.corner]\nkind = \"ball\"\nat = [0.5, 0.03, 0.02]\nradius = 1e-3\n[set.side]\nkind = \"box\"\nlow = [0.2, "
                            "0.029, -1]\nhigh = [0.31, 0.031, 1]\n[[point_mass]]\nname = \"m\"\nmass = 2\n";
  for (const char* on : {"on = \"corner\"\n", "on = \"side\"\n"}) {
    use(beam({0.5, 0.03, 0.02}, 10), {Fidelity::nonlinear});
    const auto cells = frequencies(scene + on, 5);
    use(beam({0.5, 0.03, 0.02}, 10), {Fidelity::linear});
    const auto linear = frequencies(scene + on, 5);
    EXPECT_LT(((linear - cells).array() / cells.array()).abs().maxCoeff(), 2e-3) << on << linear << "\n\n" << cells;
  }
}

// A disc on two bearings whirls: J w^2 -+ Omega Jp w - 2 k L^2 = 0 backward and forward, and sqrt(2 k/m) along.
TEST_F(NaturalModes, OfARotorAreItsWhirls) {
  const double m = 10, J = 0.4, Jp = 0.6, k = 1e5, L = 0.3, spin = 200;
  std::string scene = body("disc", m, {0, 0, 0}, {J, J, Jp});
  for (const double at : {-L, L}) scene += bushing(at < 0 ? "low" : "high", "disc", {0, 0, at}, {k, k, k});
  const std::string turning = initial("disc", "spin = " + list({0, 0, spin}));
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
  expect_end(work.run("hilo-solve scene.toml -o run.h5"), 2, "the same all around");
}

// Stiffness that turns with the disc, seen from space, is not constant where it differs across the axis; where it does not, all is well.
TEST_F(NaturalModes, OfASpringThatARotorCarriesAreRefusedWhereItIsUneven) {
  const auto scene = [](const std::string& stiffness, const std::string& ends, const std::string& more = "") {
    return body("disc", 3, {0, 0, 0}, {0.02, 0.02, 0.035}) + "[[spring]]\nkind = \"bushing\"\nname = \"mount\"\n" + ends +
           "at = [0, 0, 0]\naxis = [0, 0, 1]\nstiffness = " + stiffness + "\n" + more + initial("disc", "spin = [0, 0, 300]");
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
                               spring("torsion", "winds", "ground", "disc", "axis = [0, 0, 1]\nstiffness = 3") +
                               "[time]\nanalysis = \"modes\"\n");
  EXPECT_EQ(work.run("hilo-solve scene.toml -o run.h5").exit, 2);
}

TEST_F(NaturalModes, AreRefusedWhereTheyHaveNoMeaning) {
  const std::string arm = body("arm", 2, {0, 0, -0.5}, {0.1, 0.2, 0.15});
  work.write("scene.toml", arm + "[[initial]]\non = [\"arm\"]\nvelocity = [1, 0, 0]\n[time]\nanalysis = \"modes\"\n");
  expect_end(work.run("hilo-solve scene.toml -o run.h5"), 2, "something moves along");
  // a disc that springs hold on a slope: the force of its contact turns with the disc as it yaws
  work.write("scene.toml", "gravity = [3, 1, -9.81]\n" + body("d", 2, {0, 0, 0.12}, {0.02, 0.03, 0.02}) +
                               axial("rolling", "c", "ground", "d", {0, 0, 0.2}, Vec3::UnitZ(), "radius = 0.2\naxle = [0, 1, 0]\n") +
                               bushing("s", "d", {0, 0, 0.2}, {500, 500, 0}, "angular_stiffness = [50, 50, 50]\n") +
                               "[time]\nanalysis = \"modes\"\nstart = \"equilibrium\"\n");
  expect_end(work.run("hilo-solve scene.toml -o run.h5"), 2, "a rolling contact that bears a force along its plane");
}

// A pendulum whose hinge is accelerated sideways swings about its rest in what it feels, (g^2 + a^2)^(1/2)/l, by a joint and by a motion.
TEST_F(NaturalModes, OnASupportThatAcceleratesAreThoseAboutItsRest) {
  const double g = 9.81, a = 5, l = 0.5, drawn = std::sqrt(g / l), hung = std::sqrt(std::hypot(g, a) / l);
  const std::string bob = "gravity = [0, 0, -9.81]\n" + body("car", 1, {0, 0, 0}, {1, 1, 1}) +
                          body("bob", 1, {0, 0, -l}, {1e-9, 1e-9, 1e-9}) + pin("h", "car", "bob", {0, 0, 0}),
                    rail = axial("prismatic", "p", "ground", "car", {0, 0, 0}, {1, 0, 0},
                                 "velocity = 5\nhistory = {t = [0, 1], value = [0, 1]}\n"),
                    course = motion("translation", "m", "car",
                                    "displacement = " + list({2 * a / (pi * pi), 0, 0}) +
                                        "\nhistory = {t = [0, 1], value = [0, 1], interpolation = \"smooth\"}");  // cosine ramps
  const auto with = [&](const std::string& scene, const std::string& start) {
    work.write("scene.toml", scene + "[time]\nanalysis = \"modes\"\n" + start);
    return work.run("hilo-solve scene.toml -o run.h5");
  };
  const std::string start = "start = \"equilibrium\"\n";
  for (const std::string& scene : {bob + rail, bob + course}) {
    const Ran told = with(scene, "");
    EXPECT_EQ(told.exit, 0) << told.err;
    EXPECT_NE(told.err.find("the state is not at rest"), std::string::npos) << told.err;
    EXPECT_NEAR(Results(work / "run.h5").history("mode")(1, 0) * 2 * pi / drawn, 1, 1e-5);
    const Ran quiet = with(scene, start);
    EXPECT_EQ(quiet.exit, 0) << quiet.err;
    EXPECT_EQ(quiet.err.find("warning"), std::string::npos) << quiet.err;
    EXPECT_NEAR(Results(work / "run.h5").history("mode")(1, 0) * 2 * pi / hung, 1, 1e-5);
  }
  // held by what stands as well, it has no rest beside the support
  const std::string held_too = bob + rail + spring("bushing", "soft", "ground", "bob", "at = [0, 0, -0.5]\nstiffness = [20, 0, 0]");
  const Ran told = with(held_too, "");
  EXPECT_EQ(told.exit, 0) << told.err;
  EXPECT_NE(told.err.find("joint \"p\" accelerates what it moves at the start, and not everything alike"), std::string::npos) << told.err;
  expect_end(with(held_too, start), 2, "there is no equilibrium beside it");
  expect_end(
      with(body("disc", 1, {0, 0, 0}, {1, 1, 1}) + body("car", 1, {1, 0, 0}, {1, 1, 1}) +
               axial("prismatic", "p", "ground", "car", {1, 0, 0}, {1, 0, 0}, "velocity = 5\nhistory = {t = [0, 1], value = [0, 1]}") +
               axial("revolute", "r", "car", "disc", {0, 0, 0}, {0, 0, 1}) + initial("disc", "spin = [0, 0, 9]"),
           ""),
      2, "modes of what spins are not found where joint \"p\" accelerates");
}

// Truth: 4 k/m, 4 k a^2/J, 4 k b^2/J, and three motions that nothing resists, beside which the others are all as fast as the mean of all.
TEST_F(NaturalModes, OfABodyThatSlidesFreelyOnFourSprings) {
  const double k = 1e5, a = 0.3, b = 0.2;
  std::string scene = body("part", 2, {0, 0, 0}, {0.05, 0.07, 0.1});
  for (int i = 0; i < 4; ++i) scene += bushing(fmt::format("s{}", i), "part", {i & 1 ? a : -a, i & 2 ? b : -b, 0}, {0, 0, k});
  const auto f = frequencies(scene, 6);
  ASSERT_EQ(f.size(), 6);
  EXPECT_LT(f.head(3).cwiseAbs().maxCoeff(), 1e-6 * f[5]);
  std::vector<double> truth{4 * k / 2, 4 * k * b * b / 0.05, 4 * k * a * a / 0.07};
  std::ranges::sort(truth);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(f[3 + i], std::sqrt(truth[static_cast<size_t>(i)]) / (2 * pi), 1e-7 * f[5]) << i;
}

}  // namespace
}  // namespace hilo::test::natural_modes_test
