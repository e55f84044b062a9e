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

/// Half the step of the reference costs twice as much as the reference.  Twice the step costs half, but of a machine that rings it alone
/// may tell .1 of a tolerance where .9 is true; so may the base alone, beyond its range.  The larger of both, by quantity, was never below
/// half the truth where it told less than `most_step` (docs/advise.md), so it serves as far as twice as much would not be too large.
/// `a.step` is of the base when it comes in.
bool Judgement::is_fine_by_twice() {
  const Entry& time = all.scene().table("time");
  if (time.text("integrator") != "energy-momentum" || !all.scene().entries("contact").empty()) return false;  // not measured
  const double base = step_over(largest_step()), twice_step = 2 * time.number("step");
  if (base <= 0.02) return true;
  for (const Entry& q : all.scene().entries("quantity"))
    if (q.kind != "injury" && q.has("cfc") && 10 * twice_step * q.number("cfc") > 1) return false;  // its filter needs shorter ones
  if (base > 0.25) return false;
  const Candidate& twice = all.of({a.reference->levels, 2, end_beside(*a.reference)});
  if (!twice.failure.empty()) return false;
  const std::vector<double> change = part(twice, *a.reference, 1. / 3);
  for (size_t k = 0; k < change.size(); ++k)
    if (std::abs(change[k]) > std::abs(a.step[k])) a.step[k] = change[k];
  return step_over(largest_step()) <= most_step / 2;
}

/// What a step this long cannot tell no model will.  Far beyond its range the base may need shorter steps than the reference, or longer
/// ones.
void Judgement::find_step() {
  const std::string failure = take_step(*a.base);
  const bool base_answers = difference(*a.base, *a.reference) < 1;
  if (failure.empty() && (base_answers ? step_over(largest_step()) <= most_step : is_fine_by_twice())) return;
  if (const std::string why = base_answers && !failure.empty() ? failure : take_step(*a.reference); !why.empty())
    throw Error("", "half the step does not run: " + why, "", Exit::not_converged);
  if (step_over(largest_step()) > most_step) refuse_step();
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
