// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/contact/untouched.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "base/joined.hpp"
#include "linear/tangent_reader.hpp"
#include "system/contact/contacts.hpp"
#include "system/loads.hpp"
#include "system/solids.hpp"

namespace hilo {
namespace {

/// Clusters of cells, then the bodies; those that cells join are one piece.
class Pieces {
 public:
  explicit Pieces(const System& system)
      : system_(system),
        n_clusters_(system.part<Solids>().clusters(cluster_of_)),
        joined_(static_cast<size_t>(n_clusters_) + system.bodies.size()),
        reached_(joined_.size(), 0.0) {}
  int size() const { return static_cast<int>(joined_.size()); }
  int of_body(int b) const { return n_clusters_ + b; }
  /// -1: of no cell.
  int of_node(int i) const {
    if (system_.follower[i] >= 0) return of_body(system_.follower[i]);
    return cluster_of_[i] < n_clusters_ ? static_cast<int>(cluster_of_[i]) : -1;
  }
  int root(int k) { return joined_.root(k); }
  void join(int a, int b) {
    if (a >= 0 && b >= 0) joined_.join(a, b);
  }
  void reach(int k) {
    if (k >= 0) reached_[k] = 1;
  }
  bool is_reached(int k) const { return reached_[k] > 0; }
  /// What each rank found, on all of them: joins, and what is reached as a mark of the whole piece.
  void agree() {
    const Comm& comm = *system_.comm;
    std::vector<std::int64_t> mine;
    for (int k = 0; k < size(); ++k)
      if (root(k) != k) mine.push_back(k), mine.push_back(root(k));
    if (comm.size > 1)
      for (const auto& list : comm.exchange(std::vector<std::vector<std::int64_t>>(comm.size, mine)))
        for (size_t i = 0; i + 1 < list.size(); i += 2) join(static_cast<int>(list[i]), static_cast<int>(list[i + 1]));
    comm.sum(reached_);
    for (int k = 0; k < size(); ++k)
      if (reached_[k] > 0) reached_[root(k)] = 1;
  }

 private:
  const System& system_;
  std::vector<std::int64_t> cluster_of_;
  int n_clusters_;
  Joined<int> joined_;
  std::vector<double> reached_;
};

/// Marks the pieces whose blocks a contribution has in its tangent: it holds them, or something beside them.
class Marks final : public TangentReader {
 public:
  Marks(const System& system, const std::vector<int>& piece_of_block, Pieces& pieces)
      : system_(system), piece_of_block_(piece_of_block), pieces_(pieces), own_(system.body_clique.begin(), system.body_clique.end()) {
    for (const Modes& m : system.modes) own_.insert(m.clique);
  }
  void add(int clique, const double*) override {
    if (own_.contains(clique)) return;
    for (const int b : system_.layout.cliques[clique])
      if (b >= 0 && b < system_.first_joint_block() && piece_of_block_[b] >= 0) pieces_.reach(piece_of_block_[b]);
  }

