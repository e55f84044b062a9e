// SPDX-License-Identifier: GPL-3.0-or-later
// Geometries that the gmsh library meshes: scripts (.geo), step, brep, iges.  A script that is not trusted is looked through first, and
// gmsh is confined while it reads.
#include <fmt/format.h>
#include <gmsh.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <new>
#include <stdexcept>

#include "base/error.hpp"
#include "import/crash_guard.hpp"
#include "import/gmsh/cad.hpp"
#include "import/gmsh/confined.hpp"
#include "import/gmsh/mesh.hpp"
#include "import/gmsh/script.hpp"
#include "import/gmsh/session.hpp"
#include "model/store.hpp"

namespace hilo {
namespace {

constexpr double usual_per_turn = 12, most_off = 0.01;

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
    if (format == "step") gmsh::option::setString("Geometry.OCCTargetUnit", "MM");  // of IGES it is refused, which comes in mm too
    if (format == "iges")                                                           // faces side by side, of which a solid is to be made
      gmsh::option::setNumber("Geometry.OCCSewFaces", 1), gmsh::option::setNumber("Geometry.OCCMakeSolids", 1);
    gmsh::model::occ::importShapes(path, made, false, format);
    gmsh::model::occ::synchronize();
    mesh.of_solids = true;
    std::vector<NamedEntity> named;
    if (format == "step") named = step_names(read_text_file(path), mesh.metre.value_or(1e-3) / 1e-3, mesh.notes);
    join_touching(o.keep_apart, named, mesh.coloured, mesh.notes);
  }
  if (const auto e = GmshSession::errors(); !e.empty()) throw Error(path, e);
  gmsh::vectorpair volumes, surfaces, bars;
  gmsh::model::getEntities(volumes, 3);
  gmsh::model::getEntities(surfaces, 2);
  gmsh::model::getPhysicalGroups(bars, 1);
  if (o.face && surfaces.empty()) throw Error(path, "no surface to mesh", "the face of a section is a plane surface in x and y");
  if (!o.face && volumes.empty() && (!o.thickness.empty() ? surfaces.empty() : bars.empty() || !surfaces.empty()))
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

/// Curved faces finer, by cells around a full turn; but no cell below an eighth of the size at 12 of them, or the smallest fillet would set
/// the size of all.
void set_per_turn(double per_turn, const ImportOptions& o, double unit) {
  if (per_turn == 0) return;
  std::array<double, 6> b{};
  gmsh::model::getBoundingBox(-1, -1, b[0], b[1], b[2], b[3], b[4], b[5]);
  const double by_default = Vec3(b[3] - b[0], b[4] - b[1], b[5] - b[2]).norm() / 10;  // as gmsh takes it
  const double size = o.size ? std::min(*o.size * unit, by_default) : by_default;
  gmsh::option::setNumber("Mesh.MeshSizeFromCurvature", per_turn);
  gmsh::option::setNumber("Mesh.MeshSizeMin", size / 8 * std::min(1.0, usual_per_turn / per_turn));
}

/// Volume and area of the solids in lengths of `unit`; none of what is not of the CAD kernel.
std::optional<std::array<double, 2>> size_of_solids(double unit) {
  std::array<double, 2> sum{};
  try {
    gmsh::vectorpair volumes, faces;
    gmsh::model::getEntities(volumes, 3);
    gmsh::model::getEntities(faces, 2);
    for (const auto& [dim, tag] : volumes) {
      double volume = 0;
      gmsh::model::occ::getMass(3, tag, volume);
      if (!(volume > 0)) return std::nullopt;
      sum[0] += volume;
    }
    for (const auto& [dim, tag] : faces) {
      std::vector<int> up, down;
      gmsh::model::getAdjacencies(2, tag, up, down);
      double area = 0;
      if (up.size() == 1) gmsh::model::occ::getMass(2, tag, area);
      sum[1] += area;
    }
  } catch (...) {  // a script of gmsh's own kernel
    return std::nullopt;
  }
  if (sum[0] == 0) return std::nullopt;
  return std::array{sum[0] / (unit * unit * unit), sum[1] / (unit * unit)};
}

/// By how much of the CAD kernel's the volume and area of a mesh are off.
std::array<double, 2> off(const Imported& in, const std::array<double, 2>& solids) {
  double volume = 0, area = 0;
  std::vector<std::int64_t> cells;
  for (std::int64_t c = 0; c < in.mesh.n_cells(); ++c)
    if (info(in.mesh.shape[c]).dimension == 3) volume += quality(in.mesh, c).volume, cells.push_back(c);
  for (const Facet& f : free_facets(in.mesh, cells)) area += facet_area(in.mesh, f).norm();
  return {volume / solids[0] - 1, area / solids[1] - 1};
}

/// What gmsh has thrown and what it has logged, each once.
std::string told(const std::string& thrown) {
  const std::string logged = GmshSession::errors();
  if (logged.find(thrown) != logged.npos) return logged;
  return logged.empty() ? thrown : thrown + "; " + logged;
}

/// Why the volumes cannot be filled, with the place, of which gmsh says nothing.
std::string unfilled(const std::string& errors, double unit) {
  const std::string where = errors.find("PLC Error") == errors.npos ? "" : where_facets_cut(unit);
  return where.empty() ? errors : errors + ": " + where;
}

/// Meshes what is open; why that failed, or "".
std::string try_to_mesh(const ImportOptions& o, double unit) {
  gmsh::vectorpair volumes;
  gmsh::model::getEntities(volumes, 3);
  try {
    gmsh::model::mesh::generate(!volumes.empty() ? 3 : !o.thickness.empty() || o.face ? 2 : 1);
    if (const auto e = GmshSession::errors(); !e.empty()) return unfilled(e, unit);
    if (o.order == 2 && (o.face || !volumes.empty())) gmsh::model::mesh::setOrder(2);
  } catch (const std::string& e) {
    return unfilled(told(e), unit);
  } catch (const std::runtime_error& e) {  // from gmsh 4.13 on
    return unfilled(told(e.what()), unit);
  } catch (int) {
    return unfilled(GmshSession::errors(), unit);
  }
  for (const auto& [dim, tag] : volumes) {
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> tags, nodes;
    gmsh::model::mesh::getElements(types, tags, nodes, 3, tag);
    if (types.empty()) return fmt::format("no cells in {}", name_of_volume(tag));
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

/// Of a physical group that has nothing gmsh keeps the name alone.
void tell_empty_groups(GmshMesh& mesh) {
  constexpr std::array<const char*, 4> words{"point", "curve", "surface", "volume"};
  for (int dim = 0; dim < 4; ++dim) {
    const int behind = std::min(gmsh::model::addPhysicalGroup(dim, {}), 1'000'000);
    for (int tag = 1; tag < behind; ++tag) {
      std::string name;
      if (!mesh.group_name.contains({dim, tag})) gmsh::model::getPhysicalName(dim, tag, name);
      if (!name.empty())
        mesh.notes.push_back(fmt::format("warning: {} group \"{}\" is empty: left out", words[static_cast<size_t>(dim)], name));
    }
  }
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
GmshMesh meshed_at(double factor, double per_turn, std::string& failed, const std::string& path, const std::string& format,
                   const ImportOptions& options) {
  GmshSession session(options);
  const auto refuse = [&](const std::string& e) -> GmshMesh {
    refuse_at_limit(path);
    if (session.printed().find("ERR StepFile") != std::string::npos) throw Error(path, wrong_syntax);
    const bool memory = e.find("ut of memory") != e.npos || e.find("malloc failed") != e.npos;
    throw Error(path, "gmsh: " + told(e), "", memory ? Exit::resources : Exit::input);
  };
  try {
    GmshMesh mesh;
    const double unit = read_unit(path, format, mesh);
    open(path, format, options, mesh);
    if (session.printed().find("ERR StepFile") != std::string::npos) {
      refuse_at_limit(path);
      throw Error(path, wrong_syntax);
    }
    if (options.size) set_size(format, *options.size * unit);
    if (!is_script(format)) set_per_turn(per_turn, options, unit);
    if (factor != 1) gmsh::option::setNumber("Mesh.MeshSizeFactor", factor);
    failed = try_to_mesh(options, unit);
    if (!failed.empty()) {
      refuse_at_limit(path);
      return mesh;
    }
    take_from_library(mesh);
    mesh.solids = size_of_solids(unit);
    if (is_script(format)) tell_empty_groups(mesh);
    if (mesh.metre)
      for (Vec3& x : mesh.X) x /= unit;
    return mesh;
  } catch (const Error&) {
    throw;
  } catch (const std::string& e) {
    return refuse(e);
  } catch (const std::runtime_error& e) {  // from gmsh 4.13 on
    return refuse(e.what());
  } catch (const std::bad_alloc&) {
    throw Error(path, "not enough memory to read it, or its counts are damaged", "", Exit::resources);
  } catch (const std::length_error&) {
    throw Error(path, "its counts are damaged");
  } catch (int) {
    refuse_at_limit(path);
    throw Error(path, "gmsh: " + GmshSession::errors());
  }
}

/// The mesh at the sizes asked for; of a CAD file at others where gmsh fails at those, which is told.  Each try begins anew: gmsh refuses
/// to work after a failure.
GmshMesh meshed(const std::string& path, const std::string& format, const ImportOptions& options, double per_turn) {
  std::string failed, again;
  GmshMesh mesh = meshed_at(1, per_turn, failed, path, format, options);
  if (failed.empty()) return mesh;
  if (!is_script(format))
    for (const double factor : {0.7, 0.5, 1.4, 0.35, 0.25}) {
      mesh = meshed_at(factor, per_turn, again, path, format, options);
      if (!again.empty()) continue;
      mesh.notes.push_back(fmt::format("gmsh cannot mesh it at {} ({}): meshed at {} of that",
                                       options.size ? fmt::format("--size {:g}", *options.size) : "its default size", failed, factor));
      return mesh;
    }
  throw Error(path, fmt::format("gmsh cannot mesh it: {}{}", failed, is_script(format) ? "" : ", at this and five other sizes"),
              "try another --size, or repair the geometry");
}

/// The same, where gmsh may crash and a script that is not trusted may read files alone; `note` says where the kernel cannot hold it.
GmshMesh guarded_mesh(const std::string& path, const std::string& format, const ImportOptions& options, double per_turn,
                      std::string& note) {
  GmshMesh mesh;
  const CrashGuard guard(path, "gmsh");
  const auto mesh_it = [&] { mesh = meshed(path, format, options, per_turn); };
  if (options.trust)
    mesh_it();
  else
    note = confined(mesh_it);
  return mesh;
}

/// What of a mesh is told beside its solids, and what would bring it nearer where it is far.
void tell_off(Imported& in, const std::array<double, 2>& of, const ImportOptions& o, double per_turn, bool script) {
  const auto by = [](double x) {
    return std::abs(x) < 5e-7 ? std::string("as much") : fmt::format("{:.2g} % {}", 100 * std::abs(x), x < 0 ? "less" : "more");
  };
  const bool far = std::abs(of[0]) > most_off;
  std::string would_do;
  if (far) {
    const double finer = 0.9 * std::sqrt(most_off / std::abs(of[0]));  // chords leave out what goes with the square of their length
    if (o.size) would_do = fmt::format("--size {:.2g}", *o.size * finer);
    if (!script) would_do += fmt::format("{}--per-turn {:.0f}", would_do.empty() ? "" : " or ", std::ceil(std::max(per_turn, 6.0) / finer));
    if (o.order == 1) would_do += would_do.empty() ? "--order 2" : " or --order 2";
    if (!would_do.empty()) would_do = "; " + would_do + " would do";
  }
  in.notes.push_back(fmt::format("{}compared with the solids of the CAD kernel the mesh has {} volume and {} area{}",
                                 far ? "warning: " : "", by(of[0]), by(of[1]), would_do));
}

/// What gmsh calls the format of a file, by the ending of its name; "" where it is no geometry.
std::string format_of(const std::string& path) {
  static const std::map<std::string, std::string> formats{{".geo", "geo"},  {".step", "step"}, {".stp", "step"}, {".brep", "brep"},
                                                          {".brp", "brep"}, {".iges", "iges"}, {".igs", "iges"}};
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const auto known = formats.find(ending);
  return known == formats.end() ? "" : known->second;
}

/// Surfaces as gmsh's text of version 2.2: those of physical groups alone where there is one, as gmsh saves them.
std::string text_of(const GmshMesh& mesh) {
  std::string nodes, cells;
  std::int64_t n = 0;
  const auto is_surface = [](const auto& e) { return std::get<0>(e.first) == 2; };
  const bool grouped =
      std::any_of(mesh.entities.begin(), mesh.entities.end(), [&](const auto& e) { return is_surface(e) && !e.second.groups.empty(); });
  for (const auto& [key, entity] : mesh.entities) {
    if (std::get<0>(key) != 2 || (grouped && entity.groups.empty())) continue;
    for (const GmshMesh::Block& b : entity.blocks) {
      const size_t per = b.tags.empty() ? 0 : b.nodes.size() / b.tags.size();
      for (size_t i = 0; i < b.tags.size(); ++i) {
        cells += fmt::format("{} {} 2 0 {}", ++n, b.type, std::get<1>(key));
        for (size_t k = 0; k < per; ++k) cells += fmt::format(" {}", b.nodes[per * i + k]);
        cells += '\n';
      }
    }
  }
  for (size_t i = 0; i < mesh.X.size(); ++i)
    nodes += fmt::format("{} {} {} {}\n", mesh.node_tag[i], mesh.X[i].x(), mesh.X[i].y(), mesh.X[i].z());
  return fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n{}$EndNodes\n$Elements\n{}\n{}$EndElements\n", mesh.X.size(), nodes,
                     n, cells);
}

}  // namespace

Imported read_geometry(const std::string& path, const ImportOptions& options) {
  const std::string format = format_of(path);
  if (format == "geo") options.trust ? refuse_lost_statements(path) : refuse_commands(path);
  const auto meshed_with = [&](double per_turn, std::optional<std::array<double, 2>>& of) {
    std::string note;
    const GmshMesh mesh = guarded_mesh(path, format, options, per_turn, note);
    Imported in = imported_from(path, mesh, options, options.order == 2);
    if (!note.empty()) in.notes.push_back(note);
    of.reset();
    if (mesh.solids) of = off(in, *mesh.solids);
    return in;
  };
  std::optional<std::array<double, 2>> of, finer_of;
  double per_turn = options.per_turn.value_or(usual_per_turn);
  Imported in = meshed_with(per_turn, of);
  const bool free = !is_script(format) && !options.size && !options.per_turn;
  for (int i = 0; i < 3 && free && of && std::abs((*of)[0]) > most_off; ++i) {
    const double next = std::min(60.0, std::ceil(per_turn * std::sqrt(std::abs((*of)[0]) / (0.8 * most_off))));
    if (next <= per_turn) break;
    Imported finer = meshed_with(next, finer_of);
    if (!finer_of || std::abs((*finer_of)[0]) > 0.9 * std::abs((*of)[0])) break;  // it is not the curves
    in = std::move(finer), of = finer_of, per_turn = next;
  }
  if (of) tell_off(in, *of, options, per_turn, is_script(format));
  return in;
}

std::string face_of(const std::string& path, const ImportOptions& options) {
  const std::string format = format_of(path);
  if (format.empty())
    throw Error(path, "no geometry that a face can be meshed of", "a .geo, .step, .brep or .iges file; a scene names a .msh file itself");
  (void)read_text_file(path);  // says what is wrong with it
  if (format == "geo") options.trust ? refuse_lost_statements(path) : refuse_commands(path);
  ImportOptions o = options;
  o.face = true;
  std::string note;
  return text_of(guarded_mesh(path, format, o, o.per_turn.value_or(usual_per_turn), note));
}

}  // namespace hilo
