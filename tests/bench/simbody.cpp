// SPDX-License-Identifier: GPL-3.0-or-later
// Simbody beside hilo on the rigid scenes of rigid.sh, one thread: processor time of a step, error in position at ten times, drift of the
// energy.  Trees of pins closed by constraints, as Simbody's users build them; rates start as the scenes' do.
//   simbody-bench SCENE reference       t, x, y, z of the probe at ten times, from equations that know no joint (Bricard: Simbody at 1e-11)
//   simbody-bench SCENE merson|euler fixed|accuracy VALUE      steps, microseconds a step, error [m], largest |E - E0| [J]
// of Runge-Kutta-Merson or the semi-explicit Euler method of second order; SCENE is double, forty, bricard, bricard-as-given or top.
#include <Simbody.h>

#include <array>
#include <cstdio>
#include <ctime>
#include <functional>
#include <memory>

namespace {

using namespace SimTK;

/// One of the scenes, at rest or in its first motion; the probe is a point of a body.
struct Scene {
  MultibodySystem system;
  SimbodyMatterSubsystem matter{system};
  GeneralForceSubsystem forces{system};
  std::vector<std::pair<MobilizedBody, Real>> rate;  // of pins [rad/s]
  MobilizedBody probe;
  Vec3 station{0};
  double end = 10;  // [s]
  State state;

  void realize() {
    state = system.realizeTopology();
    for (const auto& [pin, u] : rate) pin.setOneU(state, 0, u);
    system.realize(state, Stage::Position);
  }
};

constexpr double g = 9.81;
constexpr double third = 1.0 / 12;

/// Frame at a point whose z is the axis.
Transform frame(const UnitVec3& axis, const Vec3& at) { return {Rotation(axis, ZAxis), at}; }

/// Loops in one plane: cranks 0..n of 1 m and 1 kg on the ground at x = i, a coupler between the tops of each two.
void four_bars(Scene& s, int n) {
  Force::UniformGravity(s.forces, s.matter, Vec3(0, -g, 0));
  std::vector<MobilizedBody> crank;
  const Body::Rigid upright(MassProperties(1, Vec3(0), Inertia(third, 0, third)));
  const Body::Rigid level(MassProperties(1, Vec3(0), Inertia(0, third, third)));
  for (int i = 0; i <= n; ++i) {
    crank.push_back(MobilizedBody::Pin(s.matter.Ground(), Vec3(i, 0, 0), upright, Vec3(0, -0.5, 0)));
    s.rate.emplace_back(crank.back(), -1);
  }
  for (int i = 1; i <= n; ++i) {
    MobilizedBody::Pin coupler(crank[i - 1], Vec3(0, 0.5, 0), level, Vec3(-0.5, 0, 0));
    s.rate.emplace_back(coupler, 1);
    Constraint::PointOnLine(crank[i], UnitVec3(ZAxis), Vec3(0, 0.5, 0), coupler, Vec3(0.5, 0, 0));  // two rows, none redundant
  }
  s.probe = crank[0], s.station = Vec3(0, 0.5, 0);
}

/// Bricard's mechanism; one row of the closing revolute is redundant in every position and, unless as given, left out by hand.
void bricard(Scene& s, bool as_given) {
  Force::UniformGravity(s.forces, s.matter, Vec3(0, -g, 0));
  const Vec3 corner[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}, {0, 0, 1}};
  const UnitVec3 axis[] = {UnitVec3(YAxis), UnitVec3(ZAxis), UnitVec3(XAxis), UnitVec3(YAxis), UnitVec3(ZAxis)};
  MobilizedBody before = s.matter.Ground();
  Vec3 origin(0);
  for (int i = 0; i < 5; ++i) {
    const Vec3 com = 0.5 * (corner[i] + corner[i + 1]), along = corner[i + 1] - corner[i];
    Vec3 J(third);
    for (int k = 0; k < 3; ++k)
      if (along[k] != 0) J[k] = 1e-4;
    const Body::Rigid rod(MassProperties(1, Vec3(0), Inertia(J)));
    before = MobilizedBody::Pin(before, frame(axis[i], corner[i] - origin), rod, frame(axis[i], corner[i] - com));
    if (i == 2) s.probe = before, s.station = corner[3] - com;
    origin = com;
  }
  Constraint::Ball(s.matter.Ground(), corner[5], before, corner[5] - origin);
  const UnitVec3 x(XAxis);
  Constraint::ConstantAngle(s.matter.Ground(), UnitVec3(ZAxis), before, x);
  if (as_given) Constraint::ConstantAngle(s.matter.Ground(), UnitVec3(YAxis), before, x);
}

