// SPDX-License-Identifier: GPL-3.0-or-later
// *FREQUENCY and what sums its modes, *MODAL DYNAMIC or *STEADY STATE DYNAMICS, as one run of hilo: in time by the equations themselves, or
// an analysis of modes whose response hilo-post sums.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/param.hpp"
#include "import/inp/card.hpp"
#include "import/inp/passes.hpp"

namespace hilo {
namespace {

/// Increment and end of *MODAL DYNAMIC, or the band of *STEADY STATE DYNAMICS.
void read_modal(InpReading& r) {
  InpStep& s = step_of(r);
  s.procedure = r.card.name;
  if (r.step < 2) r.skip(r.card.name);  // of modes that another job has kept
  const bool sweep = r.card.key == "STEADYSTATEDYNAMICS";
  if (const auto odd = sweep ? unknown_param(r.card, {"SOLVER", "HARMONIC"}) : unknown_param(r.card, {"SOLVER", "DIRECT", "DELTMX"});
      !odd.empty())
    s.not_read = odd;
  if (sweep && r.card.word("HARMONIC") == "NO") s.not_read = r.card.name + ", HARMONIC=NO";
  DataLine l;
  if (!r.lines.next_data(l)) return;
  s.increment = l.number(0), s.end = l.number(1);
  if (sweep && l.fields.size() > 2 && l.number(2) >= 2) s.points = static_cast<int>(std::min(l.number(2), 1e6));
}

/// Ratios of ranges of modes; RAYLEIGH: factors of mass and stiffness.
void read_modal_damping(InpReading& r) {
  const bool rayleigh = r.card.has("RAYLEIGH");
  if (const auto odd = unknown_param(r.card, {"RAYLEIGH"}); !odd.empty() || r.step == 0) return r.skip(odd.empty() ? r.card.name : odd);
  InpModalDamping& m = r.deck.steps.back().damping;
  m.place = r.card.place();
  for (DataLine l; r.lines.next_data(l);) {
    if (rayleigh)
      m.alpha = l.number(2), m.beta = l.number(3), m.rayleigh = true;
    else
      m.ratios.push_back({l.number(0), l.number(1), l.number(2)});
  }
}

/// A line of the second step on a component takes the place of that of the first; false where both speak of a node by different names.
bool replace_supports(InpDeck& d) {
  std::vector<InpNodal> lines;
  for (const InpNodal& l : d.supports) {
    std::vector<InpNodal> left{l};
    for (const InpNodal& later : d.supports) {
      if (l.step > 1 || later.step != 2) continue;
      std::vector<InpNodal> parts;
      for (const InpNodal& part : left) {
        if (part.last < later.first || later.last < part.first) {
          parts.push_back(part);
          continue;
        }
        if (part.target != later.target || (part.target.empty() && part.id != later.id)) {
          auto one = numbers_in(d.nset, part), other = numbers_in(d.nset, later);
          std::ranges::sort(one), std::ranges::sort(other);
          std::vector<std::int64_t> both;
          std::ranges::set_intersection(one, other, std::back_inserter(both));
          if (!both.empty()) return false;
          parts.push_back(part);
          continue;
        }
        std::ranges::move(without(part, later.first, later.last), std::back_inserter(parts));
      }
      left = parts;
    }
    lines.insert(lines.end(), left.begin(), left.end());
  }
  d.supports = std::move(lines);
  return true;
}

/// The one ratio of all of these modes, or not a number.
double one_ratio(const InpModalDamping& m, int n_modes) {
  double upto = 0;
  std::vector<std::array<double, 3>> ratios = m.ratios;
  std::ranges::sort(ratios);
  for (const auto& [first, last, ratio] : ratios) {
    if (ratio != ratios.front()[2] || first > upto + 1) return std::nan("");
    upto = std::max(upto, last);
  }
  return n_modes > 0 && upto < n_modes ? std::nan("") : ratios.front()[2];
}

}  // namespace

void take_modal(InpDeck& d, Imported& in) {
  if (d.steps.size() < 2 || d.steps[0].procedure != "*FREQUENCY") return;
  const bool sweep = d.steps[1].procedure == "*STEADY STATE DYNAMICS";
  if ((!sweep && d.steps[1].procedure != "*MODAL DYNAMIC") || !d.steps[1].not_read.empty() || !d.steps[0].not_read.empty()) return;
  if (!replace_supports(d)) return;
  const int n_modes = d.steps[0].n_modes;
  InpStep s = d.steps[1];
  const std::string name = s.procedure;
  // what pushes in the step of the modes itself pushes nothing
  const auto of_modes = [&](const auto& l) {
    if (l.step != 1) return false;
    if (l.value != 0) in.skip("*CLOAD or *DLOAD in the step of *FREQUENCY", l.place);
    return true;
  };
  std::erase_if(d.forces, of_modes), std::erase_if(d.distributed, of_modes);
  for (auto* lines : {&d.supports, &d.forces})
    for (InpNodal& l : *lines) l.step = std::max(l.step > 0 ? 1 : 0, l.step - 1);
  for (InpDistributed& l : d.distributed) l.step = std::max(l.step > 0 ? 1 : 0, l.step - 1);
  for (InpBaseMotion& m : d.base_motions) m.step = std::max(1, m.step - 1);
  for (InpStepCard& c : d.step_cards) --c.step;
  std::erase_if(d.step_cards, [](const InpStepCard& c) { return c.step < 2; });
  d.steps.erase(d.steps.begin());
  s.ramps = false, s.modal = true;
  const InpModalDamping m = s.damping;
  const double ratio = m.ratios.empty() ? 0 : one_ratio(m, n_modes);
  s.alpha = m.alpha, s.beta = m.beta;
  if (std::isnan(ratio)) in.skip("*MODAL DAMPING of other ratios for other modes", m.place);
  if (!sweep) {
    s.procedure = "*DYNAMIC", s.ratio = std::isnan(ratio) ? 0 : ratio;
    in.notes.push_back(
        fmt::format("{}: {} becomes a run in time of all modes, large motions too (the step of *FREQUENCY alone gives frequencies){}",
                    s.place, name, s.ratio > 0 ? "; only linear regions have its *MODAL DAMPING (hilo-tag --rest linear)" : ""));
  } else {
    s.procedure = "*FREQUENCY", s.n_modes = n_modes;
    const auto constant = [&](auto& l) {
      if (!l.amplitude.empty()) in.skip("*AMPLITUDE over the frequency", l.place);
      l.amplitude.clear();
    };
    std::ranges::for_each(d.forces, constant), std::ranges::for_each(d.distributed, constant);
    for (InpNodal& l : d.supports)
      if (l.value != 0 || l.rate != 0)
        in.skip("*BOUNDARY with a displacement, a velocity or an acceleration that swings", l.place), l.value = 0, l.rate = 0,
                                                                                                      l.amplitude.clear();
    s.sweep = {s.increment, s.end, ratio > 0 ? ratio : 0, s.points};
    if (ratio > 0) in.skip("*MODAL DAMPING of one ratio", m.place, 1, false, fmt::format("hilo-post response --damping {:g}", ratio));
    s.increment = s.end = 0;
  }
  d.steps[0] = s;
}

std::vector<InpCard> inp_modal_cards() {
  return {
      {"MODALDYNAMIC", read_modal, false, true},
      {"STEADYSTATEDYNAMICS", read_modal, false, true},
      {"MODALDAMPING", read_modal_damping, false, true},
  };
}

}  // namespace hilo
