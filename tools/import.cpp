// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-import: a mesh or a geometry becomes mesh.h5.
#include <fmt/format.h>
#include <gmsh.h>

#include <charconv>
#include <cstdlib>
#include <filesystem>

#include "about.hpp"
#include "base/args.hpp"
#include "base/error.hpp"
#include "base/json.hpp"
#include "base/param.hpp"
#include "import/imported.hpp"
#include "model/inputs.hpp"
#include "model/mesh_source.hpp"
#include "model/section_file.hpp"
#include "model/store.hpp"

using namespace hilo;

namespace {

struct Request {
  std::string input, output, scene_out;
  std::vector<std::string> defines, thickness;
  std::string subcase;
  bool json = false, face = false;
  ImportOptions options;
};

[[noreturn]] void usage(const std::string& what, const std::string& hint = "see hilo-import --help") {
  throw Error("", what, hint, Exit::usage);
}

/// NAME=VALUE of an option; where a value alone is one, the name is "".
std::pair<std::string, double> definition(const std::string& option, const std::string& text, bool needs_name) {
  const auto eq = text.rfind('=');
  const std::string number = eq == std::string::npos ? needs_name ? "" : text : text.substr(eq + 1);
  char* end = nullptr;
  const double value = std::strtod(number.c_str(), &end);
  if (eq == 0 || number.empty() || *end) usage(fmt::format("{} {}: expected {}", option, text, needs_name ? "NAME=NUMBER" : "T or NAME=T"));
  return {eq == std::string::npos ? "" : text.substr(0, eq), value};
}

void check(Request& r) {
  auto& o = r.options;
  for (const auto& d : r.defines) o.define.push_back(definition("--define", d, true));
  for (const auto& t : r.thickness)
    if (!o.thickness.insert(definition("--thickness", t, false)).second) usage(fmt::format("--thickness {}: stated twice", t));
  if (r.subcase == "all") {
    if (o.thicken) usage("--subcase all beside --thicken: the pairs of nodes depend on the supports", "--subcase N, one after the other");
    o.every_subcase = true;
  } else if (!r.subcase.empty()) {
    std::int64_t n = 0;
    const auto [end, bad] = std::from_chars(r.subcase.data(), r.subcase.data() + r.subcase.size(), n);
    if (bad != std::errc() || end != r.subcase.data() + r.subcase.size()) usage(fmt::format("--subcase {}: a number, or all", r.subcase));
    o.subcase = n;
  }
  if (o.scale <= 0) usage("--scale must be positive");
  if (o.order != 1 && o.order != 2) usage("--order is 1 or 2");
  if (o.merge && !(*o.merge > 0)) usage("--merge-nodes must be positive");
  if (o.size && *o.size <= 0) usage("--size must be positive");
  for (const auto& [name, t] : o.thickness)
    if (!(t > 0)) usage("--thickness must be positive");
  if (!o.thickness.empty() && o.order == 2) usage("--thickness makes linear shells", "leave --order away");
  if (o.per_turn && !(*o.per_turn >= 0 && *o.per_turn <= 1000)) usage("--per-turn is from 0 to 1000");
  try {
    to_si("m", o.units);
  } catch (const Error& e) {
    usage("--units: " + e.message, e.hint);
  }
  namespace fs = std::filesystem;
  note_input(r.input);
  for (const auto& out : {r.output, r.scene_out})
    if (!out.empty()) check_output(out);
  if (!r.scene_out.empty() && fs::absolute(r.scene_out) == fs::absolute(r.output)) usage("--scene-out and --output name the same file");
}

/// The files of --scene-out: with --subcase all "scene_3.toml" for SUBCASE 3.
std::string scene_file(const Request& r, const DeckCase& c) {
  const std::filesystem::path p = r.scene_out;
  return (p.parent_path() / fmt::format("{}_{}{}", p.stem().string(), c.number, p.extension().string())).string();
}

/// The scene of --scene-out: the deck's own lines, or where there are none what a scene can name.
std::string scene_text(const Request& r, const Imported& in, const std::string& lines, const std::vector<NotRead>& not_read) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::absolute(r.scene_out).parent_path();
  std::string text = fmt::format("# from {}\n", r.input);
  if (in.mesh.n_cells() > 0)
    text += fmt::format("mesh = \"{}\"\n",
                        fs::absolute(r.output).lexically_normal().lexically_relative(folder.lexically_normal()).generic_string());
  if (!lines.empty()) return text + lines;
  text += "# the file carries no materials, supports or loads.  It names:\n";
  for (const auto& name : in.mesh.all_names()) text += fmt::format("#   {}\n", name);
  return text + left_out(not_read).text();
}

