// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/tied_surfaces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/table.hpp"
#include "linear/sparse_qr.hpp"
#include "system/collocation.hpp"
#include "system/mode_forces.hpp"
#include "system/system.hpp"

namespace hilo {
namespace {

// What is held must leave so much of a row that stays: less would hold a node of a by a small weight.
constexpr double least_left = 0.05;
constexpr double independent = 1e-3;  // what other rows must leave
constexpr double round_off = 1e-9;

}  // namespace

template <class Use>
void TiedSurfaces::each(Use&& use) const {
  size_t k = 0;
  for (const SurfaceTie& tie : list)
    for (const TiedRow& row : tie.rows) use(tie, row, k++);
}

std::string TiedSurfaces::count() const { return list.empty() ? "" : fmt::format("{} ties", list.size()); }

TiedSurfaces::Place TiedSurfaces::place_of(const TiedRow& row) const {
  Place out{-1, -1, {}, {}};
  std::map<int, OnBody> bodies;
  for (const auto& [i, w] : row.term) {
    const int b = points_.follower[i];
    if (b < 0) {
      out.nodes.emplace_back(i, w);
    } else if (const auto shapes = points_.shapes_at(i); points_.bodies[b].free() || !shapes.empty()) {
      OnBody& on = bodies.try_emplace(b, OnBody{b, 0, Vec3::Zero(), {}, {}}).first->second;
      on.weight += w, on.arm += w * (points_.X[i] - points_.bodies[b].Xc);
      on.shapes.resize(shapes.size(), Vec3::Zero());
      for (size_t j = 0; j < shapes.size(); ++j) on.shapes[j] += w * shapes[j];
      if (!shapes.empty()) on.nodes.emplace_back(i, w);
    }
  }
  for (const auto& [b, on] : bodies) out.bodies.push_back(on);
  return out;
}

void TiedSurfaces::number(Layout& layout) {
  place_.clear();
  each([&](const SurfaceTie&, const TiedRow& row, size_t k) {
    Place& at = place_.emplace_back(place_of(row));
    at.block = layout.add_rows(static_cast<int>(k), 1);
    if (row.term.empty()) return;
    std::vector<int> blocks;
    for (const auto& [i, w] : at.nodes) blocks.push_back(points_.node_block[i]);
    for (const OnBody& on : at.bodies) {
      if (const int block = points_.body_block[on.body]; block >= 0) blocks.push_back(block), blocks.push_back(block + 1);
      for (int j = 0; j < static_cast<int>(on.shapes.size()) / 3; ++j) blocks.push_back(points_.modes[points_.modes_of[on.body]].block + j);
    }
    blocks.push_back(at.block);
    at.clique = layout.cliques.add(blocks);
  });
}

std::string TiedSurfaces::owner(int block) const {
  std::string out;
  if (!place_.empty() && block >= place_.front().block && block <= place_.back().block)
    each([&](const SurfaceTie& tie, const TiedRow& row, size_t k) {
      if (place_[k].block == block)
        out = row.number < 0 ? fmt::format("tie \"{}\"", tie.name) : fmt::format("tie \"{}\", at node {}", tie.name, row.number);
    });
  return out;
}

Vec3 TiedSurfaces::value(const TiedRow& row, const Config& q) const {
  Vec3 out = Vec3::Zero();
  for (const auto& [i, w] : row.term) out += w * q.x[i];
  for (int c = 0; c < 3; ++c)
    if (!row.on[c]) out[c] = 0;
  return out;
}

void TiedSurfaces::evaluate(Pass& p) const {
  const Stage& s = p.s;
  if (s.rates_alone) return;
  std::vector<double> dense;
  each([&](const SurfaceTie&, const TiedRow& row, size_t k) {
    if (row.term.empty()) return;
    const Place& at = place_[k];
    Vec3 g = value(row, *s.end);
    if (s.step) g = value(row, *s.w1) + value(row, *s.step->start) - value(row, *s.w0);  // increments, of which the sum is g(q1)
    const double* lambda = p.lambda.data() + 3 * (at.block - points_.first_joint_block());
    Vec3 f = Vec3::Zero();
    for (int c = 0; c < 3; ++c)
      if (row.on[c]) f[c] = lambda[c], p.out.r[3 * at.block + c] = p.sigma * g[c];
    for (const auto& [i, w] : row.term) p.node[i] += w * f;
    p.scale(f.norm());
    if (!p.K) return;
    const size_t n_nodes = at.nodes.size();
    size_t first = 3 * n_nodes;
    for (const OnBody& on : at.bodies) first += (points_.body_block[on.body] < 0 ? 0 : 6) + on.shapes.size();
    const size_t width = first + 3;
    dense.assign(width * width, 0.0);
    const auto put = [&](size_t unknown, int c, double left, double right) {
      dense[unknown * width + first + c] = p.sigma * left, dense[(first + c) * width + unknown] = p.sigma * right;
    };
    for (int c = 0; c < 3; ++c) {
      if (!row.on[c]) {
        dense[(first + c) * width + first + c] = p.sigma;
        continue;
      }
      for (size_t a = 0; a < n_nodes; ++a)
        if (!points_.fixed[at.nodes[a].first][c]) put(3 * a + c, c, at.nodes[a].second, at.nodes[a].second);
      size_t base = 3 * n_nodes;
      for (const OnBody& on : at.bodies) {
        const auto arm = [&](const Config& q) {
          Vec3 out = q.R[on.body] * on.arm;
          if (on.nodes.empty()) return out;
          out = -on.weight * q.c[on.body];
          for (const auto& [i, w] : on.nodes) out += w * q.x[i];
          return out;
        };
        if (points_.body_block[on.body] >= 0) {
          put(base + c, c, on.weight, on.weight);
          const Mat3 left = -skew(arm(*s.left)), right = -skew(arm(*s.end));
          for (int j = 0; j < 3; ++j) put(base + 3 + j, c, left(c, j), right(c, j));
          base += 6;
        }
        if (on.shapes.empty()) continue;
        const Vec3 left = left_turn(s, on.body).row(c), right = s.end->R[on.body].row(c);
        for (const Vec3& shape : on.shapes) put(base++, c, left.dot(shape), right.dot(shape));
      }
    }
    p.K->add(at.clique, dense.data());
  });
}

void TiedSurfaces::look_at_rows(const Config& q, double, double, Violation& worst) const {
  each([&](const SurfaceTie&, const TiedRow& row, size_t k) {
    Vec3 g = Vec3::Zero();
    for (const auto& [i, w] : row.term) g += w * q.x[i];
    for (int c = 0; c < 3; ++c) {
      if (!row.on[c] && !row.implied[c]) continue;
      double& most = row.on[c] ? worst.kept : worst.dropped;
      if (const double x = std::isnan(g[c]) ? 1e300 : std::abs(g[c]); x > most)
        most = x, (row.on[c] ? worst.kept_block : worst.dropped_block) = place_[k].block - points_.first_joint_block();
    }
  });
}

void TiedSurfaces::add_row_rates(const Rates& at, std::vector<double>& rate, std::vector<double>* acceleration) const {
  each([&](const SurfaceTie&, const TiedRow& row, size_t k) {
    const int base = 3 * (place_[k].block - points_.first_joint_block());
    Eigen::Map<Vec3>(rate.data() + base) = value(row, at.v);
    if (acceleration && at.a) Eigen::Map<Vec3>(acceleration->data() + base) = value(row, *at.a);
  });
}

void TiedSurfaces::mark_rows(std::vector<char>& on) const {
  each([&](const SurfaceTie&, const TiedRow& row, size_t k) {
    std::copy(row.on.begin(), row.on.end(), on.begin() + 3 * (place_[k].block - points_.first_joint_block()));
  });
}

std::vector<Output> TiedSurfaces::outputs() const {
  std::vector<Output> out;
  for (const SurfaceTie& tie : list) out.push_back({.group = "tie", .name = tie.name, .n_mid = 6});
  return out;
}

void TiedSurfaces::observe(const Sight& at) {
  if (!at.step || list.empty()) return;
  const Config& q = *at.step->s.left;
  struct Sum {
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();  // moment about the origin
  };
  std::map<const SurfaceTie*, Sum> sums;
  each([&](const SurfaceTie& tie, const TiedRow& row, size_t k) {
    if (row.term.empty()) return;
    Sum& sum = sums[&tie];
    const double* lambda = at.step->lambda.data() + 3 * (place_[k].block - points_.first_joint_block());
    Vec3 f = Vec3::Zero();
    for (int c = 0; c < 3; ++c)
      if (row.on[c]) f[c] = -lambda[c];
    for (const auto& [i, w] : row.term)
      if (std::ranges::binary_search(tie.b_nodes, i)) sum.force += w * f, sum.moment += w * q.x[i].cross(f);
  });
  std::vector<double> mid;
  for (const SurfaceTie& tie : list) {
    const Sum& sum = sums[&tie];
    Vec3 middle = Vec3::Zero();
    for (const int i : tie.tied) middle += q.x[i] / static_cast<double>(tie.tied.size());
    const double sign = tie.turned ? -1 : 1;
    const Vec3 force = sign * sum.force, moment = sign * (sum.moment - middle.cross(sum.force));
    mid.insert(mid.end(), force.begin(), force.end());
    mid.insert(mid.end(), moment.begin(), moment.end());
  }
  points_.comm->sum(mid);
  at.mid.insert(at.mid.end(), mid.begin(), mid.end());
}

/// What hangs on a mesh has no clock of its own.
void TiedSurfaces::tie(Ties& ties) const {
  for (const Place& at : place_)
    for (const OnBody& on : at.bodies) ties.exclude(on.body);
}

bool TiedSurfaces::is_free(int node, int c) const {
  return points_.follower[node] < 0 ? !points_.fixed[node][c] : group_of.contains(node) && !welded_to.contains(node);
}

bool TiedSurfaces::is_smooth(int node) const {
  const auto at = group_of.find(node);
  return at != group_of.end() && groups[at->second].smooth();
}

/// Components of rows whose own node is held, or follows a body, go to the rows of the nodes beside it that are free in them, where there
/// are some.
void TiedSurfaces::share_held(SurfaceTie& tie) const {
  std::map<int, size_t> row_of;
  for (size_t k = 0; k < tie.rows.size(); ++k) row_of[tie.rows[k].node] = k;
  std::vector<std::array<std::map<size_t, double>, 3>> more(tie.rows.size());  // of a row: what it takes of others, by component
  std::vector<std::array<bool, 3>> given(tie.rows.size());
  for (size_t k = 0; k < tie.rows.size(); ++k)
    for (int c = 0; c < 3; ++c) {
      const int own = tie.rows[k].node;
      if (is_free(own, c)) continue;
      std::vector<size_t> takers;
      for (const int i : tie.beside[own])
        if (const auto it = row_of.find(i); it != row_of.end() && is_free(i, c)) takers.push_back(it->second);
      for (const size_t to : takers) more[to][c][k] = 1. / static_cast<double>(takers.size());
      given[k][c] = !takers.empty();
    }
  std::vector<TiedRow> rows;
  for (size_t k = 0; k < tie.rows.size(); ++k) {
    std::map<std::map<size_t, double>, std::array<bool, 3>> alike;  // components that take the same
    for (int c = 0; c < 3; ++c)
      if (!given[k][c]) alike[more[k][c]][c] = true;
    for (const auto& [taken, on] : alike) {
      std::map<int, double> sum(tie.rows[k].term.begin(), tie.rows[k].term.end());
      for (const auto& [from, share] : taken)
        for (const auto& [i, w] : tie.rows[from].term) sum[i] += share * w;
      rows.push_back({tie.rows[k].node, {sum.begin(), sum.end()}, on, {}, -1, tie.rows[k].own});
    }
  }
  tie.rows = std::move(rows);
  tie.beside.clear();
}

/// Rows of nodes that move by smooth functions become rows of these functions.
void TiedSurfaces::smooth(SurfaceTie& tie) const {
  std::vector<TiedRow> rows;
  std::map<int, std::vector<const TiedRow*>> of_group;
  for (const TiedRow& row : tie.rows)
    if (is_smooth(row.node) && !welded_to.contains(row.node))
      of_group[group_of.at(row.node)].push_back(&row);
    else
      rows.push_back(row);
  for (const auto& [number, its] : of_group) {
    const TiedGroup& group = groups[number];
    std::map<int, Eigen::Index> place;
    for (size_t k = 0; k < group.nodes.size(); ++k) place[group.nodes[k]] = static_cast<Eigen::Index>(k);
    double mean = 0;
    for (const TiedRow* row : its) mean += row->own / static_cast<double>(its.size());
    for (Eigen::Index j = 0; j < group.functions.cols(); ++j) {
      std::map<std::map<int, double>, std::array<bool, 3>> alike;  // components that take the same
      for (int c = 0; c < 3; ++c) {
        std::map<int, double> sum;
        for (const TiedRow* row : its)
          if (row->on[c])
            for (const auto& [i, w] : row->term) sum[i] += group.functions(place.at(row->node), j) * row->own / mean * w;
        if (!sum.empty()) alike[sum][c] = true;
      }
      for (const auto& [term, on] : alike) rows.push_back({-1, {term.begin(), term.end()}, on, {}, -1, mean});
    }
  }
  tie.rows = std::move(rows);
}

/// Free nodes of cells, nodes of linear regions by themselves or by the functions that move them, and free bodies, also those that welds
/// have nodes follow.  What turns counts at the length of the scene.
std::map<std::int64_t, double> TiedSurfaces::entries_of(const TiedRow& row, int c) const {
  const auto n = static_cast<std::int64_t>(points_.X.size()), n_bodies = static_cast<std::int64_t>(points_.bodies.size());
  std::map<std::int64_t, double> out;
  for (const auto& [i, w] : row.term) {
    int b = points_.follower[i];
    if (const auto weld = welded_to.find(i); weld != welded_to.end()) {
      b = weld->second;
    } else if (const auto of = group_of.find(i); of != group_of.end()) {
      const TiedGroup& group = groups[of->second];
      if (!group.smooth()) {
        out[3 * i + c] += w;
        continue;
      }
      std::int64_t first = 3 * (n + 2 * n_bodies);
      for (int g = 0; g < of->second; ++g) first += 3 * groups[g].functions.cols();
      const auto place = std::ranges::find(group.nodes, i) - group.nodes.begin();
      for (Eigen::Index j = 0; j < group.functions.cols(); ++j) out[first + 3 * j + c] += w * group.functions(place, j);
      continue;
    }
    if (b < 0) {
      if (!points_.fixed[i][c]) out[3 * i + c] += w;
    } else if (points_.bodies[b].free()) {
      const std::int64_t base = 3 * (n + 2 * b);
      const Mat3 turn = -skew(points_.start.R[b] * (points_.X[i] - points_.bodies[b].Xc)) / points_.length;
      out[base + c] += w;
      for (int k = 0; k < 3; ++k) out[base + 3 + k] += w * turn(c, k);
    }
  }
  return out;
}

/// A row whose own node is free and in no other row is independent of the rest.  So are all rows where the own nodes are free and no tie
/// has one of another: n is positive definite.  What is left goes through a QR.
void TiedSurfaces::choose_rows() {
  std::map<int, int> met, owner;  // rows that have a component of a node; the tie that has the node as a row's own
  std::vector<TiedRow*> rows;
  bool apart = true;
  for (SurfaceTie& tie : list) share_held(tie), smooth(tie);
  for (size_t t = 0; t < list.size(); ++t)
    for (TiedRow& row : list[t].rows) {
      rows.push_back(&row);
      for (const auto& [i, w] : row.term)
        for (int c = 0; c < 3; ++c) met[3 * i + c] += row.on[c];
      if (row.node < 0) {
        apart = false;
        continue;
      }
      const auto [at, fresh] = owner.emplace(row.node, static_cast<int>(t));
      apart = apart && at->second == static_cast<int>(t);
    }
  std::vector<std::pair<size_t, int>> left;  // row, component
  for (size_t k = 0; k < rows.size(); ++k)
    for (int c = 0; c < 3; ++c) {
      const int own = rows[k]->node;
      if (!rows[k]->on[c]) continue;
      const bool free = own >= 0 && is_free(own, c);
      if (!free) apart = false;
      if (!free || met[3 * own + c] > 1) left.emplace_back(k, c);
    }
  each([&](const SurfaceTie& tie, const TiedRow& row, size_t) {
    for (const auto& [i, w] : row.term)
      if (const auto it = owner.find(i); it != owner.end()) apart = apart && &list[it->second] == &tie;
  });
  if (left.empty() || apart) return;
  const auto n_on = [](const SurfaceTie& tie) {
    int sum = 0;
    for (const TiedRow& row : tie.rows) sum += static_cast<int>(std::count(row.on.begin(), row.on.end(), true));
    return sum;
  };
  for (SurfaceTie& tie : list) tie.n_off = n_on(tie);
  std::map<std::int64_t, int> column;
  std::vector<Eigen::Triplet<double>> entries;
  const auto at = [&](std::int64_t unknown) { return column.emplace(unknown, static_cast<int>(column.size())).first->second; };
  std::vector<std::pair<size_t, int>> tried;
  for (const auto& [k, c] : left) {
    const std::map<std::int64_t, double> entry = entries_of(*rows[k], c);
    double size = 0;
    for (const auto& [u, x] : entry) size += x * x;
    size = std::sqrt(size);
    if (!(size > least_left)) {
      rows[k]->on[c] = false, rows[k]->implied[c] = !(size > round_off);
      continue;
    }
    for (const auto& [u, x] : entry) entries.emplace_back(at(u), static_cast<int>(tried.size()), x / size);
    tried.emplace_back(k, c);
  }
  Eigen::SparseMatrix<double> A(static_cast<Eigen::Index>(column.size()), static_cast<Eigen::Index>(tried.size()));
  A.setFromTriplets(entries.begin(), entries.end());
  for (const double dependent : {independent, round_off}) {
    if (tried.empty()) break;
    const SparseQr qr = sparse_qr(A, dependent, ColumnOrder::least_fill);
    for (Eigen::Index j = qr.rank; j < A.cols(); ++j) {
      const auto& [k, c] = tried[qr.order[j]];
      if (dependent == independent) rows[k]->on[c] = false;
      rows[k]->implied[c] = !rows[k]->on[c] && dependent == round_off;
    }
  }
  for (SurfaceTie& tie : list) tie.n_off -= n_on(tie);
}

void TiedSurfaces::tell_rows() {
  struct Told {
    std::int64_t tie, number;
    std::array<bool, 3> on, implied;
  };
  std::vector<Told> told;
  for (size_t t = 0; t < list.size(); ++t)
    for (TiedRow& row : list[t].rows) {
      if (row.node >= 0) row.number = points_.mesh->mesh.node_id[row.node];
      told.push_back({static_cast<std::int64_t>(t), row.number, row.on, row.implied});
    }
  told = points_.comm->of_first(told);
  if (points_.comm->rank == 0) return;
  for (const Told& row : told) list[row.tie].rows.push_back({-1, {}, row.on, row.implied, row.number, 1});
}

void TiedSurfaces::add_to_report(Json& run) const {
  if (list.empty()) return;
  Json ties = Json::object(Json::In::lines);
  for (const SurfaceTie& tie : list)
    ties.add(tie.name, {{"nodes", tie.n_nodes},
                        {"tied", tie.n_tied},
                        {"covered", {tie.covered, 6}},
                        {"largest_move", {tie.largest_move, 6}},
                        {"implied_rows", tie.n_off}});
  run.add("ties", std::move(ties));
}

const std::vector<TiedGroup>& tied_groups(const System& system) { return system.part<TiedSurfaces>().groups; }

}  // namespace hilo
