// Random machines by family.  Every joint is put together in the configuration in which it is drawn, so a scene needs no assembly.
#include <algorithm>
#include <numbers>
#include <stdexcept>

#include "machines/machine.hpp"

namespace hilo::test {
namespace {

constexpr double pi = std::numbers::pi;

/// Rows of a joint that are independent in general position.
int rows_of(const std::string& kind) {
  if (kind == "fixed") return 6;
  if (kind == "revolute" || kind == "prismatic" || kind == "screw") return 5;
  if (kind == "cylindrical" || kind == "universal" || kind == "constant-velocity") return 4;
  if (kind == "spherical" || kind == "planar") return 3;
  return kind == "in-line" ? 2 : 1;
}

struct Maker {
  Machine m;
  Dice dice;
  bool wide = false;  // mass ratios up to 1e4

  Mat3 rotation() { return Eigen::AngleAxisd(dice.in(-pi, pi), dice.direction()).toRotationMatrix(); }

  /// A box, plate or rod of about this size, its axes turned at random.
  int add_body(const Vec3& com, double size) {
    MachineBody b;
    b.mass = wide ? dice.logarithmic(1e-2, 1e2) : dice.logarithmic(0.3, 3);
    b.com = com;
    const Vec3 edge(size * dice.in(0.5, 1.5), size * dice.logarithmic(0.05, 1), size * dice.logarithmic(0.05, 1));
    const Vec3 J =
        b.mass / 12 *
        Vec3(edge[1] * edge[1] + edge[2] * edge[2], edge[0] * edge[0] + edge[2] * edge[2], edge[0] * edge[0] + edge[1] * edge[1]);
    const Mat3 R = rotation();
    b.inertia = R * J.asDiagonal() * R.transpose();
    m.bodies.push_back(b);
    return static_cast<int>(m.bodies.size()) - 1;
  }
  void throw_bodies(double speed) {
    for (auto& b : m.bodies)
      if (dice.chance(0.7)) b.spin = speed * dice.unit() * dice.direction(), b.velocity = speed / 3 * dice.unit() * dice.direction();
  }
  MachineJoint joint(const std::string& kind, const Side& a, const Side& b, const Vec3& at) {
    MachineJoint j;
    j.kind = kind, j.a = a, j.b = b, j.at = at, j.axis = dice.direction();
    do j.x = dice.direction();
    while (std::abs(j.x.dot(j.axis)) > 0.9);
    if (kind == "universal") j.x = j.axis.cross(j.x).normalized();
    j.pitch = dice.in(-0.3, 0.3);
    if (kind == "distance") j.at_b = at + dice.in(0.1, 0.5) * dice.direction();
    return j;
  }
  std::string any_kind() {
    static const std::vector<std::string> kinds{"revolute",  "revolute",  "revolute",  "revolute",  "spherical",
                                                "spherical", "spherical", "universal", "universal", "cylindrical",
                                                "screw",     "prismatic", "in-line",   "in-plane",  "constant-velocity",
                                                "planar",    "distance",  "fixed",     "revolute",  "spherical"};
    return kinds[dice.pick(static_cast<int>(kinds.size()))];
  }
  std::string hinge() {
    static const std::vector<std::string> kinds{"revolute", "revolute", "spherical", "universal", "constant-velocity", "cylindrical"};
    return kinds[dice.pick(static_cast<int>(kinds.size()))];
  }
  int mobility() const {
    int free = 6 * static_cast<int>(m.bodies.size());
    for (const auto& j : m.joints) free -= rows_of(j.kind);
    return free;
  }

