// SPDX-License-Identifier: GPL-3.0-or-later
// The kinds of joints as lists of quadratic measures and rows: every kind has its minimal number of independent rows.  Another one is a
// function that makes it, and a row of the table below.
#include <cmath>
#include <numbers>

#include "base/keys.hpp"
#include "physics/axes.hpp"
#include "physics/coordinates.hpp"
#include "physics/joint_maker.hpp"
#include "physics/rolling.hpp"

namespace hilo {
namespace {

Joint spherical(const JointPlace& j, const Config& q) {
  JointMaker m(j, q);
  m.same_point();
  return m.with();
}

Joint fixed(const JointPlace& j, const Config& q) {
  JointMaker m(j, q);
  m.same_point();
  m.aligned();
  return m.with();
}

Joint revolute(const JointPlace& j, const Config& q) {
  JointMaker m(j, q);
  m.same_point(), m.parallel();
  return m.with();
}

Joint universal(const JointPlace& j, const Config& q) {
  JointMaker m(j, q);
  m.same_point();
  m.dot(m.u(2), m.v(0));
  return m.with();
}

/// u.v' - v.u' = 4 q0 q3 of the rotation between the frames: no twist about the shafts, so the joint's plane halves their angle.
Joint constant_velocity(const JointPlace& j, const Config& q) {
  JointMaker m(j, q);
  m.same_point();
  const int u0 = m.u(0), v1 = m.v(1), u1 = m.u(1), v0 = m.v(0);
  const int twist = m.zero({{Term::dot, u0, v1}, {Term::dot, u1, v0, 0, -1}});
  if (j.gives_way) {  // tan(twist) is their difference over u.u' + v.v'
    m.c.add_measure({{Term::dot, u0, v0}, {Term::dot, u1, v1}});
    m.soften(twist, {{{1, twist, SumRows::angle}}});
  }
  return m.with();
}

Joint planar(const JointPlace& j, const Config& q) {
  JointMaker m(j, q);
  m.slide(2), m.parallel();
  return m.with();
}

Joint in_plane(const JointPlace& j, const Config& q) {
  JointMaker m(j, q);
  m.slide(2);
  return m.with();
}

Joint in_line(const JointPlace& j, const Config& q) {
  JointMaker m(j, q);
  m.slide(0), m.slide(1);
  return m.with();
}

Joint point_on_curve(const JointPlace& j, const Config& q) {
  JointMaker m(j, q);
  m.slide(0), m.slide(1), m.slide(2);
  m.c.rows = std::make_unique<CurveRows>(*j.curve);
  return m.with();
}

Joint cylindrical(const JointPlace& j, const Config& q) {
  JointMaker m(j, q);
  m.slide(0), m.slide(1), m.parallel();
  return m.with();
}

Joint prismatic(const JointPlace& j, const Config& q) {
  JointMaker m(j, q);
  m.slide(0), m.slide(1);
  m.aligned();
  return m.with();
}

Joint screw(const JointPlace& j, const Config& q) {
  JointMaker m(j, q);
  m.slide(0), m.slide(1), m.parallel();
  const int plain = static_cast<int>(m.c.measures.size()), slid = m.slid(), turned = m.turned();
  return m.with({{{1, slid}, {-j.ratio, turned, SumRows::angle}}}, plain);
}

Joint distance(const JointPlace& j, const Config& q) {
  JointMaker m(j, q);
  const int pa = m.pa(), pb = m.pb();
  m.zero({{Term::distance2, pa, pb}});
  if (j.length > 0) m.c.measures.back().offset = j.length * j.length;
  return m.with();
}

Joint gear(const JointPlace& j, const Config& q) {
  JointMaker m(j, q);
  m.c.n_ends = 3, m.c.end[2] = j.carrier;
  const int turn_a = m.angle(2, 0, m.axis, j.frame.col(0)), turn_b = m.angle(2, 1, m.axis_b, frame_of_axis(m.axis_b).col(0));
  return m.with({{{1, turn_b, SumRows::angle}, {-j.ratio, turn_a, SumRows::angle}}}, 0);
}

Joint rack(const JointPlace& j, const Config& q) {
  JointMaker m(j, q);
  m.c.n_ends = 3, m.c.end[2] = j.carrier;
  const int turn_a = m.angle(2, 0, m.axis, j.frame.col(0));
  const int along = m.c.add_direction(2, q, m.axis_b), from = m.c.add_point(2, q, j.at), to = m.c.add_point(1, q, j.at);
  const int slide = m.zero({{Term::slide, along, from, to}});
  return m.with({{{1, slide}, {-j.ratio, turn_a, SumRows::angle}}}, 0);
}

/// One row, linear in positions: factors times displacements along fixed axes sum to zero.
Joint weighted_sum(const JointPlace& j, const Config& q) {
  JointMaker m(j, q);
  constexpr int origin = -1;
  const auto term = [&](int end, const Vec3& at, size_t k) {
    const double* own = j.own.data() + 4 * k;  // factor and axis
    return Term{Term::coordinate, origin, m.c.add_point(end, q, at), 0, own[0], Vec3(own[1], own[2], own[3])};
  };
  std::vector<Term> terms{term(0, j.at, 0), term(1, j.at_b, 1)};
  if (j.own.size() > 8) {
    m.c.n_ends = 3, m.c.end[2] = j.carrier;
    terms.push_back(term(2, Vec3(j.own[12], j.own[13], j.own[14]), 2));
  }
  m.zero(std::move(terms));
  return m.with();
}

void soften_distance(Joint& joint, std::vector<double>& free) {
  free = {std::sqrt(joint.measures[0].offset)};
  joint.measures[0].offset = 0;
  joint.rows = std::make_unique<Length>();
}

// What kinds read from their entries besides.

void read_axis_b(const EntryValues& e, JointPlace& j) {
  if (e.has("axis_b")) j.axis_b = direction(e, "axis_b");
}

void read_pitch(const EntryValues& e, JointPlace& j) { j.ratio = e.number("pitch") / (2 * std::numbers::pi); }

void read_gear(const EntryValues& e, JointPlace& j) { read_axis_b(e, j), j.ratio = e.number("ratio"); }

void read_rack(const EntryValues& e, JointPlace& j) { j.axis_b = direction(e, "direction"), j.ratio = e.number("radius"); }

void read_distance(const EntryValues& e, JointPlace& j) {
  j.at = e.vector3("at_a"), j.at_b = e.vector3("at_b");
  if (!((j.at - j.at_b).norm() > 0)) e.refuse("at_b", "the two points coincide", "a spherical joint holds them together");
  if (e.has("length")) j.length = e.number("length");
}

void read_weighted_sum(const EntryValues& e, JointPlace& j) {
  j.at = e.vector3("at_a"), j.at_b = e.vector3("at_b");
  std::vector<double> factors = e.numbers("factors");
  const bool third = e.has("carrier");
  for (const char* key : {"at_carrier", "axis_carrier", "factor_carrier"})
    if (!third && e.given(key)) e.refuse(key, "there is no carrier", "leave it out, or name the third end");
  if (third) factors.push_back(e.number("factor_carrier"));
  size_t k = 0;
  for (const char* key : {"axis_a", "axis_b", "axis_carrier"}) {
    if (k == factors.size()) break;
    if (factors[k] == 0) e.refuse(k < 2 ? "factors" : "factor_carrier", "a factor of zero", "leave that end out");
    const Vec3 axis = direction(e, key);
    j.own.insert(j.own.end(), {factors[k++], axis[0], axis[1], axis[2]});
  }
  const Vec3 at = third && e.has("at_carrier") ? e.vector3("at_carrier") : Vec3(Vec3::Zero());
  if (third) j.own.insert(j.own.end(), {at[0], at[1], at[2]});
}

using enum Type;

constexpr Param angle_key{"angle", number, "rad", "", "drives the joint: angle of b about the axis at history 1"},
    spin{"spin", number, "rad/s", "", "drives the joint: rate of the angle at history 1, integrated from t = 0"},
    displacement{"displacement", number, "m", "", "drives the joint: slide of b along the axis at history 1"},
    velocity{"velocity", number, "m/s", "", "drives the joint: rate of the slide at history 1, integrated from t = 0"},
    drive_history{"history", Type::history, "1", "1",
                  "course of what drives the joint: interpolation = \"smooth\" for a few points, \"spline\" for many"},
    third_end{"carrier", text, "", "ground", "what carries both axes: a rigid region, a body, a set, or ground"};

constexpr Param cross_a{"axis", vector3, "1", "!",
                        "arm of the cross that turns in a, at a right angle to the shaft of a; inertial axes at the start, of any length"},
    cross_b{"x", vector3, "1", "!",
            "arm of the cross that turns in b, made normal to `axis`: the vector product of `axis` and the shaft of b"},
    shaft_a{"axis", vector3, "1", "!", "shaft of a, and of b without `axis_b`; inertial axes at the start, of any length"};

constexpr Param stiffness{
    "stiffness", numbers, "N/m", "", "makes the joint give way: along x, y and axis of its frame, or one number for all",
    at_least(0), {1, 3}},
    angular_stiffness{
        "angular_stiffness",
        numbers,
        "N m/rad",
        "",
        "the same about x, y and axis: moment per angle; of three the rotation vector, to half a turn, of two the tilt of the axis",
        at_least(0),
        {1, 3}},
    damping{"damping", numbers, "N s/m", "", "dampers beside these springs", at_least(0), {1, 3}},
    angular_damping{"angular_damping", numbers, "N m s/rad", "", "dampers beside these springs", at_least(0), {1, 3}};

}  // namespace

std::vector<Param> joint_keys(bool with_axis, std::initializer_list<Param> own) {
  std::vector<Param> out{keys::at};
  if (with_axis) out.push_back(keys::axis), out.push_back(keys::x_axis);
  out.insert(out.end(), own);
  return out;
}

std::vector<Param> giving_way(std::vector<Param> keys) {
  keys.insert(keys.end(), {stiffness, angular_stiffness, damping, angular_damping});
  return keys;
}

std::vector<Param> giving_way_along(std::vector<Param> keys) {
  keys.insert(keys.end(), {stiffness, damping});
  return keys;
}

std::vector<Param> giving_way_about(std::vector<Param> keys) {
  keys.insert(keys.end(), {angular_stiffness, angular_damping});
  return keys;
}

Registry<JointKind>& joint_kinds() {
  static constexpr auto angle = Freedom::angle, slide = Freedom::slide;
  static Registry<JointKind> kinds = [] {
    using enum JointKind::Turns;
    Registry<JointKind> all{
        "joint",
        {
            {"fixed", "no relative motion (6 rows)", giving_way(joint_keys(false)), fixed, "xyzABC", {}, {}},
            {"spherical", "common point (3 rows)", giving_way_along(joint_keys(false)), spherical, "xyz", {}, {0, 1, 2}, none},
            {"revolute",
             "common point and axis: one rotation (5 rows)",
             giving_way(joint_keys(true, {angle_key, spin, drive_history})),
             revolute,
             "xyzBA",
             {angle},
             {0, 1, 2}},
            {"cylindrical",
             "common axis: one rotation, one slide (4 rows)",
             giving_way(joint_keys(true, {angle_key, spin, displacement, velocity, drive_history})),
             cylindrical,
             "xyBA",
             {angle, slide},
             {0, 1}},
            {"prismatic",
             "slide along the axis (5 rows)",
             giving_way(joint_keys(true, {displacement, velocity, drive_history})),
             prismatic,
             "xyABC",
             {slide},
             {0, 1}},
            {"universal",
             "common point; the cross has an arm along `axis` in a and one along `x` in b, which stay at a right angle (4 rows)",
             giving_way({keys::at, cross_a, cross_b}),
             universal,
             "xyzB",
             {},
             {}},
            {"constant-velocity",
             "common point, shafts of a and b turn by the same angle at any bend, whatever `x` is (4 rows)",
             giving_way({keys::at, shaft_a, keys::x_axis, {"axis_b", vector3, "1", "", "shaft of b where it is bent at the start"}}),
             constant_velocity,
             "xyzC",
             {},
             {},
             both,
             read_axis_b},
            {"screw",
             "common axis, b slides by the pitch per turn (5 rows)",
             giving_way(
                 joint_keys(true, {{"pitch", number, "m", "!", "slide of b along the axis per turn of b about it; negative: left-handed"},
                                   angle_key,
                                   spin,
                                   displacement,
                                   velocity,
                                   drive_history})),
             screw,
             "xyBAz",
             {angle, slide},
             {0, 1, 4},
             both,
             read_pitch},
            {"planar",
             "b moves in a plane of a and turns about its normal, the axis (3 rows)",
             giving_way(joint_keys(true)),
             planar,
             "zBA",
             {angle},
             {}},
            {"in-plane",
             "a point of b stays in a plane of a with the normal `axis` (1 row)",
             giving_way_along(joint_keys(true)),
             in_plane,
             "z",
             {},
             {},
             first},
            {"in-line",
             "a point of b stays on a line of a along `axis` (2 rows)",
             giving_way_along(joint_keys(true)),
             in_line,
             "xy",
             {slide},
             {},
             first},
            {"gear",
             "angles of a and b about axes of a carrier stay in a ratio; bearings are joints of their own (1 row, a moment on b)",
             giving_way_about(
                 joint_keys(true, {{"axis_b", vector3, "1", "", "axis of b where it differs from that of a"},
                                   {"ratio", number, "1", "!", "turns of b per turn of a; negative when they turn against each other"},
                                   third_end})),
             gear,
             "C",
             {},
             {},
             both,
             read_gear},
            {"rack",
             "slide of b goes with the angle of a, the pinion; bearings and guides are joints of their own (1 row, a force on b, whose "
             "opposite acts on the carrier)",
             giving_way_along(joint_keys(true, {{"direction", vector3, "1", "!",
                                                 "direction in the carrier along which b moves when a turns positively about `axis`"},
                                                {"radius", number, "m", "!", "pitch radius: slide per angle", above(0)},
                                                third_end})),
             rack,
             "z",
             {},
             {},
             both,
             read_rack},
            {"point-on-curve",
             "a point of b stays on a smooth curve carried by a, a cubic spline through points (2 rows)",
             giving_way_along(
                 joint_keys(false, {{"points", numbers, "m", "", "points of the curve, [[x, y, z], ...], reference coordinates"},
                                    {"file", text, "", "", "CSV file of the points instead: a header line and three columns x, y, z"},
                                    {"closed", boolean, "", "false",
                                     "the curve returns from its last point to the first; off the end of an open one the run stops"}})),
             point_on_curve,
             "xx",
             {},
             {},
             first,
             nullptr,
             nullptr,
             true},
            {"weighted-sum",
             "factors times displacements of points of a, b and a third end, each along an inertial axis, sum to zero: blocks and tackles, "
             "*EQUATION (1 row)",
             {keys::at_a,
              keys::at_b,
              {"at_carrier", vector3, "m", "", "point on the carrier"},
              {"factors", numbers, "1", "!", "of a and of b", any_number, {2}},
              {"factor_carrier", number, "1", "1", "of the carrier"},
              {"axis_a", vector3, "1", "[0, 0, 1]", "axis of the displacement of a"},
              {"axis_b", vector3, "1", "[0, 0, 1]", "of b"},
              {"axis_carrier", vector3, "1", "[0, 0, 1]", "of the carrier"},
              {"carrier", text, "", "", "third end: a rigid region, a body, or a set"}},
             weighted_sum,
             "",
             {},
             {},
             none,
             read_weighted_sum},
            {"distance",
             "constant distance of two points (1 row)",
             giving_way_along(
                 {keys::at_a, keys::at_b, {"length", number, "m", "", "distance held; that of the two points when absent", above(0)}}),
             distance,
             "z",
             {},
             {},
             none,
             read_distance,
             soften_distance},
        }};
    for (const JointKind& kind : rolling_kinds()) all.add(kind);
    return all;
  }();
  return kinds;
}

}  // namespace hilo
