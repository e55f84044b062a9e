// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/scene/scene_items.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "model/beam_line.hpp"
#include "model/height_grid.hpp"
#include "physics/contact/obstacle_kinds.hpp"

namespace hilo {
namespace {

constexpr Rgb joint_colour{0.56, 0.10, 0.44}, spring_colour{0.10, 0.42, 0.42}, load_colour{0.80, 0.15, 0.12},
    support_colour{0.16, 0.30, 0.66}, drive_colour{0.72, 0.38, 0.02}, sensor_colour{0.15, 0.50, 0.18}, beam_colour{0.25, 0.35, 0.45},
    mass_colour{0.16, 0.17, 0.19};

/// At most about `most` of the nodes, evenly taken.
std::vector<Vec3> thinned(const Mesh& mesh, const std::vector<std::int64_t>& nodes, size_t most) {
  std::vector<Vec3> x;
  const size_t stride = std::max<size_t>(1, nodes.size() / most);
  for (size_t i = 0; i < nodes.size(); i += stride) x.push_back(mesh.X[static_cast<size_t>(nodes[i])]);
  return x;
}

/// The section next to the middle of the part of a beam that a load by length is on.
size_t middle(const BeamLine& line, const Entry& load) {
  const double half = ((load.has("from") ? load.number("from") : 0) + (load.has("to") ? load.number("to") : line.s.back())) / 2;
  size_t k = 0;
  while (k < line.cells.size() && (line.s[k] + line.s[k + 1]) / 2 <= half) ++k;
  return k;
}

struct Symbol {
  std::string_view section, kind;
  Glyph glyph;
};
constexpr Symbol symbols[] = {
    {"joint", "fixed", Glyph::block},         {"joint", "spherical", Glyph::ball},     {"joint", "constant-velocity", Glyph::ball},
    {"joint", "point-on-curve", Glyph::ball}, {"joint", "weighted-sum", Glyph::link},  {"joint", "in-plane", Glyph::ball},
    {"joint", "distance", Glyph::link},       {"joint", "prismatic", Glyph::slider},   {"joint", "cylindrical", Glyph::slider},
    {"joint", "screw", Glyph::slider},        {"joint", "in-line", Glyph::slider},     {"joint", "planar", Glyph::slider},
    {"joint", "revolute", Glyph::hinge},      {"joint", "universal", Glyph::hinge},    {"joint", "gear", Glyph::hinge},
    {"joint", "rack", Glyph::hinge},          {"joint", "rolling", Glyph::hinge},      {"joint", "knife-edge", Glyph::hinge},
    {"spring", "axial", Glyph::coil},         {"spring", "curve", Glyph::coil},        {"spring", "stop", Glyph::coil},
    {"spring", "torsion", Glyph::spiral},     {"spring", "support", Glyph::ground},    {"spring", "bushing", Glyph::bushing},
    {"stop", "angle", Glyph::stop},           {"stop", "slide", Glyph::stop},          {"motor", "rotary", Glyph::turn},
    {"motor", "linear", Glyph::arrow},        {"friction", "", Glyph::friction},       {"load", "force", Glyph::arrow},
    {"load", "acceleration", Glyph::arrow},   {"load", "centrifugal", Glyph::arrow},   {"load", "traction", Glyph::arrow},
    {"load", "line", Glyph::arrow},           {"load", "pressure", Glyph::arrow},      {"load", "torque", Glyph::turn},
    {"motion", "fixed", Glyph::clamp},        {"motion", "translation", Glyph::arrow}, {"motion", "rotation", Glyph::turn}};

class Collector {
 public:
  Collector(const Scene& scene, const MeshFile* file) : scene_(scene), file_(file) {}

