// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "system/linear_beams.hpp"
#include "system/mode_forces.hpp"
#include "system/solids.hpp"

namespace hilo {

void System::prepare() {
  points_ = layout_of_points();
  for (const auto& part : parts_) part->prepare();
  number();
  traits_ = {};
  for (const auto& part : parts_) traits_ |= part->traits();
  region_nodes.clear(), constraints_.clear();
  for (Constraining* part : all<Constraining>()) part->add_constraints(constraints_);
  for (const Turning* part : all<Turning>()) part->add_groups(region_nodes);
  moves_ = std::ranges::any_of(all<Prescribing>(), &Prescribing::moves);
}

Carry System::number() {
  const Layout before = std::exchange(layout, points_);
  for (Equations* part : all<Equations>()) part->number(layout), ++layout.part;
  const auto n = static_cast<std::int64_t>(layout.rows.size());
  BlockMap& map = layout.map;
  for (std::int64_t k = 0; k < n; ++k) map.global.push_back(map.n_global + k);
  map.X.resize(3 * map.global.size(), 0.0);
  map.n_global += n;
  if (comm->rank == comm->size - 1) map.n_owned += n;
  return {before, layout};
}

std::optional<Carry> System::search(const Config& q, const Config* v, double h) {
  if (!traits_.searches) return {};
  bool changes = false;
  for (Equations* part : all<Equations>()) changes |= part->search(q, v, h);
  if (comm->max(changes ? 1 : 0) == 0) return {};
  return number();
}

void System::evaluate(const Stage& stage, std::span<const double> lambda, Residual& out, KktSolver* K) const {
  thread_local std::vector<Vec3> node;
  thread_local std::vector<Vec6> body;
  out.force_scale = 0, out.least_det = {}, out.finite = true;
  out.sigma = constraint_scale(stage);
  if (K) K->zero();
  add_all(stage, lambda, out, K, node, body, !stage.rates_alone);
  if (!K) return;
  for (size_t i = 0; i < X.size(); ++i) {
    if (node_block[i] < 0 || !node_owned[i]) continue;
    if (fixed[i][0] || fixed[i][1] || fixed[i][2]) {
      const double d[3] = {fixed[i][0] ? out.sigma : 0, fixed[i][1] ? out.sigma : 0, fixed[i][2] ? out.sigma : 0};
      K->add_diagonal(node_block[i], d);
    }
  }
}

void System::add_all(const Stage& stage, std::span<const double> lambda, Residual& out, KktSolver* K, std::vector<Vec3>& node,
                     std::vector<Vec6>& body, bool loads) const {
  node.assign(stage.end->x.size(), Vec3::Zero());
  body.assign(bodies.size(), Vec6::Zero());
  out.r.assign(3 * n_blocks(), 0.0);
  Pass p{stage, lambda, out, K, node, body, out.sigma, loads};
  for (const Equations* part : all<Equations>()) part->evaluate(p);
  reduce(p);
}

double System::constraint_scale(const Stage& s) const {
  const double inertia = std::abs(s.mass_slope) * mass / std::max<double>(1, static_cast<double>(layout.map.n_global));
  return std::max(inertia, s.mass_slope != 0 ? 1e-300 : stiffness);
}

void System::reduce(Pass& p) const {
  std::vector<Mat3> geometric;  // of followers: slope (dtheta x arm1) x r
  if (p.K) geometric.assign(bodies.size(), Mat3::Zero());
  std::vector<ModeForces> of_modes;
  of_modes.reserve(modes.size());
  for (const Modes& m : modes) of_modes.emplace_back(m, p);
  for (size_t i = 0; i < p.node.size(); ++i) {
    const int b = follower[i];
    if (b < 0) {
      for (int k = 0; k < 3; ++k) p.out.r[3 * node_block[i] + k] += p.node[i][k];
      continue;
    }
    const Vec3& r = p.node[i];
    if (r.isZero(0)) continue;
    p.body[b].head<3>() += r;
    p.body[b].tail<3>() += (p.s.left->x[i] - p.s.left->c[b]).cross(r);
    if (p.K && body_block[b] >= 0) geometric[b] += p.s.slope * skew(r) * skew(p.s.end->x[i] - p.s.end->c[b]);
    if (const auto shapes = shapes_at(static_cast<int>(i)); !shapes.empty()) of_modes[modes_of[b]].add(shapes, r);
  }
  for (ModeForces& m : of_modes) m.finish();
  const auto none = std::vector<CarriedBodies>{};
  for (const CarriedBodies& of : modes.empty() ? none : part<LinearBeams>().carried)
    for (const int b : of.bodies)
      if (!p.body[b].isZero(0))
        throw Error("", fmt::format("something acts on section \"{}\" of a linear beam that no entry of the scene names", bodies[b].name));
  for (size_t b = 0; b < bodies.size(); ++b) {
    if (body_block[b] < 0) continue;
    for (int k = 0; k < 6; ++k) p.out.r[3 * body_block[b] + k] += p.body[b][k];
    if (p.K && !geometric[b].isZero(0)) {
      Eigen::Matrix<double, 6, 6, Eigen::RowMajor> K6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>::Zero();
      K6.bottomRightCorner<3, 3>() = geometric[b];
      p.K->add(body_clique[b], K6.data());
    }
  }
}

const Forces& Moment::forces() const {
  if (!forces_) system_.forces(s, lambda, forces_.emplace());
  return *forces_;
}

void System::forces(const Stage& stage, std::span<const double> lambda, Forces& out) const {
  Residual unused;
  add_all(stage, lambda, unused, nullptr, out.node, out.body, !stage.rates_alone);
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

void System::advance(const Stage& stage) {
  for (Stateful* part : all<Stateful>()) part->advance(stage);
}

void System::settle(bool accepted) {
  for (Stateful* part : all<Stateful>()) part->settle(accepted);
}

Energy System::energy(const Config& q, const Config& v) const {
  Energy out;
  for (const Equations* part : all<Equations>()) part->add_energy(q, v, out);
  double all[9] = {out.kinetic,     out.elastic,    out.gravity,    out.momentum[0], out.momentum[1],
                   out.momentum[2], out.angular[0], out.angular[1], out.angular[2]};
  comm->sum(all);
  out.kinetic = all[0], out.elastic = all[1], out.gravity = all[2];
  out.momentum = Vec3(all[3], all[4], all[5]), out.angular = Vec3(all[6], all[7], all[8]);
  return out;
}

Work System::work(const Stage& s, std::span<const double> lambda) const {
  const Moment moment(*this, s, lambda, lambda, nullptr);
  Work sum;
  for (const Equations* part : all<Equations>()) part->add_work(moment, sum);
  double all[3] = {sum.external, sum.dissipated, sum.stored};
  comm->sum(all);
  return {all[0], all[1], all[2]};
}

Violation System::violation(const Config& q, double t, double factor) const {
  Violation out;
  for (const Constraining* part : all<Constraining>()) part->look_at_rows(q, t, factor, out);
  if (comm->size == 1) return out;
  const auto share = [&](double& worst, int& block) {
    const double own = worst;
    worst = comm->max(own);
    block = static_cast<int>(comm->max(own == worst ? block : -1));
  };
  share(out.kept, out.kept_block), share(out.dropped, out.dropped_block);
  return out;
}

std::vector<char> System::rows_on() const {
  std::vector<char> on(3 * static_cast<size_t>(n_joint_blocks()), 0);
  for (const Constraining* part : all<Constraining>()) part->mark_rows(on);
  for (const auto& c : constraints())
    for (int r = 0; r < c->n_rows(); ++r) on[c->row() + r] = c->active()[r];
  return on;
}

std::string System::owner(int block) const {
  for (const Equations* part : all<Equations>())
    if (std::string who = part->owner(block); !who.empty()) return who;
  return "";
}

void System::row_rates(const Config& q, const Config& v, const Config* a, double t, std::vector<double>& rate,
                       std::vector<double>* acceleration) const {
  const auto combined = [&](double f, const Config& d) {
    Config out = q;
    Config::each_array([&](auto array) {
      for (size_t i = 0; i < (q.*array).size(); ++i) (out.*array)[i] += f * (d.*array)[i];
    });
    return out;
  };
  // steps over which the differences are as large as the values themselves
  const auto reach = [&](const Config& d) {
    double top = 0;
    for (const Vec3& x : d.x) top = std::max(top, x.norm());
    for (size_t i = 0; i < d.c.size(); ++i) top = std::max({top, d.c[i].norm(), d.R[i].norm() * bodies[i].size});
    return top > 0 ? length / top : 1;
  };
  const double tau = reach(v), sigma = a ? reach(*a) : 1;
  Rates at{q, v, a, t, tau, sigma, combined(tau, v), combined(-tau, v), {}, {}};
  if (a) at.up = combined(sigma, *a), at.down = combined(-sigma, *a);
  rate.assign(3 * n_joint_blocks(), 0.0);
  if (acceleration) acceleration->assign(rate.size(), 0.0);
  for (const Constraining* part : all<Constraining>()) part->add_row_rates(at, rate, acceleration);
  comm->sum(rate);
  if (acceleration) comm->sum(*acceleration);
}

System::Turn System::largest_turn(const Config& q0, const Config& q1) const {
  Turned most;
  const auto& turning = all<Turning>();
  for (size_t k = 0; k < turning.size(); ++k) turning[k]->look_at_turn(q0, q1, static_cast<int>(k), most);
  const double worst = -comm->max(-most.cos2);
  if (comm->size > 1) {
    most.part = static_cast<int>(comm->max(most.cos2 == worst ? most.part : -1));
    most.item = static_cast<int>(comm->max(most.cos2 == worst ? most.item : -1));
  }
  return {2 * std::acos(std::sqrt(std::clamp(worst, 0.0, 1.0))), most.part, most.item};
}

std::string System::too_far(const Config& q0, const Config& q1) const {
  for (const Stateful* part : all<Stateful>())
    if (std::string why = part->too_far(q0, q1); !why.empty()) return why;
  return {};
}

std::string System::name(const Turn& turn) const { return turn.part >= 0 ? all<Turning>()[turn.part]->name(turn.item) : ""; }

double System::longest_share(const Config& from, const Config& to) const {
  double share = 1;
  for (const Equations* part : all<Equations>()) share = std::min(share, part->longest_share(from, to));
  return -comm->max(-share);
}

std::string System::inside_out(const LeastDet& least) const {
  return fmt::format("a cell of region \"{}\" is {}turned inside out (det F = {:.2g})", mesh->mesh.region_name[least.region],
                     least.det > 0 ? "all but " : "", least.det);
}

std::string System::fault(const Config& q) const {
  for (const Stateful* part : all<Stateful>())
    if (std::string why = part->fault(q); !why.empty()) return why;
  return "";
}

void System::commit(const Config& q, const Config* v) {
  for (Stateful* part : all<Stateful>()) part->commit(q, v);
}

void System::archive(Archive& a) {
  for (const auto& part : parts_) part->archive(a);
}

Kept System::memory() {
  Archive now;
  now.is_aside = true;
  archive(now);
  return now.kept();
}

void System::recall(const Kept& memory) {
  Archive then(memory);
  then.is_aside = true;
  archive(then);
}

Shares System::shares() const {
  std::vector<std::int64_t> nodes, blocks, cells;
  Shares out{{*comm, {}}, {*comm, {}}, {*comm, {}}, {}, {}};
  if (mesh) {
    nodes.assign(mesh->node_global.begin(), mesh->node_global.begin() + static_cast<std::ptrdiff_t>(start.x.size()));
    for (size_t i = 0; i < node_block.size(); ++i) {
      if (node_block[i] < 0) continue;
      blocks.resize(std::max<size_t>(blocks.size(), node_block[i] + 1));
      blocks[node_block[i]] = mesh->node_global[i];
    }
    for (const SolidBatch& b : part<Solids>().batches) {
      for (const int e : b.cells) cells.push_back(mesh->cell_global[e]);
      out.batch.push_back(b.cells.size()), out.remembered.push_back(b.kernel.n_state);
      out.most_remembered = std::max(out.most_remembered, b.kernel.n_state);
    }
  }
  out.nodes = {*comm, std::move(nodes)}, out.blocks = {*comm, std::move(blocks)}, out.cells = {*comm, std::move(cells)};
  out.most_remembered = static_cast<int>(comm->max(out.most_remembered));
  return out;
}

void System::prescribe(Config& q, double t, double ramp) const {
  for (const Prescribing* part : all<Prescribing>()) part->prescribe(q, t, ramp);
  place(q);
}

void System::prescribe_rates(double t, Side side, Config* v, Config* a) const {
  for (const Prescribing* part : all<Prescribing>()) part->prescribe_rates(t, side, v, a);
}

void System::copy_prescribed(const Config& from, Config& to) const {
  for (const Prescribing* part : all<Prescribing>()) part->copy_prescribed(from, to);
}

std::string System::too_far(double t0, double t1) const {
  for (const Prescribing* part : all<Prescribing>())
    if (std::string why = part->too_far(t0, t1); !why.empty()) return why;
  return "";
}

}  // namespace hilo
