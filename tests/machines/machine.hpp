// SPDX-License-Identifier: GPL-3.0-or-later
// A machine as data: what the generator makes, the scene writer prints and the judge reads.  Nothing here knows the solver.
#pragma once
#include <cmath>
#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "model/mesh.hpp"

namespace hilo::test {

/// Numbers that are the same on every machine and compiler (splitmix64).
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15ull + 0x2545F4914F6CDD1Dull) {}
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ull);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  }
  double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  double in(double low, double high) { return low + (high - low) * unit(); }
  int pick(int n) { return static_cast<int>(next() % static_cast<std::uint64_t>(n)); }
  bool chance(double p) { return unit() < p; }
  double logarithmic(double low, double high) { return low * std::pow(high / low, unit()); }
  Vec3 vector(double size) { return {in(-size, size), in(-size, size), in(-size, size)}; }
  Vec3 direction() {
    for (;;) {
      const Vec3 v = vector(1);
      if (v.norm() > 0.1 && v.norm() < 1) return v.normalized();
    }
  }

 private:
  std::uint64_t state_;
};

struct MachineBody {
  double mass = 1;
  Vec3 com = Vec3::Zero();       // [m]
  Mat3 inertia = Mat3::Zero();   // about the centre of mass, inertial axes [kg m^2]
  Vec3 velocity = Vec3::Zero();  // of the centre, as given [m/s]
  Vec3 spin = Vec3::Zero();      // as given [rad/s]
  bool moving() const { return !velocity.isZero() || !spin.isZero(); }
};

/// One side of a joint or spring: the ground, a body, or what a block offers under a name (a face, a rigid end).
struct Side {
  enum class Of { ground, body, block } of = Of::ground;
  int body = -1;
  std::string set;  // of the mesh
  static Side ground() { return {}; }
  static Side on(int b) { return {Of::body, b, ""}; }
  static Side at(std::string name) { return {Of::block, -1, std::move(name)}; }
};

struct MachineJoint {
  std::string kind;
  Side a, b;
  Vec3 at = Vec3::Zero(), at_b = Vec3::Zero();  // at_b: of a distance
  Vec3 axis = Vec3::UnitZ(), x = Vec3::UnitX();
  double pitch = 0, ratio = 0, radius = 0;
  Vec3 axis_b = Vec3::Zero();
  Side carrier;
  double turn = 0, turn_over = 0;  // driven: angle [rad] reached after this time [s], smoothly
  bool gives = false;              // a compliant joint, which may be open
  std::string more;                // further keys
};

struct MachineSpring {
  std::string kind;  // axial, torsion, or a stop: a rope and a buffer of two points
  Side a, b;
  Vec3 at_a = Vec3::Zero(), at_b = Vec3::Zero(), axis = Vec3::UnitZ();
  double stiffness = 0, damping = 0, rest = 0;   // rest: free length or angle
  double lower = 0, upper = 0, restitution = 1;  // of a stop [m]
};

/// A flexible block of one shape between two faces; with `hub` the cells at its far end are a rigid region of that name.
struct MachineBlock {
  Shape shape = Shape::hex8;
  int n[3] = {2, 1, 1};
  Vec3 low = Vec3::Zero(), high = Vec3::Ones();
  double E = 1e7, nu = 0.3, density = 1000, damping = 0;
  double yield = 0, hardening = 0, kinematic = 0;  // of a metal; no yield stress: elastic [Pa]
  bool neo_hookean = false, hub = false;
  Vec3 spin = Vec3::Zero();
};

struct Machine {
  std::string family;
  std::uint64_t seed = 0;
  Vec3 gravity = Vec3::Zero();
  std::vector<MachineBody> bodies;
  std::vector<MachineJoint> joints;
  std::vector<MachineSpring> springs;
  std::vector<MachineBlock> blocks;                                  // none or one
  std::string more;                                                  // further sections of the scene
  enum class Energy { kept, falls, unknown } energy = Energy::kept;  // unknown: something supplies power, or stores it out of sight
  bool damped() const;
  double length() const;  // largest extent of all its points [m]
};

struct TimeAxis {
  double step = 0, end = 0;
  std::string more;  // further keys of [time]
};

/// The scene of a machine as hilo-solve reads it; the mesh it names, if any, is written by write_machine.
std::string scene_text(const Machine& m, const TimeAxis& time);
Mesh block_of(const MachineBlock& b);
/// Writes `folder`/name.toml, and its mesh and tags beside it.
std::string write_machine(const Machine& m, const TimeAxis& time, const std::string& folder, const std::string& name = "machine");

/// Families the generator knows, rigid ones first.
struct Family {
  std::string name, meaning;
  bool flexible = false, suite = true;
};
const std::vector<Family>& families();
inline void PrintTo(const Family& f, std::ostream* out) { *out << f.name; }
/// The machine of a family and a seed: the same on every computer.
Machine random_machine(const std::string& family, std::uint64_t seed);

}  // namespace hilo::test