 private:
  const System& system_;
  const std::vector<int>& piece_of_block_;
  Pieces& pieces_;
  std::set<int> own_;  // of a body alone: its inertia, the stiffness of its modes
};

/// What is prescribed, pushed, may be met, or flies at the start.
void reach_from_outside(const System& system, Pieces& pieces) {
  for (size_t i = 0; i < system.X.size(); ++i)
    if (const auto& f = system.fixed[i]; f[0] || f[1] || f[2]) pieces.reach(pieces.of_node(static_cast<int>(i)));
  for (size_t i = 0; i < system.start_velocity.x.size(); ++i)
    if (!system.start_velocity.x[i].isZero(0)) pieces.reach(pieces.of_node(static_cast<int>(i)));
  for (size_t b = 0; b < system.bodies.size(); ++b)
    if (system.body_block[b] < 0 || !system.start_velocity.c[b].isZero(0) || !system.start_velocity.R[b].isZero(0))
      pieces.reach(pieces.of_body(static_cast<int>(b)));
  for (const Load& load : system.part<Loads>().list) {
    for (const int i : load.nodes) pieces.reach(pieces.of_node(i));
    for (const auto& facet : load.facets)
      for (const int i : facet) pieces.reach(pieces.of_node(i));
    if (load.body >= 0) pieces.reach(pieces.of_body(load.body));
  }
  const Meeting meeting = what_may_meet(system);
  for (const int i : meeting.nodes) pieces.reach(pieces.of_node(i));
  for (const int b : meeting.bodies) pieces.reach(pieces.of_body(b));
}

void join_by_cells(const System& system, Pieces& pieces) {
  for (const SolidBatch& b : system.part<Solids>().batches) {
    const auto n = static_cast<size_t>(info(b.shape).n_nodes);
    for (size_t k = 0; k < b.nodes.size(); ++k) pieces.join(pieces.of_node(b.nodes[k / n * n]), pieces.of_node(b.nodes[k]));
  }
}

}  // namespace

std::vector<std::string> untouched(const System& system) {
  Pieces pieces(system);
  join_by_cells(system, pieces);
  reach_from_outside(system, pieces);

  std::vector<int> piece_of_block(system.first_joint_block(), -1);
  for (size_t i = 0; i < system.X.size(); ++i)
    if (system.node_block[i] >= 0) piece_of_block[system.node_block[i]] = pieces.of_node(static_cast<int>(i));
  for (size_t b = 0; b < system.bodies.size(); ++b)
    if (system.body_block[b] >= 0)
      piece_of_block[system.body_block[b]] = piece_of_block[system.body_block[b] + 1] = pieces.of_body(static_cast<int>(b));
  Config zero;
  zero.x.assign(system.start.x.size(), Vec3::Zero()), zero.c.assign(system.start.c.size(), Vec3::Zero());
  zero.R.assign(system.start.R.size(), Mat3::Zero()), zero.eta.assign(system.start.eta.size(), Vec3::Zero());
  zero.Y.assign(system.start.Y.size(), Mat3::Zero());
  Stage stage = stage_at(system.start, 0);
  stage.a = &zero;
  Marks marks(system, piece_of_block, pieces);
  std::vector<Vec3> node(system.X.size(), Vec3::Zero());
  std::vector<Vec6> body(system.bodies.size(), Vec6::Zero());
  const std::vector<double> lambda(3 * system.n_joint_blocks(), 0.0);
  Residual unused;
  unused.r.assign(3 * system.n_blocks(), 0.0);
  Pass p{stage, lambda, unused, &marks, node, body, 1, true};
  for (const Equations* part : system.all<Equations>())
    if (part != &system.part<Solids>()) part->evaluate(p);
  pieces.agree();

  std::vector<double> sums(static_cast<size_t>(pieces.size()) * 4, 0.0);  // count, x
  const auto of = [&](int k) { return sums.data() + static_cast<size_t>(k) * 4; };
  for (size_t i = 0; i < system.X.size(); ++i)
    if (const int k = pieces.of_node(static_cast<int>(i)); k >= 0 && system.node_owned[i]) {
      double* s = of(pieces.root(k));
      s[0] += 1;
      for (int x = 0; x < 3; ++x) s[1 + x] += system.X[i][x];
    }
  std::set<std::array<int, 2>> regions;  // a piece, a region that it has cells of
  for (const SolidBatch& b : system.part<Solids>().batches) {
    const auto n = static_cast<size_t>(info(b.shape).n_nodes);
    for (size_t e = 0; e < b.cells.size(); ++e)
      if (const int k = pieces.of_node(b.nodes[e * n]); k >= 0) regions.insert({pieces.root(k), b.region});
  }
  system.comm->sum(sums);
  for (const auto& item : system.comm->gather(std::vector(regions.begin(), regions.end()))) regions.insert(item);
  std::map<int, std::set<std::string>> bodies;  // of each piece, but for the massless ones that joints hold
  for (size_t b = 1; b < system.bodies.size(); ++b)
    if (const Body& body = system.bodies[b]; !body.patch)
      bodies[pieces.root(pieces.of_body(static_cast<int>(b)))].insert('"' + body.name + '"');
  std::vector<std::string> out;
  int total = 0;
  for (int k = 0; k < pieces.size(); ++k) {
    if (pieces.root(k) != k || k == pieces.of_body(0)) continue;
    const double* s = of(k);
    std::set<std::string> names = bodies[k];
    if (names.empty() && s[0] == 0) continue;  // a patch
    ++total;
    if (pieces.is_reached(k)) continue;
    for (auto it = regions.lower_bound({k, 0}); it != regions.end() && (*it)[0] == k; ++it)
      names.insert('"' + system.mesh->mesh.region_name[(*it)[1]] + '"');
    const Vec3 at = s[0] > 0 ? Vec3(Vec3(s[1], s[2], s[3]) / s[0]) : system.start.c[k - pieces.of_body(0)];
    out.push_back(fmt::format("{}, about ({:.4g}, {:.4g}, {:.4g}) m", fmt::join(names, ", "), at.x(), at.y(), at.z()));
  }
  return total > 1 ? out : std::vector<std::string>{};
}

}  // namespace hilo
