#include "system/system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "system/pass.hpp"

namespace hilo {

void System::evaluate(const Stage& stage, std::span<const double> lambda, Residual& out, KktSolver* K) const {
  thread_local std::vector<Vec3> node;
  thread_local std::vector<Vec6> body;
  node.assign(X.size(), Vec3::Zero());
  body.assign(bodies.size(), Vec6::Zero());
  out.r.assign(3 * n_blocks(), 0.0);
  out.force_scale = 0, out.least_det = {}, out.finite = true;
  out.sigma = constraint_scale(stage);
  Pass p{stage, lambda, out, K, node, body, out.sigma};
  if (K) K->zero();
  add_solids(p);
  add_bodies(p);
  add_connectors(p);
  if (!stage.rates_alone) add_loads(p);
  reduce(p);
  if (!K) return;
  for (size_t i = 0; i < X.size(); ++i) {
    if (node_block[i] < 0 || !node_owned[i]) continue;
    if (fixed[i][0] || fixed[i][1] || fixed[i][2]) {
      const double d[3] = {fixed[i][0] ? out.sigma : 0, fixed[i][1] ? out.sigma : 0, fixed[i][2] ? out.sigma : 0};
      K->add_diagonal(node_block[i], d);
    }
  }
  for (const auto& [n, m] : point_masses) {
    if (node_block[n] >= 0) {
      const double f = m * stage.mass_slope;
      const double d[3] = {fixed[n][0] ? 0 : f, fixed[n][1] ? 0 : f, fixed[n][2] ? 0 : f};
      K->add_diagonal(node_block[n], d);
    } else if (const int b = follower[n]; body_block[b] >= 0) {
      const double f = m * stage.mass_slope * (stage.tempo ? stage.tempo[b] * stage.tempo[b] : 1);
      const Mat3 left = skew(stage.left->x[n] - stage.left->c[b]), right = skew(stage.end->x[n] - stage.end->c[b]);
      Eigen::Matrix<double, 6, 6, Eigen::RowMajor> M;
      M << f * Mat3::Identity(), -f * right, f * left, -f * left * right;
      K->add(body_clique(b), M.data());
    }
  }
}

void System::mask_fixed(std::span<double> r) const {
  for (size_t i = 0; i < X.size(); ++i)
    for (int k = 0; k < 3; ++k)
      if (node_block[i] >= 0 && fixed[i][k]) r[3 * node_block[i] + k] = 0;
}

double System::constraint_scale(const Stage& s) const {
  const double inertia = s.mass_slope * mass / std::max<double>(1, static_cast<double>(map.n_global));
  return std::max(inertia, s.mass_slope > 0 ? 1e-300 : stiffness);
}

void System::forces(const Stage& stage, std::span<const double> lambda, Forces& out) const {
  Residual unused;
  unused.r.assign(3 * n_blocks(), 0.0);
  out.node.assign(X.size(), Vec3::Zero());
  out.body.assign(bodies.size(), Vec6::Zero());
  Pass p{stage, lambda, unused, nullptr, out.node, out.body, 1};
  add_solids(p);
  add_bodies(p);
  add_connectors(p);
  add_loads(p);
  reduce(p);
  if (comm->size > 1) {
    std::vector<double> all(6 * bodies.size());
    for (size_t b = 0; b < bodies.size(); ++b)
      for (int k = 0; k < 6; ++k) all[6 * b + k] = out.body[b][k];
    comm->sum(all);
    for (size_t b = 0; b < bodies.size(); ++b)
      for (int k = 0; k < 6; ++k) out.body[b][k] = all[6 * b + k];
    // nodes: only their sum over ranks is a force; the sums below add every rank's share, so ownership is not asked
  }
}

void System::move(Config& q, std::span<const double> z) const {
  for (size_t i = 0; i < X.size(); ++i)
    if (node_block[i] >= 0) q.x[i] += Eigen::Map<const Vec3>(z.data() + 3 * node_block[i]);
  for (size_t b = 0; b < bodies.size(); ++b) {
    if (body_block[b] < 0) continue;
    q.c[b] += Eigen::Map<const Vec3>(z.data() + 3 * body_block[b]);
    q.R[b] = cayley(Eigen::Map<const Vec3>(z.data() + 3 * body_block[b] + 3)) * q.R[b];
  }
  follow(q);
}

void System::follow(Config& q) const {
  for (size_t i = 0; i < X.size(); ++i)
    if (const int b = follower[i]; b >= 0) q.x[i] = q.c[b] + q.R[b] * (X[i] - bodies[b].Xc);
}

System::Violation System::violation(const Config& q, double t, double factor) const {
  Violation out;
  double g[max_rows];
  for (size_t i = 0; i < joints.size(); ++i) {
    const Connector& j = joints[i];
    j.row_values(j.values(q), g);
    if (j.drive.row >= 0) g[j.drive.row] -= j.drive.law.at(t, t, factor).value;
    for (int r = 0; r < j.n_rows(); ++r) {
      double& worst = j.active[r] ? out.kept : out.dropped;
      if (const double x = std::isnan(g[r]) ? 1e300 : std::abs(g[r]); x > worst)
        worst = x, (j.active[r] ? out.kept_joint : out.dropped_joint) = static_cast<int>(i);
    }
  }
  if (comm->size == 1) return out;
  const auto share = [&](double& worst, int& joint) {
    const double own = worst;
    worst = comm->max(own);
    joint = static_cast<int>(comm->max(own == worst ? joint : -1));
  };
  share(out.kept, out.kept_joint), share(out.dropped, out.dropped_joint);
  return out;
}

std::string System::fault(const Config& q) const {
  double found = -1;
  for (size_t j = 0; j < joints.size(); ++j)
    if (joints[j].rows && !joints[j].rows->fault(joints[j].values(q)).empty()) found = static_cast<double>(j);
  found = comm->max(found);
  if (found < 0) return "";
  const Connector& c = joints[static_cast<size_t>(found)];
  return "joint \"" + c.name + "\" " + c.rows->fault(c.values(q));
}

bool System::has_damping() const {
  return std::any_of(batches.begin(), batches.end(), [](const SolidBatch& b) { return b.beta > 0; }) || !springs.empty();
}

void System::commit(const Config& q, const Config* v) {
  Config ahead, behind;
  const double tau = 1e-3;  // [s]; measures are of degree two, any tau gives the exact rate
  if (v && std::any_of(springs.begin(), springs.end(), [](const Connector& s) { return s.law->needs_rate(); })) {
    ahead = behind = q;
    for (size_t i = 0; i < q.x.size(); ++i) ahead.x[i] += tau * v->x[i], behind.x[i] -= tau * v->x[i];
    for (size_t b = 0; b < q.c.size(); ++b) {
      ahead.c[b] += tau * v->c[b], behind.c[b] -= tau * v->c[b];
      ahead.R[b] += tau * v->R[b], behind.R[b] -= tau * v->R[b];
    }
  }
  for (Connector& s : springs) {
    SpringLaw::Values rate{};
    if (!ahead.c.empty() && s.law->needs_rate()) {
      const auto e1 = s.values(ahead), e0 = s.values(behind);
      for (size_t m = 0; m < s.measures.size(); ++m) rate[m] = (e1[m] - e0[m]) / (2 * tau);
    }
    s.law->commit(s.values(q), rate);
  }
  for (Connector& j : joints)
    if (j.rows) j.rows->commit(j.values(q));
  watch_strain(q);
}

void System::number() {
  region_nodes.assign(mesh ? mesh->mesh.region_name.size() : 0, {});  // every rank has an entry for every region
  std::vector<std::int64_t> region(X.size(),
                                   std::numeric_limits<std::int64_t>::max());  // the lowest, the same on all ranks that share a node
  for (const SolidBatch& b : batches)
    for (int i : b.nodes) region[i] = std::min<std::int64_t>(region[i], b.region);
  lowest_over_ranks(region);
  for (size_t i = 0; i < X.size(); ++i)
    if (follower[i] < 0 && region[i] < static_cast<std::int64_t>(region_nodes.size()))
      region_nodes[region[i]].push_back(static_cast<int>(i));
  // blocks: nodes, then bodies, then multipliers
  const int n = static_cast<int>(X.size());
  node_block.assign(n, -1);
  body_block.assign(bodies.size(), -1);
  int next = 0;
  for (int i = 0; i < n; ++i)
    if (follower[i] < 0) node_block[i] = next++;
  const int n_node_blocks = next;
  for (size_t b = 0; b < bodies.size(); ++b)
    if (bodies[b].free()) body_block[b] = next, next += 2;
  joint_block.clear();
  for (const Connector& j : joints) joint_block.push_back(next), next += (j.n_rows() + 2) / 3;
  number_globally(n_node_blocks, next);

  moves_ = false;
  for (Motion& m : motions) {
    moves_ = moves_ || m.moving;
    for (int i = 0; i < n && m.body >= 0; ++i)
      if (follower[i] == m.body) m.nodes.push_back(i);
  }

  cliques = Cliques{};
  std::vector<int> list;
  const auto blocks_of = [&](std::span<const int> nodes) {
    list.clear();
    for (int node : nodes)
      if (follower[node] < 0) list.push_back(node_block[node]);
    for (int node : nodes) {
      const int b = follower[node];
      if (b >= 0 && body_block[b] >= 0 && std::find(list.begin(), list.end(), body_block[b]) == list.end())
        list.push_back(body_block[b]), list.push_back(body_block[b] + 1);
    }
    return std::span<const int>(list);
  };
  for (SolidBatch& b : batches) {
    const int nodes = info(b.shape).n_nodes;
    b.first_clique = cliques.size();
    for (size_t e = 0; e < b.cells.size(); ++e) cliques.add(blocks_of({b.nodes.data() + e * nodes, static_cast<size_t>(nodes)}));
  }
  for (Load& l : loads) {
    l.cliques.clear();
    for (const auto& facet : l.facets) l.cliques.push_back(cliques.add(blocks_of(facet)));
  }
  body_clique_.assign(bodies.size(), -1);
  for (size_t b = 0; b < bodies.size(); ++b)
    if (body_block[b] >= 0) {
      const int blocks[2] = {body_block[b], body_block[b] + 1};
      body_clique_[b] = cliques.add(blocks);
    }
  const auto connector_clique = [&](const Connector& c, int first_row_block) {
    list.clear();
    for (const Carrier& end : c.ends()) {
      if (end.body >= 0 && body_block[end.body] >= 0) list.push_back(body_block[end.body]), list.push_back(body_block[end.body] + 1);
      if (end.body < 0 && end.node >= 0) list.push_back(node_block[end.node]);
    }
    const int rows = c.load_joint >= 0 ? joints[c.load_joint].n_rows() : c.n_rows();
    for (int k = 0; k < (rows + 2) / 3; ++k) list.push_back(first_row_block + k);
    return cliques.add(list);
  };
  const auto owns = [&](const Connector& c, size_t index) {
    for (const Carrier& end : c.ends())
      if (end.body < 0) return end.node >= 0 && node_owned[end.node] != 0;
    return static_cast<int>(index) % comm->size == comm->rank;
  };
  joint_clique_.clear(), spring_clique_.clear(), owns_joint_.clear(), owns_spring_.clear();
  for (size_t i = 0; i < joints.size(); ++i) {
    joint_clique_.push_back(connector_clique(joints[i], joint_block[i]));
    owns_joint_.push_back(owns(joints[i], i));
  }
  for (size_t i = 0; i < springs.size(); ++i) {
    spring_clique_.push_back(connector_clique(springs[i], springs[i].load_joint >= 0 ? joint_block[springs[i].load_joint] : 0));
    owns_spring_.push_back(owns(springs[i], i));
  }
}

void System::lowest_over_ranks(std::vector<std::int64_t>& value) const {
  if (comm->size == 1) return;
  std::vector<std::vector<std::int64_t>> tell(comm->size), ask(comm->size);
  for (size_t i = 0; i < X.size(); ++i) {
    const std::int64_t row = mesh->node_global[i];
    tell[row % comm->size].push_back(row), tell[row % comm->size].push_back(value[i]);
    ask[row % comm->size].push_back(row);
  }
  std::map<std::int64_t, std::int64_t> lowest;
  for (const auto& list : comm->exchange(tell))
    for (size_t k = 0; k + 1 < list.size(); k += 2) {
      const auto [it, fresh] = lowest.try_emplace(list[k], list[k + 1]);
      if (!fresh) it->second = std::min(it->second, list[k + 1]);
    }
  auto asked = comm->exchange(ask);
  for (auto& list : asked)
    for (auto& row : list) row = lowest.at(row);
  const auto answers = comm->exchange(asked);
  std::vector<size_t> cursor(comm->size, 0);
  for (size_t i = 0; i < X.size(); ++i) {
    const auto keeper = mesh->node_global[i] % comm->size;
    value[i] = answers[keeper][cursor[keeper]++];
  }
}

void System::number_globally(int n_node_blocks, int n_local) {
  map = BlockMap{};
  map.X.assign(3 * static_cast<size_t>(n_local), 0.0);
  for (size_t i = 0; i < X.size(); ++i)
    if (node_block[i] >= 0)
      for (int k = 0; k < 3; ++k) map.X[3 * node_block[i] + k] = X[i][k];
  map.global.resize(n_local);
  if (comm->size == 1) {
    for (int i = 0; i < n_local; ++i) map.global[i] = i;
    map.n_owned = map.n_global = n_local;
    map.first_dense = n_node_blocks;
    return;
  }
  // owned nodes are numbered rank after rank; bodies and multipliers come last and belong to the last rank
  std::int64_t owned = 0;
  for (size_t i = 0; i < X.size(); ++i) owned += node_block[i] >= 0 && node_owned[i];
  std::vector<double> counts(comm->size, 0.0);
  counts[comm->rank] = static_cast<double>(owned);
  comm->sum(counts);
  std::int64_t before = 0, total = 0;
  for (int r = 0; r < comm->size; ++r) {
    if (r < comm->rank) before += static_cast<std::int64_t>(counts[r]);
    total += static_cast<std::int64_t>(counts[r]);
  }
  // shared nodes ask for their number at the rank that keeps the row of the file (row modulo ranks)
  std::vector<std::vector<std::int64_t>> tell(comm->size), ask(comm->size);
  std::int64_t next = before;
  for (size_t i = 0; i < X.size(); ++i) {
    if (node_block[i] < 0) continue;
    const std::int64_t row = mesh->node_global[i];
    const int keeper = static_cast<int>(row % comm->size);
    if (node_owned[i]) {
      map.global[node_block[i]] = next;
      tell[keeper].push_back(row), tell[keeper].push_back(next);
      ++next;
    } else {
      ask[keeper].push_back(row);
    }
  }
  std::map<std::int64_t, std::int64_t> number_of_row;
  for (const auto& list : comm->exchange(tell))
    for (size_t k = 0; k + 1 < list.size(); k += 2) number_of_row[list[k]] = list[k + 1];
  auto asked = comm->exchange(ask);
  for (auto& list : asked)
    for (auto& row : list) row = number_of_row.at(row);
  const auto answers = comm->exchange(asked);
  std::vector<size_t> cursor(comm->size, 0);
  for (size_t i = 0; i < X.size(); ++i)
    if (node_block[i] >= 0 && !node_owned[i]) {
      const int keeper = static_cast<int>(mesh->node_global[i] % comm->size);
      map.global[node_block[i]] = answers[keeper][cursor[keeper]++];
    }
  for (int i = n_node_blocks; i < n_local; ++i) map.global[i] = total + (i - n_node_blocks);
  map.first = before;
  map.n_owned = owned;
  map.first_dense = total;
  map.n_global = total + (n_local - n_node_blocks);
  if (comm->rank == comm->size - 1) map.n_owned += n_local - n_node_blocks;
}

}  // namespace hilo
