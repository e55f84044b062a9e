// SPDX-License-Identifier: GPL-3.0-or-later
// Supports that move by a velocity or an acceleration, and *BASE MOTION: a scene has displacements.  The second integral of an acceleration
// that is linear between its points is a cubic spline of them, with the slopes at its ends.  The integral of a velocity is close to one
// where each length of its table has several points.
#include <fmt/format.h>

#include <algorithm>

#include "base/error.hpp"
#include "import/inp/card.hpp"
#include "import/inp/passes.hpp"

namespace hilo {
namespace {

constexpr int points_of_length = 8;  // of a table of velocities, or of accelerations that jump

/// The integral of a course over a step, once or twice.
InpAmplitude integral(const InpAmplitude& course, int times, double period) {
  std::vector<double> t = course.t, a = course.value;
  if (t.front() > 0) t.insert(t.begin(), 0), a.insert(a.begin(), a.front());
  while (t.size() > 1 && t[1] <= 0) t.erase(t.begin()), a.erase(a.begin());  // what was before counts at the start alone
  if (t.front() < 0 && t.size() > 1) a.front() += (a[1] - a.front()) * (0 - t.front()) / (t[1] - t.front());
  t.front() = 0;
  if (t.back() < period) t.push_back(period), a.push_back(a.back());
  bool jumps = false;
  for (size_t i = 1; i < t.size(); ++i) jumps = jumps || t[i] <= t[i - 1];
  InpAmplitude out;
  double x = 0, v = times == 1 ? a.front() : 0, last_slope = v;  // of two integrals v is the first one
  out.t.push_back(0), out.value.push_back(0);
  const double first_slope = v;
  for (size_t i = 1; i < t.size(); ++i) {
    const double h = t[i] - t[i - 1], rise = a[i] - a[i - 1];
    if (!(h > 0)) {  // a jump
      if (times == 1) last_slope = a[i];
      continue;
    }
    const int n = (times == 1 && (rise != 0 || t.size() > 2)) || jumps ? points_of_length : 1;
    for (int k = 1; k <= n; ++k) {
      const double s = static_cast<double>(k) / n, d = s * h;
      out.t.push_back(t[i - 1] + d);
      out.value.push_back(times == 1 ? x + d * (a[i - 1] + s * rise / 2) : x + d * v + d * d * (a[i - 1] / 2 + s * rise / 6));
    }
    x = out.value.back();
    if (times == 2) v += h * (a[i - 1] + rise / 2);
    last_slope = times == 1 ? a[i] : v;
  }
  out.slopes = {first_slope, last_slope};
  return out;
}

void read_base_motion(InpReading& r) {
  const Card& card = r.card;
  if (const auto odd = unknown_param(card, {"DOF", "AMPLITUDE", "TYPE", "SCALE"}); !odd.empty()) return r.skip(odd);
  if (r.step == 0) throw Error(card.place() + ":1", "*BASE MOTION outside a *STEP");
  if (r.step > 1) r.deck.steps.back().not_read = card.name;
  InpBaseMotion m;
  const double dof = card.number("DOF");
  if (!(dof == 1 || dof == 2 || dof == 3 || dof == 4 || dof == 5 || dof == 6))
    throw Error(card.place("DOF"), fmt::format("*BASE MOTION, DOF={}", card.value("DOF")), "1 to 6");
  m.component = static_cast<int>(dof);
  m.amplitude = card.word("AMPLITUDE"), m.step = r.step, m.place = card.place();
  if (card.has("SCALE")) m.scale = card.number("SCALE");
  const std::string type = card.word("TYPE", "ACCELERATION");
  if (type != "DISPLACEMENT" && type != "VELOCITY" && type != "ACCELERATION")
    throw Error(card.place("TYPE"), "*BASE MOTION, TYPE=" + type, "DISPLACEMENT, VELOCITY or ACCELERATION");
  m.rate = type == "DISPLACEMENT" ? 0 : type == "VELOCITY" ? 1 : 2;
  r.deck.base_motions.push_back(m);
}

/// The components of a line that others hold go out of it; those of the base move.
void move_base(InpDeck& d, const InpBaseMotion& m, Imported& in) {
  const std::string procedure = d.steps[static_cast<size_t>(m.step) - 1].procedure;
  if (m.step > 1) return;  // told with its step
  if (procedure != "*DYNAMIC")
    return in.skip(fmt::format("*BASE MOTION of {}", procedure.empty() ? "a step without a procedure" : procedure), m.place);
  if (m.component > 3) return in.skip(fmt::format("*BASE MOTION on degree of freedom {}", m.component), m.place);
  std::vector<InpNodal> lines;
  bool any = false;
  for (const InpNodal& l : d.supports) {
    if (l.step > m.step || l.value != 0 || m.component < l.first || m.component > l.last) {
      lines.push_back(l);
      continue;
    }
    any = true;
    std::ranges::move(without(l, m.component, m.component), std::back_inserter(lines));
    InpNodal part = l;
    part.first = part.last = m.component;
    part.value = m.scale, part.amplitude = m.amplitude, part.rate = m.rate, part.place = m.place, part.step = m.step;
    lines.push_back(part);
  }
  if (!any) in.skip(fmt::format("*BASE MOTION on degree of freedom {}, which nothing holds", m.component), m.place);
  d.supports = std::move(lines);
}

/// A velocity or acceleration becomes a displacement, `known` by amplitude and rate; false where it cannot, which is told.
bool integrate(InpDeck& d, InpNodal& l, std::map<std::pair<std::string, int>, std::string>& known, Imported& in) {
  if (l.rate == 0 || l.value == 0) return true;  // no velocity, no acceleration: it stays
  const char* type = l.rate == 1 ? "VELOCITY" : "ACCELERATION";
  const InpStep* step = l.step > 0 ? &d.steps[static_cast<size_t>(l.step) - 1] : nullptr;
  const auto a = d.amplitudes.find(l.amplitude);
  if (!step || step->procedure != "*DYNAMIC")
    return in.skip(fmt::format("*BOUNDARY, TYPE={}, of {}", type, step ? step->procedure : "no step"), l.place), false;
  if (!l.amplitude.empty() && (a == d.amplitudes.end() || a->second.t.empty()))
    return in.skip(fmt::format("*BOUNDARY, TYPE={}, with *AMPLITUDE {}", type, l.amplitude), l.place), false;
  std::string& name = known[{l.amplitude, l.rate}];
  if (name.empty()) {
    InpAmplitude of = integral(l.amplitude.empty() ? InpAmplitude{"constant", {0}, {1}} : a->second, l.rate, step->period());
    const std::string wish =
        fmt::format("{}_{}", l.amplitude.empty() ? "constant" : a->second.name, l.rate == 1 ? "integral" : "integral_2");
    for (int i = 1; of.name.empty() || d.amplitudes.contains(upper(of.name)); ++i) of.name = i == 1 ? wish : fmt::format("{}_{}", wish, i);
    name = upper(of.name);
    d.amplitudes[name] = std::move(of);
  }
  l.amplitude = name;
  return true;
}

}  // namespace

void find_motions(InpDeck& d, Imported& in, double scale) {
  for (const InpBaseMotion& m : d.base_motions) move_base(d, m, in);
  std::map<std::pair<std::string, int>, std::string> known;
  std::vector<InpNodal> lines;
  for (InpNodal l : d.supports)
    if (integrate(d, l, known, in)) {
      if (l.rate > 0) l.value /= scale;
      lines.push_back(l);
    }
  d.supports = std::move(lines);
}

std::vector<InpCard> inp_motion_cards() { return {{"BASEMOTION", read_base_motion, false, true}}; }

}  // namespace hilo
