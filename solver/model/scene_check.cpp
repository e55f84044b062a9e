// SPDX-License-Identifier: GPL-3.0-or-later
// Mistakes of a scene that need more than one key to see.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "model/scene_read.hpp"

namespace hilo {
namespace {

[[noreturn]] void fail(const Entry& e, std::string_view key, const std::string& what, const std::string& hint = "") {
  throw Error(e.where(key), e.label() + ": " + what, hint);
}

/// Directions have a length, and a second one is not parallel to the first.
void check_directions(const Entry& e) {
  for (const char* key : {"axis", "x", "z"})
    if (e.has(key) && e.vector3(key).norm() == 0) fail(e, key, fmt::format("{} has length zero", key), "a direction, as in [0, 0, 1]");
  const char* main = e.has("axis") ? "axis" : "z";
  if (!e.has("x") || !e.has(main)) return;
  const Vec3 x = e.vector3("x").normalized(), z = e.vector3(main).normalized();
  if (x.cross(z).norm() < 1e-6) fail(e, "x", fmt::format("x is parallel to {}", main), "x must differ from it in direction");
}

/// The two ends of a joint or spring are two things, and two points where the line between them matters.
void check_ends(const Entry& e) {
  if (e.has("a") && e.text("a") == e.text("b")) fail(e, "b", fmt::format("both ends are \"{}\"", e.text("b")));
  if (e.has("at_a") && e.kind != "weighted-sum" && (e.vector3("at_b") - e.vector3("at_a")).norm() == 0)
    fail(e, "at_b", "at_a and at_b are the same point", "the direction is the line between them");
  if (e.has("preload") && e.number("preload") != 0 && e.number("stiffness") == 0)
    fail(e, "preload", "a preload needs a stiffness", "it is added by shifting the free length");
}

void check_bodies(std::span<const Entry> bodies, std::span<const Entry> regions) {
  std::map<std::string_view, const Entry*> named;
  for (const auto& r : regions) named.emplace(r.name, &r);
  for (const auto& b : bodies) {
    if (b.name == "ground") fail(b, "name", "\"ground\" is the inertial frame", "give the body another name");
    if (const auto r = named.find(b.name); r != named.end())
      fail(b, "name", "a region has the same name", "first at " + r->second->place.text());
    const auto& J = b.numbers("inertia");
    if (std::min({J[0], J[1], J[2]}) < 0) fail(b, "inertia", "a moment of inertia is negative");
    if (!b.has("axes")) continue;
    const Mat3 R = Eigen::Map<const Mat3>(b.numbers("axes").data());
    if ((R.transpose() * R - Mat3::Identity()).norm() > 1e-6) fail(b, "axes", "the rows are not orthogonal unit vectors");
  }
}

/// A run that would not end.
void check_time(const Entry& time) {
  constexpr double most_steps = 1e9;
  if (time.text("analysis") != "dynamic" || !time.has("end") || !time.has("step")) return;
  if (const double n = time.number("end") / time.number("step"); n > most_steps)
    fail(time, "step", fmt::format("{:.3g} steps to the end, at most {:g} are taken", n, most_steps), "a longer step, or an earlier end");
}

}  // namespace

void check_entries(const Entries& entries) {
  const auto of = [&](std::string_view section) {
    const auto e = entries.find(section);
    return e == entries.end() ? std::span<const Entry>{} : std::span<const Entry>(e->second);
  };
  for (const auto& [section, list] : entries)
    for (const auto& e : list) check_directions(e);
  for (const auto* section : {"joint", "spring"})
    for (const auto& e : of(section)) check_ends(e);
  check_bodies(of("body"), of("region"));
  for (const auto& e : of("time")) check_time(e);
  check_quantities(entries);
  std::vector<std::string> materials;
  for (const auto& m : of("material")) materials.push_back(m.name);
  for (const auto& r : of("region")) {
    if (!r.has("material") || std::find(materials.begin(), materials.end(), r.text("material")) != materials.end()) continue;
    std::string hint = suggest(r.text("material"), materials);
    if (hint.empty())
      hint = materials.empty() ? fmt::format("write [material.{}]", r.text("material"))
                               : fmt::format("there are: {}", fmt::join(materials, ", "));
    fail(r, "material", fmt::format("no material \"{}\"", r.text("material")), hint);
  }
}

}  // namespace hilo
