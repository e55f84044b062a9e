// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "advise/judgement.hpp"

namespace hilo {
namespace {

constexpr double most_step = 0.8;  // of a tolerance: what a step may take of it before no model can be judged

}  // namespace

size_t Judgement::largest_step() const {
  size_t out = 0;
  for (size_t k = 1; k < a.step.size(); ++k)
    if (step_over(k) > step_over(out)) out = k;
  return out;
}

/// Error of the step of a model by (h, h/2) and its order of two.
std::string Judgement::take_step(const Candidate& c) {
  const Candidate& half = all.of({c.levels, 0.5, end_beside(c)});
  if (half.failure.empty()) a.step = part(c, half, 4. / 3);
  return half.failure;
}

/// How many times the step may be for a run to tell something of it: 2, 1.5 where filters need shorter ones than that, or 0: none may.
/// Measured are scenes without contacts, by the default method.
double Judgement::coarser() const {
  const Entry& time = all.scene().table("time");
  if (time.text("integrator") != "energy-momentum" || !all.scene().entries("contact").empty()) return 0;
  double most = 2;
  for (const Entry& q : all.scene().entries("quantity"))
    if (q.kind != "injury" && q.has("cfc")) most = std::min(most, 0.1 / q.number("cfc") / time.number("step"));
  return most >= 2 ? 2 : most >= 1.5 ? 1.5 : 0;
}

/// Half the step of the reference costs twice as much as the reference, twice the step half.  Of a machine that rings it alone may tell .1
/// of a tolerance where .9 is true, and so may the base alone, beyond its range.  Of 27 scenes the larger of both told at least .88 of the
/// largest error where that was above .17, and half of it below (docs/advise.md): the error is known where they tell at most .65.
bool Judgement::is_known_by_coarser() {
  constexpr double most_told = 0.65;
  const double times = coarser();
  if (times == 0 || !take_step(*a.base).empty()) return false;
  const double base = step_over(largest_step());
  if (base > most_told) return false;
  if (base <= 0.02) {  // it alone: the truth was up to twice as much then, but for one scene with ten times as much, of .12
    for (double& change : a.step) change *= 3;
    return true;
  }
  const double end = end_beside(*a.reference), coarse_step = times * all.scene().table("time").number("step");
  const Candidate& coarse = all.of({a.reference->levels, times, std::ceil(end / coarse_step - 1e-9) * coarse_step});
  if (!coarse.failure.empty()) return false;
  const std::vector<double> change = part(coarse, *a.reference, 1 / (times * times - 1));
  for (size_t k = 0; k < change.size(); ++k)
    if (std::abs(change[k]) > std::abs(a.step[k])) a.step[k] = change[k];
  return step_over(largest_step()) <= most_told;
}

/// What a step this long cannot tell no model will.  Far beyond its range the base may need other steps than the reference.
void Judgement::find_step() {
  const auto by_half = [&](const Candidate& c) {
    if (const std::string why = take_step(c); !why.empty()) throw Error("", "half the step does not run: " + why, "", Exit::not_converged);
    return step_over(largest_step()) <= most_step;
  };
  if (difference(*a.base, *a.reference) < 1 ? by_half(*a.base) : is_known_by_coarser()) return;
  if (!by_half(*a.reference)) refuse_step();
}

void Judgement::refuse_step() const {
  const size_t k = largest_step();
  const QuantityValue& v = a.reference->values[k];
  const Entry& time = all.scene().table("time");
  const std::string or_else =
      std::abs(a.step[k]) > std::abs(v.value) ? fmt::format("a tolerance in {} where it is about zero", v.unit) : "a larger tolerance";
  throw Error(
      time.where("step"),
      fmt::format("the step alone makes {:.3g} {} of \"{}\", of {:.3g} {} allowed", std::abs(a.step[k]), v.unit, v.name, v.allowed, v.unit),
      v.of.find(", raw") != std::string::npos
          ? "a raw acceleration holds all frequencies: give it a cfc"
          : fmt::format("time.step = {:.2g}, or {}", time.number("step") * std::sqrt(most_step / 2 / step_over(k)), or_else));
}

}  // namespace hilo
