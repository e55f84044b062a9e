// SPDX-License-Identifier: GPL-3.0-or-later
// An analysis of modes: the state of rest, and then a row of the results for every mode, its shape added to that state.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/table.hpp"
#include "dynamics/modes/accelerated_support.hpp"
#include "dynamics/modes/linearized.hpp"
#include "dynamics/modes/natural_modes.hpp"
#include "dynamics/modes/whirl.hpp"
#include "dynamics/run_parts.hpp"
#include "dynamics/start/start.hpp"
#include "system/brake.hpp"
#include "system/touching.hpp"

namespace hilo {
namespace {

/// What the modes say in run.json, and on the screen.
Json as_json(const std::vector<FoundMode>& modes) {
  const auto list = [](const Vec3& x) { return Json::list_of(x, [](double y) { return Json(y, 6); }); };
  return Json::list_of(
      modes,
      [&](const FoundMode& m) -> Json {
        const NaturalMode& f = m.figures;
        return {{"frequency", {f.frequency(), 12}},
                {"damping", {f.damping, 6}},
                {"mass", list(f.mass.head<3>())},
                {"inertia", list(f.mass.tail<3>())},
                {"error", {f.error, 3}}};
      },
      Json::In::lines);
}
std::string as_table(const std::vector<FoundMode>& modes, double mass) {
  std::string out = fmt::format("mode  frequency [Hz]  damping  effective mass along x, y, z, of {:.4g} kg [%]\n", mass);
  Vec3 sum = Vec3::Zero();
  for (size_t k = 0; k < modes.size(); ++k) {
    const NaturalMode& f = modes[k].figures;
    const Vec3 share = 100 / mass * f.mass.head<3>();
    sum += share;
    out += fmt::format("{:4}  {:14.6g}  {:7.4f}  {:7.2f} {:7.2f} {:7.2f}\n", k + 1, f.frequency(), f.damping, share[0], share[1], share[2]);
  }
  return out + fmt::format("{:31}{:7.2f} {:7.2f} {:7.2f}\n", "all of them", sum[0], sum[1], sum[2]);
}

class ModeSteps final : public Steps {
 public:
  ModeSteps(RunParts& run, Pause pause) : Steps(run, std::move(pause)), time_(run.scene.table("time")) {
    if (run.system.comm->size > 1) throw Error(time_.where("analysis"), "modes are found on one rank", "run it without mpirun");
  }
  void archive(Archive&) override {}  // one step, so nothing is kept within it

  void take() override {
    System& system = run_.system;
    State& rest = run_.state;
    set_rows(system, run_.redundancy.at_pose);
    const AcceleratedSupport support = accelerated_support(system, rest.q);
    if (!support.who.empty() && !support.all) tell_accelerated(support.who);
    const Vec3 carried = support.all.value_or(Vec3::Zero());
    if (time_.text("start") == "equilibrium") {
      const FeltLess at_rest(system, carried);
      if (!settle_down(run_)) return;
    }
    run_.figures.projected = run_.impulses.strike(system, *run_.solver, rest, run_.talk).change;
    if (!is_free(system))
      throw Error(time_.where("analysis"), "nothing is free to move: joints, drives and motions hold it all", "there are no modes");
    const bool spins = system.largest_rate(rest.v) > 0;
    consistent_acceleration(system, *run_.solver, rest, 1e-3);
    if (spins && !support.who.empty())
      throw Error(time_.where("analysis"), "modes of what spins are not found where " + support.who + " accelerates what it moves",
                  "let it begin without acceleration; gravity less the acceleration of a support does the same");
    if (const std::string why = spins ? not_steady(system, rest) : ""; !why.empty())
      throw Error(time_.where("analysis"), "modes are those of a state at rest, or of bodies that turn steadily in their places: " + why,
                  "see what [[initial]] gives");
    system.commit(rest.q);
    if (Touching* contacts = touching(system)) {
      if (spins)
        throw Error(time_.where("analysis"), "modes of what spins are not found where [[contact]] may hold it",
                    "leave out the spin or the contact");
      contacts->hold(rest.q);
    }
    run_.audit->start(rest);
    record_rest(rest, 1);
    Progress progress(run_.options.quiet, 0, time_.number("modes"));
    const int wanted = static_cast<int>(time_.number("modes"));
    State relative = rest;  // without the acceleration of supports
    const Config along = uniform(system, rest.q, carried);
    combine(relative.a, {{1, &rest.a}, {-1, &along}});
    for (size_t b = 0; b < rest.q.R.size(); ++b)  // nor what a steady spin has
      relative.a.R[b] -= rest.v.R[b] * rest.q.R[b].transpose() * rest.v.R[b];
    std::vector<FoundMode> modes;
    {
      const FeltLess at_rest(system, carried);
      modes = natural_modes(system, *run_.solver, relative, spins ? std::max(40, 3 * wanted) : wanted, !spins,
                            [&](int found) { progress.show(found, 0, 0); });
      if (!spins && time_.text("start") != "equilibrium") tell_unstressed(modes);
    }
    progress.done();
    check_rest(modes, system.largest_rate(relative.a));
    if (spins) modes = whirling_modes(system, *run_.solver, rest, modes, wanted);
    if (modes.empty()) throw Error(time_.where("analysis"), "nothing that has mass can move: there are no modes");
    tell_stuck(modes), tell_centrifugal();
    for (const FoundMode& m : modes) record(m);
    run_.lists.emplace_back("modes", as_json(modes));
    run_.report.table = as_table(modes, system.mass);
    run_.report.t = static_cast<double>(modes.size());
    for (const FoundMode& m : modes)
      if (!(m.figures.error < most_error))
        return run_.stop(
            fmt::format("the mode of {:.6g} Hz leaves {:.2g} of the equations of motion", m.figures.frequency(), m.figures.error));
    run_.report.complete = true;
  }

