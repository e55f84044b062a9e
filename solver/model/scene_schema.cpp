// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene may say: the table behind the checks, --explain and docs/format.md.
#include "base/keys.hpp"
#include "model/quantity_schema.hpp"
#include "model/scene.hpp"
#include "model/time_schema.hpp"
#include "physics/beam_section.hpp"
#include "physics/contact/obstacle_kinds.hpp"
#include "physics/material/materials.hpp"
#include "physics/spring_kinds.hpp"

namespace hilo {
namespace {

using enum Type;
using keys::at, keys::axis, keys::name;

/// "a, b or c".
std::string any_of(const std::vector<std::string>& words) {
  std::string out;
  for (size_t k = 0; k < words.size(); ++k) out += (k == 0 ? "" : k + 1 < words.size() ? ", " : " or ") + words[k];
  return out;
}

std::vector<KindSchema> make_schema() {
  std::vector<KindSchema> s;
  s.push_back({"scene",
               "",
               "keys at the top of the file",
               {{"title", text, "", "", "one line, shown in pictures"},
                {"units", text, "", "m-kg-s", "system of the numbers in this file: m-kg-s, mm-t-s, mm-kg-ms, in-lbf-s, ft-lbf-s"},
                {"mesh", text, "", "", "mesh.h5, tags.h5 or parts-N.h5; the command line overrides it"},
                {"gravity", vector3, "m/s^2", "[0, 0, 0]", "acceleration of free fall"}}});
  std::vector<std::string> laws;
  for (const MaterialKind& m : material_kinds()) laws.emplace_back(m.name);
  static const std::string material_words = any_of(laws);
  for (const MaterialKind& m : material_kinds()) {
    KindSchema rows{"material", m.name, m.meaning, {{"kind", text, "", s.back().section == "material" ? "!" : m.name, material_words}}};
    rows.params.insert(rows.params.end(), m.keys.begin(), m.keys.end());
    rows.params.push_back({"density", number, "kg/m^3", "", "reference density", above(0)});
    s.push_back(std::move(rows));
  }
  material_kinds().close();
  s.push_back(
      {"region",
       "",
       "material of a region; the name may be a glob (quoted), the last match wins",
       {{"material", text, "", "", "a name of [material.NAME]; absent: what the deck carries"},
        {"mass", number, "kg", "", "scales the density so that the region has this mass", above(0)},
        {"area", number, "m^2", "", "cross-section of bar cells", above(0)},
        {"damping", number, "s", "0", "stiffness-proportional damping beta: S += beta C dE/dt; nothing where a region is rigid",
         at_least(0)},
        {"mass_damping", number, "1/s", "0", "mass-proportional damping alpha, of every fidelity (brakes rigid motion too)", at_least(0)},
        {"modes", number, "", "40",
         "vibration modes of a linear region, at most; static ones are there besides. By default fewer where all could not stiffen",
         at_least(0)},
        {"up_to", number, "Hz", "", "vibration modes up to this frequency, but at least four; absent: 0.1 divided by the step", above(0)},
        {"interface", texts, "", "",
         "sets of facets of a linear region whose nodes have modes of their own, besides up to 66 that contacts may touch; \"none\": none"},
        {"shapes", text, "", "",
         "CSV of the modes of a linear region, in place of those that hilo finds: node, then x, y, z of each shape [length]"},
        {"shell", boolean, "", "false", "its hex8 cells, in one or more layers, are solid-shells: thin plates and walls that do not lock"},
        {"stiffening", boolean, "", "false", "strains of the second degree in the modes: spins and bending that stiffen or shorten"},
        {"modal_damping", number, "1", "0",
         "ratio to the critical damping of the modes of linear regions, as these are held at the start of the run", at_least(0)}}});
  const Param set_kind{"kind", text, "", "!", "the kind of place"};
  const Param of{"of", texts, "", "[\"*\"]", "regions whose nodes may belong to it, names or globs"};
  s.push_back({"set",
               "ball",
               "nodes within a distance of a point, and the outer facets between them",
               {set_kind, of, {"at", vector3, "m", "!", "the point"}, {"radius", number, "m", "!", "the distance", above(0)}}});
  s.push_back({"set",
               "cylinder",
               "nodes on a cylinder, as of a bore or a pin, and the outer facets between them",
               {set_kind,
                of,
                {"at", vector3, "m", "!", "a point of its axis, the middle where it has a length"},
                {"axis", vector3, "", "!", "direction of its axis"},
                {"radius", number, "m", "!", "its radius", above(0)},
                {"length", number, "m", "", "along the axis, half of it to both sides; absent: as far as there are nodes", above(0)},
                {"tolerance", number, "m", "", "off the radius; absent: a fiftieth of it", above(0)}}});
  s.push_back({"set",
               "plane",
               "nodes on a plane, and the outer facets between them",
               {set_kind,
                of,
                {"at", vector3, "m", "!", "a point of it"},
                {"axis", vector3, "", "!", "its normal"},
                {"radius", number, "m", "", "how far from the point; absent: all of the plane", above(0)},
                {"tolerance", number, "m", "", "off the plane; absent: 1e-6 of the scene's diagonal", above(0)}}});
  s.push_back(
      {"set",
       "near",
       "the smooth face that a point lies on: its facets, up to where they meet at an edge, and their nodes",
       {set_kind,
        of,
        {"at", vector3, "m", "!", "a point of it, amid rather than on its border (hilo-post mesh --faces lists one of each)"},
        {"angle", number, "rad", "0.7", "facets that turn by more than this meet at an edge", between(0, 3.2)},
        {"tolerance", number, "m", "", "how far off the face the point may be; absent: a hundredth of the scene's diagonal", above(0)}}});
  s.push_back({"set",
               "box",
               "nodes in a box along the axes, and the outer facets between them",
               {set_kind, of, {"low", vector3, "m", "!", "a corner"}, {"high", vector3, "m", "!", "the opposite corner"}}});
  for (const SectionKind& k : section_kinds()) {
    KindSchema rows{"section", k.name, k.meaning, {{"kind", text, "", "!", "the kind of section"}}};
    rows.params.insert(rows.params.end(), k.keys.begin(), k.keys.end());
    if (k.area || k.meshed)
      rows.params.push_back({"shear",
                             numbers,
                             "1",
                             "",
                             k.meshed ? "factors of shear along 1 and 2; absent: those of the face"
                                      : "factors of shear along 1 and 2; absent: Cowper's, of kind general 1",
                             above(0),
                             {1, 2}});
    s.push_back(std::move(rows));
  }
  section_kinds().close();
  s.push_back(
      {"beam",
       "",
       "a beam of linear elastic material: its sections are bodies called NAME.0, NAME.1 ... NAME.end, but for those that `a` and "
       "`b` name",
       {{"points", numbers, "m", "!", "of its axis, [[x, y, z], ...]: legs meet at them; equal first and last ones close it"},
        {"path", text, "", "line", "between the points: line, or arc: circles through three, each beginning where one ends"},
        {"cells", numbers, "1", "[8]", "of each leg; a list of one number is for all of them", at_least(1)},
        {"section", text, "", "!", "a name of [section.NAME]"},
        {"section_end", text, "", "", "where the beam ends, of the same kind: its sizes vary evenly between both"},
        {"material", text, "", "", "a name of [material.NAME], of kind stvk; none where the section is a matrix"},
        {"orientation", vector3, "1", "",
         "direction of axis 2 of the section, made normal to the beam at the start of each leg; absent: z, or y where it runs "
         "along z"},
        {"a", text, "", "", "what the first section rides on, at any distance: a region, body, set, section of a beam, or ground"},
        {"b", text, "", "", "what the last section rides on"},
        {"damping", number, "s", "0", "stiffness-proportional damping beta", at_least(0)},
        {"mass_damping", number, "1/s", "0", "mass-proportional damping alpha (brakes rigid motion too)", at_least(0)},
        {"fidelity", text, "", "nonlinear",
         "nonlinear; linear: beams that hang together by `a` and `b` are mean axes and modes, as linear regions are; rigid: they are one "
         "body, and what they bear is not known"},
        {"modes", number, "", "40", "vibration modes of a linear beam, at most; static ones are there besides", at_least(0)},
        {"up_to", number, "Hz", "", "vibration modes of a linear beam up to this frequency, as of regions", above(0)},
        {"modal_damping", number, "1", "0", "ratio to the critical damping of the modes of a linear beam, as of regions", at_least(0)}}});
  s.push_back({"body",
               "",
               "a rigid body without a mesh",
               {name,
                {"mass", number, "kg", "!", "mass", at_least(0)},
                {"com", vector3, "m", "!", "centre of mass"},
                {"inertia",
                 numbers,
                 "kg m^2",
                 "[0, 0, 0]",
                 "about the centre of mass, inertial axes: Jxx Jyy Jzz [Jxy Jxz Jyz] (tensor entries)",
                 any_number,
                 {3, 6}},
                {"axes", numbers, "1", "", "nine numbers: rows are the body axes in which `inertia` is given", any_number, {9}}}});
  s.push_back(
      {"point_mass",
       "",
       "mass added to a body, to the nodes of a set (shared equally), or to a region (shared as its own mass is)",
       {name,
        {"on", text, "", "!", "region, set or body"},
        {"mass", number, "kg", "!", "total mass added", above(0)},
        {"at", vector3, "m", "", "where on a body or rigid region; its centre, the axis of a beam, or shared by the nodes, when absent"}}});

  const auto with = [](std::vector<Param> keys, const std::vector<Param>& more) {
    keys.insert(keys.end(), more.begin(), more.end());
    return keys;
  };
  const auto kind_of = [](std::string_view meaning) { return Param{"kind", text, "", "!", meaning}; };
  const Param reactions{
      "reactions", text, "", "a",
      "axes of its reaction: a or b (the joint frame, carried by that end), ground (inertial), or a body or rigid region, "
      "whose axes are inertial at the start"};
  for (const JointKind& k : joint_kinds())
    s.push_back(
        {"joint", k.name, k.meaning, with({kind_of("the kind of joint"), name, keys::end_a, keys::end_b}, with(k.keys, {reactions}))});
  for (const SpringKind& k : spring_kinds())
    s.push_back({"spring", k.name, k.meaning, with({kind_of("the kind of spring"), name, keys::end_a, keys::end_b}, k.keys)});
  for (const JointForceKind& k : joint_force_kinds()) {
    std::vector<Param> first{name};
    if (!k.name.empty()) first.insert(first.begin(), kind_of(k.section == "stop" ? "the kind of stop" : "the kind of motor"));
    s.push_back({k.section, k.name, k.meaning, with(std::move(first), k.keys)});
  }
  for (const ObstacleKind& k : obstacle_kinds())
    s.push_back(
        {"obstacle", k.name, k.meaning,
         with({kind_of("the kind of obstacle"), name, {"on", text, "", "ground", "a rigid region, body or set that carries it, or ground"}},
              k.keys)});
  s.push_back({"contact", "", "two parts, or an obstacle and a part, that must not enter each other", contact_keys()});
  s.push_back({"tie",
               "",
               "two surfaces that stay together though their meshes do not match",
               {name,
                {"a", text, "", "!", "a region or set of facets: the stiffer, coarser or rigid side"},
                {"b", text, "", "!", "a region or set of facets: the finer side, whose nodes follow a; rigid where a is not"},
                {"gap", number, "m", "", "largest gap that is closed; absent: a twentieth of a facet of b", above(0)}}});
  obstacle_kinds().close(), joint_kinds().close(), spring_kinds().close(), joint_force_kinds().close();

  const Param on{"on", text, "", "!", "set, region or body it acts on"};
  s.push_back({"load",
               "force",
               "total force on a body's point, shared by the nodes of a set, or by a region as its mass is",
               {kind_of("the kind of load"),
                name,
                on,
                {"force", vector3, "N", "!", "total force, inertial axes"},
                {"at", vector3, "m", "",
                 "point of a body or rigid region it acts at; when absent its centre of mass, of a section of a beam the axis"},
                {"per_node", boolean, "", "false", "the force is that of each node, as in a deck's *CLOAD"},
                keys::history}});
  s.push_back({"load",
               "traction",
               "force per reference area on a facet set, inertial axes",
               {kind_of("the kind of load"), name, on, {"traction", vector3, "Pa", "!", "force per reference area"}, keys::history}});
  s.push_back({"load",
               "pressure",
               "follower pressure on a facet set, positive pushes inwards",
               {kind_of("the kind of load"), name, on, {"pressure", number, "Pa", "!", "pressure"}, keys::history}});
  s.push_back({"load",
               "torque",
               "moment on a body, inertial axes, or along an axis carried by the body",
               {kind_of("the kind of load"),
                name,
                on,
                {"torque", vector3, "N m", "!", "moment"},
                {"follower", boolean, "", "false", "the moment turns with the body"},
                keys::history}});

  s.push_back(
      {"load",
       "line",
       "force per length along a beam, in inertial axes or in those of its sections",
       {kind_of("the kind of load"),
        name,
        {"on", text, "", "!", "beam it acts on, or a glob"},
        {"force_per_length", vector3, "N/m", "!", "force per length of the beam as drawn; where it begins, if it varies"},
        {"force_per_length_end", vector3, "N/m", "", "where it ends, even between; absent: the same all along"},
        {"from", number, "m", "", "distance along the beam as drawn at which it begins, a section; absent: the first point", at_least(0)},
        {"to", number, "m", "", "distance at which it ends, a section; absent: the last point", above(0)},
        {"follower", boolean, "", "false", "along axes 1, 2 and 3 of the sections, with which it turns"},
        keys::history}});

  const Param part{"on", text, "", "!", "region or set of cells it acts on; for an acceleration a body too"};
  s.push_back({"load",
               "acceleration",
               "what gravity is, for a part of the model: mass times this acceleration, inertial axes",
               {kind_of("the kind of load"), name, part, {"acceleration", vector3, "m/s^2", "!", "force per mass"}, keys::history}});
  s.push_back(
      {"load",
       "centrifugal",
       "mass times distance from an axis times the square of a speed, away from the axis, as things are drawn; history times this force",
       {kind_of("the kind of load"),
        name,
        part,
        {"at", vector3, "m", "!", "point of the axis"},
        {"axis", vector3, "1", "!", "axis of the rotation; need not be of unit length"},
        {"speed", number, "rad/s", "!", "speed of the rotation"},
        keys::history}});

  s.push_back({"motion",
               "fixed",
               "holds the nodes of a set, or a body",
               {kind_of("the kind of motion"),
                name,
                on,
                {"components", texts, "", "[\"x\", \"y\", \"z\"]", "which components are held; a body is always held whole"}}});
  s.push_back({"motion",
               "translation",
               "moves a set or body by a displacement times its history",
               {kind_of("the kind of motion"),
                name,
                on,
                {"displacement", vector3, "m", "!", "displacement at history 1"},
                {"components", texts, "", "[\"x\", \"y\", \"z\"]", "which components are prescribed; a body is always moved whole"},
                keys::history}});
  s.push_back({"motion",
               "rotation",
               "turns a set or body about an axis by an angle times its history",
               {kind_of("the kind of motion"), name, on, at, axis, {"angle", number, "rad", "!", "angle at history 1"}, keys::history}});

  s.push_back({"initial",
               "",
               "initial velocity and spin of regions, sets or bodies",
               {{"on", texts, "", "[\"*\"]", "names or globs; later entries override earlier ones"},
                {"velocity", vector3, "m/s", "[0, 0, 0]", "velocity of the reference point"},
                {"spin", vector3, "rad/s", "[0, 0, 0]", "angular velocity"},
                {"about", vector3, "m", "", "reference point of the spin; the centre of mass of what is named when absent"}}});
  s.push_back(
      {"sensor",
       "",
       "accelerometer triad on a set, region or body",
       {name,
        on,
        {"at", vector3, "m", "", "point on a body; mean of the nodes, of a region its centre of mass, of a beam its axis, when absent"},
        {"x", vector3, "1", "[1, 0, 0]", "forward axis at the start (ISO 8855); its part normal to z counts"},
        {"z", vector3, "1", "[0, 0, 1]", "upward axis at the start (ISO 8855)"}}});
  s.push_back({"probe",
               "",
               "position, velocity and acceleration of a point",
               {name,
                on,
                {"at", vector3, "m", "",
                 "point on a body, or nearest node of the set; mean of the nodes, of a region its centre of mass, of a beam its axis, when "
                 "absent"}}});
  for (KindSchema& quantity : quantity_schema()) s.push_back(std::move(quantity));
  s.push_back(
      {"history",
       "",
       "a named factor as a function of time",
       {{"t", numbers, "s", "", "rising times; two equal ones make a jump"},
        {"value", numbers, "", "", "values, in the unit of what the history scales (1 for a factor)"},
        {"file", text, "", "",
         "CSV file with a header line and two columns: t (or time) and a value, in this order where none is named so.  A unit of time in "
         "the header (t [ms]) is converted; one of values must be that of what it scales in units of the scene, or stand beside `scale`"},
        {"scale", number, "1", "1", "factor on the values"},
        {"interpolation", text, "", "linear",
         "linear; smooth (cosine ramps) or smoother (ramps with three continuous derivatives), which stand still at every point and "
         "are for tables of a few: between the points of a dense sine their mean square rate is 23 % too large; spline (cubic, two "
         "continuous derivatives) or monotone (cubic, one, rises only where the table does) for measured and sampled courses"},
        {"ends", text, "", "natural",
         "of a spline: natural (no curvature there), clamped (`slopes`) or periodic (the table is one period, which repeats for ever)"},
        {"slopes", numbers, "1/s", "",
         "of a clamped spline: at the first point and at the last, in values by second; [0, 0] when absent"}}});
  s.push_back(time_schema());
  s.push_back({"solver",
               "",
               "Newton and the linear solver",
               {{"kind", text, "", "auto", "auto, light, direct (PETSc/MUMPS), or of PETSc cg, iterative, bddc, feti-dp"},
                {"tolerance", number, "1", "1e-10",
                 "Newton: residual relative to the forces it sums, and correction relative to the scene's size", from_to(1e-16, 0.1)},
                {"iterations", number, "1", "25", "Newton iterations before the step is cut", from_to(1, 10000)},
                {"cuts", number, "1", "8", "successive halvings of a step before the run stops", from_to(0, 30)},
                {"linear_tolerance", number, "1", "1e-10", "relative residual of an iterative linear solve", from_to(1e-16, 0.1)},
                {"subdomains", number, "1", "1", "bddc, feti-dp: into how many each rank divides its flexible part", from_to(1, 10000)}}});
  s.push_back(
      {"output",
       "",
       "what the results hold",
       {{"interval", number, "s", "", "time between field outputs; every 1/50 of the run when absent", above(0)},
        {"fields", texts, "",
         "[\"displacement\", \"velocity\", \"acceleration\", \"stress\", \"von_mises\", \"stress_error\", \"plastic_strain\", "
         "\"contact_pressure\"]",
         "nodal fields; beside these shell: forces and moments per length, stress and axes of shells"},
        {"nodes", text, "", "all", "whose fields: all, or skin: those on the surface of a region, which pictures without cuts show"},
        {"envelope", boolean, "", "false",
         "the largest von Mises stress, acceleration and displacement of each node over all steps, with their times, at the end of the "
         "run"},
        {"precision", text, "", "double", "double or single"}}});
  for (const OwnSection& own : own_sections()) s.push_back({own.name, "", own.meaning, own.keys});
  own_sections().close();
  s.push_back(
      {"left_out",
       "",
       "what hilo-import did not carry over from a deck: a warning before a run, which is refused where the model would be another one",
       {{"card", text, "", "!", "what the deck says"},
        {"loss", text, "", "other", "what the model lacks by it: load, support, tie, material or other"},
        {"count", number, "", "1", "how often", at_least(1)},
        {"place", text, "", "", "file and line of the first"}}});
  for (const auto& [section, key] : {std::pair{"solver", "kind"}, {"output", "fields"}}) words_of(section, key)->close();
  return s;
}

}  // namespace

Registry<OwnSection>& own_sections() {
  static Registry<OwnSection> sections{"section", {}};
  return sections;
}

const std::vector<KindSchema>& scene_schema() {
  static const std::vector<KindSchema> schema = make_schema();
  return schema;
}

bool is_list_section(std::string_view s) {
  return !is_single_section(s) && s != "material" && s != "region" && s != "section" && s != "beam" && s != "set" && s != "history";
}
bool is_single_section(std::string_view s) { return s == "scene" || s == "time" || s == "solver" || s == "output"; }

}  // namespace hilo
