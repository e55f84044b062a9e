// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/audit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hilo {
namespace {

constexpr double rounding = 1e-12;  // of sums over the scene
constexpr double digit = 1e-15;     // of a force times the scene's length, in work
constexpr double slip = 0.01;       // of the largest speed: what a method may leave along a row that others imply

double total(const Energy& e) { return e.kinetic + e.elastic + e.gravity; }

/// Energies, the kinetic one of what moves by a law that of the law, so that the balance sees velocities that are not.
Energy energy_of(const System& system, const State& s, Side side) {
  if (!system.moves() || system.same_time == 0) return system.energy(s.q, s.v);  // statics have no velocities
  Config v = s.v;
  system.prescribe_rates(s.t, side, &v, nullptr);
  return system.energy(s.q, v);
}

/// Of loads, weights and springs in a state, without those of joints [N].
double largest_force(const System& system, const State& s) {
  Config none;
  combine(none, {{0, &s.q}});
  Stage stage = stage_at(s.q, s.t);
  stage.a = stage.v = &none;
  Residual r;
  system.evaluate(stage, std::vector<double>(3 * static_cast<size_t>(system.n_joint_blocks())), r, nullptr);
  return system.comm->max(r.force_scale);
}

}  // namespace

Audit::Audit(const System& system, std::string energy_unchecked, double tolerance)
    : system_(system),
      energy_unchecked_(std::move(energy_unchecked)),
      energy_bound_(std::max(1e-8, 10 * tolerance)),
      left_bound_(std::max(1e-4, energy_bound_)),
      row_bound_(std::max(1e-9, 20 * tolerance)) {}

void Audit::start(const State& s) {
  t_ = s.t, now_ = {};
  now_.energy = energy_of(system_, s, Side::right);
  now_.rows = system_.violation(s.q, s.t);
  start_ = now_.energy, E0_ = total(start_), moving_ = start_.kinetic;
  if (energy_unchecked_.empty()) rounding_ = digit * largest_force(system_, s) * system_.length;
  worst_.rows = now_.rows, worst_.kept_t = worst_.dropped_t = s.t;
}