  SceneItems collect() {
    for (const Entry& e : scene_.entries("body")) body(e);
    for (const Entry& e : scene_.entries("beam")) beam(e);
    for (const Entry& e : scene_.entries("joint")) joint(e);
    for (const Entry& e : scene_.entries("spring")) spring(e);
    for (const char* section : {"stop", "motor", "friction"})
      for (const Entry& e : scene_.entries(section)) on_joint(e);
    for (const Entry& e : scene_.entries("load")) load(e);
    for (const Entry& e : scene_.entries("motion")) motion(e);
    for (const Entry& e : scene_.entries("obstacle")) obstacle(e);
    for (const Entry& e : scene_.entries("contact"))  // "all" has no place
      if (e.text("a") != "all" && e.text("b") != "all") between(e, e.number("friction") > 0 ? "contact with friction" : "contact");
    for (const Entry& e : scene_.entries("tie")) between(e, "tie");
    for (const Entry& e : scene_.entries("point_mass")) {
      SceneItem& item = add(Glyph::mass, e, "point mass", mass_colour);
      item.at = e.has("at") ? e.vector3("at") : centre(e, "on");
    }
    for (const Entry& e : scene_.entries("sensor")) {
      SceneItem& item = add(Glyph::triad, e, "sensor: forward and up", sensor_colour);
      item.at = e.has("at") ? e.vector3("at") : centre(e, "on");
      item.along = e.vector3("x"), item.above = e.vector3("z");
    }
    for (const Entry& e : scene_.entries("probe")) {
      SceneItem& item = add(Glyph::cross, e, "probe", sensor_colour);
      item.at = e.has("at") ? e.vector3("at") : centre(e, "on");
    }
    return std::move(found_);
  }

 private:
  SceneItem& add(Glyph glyph, const Entry& e, const std::string& meaning, const Rgb& colour) {
    SceneItem& item = found_.items.emplace_back();
    item.glyph = glyph, item.name = e.name, item.meaning = meaning, item.colour = colour;
    return item;
  }

  const Ellipsoid* find_body(const std::string& name) const {
    for (const auto& b : found_.bodies)
      if (b.name == name) return &b;
    return nullptr;
  }

  std::vector<std::int64_t> nodes(const Entry& e, std::string_view key) const {
    if (file_) return file_->mesh.nodes_of(e.text(key), e.where(key));
    std::vector<std::string> names;
    for (const auto& b : found_.bodies) names.push_back(b.name);
    throw Error(e.where(key), fmt::format("{}: no body \"{}\"", e.label(), e.text(key)), suggest(e.text(key), names));
  }

  Vec3 centre(const Entry& e, std::string_view key) const {
    if (const auto* b = find_body(e.text(key))) return b->centre;
    Vec3 sum = Vec3::Zero();
    const auto list = nodes(e, key);
    for (const auto n : list) sum += file_->mesh.X[static_cast<size_t>(n)];
    return list.empty() ? sum : Vec3(sum / static_cast<double>(list.size()));
  }

  /// Nodes of an end that is a set: the patch it holds.
  void add_patch(SceneItem& item, const Entry& e, std::string_view key) const {
    const std::string& name = e.text(key);
    if (name == "ground" || find_body(name)) return;
    const auto list = nodes(e, key);
    if (file_->mesh.find_region(name) >= 0) return;
    const auto dots = thinned(file_->mesh, list, 150);
    item.nodes.insert(item.nodes.end(), dots.begin(), dots.end());
  }

  void body(const Entry& e) {
    const Ellipsoid b = ellipsoid_of(e);
    found_.bodies.push_back(b);
    SceneItem& item = add(Glyph::mass, e, "centre of mass of a body", mass_colour);
    item.at = b.centre;
  }

  /// Lines between its sections, which are bodies to whoever names them.
  void beam(const Entry& e) {
    const BeamLine line = beam_line(e);
    const size_t last = line.at.size() - 1, stride = std::max<size_t>(1, last / 200);
    for (size_t k = 0; k < last; k += stride) {
      SceneItem& item = add(Glyph::link, e, "beam", beam_colour);
      item.at = line.at[k], item.to = line.at[std::min(k + stride, last)];
    }
    for (const auto& [name, k] : section_names(e, line)) found_.bodies.push_back({name, line.at[k], Mat3::Identity(), Vec3::Zero()});
  }

