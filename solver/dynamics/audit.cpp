#include "dynamics/audit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/table.hpp"

namespace hilo {
namespace {

constexpr double largest_turn = 2;   // [rad]
constexpr double rounding = 1e-12;   // of sums over the scene

double total(const System::Energy& e) { return e.kinetic + e.elastic + e.gravity; }

std::string number(double x) { return std::isfinite(x) ? fmt::format("{:.6g}", x) : "null"; }

}  // namespace

Audit::Audit(const System& system, bool keeps_energy, double tolerance)
    : system_(system), keeps_energy_(keeps_energy), energy_bound_(std::max(1e-8, 10 * tolerance)), row_bound_(energy_bound_ / 10) {}

void Audit::start(const State& s) {
  now_ = {};
  now_.energy = system_.energy(s.q, s.v);
  now_.rows = system_.violation(s.q, s.t);
  E0_ = total(now_.energy), moving_ = now_.energy.kinetic;
  worst_.rows = now_.rows, worst_.kept_t = worst_.dropped_t = s.t;
}

/// Largest way of a point over a step [m].
double Audit::motion(const Config& q0, const Config& q1) const {
  double top = 0;
  for (size_t i = 0; i < q1.x.size(); ++i) top = std::max(top, (q1.x[i] - q0.x[i]).squaredNorm());
  top = std::sqrt(top);
  for (size_t b = 0; b < q1.c.size(); ++b)
    top = std::max({top, (q1.c[b] - q0.c[b]).norm(), system_.bodies[b].size * (q1.R[b] - q0.R[b]).norm()});
  return system_.comm->max(top);
}

std::string Audit::look(const Config& q0, const State& end, std::span<const Taken> taken, const NewtonReport& newton, double load_factor) {
  opens_dropped_row_ = false;
  const double t = taken.back().stage.t_end;
  next_ = {};
  next_.energy = system_.energy(end.q, end.v);
  next_.work = sums_.work, next_.dissipated = sums_.dissipated;
  for (const Taken& part : taken) {
    const System::Work w = system_.work(part.stage, part.lambda);
    next_.work += w.external, next_.dissipated += w.dissipated;
  }
  next_.rows = system_.violation(end.q, t, load_factor);
  next_.balance = total(next_.energy) - E0_ - next_.work + next_.dissipated;
  det_ = newton.least_det;
  turn_ = system_.largest_turn(q0, end.q);
  if (!std::isfinite(next_.balance)) return "energies are not finite";
  if (det_ <= 0) return fmt::format("a cell is turned inside out (det F = {:.2g})", det_);
  if (turn_.angle > largest_turn) return fmt::format("{} turns by {:.3g} rad in one step", system_.name(turn_), turn_.angle);
  const System::Violation& g = next_.rows;
  const double open = row_bound_ * system_.length;
  if (!(g.kept <= open)) return fmt::format("joint \"{}\" opens by {:.2g}", system_.joints[g.kept_joint].name, g.kept);
  if (!(g.dropped <= open)) {
    opens_dropped_row_ = true;
    return fmt::format("joint \"{}\" opens by {:.2g} along a row that seemed redundant", system_.joints[g.dropped_joint].name, g.dropped);
  }
  moving_next_ = std::max(moving_, next_.energy.kinetic);
  step_ = sum_ = 0;
  if (!keeps_energy_) return "";
  // what Newton leaves of the residual does work on the step's motion; sums of large energies are rounded
  const double step = std::abs(next_.balance - now_.balance), sum = std::abs(next_.balance);
  const double terms = std::abs(next_.energy.elastic) + std::abs(next_.energy.gravity) + std::abs(next_.work) + next_.dissipated;
  double scale = moving_next_;
  if (!(sum <= energy_bound_ * scale)) scale = std::max({scale, newton.force * motion(q0, end.q), rounding / energy_bound_ * terms});
  if (scale <= 0) return "";
  step_ = step / scale, sum_ = sum / scale;
  if (!(step_ <= energy_bound_)) return fmt::format("the step changes the balance of energy by {:.2g} J of {:.2g} J", step, scale);
  if (!(sum_ <= energy_bound_ * std::max(1.0, n_steps_ / 1000)))
    return fmt::format("the balance of energy is off by {:.2g} J of {:.2g} J", sum, scale);
  return "";
}

void Audit::accept(double t) {
  now_ = next_, sums_ = {next_.work, next_.dissipated}, moving_ = moving_next_, ++n_steps_;
  largest_ = std::max(largest_, std::abs(now_.balance));
  if (step_ > worst_.step) worst_.step = step_, worst_.step_t = t;
  if (sum_ > worst_.sum) worst_.sum = sum_, worst_.sum_t = t;
  if (now_.rows.kept > worst_.rows.kept) worst_.rows.kept = now_.rows.kept, worst_.rows.kept_joint = now_.rows.kept_joint, worst_.kept_t = t;
  if (now_.rows.dropped > worst_.rows.dropped)
    worst_.rows.dropped = now_.rows.dropped, worst_.rows.dropped_joint = now_.rows.dropped_joint, worst_.dropped_t = t;
  if (turn_.angle > worst_.turn.angle) worst_.turn = turn_, worst_.turn_t = t;
  if (det_ < worst_.det) worst_.det = det_, worst_.det_t = t;
}

double Audit::balance() const { return moving_ > 0 ? largest_ / moving_ : std::nan(""); }

std::string Audit::json(const std::string& failure) const {
  const auto joint = [&](int j) { return j >= 0 ? json_text(system_.joints[j].name) : "null"; };
  std::string out = fmt::format("{{\n    \"passed\": {},\n", failure.empty());
  if (!failure.empty()) out += fmt::format("    \"failed\": {},\n", json_text(failure));
  out += keeps_energy_ ? fmt::format("    \"energy\": {{\"step\": {}, \"step_t\": {}, \"sum\": {}, \"sum_t\": {}, \"bound\": {}}},\n",
                                     number(worst_.step), number(worst_.step_t), number(worst_.sum), number(worst_.sum_t),
                                     number(energy_bound_))
                       : "    \"energy\": \"not checked: the method does not keep it\",\n";
  const auto rows = [&](const char* key, double worst, int by, double t) {
    out += fmt::format("    \"{}\": {{\"worst\": {}, \"joint\": {}, \"t\": {}, \"bound\": {}}},\n", key, number(worst), joint(by), number(t),
                       number(row_bound_ * system_.length));
  };
  rows("joint_rows", worst_.rows.kept, worst_.rows.kept_joint, worst_.kept_t);
  rows("dropped_rows", worst_.rows.dropped, worst_.rows.dropped_joint, worst_.dropped_t);
  out += fmt::format("    \"turn\": {{\"largest\": {}, \"of\": {}, \"t\": {}, \"bound\": {}}},\n", number(worst_.turn.angle),
                     worst_.turn.angle > 0 ? json_text(system_.name(worst_.turn)) : "null", number(worst_.turn_t), number(largest_turn));
  out += fmt::format("    \"det_F\": {{\"least\": {}, \"t\": {}}},\n", worst_.det < 1e299 ? number(worst_.det) : "null", number(worst_.det_t));
  return out + "    \"finite\": true\n  }";
}

}  // namespace hilo
