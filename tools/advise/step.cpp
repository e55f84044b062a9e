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
  const Candidate& half = all.of({c.levels, 0.5, c.end});
  if (half.failure.empty()) a.step = part(c, half, 4. / 3);
  return half.failure;
}

/// Do the filters of what is asked let a run have twice the step?
bool Judgement::may_be_twice() const {
  return std::ranges::none_of(all.scene().entries("quantity"), [&](const Entry& q) {
    return q.kind != "injury" && q.has("cfc") && 2 * all.scene().table("time").number("step") > 0.1 / q.number("cfc");
  });
}

/// Were steps of other lengths measured with such scenes? (docs/advise.md)
bool Judgement::is_measured_method() const {
  return all.scene().table("time").text("integrator") == "energy-momentum" && all.scene().entries("contact").empty();
}

/// Half the step of the reference costs twice as much as the reference, twice the step half.  Of a machine that rings it alone may tell .1
/// of a tolerance where .9 is true, and so may the base alone, which is `off` by so many tolerances.  Of 27 scenes the larger of both told
/// at least .88 of the largest error where that was above .17, and half of it below (docs/advise.md): the error is known where they tell at
/// most .65.  A base that is far off tells nothing; then twice the step must tell more than ringing hides.  Measured are scenes without
/// contacts, by the default method.
bool Judgement::is_known_by_twice(double off) {
  constexpr double most_told = 0.65, least_told = 0.2;
  if (!is_measured_method()) return false;
  const bool base_tells = off < 15;
  if (base_tells) {
    if (!take_step(*a.base).empty()) return false;
    const double base = step_over(largest_step());
    if (base <= 0.02) {  // the truth was up to twice as much then
      for (double& change : a.step) change *= 3;
      return true;
    }
    if (base > most_told) return false;
  } else {
    a.step.assign(a.reference->values.size(), 0);
  }
  if (!may_be_twice()) return false;
  const Candidate& twice = all.of({a.reference->levels, 2, a.reference->end});
  if (!twice.failure.empty()) return false;
  const std::vector<double> change = part(twice, *a.reference, 1. / 3);
  for (size_t k = 0; k < change.size(); ++k)
    if (std::abs(change[k]) > std::abs(a.step[k])) a.step[k] = change[k];
  const double told = step_over(largest_step());
  return told <= most_told && (base_tells || told >= least_told);
}

/// What a step this long cannot tell no model will.  Far beyond its range the base may need other steps than the reference.
void Judgement::find_step() {
  const auto by_half = [&](const Candidate& c) {
    if (const std::string why = take_step(c); !why.empty()) throw Error("", "half the step does not run: " + why, "", Exit::not_converged);
    a.is_by_half = true;
    return step_over(largest_step()) <= most_step;
  };
  a.is_by_half = false;
  const double off = difference(*a.base, *a.reference);
  if (off < 1 ? by_half(*a.base) : is_known_by_twice(off)) return;
  if (!by_half(*a.beside)) refuse_step();
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
      v.measured == Measured::raw_acceleration
          ? "a raw acceleration holds all frequencies: give it a cfc"
          : fmt::format("time.step = {:.2g}, or {}", all.written("s", time.number("step") * std::sqrt(most_step / 2 / step_over(k))),
                        or_else));
}

}  // namespace hilo
