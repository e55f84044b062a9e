// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>

#include "folder.hpp"
#include "machines/machine.hpp"
#include "verify/block_mesh.hpp"

namespace hilo::test {
namespace {

std::string list(const Vec3& v) { return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v[0], v[1], v[2]); }
std::string side(const Side& s) {
  return s.of == Side::Of::ground ? "ground" : s.of == Side::Of::body ? fmt::format("b{}", s.body) : s.set;
}

std::string body_text(const MachineBody& b, size_t i) {
  const Mat3& J = b.inertia;
  std::string out =
      fmt::format("[[body]]\nname = \"b{}\"\nmass = {:.17g}\ncom = {}\ninertia = [{:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}, {:.17g}]\n",
                  i, b.mass, list(b.com), J(0, 0), J(1, 1), J(2, 2), J(0, 1), J(0, 2), J(1, 2));
  if (b.moving()) out += fmt::format("[[initial]]\non = [\"b{}\"]\nvelocity = {}\nspin = {}\n", i, list(b.velocity), list(b.spin));
  for (int k = 0; k < 4; ++k)  // centre and three directors, from which the judge reads place and velocity
    out += fmt::format("[[probe]]\nname = \"b{0}p{1}\"\non = \"b{0}\"\nat = {2}\n", i, k, list(k ? b.com + Vec3::Unit(k - 1) : b.com));
  return out;
}

std::string joint_text(const MachineJoint& j, size_t i) {
  std::string out = fmt::format("[[joint]]\nkind = \"{}\"\nname = \"j{}\"\na = \"{}\"\nb = \"{}\"\n", j.kind, i, side(j.a), side(j.b));
  if (j.kind == "distance") return out + fmt::format("at_a = {}\nat_b = {}\n", list(j.at), list(j.at_b));
  out += fmt::format("at = {}\n", list(j.at));
  if (j.kind == "spherical" || j.kind == "fixed") return out + j.more;
  out += fmt::format("axis = {}\nx = {}\n", list(j.axis), list(j.x));
  if (j.kind == "screw") out += fmt::format("pitch = {:.17g}\n", j.pitch);
  if (j.kind == "gear") out += fmt::format("ratio = {:.17g}\naxis_b = {}\ncarrier = \"{}\"\n", j.ratio, list(j.axis_b), side(j.carrier));
  if (j.kind == "rack")
    out += fmt::format("radius = {:.17g}\ndirection = {}\ncarrier = \"{}\"\n", j.radius, list(j.axis_b), side(j.carrier));
  if (j.turn != 0)
    out += fmt::format("angle = {:.17g}\nhistory = {{ t = [0, {:.17g}], value = [0, 1], interpolation = \"smoother\" }}\n", j.turn,
                       j.turn_over);
  return out + j.more;
}

std::string spring_text(const MachineSpring& s, size_t i) {
  if (s.kind == "stop")
    return fmt::format("[[spring]]\nkind = \"stop\"\nname = \"s{}\"\na = \"{}\"\nb = \"{}\"\nat_a = {}\nat_b = {}\n", i, side(s.a),
                       side(s.b), list(s.at_a), list(s.at_b)) +
           fmt::format("lower = {:.17g}\nupper = {:.17g}\nstiffness = {:.17g}\nrestitution = {:.17g}\n", s.lower, s.upper, s.stiffness,
                       s.restitution);
  std::string out =
      fmt::format("[[spring]]\nkind = \"{}\"\nname = \"s{}\"\na = \"{}\"\nb = \"{}\"\nstiffness = {:.17g}\ndamping = {:.17g}\n", s.kind, i,
                  side(s.a), side(s.b), s.stiffness, s.damping);
  if (s.kind == "axial") return out + fmt::format("at_a = {}\nat_b = {}\nlength = {:.17g}\n", list(s.at_a), list(s.at_b), s.rest);
  return out + fmt::format("axis = {}\nangle = {:.17g}\n", list(s.axis), s.rest);
}

std::string block_text(const MachineBlock& b) {
  std::string out = fmt::format("[material.soft]\nkind = \"{}\"\nE = {:.17g}\nnu = {:.17g}\ndensity = {:.17g}\n",
                                b.yield > 0     ? "j2"
                                : b.neo_hookean ? "neo-hookean"
                                                : "stvk",
                                b.E, b.nu, b.density);
  if (b.yield > 0) out += fmt::format("yield = {:.17g}\nhardening = {:.17g}\nkinematic = {:.17g}\n", b.yield, b.hardening, b.kinematic);
  out += fmt::format("[region.block]\nmaterial = \"soft\"\ndamping = {:.17g}\n", b.damping);
  if (b.hub) out += "[region.hub]\nmaterial = \"soft\"\n";
  if (!b.spin.isZero())
    out += fmt::format("[[initial]]\non = [\"block\"{}]\nspin = {}\nabout = {}\n", b.hub ? ", \"hub\"" : "", list(b.spin),
                       list((b.low + b.high) / 2));
  return out;
}

}  // namespace

