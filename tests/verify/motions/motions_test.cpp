// What moves by a law: a body, a set of a flexible part or single components of its nodes have the position, velocity and acceleration of
// the law from the first step on, at kinks and behind them, with every integrator; what moves them is measured and its work accounted for.
#include <numbers>

#include "verify/verify.hpp"

namespace hilo::test {
namespace {

const std::vector<std::string> integrators{
    "energy-momentum", "mid-point", "generalized-alpha", "newmark", "hht", "wbz", "U0", "V0", "bathe", "bdf2", "radau"};

std::string with(const std::string& integrator) { return "--set 'time.integrator=\"" + integrator + "\"' "; }

/// A cart of 1 kg moved at 1 m/s from t = 0, a bob of 1 kg on a spring of 100 N/m before it.
std::string cart(const std::string& history) {
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

// Exact: the cart has 1 m/s and the energy of it throughout; the bob follows as x = 1 + t - sin(10 t)/10, and the hand that moves the cart
// feels 10 sin(10 t) N.
TEST_F(Motions, OfABodyHaveItsSpeedFromTheFirstStepWithEveryIntegrator) {
  write("scene.toml", cart("{t = [0, 1], value = [0, 1]}"));
  for (const std::string& kind : integrators) {
    SCOPED_TRACE(kind);
    const Results r = solved(with(kind));
    const auto x = r.history("probe/cart"), bob = r.history("probe/bob"), energy = r.history("energy"), force = r.history("motion/drive");
    for (Eigen::Index i = 0; i < r.t().size(); ++i) {
      const double t = r.t()[i];
      EXPECT_NEAR(x(i, 0), t, 1e-14);
      EXPECT_NEAR(x(i, 3), 1, 1e-14);
      EXPECT_NEAR(x(i, 6), 0, 1e-10);
      EXPECT_NEAR(energy(i, 0), 0.5 + bob(i, 3) * bob(i, 3) / 2, 1e-13);
      EXPECT_NEAR(bob(i, 0), 1 + t - std::sin(10 * t) / 10, 1e-3);
      EXPECT_NEAR(force(i, 0), 10 * std::sin(10 * t), 0.15);
    }
    EXPECT_NE(err.find("motion \"drive\" changes its speed by 1 m/s at once: an impulse that does work of 0.5 J"), std::string::npos)
        << err;
    EXPECT_NE(text_of(*this / "run.json").find("\"impulses\": {\"count\": 1, \"work\": 0.5}"), std::string::npos);
    if (kind == "energy-momentum" || kind == "mid-point") {
      EXPECT_LT(reported("energy_balance"), 1e-13);
    }
  }
}

// Exact: where the speed jumps, at instants between the steps of the run, it jumps once, by m (v1^2 - v0^2)/2, and the steps end there.
TEST_F(Motions, TakeAKinkAtAnOddTimeAsABlow) {
  write("scene.toml", cart("{t = [0, 0.0537, 0.0791, 1], value = [0, 0, 0.0508, 0.0508]}"));
  for (const std::string& kind : integrators)
    for (const std::string steps : {"", " --set time.tolerance=1e-4"}) {
      SCOPED_TRACE(kind + steps);
      const Results r = solved(with(kind) + steps);
      const auto x = r.history("probe/cart");
      for (Eigen::Index i = 0; i < r.t().size(); ++i) {
        const double t = r.t()[i], speed = t > 0.0537 + 1e-12 && t < 0.0791 + 1e-12 ? 2 : 0;
        EXPECT_NEAR(x(i, 3), speed, 1e-12) << t;
        EXPECT_NEAR(x(i, 6), 0, 1e-8) << t;
        const double s = t - 0.0537, d = t - 0.0791;  // the bob is a sum of two such waves
        const double bob = 1 + (s > 0 ? 2 * (s - std::sin(10 * s) / 10) : 0) - (d > 0 ? 2 * (d - std::sin(10 * d) / 10) : 0);
        EXPECT_NEAR(r.history("probe/bob")(i, 0), bob, 2e-3) << t;
      }
      EXPECT_LT((r.t().array() - 0.0537).abs().minCoeff(), 1e-15);
      EXPECT_LT((r.t().array() - 0.0791).abs().minCoeff(), 1e-15);
      if (kind == "energy-momentum") {
        EXPECT_LT(reported("energy_balance"), 1e-13);
      }
    }
}

// Exact: a load on what moves by a law changes nothing but the hand, which takes over its work.
TEST_F(Motions, DoNotFeelALoadOnWhatTheyMove) {
  write_mesh(*this / "mesh.h5", block_mesh({}), {"test"});
  const std::string scene = R"([material.soft]
E = 1e5
nu = 0.3
density = 1000
[region."*"]
material = "soft"
[[motion]]
kind = "fixed"
name = "held"
on = "xmin"
components = ["x", "y", "z"]
[[motion]]
kind = "translation"
name = "pull"
on = "xmax"
components = ["x"]
displacement = [0.1, 0, 0]
history = {t = [0, 0.2], value = [0, 1], interpolation = "smooth"}
[time]
end = 0.2
step = 0.005
)";
  write("scene.toml", scene);
  const Results alone = solved("", "mesh.h5");
  const Eigen::VectorXd work = alone.history("energy").col(3);
  write("scene.toml", scene + R"([[load]]
kind = "force"
name = "push"
on = "xmax"
force = [3e4, 0, 0]
history = {t = [0, 0.2], value = [1, 0.5]}
)");
  const Results pushed = solved("", "mesh.h5");
  EXPECT_GT(work.cwiseAbs().maxCoeff(), 1);
  EXPECT_LT((pushed.history("energy").col(3) - work).cwiseAbs().maxCoeff(), 1e-10 * 3e4 * 0.1);
  const auto hand = [&](const Results& r, double t) { return r.at("motion/pull", t)[0]; };
  EXPECT_NEAR(hand(pushed, 0.1), hand(alone, 0.1) - 0.75 * 3e4, 1e-6 * 3e4);
}

// Invariant: the same motion a little later gives the same answer a little later.
TEST_F(Motions, DoNotAskWhenTheyStart) {
  write("scene.toml", cart("{t = [0, 1], value = [0, 1]}"));
  const Results now = solved("--set time.end=0.1");
  write("scene.toml", cart("{t = [0.05, 1.05], value = [0, 1]}"));
  const Results later = solved();
  for (const double t : {0.01, 0.04, 0.1}) {
    EXPECT_LT((now.at("probe/bob", t).tail(6) - later.at("probe/bob", t + 0.05).tail(6)).norm(), 1e-10) << t;
    EXPECT_LT((now.at("motion/drive", t) - later.at("motion/drive", t + 0.05)).norm(), 1e-10) << t;
  }
}

/// A crank of 1 kg, its centre 0.5 m from the axis, turned by a motion; a bob of 1 kg pinned to it at 1 m, with the right velocity.
std::string crank(const std::string& history) {
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

// Exact: nothing to change at the start, the pin pulls with m w^2 r = 1 N along the crank, the hand holds 1 + 0.5 N.
TEST_F(Motions, LeaveAVelocityGivenBesideThemAsItIs) {
  write("scene.toml", crank("{t = [0, 1], value = [0, 1]}") + "[[initial]]\non = [\"bob\"]\nvelocity = [0, 1, 0]\n");
  for (const std::string& kind : integrators) {
    SCOPED_TRACE(kind);
    const Results r = solved(with(kind));
    EXPECT_EQ(err.find("initial velocities changed"), std::string::npos) << err;
    EXPECT_LT(reported("velocity_change"), 1e-14);
    for (Eigen::Index i = 0; i < r.t().size(); ++i) {
      const double t = r.t()[i];
      const Vec3 along(std::cos(t), std::sin(t), 0), pin = r.history("joint/pin").row(i).head<3>(),
                                                     hand = r.history("motion/drive").row(i).head<3>(),
                                                     v = r.history("probe/crank").row(i).segment<3>(3);
      EXPECT_LT((v - 0.5 * Vec3(-std::sin(t), std::cos(t), 0)).norm(), 1e-14);
      // a transverse force of first order dies out behind the start where accelerations are constrained
      EXPECT_NEAR(pin[0], -1, 5e-3) << t;
      EXPECT_NEAR(hand.dot(along), -1.5, 5e-3) << t;
      EXPECT_LT(pin.tail<2>().norm(), 0.04) << t;
    }
  }
}

// Exact: m a, with the centripetal and the tangential part, about any axis and over more than a turn; of second order in the step for all,
// of a higher one for Radau.
TEST_F(Motions, AreMovedByMassTimesAcceleration) {
  const std::string scene = R"([[body]]
name = "free"
mass = 1
com = [0, 0, 0]
inertia = [1, 1, 1]
[[body]]
name = "arm"
mass = 2
com = [0.5, 0.2, 0.1]
inertia = [0.3, 0.2, 0.4]
[[motion]]
kind = "rotation"
name = "drive"
on = "arm"
at = [0, 0, 1]
axis = [1, 2, 2]
angle = 9
history = {t = [0, 1], value = [0, 1], interpolation = "smoother"}
[[probe]]
name = "arm"
on = "arm"
[time]
end = 1
step = 0.01
)";
  write("scene.toml", scene);
  const Vec3 axis = Vec3(1, 2, 2) / 3, arm(0.5, 0.2, -0.9);
  const auto exact = [&](double t) {  // position, velocity, acceleration
    const double s = t, w = s * s * s * s * (35 + s * (-84 + s * (70 - 20 * s))), dw = 140 * s * s * s * (1 - s) * (1 - s) * (1 - s),
                 ddw = 420 * s * s * (1 - s) * (1 - s) * (1 - 2 * s);
    const Vec3 r = Eigen::AngleAxisd(9 * w, axis) * arm, spin = 9 * dw * axis;
    Eigen::Matrix<double, 9, 1> x;
    x << Vec3(r + Vec3::UnitZ()), spin.cross(r), (9 * ddw * axis).cross(r) + spin.cross(spin.cross(r));
    return x;
  };
  for (const std::string& kind : integrators) {
    SCOPED_TRACE(kind);
    double error[2] = {};
    for (int fine = 0; fine < 2; ++fine) {
      const Results r = solved(with(kind) + (fine ? "--set time.step=0.005" : ""));
      for (const double t : {0.3, 0.5, 0.7}) {
        EXPECT_LT((r.at("probe/arm", t).head<6>() - exact(t).head<6>()).norm(), 1e-12) << t;
        error[fine] = std::max(error[fine], (r.at("motion/drive", t).head<3>() - 2 * exact(t).tail<3>()).norm());
      }
    }
    EXPECT_LT(error[1], 2) << "of 700 N";
    EXPECT_LT(error[1], 0.3 * error[0] + 1e-10);
    if (kind == "energy-momentum" || kind == "mid-point") {
      EXPECT_LT(reported("energy_balance"), 1e-13);
    }
  }
}

/// A steel bar of 1 m with ten cells; sets root and tip.
Mesh bar() {
  BlockOptions o;
  o.n[0] = 10;
  o.high = Vec3(1, 0.1, 0.1);
  o.regions = {"bar"};
  return block_mesh(o);
}

const std::string steel = R"([material.steel]
E = 2e11
nu = 0.3
density = 7800
[region.bar]
material = "steel"
[[probe]]
name = "tip"
on = "xmax"
[[probe]]
name = "root"
on = "xmin"
[time]
end = 0.003
step = 1e-4
[output]
interval = 0.001
)";
const std::string moved_root = R"([[motion]]
kind = "translation"
name = "drive"
on = "xmin"
displacement = [1, 0, 0]
history = {t = [0, 1], value = [0, 1]}
)";

