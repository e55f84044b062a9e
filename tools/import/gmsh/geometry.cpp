// Geometries that the gmsh library meshes: scripts (.geo), step, brep, iges.  A script that is not trusted is looked through first, and
// gmsh is confined while it reads.
#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <filesystem>
#include <new>
#include <stdexcept>

#include "base/error.hpp"
#include "import/gmsh/confined.hpp"
#include "import/gmsh/mesh.hpp"
#include "import/gmsh/script.hpp"
#include "import/gmsh/session.hpp"

namespace hilo {
namespace {

/// The reader is named, so that the library does not guess by what the file begins with: it would run what it takes for a script.
void open(const std::string& path, const std::string& format, const ImportOptions& o) {
  if (format == "geo") {
    gmsh::merge(path);
  } else {
    gmsh::vectorpair made;
    gmsh::model::occ::importShapes(path, made, false, format);
    gmsh::model::occ::synchronize();
  }
  if (const auto e = GmshSession::last_error(); !e.empty()) throw Error(path, e);
  gmsh::vectorpair volumes, surfaces, bars;
  gmsh::model::getEntities(volumes, 3);
  gmsh::model::getEntities(surfaces, 2);
  gmsh::model::getPhysicalGroups(bars, 1);
  if (volumes.empty() && (bars.empty() || !surfaces.empty()))
    throw Error(path, "no volume to mesh", "the geometry holds points, curves or surfaces only");
  if (o.size) {
    if (format != "geo") {  // a script may say its own sizes, which the option only bounds
      gmsh::vectorpair points;
      gmsh::model::getEntities(points, 0);
      gmsh::model::mesh::setSize(points, *o.size);
    }
    gmsh::option::setNumber("Mesh.MeshSizeMax", *o.size);
    double low;
    gmsh::option::getNumber("Mesh.MeshSizeMin", low);
    if (low > *o.size) gmsh::option::setNumber("Mesh.MeshSizeMin", *o.size);
  }
  gmsh::model::mesh::generate(volumes.empty() ? 1 : 3);
  if (const auto e = GmshSession::last_error(); !e.empty()) throw Error(path, "gmsh cannot mesh it: " + e, "try another --size");
  if (o.order == 2 && !volumes.empty()) gmsh::model::mesh::setOrder(2);
  for (const auto& [dim, tag] : volumes) {
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> tags, nodes;
    gmsh::model::mesh::getElements(types, tags, nodes, 3, tag);
    if (types.empty()) throw Error(path, fmt::format("gmsh made no cells in volume {}", tag), "try another --size");
  }
}

GmshMesh mesh_of_library() {
  GmshMesh mesh;
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
  return mesh;
}

GmshMesh meshed(const std::string& path, const std::string& format, const ImportOptions& options) {
  const GmshSession session(options);
  try {
    open(path, format, options);
    return mesh_of_library();
  } catch (const std::string& e) {
    const bool memory = e.find("ut of memory") != e.npos;
    throw Error(path, "gmsh: " + e, "", memory ? Exit::resources : Exit::input);
  } catch (const std::bad_alloc&) {
    throw Error(path, "not enough memory to read it, or its counts are damaged", "", Exit::resources);
  } catch (const std::length_error&) {
    throw Error(path, "its counts are damaged");
  } catch (int) {
    throw Error(path, "gmsh: " + GmshSession::last_error());
  }
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