  void joint(const Entry& e) {
    const auto glyph = glyph_of(e.section, e.kind);
    const char* drives[] = {"angle", "spin", "displacement", "velocity"};
    const bool driven = std::any_of(std::begin(drives), std::end(drives), [&](const char* key) { return e.given(key); });
    const bool gives = e.has("stiffness") || e.has("angular_stiffness");
    SceneItem& item = add(glyph, e, e.kind + (driven ? " joint, driven" : gives ? " joint that gives way" : " joint"), joint_colour);
    if (glyph == Glyph::link)
      item.at = e.vector3("at_a"), item.to = e.vector3("at_b");
    else
      item.at = e.vector3("at");
    if (e.has("axis")) item.along = e.vector3("axis");
    add_patch(item, e, "a");
    add_patch(item, e, "b");
  }

  /// Stops, motors and friction sit at the joint they act in, about its symbol.
  void on_joint(const Entry& e) {
    std::vector<std::string> names;
    for (const Entry& j : scene_.entries("joint")) {
      names.push_back(j.name);
      if (j.name != e.text("joint")) continue;
      const auto glyph = glyph_of(e.section, e.kind);
      SceneItem& item = add(glyph, e, e.section == "friction" ? "friction" : e.kind + " " + e.section, drive_colour);
      item.at = j.vector3(j.has("at") ? "at" : "at_a");
      if (j.has("axis")) item.along = j.vector3("axis");
      return;
    }
    throw Error(e.where("joint"), fmt::format("{}: no joint \"{}\"", e.label(), e.text("joint")), suggest(e.text("joint"), names));
  }

  void spring(const Entry& e) {
    const auto glyph = glyph_of(e.section, e.kind);
    SceneItem& item = add(glyph, e, e.kind == "bushing" ? "bushing" : e.kind + " spring", spring_colour);
    if (glyph == Glyph::coil)
      item.at = e.vector3("at_a"), item.to = e.vector3("at_b");
    else if (glyph == Glyph::spiral)
      item.at = shared_joint(e);
    else
      item.at = e.vector3("at");
    if (e.has("axis")) item.along = e.vector3("axis");
  }

  /// A torsion spring sits at the joint of its two ends.
  Vec3 shared_joint(const Entry& e) const {
    for (const Entry& j : scene_.entries("joint")) {
      const bool same = j.text("a") == e.text("a") && j.text("b") == e.text("b"),
                 turned = j.text("a") == e.text("b") && j.text("b") == e.text("a");
      if ((same || turned) && j.has("at")) return j.vector3("at");
    }
    return centre(e, "b");
  }

  void load(const Entry& e) {
    const auto glyph = glyph_of(e.section, e.kind);
    if (glyph == Glyph::turn) {
      SceneItem& item = add(glyph, e, e.kind, load_colour);
      item.at = centre(e, "on"), item.along = e.vector3("torque");
      return;
    }
    if (e.kind == "line") {  // in the middle of what it is on of each beam
      for (const Entry& beam : scene_.entries("beam")) {
        if (fnmatch(e.text("on").c_str(), beam.name.c_str(), 0) != 0) continue;
        const BeamLine line = beam_line(beam);
        const size_t k = middle(line, e);
        SceneItem& item = add(glyph, e, "force per length", load_colour);
        item.at = line.at[k], item.along = e.vector3("force_per_length");
        if (e.has("force_per_length_end")) item.along = (item.along + e.vector3("force_per_length_end")) / 2;
        if (e.boolean("follower")) item.along = (k > 0 ? line.cells[k - 1].frame_b : line.cells[0].frame_a) * item.along;
      }
      return;
    }
    SceneItem& item = add(glyph, e, e.kind, load_colour);
    item.at = e.kind == "force" && e.has("at") ? e.vector3("at") : centre(e, "on");
    if (!find_body(e.text("on"))) item.nodes = thinned(file_->mesh, nodes(e, "on"), 150);
    if (e.kind == "centrifugal") {
      const Vec3 axis = e.vector3("axis").normalized(), from = item.at - e.vector3("at");
      item.along = from - from.dot(axis) * axis;
      if (!(item.along.norm() > 0)) item.along = axis.unitOrthogonal();  // about its own middle: any way out
    } else {
      item.along = e.kind == "pressure" ? Vec3(inward(e) * e.number("pressure")) : e.vector3(e.kind);
    }
    if ((e.kind == "force" || e.kind == "acceleration" || e.kind == "centrifugal") && file_ && file_->mesh.find_region(e.text("on")) >= 0)
      item.nodes.clear();  // a whole region: the arrow says enough
  }