/// The scene as parts for two ranks.
void share(const Workplace& place) { ASSERT_EQ(place.run("hilo-part mesh.h5 -n 2 -o parts.h5").exit, 0); }

// Exact: a bar that moves as one is without stress and acceleration, whether its end is moved whole or by components.
TEST_F(Motions, OfASetOfABarThatMovesAlongLeaveItWithoutStress) {
  write_mesh(*this / "mesh.h5", bar(), {"test"});
  share(*this);
  const std::string along = "[[initial]]\non = [\"bar\"]\nvelocity = [1, 0, 0]\n";
  for (const std::string components : {"", "components = [\"x\"]\n"})
    for (const std::string& kind : integrators) {
      SCOPED_TRACE(kind + components);
      write("scene.toml", steel + moved_root + components + along);
      for (const int ranks : {1, 2}) {
        if (ranks == 2 && kind == "radau") continue;  // serial
        if (ranks == 1) {
          solved(with(kind), "mesh.h5");
          EXPECT_EQ(err.find("initial velocities changed"), std::string::npos) << err;
          EXPECT_EQ(err.find("impulse"), std::string::npos) << err;
        } else if (kind == "energy-momentum" || kind == "generalized-alpha") {
          ASSERT_EQ(mpirun(2, "hilo-solve --quiet scene.toml parts.h5 -o run.h5", path()).exit, 0);
        } else {
          continue;
        }
        const Results r(*this / "run.h5");
        // round-off of positions of 1 m in cells of 2e11 Pa
        EXPECT_LT(r.table("/field/" + r.steps().back() + "/von_mises").maxCoeff(), 0.05);
        EXPECT_LT(r.peak("probe/tip", 6, 3), 1e-4);
        EXPECT_NEAR(r.history("probe/root").col(3).minCoeff(), 1, 1e-14);
        EXPECT_LT(reported("energy_balance"), 1e-10);
      }
    }
}

