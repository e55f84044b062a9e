// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/time_schema.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <deque>

#include "model/integrators.hpp"

namespace hilo {
namespace {

/// A text that stays, for the tables.
std::string_view kept(std::string text) {
  static std::deque<std::string> texts;
  return texts.emplace_back(std::move(text));
}

/// What methods there are.
std::string_view methods() {
  std::vector<std::string> out;
  for (const IntegratorWords& m : integrator_words()) out.push_back(fmt::format("{}: {}", m.name, m.meaning));
  return kept(fmt::format("method; {}", fmt::join(out, "; ")));
}

/// Keys that methods bring, each told with the methods that have it.
std::vector<Param> keys_of_methods() {
  std::vector<Param> out;
  for (const IntegratorWords& method : integrator_words())
    for (const Param& p : method.keys) {
      if (std::any_of(out.begin(), out.end(), [&](const Param& known) { return known.key == p.key; })) continue;
      std::vector<std::string_view> who;
      for (const IntegratorWords& other : integrator_words())
        if (std::any_of(other.keys.begin(), other.keys.end(), [&](const Param& of) { return of.key == p.key; })) who.push_back(other.name);
      out.push_back(p), out.back().meaning = kept(fmt::format("{}: {}", fmt::join(who, ", "), p.meaning));
    }
  return out;
}

}  // namespace

KindSchema time_schema() {
  using enum Type;
  std::vector<Param> keys{
      {"end", number, "s", "", "end of the run", above(0)},
      {"step", number, "s", "", "time step", above(0)},
      {"start", text, "", "as given", "as given, or equilibrium: a static solve first"},
      {"tolerance", number, "1", "",
       "error of positions at the end, as a fraction of the scene's length: chooses the steps, `step` being the largest, and where no "
       "`integrator` is named the method: energy-momentum, gauss where that needs fewer",
       from_to(1e-13, 1)},
      {"error_estimate", text, "", "auto",
       "how the error of positions is estimated: always, by a second solution at twice the step; steps, by the sum of what single steps "
       "add; auto, "
       "the second solution with `tolerance` and in scenes of up to 900 unknowns, else steps; never"},
      {"integrator", text, "", integrator_words()[0].name, methods()}};
  for (const Param& p : keys_of_methods()) keys.push_back(p);
  keys.push_back({"steps", number, "1", "1",
                  "load steps of a static analysis, over which gravity and loads without a history grow; of a path, about how many the "
                  "whole load would need at first",
                  from_to(1, 1e6)});
  keys.push_back({"reach", number, "m", "", "displacement at which a path ends; without, it ends where it has the whole load", above(0)});
  keys.push_back({"modes", number, "1", "10", "how many modes an analysis of modes or buckling looks for, the lowest", from_to(1, 1000)});
  keys.push_back({"analysis", text, "", "dynamic",
                  "dynamic; static (histories then run from 0 to `end`, 1 when absent); path: static, loads grow and shrink as the path of "
                  "equilibrium has it; modes: natural frequencies about the state at the start; buckling: factors of the loads at which "
                  "the drawn state gives way, as a "
                  "linear problem of eigenvalues"});
  integrator_words().close();
  return {"time", "", "the time axis", std::move(keys)};
}

}  // namespace hilo