  /// Bodies one after another (a chain) or each on a random earlier one (a tree).
  void grow(int n, bool chain, bool grounded, bool hinges_alone) {
    std::vector<Vec3> tip;
    for (int i = 0; i < n; ++i) {
      const int parent = i == 0 ? -1 : chain ? i - 1 : dice.pick(i + (grounded ? 1 : 0)) - (grounded ? 1 : 0);
      const double size = dice.in(0.3, 1.2);
      const Vec3 at = parent < 0 ? Vec3(i == 0 ? Vec3::Zero() : Vec3(dice.vector(1))) : tip[parent], along = size * dice.direction();
      const int b = add_body(at + along * dice.in(0.3, 0.7) + 0.1 * size * dice.vector(1), size);
      tip.push_back(at + along);
      if (i == 0 && !grounded) continue;
      m.joints.push_back(joint(hinges_alone ? hinge() : any_kind(), parent < 0 ? Side::ground() : Side::on(parent), Side::on(b), at));
    }
  }
  /// Joints between far bodies until the mechanism has few freedoms left; each of them leaves one or more.
  void close(int loops) {
    const int n = static_cast<int>(m.bodies.size());
    for (int k = 0; k < loops; ++k) {
      static const std::vector<std::string> kinds{"revolute", "spherical", "universal", "cylindrical", "in-line", "distance", "spherical"};
      std::string kind = kinds[dice.pick(static_cast<int>(kinds.size()))];
      if (mobility() - rows_of(kind) < 1) kind = "distance";
      if (mobility() - rows_of(kind) < 1) return;
      const int b = n - 1 - dice.pick(std::max(1, n / 2)), a = dice.chance(0.6) || b < 2 ? -1 : dice.pick(b - 1);
      m.joints.push_back(joint(kind, a < 0 ? Side::ground() : Side::on(a), Side::on(b), m.bodies[b].com + 0.5 * dice.vector(1)));
    }
  }
  /// A closed polygon of links hinged about parallel axes: three rows of its joints are redundant as long as they stay parallel.
  void polygon(int links) {
    const Mat3 R = rotation();
    std::vector<Vec3> corner;
    for (int i = 0; i <= links; ++i) {
      const double angle = 2 * pi * (i + dice.in(-0.25, 0.25)) / (links + 1);
      corner.push_back(R * (dice.in(0.6, 1.4) * Vec3(std::cos(angle), std::sin(angle), 0)));
    }
    for (int i = 0; i < links; ++i) {
      const int b = add_body((corner[i] + corner[i + 1]) / 2 + R * (0.1 * dice.vector(1)), (corner[i + 1] - corner[i]).norm());
      hinge_at(i ? Side::on(b - 1) : Side::ground(), Side::on(b), corner[i], R.col(2), i == 1 && dice.chance(0.25));
    }
    hinge_at(Side::ground(), Side::on(links - 1), corner[links], R.col(2), false);
  }
  void hinge_at(const Side& a, const Side& b, const Vec3& at, const Vec3& axis, bool ball) {
    MachineJoint j = joint(ball ? "spherical" : "revolute", a, b, at);
    j.axis = axis, j.x = axis.unitOrthogonal();
    m.joints.push_back(j);
  }
  /// Cranks of equal length on a common coupler; a third crank is redundant at every pose.
  void parallelogram(int cranks) {
    const Mat3 R = rotation();
    const double angle = dice.in(0.3, 1.2) * (dice.chance(0.5) ? 1 : -1) + pi / 2, length = dice.in(0.3, 0.8);
    const Vec3 crank = length * (R.col(0) * std::cos(angle) + R.col(1) * std::sin(angle));
    const int coupler = add_body(R.col(0) * 0.7 + crank, 1.4);
    for (int i = 0; i < cranks; ++i) {
      const Vec3 foot = R.col(0) * (1.4 * i / std::max(1, cranks - 1));
      const int b = add_body(foot + crank / 2, length);
      hinge_at(Side::ground(), Side::on(b), foot, R.col(2), false);
      hinge_at(Side::on(b), Side::on(coupler), foot + crank, R.col(2), false);
    }
  }
  void add_springs(int n, double damping_share) {
    for (int k = 0; k < n; ++k) {
      MachineSpring s;
      const int b = dice.pick(static_cast<int>(m.bodies.size()));
      const double mass = m.bodies[b].mass, frequency = dice.logarithmic(1, 10), stiffness = mass * frequency * frequency;
      const bool damped = dice.chance(damping_share);
      std::vector<const MachineJoint*> hinges;
      for (const auto& j : m.joints)
        if (j.kind == "revolute") hinges.push_back(&j);
      if (!hinges.empty() && dice.chance(0.3)) {
        const MachineJoint& j = *hinges[dice.pick(static_cast<int>(hinges.size()))];
        s.kind = "torsion", s.a = j.a, s.b = j.b, s.axis = j.axis, s.rest = dice.in(-1, 1);
        s.stiffness = 0.1 * stiffness;
      } else {
        const int a = dice.pick(static_cast<int>(m.bodies.size()) + 1) - 1;
        s.kind = "axial", s.a = a < 0 || a == b ? Side::ground() : Side::on(a), s.b = Side::on(b);
        s.at_a = (s.a.of == Side::Of::ground ? m.bodies[b].com + dice.direction() : m.bodies[a].com) + 0.2 * dice.vector(1);
        s.at_b = m.bodies[b].com + 0.3 * dice.vector(1);
        s.rest = (s.at_a - s.at_b).norm() * dice.in(0.5, 1.3);
        s.stiffness = stiffness;
      }
      if (damped) s.damping = 2 * dice.in(0.02, 0.5) * s.stiffness / frequency;
      if (damped && dice.chance(0.2)) s.stiffness = 0;
      m.springs.push_back(s);
    }
  }
};

/// A block between rigid bodies, or between one and the ground.
void add_block(Maker& k, bool damped, bool free) {
  Dice& d = k.dice;
  MachineBlock b;
  static constexpr Shape shapes[] = {Shape::hex8, Shape::hex8, Shape::tet4, Shape::tet10, Shape::wedge6, Shape::wedge15, Shape::hex20};
  b.shape = shapes[d.pick(7)];
  const bool big = b.shape == Shape::hex20 || b.shape == Shape::wedge15 || b.shape == Shape::tet10;
  b.n[0] = big ? 2 : 2 + d.pick(3), b.n[1] = big ? 1 : 1 + d.pick(2);
  b.high = Vec3(d.in(0.6, 1.5), d.in(0.15, 0.4), d.in(0.15, 0.4));
  b.low = Vec3::Zero();
  b.E = d.logarithmic(1e6, 1e10), b.nu = d.in(0, 0.45), b.density = d.logarithmic(300, 3000);
  b.neo_hookean = d.chance(0.4), b.hub = d.chance(0.3);
  if (damped) b.damping = d.logarithmic(1e-4, 1e-2);
  k.m.blocks.push_back(b);
  const Vec3 near(0, b.high[1] / 2, b.high[2] / 2), far(b.high[0], b.high[1] / 2, b.high[2] / 2);
  const Side end = Side::at(b.hub ? "hub" : "xmax");
  static const std::vector<std::string> kinds{"revolute", "spherical", "universal", "fixed", "revolute", "spherical"};
  if (free) {
    const int first = k.add_body(near - Vec3(d.in(0.1, 0.4), 0, 0), 0.5);
    k.m.joints.push_back(k.joint(kinds[d.pick(6)], Side::on(first), Side::at("xmin"), near));
  } else {
    k.m.joints.push_back(k.joint(kinds[d.pick(6)], Side::ground(), Side::at("xmin"), near));
  }
  if (free || d.chance(0.7)) {
    const int last = k.add_body(far + Vec3(d.in(0.1, 0.4), 0, 0), 0.5);
    k.m.joints.push_back(k.joint(kinds[d.pick(6)], end, Side::on(last), far));
    if (d.chance(0.4)) {
      const Vec3 at = k.m.bodies[last].com + 0.3 * d.direction();
      const int next = k.add_body(at + 0.3 * d.direction(), 0.5);
      k.m.joints.push_back(k.joint(k.hinge(), Side::on(last), Side::on(next), at));
    }
    if (d.chance(0.4)) k.add_springs(1, damped ? 1 : 0);
  }
  for (auto& body : k.m.bodies) body.mass *= b.density * b.high.prod(), body.inertia *= b.density * b.high.prod();
  for (auto& s : k.m.springs) s.stiffness *= b.density * b.high.prod(), s.damping *= b.density * b.high.prod();
  if (d.chance(0.6)) k.m.blocks[0].spin = d.in(0, 4) * d.direction();
}

}  // namespace

const std::vector<Family>& families() {
  static const std::vector<Family> list{
      {"chain", "bodies one after another, joints of any kind"},
      {"tree", "each body on a random earlier one, joints of any kind"},
      {"loop", "chains closed in space by one to three joints"},
      {"polygon", "closed chains of parallel hinges: three rows are redundant"},
      {"parallelogram", "two to four equal cranks on a coupler"},
      {"sprung", "trees and chains with axial and torsion springs"},
      {"damped", "the same with dampers"},
      {"floating", "trees without ground: momentum is kept"},
      {"block", "a flexible block on the ground, bodies behind it", true},
      {"floating-block", "bodies on both sides of a flexible block, no ground: momentum is kept", true},
      {"damped-block", "a block with material damping", true},
  };
  return list;
}

Machine random_machine(const std::string& family, std::uint64_t seed) {
  std::uint64_t salt = 1469598103934665603ull;
  for (char c : family) salt = (salt ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  Maker k{{}, Dice(seed * 1000003 + salt)};
  Dice& d = k.dice;
  k.m.family = family, k.m.seed = seed;
  k.wide = d.chance(0.5);
  const bool weight = d.chance(0.6), thrown = d.chance(0.6);
  if (weight) k.m.gravity = d.chance(0.7) ? Vec3(0, 0, -9.81) : Vec3(9.81 * d.direction());
  if (family == "chain") {
    k.grow(2 + d.pick(5), true, true, d.chance(0.5));
  } else if (family == "tree") {
    k.grow(3 + d.pick(5), false, true, d.chance(0.3));
  } else if (family == "loop") {
    k.grow(3 + d.pick(4), d.chance(0.7), true, true);
    k.close(1 + d.pick(3));
  } else if (family == "polygon") {
    k.polygon(3 + d.pick(4));
  } else if (family == "parallelogram") {
    k.parallelogram(2 + d.pick(3));
  } else if (family == "sprung" || family == "damped") {
    k.grow(2 + d.pick(5), d.chance(0.5), true, d.chance(0.6));
    k.add_springs(1 + d.pick(4), family == "damped" ? 0.8 : 0);
    if (family == "damped" && !k.m.damped()) k.m.springs[0].damping = 0.1 * k.m.springs[0].stiffness;
  } else if (family == "floating") {
    k.grow(2 + d.pick(5), d.chance(0.5), false, d.chance(0.6));
    for (auto& j : k.m.joints)
      if (j.kind == "in-line" || j.kind == "in-plane") j.kind = "spherical";
  } else if (family == "block" || family == "damped-block") {
    add_block(k, family == "damped-block", false);
  } else if (family == "floating-block") {
    add_block(k, false, true);
  } else {
    throw std::invalid_argument("no family " + family);
  }
  if (thrown || !weight) k.throw_bodies(d.logarithmic(0.5, 8));
  k.m.keeps_energy = !k.m.damped();
  return k.m;
}

}  // namespace hilo::test