void write_scenes(const Request& r, const Imported& in) {
  if (r.scene_out.empty()) return;
  for (const DeckCase& c : in.cases) {
    const std::string file = scene_file(r, c);
    check_output(file);
    if (std::filesystem::absolute(file) == std::filesystem::absolute(r.output))
      usage(fmt::format("SUBCASE {} and --output name the same file", c.number));
  }
  for (const DeckCase& c : in.cases) write_text_file(scene_file(r, c), scene_text(r, in, c.scene.text(), c.not_read));
  if (in.cases.empty()) write_text_file(r.scene_out, scene_text(r, in, in.mesh.deck_scene, in.not_read));
}

void write_face(Request& r, bool order_given) {
  if (r.options.units_given) usage("--units beside --face: the face keeps the lengths of the file", "`scale` in [section.NAME]");
  if (r.options.scale != 1) usage("--scale beside --face: the face keeps the lengths of the file", "`scale` in [section.NAME]");
  if (!r.scene_out.empty()) usage("--scene-out beside --face: a face has no scene");
  if (!r.output.ends_with(".msh")) usage(fmt::format("--face writes a mesh of gmsh: -o {} does not end in .msh", r.output));
  if (!order_given) r.options.order = 2;
  const std::string text = face_of(r.input, r.options);
  const SectionMesh mesh = section_mesh_of(text, r.output);
  const SectionArea a = meshed_face(mesh, 0.3).area;
  write_text_file(r.output, text);
  if (is_quiet() && !r.json) return;
  if (r.json)
    fmt::print(
        "{}\n",
        Json{{"cells", mesh.cells.size()}, {"A", a.A}, {"I1", a.I1}, {"I2", a.I2}, {"I12", a.I12}, {"J", a.J}, {"s1", a.s1}, {"s2", a.s2}}
            .text());
  else
    fmt::print("{} cells; A {:.6g}, I1 {:.6g}, I2 {:.6g}, I12 {:.6g}, J {:.6g}, shear centre ({:.6g}, {:.6g}) from the centre of area\n",
               mesh.cells.size(), a.A, a.I1, a.I2, a.I12, a.J, a.s1, a.s2);
}

void talk(const Imported& in) {
  if (!is_quiet())
    for (const auto& n : in.notes) fmt::print(stderr, "hilo-import: {}\n", n);
  for (const auto& n : in.not_read) {
    if (is_quiet() && loss_of(n).empty()) continue;
    fmt::print(stderr, "hilo-import: not read: {} ({}{}{}){}{}{}\n", n.what, n.count, n.place.empty() ? "" : ", ", n.place,
               n.output ? ", a request for output" : "", n.hint.empty() ? "" : "; ", n.hint);
  }
}

}  // namespace

