// What a scene may say: the table behind the checks, --explain and docs/format.md.
#include "dynamics/integrators.hpp"
#include "model/scene.hpp"
#include "model/time_schema.hpp"
#include "physics/material/materials.hpp"

namespace hilo {
namespace {

using enum Type;
constexpr Range any = any_number;

constexpr Param name{"name", text, "", "!", "name, unique within the section"};
constexpr Param history_key{"history", history, "1", "1",
                            "factor over time: a name of [history.NAME] or a table {t = [...], value = [...]}"};
constexpr Param end_a{"a", text, "", "ground", "first end: a rigid region, a body, a set, or ground"};
constexpr Param end_b{"b", text, "", "!", "second end: a rigid region, a body, a set, or ground"};
constexpr Param at{"at", vector3, "m", "!", "joint point, reference coordinates"};
constexpr Param axis{"axis", vector3, "1", "!", "joint axis, inertial axes at the start; need not be of unit length"};
constexpr Param x_axis{"x", vector3, "1", "", "first axis of the joint frame, made normal to `axis`"};

std::vector<KindSchema> make() {
  std::vector<KindSchema> s;
  s.push_back({"scene",
               "",
               "keys at the top of the file",
               {{"title", text, "", "", "one line, shown in pictures"},
                {"units", text, "", "m-kg-s", "system of the numbers in this file: m-kg-s, mm-t-s, mm-kg-ms, in-lbf-s, ft-lbf-s"},
                {"mesh", text, "", "", "mesh.h5, tags.h5 or parts-N.h5; the command line overrides it"},
                {"gravity", vector3, "m/s^2", "[0, 0, 0]", "acceleration of free fall"}}});
  static const std::string material_words = [] {
    std::string words;
    const auto& kinds = material_kinds();
    for (size_t k = 0; k < kinds.size(); ++k) words += (k == 0 ? "" : k + 1 < kinds.size() ? ", " : " or ") + std::string(kinds[k].kind);
    return words;
  }();
  for (const MaterialKind& m : material_kinds()) {
    KindSchema rows{"material", m.kind, m.meaning, {{"kind", text, "", s.back().section == "material" ? "!" : m.kind, material_words}}};
    rows.params.insert(rows.params.end(), m.keys.begin(), m.keys.end());
    rows.params.push_back({"density", number, "kg/m^3", "", "reference density", above(0)});
    s.push_back(std::move(rows));
  }
  s.push_back({"region",
               "",
               "material of a region; the name may be a glob (quoted), the last match wins",
               {{"material", text, "", "", "a name of [material.NAME]; absent: what the deck carries"},
                {"mass", number, "kg", "", "scales the density so that the region has this mass", above(0)},
                {"area", number, "m^2", "", "cross-section of bar cells", above(0)},
                {"damping", number, "s", "0", "stiffness-proportional damping beta: S += beta C dE/dt", at_least(0)},
                {"mass_damping", number, "1/s", "0", "mass-proportional damping alpha (brakes rigid motion too)", at_least(0)}}});
  s.push_back(
      {"body",
       "",
       "a rigid body without a mesh",
       {name,
        {"mass", number, "kg", "!", "mass", at_least(0)},
        {"com", vector3, "m", "!", "centre of mass"},
        {"inertia", numbers, "kg m^2", "[0, 0, 0]", "about the centre of mass, inertial axes: Jxx Jyy Jzz [Jxy Jxz Jyz] (tensor entries)"},
        {"axes", numbers, "1", "", "nine numbers: rows are the body axes in which `inertia` is given"}}});
  s.push_back({"point_mass",
               "",
               "mass added to the nodes of a set (shared equally) or to a body",
               {name,
                {"on", text, "", "!", "region, set or body"},
                {"mass", number, "kg", "!", "total mass added", above(0)},
                {"at", vector3, "m", "", "where on a body; its centre when absent"}}});

  const Param joint_kind{"kind", text, "", "!", "the kind of joint"};
  const std::vector<Param> give_way{
      {"stiffness", numbers, "N/m", "", "makes the joint give way: along x, y and axis of its frame, or one number for all", at_least(0)},
      {"angular_stiffness", numbers, "N m/rad", "", "likewise about x, y and axis; the measure is the sine of the angle", at_least(0)},
      {"damping", numbers, "N s/m", "", "dampers beside these springs", at_least(0)},
      {"angular_damping", numbers, "N m s/rad", "", "dampers beside these springs", at_least(0)}};
  const auto joint = [&](std::string_view kind, std::string_view meaning, bool with_axis, std::vector<Param> more = {}) {
    std::vector<Param> p{joint_kind, name, end_a, end_b, at};
    if (with_axis) p.push_back(axis), p.push_back(x_axis);
    p.insert(p.end(), more.begin(), more.end());
    p.insert(p.end(), give_way.begin(), give_way.end());
    s.push_back({"joint", kind, meaning, std::move(p)});
  };
  constexpr Param angle{"angle", number, "rad", "", "drives the joint: angle of b about the axis at history 1"},
      spin{"spin", number, "rad/s", "", "drives the joint: rate of the angle at history 1, integrated from t = 0"},
      displacement{"displacement", number, "m", "", "drives the joint: slide of b along the axis at history 1"},
      velocity{"velocity", number, "m/s", "", "drives the joint: rate of the slide at history 1, integrated from t = 0"},
      drive_history{"history", history, "1", "1", "course of what drives the joint, best with interpolation = \"smooth\""},
      axis_b{"axis_b", vector3, "1", "", "shaft of b where it is bent at the start"},
      third_end{"carrier", text, "", "ground", "what carries both axes: a rigid region, a body, a set, or ground"};
  joint("fixed", "no relative motion (6 rows)", false);
  joint("spherical", "common point (3 rows)", false);
  joint("revolute", "common point and axis: one rotation (5 rows)", true, {angle, spin, drive_history});
  joint("cylindrical", "common axis: one rotation, one slide (4 rows)", true, {angle, spin, displacement, velocity, drive_history});
  joint("prismatic", "slide along the axis (5 rows)", true, {displacement, velocity, drive_history});
  joint("universal", "common point, the axis of a stays normal to `x` of b (4 rows)", true);
  joint("constant-velocity", "common point, shafts of a and b turn by the same angle at any bend (4 rows)", true, {axis_b});
  joint("screw", "common axis, b slides by the pitch per turn (5 rows)", true,
        {{"pitch", number, "m", "!", "slide of b along the axis per turn of b about it; negative: left-handed"},
         angle,
         spin,
         displacement,
         velocity,
         drive_history});
  joint("planar", "b moves in a plane of a and turns about its normal, the axis (3 rows)", true);
  joint("in-plane", "a point of b stays in a plane of a with the normal `axis` (1 row)", true);
  joint("in-line", "a point of b stays on a line of a along `axis` (2 rows)", true);
  joint("gear", "angles of a and b about axes of a carrier stay in a ratio; bearings are joints of their own (1 row, a moment on b)", true,
        {{"axis_b", vector3, "1", "", "axis of b where it differs from that of a"},
         {"ratio", number, "1", "!", "turns of b per turn of a; negative when they turn against each other"},
         third_end});
  joint("rack", "slide of b goes with the angle of a, the pinion; bearings and guides are joints of their own (1 row)", true,
        {{"direction", vector3, "1", "!", "direction in the carrier along which b moves when a turns positively about `axis`"},
         {"radius", number, "m", "!", "pitch radius: slide per angle", above(0)},
         third_end});
  joint("point-on-curve", "a point of b stays on a smooth curve carried by a, a cubic spline through points (2 rows)", false,
        {{"points", numbers, "m", "", "points of the curve, [[x, y, z], ...], reference coordinates"},
         {"file", text, "", "", "CSV file of the points instead: a header line and three columns x, y, z"},
         {"closed", boolean, "", "false", "the curve returns from its last point to the first; off the end of an open one the run stops"}});
  s.push_back(
      {"joint",
       "rolling",
       "a disc, wheel or ball b rolls without slip on a plane carried by a (3 rows, two of them of velocities); the contact also pulls",
       {joint_kind,
        name,
        end_a,
        end_b,
        {"at", vector3, "m", "!", "centre of the disc or ball"},
        {"axis", vector3, "1", "!", "normal of the plane, from the contact to the centre of an upright disc"},
        x_axis,
        {"radius", number, "m", "!", "from the centre to the contact", above(0)},
        {"axle", vector3, "1", "", "axis of the disc or wheel, carried by b; absent: a ball"}}});
  s.push_back({"joint",
               "knife-edge",
               "a point of b moves along an edge of b and not across it (1 row of velocities); joints of their own keep it on its plane",
               {joint_kind,
                name,
                end_a,
                end_b,
                {"at", vector3, "m", "!", "contact point of the edge, carried by b"},
                {"axis", vector3, "1", "!", "normal of the plane, carried by b for the direction across: axis x edge"},
                {"edge", vector3, "1", "!", "direction in which b may move"}}});
  s.push_back({"joint",
               "distance",
               "constant distance of two points (1 row)",
               {joint_kind,
                name,
                end_a,
                end_b,
                {"at_a", vector3, "m", "!", "point on a"},
                {"at_b", vector3, "m", "!", "point on b"},
                {"length", number, "m", "", "distance held; that of the two points when absent", above(0)},
                give_way[0],
                give_way[2]}});

  constexpr std::string_view rest_speed_meaning = "slower impacts lose no smaller part of their speed than they would at this one";
  const Param restitution{"restitution", number, "1", "1", "speed after an impact over that before it; 1 gives the energy back exactly",
                          from_to(0, 1)};
  s.push_back({"spring",
               "stop",
               "limits of the distance of two points: a rope (upper) or a buffer (lower)",
               {{"kind", text, "", "!", "the kind of spring"},
                name,
                end_a,
                end_b,
                {"at_a", vector3, "m", "!", "point on a"},
                {"at_b", vector3, "m", "!", "point on b"},
                {"lower", number, "m", "", "least distance"},
                {"upper", number, "m", "", "greatest distance"},
                {"stiffness", number, "N/m", "!", "of the stop, beyond the limit", above(0)},
                restitution,
                {"rest_speed", number, "m/s", "1e-3", rest_speed_meaning, above(0)}}});
  s.push_back({"spring",
               "axial",
               "spring and damper along the line of two points",
               {{"kind", text, "", "!", "the kind of spring"},
                name,
                end_a,
                end_b,
                {"at_a", vector3, "m", "!", "point on a"},
                {"at_b", vector3, "m", "!", "point on b"},
                {"stiffness", number, "N/m", "0", "force per extension", at_least(0)},
                {"damping", number, "N s/m", "0", "force per rate of extension", at_least(0)},
                {"length", number, "m", "", "free length; the initial distance when absent", at_least(0)},
                {"preload", number, "N", "0", "tension at the initial distance, added by shifting the free length; needs a stiffness"}}});
  s.push_back({"spring",
               "torsion",
               "spring and damper about an axis that a and b share through a joint",
               {{"kind", text, "", "!", "the kind of spring"},
                name,
                end_a,
                end_b,
                axis,
                {"stiffness", number, "N m/rad", "0", "moment per angle of b relative to a", at_least(0)},
                {"damping", number, "N m s/rad", "0", "moment per rate of angle", at_least(0)},
                {"angle", number, "rad", "0", "free angle, measured from the initial position"}}});
  s.push_back({"spring",
               "bushing",
               "six springs and dampers in a frame carried by a",
               {{"kind", text, "", "!", "the kind of spring"},
                name,
                end_a,
                end_b,
                at,
                {"axis", vector3, "1", "[0, 0, 1]", "third axis of the frame"},
                x_axis,
                {"stiffness", numbers, "N/m", "[0, 0, 0]", "three translational stiffnesses", at_least(0)},
                {"damping", numbers, "N s/m", "[0, 0, 0]", "three translational dampings", at_least(0)},
                {"angular_stiffness", numbers, "N m/rad", "[0, 0, 0]",
                 "three rotational stiffnesses; the measure is sin(angle) n, good to about 60 degrees", at_least(0)},
                {"angular_damping", numbers, "N m s/rad", "[0, 0, 0]", "three rotational dampings", at_least(0)}}});
  s.push_back({"spring",
               "support",
               "unilateral spring of a point on b against a plane carried by a, with springs in the plane",
               {{"kind", text, "", "!", "the kind of spring"},
                name,
                end_a,
                end_b,
                at,
                {"axis", vector3, "1", "[0, 0, 1]", "normal of the plane, towards b"},
                x_axis,
                {"stiffness", number, "N/m", "!", "normal force per penetration, never a pull", at_least(0)},
                {"damping", number, "N s/m", "0", "normal damping while in contact", at_least(0)},
                restitution,
                {"rest_speed", number, "m/s", "1e-3", rest_speed_meaning, above(0)},
                {"clearance", number, "m", "0", "gap at the start; negative is penetration"},
                {"tangential_stiffness", numbers, "N/m", "[0, 0]", "along `x` and along axis x `x`", at_least(0)},
                {"tangential_damping", numbers, "N s/m", "[0, 0]", "along `x` and along axis x `x`", at_least(0)}}});

  const Param of_joint{"joint", text, "", "!", "name of the [[joint]] along whose axis it acts, on b and in return on a"};
  const auto stop = [&](std::string_view kind, std::string_view meaning, std::string_view unit, std::string_view per,
                        std::string_view speed) {
    s.push_back({"stop",
                 kind,
                 meaning,
                 {{"kind", text, "", "!", "the kind of stop"},
                  name,
                  of_joint,
                  {"lower", number, unit, "", "limit from below, measured from the start"},
                  {"upper", number, unit, "", "limit from above, measured from the start"},
                  {"stiffness", number, per, "!", "of the stop, beyond the limit", above(0)},
                  restitution,
                  {"rest_speed", number, speed, "1e-3", rest_speed_meaning, above(0)}}});
  };
  stop("angle", "limits the angle of a revolute, cylindrical, screw or planar joint", "rad", "N m/rad", "rad/s");
  stop("slide", "limits the displacement of a prismatic, cylindrical, screw or in-line joint", "m", "N/m", "m/s");
  s.push_back({"motor",
               "rotary",
               "torque about the axis of a revolute, cylindrical, screw or planar joint, from its speed",
               {{"kind", text, "", "!", "the kind of motor"},
                name,
                of_joint,
                {"rate", numbers, "rad/s", "!", "rising speeds of b relative to a; one number for a constant torque"},
                {"torque", numbers, "N m", "!",
                 "torque on b at these speeds, linear between them, first and last segment continued; none in statics"},
                history_key}});
  s.push_back(
      {"motor",
       "linear",
       "force along the axis of a prismatic, cylindrical, screw or in-line joint, from its speed",
       {{"kind", text, "", "!", "the kind of motor"},
        name,
        of_joint,
        {"rate", numbers, "m/s", "!", "rising speeds of b relative to a; one number for a constant force"},
        {"force", numbers, "N", "!", "force on b at these speeds, linear between them, first and last segment continued; none in statics"},
        history_key}});
  s.push_back(
      {"friction",
       "",
       "Coulomb friction in a revolute, cylindrical, prismatic, screw or spherical joint, pressed by the joint's own reaction force",
       {name,
        {"joint", text, "", "!", "name of the [[joint]]"},
        {"coefficient", number, "1", "!", "of friction", at_least(0)},
        {"radius", number, "m", "", "of the surfaces that turn; not of a prismatic joint", above(0)},
        {"preload", number, "N", "0", "pressing force besides the reaction", at_least(0)},
        {"reaction", boolean, "", "true", "the joint's reaction presses too; false leaves the preload alone, as of a brake"},
        {"slip_velocity", number, "m/s", "1e-3",
         "v of the regularisation tanh(slip/v): a fraction p of the limit force creeps at v artanh(p)", above(0)}}});

  const Param on{"on", text, "", "!", "set, region or body it acts on"};
  s.push_back({"load",
               "force",
               "total force shared by the nodes of a set, or on a body's point",
               {{"kind", text, "", "!", "the kind of load"},
                name,
                on,
                {"force", vector3, "N", "!", "total force, inertial axes"},
                {"at", vector3, "m", "", "point of a body it acts at; the set's nodes, or the centre of mass, when absent"},
                {"per_node", boolean, "", "false", "the force is that of each node, as in a deck's *CLOAD"},
                history_key}});
  s.push_back(
      {"load",
       "traction",
       "force per reference area on a facet set, inertial axes",
       {{"kind", text, "", "!", "the kind of load"}, name, on, {"traction", vector3, "Pa", "!", "force per reference area"}, history_key}});
  s.push_back({"load",
               "pressure",
               "follower pressure on a facet set, positive pushes inwards",
               {{"kind", text, "", "!", "the kind of load"}, name, on, {"pressure", number, "Pa", "!", "pressure"}, history_key}});
  s.push_back({"load",
               "torque",
               "moment on a body, inertial axes, or along an axis carried by the body",
               {{"kind", text, "", "!", "the kind of load"},
                name,
                on,
                {"torque", vector3, "N m", "!", "moment"},
                {"follower", boolean, "", "false", "the moment turns with the body"},
                history_key}});

  s.push_back({"motion",
               "fixed",
               "holds the nodes of a set, or a body",
               {{"kind", text, "", "!", "the kind of motion"},
                name,
                on,
                {"components", texts, "", "[\"x\", \"y\", \"z\"]", "which components are held; a body is always held whole"}}});
  s.push_back({"motion",
               "translation",
               "moves a set or body by a displacement times its history",
               {{"kind", text, "", "!", "the kind of motion"},
                name,
                on,
                {"displacement", vector3, "m", "!", "displacement at history 1"},
                {"components", texts, "", "[\"x\", \"y\", \"z\"]", "which components are prescribed; a body is always moved whole"},
                history_key}});
  s.push_back({"motion",
               "rotation",
               "turns a set or body about an axis by an angle times its history",
               {{"kind", text, "", "!", "the kind of motion"},
                name,
                on,
                at,
                axis,
                {"angle", number, "rad", "!", "angle at history 1"},
                history_key}});

  s.push_back({"initial",
               "",
               "initial velocity and spin of regions, sets or bodies",
               {{"on", texts, "", "[\"*\"]", "names or globs; later entries override earlier ones"},
                {"velocity", vector3, "m/s", "[0, 0, 0]", "velocity of the reference point"},
                {"spin", vector3, "rad/s", "[0, 0, 0]", "angular velocity"},
                {"about", vector3, "m", "", "reference point of the spin; the centre of mass of what is named when absent"}}});
  s.push_back({"sensor",
               "",
               "accelerometer triad on a set, region or body",
               {name,
                on,
                {"at", vector3, "m", "", "point on a body; mean of the nodes when absent"},
                {"x", vector3, "1", "[1, 0, 0]", "forward axis at the start (ISO 8855)"},
                {"z", vector3, "1", "[0, 0, 1]", "upward axis at the start (ISO 8855)"}}});
  s.push_back({"probe",
               "",
               "position, velocity and acceleration of a point",
               {name, on, {"at", vector3, "m", "", "point on a body, or nearest node of the set; mean of the nodes when absent"}}});
  s.push_back(
      {"history",
       "",
       "a named factor over time",
       {{"t", numbers, "s", "", "rising times; two equal ones make a jump"},
        {"value", numbers, "", "", "values, in the unit of what the history scales (1 for a factor)"},
        {"file", text, "", "", "CSV file with a header line and two columns: t, value"},
        {"scale", number, "1", "1", "factor on the values"},
        {"interpolation", text, "", "linear", "linear, smooth (cosine ramps) or smoother (ramps with three continuous derivatives)"}}});
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
         "[\"displacement\", \"velocity\", \"acceleration\", \"stress\", \"von_mises\", \"stress_error\", \"plastic_strain\"]",
         "nodal fields"},
        {"nodes", text, "", "all", "whose fields: all, or skin: those on the surface of a region, which pictures without cuts show"},
        {"precision", text, "", "double", "double or single"}}});
  return s;
}

}  // namespace