// Invariant: an end moved by a motion and one moved by a driven joint are the same, from rest (an impulse), over kinks, and on two ranks.
TEST_F(Motions, OfASetAreThoseOfADrivenJoint) {
  write_mesh(*this / "mesh.h5", bar(), {"test"});
  share(*this);
  const std::string history = "history = {t = [0, 0.00123, 0.00217, 1], value = [0, 0.00123, 0.0006, 0.0006]}\n";
  const std::string fields = "--set time.step=2e-5 --set time.end=0.0025 --set 'output.fields=[\"displacement\"]'";
  const auto compare = [&](const Results& a, const Results& b, const std::string& force_a, const std::string& force_b, const Mat3& back) {
    for (const double t : {0.00123, 0.00217, 0.0025}) {
      const auto u = a.at("probe/tip", t), w = b.at("probe/tip", t);
      EXPECT_LT((u.head(3) - w.head(3)).norm(), 1e-10) << t;
      EXPECT_LT((u.segment(3, 3) - w.segment(3, 3)).norm(), 1e-6) << t;
      const Vec3 f = a.at(force_a, t).head<3>(), g = back * Vec3(b.at(force_b, t).head<3>());
      EXPECT_LT((f - g).norm(), 1e-4 * std::max(1e4, f.norm())) << t;
    }
  };
  for (const std::string kind : {"energy-momentum", "mid-point", "bathe"}) {
    SCOPED_TRACE(kind);
    write("scene.toml",
          steel + "[[motion]]\nkind = \"translation\"\nname = \"drive\"\non = \"xmin\"\ndisplacement = [1, 0, 0]\n" + history);
    solved(with(kind) + fields, "mesh.h5");
    EXPECT_NE(err.find("an impulse that does work of"), std::string::npos) << err;
    if (kind == "energy-momentum") {
      EXPECT_LT(reported("energy_balance"), 1e-9);
      const Results one(*this / "run.h5");
      ASSERT_EQ(mpirun(2, "hilo-solve --quiet scene.toml parts.h5 -o two.h5 " + fields, path()).exit, 0);
      EXPECT_NE(text_of(*this / "two.json").find("\"count\": 3"), std::string::npos);
      compare(one, Results(*this / "two.h5"), "motion/drive", "motion/drive", Mat3::Identity());
      const auto e = one.history("energy"), f = Results(*this / "two.h5").history("energy");
      EXPECT_LT((e - f).cwiseAbs().maxCoeff(), 1e-8 * e.cwiseAbs().maxCoeff()) << "work on two ranks";
    }
    ASSERT_EQ(run("mv run.h5 moved.h5").exit, 0);
    write(
        "scene.toml",
        steel +
            "[[joint]]\nkind = \"prismatic\"\nname = \"drive\"\nb = \"xmin\"\nat = [0, 0.05, 0.05]\naxis = [1, 0, 0]\ndisplacement = 1\n" +
            history);
    const Results driven = solved(with(kind) + fields, "mesh.h5");
    const Vec3 axis = Vec3::UnitX();
    compare(Results(*this / "moved.h5"), driven, "motion/drive", "joint/drive", frame_of_axis(axis));
  }
}

