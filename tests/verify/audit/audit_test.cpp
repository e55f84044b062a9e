// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes that once ended with exit 0 and a wrong answer: bodies that turned by half a turn in one accepted step, where (R0 + R1)/2 loses
// rank and equations vanish, and joints that opened because their rows had been dropped as redundant at the one pose where they are.
// Truth: energy is kept, the fixed points of the joints stay together (recomputed here from the four points of each body), and what
// contradicts itself is refused.
#include "verify/verify.hpp"

namespace hilo::test::audit_test {
namespace {

/// Position of a material point, given at the start, from the four points of its body (centre and one along each axis).
Vec3 carried(const Results& r, const std::string& body, Eigen::Index row, const Vec3& at) {
  const auto points = r.history("body/" + body);
  const auto p = [&](Eigen::Index k, int i) -> Vec3 { return points.row(k).segment<3>(3 * i).transpose(); };
  Mat3 before, now;
  for (int i = 0; i < 3; ++i) before.col(i) = p(0, i + 1) - p(0, 0), now.col(i) = p(row, i + 1) - p(row, 0);
  return p(row, 0) + now * before.inverse() * (at - p(0, 0));
}

/// Largest distance between a point of one body and the same point of another ("" the ground) over all steps [m].
double gap(const Results& r, const std::string& a, const std::string& b, const Vec3& at) {
  double worst = 0;
  for (Eigen::Index k = 0; k < r.t().size(); ++k)
    worst = std::max(worst, (carried(r, b, k, at) - (a.empty() ? at : carried(r, a, k, at))).norm());
  return worst;
}

/// Largest angle by which a body turns in one step [rad].
double largest_turn(const Results& r, const std::string& body) {
  const auto points = r.history("body/" + body);
  double worst = 0;
  for (Eigen::Index k = 1; k < points.rows(); ++k) {
    Mat3 R[2];
    for (int e = 0; e < 2; ++e)
      for (int i = 0; i < 3; ++i)
        R[e].col(i) = (points.row(k - 1 + e).segment<3>(3 * i + 3) - points.row(k - 1 + e).segment<3>(0)).transpose().normalized();
    worst = std::max(worst, std::acos(std::clamp(((R[0].transpose() * R[1]).trace() - 1) / 2, -1.0, 1.0)));
  }
  return worst;
}

/// Kinetic, elastic and potential energy over all steps against the start, over the largest kinetic energy.
double drift(const Results& r) {
  const auto e = r.history("energy");
  const Eigen::VectorXd total = e.col(0) + e.col(1) + e.col(2);
  return (total.array() - total[0]).abs().maxCoeff() / e.col(0).maxCoeff();
}

TEST(Audit, NoBodyTurnsByHalfATurnInAStep) {
  const Case c("../cases");
  const struct {
    const char *scene, *more;
    std::vector<std::string> bodies;
  } cases[] = {{"half_turn_chain", "", {"b0", "b1", "b2", "b3"}},
               {"half_turn_chain", "--set time.step=0.0508", {"b0", "b1", "b2", "b3"}},
               {"half_turn_chain", "--set time.step=0.0436", {"b0", "b1", "b2", "b3"}},
               {"half_turn_rods", "", {"b0", "b1", "b2"}},
               {"half_turn_rods", "--set time.step=0.1", {"b0", "b1", "b2"}},
               {"half_turn_rods", "--set time.step=0.2", {"b0", "b1", "b2"}},
               {"half_turn_two", "", {"b0", "b1"}}};
  for (const auto& k : cases) {
    const Results r = c.solved(k.more, "run.h5", k.scene);
    EXPECT_LT(drift(r), 1e-11) << k.scene << k.more;
    for (const auto& body : k.bodies) EXPECT_LT(largest_turn(r, body), 2.0001) << k.scene << k.more << body;
    EXPECT_NE(text_of(c / "run.json").find("\"passed\": true"), std::string::npos);
  }
}

// Truth: p(t) h/E.  A load that grows slowly from nothing: the kinetic energy stays far below what positions are rounded to under the load.
TEST(Audit, ASlowLoadFromRestIsNoLossOfEnergy) {
  for (const bool lies : {false, true}) {
    Case c("contact");
    BlockOptions o;
    o.n[0] = 3, o.n[1] = o.n[2] = 2, o.high = Vec3(0.3, 0.2, 0.1);
    c.use(block_mesh(o), {Fidelity::nonlinear});
    c.write(
        "scene.toml",
        std::string("[material.m]\nE = 1e9\nnu = 0\ndensity = 1000\n[region.block]\nmaterial = \"m\"\n[[load]]\nkind = \"pressure\"\n"
                    "name = \"N\"\non = \"zmax\"\npressure = 1e3\nhistory = {t = [0, 0.2, 1], value = [0, 1, 1]}\n"
                    "[[joint]]\nkind = \"prismatic\"\nname = \"guide\"\na = \"ground\"\nb = \"zmax\"\nat = [0.15, 0.1, 0.1]\naxis = [0, "
                    "0, 1]\n[[probe]]\nname = \"top\"\non = \"zmax\"\n[time]\nend = 0.4\n") +
            (lies ? "[[obstacle]]\nkind = \"plane\"\nname = \"ground\"\n[[contact]]\nname = \"c\"\na = \"ground\"\nb = \"zmin\"\n"
                  : "[[motion]]\nkind = \"fixed\"\nname = \"foot\"\non = \"zmin\"\n"));
    for (const double step : {0.05, 0.02}) {
      succeeded(c.run(fmt::format("hilo-solve --quiet scene.toml tags.h5 --set time.step={} -o run.h5", step)));
      EXPECT_EQ(c.reported("steps"), std::lround(0.4 / step)) << lies;
      const Eigen::VectorXd end = Results(c / "run.h5").at("probe/top", 0.4);
      EXPECT_NEAR(0.1 - end[2], 1e3 / 1e9 * (lies ? 0.15 : 0.1), 0.05e-7) << lies << step << ", and a little vibration";
    }
  }
}

TEST(Audit, AMechanismDrawnFlatKeepsEveryJoint) {
  const Case c("../cases");
  const std::string driven = "--set joint.A.angle=6.28 --set 'joint.A.history={t=[0,2],value=[0,1],interpolation=\"smooth\"}'";
  for (const std::string& more : {std::string(), driven}) {
    const Results r = c.solved(more, "run.h5", "flat_parallelogram");
    EXPECT_LT(gap(r, "", "crank", Vec3(0, 0, 0)), 1e-12) << more;
    EXPECT_LT(gap(r, "crank", "coupler", Vec3(1, 0, 0)), 1e-12) << more;
    EXPECT_LT(gap(r, "coupler", "rocker", Vec3(4, 0, 0)), 1e-12) << more;
    EXPECT_LT(gap(r, "", "rocker", Vec3(3, 0, 0)), 1e-12) << more;
    EXPECT_EQ(c.reported("redundant_rows"), 3) << "of the plane mechanism in space; the fourth depends on the others at the start alone";
  }
  // without a drive nothing but gravity works: equal cranks of 1 m stay parallel, each of them a pendulum of I = 0.1 + 1/4 about its end
  // with 1 kg at half its length, and half the coupler's kilogram at its end
  const Results r = c.solved("", "run.h5", "flat_parallelogram");
  EXPECT_LT(drift(r), 1e-11);
  double angle = 0, rate = 0;
  const double I = 0.35 + 0.5, m_r = 0.5 + 0.5, h = 1e-5;
  const auto pull = [&](double a) { return 9.81 * m_r * std::cos(a) / I; };
  for (int k = 0; k < 50000; ++k) {  // to 0.5 s, mid-point
    const double a = angle + h / 2 * rate, w = rate + h / 2 * pull(angle);
    angle += h * w, rate += h * pull(a);
  }
  const Vec3 pin = carried(r, "crank", r.index(0.5), Vec3(1, 0, 0));
  EXPECT_NEAR(std::atan2(-pin.z(), pin.x()), angle, 2e-4);
}

TEST(Audit, ABarBetweenTwoPinsDoesNotFall) {
  const Case c("../cases");
  const Ran ran = c.solve("", "run.h5", 3, "dead_point");
  EXPECT_NE(ran.err.find("singular position"), std::string::npos) << ran.err;
  EXPECT_NE(ran.err.find("\"B\""), std::string::npos) << ran.err;
  EXPECT_NE(text_of(c / "run.json").find("\"passed\": false"), std::string::npos);
}

const char* arm =
    "[time]\nend = 1\nstep = 1e-2\n[[body]]\nname = \"arm\"\nmass = 1\ncom = [0.5, 0, 0]\ninertia = [0.1, 0.1, 0.1]\n"
    "[[joint]]\nkind = \"revolute\"\nname = \"drive\"\nb = \"arm\"\nat = [0, 0, 0]\naxis = [0, 0, 1]\nangle = 1.57\n";

TEST(Audit, ContradictionsAreRefusedByName) {
  const Case c("../cases");
  Ran ran = c.solve("", "run.h5", 2, "held_and_moved");
  EXPECT_NE(ran.err.find("joint \"w1\" holds what motion \"mv\" moves"), std::string::npos) << ran.err;
  const std::string smooth = "history = {t = [0, 1], value = [0, 1], interpolation = \"smooth\"}\n",
                    late = "history = {t = [0, 0.5, 1], value = [0, 0, 1]}\n";
  c.write("weld.toml", arm + smooth + "[[joint]]\nkind = \"fixed\"\nname = \"weld\"\nb = \"arm\"\nat = [0, 0, 0]\n");
  ran = c.run("hilo-solve weld.toml -o run.h5");
  expect_end(ran, 2, "joint \"drive\" is to be driven, but joint \"weld\" holds it still");
  c.write("rod.toml", arm + late + "[[joint]]\nkind = \"distance\"\nname = \"rod\"\nb = \"arm\"\nat_a = [3, 4, 0]\nat_b = [1, 0, 0]\n");
  ran = c.run("hilo-solve rod.toml -o run.h5");
  expect_end(ran, 2, "joint \"drive\" is to be driven, but joint \"rod\" holds it still");
  EXPECT_FALSE(std::filesystem::exists(c / "run.h5"));
}

// Two drives on one freedom do no harm while they agree; where they part company the run stops, and says so.
TEST(Audit, DrivesThatPartCompanyStopTheRun) {
  const Case c("../cases");
  const auto second = [&](const char* value) {
    return std::string("[[joint]]\nkind = \"revolute\"\nname = \"twin\"\nb = \"arm\"\nat = [0, 0, 0.3]\naxis = [0, 0, 1]\nangle = 1.57\n") +
           "history = {t = [0, 0.5, 1], value = [0, 0.5, " + value + "], interpolation = \"linear\"}\n";
  };
  const std::string first = "history = {t = [0, 0.5, 1], value = [0, 0.5, 1]}\n";
  c.write("same.toml", arm + first + second("1"));
  Ran ran = succeeded(c.run("hilo-solve --quiet same.toml -o run.h5"));
  EXPECT_LT(c.reported("constraint_violation"), 1e-12);
  c.write("apart.toml", arm + first + second("0.9"));
  ran = c.run("hilo-solve --quiet apart.toml -o run.h5");
  expect_end(ran, 3, "contradicts it");
  EXPECT_NEAR(c.reported("t"), 0.5, 0.02);
}

}  // namespace
}  // namespace hilo::test::audit_test
