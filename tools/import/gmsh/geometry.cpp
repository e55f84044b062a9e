// SPDX-License-Identifier: GPL-3.0-or-later
// Geometries that the gmsh library meshes: scripts (.geo), step, brep, iges.  A script that is not trusted is looked through first, and
// gmsh is confined while it reads.
#include <fmt/format.h>
#include <gmsh.h>
#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <new>
#include <stdexcept>

#include "base/error.hpp"
#include "import/gmsh/cad.hpp"
#include "import/gmsh/confined.hpp"
#include "import/gmsh/mesh.hpp"
#include "import/gmsh/script.hpp"
#include "import/gmsh/session.hpp"
#include "model/store.hpp"

namespace hilo {
namespace {

constexpr const char* wrong_syntax = "OpenCASCADE finds wrong syntax in it";

bool is_script(const std::string& format) { return format == "geo"; }

/// Lengths of CAD files come in mm, whatever the file's unit is (OpenCASCADE); those of a .brep and of a script are numbers.
bool comes_in_mm(const std::string& format) { return format == "step" || format == "iges"; }

/// The unit of a CAD file, and what --size is to be multiplied with.
double read_unit(const std::string& path, const std::string& format, GmshMesh& mesh) {
  if (!comes_in_mm(format)) return 1;
  const std::string text = read_text_file(path);
  const auto unit = format == "step" ? step_unit(text) : iges_unit(text);
  mesh.metre = unit && !unit->name.empty() ? unit->metre : 1e-3;
  if (!unit)
    mesh.notes.push_back("the file states no unit of length: mm");
  else
    mesh.notes.push_back(unit->name.empty() ? "parts of the file are in different units: lengths are in mm"
                                            : fmt::format("lengths are in {}, as the file says", unit->name));
  return *mesh.metre / 1e-3;
}

/// The reader is named, so that the library does not guess by what the file begins with: it would run what it takes for a script.
void open(const std::string& path, const std::string& format, const ImportOptions& o, GmshMesh& mesh) {
  if (is_script(format)) {
    gmsh::merge(path);
  } else {
    gmsh::vectorpair made;
    gmsh::option::setString("Geometry.OCCTargetUnit", "MM");
    gmsh::model::occ::importShapes(path, made, false, format);
    gmsh::model::occ::synchronize();
    mesh.of_solids = true;
    join_touching(o.keep_apart, mesh.coloured, mesh.notes);
  }
  if (const auto e = GmshSession::last_error(); !e.empty()) throw Error(path, e);
  gmsh::vectorpair volumes, surfaces, bars;
  gmsh::model::getEntities(volumes, 3);
  gmsh::model::getEntities(surfaces, 2);
  gmsh::model::getPhysicalGroups(bars, 1);
  if (volumes.empty() && (bars.empty() || !surfaces.empty()))
    throw Error(path, "no volume to mesh", "the geometry holds points, curves or surfaces only");
}

void set_size(const std::string& format, double size) {
  if (!is_script(format)) {  // a script may say its own sizes, which the option only bounds
    gmsh::vectorpair points;
    gmsh::model::getEntities(points, 0);
    gmsh::model::mesh::setSize(points, size);
  }
  gmsh::option::setNumber("Mesh.MeshSizeMax", size);
  double low;
  gmsh::option::getNumber("Mesh.MeshSizeMin", low);
  if (low > size) gmsh::option::setNumber("Mesh.MeshSizeMin", size);
}

/// Meshes what is open; why that failed, or "".
std::string try_to_mesh(const ImportOptions& o) {
  gmsh::vectorpair volumes;
  gmsh::model::getEntities(volumes, 3);
  try {
    gmsh::model::mesh::generate(volumes.empty() ? 1 : 3);
    if (const auto e = GmshSession::last_error(); !e.empty()) return e;
    if (o.order == 2 && !volumes.empty()) gmsh::model::mesh::setOrder(2);
  } catch (const std::string& e) {
    return e;
  } catch (int) {
    return GmshSession::last_error();
  }
  for (const auto& [dim, tag] : volumes) {
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> tags, nodes;
    gmsh::model::mesh::getElements(types, tags, nodes, 3, tag);
    if (types.empty()) return fmt::format("no cells in volume {}", tag);
  }
  return "";
}

void take_from_library(GmshMesh& mesh) {
  std::vector<std::size_t> tags;
  std::vector<double> x, u;
  gmsh::model::mesh::getNodes(tags, x, u);
  for (size_t i = 0; i < tags.size(); ++i) {
    mesh.node_tag.push_back(static_cast<std::int64_t>(tags[i]));
    mesh.X.emplace_back(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
  }
  gmsh::vectorpair entities;
  gmsh::model::getEntities(entities);
  for (const auto& [dim, tag] : entities) {
    auto& entity = mesh.entities[{dim, tag, 0}];
    gmsh::model::getEntityName(dim, tag, entity.name);
    gmsh::model::getPhysicalGroupsForEntity(dim, tag, entity.groups);
    for (auto& g : entity.groups) g = std::abs(g);
    if (dim == 0) {
      gmsh::model::mesh::getNodes(tags, x, u, 0, tag);
      entity.points.assign(tags.begin(), tags.end());
    }
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> of_type, nodes;
    gmsh::model::mesh::getElements(types, of_type, nodes, dim, tag);
    for (size_t t = 0; t < types.size(); ++t)
      entity.blocks.push_back({types[t], {of_type[t].begin(), of_type[t].end()}, {nodes[t].begin(), nodes[t].end()}});
  }
  gmsh::vectorpair groups;
  gmsh::model::getPhysicalGroups(groups);
  for (const auto& [dim, tag] : groups) gmsh::model::getPhysicalName(dim, tag, mesh.group_name[{dim, tag}]);
}

/// What gmsh says of a file is worth nothing where it got no memory: it says that a file cannot be read, or nothing.
void refuse_at_limit(const std::string& path) {
  rlimit most{};
  if (getrlimit(RLIMIT_AS, &most) != 0 || most.rlim_cur == RLIM_INFINITY) return;
  std::ifstream status("/proc/self/status");
  rlim_t peak = 0;  // of addresses [kB]
  for (std::string word; status >> word && peak == 0;)
    if (word == "VmPeak:") status >> peak;
  if (const rlim_t near = 64 << 20; (peak << 10) + near > most.rlim_cur)
    throw Error(path, fmt::format("not enough memory to read it: the limit is {} MB", most.rlim_cur >> 20), "raise it, ulimit -v",
                Exit::resources);
}

/// The mesh at `factor` of the sizes asked for, or why gmsh cannot make it.
GmshMesh meshed_at(double factor, std::string& failed, const std::string& path, const std::string& format, const ImportOptions& options) {
  GmshSession session(options);
  try {
    GmshMesh mesh;
    const double unit = read_unit(path, format, mesh);
    open(path, format, options, mesh);
    if (session.printed().find("ERR StepFile") != std::string::npos) {
      refuse_at_limit(path);
      throw Error(path, wrong_syntax);
    }
    if (options.size) set_size(format, *options.size * unit);
    if (factor != 1) gmsh::option::setNumber("Mesh.MeshSizeFactor", factor);
    failed = try_to_mesh(options);
    if (!failed.empty()) {
      refuse_at_limit(path);
      return mesh;
    }
    take_from_library(mesh);
    if (mesh.metre)
      for (Vec3& x : mesh.X) x /= unit;
    return mesh;
  } catch (const std::string& e) {
    refuse_at_limit(path);
    if (session.printed().find("ERR StepFile") != std::string::npos) throw Error(path, wrong_syntax);
    const bool memory = e.find("ut of memory") != e.npos || e.find("malloc failed") != e.npos;
    throw Error(path, "gmsh: " + e, "", memory ? Exit::resources : Exit::input);
  } catch (const std::bad_alloc&) {
    throw Error(path, "not enough memory to read it, or its counts are damaged", "", Exit::resources);
  } catch (const std::length_error&) {
    throw Error(path, "its counts are damaged");
  } catch (int) {
    refuse_at_limit(path);
    throw Error(path, "gmsh: " + GmshSession::last_error());
  }
}

/// The mesh at the sizes asked for; of a CAD file at others where gmsh fails at those, which is told.  Each try begins anew: gmsh refuses
/// to work after a failure.
GmshMesh meshed(const std::string& path, const std::string& format, const ImportOptions& options) {
  std::string failed, again;
  GmshMesh mesh = meshed_at(1, failed, path, format, options);
  if (failed.empty()) return mesh;
  if (!is_script(format))
    for (const double factor : {0.7, 0.5, 1.4, 0.35, 0.25}) {
      mesh = meshed_at(factor, again, path, format, options);
      if (!again.empty()) continue;
      mesh.notes.push_back(fmt::format("gmsh cannot mesh it at {} ({}): meshed at {} of that",
                                       options.size ? fmt::format("--size {:g}", *options.size) : "its default size", failed, factor));
      return mesh;
    }
  throw Error(path, fmt::format("gmsh cannot mesh it: {}{}", failed, is_script(format) ? "" : ", at this and five other sizes"),
              "try another --size, or repair the geometry");
}

Imported read_geometry(const std::string& path, const std::string& format, const ImportOptions& options) {
  GmshMesh mesh;
  std::string note;
  {
    const CrashGuard guard(path);
    if (options.trust) {
      mesh = meshed(path, format, options);
    } else {
      if (format == "geo") refuse_commands(path);
      note = confined([&] { mesh = meshed(path, format, options); });
    }
  }
  Imported in = imported_from(path, mesh, options, options.order == 2);
  if (!note.empty()) in.notes.push_back(note);
  return in;
}

}  // namespace

Imported read_geo(const std::string& path, const ImportOptions& options) { return read_geometry(path, "geo", options); }
Imported read_step(const std::string& path, const ImportOptions& options) { return read_geometry(path, "step", options); }
Imported read_brep(const std::string& path, const ImportOptions& options) { return read_geometry(path, "brep", options); }
Imported read_iges(const std::string& path, const ImportOptions& options) { return read_geometry(path, "iges", options); }

}  // namespace hilo
