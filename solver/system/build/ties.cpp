// SPDX-License-Identifier: GPL-3.0-or-later
// [[tie]] entries: surfaces whose meshes do not match.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "model/region_surface.hpp"
#include "system/build/builder.hpp"
#include "system/build/mortar.hpp"
#include "system/reduction/reduction.hpp"
#include "system/tied_surfaces.hpp"
#include "system/welds.hpp"

namespace hilo {
namespace {

std::string place(const Vec3& x) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", x[0], x[1], x[2]); }

}  // namespace

std::vector<Facet> Builder::facets_to_tie(const Entry& e, std::string_view key) {
  const std::string& name = e.text(key);
  const Mesh& mesh = mesh_->mesh;
  if (const auto set = mesh.facet_sets.find(name); set != mesh.facet_sets.end()) return set->second;
  const int region = mesh.find_region(name);
  if (region < 0) {
    const std::vector<std::string> names = mesh.all_names();
    if (std::find(names.begin(), names.end(), name) == names.end())
      e.refuse(key, fmt::format("no region or set of facets \"{}\"", name), suggest(name, names));
    e.refuse(key, fmt::format("\"{}\" has no facets", name), "name a region, a 2-D group or *SURFACE of faces");
  }
  std::vector<Facet> facets = outer_surface(*mesh_, comm_);
  std::erase_if(facets, [&](const Facet& f) { return mesh.region[f.cell] != region; });
  return facets;
}

std::vector<MortarFacet> Builder::tied_facets(const Entry& e, std::string_view key, const std::vector<PairFacet>& facets) const {
  const std::string& name = e.text(key);
  std::vector<MortarFacet> out;
  for (const PairFacet& f : facets) {
    const Region& region = regions_[f.region];
    if (region.fidelity == Fidelity::linear && !region.shapes.empty())
      e.refuse(key, fmt::format("region \"{}\" has shapes of a file: its nodes cannot each follow another surface", region.name),
               fmt::format("leave shapes out, or hilo-tag --nonlinear '{}'", region.name));
    if (region.fidelity == Fidelity::rigid && key == "b")
      e.refuse(key, fmt::format("region \"{}\" is rigid, and so is the other side", region.name), "weld rigid parts by a joint");
    out.push_back({f.n, f.node});
  }
  if (out.empty()) e.refuse(key, fmt::format("\"{}\" has no facets", name), "name a region of solid cells or a set of their facets");
  return out;
}

/// Whether one side is of linear regions that move by smooth functions, and the other of cells: nodes of cells follow what is smooth.
bool Builder::is_smoother(const std::vector<PairFacet>& one, const std::vector<PairFacet>& other) const {
  const auto all = [&](const std::vector<PairFacet>& facets, Fidelity level) {
    return std::ranges::all_of(facets, [&](const PairFacet& f) { return regions_[f.region].fidelity == level; });
  };
  std::set<int> nodes;
  for (const PairFacet& f : one) nodes.insert(f.node.begin(), f.node.begin() + f.n);
  return nodes.size() > most_free && all(one, Fidelity::linear) && all(other, Fidelity::nonlinear);
}

/// The rows of a tie, on rank 0.
void Builder::find_tie(const Entry& e, const std::array<std::vector<PairFacet>, 2>& facets, SurfaceTie& tie) {
  const std::vector<MortarFacet> a = tied_facets(e, "a", facets[0]), b = tied_facets(e, "b", facets[1]);
  const Mesh& mesh = mesh_->mesh;
  std::vector<int> nodes[2];
  for (const MortarFacet& f : a) nodes[0].insert(nodes[0].end(), f.node.begin(), f.node.begin() + f.n);
  for (const MortarFacet& f : b) nodes[1].insert(nodes[1].end(), f.node.begin(), f.node.begin() + f.n);
  std::sort(nodes[0].begin(), nodes[0].end());
  for (const int i : nodes[1])
    if (std::binary_search(nodes[0].begin(), nodes[0].end(), i))
      e.refuse("b", fmt::format("both surfaces have node {}: it is tied already", mesh.node_id[i]),
               "name the facets that are to be tied as two sets");
  const Mortar found = mortar(mesh.X, b, a, e.given("gap") ? e.number("gap") : -1);
  const std::string limit = e.given("gap") ? "" : ", a twentieth of a facet";
  if (found.open_node >= 0 && !e.given("gap"))
    e.refuse("b",
             fmt::format("node {} at {} is {:.3g} m off \"{}\", more than {:.3g} m{}", mesh.node_id[found.open_node],
                         place(mesh.X[found.open_node]), found.open, e.text("a"), found.open_limit, limit),
             fmt::format("move the parts together, or give gap = {:.3g}", 1.05 * found.open / to_si("m", scene_.units)));
  if (found.twice_node >= 0)
    e.refuse("b",
             fmt::format("at node {}, {}, a facet of b faces \"{}\" in two layers", mesh.node_id[found.twice_node],
                         place(mesh.X[found.twice_node]), e.text("a")),
             "name the facets that are to be tied as a set, or give a smaller gap");
  if (found.rows.empty())
    e.refuse("b",
             fmt::format("no facet of \"{}\" faces one of \"{}\" within {}", e.text("b"), e.text("a"),
                         e.given("gap") ? fmt::format("{:g} m", e.number("gap")) : std::string("a twentieth of its size")),
             "move the parts together, or give gap");
  tie.n_nodes = found.n_nodes, tie.n_tied = static_cast<int>(found.rows.size()), tie.covered = found.covered;
  for (const MortarFacet& f : b)
    for (int k = 0; k < f.n; ++k)
      for (int l = 0; l < f.n; ++l)
        if (k != l) tie.beside[f.node[k]].insert(f.node[l]);
  for (const auto& [i, others] : tie.beside) tie.b_nodes.push_back(i);
  for (const MortarRow& row : found.rows) {
    TiedRow& to = tie.rows.emplace_back();
    to.node = row.node, to.term = row.term, to.own = row.own;
    tie.tied.push_back(row.node);
  }
  mortar_.push_back(found.rows);
  constexpr double hinge = 0.05;
  if (const TurnHeld turn = least_held_turn(found, mesh.X); turn.share < hinge)
    warn(e.place.text(),
         fmt::format("{}: a hinge about {}: {} nodes of \"{}\" have too little of \"{}\" before them to hold its turn ({}mesh \"{}\" finer "
                     "there)",
                     e.label(), place((100 * turn.axis).array().round() / 100 + 0.), found.rows.size(), e.text("b"), e.text("a"),
                     tie.turned ? "" : "swap a and b, or ", e.text("b")));
  if (mesh.facet_sets.contains(e.text("b")) && found.rows.size() < static_cast<size_t>(found.n_nodes))
    warn(e.place.text(), fmt::format("{}: {} of {} nodes of \"{}\" face nothing of \"{}\" and stay free", e.label(),
                                     static_cast<size_t>(found.n_nodes) - found.rows.size(), found.n_nodes, e.text("b"), e.text("a")));
}

/// Before anything is integrated: nodes of b are moved onto a.
void Builder::close_ties() {
  std::vector<SurfaceTie>& list = out_->part<TiedSurfaces>().list;
  for (Entry e : scene_.entries("tie")) {
    if (!mesh_) e.refuse("a", "the scene has no mesh: nothing to tie", "name two regions or sets of facets of a mesh");
    if (e.text("a") == e.text("b")) e.refuse("b", "a surface is not tied to itself");
    tied_.emplace_back(e.place.text(), e.label());
    SurfaceTie& tie = list.emplace_back();
    tie.name = e.name;
    std::vector<Facet> of_a = facets_to_tie(e, "a"), of_b = facets_to_tie(e, "b");
    const auto bends = [&](const std::vector<Facet>& side) {
      const auto is_rigid = [&](const Facet& f) { return regions_[mesh_->mesh.region[f.cell]].fidelity == Fidelity::rigid; };
      return comm_.max(std::ranges::all_of(side, is_rigid) ? 0 : 1) > 0;
    };
    const bool a_bends = bends(of_a), b_bends = bends(of_b);
    if (a_bends && !b_bends && comm_.max(of_b.empty() ? 0 : 1) > 0) {  // nodes follow what is rigid
      tie.turned = true;
      std::swap(of_a, of_b), std::swap(e.values.at("a"), e.values.at("b"));
    }
    std::array<std::vector<PairFacet>, 2> facets{on_first_rank(of_a), on_first_rank(of_b)};
    comm_.on_first([&] {
      if (!tie.turned && is_smoother(facets[1], facets[0])) {
        tie.turned = true;
        std::swap(facets[0], facets[1]), std::swap(e.values.at("a"), e.values.at("b"));
      }
      find_tie(e, facets, tie);
    });
  }
  if (list.empty()) return;
  std::vector<Vec3>& X = mesh_->mesh.X;
  struct Moved {
    std::int64_t row, tie;
    double x[3];
  };
  std::vector<Moved> moved;
  comm_.on_first([&] {  // a tie may move nodes that another one follows: again until all are closed
    const std::vector<Vec3> before = X;
    const auto open = [&](size_t k) {
      double worst = 0;
      for (const MortarRow& row : mortar_[k]) {
        Vec3 gap = Vec3::Zero();
        for (const auto& [i, w] : row.term) gap += w * X[i];
        worst = std::max(worst, gap.norm());
      }
      return worst;
    };
    for (size_t pass = 0; pass < 2 + list.size(); ++pass)
      for (size_t k = 0; k < list.size(); ++k)
        if (open(k) > 0) close_gaps(mortar_[k], X);
    double farthest = 0;  // from the origin, whose round-off gaps have
    for (const std::vector<MortarRow>& rows : mortar_)
      for (const MortarRow& row : rows)
        for (const auto& [i, w] : row.term) farthest = std::max(farthest, before[i].cwiseAbs().maxCoeff());
    for (size_t k = 0; k < list.size(); ++k) {
      if (const double gap = open(k); !(gap < 1e-12 * mesh_->length + 1e-14 * farthest))
        throw Error(tied_[k].first, fmt::format("{}: {:.3g} m stay open, as another tie moves the same nodes", tied_[k].second, gap),
                    "tie each node once, or mesh the surfaces so that they fit");
      for (const MortarRow& row : mortar_[k]) {
        list[k].largest_move = std::max(list[k].largest_move, (X[row.node] - before[row.node]).norm());
        const Vec3& x = X[row.node];
        if (x != before[row.node]) moved.push_back({mesh_->node_global[row.node], static_cast<std::int64_t>(k), {x[0], x[1], x[2]}});
      }
      if (list[k].largest_move > 1e-6 * mesh_->length)
        warn(tied_[k].first, fmt::format("{}: nodes of b are moved by up to {:.3g} m onto a", tied_[k].second, list[k].largest_move));
    }
  });
  std::map<std::int64_t, const Moved*> now;  // by row
  moved = comm_.of_first(moved);
  for (const Moved& m : moved) now.try_emplace(m.row, &m);
  std::vector<std::int64_t> by(X.size(), -1);  // the tie that moves a node
  for (size_t i = 0; i < X.size(); ++i)
    if (const auto it = now.find(mesh_->node_global[i]); it != now.end())
      X[i] = Eigen::Map<const Vec3>(it->second->x), by[i] = it->second->tie;
  const Mesh& mesh = mesh_->mesh;
  comm_.together([&] {
    for (std::int64_t cell = 0; cell < mesh.n_cells(); ++cell) {
      const auto of = mesh.cell(cell);
      const auto mover = std::ranges::find_if(of, [&](std::int64_t i) { return by[i] >= 0; });
      if (mover == of.end() || info(mesh.shape[cell]).dimension != 3 || quality(mesh, cell).scaled_jacobian > 0) continue;
      const auto& [place, label] = tied_[static_cast<size_t>(by[*mover])];
      throw Error(place, fmt::format("{}: nodes that are moved onto the other surface turn cell {} inside out", label, mesh.cell_id[cell]),
                  "give a smaller gap, or move the parts together");
    }
  });
  out_->X = X;
  out_->start.x.assign(X.begin(), X.begin() + n_active_);
}

/// Nodes of linear regions that are tied, as interfaces of their modes: of each tie, those of both sides, where no weld and no tie before
/// has them.
void Builder::group_tied_nodes(TiedSurfaces& ties) const {
  for (const Weld& w : out_->part<Welds>().list)
    for (const int i : w.nodes) ties.welded_to[i] = w.body;
  for (const SurfaceTie& tie : ties.list) {
    std::map<std::pair<bool, int>, std::map<std::int64_t, int>> found;  // by side and body: nodes in the order of the mesh
    for (const TiedRow& row : tie.rows)
      for (const auto& [i, w] : row.term)
        if (const int b = out_->follower[i]; b >= 0 && out_->bodies[b].linear && !ties.welded_to.contains(i) && !ties.group_of.contains(i))
          found[{std::ranges::binary_search(tie.b_nodes, i), b}][mesh_->node_global[i]] = i;
    for (const auto& [key, nodes] : found) {
      TiedGroup& group = ties.groups.emplace_back();
      group.name = fmt::format("tie \"{}\" side {}", tie.name, key.first != tie.turned ? "b" : "a"), group.body = key.second;
      std::vector<Vec3> at;
      for (const auto& [row, i] : nodes) {
        group.nodes.push_back(i), at.push_back(out_->X[i]);
        ties.group_of[i] = static_cast<int>(ties.groups.size()) - 1;
      }
      if (at.size() > most_free) group.functions = smooth_functions(at);
    }
  }
}

void Builder::add_ties() {
  TiedSurfaces& ties = out_->part<TiedSurfaces>();
  if (ties.list.empty()) return;
  comm_.on_first([&] {
    group_tied_nodes(ties);
    ties.choose_rows();
    for (size_t k = 0; k < ties.list.size(); ++k) {
      const SurfaceTie& tie = ties.list[k];
      std::set<int> bodies;
      for (const TiedRow& row : tie.rows)
        for (const auto& [i, w] : row.term) bodies.insert(out_->follower[i]);
      if (bodies.size() == 1 && *bodies.begin() >= 0 && !out_->bodies[*bodies.begin()].linear)
        throw Error(tied_[k].first, fmt::format("{}: both sides are of one body", tied_[k].second));
      if (std::ranges::none_of(tie.rows, [](const TiedRow& row) { return row.on[0] || row.on[1] || row.on[2]; }))
        warn(tied_[k].first, fmt::format("{}: it does nothing, both sides are held or tied already", tied_[k].second));
    }
  });
  ties.tell_rows();
}

}  // namespace hilo