void top(Scene& s) {
  Force::UniformGravity(s.forces, s.matter, Vec3(0, 0, -g));
  const Vec3 com(0, 1, 0);
  const Body::Rigid body(MassProperties(15, com, Inertia(0.234375, 0.46875, 0.234375).shiftFromMassCenter(com, 15)));
  s.probe = MobilizedBody::Ball(s.matter.Ground(), Vec3(0), body, Vec3(0));
  s.station = com, s.end = 2;
}

std::unique_ptr<Scene> build(const std::string& name) {
  auto s = std::make_unique<Scene>();
  if (name == "bricard" || name == "bricard-as-given")
    bricard(*s, name != "bricard");
  else if (name == "top")
    top(*s);
  else
    four_bars(*s, name == "forty" ? 40 : 2);
  s->realize();
  if (name == "top") s->probe.setUFromVector(s->state, Vector(Vec3(0, 150, -4.61538)));
  return s;
}

/// How to integrate: "merson" or "euler", with a step [s] or a local accuracy.
struct Method {
  std::string name;
  bool fixed;
  double value;
};

std::unique_ptr<Integrator> integrator(const Scene& s, const Method& m) {
  std::unique_ptr<Integrator> out;
  if (m.name == "euler")
    out = std::make_unique<SemiExplicitEuler2Integrator>(s.system);
  else
    out = std::make_unique<RungeKuttaMersonIntegrator>(s.system);
  if (m.fixed)
    out->setFixedStepSize(m.value);
  else
    out->setAccuracy(m.value);
  return out;
}

using Places = std::array<Vec3, 10>;

/// Where the probe is at ten times, and how far the energy [J] went from its start there and in between.
Places simulated(const std::string& name, const Method& m, double& drift) {
  const auto s = build(name);
  const auto run = integrator(*s, m);
  TimeStepper stepper(s->system, *run);
  stepper.setReportAllSignificantStates(true);
  stepper.initialize(s->state);
  const double E = s->system.calcEnergy(stepper.getState());
  Places out;
  drift = 0;
  for (int k = 0; k < 10; ++k) {
    const double t = s->end * (k + 1) / 10;
    while (stepper.getTime() < t) {
      stepper.stepTo(t);
      drift = std::max(drift, std::abs(s->system.calcEnergy(stepper.getState()) - E));
    }
    out[k] = s->probe.findStationLocationInGround(stepper.getState(), s->station);
  }
  return out;
}

template <size_t m>
using Values = std::array<double, m>;

/// Classical Runge-Kutta on y' = rate(y), n steps to each of ten times.
template <size_t m, class Rate>
std::array<Values<m>, 10> runge_kutta(Values<m> y, double end, int n, Rate rate) {
  std::array<Values<m>, 10> out;
  const double h = end / 10 / n;
  const auto along = [](Values<m> a, double s, const Values<m>& b) {
    for (size_t i = 0; i < m; ++i) a[i] += s * b[i];
    return a;
  };
  for (auto& at : out) {
    for (int i = 0; i < n; ++i) {
      const auto a = rate(y), b = rate(along(y, h / 2, a)), c = rate(along(y, h / 2, b)), d = rate(along(y, h, c));
      for (const auto& [weight, k] : {std::pair{1.0, &a}, {2.0, &b}, {2.0, &c}, {1.0, &d}}) y = along(y, h / 6 * weight, *k);
    }
    at = y;
  }
  return out;
}

