// SPDX-License-Identifier: GPL-3.0-or-later
// CELAS, CDAMP and CBUSH as scene lines: a [[spring]] between bodies, along the line of its grids, or a plane that gives way to a node.
#include <Eigen/Geometry>

#include "base/error.hpp"
#include "import/bdf/scene.hpp"

namespace hilo {
namespace {

/// "CELAS1": the card of its properties, "PELAS".
std::string property_card(std::string name) {
  if (name == "CELAS1" || name == "CDAMP1") name.pop_back();
  name.front() = 'P';
  return name;
}

}  // namespace

void BdfScene::springs() {
  for (const BdfSpring& s : deck_.springs) {
    BdfSpringData p{s.k, s.c};
    if (s.property != 0) {
      const auto at = deck_.spring_data.find({property_card(s.name), s.property});
      if (at == deck_.spring_data.end())
        throw Error(s.place, fmt::format("{} {}: no {} {}", s.name, s.id, property_card(s.name), s.property));
      p = at->second;
    }
    bool nothing = true, negative = false;
    for (size_t i = 0; i < 6; ++i) nothing = nothing && p.k[i] == 0 && p.c[i] == 0, negative = negative || p.k[i] < 0 || p.c[i] < 0;
    if (nothing) continue;
    if (negative) {
      in_.skip(s.name + " below zero", s.place);
      continue;
    }
    bool mean = false;
    for (const auto g : s.grids) mean = mean || (g != 0 && end(row(g, s.place, s.name)) == End::mean);
    if (mean || (s.grids[0] == 0 && s.grids[1] == 0) || s.grids[0] == s.grids[1])
      in_.skip(s.name + " between no two ends", s.place);
    else if (s.component[0] == -1)
      line_spring(s, p.k[0], p.c[0]);
    else if (s.component[0] == 0 && s.component[1] == 0)
      bush(s, p);
    else
      scalar_spring(s, s.name.starts_with("CELAS") ? p.k[0] : 0, s.name.starts_with("CELAS") ? 0 : p.c[0]);
  }
}

/// A plane of a that gives way to a point of b along its normal; a damper alone is a bushing, which bodies have.
void BdfScene::spring_along(const Vec3& axis, const std::string& name, const std::string& a, std::int64_t b, double k, double c,
                            const std::string& place) {
  const Vec3& at = X(b);
  if (k == 0 && end(b) == End::body) {
    scene_.add_unique({"spring", "bushing"}, name, place,
                      {{"a", a}, {"b", end_name(b)}, {"at", point(at)}, {"axis", axis}, {"damping", {0, 0, c * si("N s/m")}}});
    return;
  }
  if (k == 0 && a == "ground") return sliding_spring(axis, name, -1, b, k, c, place);
  if (k == 0) return in_.skip(name.substr(0, name.find('_')) + ": damping without stiffness between a body and a node of solids", place);
  scene_
      .add_unique({"joint", "in-plane"}, name, place,
                  {{"a", a}, {"b", end_name(b)}, {"at", point(at)}, {"axis", axis}, {"stiffness", k * si("N/m")}})
      .set_if(c > 0, "damping", c * si("N s/m"));
}

/// A body of no mass slides along the axis with b, on the ground or on another that slides with a: the force acts along the axis at each
/// grid, wherever they are.
void BdfScene::sliding_spring(const Vec3& axis, const std::string& name, std::int64_t a, std::int64_t b, double k, double c,
                              const std::string& place) {
  const auto slider = [&](const std::string& wish, const std::string& on, std::int64_t grid) {
    const std::string body = massless_body(scene_, scene_.unique("body", wish), point(X(grid)), place);
    scene_.add_unique({"joint", "prismatic"}, body, place, {{"a", on}, {"b", body}, {"at", point(X(grid))}, {"axis", axis}});
    joint_to_slide(scene_, body + "_end", body, end_name(grid), axis, point(X(grid)), place);
    return body;
  };
  const std::string on = a < 0 ? "ground" : slider(name + "_carrier", "ground", a), body = slider(name + "_slide", on, b);
  const Vec3 from = X(b), to = from + 4 * size_ * axis;  // far enough that the distance is the slide and a constant
  axial_spring(name, on, body, from, to, k, c, place);
}

void BdfScene::axial_spring(const std::string& name, const std::string& a, const std::string& b, const Vec3& at_a, const Vec3& at_b,
                            double k, double c, const std::string& place) {
  scene_.add_unique(
      {"spring", "axial"}, name, place,
      {{"a", a}, {"b", b}, {"at_a", point(at_a)}, {"at_b", point(at_b)}, {"stiffness", k * si("N/m")}, {"damping", c * si("N s/m")}});
}

void BdfScene::line_spring(const BdfSpring& s, double k, double c) {
  if (s.grids[0] == 0 || s.grids[1] == 0 || s.system) return in_.skip(s.name + " to the ground, or in a system", s.place);
  const auto a = row(s.grids[0], s.place, s.name), b = row(s.grids[1], s.place, s.name);
  if ((X(b) - X(a)).norm() < 1e-9 * size_) return in_.skip(s.name + " of no length", s.place);
  axial_spring(fmt::format("{}_{}", s.name, s.id), end_name(a), end_name(b), X(a), X(b), k, c, s.place);
}

void BdfScene::scalar_spring(const BdfSpring& s, double k, double c) {
  const std::string name = fmt::format("{}_{}", s.name, s.id);
  std::int64_t a = s.grids[0] ? row(s.grids[0], s.place, s.name) : -1, b = s.grids[1] ? row(s.grids[1], s.place, s.name) : -1;
  int of_a = s.component[0], of_b = s.component[1];
  if (b < 0) std::swap(a, b), std::swap(of_a, of_b);
  if (a >= 0 && end(b) == End::body && end(a) != End::body) std::swap(a, b), std::swap(of_a, of_b);  // a must be able to turn
  const Eigen::Index k_b = (of_b - 1) % 3, k_a = (of_a > 0 ? of_a - 1 : of_b - 1) % 3;
  const Vec3 axis = axes(b).col(k_b), gap = a < 0 ? Vec3::Zero() : Vec3(X(b) - X(a));
  if (a >= 0 && ((of_a > 3) != (of_b > 3) || axes(a).col(k_a).dot(axis) < 1 - 1e-9))
    return in_.skip(s.name + " between different components", s.place);
  if (of_b > 3) {
    if (end(b) != End::body || (a >= 0 && end(a) != End::body))
      return in_.skip(s.name + " on the rotation of a node of solids, which does not turn", s.place);
    scene_.add_unique({"spring", "bushing"}, name, s.place,
                      {{"a", end_name(a)},
                       {"b", end_name(b)},
                       {"at", point(X(b))},
                       {"axis", axis},
                       {"angular_stiffness", {0, 0, k * si("N m/rad")}},
                       {"angular_damping", {0, 0, c * si("N m s/rad")}}});
    return;
  }
  const bool apart = gap.norm() > 1e-9 * size_;
  if (apart && gap.cross(axis).norm() < 1e-9 * gap.norm()) return line_spring(s, k, c);
  if (apart || (a >= 0 && end(a) != End::body)) {
    for (const auto one : {a, b})
      if (one >= 0 && end(one) != End::body && end(one) != End::node) return in_.skip(s.name + " on a grid of no element", s.place);
    return sliding_spring(axis, name, a, b, k, c, s.place);
  }
  spring_along(axis, name, end_name(a), b, k, c, s.place);
}

void BdfScene::bush(const BdfSpring& s, const BdfSpringData& p) {
  const std::string name = fmt::format("{}_{}", s.name, s.id);
  std::int64_t a = s.grids[0] ? row(s.grids[0], s.place, s.name) : -1, b = s.grids[1] ? row(s.grids[1], s.place, s.name) : -1;
  const auto first = a >= 0 ? a : b;
  const Vec3 gap = a < 0 || b < 0 ? Vec3::Zero() : Vec3(X(b) - X(a));
  const bool apart = gap.norm() > 1e-9 * size_;
  bool along = apart;  // nothing but a spring along the line
  for (size_t i = 1; i < 6; ++i) along = along && p.k[i] == 0 && p.c[i] == 0;
  if (along && !s.system) return line_spring(s, p.k[0], p.c[0]);
  Mat3 own;
  if (s.system) {
    own = axes_at(deck_, *s.system, X(first), s.place);
  } else {
    const Vec3 plane = s.towards ? Vec3(X(row(*s.towards, s.place, s.name)) - X(first)) : Vec3(axes(first) * s.plane);
    const Vec3 x = gap.normalized(), z = x.cross(plane);
    if (!apart || !(z.norm() > 1e-9 * plane.norm())) return in_.skip(s.name + " whose axes are not given", s.place);
    own << x, z.normalized().cross(x), z.normalized();
  }
  if (b < 0) std::swap(a, b);
  const auto turns = [&](std::int64_t at) { return at < 0 || end(at) == End::body; };
  if (turns(a) && turns(b)) {
    const Vec3 at = apart ? Vec3(X(a) + s.share * gap) : X(b);
    const auto three = [&](const std::array<double, 6>& v, size_t from, const char* unit) { return Vec3(Vec3(&v[from]) * si(unit)); };
    scene_.add_unique({"spring", "bushing"}, name, s.place,
                      {{"a", end_name(a)},
                       {"b", end_name(b)},
                       {"at", point(at)},
                       {"axis", own.col(2)},
                       {"x", own.col(0)},
                       {"stiffness", three(p.k, 0, "N/m")},
                       {"damping", three(p.c, 0, "N s/m")},
                       {"angular_stiffness", three(p.k, 3, "N m/rad")},
                       {"angular_damping", three(p.c, 3, "N m s/rad")}});
    return;
  }
  if (turns(b)) std::swap(a, b);
  if (apart) return in_.skip(s.name + " with a length at a node of solids, which does not turn", s.place);
  if (!turns(a) && (end(a) != End::node || end(b) != End::node)) return in_.skip(s.name + " on a grid of no element", s.place);
  for (Eigen::Index i = 0; i < 3; ++i)
    if (const double k = p.k[static_cast<size_t>(i)], c = p.c[static_cast<size_t>(i)]; k > 0 || c > 0)
      turns(a) ? spring_along(own.col(i), name, end_name(a), b, k, c, s.place) : sliding_spring(own.col(i), name, a, b, k, c, s.place);
  for (size_t i = 3; i < 6; ++i)
    if (p.k[i] > 0 || p.c[i] > 0) return in_.skip(s.name + " on the rotation of a node of solids, which does not turn", s.place);
}

}  // namespace hilo
