// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/contact/obstacle_kinds.hpp"

#include "base/keys.hpp"
#include "physics/axes.hpp"
#include "physics/contact/point_contact.hpp"

namespace hilo {
namespace {

using enum Type;

const Param at{"at", vector3, "m", "[0, 0, 0]", "its centre, reference coordinates"};
const Param axis{"axis", vector3, "1", "[0, 0, 1]", "its axis, reference coordinates; need not be of unit length"};
const Param radius{"radius", number, "m", "!", "radius", above(0)};

Param within(std::string_view meaning) { return {"inside", boolean, "", "false", meaning}; }

Obstacle along_axis(const EntryValues& e, Distance::Kind kind) {
  Obstacle out;
  out.shape.kind = kind;
  out.at = e.vector3("at"), out.axes = frame_of_axis(direction(e, "axis"));
  return out;
}

Obstacle plane(const EntryValues& e) { return along_axis(e, Distance::Kind::plane); }
Obstacle sphere(const EntryValues& e) {
  Obstacle out;
  out.shape.kind = Distance::Kind::sphere;
  out.shape.radius = e.number("radius"), out.shape.inside = e.boolean("inside"), out.at = e.vector3("at");
  return out;
}
Obstacle cylinder(const EntryValues& e) {
  Obstacle out = along_axis(e, Distance::Kind::cylinder);
  out.shape.radius = e.number("radius"), out.shape.half_length = e.has("length") ? e.number("length") / 2 : 0;
  out.shape.inside = e.boolean("inside");
  return out;
}
Obstacle capsule(const EntryValues& e) {
  Obstacle out = along_axis(e, Distance::Kind::capsule);
  out.shape.radius = e.number("radius"), out.shape.half_length = e.number("length") / 2;
  return out;
}
Obstacle torus(const EntryValues& e) {
  Obstacle out = along_axis(e, Distance::Kind::torus);
  out.shape.radius = e.number("radius"), out.shape.tube = e.number("tube");
  if (out.shape.tube >= out.shape.radius) e.refuse("tube", "the tube is as large as the ring: there is no hole");
  return out;
}
Obstacle height_field(const EntryValues& e) {  // its heights are in a file, which who knows files reads
  Obstacle out = along_axis(e, Distance::Kind::height_field);
  out.axes = frame_of_axis(direction(e, "axis"), direction(e, "x"));
  return out;
}
Obstacle box(const EntryValues& e) {
  Obstacle out = along_axis(e, Distance::Kind::box);
  out.axes = frame_of_axis(direction(e, "axis"), direction(e, "x"));
  out.shape.half = e.vector3("size") / 2, out.shape.inside = e.boolean("inside");
  if (!(out.shape.half.minCoeff() > 0)) e.refuse("size", "an edge of the box is not above zero");
  return out;
}

}  // namespace

double PointLaw::potential(double gap) const {
  if (gap >= 0) return 0;
  return hertz > 0 ? 0.4 * hertz * gap * gap * std::sqrt(-gap) : k / 2 * gap * gap;
}

Registry<ObstacleKind>& obstacle_kinds() {
  static Registry<ObstacleKind> kinds{
      "obstacle",
      {{"plane",
        "all that lies below a plane: flat ground",
        {{"at", vector3, "m", "[0, 0, 0]", "a point of it"}, {"axis", vector3, "1", "[0, 0, 1]", "its normal, out of the ground"}},
        plane},
       {"sphere", "a ball, or a round bowl", {at, radius, within("what it meets is within the sphere")}, sphere},
       {"cylinder",
        "a round bar, or a bore",
        {at,
         axis,
         radius,
         {"length", number, "m", "", "between its ends; it has none when absent", above(0)},
         within("what it meets is within the cylinder: a bore")},
        cylinder},
       {"capsule",
        "a round bar with half spheres as ends",
        {at, axis, radius, {"length", number, "m", "!", "between the centres of the half spheres", above(0)}},
        capsule},
       {"torus",
        "a ring",
        {at,
         axis,
         {"radius", number, "m", "!", "of the circle in the middle of the tube", above(0)},
         {"tube", number, "m", "!", "radius of the tube", above(0)}},
        torus},
       {"box",
        "a box, or a container",
        {at,
         axis,
         {"x", vector3, "1", "[1, 0, 0]", "its first axis, made normal to `axis`"},
         {"size", vector3, "m", "!", "edges along x, across, and along `axis`"},
         within("what it meets is within the box")},
        box},
       {"height-field",
        "all that lies below heights over a grid: a road, a terrain, a measured surface",
        {{"at", vector3, "m", "[0, 0, 0]", "where x = y = height = 0 of the file lies, reference coordinates"},
         {"axis", vector3, "1", "[0, 0, 1]", "the direction of the heights"},
         {"x", vector3, "1", "[1, 0, 0]", "the direction of x of the file, made normal to `axis`"},
         {"file", text, "", "!",
          "CSV in the length of the scene: a word and the x of the columns, then lines of a y and the heights there; x and y rise; "
          "or a grey PNG image, whose left lowest pixel is x = y = 0"},
         {"size", numbers, "m", "", "of an image: from its first pixel to its last along x and along y", above(0), {2}},
         {"heights", numbers, "m", "", "of an image: of black and of white", any_number, {2}}},
        height_field}}};
  return kinds;
}

std::vector<Param> contact_keys() {
  return {
      keys::name,
      {"a", text, "", "!", "an obstacle; or a region or a set of facets, which meets b; or all: every obstacle and region"},
      {"b", text, "", "!",
       "what meets it: a region, a set of facets, or an obstacle of kind sphere or box on a body; the same name as a: it meets itself; or "
       "all"},
      {"friction", number, "1", "0", "coefficient of friction", from_to(0, 5)},
      {"restitution", number, "1", "1", "speed after an impact, divided by that before it; 1 gives the energy back exactly", from_to(0, 1)},
      {"rest_speed", number, "m/s", "1e-3", "slower impacts lose no smaller part of their speed than they would at this one", above(0)},
      {"factor", number, "1", "1",
       "on the stiffness, which is, of a region, E divided by the depth of the cell at the facet; absent in load steps: 100 where a part "
       "bends",
       from_to(1e-3, 1000)},
      {"modulus", number, "Pa", "",
       "E* of the pair, 1/E* = (1 - nu_a^2)/E_a + (1 - nu_b^2)/E_b: of rigid surfaces with `layer`, or of a ball by its curvature (Hertz)",
       above(0)},
      {"layer", number, "m", "", "depth of the elastic layer on a rigid surface, which is `modulus` stiff", above(0)},
      {"stiffness", number, "N/m", "", "of each point of a body: of a ball instead of `modulus`, of the corners of a box", above(0)}};
}

}  // namespace hilo
