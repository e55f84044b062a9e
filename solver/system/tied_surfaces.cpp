// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/tied_surfaces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "base/table.hpp"
#include "linear/sparse_qr.hpp"
#include "system/collocation.hpp"

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
    } else if (points_.bodies[b].free()) {
      OnBody& on = bodies.try_emplace(b, OnBody{b, 0, Vec3::Zero()}).first->second;
      on.weight += w, on.arm += w * (points_.X[i] - points_.bodies[b].Xc);
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
    for (const OnBody& on : at.bodies) blocks.push_back(points_.body_block[on.body]), blocks.push_back(points_.body_block[on.body] + 1);
    blocks.push_back(at.block);
    at.clique = layout.cliques.add(blocks);
  });
}

std::string TiedSurfaces::owner(int block) const {
  std::string out;
  if (!place_.empty() && block >= place_.front().block && block <= place_.back().block)
    each([&](const SurfaceTie& tie, const TiedRow& row, size_t k) {
      if (place_[k].block == block) out = fmt::format("tie \"{}\", at node {}", tie.name, row.number);
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
    const size_t n_nodes = at.nodes.size(), first = 3 * (n_nodes + 2 * at.bodies.size()), width = first + 3;
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
      for (size_t b = 0; b < at.bodies.size(); ++b) {
        const OnBody& on = at.bodies[b];
        const size_t base = 3 * n_nodes + 6 * b;
        put(base + c, c, on.weight, on.weight);
        const Mat3 left = -skew(s.left->R[on.body] * on.arm), right = -skew(s.end->R[on.body] * on.arm);
        for (int j = 0; j < 3; ++j) put(base + 3 + j, c, left(c, j), right(c, j));
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
    std::set<int> tied;
  };
  std::map<const SurfaceTie*, Sum> sums;
  each([&](const SurfaceTie& tie, const TiedRow& row, size_t k) {
    if (row.term.empty()) return;
    Sum& sum = sums[&tie];
    sum.tied.insert(row.node);
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
    for (const int i : sum.tied) middle += q.x[i] / static_cast<double>(sum.tied.size());
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

bool TiedSurfaces::is_free(int node, int c) const { return points_.follower[node] < 0 && !points_.fixed[node][c]; }

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
      rows.push_back({tie.rows[k].node, {sum.begin(), sum.end()}, on, {}, -1});
    }
  }
  tie.rows = std::move(rows);
  tie.beside.clear();
}

/// A row whose own node is free and in no other row is independent of the rest.  So are all rows where the own nodes are free and no tie
/// has one of another: n is positive definite.  What is left goes through a QR.
void TiedSurfaces::choose_rows() {
  std::map<int, int> met, owner;  // rows that have a component of a node; the tie that has the node as a row's own
  std::vector<std::pair<TiedRow*, Place>> rows;
  bool apart = true;
  for (SurfaceTie& tie : list) share_held(tie);
  for (size_t t = 0; t < list.size(); ++t)
    for (TiedRow& row : list[t].rows) {
      rows.emplace_back(&row, place_of(row));
      for (const auto& [i, w] : row.term)
        for (int c = 0; c < 3; ++c) met[3 * i + c] += row.on[c];
      const auto [at, fresh] = owner.emplace(row.node, static_cast<int>(t));
      apart = apart && at->second == static_cast<int>(t);
    }
  std::vector<std::pair<size_t, int>> left;  // row, component
  for (size_t k = 0; k < rows.size(); ++k)
    for (int c = 0; c < 3; ++c) {
      const int own = rows[k].first->node;
      if (!rows[k].first->on[c]) continue;
      if (!is_free(own, c)) apart = false;
      if (!is_free(own, c) || met[3 * own + c] > 1) left.emplace_back(k, c);
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
  std::map<int, int> column;
  std::vector<Eigen::Triplet<double>> entries;
  const auto at = [&](int unknown) { return column.emplace(unknown, static_cast<int>(column.size())).first->second; };
  const int n = static_cast<int>(points_.X.size());
  std::vector<std::pair<size_t, int>> tried;
  for (const auto& [k, c] : left) {
    std::vector<std::pair<int, double>> entry;
    for (const auto& [i, w] : rows[k].second.nodes)
      if (!points_.fixed[i][c]) entry.emplace_back(3 * i + c, w);
    for (const OnBody& on : rows[k].second.bodies) {
      const int base = 3 * (n + 2 * on.body);
      const Mat3 turn = -skew(points_.start.R[on.body] * on.arm) / points_.length;
      entry.emplace_back(base + c, on.weight);
      for (int i = 0; i < 3; ++i) entry.emplace_back(base + 3 + i, turn(c, i));
    }
    double size = 0;
    for (const auto& [u, x] : entry) size += x * x;
    size = std::sqrt(size);
    if (!(size > least_left)) {
      rows[k].first->on[c] = false, rows[k].first->implied[c] = !(size > round_off);
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
      if (dependent == independent) rows[k].first->on[c] = false;
      rows[k].first->implied[c] = !rows[k].first->on[c] && dependent == round_off;
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
      row.number = points_.mesh->mesh.node_id[row.node];
      told.push_back({static_cast<std::int64_t>(t), row.number, row.on, row.implied});
    }
  told = points_.comm->of_first(told);
  if (points_.comm->rank == 0) return;
  for (const Told& row : told) list[row.tie].rows.push_back({-1, {}, row.on, row.implied, row.number});
}

void TiedSurfaces::add_to_report(std::vector<std::pair<std::string, std::string>>& report) const {
  if (list.empty()) return;
  std::string text;
  for (const SurfaceTie& tie : list)
    text += fmt::format("{}\n    {}: {{\"nodes\": {}, \"tied\": {}, \"covered\": {:.6g}, \"largest_move\": {:.6g}, \"implied_rows\": {}}}",
                        text.empty() ? "" : ",", json_text(tie.name), tie.n_nodes, tie.n_tied, tie.covered, tie.largest_move, tie.n_off);
  report.emplace_back("ties", "{" + text + "}");
}

}  // namespace hilo