const std::vector<KindSchema>& scene_schema() {
  static const std::vector<KindSchema> schema = make();
  return schema;
}

std::vector<std::string> choices(std::string_view section, std::string_view key) {
  if (section == "time" && key == "integrator") return integrator_words().words();
  static const std::map<std::pair<std::string_view, std::string_view>, std::vector<std::string>> words = {
      {{"scene", "units"}, unit_systems()},
      {{"motion", "components"}, {"x", "y", "z"}},
      {{"history", "interpolation"}, {"linear", "smooth", "smoother"}},
      {{"time", "start"}, {"as given", "equilibrium"}},
      {{"time", "analysis"}, {"dynamic", "static"}},
      {{"solver", "kind"}, {"auto", "light", "klu", "cholesky", "umfpack", "direct", "cg", "iterative", "bddc", "feti-dp"}},
      {{"output", "fields"}, {"displacement", "velocity", "acceleration", "stress", "von_mises", "stress_error", "plastic_strain"}},
      {{"output", "nodes"}, {"all", "skin"}},
      {{"output", "precision"}, {"double", "single"}},
  };
  const auto found = words.find({section, key});
  return found == words.end() ? std::vector<std::string>{} : found->second;
}

std::vector<size_t> lengths(std::string_view section, std::string_view key) {
  if (section == "body") return key == "inertia" ? std::vector<size_t>{3, 6} : std::vector<size_t>{9};
  if (section == "joint") return key == "points" ? std::vector<size_t>{} : std::vector<size_t>{1, 3};
  if (section == "spring") return key.starts_with("tangential") ? std::vector<size_t>{2} : std::vector<size_t>{3};
  return {};
}

bool is_list_section(std::string_view s) {
  return s == "body" || s == "point_mass" || s == "joint" || s == "spring" || s == "stop" || s == "motor" || s == "friction" ||
         s == "load" || s == "motion" || s == "initial" || s == "sensor" || s == "probe";
}
bool is_single_section(std::string_view s) { return s == "scene" || s == "time" || s == "solver" || s == "output"; }

}  // namespace hilo
