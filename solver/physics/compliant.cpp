// Joints that give way: the rows of any joint on springs and dampers instead of multipliers.
#include <cmath>
#include <string_view>
#include <utility>

#include "physics/coordinates.hpp"
#include "physics/joint_rows.hpp"

namespace hilo {
namespace {

/// What the rows of a joint hold, in their order: slides along x, y, z of the joint frame and turns A, B, C about them.
std::string_view rows_of(std::string_view kind) {
  constexpr std::pair<std::string_view, std::string_view> table[] = {
      {"fixed", "xyzCAB"}, {"spherical", "xyz"}, {"revolute", "xyzBA"}, {"universal", "xyzB"},   {"constant-velocity", "xyzC"},
      {"planar", "zBA"},   {"in-plane", "z"},    {"in-line", "xy"},     {"cylindrical", "xyBA"}, {"prismatic", "xyBAC"},
      {"screw", "xyBAz"},  {"gear", "C"},        {"rack", "z"},         {"distance", "z"},       {"point-on-curve", "xx"}};
  for (const auto& [name, rows] : table)
    if (name == kind) return rows;
  return {};
}

/// The three rows of a common point along the frame carried by a instead of the inertial axes.
void turn_with_a(Connector& c) {
  if (c.end[0].body < 0) return;
  for (int i = 0; i < 3; ++i) {
    c.entities.push_back({0, c.frame_a.col(i), false});
    const Term& t = c.measures[i].terms[0];
    c.measures[i] = {{{Term::slide, static_cast<int>(c.entities.size()) - 1, t.i, t.j}}, 0};
  }
}

}  // namespace

bool can_be_compliant(std::string_view kind) { return !rows_of(kind).empty(); }

std::string missing_stiffness(std::string_view kind, const Vec3& k, const Vec3& k_angle) {
  for (const char r : rows_of(kind)) {
    if (r >= 'x' && !(k[r - 'x'] > 0)) return "stiffness";
    if (r <= 'C' && !(k_angle[r - 'A'] > 0)) return "angular_stiffness";
  }
  return {};
}

Connector make_compliant(Connector c, const Vec3& k, const Vec3& damping, const Vec3& k_angle, const Vec3& damping_angle) {
  std::vector<double> stiffness, viscosity, free;
  for (const char r : rows_of(c.kind)) {
    stiffness.push_back(r >= 'x' ? k[r - 'x'] : k_angle[r - 'A']);
    viscosity.push_back(r >= 'x' ? damping[r - 'x'] : damping_angle[r - 'A']);
  }
  std::unique_ptr<RowLaw> rows = std::move(c.rows);
  if (rows_of(c.kind).starts_with("xyz")) turn_with_a(c);
  if (c.kind == "constant-velocity")
    rows = std::make_unique<SumRows>(3, std::vector<std::vector<SumRows::Part>>{{{0.5, 3}}});  // row: 2 twist
  if (c.kind == "distance") {
    free = {std::sqrt(c.measures[0].offset)};
    c.measures[0].offset = 0;
    rows = std::make_unique<Length>();
  }
  c.law = make_linear(stiffness, viscosity, free);
  if (rows) c.law = std::make_unique<OnCoordinates>(std::move(rows), std::move(c.law));
  c.section = "joint";
  return c;
}

}  // namespace hilo
