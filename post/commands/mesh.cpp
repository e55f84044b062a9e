// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-post mesh: a mesh, its tags or its parts, coloured by region, fidelity or part.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vtkCamera.h>

#include <memory>

#include "base/args.hpp"
#include "base/error.hpp"
#include "model/scaled_jacobian.hpp"
#include "post/commands/commands.hpp"
#include "post/files/output.hpp"
#include "post/scene/glyphs.hpp"
#include "post/scene/numbered_faces.hpp"
#include "post/scene/overlay.hpp"
#include "post/scene/shown_field.hpp"
#include "post/scene/stage.hpp"
#include "post/scene/view.hpp"

namespace hilo {
namespace {

struct MeshOptions {
  std::string mesh, output, field = "region", camera = "iso", size = "1280x720", edges = "feature", title;
  std::vector<std::string> show, hide;
  double angle = 0.7;  // [rad]
  bool faces = false, slivers = false, json = false;
};

/// Slivers of what is shown, in red within the pale whole.
std::int64_t draw_slivers(vtkRenderer* stage, const Mesh& mesh, const std::vector<bool>& shown) {
  std::vector<Facet> facets;
  std::int64_t count = 0;
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c) {
    const auto& shape = info(mesh.shape[static_cast<size_t>(c)]);
    if (!shown[static_cast<size_t>(mesh.region[static_cast<size_t>(c)])] || shape.dimension < 3) continue;
    if (!(scaled_jacobian(mesh, c) < sliver_limit)) continue;
    ++count;
    for (std::int64_t f = 0; f < static_cast<std::int64_t>(shape.facets.size()); ++f) facets.push_back({c, f});
  }
  if (count == 0) return 0;
  Look look;
  look.colour = {0.85, 0.05, 0.05};
  add_skin(stage, Skin(mesh, facets), look);
  return count;
}

void run(const MeshOptions& o) {
  const MeshFile file = read_mesh_file(o.mesh);
  const Mesh& mesh = file.mesh;
  const auto shown = shown_regions(mesh, o.show, o.hide);
  const NamedCells named = named_cells(file, o.field, shown, o.mesh);
  const auto [width, height] = parse_size(o.size);
  const double pixel = picture_scale(width, height);
  const Frame frame = frame_of(width, height, 230, true);
  Picture picture(width, height);
  vtkRenderer* stage = picture.layer(frame.model);
  light(stage);
  const auto region_of = [&](std::int64_t cell) { return static_cast<size_t>(mesh.region[static_cast<size_t>(cell)]); };
  Fit fit(parse_view(o.camera), frame.model.w / frame.model.h);
  std::vector<std::array<std::uint8_t, 3>> colour;
  std::vector<std::int64_t> bars;
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c) {
    colour.push_back(bytes(named.colours[static_cast<size_t>(named.name_of[static_cast<size_t>(c)])]));
    if (!shown[region_of(c)]) continue;
    if (info(mesh.shape[static_cast<size_t>(c)]).dimension == 1) bars.push_back(c);
    for (const auto n : mesh.cell(c)) fit.add(mesh.X[static_cast<size_t>(n)]);
  }
  fit.aim(stage->GetActiveCamera());
  const auto outside = boundary_facets(mesh, shown);
  Skin skin(mesh, outside, bars);
  skin.set_cell_colours(colour);
  Look look;
  look.by = Look::By::cells;
  look.bar_width = 5 * pixel;
  look.opacity = o.slivers ? 0.15 : 1;
  const std::int64_t n_slivers = o.slivers ? draw_slivers(stage, mesh, shown) : 0;
  add_skin(stage, skin, look);
  if (o.edges == "all") add_grid(stage, skin, pixel, 0.35, pixels_per_metre(stage, frame.model.h));
  if (o.edges != "none") add_lines(stage, skin.feature_edges(), {0.1, 0.1, 0.12}, 1.3 * pixel, 0.8);
  stage->ResetCameraClippingRange();
  const auto faces = o.faces ? numbered_faces(mesh, outside, o.angle) : std::vector<NumberedFace>{};
  const auto places = places_of_numbers(faces, stage->GetActiveCamera());
  std::string unseen;
  for (size_t i = 0; i < places.size(); ++i)
    if (!places[i]) unseen += fmt::format("{}{}", unseen.empty() ? "" : ", ", i + 1);
  picture.paint([&](Painter& p) {
    const Projection project(stage, frame.model);
    std::vector<Vec2> points;
    for (const auto& place : places)
      if (place) points.push_back(project(*place));
    const auto labels = spread_labels(points, 23 * p.scale, frame.model);
    for (size_t k = 0; k < labels.size(); ++k)
      if ((labels[k] - points[k]).norm() > 4 * p.scale) p.line(points[k], labels[k], ink, 1.2), p.disc(points[k], 3 * p.scale, ink);
    for (size_t i = 0, k = 0; i < places.size(); ++i) {
      if (!places[i]) continue;
      p.disc(labels[k], 11 * p.scale, white);
      p.text(labels[k++], fmt::format("{}", i + 1), 13, Across::centre, Up::middle, ink, true);
    }
    std::string line = fmt::format("{} cells, {} nodes", mesh.n_cells(), mesh.n_nodes());
    if (o.slivers) line += fmt::format(", {} slivers (scaled Jacobian below {})", n_slivers, sliver_limit);
    draw_title(p, o.title.empty() ? o.mesh : o.title, line);
    draw_axes_cross(p, fit.right(), fit.up(), fit.back());
    std::vector<LegendEntry> entries;
    for (size_t i = 0; i < named.names.size(); ++i) entries.push_back({named.names[i], named.colours[i], nullptr});
    draw_legend(p, frame.side, named.title, entries);
  });
  picture.write(o.output);
  if (o.faces) {
    const Table table = table_of_faces(mesh, faces);
    if (o.json || !is_quiet()) write_out("-", o.json ? table.json().text() + "\n" : table.text());
    if (!unseen.empty() && !is_quiet()) fmt::print(stderr, "not seen from here: {}; --camera looks from elsewhere\n", unseen);
  } else if (!is_quiet())
    fmt::print("{}\n", o.output);
}

}  // namespace