 private:
  /// Whether there are more unknowns than rows that hold them, which are independent.
  static bool is_free(const System& system) {
    size_t n = 0, held = 0;
    for (const UnknownField& f : system.unknowns) {
      n += 3 * f.size();
      for (size_t k = 0; k < f.size(); ++k) held += std::ranges::count(f.held_of(k), true);
    }
    for (const char on : system.rows_on()) held += on != 0;
    return n > held;
  }
  /// The force grows as its points move away from the axis, which takes speed^2 M off the stiffness across the axis.
  void tell_centrifugal() const {
    const auto softens = [](const Entry& e) { return e.text("card").starts_with("spin softening"); };
    if (std::ranges::any_of(run_.scene.entries("left_out"), softens)) return;  // told of already
    for (const Entry& load : run_.scene.entries("load"))
      if (load.kind == "centrifugal")
        warn(load.place.text(),
             fmt::format("{}: the model lacks spin softening: the load acts where things are drawn, and frequencies of motions across its "
                         "axis come out too high",
                         load.label()));
  }
  /// At rest friction of joints is a damper that lets nothing swing: a joint that sticks.
  void tell_stuck(const std::vector<FoundMode>& modes) const {
    for (const Entry& friction : run_.scene.entries("friction")) {
      const auto stuck = std::ranges::find_if(modes, [&](const FoundMode& m) {
        return m.figures.damping >= 1 && brake_of(m) == std::pair<std::string, std::string>{"friction", friction.name};
      });
      if (stuck == modes.end()) continue;
      warn(
          friction.place.text(),
          fmt::format("{}: at rest it is a damper of mu N r^2/slip_velocity, and mode {} has the damping ratio {:.3g}: a joint that sticks "
                      "is held by one of kind fixed in its place",
                      friction.label(), stuck - modes.begin() + 1, stuck->figures.damping));
    }
  }
  /// What takes most of the motion of a mode.
  std::pair<std::string, std::string> brake_of(const FoundMode& m) const {
    const System& system = run_.system;
    const State& rest = run_.state;
    Config way, before, after;
    combine(way, {{0, &rest.q}});
    system.add_rates(way, rest.q, m.x);
    const double h = 10, by = 1e-6 * system.length / std::max(1e-300, system.largest_rate(way)) * h / 2;
    combine(before, {{1, &rest.q}, {-by, &way}});
    combine(after, {{1, &rest.q}, {by, &way}});
    Stage s = stage_at(rest.q, rest.t);
    s.w0 = &before, s.w1 = &after, s.h = h, s.no_impacts = true;
    return takes_most(system, s, rest.lambda);
  }
  /// There is no rest beside a support that does not take all along alike.
  void tell_accelerated(const std::string& who) const {
    const std::string what = who + " accelerates what it moves at the start, and not everything alike";
    const char* hint = "let it begin without acceleration, or give that of a support as gravity";
    if (time_.text("start") == "equilibrium") throw Error(time_.where("start"), what + ": there is no equilibrium beside it", hint);
    warn(time_.where("analysis"), fmt::format("{}: modes are those of that instant, and not about a state of rest ({})", what, hint));
  }
  /// What is not at rest would come to rest where each mode has given way to its share of the forces.
  void check_rest(const std::vector<FoundMode>& modes, double acceleration) const {
    const System& system = run_.system;
    Config way;
    combine(way, {{0, &run_.state.q}});
    for (const FoundMode& m : modes) {
      if (std::abs(m.figures.omega2) <= 1e-9 * modes.back().figures.omega2) continue;
      std::vector<double> z = m.x;
      for (double& value : z) value *= m.figures.pull / std::abs(m.figures.omega2);
      system.add_rates(way, run_.state.q, z);
    }
    if (const double away = system.largest_rate(way); away > 1e-2 * system.length)
      warn(time_.where("analysis"),
           fmt::format("the state is not at rest: it accelerates by up to {:.3g} m/s^2, and rests about {:.2g} m away ({})", acceleration,
                       away, "start = \"equilibrium\" goes there"));
  }