std::string Audit::look(const Config& q0, const State& end, std::span<const Taken> taken, const NewtonReport& newton, double load_factor,
                        const Besides& besides, const Taken* before, bool followed) {
  opens_dropped_row_ = false;
  next_ = {};
  next_.energy = energy_of(system_, end, Side::left);
  next_.work = sums_.work + besides.work, next_.dissipated = sums_.dissipated + besides.dissipated;
  const double at_start = before ? system_.work(before->stage, before->lambda).external : 0;
  for (const Taken& part : taken) {
    const Work w = system_.work(part.stage, part.lambda);
    next_.work += before ? (w.external + at_start) / 2 : w.external;
    next_.dissipated += w.dissipated, next_.energy.elastic += w.stored;
  }
  next_.left = sums_.left + newton.left + opened(newton.gaps, taken);
  next_.rows = system_.violation(end.q, end.t, load_factor);
  next_.balance = total(next_.energy) - E0_ - next_.work + next_.dissipated;
  det_ = newton.least_det;
  turn_ = followed ? System::Turn{} : system_.largest_turn(q0, end.q);
  if (!std::isfinite(next_.balance)) return "energies are not finite";
  if (det_.det <= 0) return system_.inside_out(det_);
  if (turn_.angle > turn_limit) return fmt::format("{} turns by {:.3g} rad in one step", system_.name(turn_), turn_.angle);
  const Violation& g = next_.rows;
  const double open = row_bound_ * system_.length;
  if (!(g.kept <= open)) return fmt::format("{} opens by {:.2g}", system_.row_owner(g.kept_block), g.kept);
  if (!(g.dropped <= open)) {
    opens_dropped_row_ = true;
    return fmt::format("{} opens by {:.2g} along a row that seemed redundant", system_.row_owner(g.dropped_block), g.dropped);
  }
  if (const std::string slips = slipping(end); !slips.empty()) return slips;
  moving_next_ = std::max(moving_, next_.energy.kinetic);
  step_ = sum_ = left_ = 0;
  if (!energy_unchecked_.empty()) return "";
  // Sums of large energies are rounded, and so are positions: to 1e-12 of the scene at most.
  const double terms = std::abs(next_.energy.elastic) + std::abs(next_.energy.gravity) + std::abs(next_.work) + next_.dissipated;
  const double h = end.t - t_, way = rounding * system_.length;
  // Where strain is stored, a rounded position is one under load: its work is of first order.
  const double loaded = digit * system_.length * std::sqrt(2 * system_.stiffness * std::abs(next_.energy.elastic));
  rounding_next_ = std::max(rounding_, rounding * terms + way * way * (system_.stiffness + system_.mass / (h * h)) + loaded);
  const double step = std::abs(next_.balance - now_.balance - (next_.left - now_.left)), sum = std::abs(next_.balance - next_.left);
  double scale = 0, scale_of_sum = 0;
  const auto compare = [&] {
    // From rest the kinetic energy says little of what is to come; gravity's will be compared with it at the end.
    const double from_rest = moving_next_ + 1e-10 * system_.mass * system_.gravity.norm() * system_.length / energy_bound_;
    scale = from_rest + rounding_next_ / energy_bound_, scale_of_sum = from_rest + rounded(rounding_next_) / energy_bound_;
    step_ = step / scale, sum_ = sum / scale_of_sum;
  };
  compare();
  if (!(std::max(step_, sum_) <= energy_bound_)) {  // loads may have grown since the start
    rounding_next_ = std::max(rounding_next_, digit * largest_force(system_, end) * system_.length);
    compare();
  }
  if (!(step_ <= energy_bound_)) return fmt::format("the step changes the balance of energy by {:.2g} J of {:.2g} J", step, scale);
  if (!(sum_ <= energy_bound_ * std::max(1.0, n_steps_ / 1000)))
    return fmt::format("the balance of energy is off by {:.2g} J of {:.2g} J", sum, scale_of_sum);
  const double came = scale + std::abs(next_.energy.elastic - start_.elastic) + std::abs(next_.energy.gravity - start_.gravity) +
                      std::abs(next_.work) + next_.dissipated;
  left_ = std::abs(next_.left) / came;
  if (!(left_ <= left_bound_ * std::max(1.0, n_steps_ / 1000)))
    return fmt::format("Newton left {:.2g} J of {:.2g} J: solver.tolerance is too loose", std::abs(next_.left), came);
  return "";
}

/// Which row of velocities, dropped as redundant, slips by more than methods leave of others.
std::string Audit::slipping(const State& end) {
  const auto is_dropped = [](const Constraint& c, int r) { return !c.active()[r] && !c.is_driven(r); };
  const auto each = [&](auto&& visit) {
    for (const auto& c : system_.constraints())
      for (int r = c->n_position_rows(); r < c->n_rows(); ++r) visit(*c, r);
  };
  bool any = false;
  each([&](const Constraint& c, int r) { any = any || is_dropped(c, r); });
  if (!any || system_.same_time == 0) return "";
  std::vector<double> rate;
  system_.row_rates(end.q, end.v, nullptr, end.t, rate, nullptr);
  double kept = 0, most = 0;
  const Constraint* worst = nullptr;
  each([&](const Constraint& c, int r) {
    const double x = std::abs(rate[static_cast<size_t>(c.row() + r)]);
    if (!is_dropped(c, r))
      kept = std::max(kept, x);
    else if (!(x <= most))
      most = x, worst = &c;
  });
  if (!worst || most <= slip * system_.largest_rate(end.v) + 10 * kept + row_bound_ * system_.length / (end.t - t_)) return "";
  opens_dropped_row_ = true;
  return fmt::format("{} slips at {:.2g} m/s along a row that seemed redundant", worst->label(), most);
}

/// Work of the multipliers as their rows open or close over the step, which the balance sees as lost [J].  Rows are the same on all ranks.
double Audit::opened(const std::vector<double>& gaps, std::span<const Taken> taken) {
  gaps_next_ = gaps;
  if (gaps.empty() || taken.size() != 1) return 0;
  double work = 0;
  const std::vector<double>& lambda = taken[0].lambda;
  for (size_t k = 0; k < gaps.size(); ++k) work -= lambda[k] * (gaps[k] - (k < gaps_.size() ? gaps_[k] : 0));
  for (const auto& c : system_.constraints())
    std::fill(gaps_next_.begin() + c->row() + c->n_position_rows(), gaps_next_.begin() + c->row() + c->n_rows(), 0.0);
  return work;
}

