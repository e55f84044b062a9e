// SPDX-License-Identifier: GPL-3.0-or-later
// [[joint]] entries to connectors with multiplier rows.
#include "system/joints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "system/build/builder.hpp"
#include "system/springs.hpp"

namespace hilo {
namespace {

/// The key that drives the joint, if any: angle or spin, displacement or velocity, each times the history.
std::string driving_key(const Entry& e) {
  std::string found;
  for (const char* key : {"angle", "spin", "displacement", "velocity"}) {
    if (!e.has(key)) continue;
    if (!found.empty())
      throw Error(e.where(key), fmt::format("{}: both {} and {} are prescribed", e.label(), found, key), "one of them drives the joint");
    found = key;
  }
  if (found.empty() && e.given("history"))
    throw Error(e.where("history"), e.label() + ": a history without anything that follows it",
                "give an angle, spin, displacement or velocity");
  return found;
}

/// The curve of a joint, from its point at the start.
std::shared_ptr<const Curve> curve(const Entry& e, const Scene& scene, const Vec3& at) {
  const bool from_file = e.has("file"), closed = e.boolean("closed");
  if (from_file == e.has("points"))
    throw Error(e.where("points"), fmt::format("{}: {}", e.label(), from_file ? "both points and a file" : "neither points nor a file"),
                "points = [[x, y, z], ...] or file = \"curve.csv\"");
  std::vector<Vec3> points;
  if (from_file) {
    const std::filesystem::path file = e.text("file");
    points = read_points_csv((scene.folder == "." ? file : scene.folder / file).string(), e.where("file"));
    for (Vec3& x : points) x *= to_si("m", scene.units);
  } else {
    const auto& flat = e.numbers("points");
    if (flat.size() % 3 != 0) throw Error(e.where("points"), e.label() + ": points are not rows of three numbers");
    for (size_t i = 0; i < flat.size(); i += 3) points.emplace_back(flat[i], flat[i + 1], flat[i + 2]);
  }
  const char* key = from_file ? "file" : "points";
  if (closed && points.size() > 1 && points.front() == points.back()) points.pop_back();
  if (points.size() < (closed ? 3 : 2))
    throw Error(e.where(key), fmt::format("{}: {} points do not make a curve", e.label(), points.size()),
                closed ? "at least three" : "at least two");
  for (size_t i = 1; i < points.size(); ++i)
    if (points[i] == points[i - 1]) throw Error(e.where(key), fmt::format("{}: points {} and {} are the same", e.label(), i, i + 1));
  for (Vec3& x : points) x -= at;
  return std::make_shared<Curve>(std::move(points), closed);
}

/// One number for all, or three along or about x, y and axis of the joint frame.
Vec3 triple(const Entry& e, std::string_view key) {
  if (!e.has(key)) return Vec3::Zero();
  const std::vector<double>& v = e.numbers(key);
  return v.size() == 1 ? Vec3::Constant(v[0]) : Vec3(v[0], v[1], v[2]);
}

/// Of three numbers, one in a direction that the joint leaves free acts on nothing.
void warn_of_idle_springs(const Entry& e, const JointKind& kind) {
  constexpr std::array<const char*, 3> name{"x", "y", "its axis"};
  for (const auto& [key, rows] :
       {std::pair("stiffness", "xyz"), {"damping", "xyz"}, {"angular_stiffness", "ABC"}, {"angular_damping", "ABC"}}) {
    if (!e.has(key) || e.numbers(key).size() < 3) continue;
    for (size_t i = 0; i < 3; ++i)
      if (e.numbers(key)[i] != 0 && kind.holds.find(rows[i]) == kind.holds.npos)
        warn(e.where(key),
             fmt::format("{}: a joint of kind {} is free {} {}, so its {} there acts on nothing; a [[spring]] beside it would", e.label(),
                         kind.name, rows[0] == 'x' ? "along" : "about", name[i], key));
  }
}

Spring compliant(const Entry& e, const JointPlace& j, const Config& q) {
  const Stiffness s{.along = triple(e, "stiffness"),
                    .damping = triple(e, "damping"),
                    .about = triple(e, "angular_stiffness"),
                    .angular_damping = triple(e, "angular_damping")};
  if (const std::string key = missing_stiffness(joint_kinds().at(j.kind), s); !key.empty())
    throw Error(e.has(key) ? e.where(key) : e.place.text(),
                fmt::format("{}: {} leaves a row of the joint without a spring", e.label(), key),
                fmt::format("give {} along every row, or leave all stiffnesses out", key));
  warn_of_idle_springs(e, joint_kinds().at(j.kind));
  Spring c = make_compliant(j, s, q);
  c.name = e.name;
  return c;
}

}  // namespace

void Builder::add_joints() {
  for (const Entry& e : scene_.entries("joint")) {
    const JointKind& kind = joint_kinds().at(e.kind, e.place.text());
    JointPlace j;
    j.kind = e.kind;
    j.a = carrier(e, "a", kind.turns != JointKind::Turns::none), j.b = carrier(e, "b", kind.turns == JointKind::Turns::both);
    if (e.has("carrier")) j.carrier = carrier(e, "carrier", kind.turns != JointKind::Turns::none);
    const auto different = [&](const Carrier& one, const Carrier& other, const char* key, const char* other_key) {
      if (one.body != other.body || one.node != other.node) return;
      e.refuse(key, fmt::format("{} and {} are the same body", other_key, key),
               one.body > 0
                   ? fmt::format("\"{}\" and \"{}\" are one rigid body, {}", e.text(other_key), e.text(key), out_->bodies[one.body].name)
                   : "");
    };
    different(j.b, j.a, "b", "a");
    if (e.has("carrier")) different(j.carrier, j.a, "carrier", "a"), different(j.carrier, j.b, "carrier", "b");
    if (e.has("at")) j.at = j.at_b = e.vector3("at");
    j.frame = joint_frame(e);
    if (kind.read) kind.read(e, j);
    for (const Carrier* end : {&j.a, &j.b})
      if (end->node >= 0 && (out_->X[end->node] - (end == &j.a ? j.at : j.at_b)).norm() > 1e-6 * out_->length)
        e.refuse(end == &j.a ? "a" : "b", "the node is not at the joint point");
    if (kind.follows_curve) j.curve = curve(e, scene_, j.at);
    const std::string driven = driving_key(e);
    if (e.has("stiffness") || e.has("angular_stiffness")) {
      if (!driven.empty()) e.refuse(driven, "a joint that gives way cannot be driven", "put a motor or a rigid joint");
      if (e.given("reactions")) e.refuse("reactions", "a joint that gives way tells its force in its frame", "leave it out");
      out_->part<Springs>().list.push_back(compliant(e, j, out_->start));
      continue;
    }
    for (const char* key : {"damping", "angular_damping"})
      if (e.has(key)) e.refuse(key, fmt::format("{} without a stiffness", key), "rigid rows do not move");
    const bool is_rate = driven == "spin" || driven == "velocity";
    if (!driven.empty()) j.driven = driven == "angle" || driven == "spin" ? JointPlace::Driven::angle : JointPlace::Driven::slide;
    Joint c = make_joint(j, out_->start);
    c.name = e.name;
    if (!driven.empty()) {
      c.drive.law = MotionLaw(e.number(driven), is_rate, use_history(e, is_rate ? Acts::as_rate : Acts::as_position), !e.given("history"));
      c.drive.unit = j.driven == JointPlace::Driven::angle ? "rad/s" : "m/s";
    }
    auto& joints = out_->part<Joints>();
    if (const std::string& axes = e.text("reactions"); axes != "a") {
      Joints::Axes told;
      if (axes == "b") {
        told.body = c.end[1].body;
        told.in = j.frame;
        if (told.body >= 0) told.in = out_->start.R[told.body].transpose() * j.frame;
      } else if (const Found found = find(axes, e.where("reactions")); found.body < 0) {
        e.refuse("reactions", fmt::format("\"{}\" has no axes that turn with it", axes), "a, b, ground, a body or a rigid region");
      } else {
        told.body = found.body;
      }
      joints.told_in[joints.list.size()] = told;
    }
    joints.list.push_back(std::move(c));
  }
}

void Builder::add_bond(int axes, int body, const Vec3& at) {
  Joint bond = make_joint({.kind = "fixed", .a = {axes, -1}, .b = {body, -1}, .at = at, .at_b = at}, out_->start);
  bond.name = fmt::format("{} and {}", out_->bodies[axes].name, out_->bodies[body].name);
  auto& joints = out_->part<Joints>();
  joints.list.push_back(std::move(bond)), ++joints.n_bonds;
}

}  // namespace hilo
