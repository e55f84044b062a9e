// SPDX-License-Identifier: GPL-3.0-or-later
// [[load]] entries.
#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "physics/axes.hpp"
#include "physics/solid_kernel.hpp"
#include "system/builder.hpp"
#include "system/facet.hpp"
#include "system/loads.hpp"

namespace hilo {

void Builder::add_loads() {
  for (const Entry& e : scene_.entries("load")) {
    Load load;
    load.name = e.name;
    load.history = use_history(e, Acts::as_force);
    load.ramped = !e.given("history");
    const std::string where = e.where("on"), &on = e.text("on");
    const Found found = find(on, where);
    if (found.body == 0) throw Error(where, e.label() + ": a load on the ground does nothing");
    const bool has_facets = mesh_ && mesh_->mesh.facet_sets.contains(on);
    const auto facets = [&] {
      if (!has_facets) throw Error(where, fmt::format("{}: \"{}\" is not a set of facets", e.label(), on), "name a 2-D group or *SURFACE");
      std::vector<std::vector<int>> list;
      for (const Facet& f : mesh_->mesh.facet_sets.at(on)) {
        const auto nodes = mesh_->mesh.facet_nodes(f);
        list.emplace_back(nodes.begin(), nodes.end());
      }
      return list;
    };
    const auto share_by_area = [&](double& area) {
      std::vector<double> weight(out_->X.size(), 0.0);
      area = 0;
      for (const auto& facet : facets()) {
        std::vector<Vec3> X;
        for (int i : facet) X.push_back(out_->X[i]);
        const auto w = facet_weights(X);
        for (size_t a = 0; a < facet.size(); ++a) weight[facet[a]] += w[a], area += w[a];
      }
      area = comm_.sum(area);
      for (size_t i = 0; i < weight.size(); ++i)
        if (weight[i] != 0) load.nodes.push_back(static_cast<int>(i)), load.weight.push_back(weight[i]);
    };
    const auto force = [&] {
      load.value = e.vector3("force");
      if (found.body >= 0 && (found.n_global == 0 || e.has("at") || found.is_region)) {
        load.kind = Load::Kind::body_force;
        load.body = found.body;
        if (e.has("at")) load.arm = e.vector3("at") - out_->bodies[found.body].Xc;
      } else {
        if (e.has("at")) throw Error(e.where("at"), fmt::format("{}: \"{}\" is flexible, its force is shared by its nodes", e.label(), on));
        load.kind = Load::Kind::nodal;
        if (has_facets && !e.boolean("per_node")) {
          double area = 0;
          share_by_area(area);
          for (double& w : load.weight) w /= area;
        } else {
          for (int i : found.nodes)
            if (out_->node_owned[i])
              load.nodes.push_back(i), load.weight.push_back(e.boolean("per_node") ? 1.0 : 1.0 / static_cast<double>(found.n_global));
        }
      }
    };
    const auto traction = [&] {
      load.kind = Load::Kind::nodal;
      load.value = e.vector3("traction");
      double area = 0;
      share_by_area(area);
    };
    const auto pressure = [&] {
      load.kind = Load::Kind::pressure;
      load.pressure = e.number("pressure");
      load.facets = facets();
    };
    const auto torque = [&] {
      load.kind = Load::Kind::body_torque;
      load.value = e.vector3("torque");
      load.follower = e.boolean("follower");
      load.body = body_of(on, found, where);
    };
    // Forces of the mass of cells at accelerations that are linear in the reference position, by the mass rule of the cells; by node.
    const auto forces_of_mass = [&](const std::function<Vec3(const Vec3&)>& acceleration) {
      if (!mesh_) throw Error(where, fmt::format("{}: the scene has no mesh", e.label()), "name a body");
      const Mesh& mesh = mesh_->mesh;
      const int region = mesh.find_region(on);
      const auto set = mesh.cell_sets.find(on);
      if (region < 0 && set == mesh.cell_sets.end())
        throw Error(where, fmt::format("{}: \"{}\" is no region and no set of cells", e.label(), on), "mass is in cells");
      std::vector<std::int64_t> cells;
      for (std::int64_t c = 0; region >= 0 && c < mesh.n_cells(); ++c)
        if (mesh.region[c] == region) cells.push_back(c);
      if (region < 0) cells = set->second;
      std::map<int, Vec3> force;
      const StVenantKirchhoff no_matter{{1, 1}};  // the mass alone is asked for
      struct alignas(64) Line {
        double value[8];
      };
      std::vector<Line> scratch;
      comm_.together([&] {
        for (const std::int64_t c : cells) {
          const Region& r = regions_[mesh.region[c]];
          if (r.fidelity != Fidelity::nonlinear)
            throw Error(where,
                        fmt::format("{}: region \"{}\" is {}", e.label(), r.name, r.fidelity == Fidelity::rigid ? "rigid" : "linear"),
                        fmt::format("tag it nonlinear: hilo-tag --nonlinear '{}'", r.name));
          if (!(r.density > 0))
            throw Error(where, fmt::format("{}: region \"{}\" has no density", e.label(), r.name), "give its material a density");
          if (info(mesh.shape[c]).dimension == 2) continue;  // has none as a cell
          const auto nodes = mesh.cell(c);
          const SolidKernel kernel = solid_kernel(static_cast<Shape>(mesh.shape[c]), place_of<StVenantKirchhoff>);
          const int n3 = 3 * static_cast<int>(nodes.size()), w = std::min(lanes(), kernel.width);
          scratch.resize(9 * nodes.size());
          double *X = scratch[0].value, *a = scratch[n3].value, *f = scratch[2 * static_cast<size_t>(n3)].value;
          for (int i = 0; i < n3; ++i)
            for (int l = 0; l < w; ++l)
              X[i * w + l] = mesh.X[nodes[i / 3]][i % 3] - origin_[i % 3], a[i * w + l] = acceleration(mesh.X[nodes[i / 3]])[i % 3];
          kernel.call({X, X, X, 0, 0, &no_matter, f, nullptr, nullptr, nullptr, nullptr, r.density, a, 0, r.area});
          for (int i = 0; i < n3; i += 3)
            force.try_emplace(static_cast<int>(nodes[i / 3]), Vec3::Zero()).first->second += Vec3(f[i * w], f[(i + 1) * w], f[(i + 2) * w]);
        }
      });
      return force;
    };
    // each component is a load of its own
    const auto of_mass = [&](const std::function<Vec3(const Vec3&)>& acceleration) {
      load.kind = Load::Kind::nodal;
      const auto force = forces_of_mass(acceleration);
      for (int k = 0; k < 3; ++k) {
        Load one = load;
        one.value = Vec3::Unit(k);
        for (const auto& [i, f] : force)
          if (f[k] != 0) one.nodes.push_back(i), one.weight.push_back(f[k]);
        if (k < 2)
          out_->part<Loads>().list.push_back(std::move(one));
        else
          load = std::move(one);
      }
    };
    const auto of_acceleration = [&] {
      const Vec3 a = e.vector3("acceleration");
      if (found.body < 0 || !(found.is_region || found.n_global == 0)) return of_mass([a](const Vec3&) { return a; });
      load.kind = Load::Kind::body_force, load.body = found.body;
      load.value = out_->bodies[found.body].mass * a;
    };
    const auto centrifugal = [&] {
      if (found.body >= 0 && found.n_global == 0) throw Error(where, e.label() + ": a body has no cells", "give it the force that it has");
      const Vec3 at = e.vector3("at"), axis = direction(e, "axis");
      const double square = e.number("speed") * e.number("speed");
      of_mass([=](const Vec3& X) { return Vec3(square * (X - at - (X - at).dot(axis) * axis)); });
    };
    struct Kind {
      std::string_view name;
      std::function<void()> read;
    };
    Registry<Kind>("load", {{"force", force},
                            {"traction", traction},
                            {"pressure", pressure},
                            {"torque", torque},
                            {"acceleration", of_acceleration},
                            {"centrifugal", centrifugal}})
        .at(e.kind, e.place.text())
        .read();
    out_->part<Loads>().list.push_back(std::move(load));
  }
}

}  // namespace hilo