int main(int argc, char** argv) {
  return guarded("hilo-import", [&] {
    auto app = make_app(
        {"hilo-import",
         "Reads a mesh, or a geometry that it meshes, and writes mesh.h5: regions, sets, and what the deck says of materials and loads.",
         "hilo-import bracket.inp -o bracket.h5 --units mm-t-s\n"
         "hilo-import vehicle.geo -o vehicle.h5 --define SIZE=0\n"
         "hilo-import arm.step -o arm.h5 --size 20 --order 2 --set 'bore=cylinder:at=[0,0,15],axis=[0,0,1],radius=10'",
         about({"gmsh " GMSH_API_VERSION})});
    Request r;
    auto& o = r.options;
    app->add_option("input", r.input, "inp (plain or .gz), bdf, msh, unv, vtk, vtu, mesh, med, exo; geo, step, brep, iges are meshed")
        ->required()
        ->type_name("FILE");
    app->add_option("-o,--output", r.output, "mesh file to write")->required()->type_name("mesh.h5");
    const auto* units = app->add_option("--units", o.units,
                                        "system of the file's numbers, all converted to SI: m-kg-s, mm-t-s, mm-kg-ms, in-lbf-s, ft-lbf-s")
                            ->type_name("SYSTEM");
    app->add_option("--scale", o.scale,
                    "factor on the geometry and on displacements that a deck prescribes; STEP and IGES say their unit of length");
    app->add_option("--order", o.order, "2: quadratic cells (linear ones get nodes in the middle of their edges)")->type_name("N");
    app->add_option("--size", o.size, "cell edge when CAD is meshed, at most this when a .geo script is; in the unit of the file");
    app->add_option("--thickness", r.thickness,
                    "surfaces become solid-shells of this thickness about them, in the unit of the file (geo, CAD, msh, unv, med, exo); "
                    "NAME=T: one group of "
                    "them, beside volumes too, may be repeated")
        ->type_name("[NAME=]T")
        ->allow_extra_args(false);
    app->add_option(
           "--per-turn", o.per_turn,
           "cells around a full turn of a curved face when CAD is meshed, none finer than an eighth of the size at 12; 0: no finer than "
           "elsewhere (default: 12, and without --size more where the volume would be off by 1 %)")
        ->type_name("N");
    app->add_option("--define", r.defines, "parameter of a .geo script, may be repeated")->type_name("NAME=VALUE")->allow_extra_args(false);
    app->add_flag("--trust", o.trust, "a .geo script may run commands, write files, read the environment and files of other folders");
    app->add_flag("--thicken", o.thicken,
                  "shells of a deck (S3 to S8R, CTRIA3 to CQUAD8) become solid-shells: pairs of nodes across the thickness");
    app->add_flag("--rigid-beams", o.rigid_beams,
                  "beams of a deck become cells of a region that can be rigid alone, not beams of the scene");
    app->add_option(
           "--subcase", r.subcase,
           "number of the SUBCASE of a Nastran file whose loads and supports are taken; the first one when absent; all: a scene for "
           "each of them, scene_N.toml by --scene-out scene.toml, and one mesh with the sets of all")
        ->type_name("N");
    app->add_flag("--flip", o.flip, "turn cells whose nodes are numbered as in a mirror (negative volume)");
    app->add_flag("--face", r.face,
                  "a plane surface of a .geo or CAD file becomes the face of a section of beams: -o face.msh, in the unit of the file; of "
                  "quadratic cells unless --order 1 is given");
    app->add_flag("--keep-apart", o.keep_apart, "solids of a CAD file that touch share no nodes");
    app->add_option("--set", o.sets,
                    "a set by place, with the words of [set.NAME] in a scene, in the unit of the file; may be repeated: "
                    "bore=cylinder:at=[0,0,0],axis=[0,0,1],radius=8, foot=plane:..., pin=near:1,2,3, rim=box:...")
        ->type_name("NAME=KIND:KEY=VALUE,...")
        ->allow_extra_args(false);
    app->add_option("--beams", o.beams,
                    "a curve group (geo, CAD, msh) becomes beams of the scene, with the words of [section.NAME], in the unit of the file; "
                    "may be repeated: rail=tube:diameter=60,thickness=3")
        ->type_name("GROUP=KIND:KEY=VALUE,...")
        ->allow_extra_args(false);
    app->add_option("--merge-nodes", o.merge, "nodes nearer than this become one, in the unit of the file");
    app->add_option("--regions", o.regions, "element sets that become regions, before what the file says")
        ->delimiter(',')
        ->type_name("SET,...")
        ->allow_extra_args(false);
    app->add_option("--rest", o.rest, "name of the region of the cells that are in none; \"rest\" when absent")->type_name("NAME");
    app->add_option("--scene-out", r.scene_out, "write the deck's materials, supports and loads as a scene too")->type_name("scene.toml");
    app->add_flag("--json", r.json, "the table as JSON");
    if (!parse(*app, argc, argv)) return;
    o.units_given = units->count() > 0;
    check(r);
    if (r.face) return write_face(r, app->count("--order") > 0);
    Imported in = read_any(r.input, o);
    finish(in, r.input, o);
    Store mesh = unpublished_mesh(r.output, in.mesh, {command_line(argc, argv)});
    if (!in.thin_regions.empty()) write_thin_regions(mesh, in.thin_regions);
    write_scenes(r, in);  // all files or none
    mesh.publish();
    talk(in);
    std::vector<std::string> scenes;
    for (const DeckCase& c : in.cases) scenes.push_back(r.scene_out.empty() ? "" : scene_file(r, c));
    if (r.json || !is_quiet()) fmt::print("{}", r.json ? import_json(in, r.input, r.output, scenes) : import_table(in, scenes));
  });
}
