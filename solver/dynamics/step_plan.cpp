// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/step_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dynamics/run.hpp"
#include "model/integrators.hpp"
#include "system/springs.hpp"

namespace hilo {
namespace {

constexpr double aim = 0.5, most = 1;  // of what is asked: error that a pass aims at, and that is good enough
constexpr double most_high = 0.8;      // the same of a high order, whose estimate is less exact
constexpr double most_before = 3;      // the same before the end
constexpr double sure = 12,            // times what is asked: distance of two solutions of one pass that needs no other,
    sure_of_springs = 1.5;             // and where something may vibrate
constexpr double other = 0.4;          // of a demand: another run than that, which may confirm it
constexpr double far_off = 50;         // of what is asked: a run with such an error confirms nothing
constexpr double much_better = 0.1;    // an error at the end that needs a reason
constexpr size_t most_passes = 12;
constexpr double steep = 64,
                 steepest = 1000;     // by which a demand falls at most, where an error is no small part of the motion, and where it is
constexpr double loosest = 1e-4;      // of the length: where a method may be chosen, a first pass asks no less
constexpr double many_steps = 5000;   // of second order: gauss is tried first,
constexpr double dear = 10;           // a step of it costs as much as this many of them: so long as it may be cheaper
constexpr double most_steps = 100;    // of a pass, over those of the first by the same method
constexpr double starting_steps = 6;  // until steps have grown to the longest
constexpr long fewest_steps = 8;      // of a run, which begins with sixteenths of it
constexpr double shortest = 0.3;      // of a demand: one more pass would not be much better
constexpr double least_step = 1e-14;  // of the length: smaller local errors of second order are round-off
constexpr double least_share = 1e-7;  // of the length: demands of methods above second order below it ask for round-off

/// Gauss is for rigid bodies here, serial.  Forces with kinks spoil any order above the second.
bool gauss_serves(const System& system) {
  if (system.comm->size > 1 || system.traits().deforms || system.layout.map.n_global > 1000) return false;
  return springs_are_smooth(system);
}

/// A demand to begin with.  Second order: the sum of local errors is what is asked.  Higher orders: a coarse one, since what the next pass
/// takes is many times dearer; a hundred-thousandth of the length in steps of .7 rad.
double first_demand(double asked, int order, double length, double end) {
  if (order == 2) return asked / end;
  return 0.02 * length * std::min(1.0, std::pow(asked / length / 1e-5, 3.0 / order));
}

}  // namespace

StepPlan first_plan(const Scene& scene, const System& system) {
  const Entry& time = scene.table("time");
  StepPlan plan;
  const std::string& method = time.text("integrator");
  if (time.text("analysis") == "dynamic" && time.has("tolerance")) {
    plan.asked = time.number("tolerance") * system.length;
    plan.chooses_method =
        !time.given("integrator") && !time.given("dissipation") && time.text("error_estimate") != "never" && gauss_serves(system);
    const int order = method == Gauss::name ? 6 : method == Radau::name ? 5 : 2;
    const double first = plan.chooses_method ? std::max(plan.asked, loosest * system.length) : plan.asked;
    plan.passes.push_back({method, first_demand(first, order, system.length, time.number("end"))});
  } else {
    plan.passes.push_back({method});
  }
  return plan;
}

bool plan_another(StepPlan& plan, const RunReport& report, const Config& q, const ErrorEstimate& estimate, int order, const System& system,
                  double end) {
  StepPlan::Pass& now = plan.passes.back();
  now.error = estimate.end(), now.steps = report.steps;
  if (plan.asked == 0 || report.stopped) return false;
  const double power = order == 2 ? 1 : order / 3.0;  // of the demand, to which the error falls
  const StepPlan::Pass *first = &now, *before = nullptr, *second_order = nullptr;
  int by_method = 1;
  for (const StepPlan::Pass& p : plan.passes) {
    if (&p == &now) break;
    if (p.method == now.method) before = &p, first = by_method++ == 1 ? &p : first;
    if (p.method == EnergyMomentum::name) second_order = &p;
  }
  const double changed = before ? apart(system, q, plan.end) : 0;
  plan.end = q;
  const auto says = [&](const std::string& why) { return plan.unmet = why, false; };
  const auto again = [&](const std::string& method, double demand) {
    plan.passes.push_back({method, demand});
    return true;
  };
  /// By energy-momentum, where another method was chosen that does not serve.
  const auto fall_back = [&](const std::string& why) {
    if (!plan.chooses_method || order == 2) return says(why);
    const double known = second_order ? second_order->demand * aim * plan.asked / second_order->error : 0;
    const double pieces = known > 0 ? static_cast<double>(second_order->steps) * std::sqrt(second_order->demand / known) : 0;
    const bool is_far =
        known > 0 && (pieces > most_steps * static_cast<double>(second_order->steps) || known * end / pieces < least_step * system.length);
    if (is_far && report.complete) return says(why);
    plan.chooses_method = false;
    const std::string method(EnergyMomentum::name);
    return again(method, is_far ? second_order->demand / steep : known > 0 ? known : first_demand(plan.asked, 2, system.length, end));
  };
  if (!report.complete) return order > 2 && fall_back("");
  if (plan.passes.size() >= most_passes) return says(fmt::format("{} runs with ever shorter steps did not reach it", plan.passes.size()));

  if (estimate.rounding(end) > plan.asked) return says("the motion is chaotic: by the end it makes more of rounding alone, at any step");
  // The leading term of a high order rules late: two passes tell whether their estimates hold.  One is enough where the distance of its two
  // solutions is small whatever the order, from the third on: there it is 7 times the error.  A vibration that steps do not resolve has no
  // order: there it is the error.
  const double enough = is_sprung(system) ? sure_of_springs : sure;
  const bool is_whole = estimate.is_there() && estimate.splits() == 0;
  const double at_worst = std::max(now.error, estimate.largest() / most_before) * (std::pow(2.0, order) - 1) / enough;
  const bool is_sure = is_whole && at_worst <= plan.asked;
  const bool agrees =
      before && now.demand <= other * before->demand && before->error <= far_off * plan.asked && changed <= 2 * (before->error + now.error);
  const bool holds = order == 2 ? estimate.is_there() : is_sure || (is_whole && agrees);
  const bool is_met = now.error <= (order == 2 ? most : most_high) * plan.asked && estimate.largest() <= most_before * plan.asked;
  if (!holds) {
    const double less = is_whole ? std::clamp(std::pow(0.8 * plan.asked / at_worst, 1 / power), 0.1, 0.7) : 0.1;
    const double steps = static_cast<double>(now.steps) * std::pow(less, -1. / 3);
    // of second order, from its own pass
    const double others = second_order ? static_cast<double>(second_order->steps) * std::sqrt(second_order->error / (aim * plan.asked)) : 0;
    if (by_method > 3 && dear * steps > others)
      return fall_back("the error is not known: " + (estimate.is_there() ? "passes do not agree with it" : estimate.why()));
    return again(now.method, less * now.demand);
  }
  if (is_met) return false;
  double seen = power;
  if (before && before->error > 0)
    seen = std::clamp(std::log(before->error / now.error) / std::log(before->demand / now.demand), power / 2, power);
  double less = std::pow(aim * plan.asked / std::max(now.error, estimate.largest() / most_before), 1 / seen);
  less = std::max(less, 1 / (estimate.share(now.error) > 0.05 ? steep : steepest));
  const std::string lack = fmt::format("{:.3g} m at the end where {:.3g} m are asked", now.error, plan.asked);
  // Where the error falls slower than those of single steps, as with kinks of forces, these become round-off first.
  const double least = std::pow(least_step * system.length * static_cast<double>(now.steps) / (now.demand * end), 2. / 3);
  if (order == 2 && less < least) {
    if (least > shortest) return says(lack + ": errors of single steps are round-off already");
    less = least;
  }
  const double demand = less * now.demand, steps = static_cast<double>(now.steps) * std::pow(less, order == 2 ? -1. / 2 : -1. / 3);
  const bool knows_gauss = std::ranges::any_of(plan.passes, [](const StepPlan::Pass& p) { return p.method == Gauss::name; });
  if (order == 2 && plan.chooses_method && !knows_gauss && steps > many_steps)
    return again(std::string(Gauss::name), first_demand(plan.asked, 6, system.length, end));
  if (order > 2 && demand < least_share * system.length) return fall_back(lack + ": steps as short as that are lost in round-off");
  if (steps > most_steps * static_cast<double>(first->steps))
    return says(fmt::format("{}: that would need about {:.2g} steps instead of {}", lack, steps, now.steps));
  return again(now.method, demand);
}

double longest_step(const Entry& time) { return time.has("step") ? time.number("step") : time.number("end") / 20; }

std::string why_better(const StepPlan& plan, const RunReport& report, const ErrorEstimate& estimate, int order, double length,
                       const Entry& time) {
  if (plan.asked == 0 || !report.complete || !plan.unmet.empty() || !estimate.is_there()) return "";
  if (estimate.end() >= much_better * plan.asked) return "";
  if (estimate.largest() < 1e-12 * length) return "the method makes no error in this motion but rounding";
  if (estimate.largest() >= much_better * plan.asked)
    return fmt::format("it was {:.2g} m at t = {:.3g} s and is smaller at the end", estimate.largest(), estimate.largest_t());
  if (static_cast<double>(report.steps) <= 1.5 * time.number("end") / longest_step(time) + starting_steps)
    return "steps are as long as time.step allows";
  if (report.steps <= fewest_steps) return "these are the fewest steps that a run takes: it begins with sixteenths of its time";
  if (order > 2 && plan.passes.size() > 1 && plan.passes[plan.passes.size() - 2].method == plan.now().method)
    return fmt::format("steps by {} that resolve the motion are this good, and {} longer ones did not resolve it", plan.now().method,
                       plan.passes[plan.passes.size() - 2].steps);
  return order > 2 ? fmt::format("the longest steps by {} that were tried are this good", plan.now().method)
                   : "the errors of single steps, which chose their length, cancel";
}

}  // namespace hilo
