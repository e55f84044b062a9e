// SPDX-License-Identifier: GPL-3.0-or-later
// [[load]] entries.
#include <fmt/format.h>

#include <functional>

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
    struct Kind {
      std::string_view name;
      std::function<void()> read;
    };
    Registry<Kind>("load", {{"force", force}, {"traction", traction}, {"pressure", pressure}, {"torque", torque}})
        .at(e.kind, e.place.text())
        .read();
    out_->part<Loads>().list.push_back(std::move(load));
  }
}

}  // namespace hilo