  /// Mean inward normal of a facet set.
  Vec3 inward(const Entry& e) const {
    const auto set = file_ ? file_->mesh.facet_sets.find(e.text("on")) : std::map<std::string, std::vector<Facet>>::const_iterator{};
    if (!file_ || set == file_->mesh.facet_sets.end())
      throw Error(e.where("on"), fmt::format("{}: \"{}\" is no facet set", e.label(), e.text("on")));
    Vec3 sum = Vec3::Zero();
    const auto& X = file_->mesh.X;
    for (const Facet& f : set->second) {
      const auto n = file_->mesh.facet_nodes(f);
      const auto x = [&](size_t k) -> const Vec3& { return X[static_cast<size_t>(n[k])]; };
      const bool triangle = n.size() % 3 == 0;
      sum -= triangle ? (x(1) - x(0)).cross(x(2) - x(0)) : (x(2) - x(0)).cross(x(3) - x(1));
    }
    return sum.norm() > 0 ? Vec3(sum.normalized()) : Vec3(0, 0, -1);
  }

  void motion(const Entry& e) {
    const bool on_body = find_body(e.text("on")) != nullptr;
    const auto glyph = glyph_of(e.section, e.kind);
    SceneItem& item = add(glyph, e, e.kind == "fixed" ? "held" : "prescribed " + e.kind, support_colour);
    item.at = e.kind == "rotation" ? e.vector3("at") : centre(e, "on");
    if (!on_body) item.nodes = thinned(file_->mesh, nodes(e, "on"), 150);
    if (e.kind == "rotation") item.along = e.vector3("axis") * e.number("angle");
    if (e.kind == "translation") item.along = e.vector3("displacement");
  }

  /// The middle of what there is, and half its extent [m].
  std::pair<Vec3, double> extent() const {
    Vec3 low = Vec3::Constant(1e300), high = -low;
    if (file_)
      for (const Vec3& x : file_->mesh.X) low = low.cwiseMin(x), high = high.cwiseMax(x);
    for (const auto& b : found_.bodies) low = low.cwiseMin(b.centre), high = high.cwiseMax(b.centre);
    for (const Entry& e : scene_.entries("obstacle"))  // on bodies, which may be points
      if (e.text("on") != "ground" && e.has("radius"))
        for (const double r : {-e.number("radius"), e.number("radius")})
          low = low.cwiseMin(Vec3(e.vector3("at").array() + r)), high = high.cwiseMax(Vec3(e.vector3("at").array() + r));
    if (!(low[0] <= high[0])) return {Vec3::Zero(), 1};
    return {(low + high) / 2, std::max((high - low).norm() / 2, 1e-300)};
  }

