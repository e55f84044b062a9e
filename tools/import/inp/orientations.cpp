// SPDX-License-Identifier: GPL-3.0-or-later
// The axes of materials that differ with direction: as *ORIENTATION of a section says, in shells laid into their surface.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "import/inp/passes.hpp"

namespace hilo {

Mat3 InpOrientation::frame() const {
  Mat3 axes;
  axes.col(0) = a.normalized(), axes.col(2) = a.cross(b).normalized(), axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

namespace {

using Sections = std::vector<const InpSection*>;  // of cells

/// In shells axis 1 lies in the surface, and axis 3 is its normal.  Without an orientation axis 1 is x, or z where the normal is x.  Abaqus
/// and CalculiX agree on that, and on axis 1 of an orientation that turns about its axis 3.
struct ShellAxes {
  Vec3 first = Vec3::Zero(), normal = Vec3::Zero();
  std::string why = {};  // there are none for all shells of the section
};

ShellAxes axes_of_shells(const InpDeck& d, const Mesh& m, const Sections& of, const InpSection& s, const InpOrientation* o) {
  ShellAxes all;
  const Mat3 frame = o ? o->frame() : Mat3(Mat3::Identity());
  const double most = std::cos(0.1 * std::numbers::pi / 180);  // nearer to the normal, axis 1 says nothing
  for (const auto id : d.elset.at(s.elset).members) {
    const auto c = d.cell.find(id);
    if (c == d.cell.end() || of[static_cast<size_t>(c->second)] != &s) continue;
    const ShapeInfo& shape = info(m.shape[static_cast<size_t>(c->second)]);
    if (shape.dimension != 2) continue;
    const auto n = m.cell(c->second);
    const auto x = [&](size_t k) { return m.X[static_cast<size_t>(n[k])]; };
    const Vec3 normal = (shape.n_corners == 3 ? (x(1) - x(0)).cross(x(2) - x(0)) : (x(2) - x(0)).cross(x(3) - x(1))).normalized();
    const double up[2] = {std::abs(normal.dot(frame.col(0))), std::abs(normal.dot(frame.col(2)))};
    if (o && (up[0] > most || (o->about != 3 && up[1] <= up[0]))) {
      all.why = "*ORIENTATION of shells whose normal is not near its axis 3";
      return all;
    }
    const Vec3 along = frame.col(up[0] > most ? 2 : 0);
    const double turn = s.turn * std::numbers::pi / 180;
    const Vec3 flat = (along - normal * normal.dot(along)).normalized();
    const Vec3 first = std::cos(turn) * flat + std::sin(turn) * normal.cross(flat);
    if (all.first == Vec3::Zero()) all.first = first, all.normal = normal;
    if (!(std::abs(first.dot(all.first)) > 1 - 1e-6 && std::abs(normal.dot(all.normal)) > 1 - 1e-6)) {
      all.why = o ? "*ORIENTATION of shells that do not lie in one plane"
                  : "*ELASTIC that differs with direction, of shells that do not lie in one plane";
      return all;
    }
  }
  return all;
}

void set_axes(DeckMaterial& law, const Vec3& a, const Vec3& b) {
  law.set({"axis_1", {a.x(), a.y(), a.z()}, "1", true});
  law.set({"axis_2", {b.x(), b.y(), b.z()}, "1", true});
}

/// The law of a section whose material differs with direction.
void turn(const InpDeck& d, Imported& in, const Sections& of, InpSection& s, DeckMaterial& law, bool thicken) {
  const auto none = [&](const std::string& what, const std::string& place) {
    law.no_law = fmt::format("{}, {}", what, place);
    in.skip(what, place);
  };
  const InpOrientation* o = s.orientation.empty() ? nullptr : &d.orientations.at(s.orientation);
  if (o) {
    s.law += "\n" + s.orientation, law.name += "_" + o->name;
    set_axes(law, o->a, o->b);
    if (!o->not_read.empty()) {
      law.no_law = o->not_read;
      return in.skip(o->not_read, o->place);
    }
  }
  if (!thicken || s.thickness == 0) return;  // solids; a shell that is rigid has no need of axes
  const std::string place = o ? s.orientation_place : s.place;
  const auto own = [&] { s.law += "\n\n" + s.elset, law.name += "_" + s.elset_name; };
  if (s.several_directions) return own(), none(s.card + ", COMPOSITE of several orientations", s.place);
  const ShellAxes axes = axes_of_shells(d, in.mesh, of, s, o);
  if (!axes.why.empty()) return own(), none(axes.why, place);
  const Mat3 frame = o ? o->frame() : Mat3(Mat3::Identity());
  if (std::abs(axes.first.dot(frame.col(0))) > 1 - 1e-12 && std::abs(axes.normal.dot(frame.col(2))) > 1 - 1e-12) return;
  if (axes.first == Vec3::Zero()) return;  // no shells
  own();
  set_axes(law, axes.first, axes.normal.cross(axes.first));
}

}  // namespace

void turn_materials(InpDeck& d, Imported& in, bool thicken) {
  const Sections of = section_of_cells(d);
  for (auto& s : d.sections) {
    DeckMaterial law;  // of a section without a material: none
    if (s.own)
      law = *s.own;
    else if (s.material.empty())
      law.no_law = (s.no_solid.empty() ? s.card + " without MATERIAL" : s.no_solid) + ", " + s.place;
    else
      law = d.materials.at(s.material);
    s.law = s.own ? "\n" + s.elset : s.material;
    if (law.kind == "orthotropic" && law.no_law.empty()) turn(d, in, of, s, law, thicken);
    d.laws.try_emplace(s.law, std::move(law));
  }
}

}  // namespace hilo
