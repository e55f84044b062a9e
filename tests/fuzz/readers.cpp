// SPDX-License-Identifier: GPL-3.0-or-later
#include "fuzz/readers.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "import/gmsh/script.hpp"
#include "import/imported.hpp"
#include "model/height_grid.hpp"
#include "model/mesh.hpp"
#include "model/mesh_tags.hpp"
#include "model/scene.hpp"
#include "model/scene_read.hpp"
#include "model/section_file.hpp"
#include "model/store.hpp"
#include "post/files/csv.hpp"

namespace hilo::test {
namespace {

template <Imported (*read)(const std::string&, const ImportOptions&)>
void import(const std::string& path) {
  const ImportOptions options{};
  Imported in = read(path, options);
  finish(in, path, options);
  import_table(in);
}

void scene(const std::string& path) { Scene::load(path).explain(); }
void tags(const std::string& path) { read_tag_rules(path); }

void store(const std::string& path) {
  const MeshFile file = read_mesh_file(path);
  const Store s = Store::open(path);
  for (const auto& group : {"/", "/tags", "/parts", "/history", "/mesh"})
    for (const auto& name : s.list(group)) {
      const std::string array = group == std::string_view("/") ? group + name : fmt::format("{}/{}", group, name);
      if (s.is_array(array) && s.type(array) == "f8") s.read<double>(array);
      if (s.is_array(array) && s.type(array) == "string") s.read_strings(array);
    }
}

void table(const std::string& path) {
  const CsvTable t = read_csv(path);
  for (size_t i = 0; i < t.header.size(); ++i) try {
      t.numbers(i);
    } catch (const Error&) {  // a column of names
    }
}
void points(const std::string& path) { read_points_csv(path, "fuzz"); }
void heights(const std::string& path) {
  constexpr double size[2] = {1, 1}, range[2] = {0, 1e-3};
  read_height_image(path, "fuzz", size, range);
}
void section(const std::string& path) { meshed_face(section_mesh_of(read_text_file(path), path), 0.3); }
void history(const std::string& path) { read_history_csv(path, "fuzz"); }

}  // namespace

std::span<const Reader> readers() {
  static const Reader all[] = {
      {"msh", ".msh", import <read_msh>},
      {"medit", ".mesh", import <read_medit>},
      {"bdf", ".bdf", import <read_bdf>},
      {"inp", ".inp", import <read_inp>},
      {"unv", ".unv", import <read_unv>},
      {"vtk", ".vtk", import <read_vtk>},
      {"vtu", ".vtu", import <read_vtk>},
      {"stl", ".stl", import <read_stl>},
      {"geo", ".geo", refuse_commands},
      {"scene", ".toml", scene},
      {"tags", ".toml", tags},
      {"csv", ".csv", table},
      {"points", ".csv", points},
      {"history", ".csv", history},
      {"heights", ".png", heights},
      {"section", ".msh", section},
      {"store", ".h5", store},
  };
  return all;
}

std::string offence(const Reader& reader, const std::string& path) {
  try {
    reader.read(path);
  } catch (const Error& e) {
    const std::string_view what = e.what();
    if (e.exit != Exit::input && e.exit != Exit::usage) return fmt::format("exit {}: {}", static_cast<int>(e.exit), what);
    if (what.find('\n') != what.npos) return fmt::format("more than one line: {}", what);
  } catch (const std::exception& e) {
    return fmt::format("not an Error: {}", e.what());
  }
  return "";
}

}  // namespace hilo::test