Places reference(const std::string& name) {
  Places out;
  double unused;
  if (name == "bricard" || name == "bricard-as-given") return simulated("bricard", {"merson", false, 1e-11}, unused);
  if (name == "top") {  // Euler's equations about the pivot, body axes, and the directors' inertial components row by row
    const Vec3 J(15.234375, 0.46875, 15.234375);
    const auto y = runge_kutta<12>({0, 150, -4.61538, 1, 0, 0, 0, 1, 0, 0, 0, 1}, 2, 20000, [&](const Values<12>& s) {
      const Vec3 w(s[0], s[1], s[2]), down = -15 * g * Vec3(s[9], s[10], s[11]);
      const Vec3 moment = Vec3(0, 1, 0) % down - w % J.elementwiseMultiply(w);
      Values<12> rate;
      for (int k = 0; k < 3; ++k) {
        rate[k] = moment[k] / J[k];
        const Vec3 row = Vec3(s[3 + 3 * k], s[4 + 3 * k], s[5 + 3 * k]) % w;
        for (int i = 0; i < 3; ++i) rate[3 + 3 * k + i] = row[i];
      }
      return rate;
    });
    for (int k = 0; k < 10; ++k) out[k] = Vec3(y[k][4], y[k][7], y[k][10]);
    return out;
  }
  // All cranks turn alike: ((n + 1)/3 + n) theta'' = ((n + 1)/2 + n) g sin(theta).
  const double n = name == "forty" ? 40 : 2, pull = ((n + 1) / 2 + n) * g / ((n + 1) / 3 + n);
  const auto y = runge_kutta<2>({0, 1}, 10, 10000, [&](const Values<2>& s) { return Values<2>{s[1], pull * std::sin(s[0])}; });
  for (int k = 0; k < 10; ++k) out[k] = Vec3(std::sin(y[k][0]), std::cos(y[k][0]), 0);
  return out;
}

double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void measure(const std::string& name, const Method& m) {
  double error = 0, drift = 0, best = 1e300, spent = 0;
  const Places truth = reference(name), places = simulated(name, m, drift);
  for (int k = 0; k < 10; ++k) error = std::max(error, (places[k] - truth[k]).norm());
  int steps = 0;
  for (int k = 0; k < 5 && spent < 5; ++k) {
    const auto s = build(name);
    const auto run = integrator(*s, m);
    TimeStepper stepper(s->system, *run);
    stepper.initialize(s->state);
    const double start = processor_seconds();
    stepper.stepTo(s->end);
    const double seconds = processor_seconds() - start;
    best = std::min(best, seconds), spent += seconds;
    steps = run->getNumStepsTaken();
  }
  std::printf("%d %.4g %.2g %.2g\n", steps, best / steps * 1e6, error, drift);
}

}  // namespace

int main(int argc, char** argv) try {
  const std::string name = argc > 2 ? argv[1] : "", what = argc > 2 ? argv[2] : "";
  if (what == "reference") {
    const Places x = reference(name);
    const double end = build(name)->end;
    for (int k = 0; k < 10; ++k) std::printf("%.6g %.12g %.12g %.12g\n", end * (k + 1) / 10, x[k][0], x[k][1], x[k][2]);
    return 0;
  }
  if (argc != 5) return std::fputs("simbody-bench SCENE reference, or SCENE merson|euler fixed|accuracy VALUE\n", stderr), 1;
  measure(name, {what, std::string(argv[3]) == "fixed", std::stod(argv[4])});
} catch (const std::exception& e) {
  std::printf("failed: %s\n", e.what());
  return 3;
}