  /// Modes of the drawn state lack the stress that the loads would bring: by how much that would change a mode, to first order, from the
  /// stiffness along it on either side of the drawn state.
  void tell_unstressed(const std::vector<FoundMode>& modes) const {
    constexpr double told = 0.04, farthest = 0.02;  // of the square of a frequency; of the scene's length
    constexpr size_t most = 20;                     // the lowest ones
    const System& system = run_.system;
    const State& drawn = run_.state;
    const bool floats = std::ranges::any_of(modes, [&](const FoundMode& m) { return m.is_rigid || !m.is_real; });
    if (modes.empty() || floats || touching(run_.system)) return;
    Linearized at(system, *run_.solver, drawn);
    const Eigen::VectorXd loads = at.loads();
    if (loads.isZero(0)) return;
    at.mean_omega2(), at.factor(0);
    Eigen::VectorXd u;
    std::vector<double> mu;
    try {
      at.solve(loads, u, &mu);
    } catch (const Error&) {
      return;  // there is no state of rest to compare with
    }
    const double way = system.largest_rate(at.rates_of(u));
    if (!(way > 0)) return;
    const double share = std::min(1.0, farthest * system.length / way);
    const auto stiffness = [&](double f) {
      State moved = drawn;
      std::vector<double> z(3 * static_cast<size_t>(system.n_blocks()), 0.0);
      for (Eigen::Index i = 0; i < u.size(); ++i) z[static_cast<size_t>(i)] = f * u[i];
      system.move(moved.q, z);
      for (size_t i = 0; i < mu.size(); ++i) moved.lambda[i] += f * mu[i];
      const Linearized there(system, *run_.solver, moved);
      std::vector<double> along;
      for (size_t k = 0; k < std::min(most, modes.size()); ++k) {
        const Eigen::Map<const Eigen::VectorXd> x(modes[k].x.data(), there.n());
        along.push_back(x.dot(there.stiffness(x)));
      }
      return along;
    };
    const std::vector<double> ahead = stiffness(share), behind = stiffness(-share);
    size_t worst = 0;
    double largest = 0;
    for (size_t k = 0; k < ahead.size(); ++k) {
      const double change = (ahead[k] - behind[k]) / (2 * share * modes[k].figures.omega2);
      if (std::abs(change) > std::abs(largest)) largest = change, worst = k;
    }
    if (!(std::abs(largest) > told)) return;
    warn(time_.where("analysis"),
         fmt::format("modes are those of the drawn state, without the stress of the loads: they would {} (start = \"equilibrium\" has it)",
                     largest > -1
                         ? fmt::format("change mode {} by about {:.2g} % in frequency", worst + 1, 100 * (std::sqrt(1 + largest) - 1))
                         : fmt::format("take away what holds mode {}", worst + 1)));
  }

  /// The shape, of a hundred thousandth of the scene at most, on the state of rest; forces as they are at its turning point.
  void record(const FoundMode& m) {
    System& system = run_.system;
    const State& rest = run_.state;
    State at = rest;
    at.t = static_cast<double>(run_.report.steps + 1);
    Config zero, shape, a;
    combine(zero, {{0, &rest.q}});
    shape = a = zero;
    std::vector<double> z = m.x;
    system.add_rates(shape, rest.q, z);
    const double amplitude = 1e-5 * system.length / std::max(1e-300, system.largest_rate(shape));
    for (double& value : z) value *= amplitude;
    system.move(at.q, z);
    for (size_t i = 0; i < m.mu.size(); ++i) at.lambda[i] += amplitude * m.mu[i];
    for (double& value : z) value *= -m.figures.omega2;
    system.add_rates(a, rest.q, z);
    Taken taken{stage_at(at.q, rest.t), at.lambda};
    taken.stage.a = &a;
    NaturalMode& now = system.part<ModeOutput>().now;
    now = m.figures;
    now.amplitude = m.is_real ? amplitude : 0;
    Ledger ledger = run_.audit->ledger();
    ledger.energy = system.energy(at.q, at.v);
    ledger.rows = system.violation(at.q, rest.t);
    run_.recorder->step(at, ledger, taken, a, 0);
    ++run_.report.steps;
  }

  const Entry& time_;
};

}  // namespace

std::unique_ptr<Steps> mode_steps(RunParts& run, Pause pause) { return std::make_unique<ModeSteps>(run, std::move(pause)); }

}  // namespace hilo
