// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/record/mesh_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numeric>

#include "model/region_surface.hpp"

namespace hilo {

void MeshPart::find_rows() {
  const System& s = system_;
  const LocalMesh& m = *s.mesh;
  const Comm& comm = *s.comm;
  const auto n_nodes = static_cast<std::int64_t>(s.X.size());
  std::int64_t n = m.n_nodes_global;
  node_row_ = m.node_global;
  std::vector<Facet>& facets = facets_;
  std::vector<std::int64_t>& skin = skin_node_;
  if (skin_) {
    facets = region_surface(m, comm);
    for (const Facet& f : facets)
      for (const std::int64_t node : m.mesh.facet_nodes(f)) skin.push_back(m.node_global[node]);
    for (std::int64_t c = 0; c < m.mesh.n_cells(); ++c)
      if (info(m.mesh.shape[c]).dimension < 3)
        for (const std::int64_t node : m.mesh.cell(c)) skin.push_back(m.node_global[node]);
    const auto unite = [&] {
      std::sort(skin.begin(), skin.end());
      skin.erase(std::unique(skin.begin(), skin.end()), skin.end());
    };
    unite();
    const auto all = comm.exchange(std::vector<std::vector<std::int64_t>>(comm.size, skin));
    for (const auto& list : all) skin.insert(skin.end(), list.begin(), list.end());
    unite();
    n = static_cast<std::int64_t>(skin.size());
    for (std::int64_t& row : node_row_) {
      const auto at = std::lower_bound(skin.begin(), skin.end(), row);
      row = at != skin.end() && *at == row ? at - skin.begin() : -1;
    }
  }
  std::vector<std::int64_t> mine = node_row_, everyones = m.node_global;
  for (std::int64_t i = 0; i < n_nodes; ++i)
    if (!s.node_owned[i]) mine[i] = everyones[i] = -1;
  nodes_.emplace(comm, std::move(mine), n);
  cells_.emplace(comm, m.cell_global, m.n_cells_global);
}

void MeshPart::declare() {
  const Comm& comm = *system_.comm;
  if (!nodes_) find_rows();
  for (const FieldKind& kind : field_kinds()) sources_.push_back(kind.make(system_, node_row_));
  write_followers();
  if (skin_) file_.on_store([&](Store& f) { write_array(f, "/skin/node", skin_node_, {nodes_->n_rows()}); });
  if (comm.size > 1)
    write_parts();
  else
    file_.on_store([](Store& f) { f.remove("/parts"); });  // of a run on ranks that this one goes on from
  if (skin_) write_skin(facets_);
}

void MeshPart::write_followers() {
  const System& s = system_;
  const LocalMesh& m = *s.mesh;
  const Comm& comm = *s.comm;
  const auto n_nodes = static_cast<std::int64_t>(s.X.size());
  std::vector<std::vector<std::int64_t>> followers(comm.size);  // node, body
  for (std::int64_t i = 0; i < n_nodes; ++i)
    if (s.node_owned[i] && s.follower[i] > 0 && !s.bodies[s.follower[i]].linear)
      followers[0].push_back(m.node_global[i]), followers[0].push_back(s.follower[i] - 1);
  const auto received = comm.exchange(followers);
  file_.on_store([&](Store& f) {
    std::vector<std::pair<std::int64_t, std::int32_t>> pairs;
    for (const auto& list : received)
      for (size_t k = 0; k < list.size(); k += 2) pairs.emplace_back(list[k], static_cast<std::int32_t>(list[k + 1]));
    std::sort(pairs.begin(), pairs.end());
    std::vector<std::int64_t> nodes;
    std::vector<std::int32_t> bodies;
    for (const auto& [node, body] : pairs) nodes.push_back(node), bodies.push_back(body);
    const auto count = static_cast<std::int64_t>(nodes.size());
    write_array(f, "/body/follower_node", nodes, {count});
    write_array(f, "/body/follower_body", bodies, {count});
  });
}

void MeshPart::write_parts() {
  const LocalMesh& m = *system_.mesh;
  const Comm& comm = *system_.comm;
  const std::vector<double> rank(m.cell_global.size(), comm.rank);
  const auto piece = cells_->collect(rank, 1);
  std::vector<std::vector<std::int64_t>> to(comm.size);
  for (const double r : piece) to[0].push_back(static_cast<std::int64_t>(r));
  const auto pieces = comm.exchange(to);
  file_.on_store([&](Store& f) {
    std::vector<std::int32_t> all;
    for (const auto& list : pieces) all.insert(all.end(), list.begin(), list.end());
    write_array(f, "/parts/rank", all, {m.n_cells_global});
    f.set("/parts/rank", "n_parts", static_cast<std::int64_t>(comm.size));
  });
}

void MeshPart::write_from_sources(FieldWriter& to, const Snapshot& at) const {
  for (const auto& source : sources_) {
    const auto fields = source->fields();
    if (std::any_of(fields.begin(), fields.end(), [&](const Field& field) { return to.wants(field.key); })) source->write(at, to);
  }
}

void MeshPart::write(double t, const Snapshot& at) {
  FieldWriter to(file_, wanted_, *nodes_, *cells_, !skin_);
  to.group = fmt::format("/field/{:06}", times_.size());
  write_from_sources(to, at);
  times_.push_back(t);
  file_.on_store([&](Store& f) { f.set(to.group, "t", t); });
}

void MeshPart::envelop(double t, const Snapshot& at) {
  EnvelopeWriter to(file_, *envelope_, t, *nodes_, *cells_);
  write_from_sources(to, at);
}

void MeshPart::write_envelope() {
  if (!envelope_) return;
  for (const Envelope::Of& of : envelope_->fields()) {
    file_.write_piece(*nodes_, "/envelope/" + of.name, of.most, true);
    file_.write_piece(*nodes_, "/envelope/" + of.name + "_time", of.t, true);
  }
}

void MeshPart::archive(Archive& a) {
  a("fields", times_);
  bool has = envelope_.has_value();
  a("envelope", has);  // of the run that is kept: one that goes on may do without
  if (!has && envelope_)
    throw Error("output.envelope", "the run that was kept had none: what was largest before is not known", "leave it out");
  if (!has) return;
  if (!nodes_) find_rows();
  std::vector<std::int64_t> row(static_cast<size_t>(nodes_->count()));
  std::iota(row.begin(), row.end(), nodes_->first());
  Envelope unwanted;
  (envelope_ ? *envelope_ : unwanted).archive(a, Spread(*system_.comm, std::move(row)));
}

void MeshPart::shorten(Store& f) const {
  for (const std::string& step : f.list("/field"))
    if (step >= fmt::format("{:06}", times_.size())) f.remove("/field/" + step);
  for (const std::string& step : f.list("/border"))
    if (std::isdigit(step[0]) && step >= fmt::format("{:06}", times_.size())) f.remove("/border/" + step);
  f.remove("/VTKHDF");
  f.remove("/xdmf");
  f.remove("/envelope");
}

void MeshPart::show() {
  const double began = wall_clock();
  if (began < next_xdmf_) return;
  file_.on_store([&](Store& f) {
    if (!times_.empty()) write_xdmf(f);
  });
  next_xdmf_ = wall_clock() + std::max(1.0, 50 * (wall_clock() - began));  // it lists all instants, so that it takes ever longer
}

void MeshPart::finish(bool whole) {
  file_.on_store([&](Store& f) {
    if (times_.empty()) return;
    write_xdmf(f);
    if (whole) write_vtkhdf(f);
  });
}

}  // namespace hilo
