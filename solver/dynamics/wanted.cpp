// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/wanted.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "base/free_memory.hpp"
#include "dynamics/choose_solver.hpp"
#include "dynamics/record/fields.hpp"
#include "linear/front_order.hpp"
#include "model/schema.hpp"

namespace hilo {
namespace {

double resident() {
  double size = 0, pages = 0;
  std::ifstream("/proc/self/statm") >> size >> pages;
  return pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}

/// Of the matrix in blocks of 3 x 3 with its places, a symmetric copy by scalars, and the factor in double and in single precision.
double solver_bytes(const System& system) {
  const BlockMap& map = system.layout.map;
  Cliques flexible;
  std::vector<int> list;
  for (int i = 0; i < system.layout.cliques.size(); ++i) {
    list.clear();
    for (const int b : system.layout.cliques[i])
      if (b >= 0 && map.global[static_cast<size_t>(b)] < map.first_dense) list.push_back(b);
    flexible.add(list, true);
  }
  const auto n = static_cast<int>(map.global.size());
  if (n == 0) return 0;
  const double blocks = 2 * static_cast<double>(LowerBlocks(system.layout.cliques, n).rows.size());
  return blocks * (9 * 8 + 2 * 4) + blocks / 2 * 9 * (8 + 4) + (8 + 4) * FrontOrder(flexible, n).entries;
}

double field_bytes(const Scene& scene, const System& system) {
  if (!system.mesh) return 0;
  const auto asked = scene.table("output").texts("fields");
  const double size = scene.table("output").text("precision") == "single" ? 4 : 8;
  double out = 0;  // of one output
  const std::vector<std::int64_t> all(system.mesh->node_global);
  for (const FieldKind& kind : field_kinds())
    for (const Field& f : kind.make(system, all)->fields()) {
      if (std::find(asked.begin(), asked.end(), f.key) == asked.end()) continue;
      double width = 1;
      for (const auto w : row_shape(run_array("/field/000000/" + f.name))) width *= static_cast<double>(w);
      out += size * width * static_cast<double>(f.of_cells ? system.mesh->n_cells_global : system.mesh->n_nodes_global);
    }
  return out;
}

/// What ParaView needs of the mesh, in its two forms.
double topology_bytes(const System& system) {
  if (!system.mesh || system.mesh->mesh.n_cells() == 0) return 0;
  const Mesh& m = system.mesh->mesh;
  const double part = static_cast<double>(m.n_cells()) / static_cast<double>(system.mesh->n_cells_global);
  return 8 * static_cast<double>(2 * m.nodes.size() + 3 * m.shape.size()) / part;
}

std::string size(double bytes) {
  return bytes < 1e9 ? fmt::format("{:.0f} MB", std::ceil(bytes / 1e6)) : fmt::format("{:.1f} GB", bytes / 1e9);
}

}  // namespace

Wanted wanted(const Scene& scene, const System& system) {
  Wanted w;
  const Entry &time = scene.table("time"), &output = scene.table("output");
  const std::string& solver = scene.table("solver").text("kind");
  const std::int64_t unknowns = 3 * system.layout.map.n_global;
  const bool factored = solver == "light" || solver == "klu" || solver == "cholesky" || solver == "umfpack" ||
                        (solver == "auto" && unknowns <= most_factored(scene, system));
  if (system.comm->size == 1 && factored) w.memory = resident() + solver_bytes(system);
  w.per_step = 8 * 12;
  for (const Observer* part : system.all<Observer>())
    for (const Output& o : part->outputs()) w.per_step += 8 * (o.n_end + o.n_mid);
  if (!time.has("end")) return w;
  const double end = time.number("end"), interval = output.given("interval") ? output.number("interval") : end / 50;
  if (time.has("step")) w.steps = end / time.number("step");
  double outputs = interval > 0 ? std::ceil(end / interval - 1e-9) : w.steps;
  if (w.steps > 0) outputs = std::min(outputs, w.steps);  // at steps
  w.fields = field_bytes(scene, system) * (1 + outputs) + topology_bytes(system);
  if (output.boolean("envelope") && system.mesh) w.fields += 6 * 8 * static_cast<double>(system.mesh->n_nodes_global);
  return w;
}

std::string text(const Wanted& w) {
  std::string out = "needs ";
  if (w.memory > 0) out += fmt::format("{} of memory ({} are free) and ", size(w.memory), size(free_memory()));
  out += fmt::format("{} of disk", size(w.disk()));
  if (w.steps == 0) out += fmt::format(" and {:.0f} bytes a step", w.per_step);
  return out;
}

}  // namespace hilo
