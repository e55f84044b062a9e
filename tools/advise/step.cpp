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

/// Does a run at twice the step tell something of the step of the reference?  Measured are scenes without contacts, by the default method.
bool Judgement::may_be_twice() const {
  const Entry& time = all.scene().table("time");
  for (const Entry& q : all.scene().entries("quantity"))
    if (q.kind != "injury" && q.has("cfc") && 20 * time.number("step") * q.number("cfc") > 1)
      return false;  // its filter needs shorter ones
  return time.text("integrator") == "energy-momentum" && all.scene().entries("contact").empty();
}

/// Half the step of the reference costs twice as much as the reference, twice the step half.  Of a machine that rings it alone may tell .1
/// of a tolerance where .9 is true, and so may the base alone, beyond its range.  The larger of both, by quantity, was at least .49 of the
/// truth in 27 scenes where it told less than `most_step` (docs/advise.md), so it serves as far as twice as much would not be too large.
/// `a.step` is that of the base when it comes in.
bool Judgement::is_fine_by_twice() {
  const double base = step_over(largest_step());
  if (base > 0.25) return false;
  if (base <= 0.02) {  // it alone: the truth was up to twice as much then
    for (double& change : a.step) change *= 3;
    return true;
  }
  const Candidate& twice = all.of({a.reference->levels, 2, end_beside(*a.reference)});
  if (!twice.failure.empty()) return false;
  const std::vector<double> change = part(twice, *a.reference, 1. / 3);
  for (size_t k = 0; k < change.size(); ++k)
    if (std::abs(change[k]) > std::abs(a.step[k])) a.step[k] = change[k];
  return step_over(largest_step()) <= most_step / 2;
}

/// What a step this long cannot tell no model will.  Far beyond its range the base may need other steps than the reference.
void Judgement::find_step() {
  const double off = difference(*a.base, *a.reference);
  if (off < 15 && (off < 1 || may_be_twice())) {
    const std::string why = take_step(*a.base);
    if (why.empty() && (off < 1 ? step_over(largest_step()) <= most_step : is_fine_by_twice())) return;
    if (off < 1 && !why.empty()) throw Error("", "half the step does not run: " + why, "", Exit::not_converged);
  }
  if (a.reference != a.base || a.step.empty())
    if (const std::string why = take_step(*a.reference); !why.empty())
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