// Exact: a bar turned by its root with its own initial spin keeps turning: as a rigid one but for the stretch rho w^2 L^2/2E = 5e-7 at 30
// rad/s ... here the invariant is that motion and driven joint agree over most of a turn, and that work is the change of energy.
TEST_F(Motions, TurnAFlexibleSetThroughLargeAngles) {
  write_mesh(*this / "mesh.h5", bar(), {"test"});
  share(*this);
  const std::string spin = "[[initial]]\non = [\"bar\"]\nspin = [0, 0, 30]\nabout = [0, 0.05, 0.05]\n";
  const std::string history = "history = {t = [0, 1], value = [0, 30]}\n";
  const std::string soft = "--set material.steel.E=2e8 --set time.step=1e-3 --set time.end=0.16 --set output.interval=0.08 ";
  write("scene.toml",
        steel + spin +
            "[[motion]]\nkind = \"rotation\"\nname = \"drive\"\non = \"xmin\"\nat = [0, 0.05, 0.05]\naxis = [0, 0, 1]\nangle = 1\n" +
            history);
  const Results moved = solved(soft, "mesh.h5");
  EXPECT_EQ(err.find("initial velocities changed"), std::string::npos) << err;
  EXPECT_EQ(err.find("impulse"), std::string::npos) << err;
  EXPECT_LT(reported("energy_balance"), 1e-10);
  for (const double t : {0.001, 0.08, 0.16}) {
    const Vec3 v = moved.at("probe/root", t).segment<3>(3);
    EXPECT_LT(v.norm(), 1e-12) << "the mean of the root is on the axis";
  }
  ASSERT_EQ(mpirun(2, "hilo-solve --quiet scene.toml parts.h5 -o two.h5 " + soft, path()).exit, 0);
  const Results two(*this / "two.h5");
  EXPECT_LT((moved.history("probe/tip") - two.history("probe/tip")).leftCols(3).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_LT((moved.history("energy") - two.history("energy")).leftCols(5).cwiseAbs().maxCoeff(), 1e-8 * moved.history("energy")(0, 0));
  ASSERT_EQ(run("mv run.h5 moved.h5").exit, 0);
  write("scene.toml",
        steel + spin +
            "[[joint]]\nkind = \"revolute\"\nname = \"drive\"\nb = \"xmin\"\nat = [0, 0.05, 0.05]\naxis = [0, 0, 1]\nangle = 1\n" +
            history);
  const Results driven = solved(soft, "mesh.h5"), again(*this / "moved.h5");
  for (const double t : {0.001, 0.08, 0.16}) {
    EXPECT_LT((again.at("probe/tip", t).head(3) - driven.at("probe/tip", t).head(3)).norm(), 2e-5) << t;
    EXPECT_NEAR(again.at("motion/drive", t)[5], driven.at("joint/drive", t)[5], 0.02 * 78 * 900 / 3) << t;
  }
}

// Exact: steps in which a body would turn by more than a quarter are cut, until the force that holds it is m w^2 r.
TEST_F(Motions, AreFollowedThroughTurnsThatAStepCannotTake) {
  write("scene.toml", crank("{t = [0, 1], value = [0, 200]}") + "[[initial]]\non = [\"bob\"]\nvelocity = [0, 200, 0]\n");
  for (const std::string kind : {"energy-momentum", "radau"}) {
    solved(with(kind) + "--set time.end=0.05");
    EXPECT_GT(reported("cuts"), 0) << kind;
    const Results r(*this / "run.h5");
    EXPECT_NEAR(r.at("motion/drive", 0.03).head<3>().norm(), 1.5 * 200 * 200, 0.15 * 1.5 * 200 * 200)
        << kind << ": two cuts, 0.5 rad a step";
  }
}

TEST_F(Motions, RefuseAHistoryThatJumpsAndComponentsMovedTwice) {
  write("scene.toml", cart("{t = [0, 1, 1, 2], value = [0, 0, 1, 1]}"));
  Ran ran = run("hilo-solve --quiet scene.toml -o run.h5");
  EXPECT_EQ(ran.exit, 2);
  EXPECT_NE(ran.err.find("motion \"drive\": the history jumps at t = 1"), std::string::npos) << ran.err;
  write_mesh(*this / "mesh.h5", bar(), {"test"});
  write("scene.toml", steel + moved_root + "components = [\"x\", \"y\"]\n" +
                          "[[motion]]\nkind = \"fixed\"\nname = \"slide\"\non = \"ymin\"\ncomponents = [\"y\"]\n");
  ran = run("hilo-solve --quiet scene.toml mesh.h5 -o run.h5");
  EXPECT_EQ(ran.exit, 2);
  EXPECT_NE(ran.err.find("motion \"drive\" prescribes the same component of a node"), std::string::npos) << ran.err;
}

}  // namespace
}  // namespace hilo::test