std::string scene_text(const Machine& m, const TimeAxis& time) {
  std::string out = fmt::format("title = \"{} {}\"\ngravity = {}\n", m.family, m.seed, list(m.gravity));
  if (!m.blocks.empty()) out += "mesh = \"tags.h5\"\n";
  out += fmt::format("[time]\nstep = {:.17g}\nend = {:.17g}\n{}[output]\ninterval = {:.17g}\n", time.step, time.end, time.more,
                     time.step / 4096);  // fields at every step, also at cut ones
  for (const MachineBlock& b : m.blocks) out += block_text(b);
  for (size_t i = 0; i < m.bodies.size(); ++i) out += body_text(m.bodies[i], i);
  for (size_t i = 0; i < m.joints.size(); ++i) out += joint_text(m.joints[i], i);
  for (size_t i = 0; i < m.springs.size(); ++i) out += spring_text(m.springs[i], i);
  return out + m.more;
}

Mesh block_of(const MachineBlock& b) {
  BlockOptions o{.shape = b.shape};
  std::copy(b.n, b.n + 3, o.n);
  o.low = b.low, o.high = b.high;
  o.regions = {"block"};
  if (b.hub) {
    o.regions = {"block", "hub"};
    const double from = b.high[0] - (b.high[0] - b.low[0]) / b.n[0];
    o.region_of = [from](const Vec3& x) { return x[0] > from ? 1 : 0; };
  }
  return block_mesh(o);
}

std::string write_machine(const Machine& m, const TimeAxis& time, const std::string& folder, const std::string& name) {
  if (!m.blocks.empty()) {
    write_mesh(folder + "/mesh.h5", block_of(m.blocks[0]), {"machines"});
    std::vector<Fidelity> fidelity{Fidelity::nonlinear};
    if (m.blocks[0].hub) fidelity.push_back(Fidelity::rigid);
    write_tags(folder + "/tags.h5", folder + "/mesh.h5", fidelity, {"machines"});
  }
  write_text(folder + "/" + name + ".toml", scene_text(m, time));
  return folder + "/" + name + ".toml";
}

bool Machine::damped() const {
  return std::any_of(springs.begin(), springs.end(), [](const MachineSpring& s) { return s.damping > 0; }) ||
         std::any_of(blocks.begin(), blocks.end(), [](const MachineBlock& b) { return b.damping > 0; });
}

double Machine::length() const {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  const auto add = [&](const Vec3& x) { low = low.cwiseMin(x), high = high.cwiseMax(x); };
  for (const auto& b : bodies) add(b.com);
  for (const auto& j : joints) add(j.at), add(j.kind == "distance" ? j.at_b : j.at);
  for (const auto& s : springs)
    if (s.kind != "torsion") add(s.at_a), add(s.at_b);
  for (const auto& b : blocks) add(b.low), add(b.high);
  return (high - low).norm();
}

}  // namespace hilo::test