Command mesh_command(CLI::App& app) {
  auto* sub = app.add_subcommand("mesh", "picture of a mesh, its tags or its parts");
  const auto o = std::make_shared<MeshOptions>();
  sub->add_option("mesh", o->mesh, "mesh.h5, tags.h5 or parts-N.h5")->required();
  sub->add_option("-o,--output", o->output, "PNG file")->required();
  sub->add_option("--field", o->field, "region, fidelity or partition")
      ->check(CLI::IsMember({"region", "fidelity", "partition"}))
      ->capture_default_str();
  sub->add_option("--camera", o->camera, fmt::format("{}, or x,y,z towards the camera", fmt::join(view_names(), ", ")))
      ->capture_default_str();
  sub->add_option("--show", o->show, "regions to draw, by name or glob; all by default")->allow_extra_args(false);
  sub->add_option("--hide", o->hide, "regions not to draw")->allow_extra_args(false);
  sub->add_option("--edges", o->edges, "none, feature or all")->check(CLI::IsMember({"none", "feature", "all"}))->capture_default_str();
  sub->add_flag("--faces", o->faces, "number the smooth faces, and list what [set.NAME] kind = \"near\" and a joint need of them");
  sub->add_option("--angle", o->angle, "facets that turn by more than this meet at an edge between faces [rad]")
      ->check(CLI::Range(0.0, 3.2))
      ->capture_default_str();
  sub->add_flag("--slivers", o->slivers, "show the cells whose scaled Jacobian is below 0.05");
  sub->add_flag("--json", o->json, "the list of --faces as JSON");
  sub->add_option("--size", o->size, "size of the picture, WIDTHxHEIGHT")->capture_default_str();
  sub->add_option("--title", o->title, "title instead of the file's name");
  example(*sub, "  hilo-post mesh tags.h5 --field fidelity -o fidelity.png\n  hilo-post mesh tags.h5 --faces -o faces.png");
  return {sub, [o] { run(*o); }};
}

}  // namespace hilo
