// SPDX-License-Identifier: GPL-3.0-or-later
// Kinds of springs between two ends.
#include "physics/spring_kinds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/keys.hpp"
#include "physics/axes.hpp"
#include "physics/spring_curve.hpp"

namespace hilo {
namespace {

using enum Type;

/// Three numbers, of which those left out are 0.
Vec3 padded(const EntryValues& e, std::string_view key) {
  const std::vector<double>& v = e.numbers(key);
  for (const double x : v)
    if (!(x >= 0)) e.refuse(key, fmt::format("{} is negative", key));
  return {v[0], v.size() > 1 ? v[1] : 0, v.size() > 2 ? v[2] : 0};
}

Spring axial(const SpringPlace& s, const Config& q) {
  const EntryValues& e = s.entry;
  const Vec3 at_a = e.vector3("at_a"), at_b = e.vector3("at_b");
  const double distance = (at_b - at_a).norm(), k = e.number("stiffness"), preload = e.number("preload");
  if (!(distance > 0)) e.refuse("at_b", "the two points coincide");
  if (preload != 0 && k == 0) e.refuse("preload", "a preload needs a stiffness");
  const double length = (e.given("length") ? e.number("length") : distance) - (k > 0 ? preload / k : 0);
  return make_axial_spring(
      {.a = s.a, .b = s.b, .at_a = at_a, .at_b = at_b, .stiffness = k, .damping = e.number("damping"), .length = length}, q);
}

Spring curve(const SpringPlace& s, const Config& q) {
  const EntryValues& e = s.entry;
  const Vec3 at_a = e.vector3("at_a"), at_b = e.vector3("at_b");
  const double distance = (at_b - at_a).norm();
  const std::vector<double>&x = e.numbers("extension"), &f = e.numbers("force");
  if (!(distance > 0)) e.refuse("at_b", "the two points coincide");
  if (x.size() < 2 || x.size() != f.size())
    e.refuse("force", fmt::format("{} forces at {} extensions", f.size(), x.size()), "two at least, and as many of each");
  double steepest = 0;
  for (size_t i = 1; i < x.size(); ++i) {
    if (!(x[i] > x[i - 1])) e.refuse("extension", fmt::format("value {} is not above the one before it", i + 1));
    steepest = std::max(steepest, std::abs((f[i] - f[i - 1]) / (x[i] - x[i - 1])));
  }
  const double free = e.given("length") ? e.number("length") : distance;
  Spring c = along_distance(s.a, s.b, at_a, at_b, q, make_curve(free, e.number("damping"), x, f));
  c.stiffness = steepest;
  return c;
}

Spring torsion(const SpringPlace& s, const Config& q) {
  const EntryValues& e = s.entry;
  return make_torsion_spring({.a = s.a,
                              .b = s.b,
                              .frame = joint_frame(e),
                              .stiffness = e.number("stiffness"),
                              .damping = e.number("damping"),
                              .angle = e.number("angle")},
                             q);
}

Spring bushing(const SpringPlace& s, const Config& q) {
  const EntryValues& e = s.entry;
  return make_bushing({.a = s.a,
                       .b = s.b,
                       .at = e.vector3("at"),
                       .frame = joint_frame(e),
                       .stiffness = {.along = padded(e, "stiffness"),
                                     .damping = padded(e, "damping"),
                                     .about = padded(e, "angular_stiffness"),
                                     .angular_damping = padded(e, "angular_damping")}},
                      q);
}

Spring rope_or_buffer(const SpringPlace& s, const Config& q) {
  return make_distance_stop(
      {.a = s.a, .b = s.b, .at_a = s.entry.vector3("at_a"), .at_b = s.entry.vector3("at_b"), .stop = stop_law(s.entry)}, q);
}

Spring support(const SpringPlace& s, const Config& q) {
  const EntryValues& e = s.entry;
  if (e.given("restitution") && e.number("damping") > 0)
    e.refuse("restitution", "restitution and damping are two ways to say the same", "leave one out");
  return make_support({.a = s.a,
                       .b = s.b,
                       .at = e.vector3("at"),
                       .frame = joint_frame(e),
                       .stiffness = e.number("stiffness"),
                       .damping = e.number("damping"),
                       .restitution = e.number("restitution"),
                       .rest_speed = e.number("rest_speed"),
                       .clearance = e.number("clearance"),
                       .tangential_stiffness = padded(e, "tangential_stiffness"),
                       .tangential_damping = padded(e, "tangential_damping")},
                      q);
}

std::vector<Param> support_keys() {
  std::vector<Param> keys{keys::at,
                          {"axis", vector3, "1", "[0, 0, 1]", "normal of the plane, towards b"},
                          keys::x_axis,
                          {"stiffness", number, "N/m", "!", "normal force per penetration, never a pull", at_least(0)},
                          {"damping", number, "N s/m", "0", "normal damping while in contact", at_least(0)}};
  for (const Param& p : rebound_keys("m/s")) keys.push_back(p);
  keys.insert(
      keys.end(),
      {{"clearance", number, "m", "0", "gap at the start; negative is penetration"},
       {"tangential_stiffness", numbers, "N/m", "[0, 0]", "along `x` and along axis x `x`, while it is lifted too", at_least(0), {2}},
       {"tangential_damping", numbers, "N s/m", "[0, 0]", "along `x` and along axis x `x`, while it is lifted too", at_least(0), {2}}});
  return keys;
}

std::vector<Param> rope_keys() {
  std::vector<Param> keys{keys::at_a,
                          keys::at_b,
                          {"lower", number, "m", "", "least distance"},
                          {"upper", number, "m", "", "greatest distance"},
                          {"stiffness", number, "N/m", "!", "of the stop, beyond the limit", above(0)}};
  for (const Param& p : rebound_keys("m/s")) keys.push_back(p);
  return keys;
}

}  // namespace

Registry<SpringKind>& spring_kinds() {
  static Registry<SpringKind> kinds{
      "spring",
      {
          {"stop", "limits of the distance of two points: a rope (upper) or a buffer (lower)", rope_keys(), rope_or_buffer},
          {"axial",
           "spring and damper along the line of two points",
           {keys::at_a,
            keys::at_b,
            {"stiffness", number, "N/m", "0", "force per extension", at_least(0)},
            {"damping", number, "N s/m", "0", "force per rate of extension", at_least(0)},
            {"length", number, "m", "", "free length; the initial distance when absent", at_least(0)},
            {"preload", number, "N", "0", "tension at the initial distance, added by shifting the free length; needs a stiffness"}},
           axial},
          {"curve",
           "force by a table over the extension of the line of two points, linear between its points and constant beyond them",
           {keys::at_a,
            keys::at_b,
            {"extension", numbers, "m", "!", "ascending; distance less free length"},
            {"force", numbers, "N", "!", "tension at each of them"},
            {"damping", number, "N s/m", "0", "force per rate of extension", at_least(0)},
            {"length", number, "m", "", "free length; the initial distance when absent", at_least(0)}},
           curve},
          {"torsion",
           "spring and damper about an axis that a and b share through a joint",
           {keys::axis,
            {"stiffness", number, "N m/rad", "0", "moment per angle of b relative to a", at_least(0)},
            {"damping", number, "N m s/rad", "0", "moment per rate of angle", at_least(0)},
            {"angle", number, "rad", "0", "free angle, measured from the initial position"}},
           torsion,
           true,
           true},
          {"bushing",
           "six springs and dampers in a frame carried by a",
           {keys::at,
            {"axis", vector3, "1", "[0, 0, 1]", "third axis of the frame"},
            keys::x_axis,
            {"stiffness", numbers, "N/m", "[0, 0, 0]", "three translational stiffnesses", at_least(0), {3}},
            {"damping", numbers, "N s/m", "[0, 0, 0]", "three translational dampings", at_least(0), {3}},
            {"angular_stiffness",
             numbers,
             "N m/rad",
             "[0, 0, 0]",
             "moments per angle: of three the rotation vector, to half a turn; of one or two, tilt of an axis and twist about it",
             at_least(0),
             {3}},
            {"angular_damping", numbers, "N m s/rad", "[0, 0, 0]", "three rotational dampings", at_least(0), {3}}},
           bushing,
           true,
           true},
          {"support", "unilateral spring of a point on b against a plane carried by a, with springs in the plane", support_keys(), support,
           true},
      }};
  return kinds;
}

}  // namespace hilo