void Audit::accept(double t) {
  t_ = t;
  rounding_ = rounding_next_, now_ = next_, sums_ = {next_.work, next_.dissipated, next_.left}, moving_ = moving_next_, ++n_steps_;
  largest_ = std::max(largest_, std::abs(now_.balance)), unexplained_ = std::max(unexplained_, std::abs(now_.balance - now_.left));
  gaps_ = gaps_next_;
  if (left_ > worst_.left.part) worst_.left = {left_, t};
  if (step_ > worst_.step) worst_.step = step_, worst_.step_t = t;
  if (sum_ > worst_.sum) worst_.sum = sum_, worst_.sum_t = t;
  if (now_.rows.kept > worst_.rows.kept)
    worst_.rows.kept = now_.rows.kept, worst_.rows.kept_block = now_.rows.kept_block, worst_.kept_t = t;
  if (now_.rows.dropped > worst_.rows.dropped)
    worst_.rows.dropped = now_.rows.dropped, worst_.rows.dropped_block = now_.rows.dropped_block, worst_.dropped_t = t;
  if (turn_.angle > worst_.turn.angle) worst_.turn = turn_, worst_.turn_t = t;
  if (det_.det < worst_.det.det) worst_.det = det_, worst_.det_t = t;
}

std::string Audit::verdict() const {
  if (!energy_unchecked_.empty() || unexplained_ <= energy_bound_ * std::max(1.0, n_steps_ / 1000) * moving_ + rounded(rounding_))
    return "";
  return fmt::format("the balance of energy is off by {:.2g} J, and the kinetic energy was never above {:.2g} J", unexplained_, moving_);
}

double Audit::balance() const { return moving_ > rounding_ ? largest_ / moving_ : std::nan(""); }

Json Audit::json(const std::string& failure) const {
  const auto joint = [&](int block) -> Json {  // the name of a joint; of other rows what they belong to
    for (const auto& c : system_.constraints())
      if (3 * block >= c->row() && 3 * block < c->row() + c->n_padded()) return c->name();
    const std::string who = system_.row_owner(block);
    return who.empty() ? Json(nullptr) : who;
  };
  const auto number = [](double x) { return Json(x, 6); };
  Json out = Json::object(Json::In::lines);
  out.add("passed", failure.empty());
  if (!failure.empty()) out.add("failed", failure);
  if (energy_unchecked_.empty())
    out.add("energy", {{"step", number(worst_.step)},
                       {"step_t", number(worst_.step_t)},
                       {"sum", number(worst_.sum)},
                       {"sum_t", number(worst_.sum_t)},
                       {"bound", number(energy_bound_)},
                       {"newton", number(worst_.left.part)},
                       {"newton_t", number(worst_.left.t)},
                       {"newton_bound", number(left_bound_)}});
  else
    out.add("energy", "not checked: " + energy_unchecked_);
  const auto rows = [&](const char* key, double worst, int by, double t) {
    out.add(key, {{"worst", number(worst)}, {"joint", joint(by)}, {"t", number(t)}, {"bound", number(row_bound_ * system_.length)}});
  };
  rows("joint_rows", worst_.rows.kept, worst_.rows.kept_block, worst_.kept_t);
  rows("dropped_rows", worst_.rows.dropped, worst_.rows.dropped_block, worst_.dropped_t);
  out.add("turn", {{"largest", number(worst_.turn.angle)},
                   {"of", worst_.turn.angle > 0 ? Json(system_.name(worst_.turn)) : nullptr},
                   {"t", number(worst_.turn_t)},
                   {"bound", number(turn_limit)}});
  const auto& [det, region] = worst_.det;
  out.add("det_F", {{"least", region >= 0 ? number(det) : nullptr},
                    {"region", region >= 0 ? Json(system_.mesh->mesh.region_name[region]) : nullptr},
                    {"t", number(worst_.det_t)}});
  out.add("finite", true);
  return out;
}

}  // namespace hilo