  /// Its outline, in its true size; of what has no end, as far as the model.
  void obstacle(const Entry& e) {
    const Obstacle made = obstacle_kinds().at(e.kind, e.place.text()).make(e);
    SceneItem& item = add(Glyph::outline, e, "obstacle: " + e.kind, support_colour);
    item.at = made.at;
    const auto [middle, size] = extent();
    const Distance& shape = made.shape;
    const auto line = [&](int n, auto&& at) {
      auto& points = item.lines.emplace_back();
      for (int k = 0; k <= n; ++k) points.push_back(item.at + made.axes * at(static_cast<double>(k) / n));
    };
    const auto circle = [&](const Vec3& about, const Vec3& a, const Vec3& b) {
      line(48, [&](double s) { return Vec3(about + std::cos(2 * M_PI * s) * a + std::sin(2 * M_PI * s) * b); });
    };
    const Vec3 x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
    const double r = shape.radius;
    switch (shape.kind) {
      case Distance::Kind::plane: {  // a net below the model
        const Vec3 local = made.axes.transpose() * (middle - made.at);
        item.at = made.at + made.axes * Vec3(local[0], local[1], 0);
        for (int k = -2; k <= 2; ++k) {
          line(1, [&](double s) { return Vec3(size * (2 * s - 1), size * k / 2, 0); });
          line(1, [&](double s) { return Vec3(size * k / 2, size * (2 * s - 1), 0); });
        }
        break;
      }
      case Distance::Kind::sphere:
        circle(Vec3::Zero(), r * x, r * y), circle(Vec3::Zero(), r * x, r * z), circle(Vec3::Zero(), r * y, r * z);
        break;
      case Distance::Kind::cylinder:
      case Distance::Kind::capsule: {
        const bool endless = shape.half_length <= 0;
        const double half = endless ? size : shape.half_length;
        if (endless) item.at = made.at + made.axes.col(2) * made.axes.col(2).dot(middle - made.at);
        for (const double side : {-half, half}) {
          circle(side * z, r * x, r * y);
          for (const Vec3& across : {x, y})
            if (shape.kind == Distance::Kind::capsule)
              line(24, [&](double s) {
                return Vec3(side * z + std::cos(M_PI * s) * r * across + std::copysign(r, side) * std::sin(M_PI * s) * z);
              });
        }
        for (int k = 0; k < 4; ++k)
          line(1, [&](double s) { return Vec3(r * std::cos(M_PI * k / 2), r * std::sin(M_PI * k / 2), half * (2 * s - 1)); });
        break;
      }
      case Distance::Kind::torus:
        for (const double side : {-shape.tube, shape.tube})
          circle(Vec3::Zero(), (r + side) * x, (r + side) * y), circle(side * z, r * x, r * y);
        for (int k = 0; k < 4; ++k) {
          const Vec3 out(std::cos(M_PI * k / 2), std::sin(M_PI * k / 2), 0);
          circle(r * out, shape.tube * out, shape.tube * z);
        }
        break;
      case Distance::Kind::box:
        for (int axis = 0; axis < 3; ++axis)
          for (int k = 0; k < 4; ++k) {
            Vec3 corner = shape.half;
            corner[(axis + 1) % 3] *= k & 1 ? 1 : -1, corner[(axis + 2) % 3] *= k & 2 ? 1 : -1;
            line(1, [&](double s) {
              Vec3 at = corner;
              at[axis] *= 2 * s - 1;
              return at;
            });
          }
        break;
      case Distance::Kind::height_field: {
        const HeightGrid grid = height_grid_of(e, scene_);
        const auto nx = static_cast<int>(grid.x.size()), ny = static_cast<int>(grid.y.size());
        const auto net = [&](int n_lines, int n_points, auto&& at) {  // few enough lines to be seen apart
          const int lines = std::min(n_lines - 1, 16), pieces = std::min(n_points - 1, 200);
          for (int k = 0; k <= lines; ++k) {
            auto& points = item.lines.emplace_back();
            for (int m = 0; m <= pieces; ++m) {
              const auto [i, j] = at(k * (n_lines - 1) / lines, m * (n_points - 1) / pieces);
              points.push_back(item.at + made.axes * Vec3(grid.x[i], grid.y[j], grid.heights[static_cast<size_t>(j) * nx + i]));
            }
          }
        };
        net(ny, nx, [](int line, int point) { return std::pair(point, line); });
        net(nx, ny, [](int line, int point) { return std::pair(line, point); });
        break;
      }
    }
  }

  /// A line between what meets, with the nodes of sets.
  void between(const Entry& e, const char* meaning) {
    SceneItem& item = add(Glyph::link, e, meaning, drive_colour);
    const auto place = [&](std::string_view key) {
      for (const Entry& o : scene_.entries("obstacle"))
        if (o.name == e.text(key)) return o.vector3("at");
      add_patch(item, e, key);
      return centre(e, key);
    };
    item.at = place("a"), item.to = place("b");
  }

  const Scene& scene_;
  const MeshFile* file_;
  SceneItems found_;
};

}  // namespace

Glyph glyph_of(std::string_view section, std::string_view kind) {
  for (const Symbol& s : symbols)
    if (s.section == section && s.kind == kind) return s.glyph;
  throw Error("", fmt::format("no symbol for a {} of kind \"{}\"", section, kind), "a row is missing in post/scene/scene_items.cpp",
              Exit::fault);
}

SceneItems scene_items(const Scene& scene, const MeshFile* mesh) { return Collector(scene, mesh).collect(); }

}  // namespace hilo
