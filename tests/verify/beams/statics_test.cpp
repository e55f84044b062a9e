// SPDX-License-Identifier: GPL-3.0-or-later
// Beams at rest against closed forms and published values.
#include "verify/beams/beam_scene.hpp"
#include "verify/shells/shell_scene.hpp"

namespace hilo::test::beams_statics_test {
namespace {

constexpr double pi = std::numbers::pi;

class BeamStatics : public BeamPlace {};

// 2 pi EI/L closes it to a circle, whatever the number of cells: the strains are those of the helix.
TEST_F(BeamStatics, AnEndMomentRollsACantileverToACircle) {
  for (const int n : {4, 7}) {
    const Results r = solved(plain_section(1e4, 1e4, 100, 100) + beam_of("[[0, 0, 0], [10, 0, 0]]", n) +
                             twist("arm.end", Vec3(0, 20 * pi, 0)) + tip_probe() + in_steps(8));
    EXPECT_LT(r.history("probe/tip").bottomRows(1).leftCols<3>().norm(), 1e-8) << n;
    const Eigen::VectorXd f = r.history("beam/arm").bottomRows(1).transpose();
    for (int end = 0; end < 2 * n; ++end) {
      EXPECT_NEAR(f.segment<3>(6 * end + 3).norm(), 20 * pi, 1e-6);
      EXPECT_LT(f.segment<3>(6 * end).norm(), 1e-6);
    }
  }
}

// Two formulations agree on this value to 2e-7 (beams.md 3); it is of the arc itself, where others take a parabola through its points.
TEST_F(BeamStatics, TheBendOf45DegreesIsThatOfTheArc) {
  const double s = std::sin(pi / 8), c = std::cos(pi / 8), h = std::sqrt(0.5);
  const auto bend = [&](int n, double GJ) {
    const std::string points =
        fmt::format("[[0, 0, 0], [{:.17g}, {:.17g}, 0], [{:.17g}, {:.17g}, 0]]", 100 * s, 100 * (1 - c), 100 * h, 100 * (1 - h));
    return Vec3(tip(plain_section(4.16666667e6, 1e7, 8.3333333e5, GJ) + beam_of(points, n, "a = \"ground\"\npath = \"arc\"") +
                    push("arm.end", Vec3(0, 0, 600)) + tip_probe() + in_steps(6)) -
                Vec3(100 * h, 100 * (1 - h), 0));
  };
  const Vec3 arc(-23.56058, -13.60463, 53.47548);
  const double e4 = (bend(4, 8.3333333e5) - arc).norm() / arc.norm(), e8 = (bend(8, 8.3333333e5) - arc).norm() / arc.norm();
  EXPECT_LT(e8, 2e-5);
  EXPECT_GT(e4 / e8, 8) << "of fourth order";
  EXPECT_LT((bend(16, 7.03e5) - Vec3(-23.821, -13.732, 53.610)).norm(), 0.01) << "Sonneville 2014";
}

// At alpha 4, by Reissner's beam: 3.28946 and 6.70011 of 10.
TEST_F(BeamStatics, ACantileverBendsAsReissnersBeam) {
  const auto u = [&](int n) {
    return Vec3(tip("[section.s]\nkind = \"matrix\"\nstiffness = [6e4, 6e4, 1.2e5]\nbending = [100, 1e4, 1e4]\n" +
                    beam_of("[[0, 0, 0], [10, 0, 0]]", n) + push("arm.end", Vec3(0, 0, 4)) + tip_probe() + in_steps(5)) -
                Vec3(10, 0, 0));
  };
  EXPECT_LT((u(4) - Vec3(-3.28946, 0, 6.70011)).norm() / 7.46, 2e-4);
  EXPECT_LT((u(8) - Vec3(-3.28946, 0, 6.70011)).norm() / 7.46, 1e-5);
}

// Tangents have the forces that the last correction foresaw: thinner beams take no more corrections (147 and 541 without).
TEST_F(BeamStatics, ThinBeamsSettleAsFastAsThickOnes) {
  const auto corrections = [&](double thickness, const std::string& more) {
    const double EA = 1200 / (thickness * thickness);
    (void)solved(plain_section(EA / 3, EA, 100, 100) + beam_of("[[0, 0, 0], [10, 0, 0]]", 8) + more);
    return reported_in(work, "newton_iterations");
  };
  const std::string bent = push("arm.end", Vec3(0, 0, 4)) + in_steps(5), rolled = twist("arm.end", Vec3(0, 20 * pi, 0)) + in_steps(8);
  EXPECT_LE(corrections(0.1, bent), 35);
  EXPECT_LE(corrections(0.01, bent), 35);
  EXPECT_LE(corrections(0.1, rolled), 120);
  EXPECT_LE(corrections(0.01, rolled), 120);
}

// q L^4/8EI and q L^2/2GA, and the forces q (L - x) and q (L - x)^2/2 at each section, whatever the number of cells.
TEST_F(BeamStatics, AUniformLoadBendsACantilever) {
  const double EI = 1e4, GA = 1e5, L = 10, q = 1e-3;
  for (const int n : {1, 3}) {
    const Results r = solved(
        "[section.s]\nkind = \"matrix\"\nstiffness = [1e5, 1e5, 1e7]\nbending = [1e4, 1e4, 1e4]\n" + beam_of("[[0, 0, 0], [10, 0, 0]]", n) +
        "[[load]]\nkind = \"line\"\nname = \"snow\"\non = \"ar*\"\nforce_per_length = [0, 0, -1e-3]\n" + tip_probe() + in_steps(1));
    const Eigen::MatrixXd tip = r.history("probe/tip");
    EXPECT_NEAR(tip(tip.rows() - 1, 2) / (-q * std::pow(L, 4) / (8 * EI) - q * L * L / (2 * GA)), 1, n == 1 ? 1e-3 : 1e-4) << n;
    const Eigen::VectorXd f = r.history("beam/arm").bottomRows(1).transpose();
    for (int end = 0; end < 2 * n; ++end) {
      const double x = L * ((end + 1) / 2) / n;
      EXPECT_NEAR(f.segment<3>(6 * end).norm(), q * (L - x), 1e-8);
      EXPECT_NEAR(f.segment<3>(6 * end + 3).norm(), q * (L - x) * (L - x) / 2, 1e-7);
    }
  }
}

// From q at the root to none at the tip: q L^2/6EA along the beam, wherever it points; follower or not.
TEST_F(BeamStatics, ALoadAlongTheAxisThatFadesIsExactOfOneCell) {
  const double EA = 1e6, L = 2, q = 3;
  const Vec3 along = Vec3(1, 2, -0.5).normalized();
  const std::string beam = plain_section(1e5, EA, 100, 100) +
                           beam_of(fmt::format("[[0, 0, 0], [{:.17g}, {:.17g}, {:.17g}]]", L * along.x(), L * along.y(), L * along.z()), 1);
  for (const bool turns : {false, true}) {
    const std::string load = fmt::format(
        "[[load]]\nkind = \"line\"\nname = \"q\"\non = \"arm\"\nforce_per_length = {}\nforce_per_length_end = [0, 0, 0]\nfollower = {}\n",
        list(turns ? Vec3(0, 0, q) : Vec3(q * along)), turns);
    const Vec3 u = tip(beam + load + tip_probe() + in_steps(1)) - L * along;
    EXPECT_NEAR(u.dot(along) / (q * L * L / (6 * EA)), 1, 1e-5) << turns;
  }
}

// Small loads, one cell: exact of Timoshenko's beam along both axes, in stretch and in twist, wherever the beam points.
TEST_F(BeamStatics, OneCellIsExactUnderEndLoads) {
  const double E = 2e11, nu = 0.3, G = E / 2.6, L = 1.5, b = 0.02, h = 0.05, k = 10 * (1 + nu) / (12 + 11 * nu), A = b * h;
  const std::string section =
      fmt::format("[section.s]\nkind = \"rectangle\"\nwidth = {}\nheight = {}\n[material.m]\nE = {}\nnu = {}\n", b, h, E, nu);
  const Vec3 along = Vec3(1, 2, -0.5).normalized(), up = (Vec3::UnitZ() - along.z() * along).normalized(), across = up.cross(along);
  const std::string beam = beam_of(fmt::format("[[0, 0, 0], [{:.17g}, {:.17g}, {:.17g}]]", L * along.x(), L * along.y(), L * along.z()), 1,
                                   "a = \"ground\"\nmaterial = \"m\"");
  const Vec3 f(0.03, 0.05, 20);  // one after the other: stretched, it is stiffer
  const Vec3 u = tip(section + beam + push("arm.end", f[0] * across + f[1] * up) + tip_probe() + in_steps(1)) - L * along;
  const Vec3 stretched = tip(section + beam + push("arm.end", f[2] * along) + tip_probe() + in_steps(1)) - L * along;
  EXPECT_NEAR(u.dot(across), f[0] * (L * L * L / (3 * E * h * b * b * b / 12) + L / (k * G * A)), 1e-5 * u.dot(across));
  EXPECT_NEAR(u.dot(up), f[1] * (L * L * L / (3 * E * b * h * h * h / 12) + L / (k * G * A)), 1e-5 * u.dot(up));
  EXPECT_NEAR(stretched.dot(along), f[2] * L / (E * A), 1e-6 * f[2] * L / (E * A));
  const Results r = solved(section + beam + twist("arm.end", 5e-3 * along) + in_steps(1));
  const Eigen::VectorXd x = r.history("body/arm.1").bottomRows(1).transpose();  // the points turn with it
  const Eigen::VectorXd x0 = r.history("body/arm.1").topRows(1).transpose();
  const Vec3 d0 = x0.segment<3>(3) - x0.head<3>(), d1 = x.segment<3>(3) - x.head<3>();
  const Vec3 n0 = d0 - d0.dot(along) * along, n1 = d1 - d1.dot(along) * along;
  const double J = h * b * b * b * (1.0 / 3 - 0.21 * b / h * (1 - std::pow(b / h, 4) / 12));
  EXPECT_NEAR(std::atan2(n0.cross(n1).dot(along), n0.dot(n1)), 5e-3 * L / (G * J), 2e-3 * 5e-3 * L / (G * J));
}

// Whatever the shape: the root carries the loads, and the weight of all of it.
TEST_F(BeamStatics, ForcesAlongABeamAreThoseOfEquilibrium) {
  const Vec3 P(30, -20, 15), g(1, -2, -9.81);
  const Results r = solved("gravity = [1, -2, -9.81]\n" + plain_section(1e6, 2e6, 900, 700, "line_mass = 2\ninertia = [0.01, 0.02]") +
                           beam_of("[[0, 0, 0], [2, 0, 0], [2, 1, 0.5]]", 4) + push("arm.end", P) + tip_probe() + in_steps(4));
  const Eigen::VectorXd f = r.history("beam/arm").bottomRows(1).transpose();
  const double mass = 2 * (2 + std::sqrt(1.25));
  EXPECT_NEAR(f.head<3>().norm(), (P + mass * g).norm(), 1e-8 * mass * g.norm());
  EXPECT_NEAR(f.segment<3>(12 * 7 + 6).norm(), P.norm(), 1e-8 * P.norm());
  EXPECT_LT(f.segment<3>(12 * 7 + 9).norm(), 1e-8) << "no moment at the tip";
  for (const int k : {1, 2, 3, 5, 6, 7})
    EXPECT_LT((f.segment<6>(12 * k) - f.segment<6>(12 * k - 6)).norm(), 1e-7) << "goes on, section " << k;
  EXPECT_NEAR(f.segment<3>(12 * 4 + 3).norm(), f.segment<3>(12 * 3 + 9).norm(), 1e-7) << "round the corner";
}

// Bauchau's measurements at Princeton, as ANSYS' beam has them: w across and flapwise in mm at angles 0, 15 ... 90 degrees.
TEST_F(BeamStatics, PrincetonsBeamIsThatOfAnsys) {
  const std::map<double, std::array<std::pair<double, double>, 7>> ansys{
      {8.896, {{{10.714, 0}, {10.613, 42.082}, {10.112, 79.395}, {8.837, 108.988}, {6.605, 129.888}, {3.539, 142.194}, {0, 146.246}}}},
      {13.345, {{{16.064, 0}, {16.458, 64.358}, {16.659, 117.736}, {15.186, 156.467}, {11.578, 181.862}, {6.249, 196.097}, {0, 200.678}}}}};
  const std::string beam =
      "[section.s]\nkind = \"rectangle\"\nwidth = 12.3777e-3\nheight = 3.2024e-3\n[material.m]\nE = 71.7e9\nnu = 0.31\n" +
      beam_of("[[0, 0, 0], [0.508, 0, 0]]", 8, "a = \"ground\"\nmaterial = \"m\"") + tip_probe();
  double most = 0;
  for (const auto& [P, rows] : ansys)
    for (int i = 0; i < 7; ++i) {
      const double beta = i * pi / 12;
      const Vec3 u = tip(beam + push("arm.end", P * Vec3(0, std::cos(beta), std::sin(beta))) + in_steps(6));
      const double off = std::max(std::abs(1e3 * std::abs(u.y()) - rows[i].first), std::abs(1e3 * std::abs(u.z()) - rows[i].second));
      most = std::max(most, off / std::max(rows[i].first, rows[i].second));
    }
  std::printf("largest difference from ANSYS' beam: %.2g %%\n", 100 * most);
  EXPECT_LT(most, 3e-3);
}

// On a face of a block of each fidelity; rigid is the least compliant.
TEST_F(BeamStatics, ABeamRidesOnASetOfARegionOfEveryFidelity) {
  write_mesh(work / "mesh.h5", block_mesh({.n = {1, 1, 4}, .high = {0.2, 0.2, 1}}), {"test"});
  const std::string text =
      "gravity = [0, 0, -9.81]\n[material.m]\nE = 2e9\nnu = 0.3\ndensity = 1000\n[region.\"*\"]\nmaterial = \"m\"\n"
      "[section.s]\nkind = \"box\"\nwidth = 0.05\nheight = 0.03\nthickness = 0.004\n" +
      beam_of("[[0.1, 0.1, 1], [1, 0.1, 1.3]]", 4, "a = \"zmax\"\nmaterial = \"m\"") +
      "[[motion]]\nkind = \"fixed\"\nname = \"base\"\non = \"zmin\"\n" + push("arm.end", Vec3(0, 3, 5)) + tip_probe() + in_steps(2);
  std::map<Fidelity, Vec3> at;
  for (const Fidelity level : {Fidelity::nonlinear, Fidelity::linear, Fidelity::rigid}) {
    write_tags(work / "tags.h5", work / "mesh.h5", {level}, {"test"});
    const std::string mesh = work / "tags.h5";
    at[level] = tip(text, "'" + mesh + "'");
  }
  EXPECT_LT((at[Fidelity::linear] - at[Fidelity::nonlinear]).norm(), 1e-6);
  EXPECT_GT((at[Fidelity::rigid] - at[Fidelity::nonlinear]).norm(), 1e-6);
  EXPECT_LT((at[Fidelity::rigid] - at[Fidelity::nonlinear]).norm(), 1e-4);
}

// A strip of shells goes on as a beam from the facets of its end, and carries a post on facets of its face: sums of cantilevers.
TEST_F(BeamStatics, ABeamRidesOnASetOfShellsOfEveryFidelity) {
  const double E = 1e9, L = 1, b = 0.1, h = 0.01, EI = E * b * h * h * h / 12, beam = 40, P = 1e-3;
  const int n = 40;
  Mesh m = shell_mesh(plate(L, b), n, 4, h);
  for (const Facet& f : m.facet_sets.at("zmax")) {
    Vec3 centre = Vec3::Zero();
    for (const auto a : m.cell(f.cell)) centre += m.X[static_cast<size_t>(a)] / 8;
    if (centre.x() > L - L / n) m.facet_sets["foot"].push_back(f);
  }
  const std::string strip = shell_of(E, 0) + held("xmin") + plain_section(1e8, 1e8, beam, beam) + tip_probe() + in_steps(1),
                    ahead = beam_of("[[1, 0.05, 0], [1.5, 0.05, 0]]", 2, "a = \"xmax\""),
                    post = beam_of("[[0.9875, 0.05, 0.005], [0.9875, 0.05, 0.505]]", 2, "a = \"foot\"");
  const double B = 0.5,
               goes_on =
                   P * (L * L * L / (3 * EI) + B * L * L / (2 * EI)) + B * P * (L * L / (2 * EI) + B * L / EI) + P * B * B * B / (3 * beam),
               stands = P * ((B + h / 2) * (B + h / 2) * (L - L / n) / EI +
                             B * B * B / (3 * beam));  // up to the cell of the foot, from its middle
  for (const Fidelity level : {Fidelity::nonlinear, Fidelity::linear}) {
    use(m, {level});
    const double up = tip(strip + ahead + push("arm.end", {0, 0, P}))[2],
                 along = tip(strip + post + push("arm.end", {P, 0, 0}))[0] - 0.9875;
    std::printf("%.5f, %.5f\n", up / goes_on, along / stands);
    EXPECT_NEAR(up / goes_on, 1, 2e-3);
    EXPECT_NEAR(along / stands, 1, 5e-3);
  }
}

/// The turn about its line and the displacement of the tip of a metre of a section of thin walls, loaded in its centre of area.
class BeamOpenSections : public BeamPlace {
 protected:
  struct Tip {
    Vec3 u;
    double twist;
  };
  Tip loaded(const std::string& section, const Vec3& force, const Vec3& torque = Vec3::Zero()) {
    const Results r = solved("[section.s]\n" + section + "\n[material.m]\nE = 2e11\nnu = 0.3\n" +
                             beam_of("[[0, 0, 0], [1, 0, 0]]", 1, "material = \"m\"\na = \"ground\"") + push("arm.end", force) +
                             twist("arm.end", torque) + in_steps(1));
    const Eigen::RowVectorXd x = r.history("body/arm.1").bottomRows(1);
    // axis 1 of the section is y, 2 is z; columns: its origin, and that with each direction of the model
    return {Vec3(x.segment<3>(0).transpose()) - Vec3(1, 0, 0), std::atan2(x[8] - x[2], x[7] - x[1])};
  }
  static constexpr double E = 2e11, G = E / 2.6;
};

// Of a channel of one thickness the shear centre lies e = 3 b^2/(h + 6 b) beyond the web (middles of walls); a force in the centre of area
// twists it by its arm, a force and its moment about the shear centre do not.
TEST_F(BeamOpenSections, AChannelTwistsAboutItsShearCentre) {
  const double t = 0.001, b = 0.04, h = 0.08, e = 3 * b * b / (h + 6 * b);
  const std::string c = fmt::format("kind = \"C\"\nwidth = {}\nheight = {}\nflange = {}\nweb = {}\n", b + t / 2, h + t, t, t);
  const double centre = b * b / (h + 2 * b), arm = centre + e, J = (h + 2 * b) * t * t * t / 3;
  const double force = 1e-3;
  const Tip tip = loaded(c, Vec3(0, 0, force));
  EXPECT_NEAR(std::abs(tip.twist), force * arm / (G * J), 0.015 * force * arm / (G * J)) << "the walls' ends round J off";
  const double sign = tip.twist > 0 ? 1 : -1;
  EXPECT_LT(std::abs(loaded(c, Vec3(0, 0, force), Vec3(-sign * force * arm, 0, 0)).twist), 0.015 * std::abs(tip.twist));
  EXPECT_LT(std::abs(loaded(c, Vec3(0, force, 0)).twist), 1e-9 * std::abs(tip.twist)) << "along its axis of symmetry";
}

// Of an angle both shear forces pass through the corner; equal legs bend by the principal moments about the diagonals.
TEST_F(BeamOpenSections, AnAngleBendsAskewAndTwistsAboutItsCorner) {
  const double t = 0.002, a = 0.1, force = 0.01;
  const std::string l = fmt::format("kind = \"L\"\nwidth = {0}\nheight = {0}\nthickness = {1}\n", a, t);
  const double m = a - t / 2, centre = m / 4, J = 2 * m * t * t * t / 3;  // of the middles
  const Tip tip = loaded(l, Vec3(0, 0, force));
  EXPECT_NEAR(std::abs(tip.twist), force * centre / (G * J), 0.03 * force * centre / (G * J));
  // without the twist's share: principal moments m^3 t/3 about the axis of symmetry, m^3 t/12 about the other
  const double sign = tip.twist > 0 ? 1 : -1;
  const Tip pure = loaded(l, Vec3(0, 0, force), Vec3(-sign * force * centre, 0, 0));
  const double strong = force / 2 / (3 * E * m * m * m * t / 3), weak = force / 2 / (3 * E * m * m * m * t / 12);
  EXPECT_NEAR(pure.u.z(), strong + weak, 0.03 * weak);
  EXPECT_NEAR(std::abs(pure.u.y()), weak - strong, 0.03 * weak);
}

// A Z is alike when turned by half a turn: its shear centre is its centre of area; it bends askew, by int X1 X2 = (b h)^2 t ... of its
// flanges.
TEST_F(BeamOpenSections, AZBendsAskewWithoutTwist) {
  const double t = 0.001, b = 0.04, h = 0.08, force = 1e-3;
  const Tip tip =
      loaded(fmt::format("kind = \"Z\"\nwidth = {}\nheight = {}\nflange = {}\nweb = {}\n", b + t / 2, h + t, t, t), Vec3(0, 0, force));
  Eigen::Matrix2d I;  // int X1^2, X1 X2, X2^2
  I << 2 * b * b * b * t / 3, b * b / 2 * h / 2 * t * 2, b * b / 2 * h / 2 * t * 2, h * h * h * t / 12 + 2 * b * t * h * h / 4;
  const Eigen::Vector2d u = I.inverse() * Eigen::Vector2d(0, force) / (3 * E);
  EXPECT_NEAR(tip.u.z(), u[1], 0.02 * u[1]);
  EXPECT_NEAR(tip.u.y(), u[0], 0.03 * std::abs(u[0]));
  EXPECT_LT(std::abs(tip.twist), 1e-9);
}

// The shear centre of a T is where flange and web meet; a deep web carries shear as 5/6 of a rectangle where the flange is small.
TEST_F(BeamOpenSections, ATTwistsAboutItsJunction) {
  const double f = 0.001, w = 0.001, b = 0.06, h = 0.06, force = 1e-3;
  const double m = h - f / 2, below = m * m * w / 2 / (m * w + b * f), J = (m + b) * f * f * f / 3;  // of the centre below the flange
  const Tip tip = loaded(fmt::format("kind = \"T\"\nwidth = {}\nheight = {}\nflange = {}\nweb = {}\n", b, h, f, w), Vec3(0, force, 0));
  EXPECT_NEAR(std::abs(tip.twist), force * below / (G * J), 0.02 * force * below / (G * J));
  EXPECT_LT(
      std::abs(loaded(fmt::format("kind = \"T\"\nwidth = {}\nheight = {}\nflange = {}\nweb = {}\n", b, h, f, w), Vec3(0, 0, force)).twist),
      1e-9);
}

/// A load by length, along the whole of a beam.
std::string along(const Vec3& from, const Vec3& end, bool follower = false) {
  return fmt::format(
      "[[load]]\nkind = \"line\"\nname = \"wind\"\non = \"arm\"\nforce_per_length = [{}, {}, {}]\nforce_per_length_end = [{}, {}, {}]\n{}",
      from[0], from[1], from[2], end[0], end[1], end[2], follower ? "follower = true\n" : "");
}

// Triangular loads: w L^4/(30 E I) where it falls to nothing at the tip, 11 w L^4/(120 E I) where it rises to the tip; shear w L^2/(6 G A)
// and w L^2/(3 G A).  Exact with one cell, and in its middle with two.
TEST_F(BeamStatics, ALoadThatVariesBendsAsItsTriangle) {
  const double L = 2, EI = 900, GA = 4e4, w = 1e-3;
  for (const int cells : {1, 2, 3}) {
    const std::string beam = plain_section(GA, 2e6, EI, 700) + beam_of("[[0, 0, 0], [2, 0, 0]]", cells) + tip_probe() + in_steps(1);
    const double falling = tip(beam + along({0, 0, w}, {0, 0, 0}))[2], rising = tip(beam + along({0, w, 0}, {0, w, 0}))[1];
    EXPECT_NEAR(falling, w * std::pow(L, 4) / (30 * EI) + w * L * L / (6 * GA), 1e-6 * falling) << cells;
    EXPECT_NEAR(rising, w * std::pow(L, 4) / (8 * EI) + w * L * L / (2 * GA), 1e-6 * rising) << cells;
    const double late = tip(beam + along({0, 0, 0}, {0, 0, w}))[2];
    EXPECT_NEAR(late, 11 * w * std::pow(L, 4) / (120 * EI) + w * L * L / (3 * GA), 1e-6 * late) << cells;
  }
}

// On a part of the beam, between sections: P a^2 (3 L - a)/(6 E I) + P a/GA summed; where no section is, refused.
TEST_F(BeamStatics, ALoadOnAPartOfABeamBendsIt) {
  const double EI = 900, GA = 4e4, w = 1e-3;
  const std::string beam = plain_section(GA, 2e6, EI, 700) + beam_of("[[0, 0, 0], [2, 0, 0]]", 5) + tip_probe() + in_steps(1),
                    load = "[[load]]\nkind = \"line\"\nname = \"wind\"\non = \"arm\"\nforce_per_length = [0, 0, 1e-3]\n";
  const auto up_to = [&](double a) { return w * (a * a * a * (8 - a) / (24 * EI) + a * a / (2 * GA)); };
  EXPECT_NEAR(tip(beam + load + "to = 0.8\n")[2], up_to(0.8), 1e-6 * up_to(2));
  EXPECT_NEAR(tip(beam + load + "from = 0.8\n")[2], up_to(2) - up_to(0.8), 1e-6 * up_to(2));
  EXPECT_NEAR(tip(beam + load + "from = 0.4\nto = 1.6\n")[2], up_to(1.6) - up_to(0.4), 1e-6 * up_to(2));
  for (const auto& [keys, why] : {std::pair{"from = 0.5\n", "no section of beam \"arm\" stands 0.5 m along it, the nearest at 0.4 m"},
                                  std::pair{"to = 2.4\n", "no section of beam \"arm\" stands 2.4 m along it, the nearest at 2 m"},
                                  std::pair{"from = 0.8\nto = 0.4\n", "it ends where it begins, or before"}}) {
    work.write("scene.toml", beam + load + keys);
    expect_end(work.run("hilo-solve --quiet scene.toml -o run.h5"), 2, why);
  }
}

// A load across the sections that turns with them and falls from 1 to 0.4, until the tip has turned by about half a turn.  Along the
// deformed axis N' = k V, V' = -k N - p, M' = -V with k = M/EI, from N = V = M = 0 at the tip on: integrated here with fine steps.
TEST_F(BeamStatics, ALoadThatTurnsWithTheSectionsRollsTheBeam) {
  const double L = 1, EI = 10, p = 470;
  const auto load = [&](double s) { return p * (1 - 0.6 * s / L); };
  Eigen::Matrix<double, 6, 1> y = Eigen::Matrix<double, 6, 1>::Zero();  // N, V, M, angle, x, y, from the tip back, in axes of the tip
  const auto slope = [&](double s, const Eigen::Matrix<double, 6, 1>& u) {
    const double k = u[2] / EI;
    Eigen::Matrix<double, 6, 1> d;
    d << k * u[1], -k * u[0] - load(s), -u[1], k, std::cos(u[3]), std::sin(u[3]);
    return d;
  };
  const int n = 4000;
  for (int i = 0; i < n; ++i) {
    const double h = -L / n, s = L + i * h;
    const auto a = slope(s, y), b = slope(s + h / 2, y + h / 2 * a), c = slope(s + h / 2, y + h / 2 * b), d = slope(s + h, y + h * c);
    y += h / 6 * (a + 2 * b + 2 * c + d);
  }
  // in axes of the root: the tip from there
  const double turn = -y[3], x = -(std::cos(y[3]) * y[4] + std::sin(y[3]) * y[5]), z = -(-std::sin(y[3]) * y[4] + std::cos(y[3]) * y[5]);
  std::printf("turn %.4f, tip (%.4f, %.4f)\n", turn, x, z);
  double before = 0;
  for (const int cells : {8, 16, 32}) {
    const Vec3 at = tip(plain_section(1e7, 1e7, EI, 10) + beam_of("[[0, 0, 0], [1, 0, 0]]", cells) +
                        along({0, p, 0}, {0, 0.4 * p, 0}, true) + tip_probe() + in_steps(10));
    const double away = std::hypot(at[0] - x, at[2] - z);
    std::printf("%d cells: (%.5f, %.5f), %.2g of L away\n", cells, at[0], at[2], away);
    EXPECT_LT(away, 0.2 / (cells * cells));
    if (before > 0) {
      EXPECT_LT(away, before / 3.2) << "of second order";
    }
    before = away;
  }
}

// A section is meant on the axis of its beam, whatever hangs on it: no twist by a force, F s^3/3EI at it.
TEST_F(BeamStatics, AForceOnASectionActsOnTheAxis) {
  const Results r =
      solved(plain_section(1e8, 1e8, 1e3, 1e3, "line_mass = 1\ninertia = [1e-5, 1e-5]") + beam_of("[[0, 0, 0], [1, 0, 0]]", 2) +
             "[[point_mass]]\nname = \"lug\"\non = \"arm.1\"\nmass = 1e-3\nat = [0.5, 0.3, 0]\n" + push("arm.1", Vec3(0, 0, 0.1)) +
             tip_probe("arm.1") + in_steps(1));
  EXPECT_NEAR(r.history("beam/arm")(r.history("beam/arm").rows() - 1, 5), 0, 1e-7);
  const Vec3 at = r.history("probe/tip").bottomRows(1).leftCols<3>().transpose();
  EXPECT_NEAR(at[1], 0, 1e-7);
  EXPECT_NEAR(at[2], 0.1 * 0.125 / 3e3, 1e-8);
}

// The mass of a section is in its beam: an acceleration on it, or on a body without mass, did nothing without a word.
TEST_F(BeamStatics, AnAccelerationOfWhatHasNoMassIsRefused) {
  for (const std::string fidelity : {"nonlinear", "linear", "rigid"})
    for (const std::string on : {"arm.2", "knot"}) {
      work.write("scene.toml", plain_section(1e8, 1e8, 1e3, 1e3, "line_mass = 1\ninertia = [1e-5, 1e-5]") +
                                   beam_of("[[0, 0, 0], [1, 0, 0]]", 4, "a = \"ground\"\nb = \"knot\"\nfidelity = \"" + fidelity + "\"") +
                                   body("knot", 0, {1, 0, 0}, {0, 0, 0}) + load("acceleration", "a", on, "acceleration = [0, 0, -1]\n") +
                                   in_steps(1));
      ran = work.run("hilo-solve scene.toml -o run.h5");
      EXPECT_EQ(ran.exit, 2) << on;
      EXPECT_NE(ran.err.find(on == "knot" ? "has no mass" : "that of its beam"), std::string::npos) << ran.err;
    }
}

}  // namespace
}  // namespace hilo::test::beams_statics_test
