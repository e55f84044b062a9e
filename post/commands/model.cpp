// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-post model: the scene before any run, with its joints, springs, loads, supports and sensors.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vtkCamera.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <set>

#include "base/args.hpp"
#include "base/error.hpp"
#include "model/scene_sets.hpp"
#include "post/commands/commands.hpp"
#include "post/files/csv.hpp"
#include "post/scene/ellipsoid_surface.hpp"
#include "post/scene/glyphs.hpp"
#include "post/scene/names.hpp"
#include "post/scene/overlay.hpp"
#include "post/scene/shown_field.hpp"
#include "post/scene/stage.hpp"
#include "post/scene/view.hpp"

namespace hilo {
namespace {

struct ModelOptions {
  std::string scene, mesh, output, camera = "iso", size = "1600x900", title, values;
  std::vector<std::string> show, hide, set;
  bool see_through = false, no_names = false;
};

/// One line of the legend and how its regions are drawn.
struct Group {
  std::string heading, label;  // groups of one heading stand below it
  Fidelity fidelity;
  Rgb colour;
  std::vector<bool> member;  // per region
};

/// Regions of one fidelity in groups of like names; rigid ones are paler.
std::vector<Group> groups_of(const MeshFile& file, const std::vector<bool>& shown) {
  std::vector<Group> groups;
  for (const Fidelity f : {Fidelity::nonlinear, Fidelity::linear, Fidelity::rigid}) {
    std::vector<std::string> names;
    std::vector<size_t> which;
    for (size_t r = 0; r < shown.size(); ++r)
      if (shown[r] && file.fidelity[r] == f) names.push_back(file.mesh.region_name[r]), which.push_back(r);
    for (const NameGroup& g : grouped(names, 8)) {
      const Rgb colour = category_colour(static_cast<int>(groups.size()));
      Group group{fmt::format("{} regions", word(f)), g.label, f, f == Fidelity::rigid ? blend(colour, {0.88, 0.88, 0.88}, 0.62) : colour,
                  std::vector<bool>(shown.size(), false)};
      for (const size_t m : g.members) group.member[which[m]] = true;
      groups.push_back(std::move(group));
    }
  }
  return groups;
}

/// A region each with its value, the largest first, in colours from dark to bright with the value or its logarithm; the rest is grey.
std::vector<Group> groups_by_value(const MeshFile& file, const std::vector<bool>& shown, const std::string& path) {
  const CsvTable table = read_csv(path);
  if (table.header.size() < 2) throw Error(path, "has one column", "region,value: a header, then a row for each region");
  const std::vector<double> numbers = table.numbers(1);
  const auto& names = file.mesh.region_name;
  std::vector<std::pair<double, size_t>> valued;
  for (size_t row = 0; row < table.rows(); ++row) {
    const std::string& name = table.column[0][row];
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) throw Error(path, fmt::format("no region \"{}\"", name), suggest(name, names));
    const auto r = static_cast<size_t>(at - names.begin());
    if (shown[r] && std::isfinite(numbers[row])) valued.emplace_back(numbers[row], r);
  }
  std::stable_sort(valued.begin(), valued.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Group> groups;
  std::vector<bool> rest = shown;
  const bool by_logarithm = !valued.empty() && valued.back().first > 0 && valued[0].first > 10 * valued.back().first;
  const auto scaled = [&](double v) { return by_logarithm ? std::log(v) : v; };
  for (const auto& [value, r] : valued) {
    const double low = scaled(valued.back().first), high = scaled(valued[0].first);
    const double s = high > low ? (scaled(value) - low) / (high - low) : 1;
    Group group{table.header[1], fmt::format("{}: {:.3g}", names[r], value), Fidelity::nonlinear,
                map_colour(ColourMap::viridis, 0.15 + 0.8 * s), std::vector<bool>(shown.size(), false)};
    group.member[r] = true, rest[r] = false;
    groups.push_back(std::move(group));
  }
  if (std::find(rest.begin(), rest.end(), true) != rest.end())
    groups.push_back({"Other regions", "no value", Fidelity::rigid, neutral, rest});
  return groups;
}

std::string mesh_path(const ModelOptions& o, const Scene& scene) {
  if (!o.mesh.empty()) return o.mesh;
  const Entry& head = scene.table("scene");
  const std::string mesh = head.has("mesh") ? head.text("mesh") : "";
  return mesh.empty() ? "" : (std::filesystem::path(scene.folder) / mesh).lexically_normal().string();
}

void add_meshed(vtkRenderer* stage, const MeshFile& file, const std::vector<Group>& groups, const std::vector<bool>& shown, double pixel,
                double height, bool see_through) {
  const Mesh& mesh = file.mesh;
  const auto facets = boundary_facets(mesh, shown);
  for (const Group& g : groups) {
    std::vector<Facet> own;
    std::vector<std::int64_t> bars;
    for (const Facet& f : facets)
      if (g.member[static_cast<size_t>(mesh.region[static_cast<size_t>(f.cell)])]) own.push_back(f);
    for (std::int64_t c = 0; c < mesh.n_cells(); ++c)
      if (g.member[static_cast<size_t>(mesh.region[static_cast<size_t>(c)])] && info(mesh.shape[static_cast<size_t>(c)]).dimension == 1)
        bars.push_back(c);
    const Skin skin(mesh, own, bars);
    const bool rigid = g.fidelity == Fidelity::rigid;
    Look look;
    look.colour = g.colour;
    look.opacity = rigid && see_through ? 0.3 : 1;
    look.bar_width = 5 * pixel;
    add_skin(stage, skin, look);
    if (!rigid) add_grid(stage, skin, 0.8 * pixel, 0.3, pixels_per_metre(stage, height));
    add_lines(stage, skin.feature_edges(), {0.1, 0.1, 0.12}, 1.1 * pixel, rigid ? 0.55 : 0.85);
  }
}

std::vector<LegendEntry> legend_of(const std::vector<Group>& groups, const SceneItems& scene, double glyph_size) {
  std::vector<LegendEntry> entries;
  const Group* last = nullptr;
  for (const Group& g : groups) {
    if (!last || last->heading != g.heading) entries.push_back({g.heading, {}, nullptr, true});
    entries.push_back({g.label, g.colour, nullptr});
    last = &g;
  }
  if (!scene.items.empty()) entries.push_back({"Mechanism and loads", {}, nullptr, true});
  std::set<std::string> seen;
  for (const SceneItem& i : scene.items) {
    if (!seen.insert(i.meaning).second) continue;
    const auto symbol = [i, glyph_size](Painter& p, const Vec2& at) {
      const bool two_ends = i.glyph == Glyph::link || i.glyph == Glyph::coil;
      const Vec2 from = two_ends                  ? Vec2(at - Vec2(0.55 * glyph_size, 0))
                        : i.glyph == Glyph::arrow ? Vec2(at + Vec2(0.6 * glyph_size, 0))
                                                  : at;
      const double size = i.glyph == Glyph::arrow ? 0.55 * glyph_size : i.glyph == Glyph::ground ? 0.7 * glyph_size : 0.8 * glyph_size;
      const Vec2 shift = i.glyph == Glyph::ground || i.glyph == Glyph::clamp ? Vec2(0, 0.3 * glyph_size) : Vec2(0, 0);
      draw_glyph(p, i.glyph, from + shift, {0.75, 0}, {0, 0.6}, at + Vec2(0.55 * glyph_size, 0), i.colour, size);
    };
    entries.push_back({i.meaning, i.colour, symbol});
  }
  return entries;
}

/// Which items get their name: all, or where there are many the nearest of those that are alike by name (axle_l1, axle_l2, ...).
std::vector<bool> with_names(const SceneItems& scene, const Vec3& back) {
  std::vector<std::string> names;
  for (const SceneItem& i : scene.items) names.push_back(i.name + " " + i.meaning);
  std::vector<bool> named(names.size(), false);
  for (const NameGroup& g : grouped(names, 24)) {
    const auto nearer = [&](size_t a, size_t b) { return scene.items[a].at.dot(back) < scene.items[b].at.dot(back); };
    if (g.members.size() > 3)
      named[*std::max_element(g.members.begin(), g.members.end(), nearer)] = true;
    else
      for (const size_t m : g.members) named[m] = true;
  }
  return named;
}

void draw_items(Painter& p, const ModelOptions& o, const SceneItems& scene, const Projection& project, const Vec3& back, const Box& box) {
  const double size = 26 * p.scale;
  std::vector<Label> labels;
  const std::vector<bool> named = with_names(scene, back);
  for (const SceneItem& i : scene.items) {
    const Vec2 at = project(i.at), to = project(i.to);
    for (const std::vector<Vec3>& line : i.lines) {
      std::vector<Vec2> drawn;
      for (const Vec3& x : line) drawn.push_back(project(x));
      p.line(drawn, i.colour, 1.2);
    }
    if (i.glyph != Glyph::outline)
      draw_glyph(p, i.glyph, at, project.direction(i.at, i.along), project.direction(i.at, i.above), to, i.colour, size);
    const bool two_ends = i.glyph == Glyph::link || i.glyph == Glyph::coil;
    if (named[static_cast<size_t>(&i - scene.items.data())]) labels.push_back({two_ends ? Vec2(0.5 * (at + to)) : at, i.name, i.colour});
  }
  if (!o.no_names) draw_labels(p, labels, box, 13.5);
}

/// The direction of gravity beside the cross of axes.
void draw_gravity(Painter& p, const Vec3& g, const Fit& fit) {
  if (g.norm() == 0) return;
  const Vec2 d = Vec2(g.dot(fit.right()), g.dot(fit.up())) / g.norm(), at(150 * p.scale, 78 * p.scale);
  if (d.norm() < 0.05) return;
  draw_arrow(p, at, at + 40 * p.scale * d, {0.35, 0.36, 0.38}, 2.2);
  p.text(at - 12 * p.scale * d.normalized(), "g", 16, Across::centre, Up::middle, {0.35, 0.36, 0.38}, true);
}

void run(const ModelOptions& o) {
  const Scene scene = Scene::load(o.scene, o.set);
  for (const auto& w : scene.warnings) fmt::print(stderr, "hilo-post: warning: {}\n", w);
  const std::string path = mesh_path(o, scene);
  std::unique_ptr<MeshFile> file;
  if (!path.empty()) file = std::make_unique<MeshFile>(read_mesh_file(path)), add_scene_sets(scene, file->mesh);
  const SceneItems items = scene_items(scene, file.get());
  if (!file && items.bodies.empty()) throw Error(o.scene, "has neither a mesh nor bodies to draw", "give the mesh as second argument");

  const auto [width, height] = parse_size(o.size);
  const double pixel = picture_scale(width, height);
  const Frame frame = frame_of(width, height, 250, true);
  Picture picture(width, height);
  vtkRenderer* stage = picture.layer(frame.model);
  light(stage);
  Fit fit(parse_view(o.camera), frame.model.w / frame.model.h, 0.07);
  std::vector<bool> shown;
  if (file) {
    shown = shown_regions(file->mesh, o.show, o.hide);
    for (std::int64_t c = 0; c < file->mesh.n_cells(); ++c)
      if (shown[static_cast<size_t>(file->mesh.region[static_cast<size_t>(c)])])
        for (const auto n : file->mesh.cell(c)) fit.add(file->mesh.X[static_cast<size_t>(n)]);
  }
  for (const Ellipsoid& b : items.bodies)
    fit.add(b.centre - b.radii.norm() * Vec3::Ones()), fit.add(b.centre + b.radii.norm() * Vec3::Ones());
  for (const SceneItem& i : items.items) {
    fit.add(i.at);
    if (i.glyph == Glyph::link || i.glyph == Glyph::coil) fit.add(i.to);
  }
  fit.aim(stage->GetActiveCamera());
  if (!file && !o.values.empty())
    throw Error("--values", "the scene has no mesh, so no regions", "give the mesh as second argument", Exit::usage);
  std::vector<Group> groups;
  if (file) {
    groups = o.values.empty() ? groups_of(*file, shown) : groups_by_value(*file, shown, o.values);
    add_meshed(stage, *file, groups, shown, pixel, frame.model.h, o.see_through);
  }
  for (size_t k = 0; k < items.bodies.size(); ++k)
    if (items.bodies[k].radii.norm() > 0)
      add_surface(stage, ellipsoid(items.bodies[k]), blend(category_colour(static_cast<int>(k)), white, 0.35));
  for (const SceneItem& i : items.items)
    if (!i.nodes.empty()) add_dots(stage, i.nodes, blend(i.colour, white, 0.15), 4.5 * pixel);
  stage->ResetCameraClippingRange();
  const Entry& head = scene.table("scene");
  const std::string title = !o.title.empty()                                   ? o.title
                            : head.has("title") && !head.text("title").empty() ? head.text("title")
                                                                               : std::filesystem::path(o.scene).stem().string();
  std::string line =
      file ? fmt::format("{} regions, {} cells, {} nodes", file->mesh.region_name.size(), file->mesh.n_cells(), file->mesh.n_nodes())
           : fmt::format("{} bodies", items.bodies.size());
  if (file && !file->tagged) line += ", not tagged: all nonlinear";
  picture.paint([&](Painter& p) {
    draw_items(p, o, items, Projection(stage, frame.model), fit.back(), frame.model);
    draw_title(p, title, line);
    draw_axes_cross(p, fit.right(), fit.up(), fit.back());
    draw_gravity(p, head.vector3("gravity"), fit);
    draw_legend(p, frame.side, "", legend_of(groups, items, 24 * p.scale));
  });
  picture.write(o.output);
  if (!is_quiet()) fmt::print("{}\n", o.output);
}

}  // namespace

Command model_command(CLI::App& app) {
  auto* sub = app.add_subcommand("model", "picture of a scene before any run: regions, joints, loads, supports, sensors");
  const auto o = std::make_shared<ModelOptions>();
  sub->add_option("scene", o->scene, "scene.toml; - for standard input")->required();
  sub->add_option("mesh", o->mesh, "mesh.h5, tags.h5 or parts-N.h5; that of the scene by default");
  sub->add_option("-o,--output", o->output, "PNG file")->required();
  sub->add_option("--camera", o->camera, fmt::format("{}, or x,y,z towards the camera", fmt::join(view_names(), ", ")))
      ->capture_default_str();
  sub->add_option("--show", o->show, "regions to draw, by name or glob; all by default")->allow_extra_args(false);
  sub->add_option("--hide", o->hide, "regions not to draw")->allow_extra_args(false);
  sub->add_option("--values", o->values, "CSV of region and number: colours regions by it, as hilo-advise --regions writes it")
      ->type_name("FILE");
  sub->add_flag("--see-through", o->see_through, "rigid regions are transparent");
  sub->add_flag("--no-names", o->no_names, "symbols without their names");
  sub->add_option("--set", o->set, "override a key of the scene: joint.trunnion.at=[0,0,1]")->allow_extra_args(false);
  sub->add_option("--size", o->size, "size of the picture, WIDTHxHEIGHT")->capture_default_str();
  sub->add_option("--title", o->title, "title instead of the scene's");
  example(*sub, "  hilo-post model scene.toml tags.h5 -o model.png");
  return {sub, [o] { run(*o); }};
}

}  // namespace hilo
