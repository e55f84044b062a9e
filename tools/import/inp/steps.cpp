// SPDX-License-Identifier: GPL-3.0-or-later
// A load of a step stays in the next ones until it is given anew (OP=MOD) or all of its kind are (OP=NEW).  Without an amplitude it goes
// in static steps from the value it had to its own, over the step, and has its own at once in dynamic ones [Abaqus, CalculiX], or where
// *STEP says AMPLITUDE=STEP.  A load without a history grows from nothing in a static run: one that is there at once has a history of 1.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "import/inp/passes.hpp"

namespace hilo {
namespace {

using Points = std::vector<std::pair<double, double>>;  // time, value

/// A load or support of the deck over its steps: what it has in each, and in which it is.
struct Item {
  size_t line = 0;  // the first that speaks of it
  struct Given {
    bool is = false, gone = false;  // given in this step; taken away by OP=NEW
    double value = 0;
    std::string amplitude;
  };
  std::vector<Given> step;
};

/// What one run cannot say.
struct Cannot {
  std::string why, place;
};

/// The key of a new amplitude.
std::string amplitude_of(InpDeck& d, const Points& points) {
  InpAmplitude a;
  for (int i = 1; a.name.empty() || d.amplitudes.contains(upper(a.name)); ++i) a.name = i == 1 ? "steps" : fmt::format("steps_{}", i);
  for (const auto& [t, x] : points) a.t.push_back(t), a.value.push_back(x);
  d.amplitudes[upper(a.name)] = a;
  return upper(a.name);
}

using Face = std::tuple<std::int64_t, int, std::array<double, 3>>;  // element, face, direction

std::array<double, 3> direction_of(const InpDistributed& l) { return {l.direction.x(), l.direction.y(), l.direction.z()}; }

/// What a load by face or by length is on; none of gravity and CENTRIF, of which elements have the sum of their sets.
std::vector<Face> faces_of(const InpDeck& d, const InpDistributed& l) {
  std::vector<Face> out;
  const auto add = [&](const InpTarget& t, int first, int last) {
    for (const auto id : numbers_in(d.elset, t))
      for (int face = first; face <= last; ++face) out.emplace_back(id, face, direction_of(l));
  };
  if (l.face == 0) {
    for (const InpSurface& s : d.surfaces)
      if (upper(s.name) == l.target)
        for (const auto& part : s.lines) part.face == 0 ? add(part, 1, 6) : add(part, part.face, part.face);
  } else if (l.face != -1 && l.face != -2)
    add(l, l.face, l.face);
  return out;
}

/// A load for each face where a later step speaks of faces by another set, number or surface.
std::vector<InpDistributed> by_face(const InpDeck& d, const std::vector<InpDistributed>& lines) {
  std::map<Face, std::set<std::pair<std::string, std::int64_t>>> names;
  bool anew = false;
  for (const InpDistributed& l : lines)
    for (const Face& f : faces_of(d, l)) {
      auto& said = names[f];
      said.insert({l.face == 0 ? "surface " + l.target : l.target, l.target.empty() ? l.id : 0});
      anew = anew || (said.size() > 1 && l.step > 1);
    }
  if (!anew) return lines;
  std::vector<InpDistributed> out;
  for (const InpDistributed& l : lines) {
    const auto faces = faces_of(d, l);
    if (std::ranges::none_of(faces, [&](const Face& f) { return names[f].size() > 1; })) {
      out.push_back(l);
      continue;
    }
    for (const InpSurface& s : d.surfaces)
      if (l.face == 0 && upper(s.name) == l.target)
        if (std::ranges::any_of(s.lines, [](const auto& part) { return part.face == 0 || part.of_shell; }))
          throw Cannot{fmt::format("a pressure on a part of surface {}", s.name), l.place};
    for (const auto& [id, face, direction] : faces) {
      InpDistributed& one = out.emplace_back(l);
      one.target.clear(), one.id = id, one.face = face;
    }
  }
  return out;
}

class Joiner {
 public:
  Joiner(InpDeck& d, size_t n) : d_(d), n_(n) {
    const auto& last = d.steps[n - 1];
    // what comes before the first step of the run is its start, in equilibrium
    if (last.procedure == "*FREQUENCY")
      first_ = n;
    else if (last.procedure == "*DYNAMIC")
      while (d.steps[first_].procedure == "*STATIC") ++first_;
  }

  InpPlan plan() {
    InpPlan p{d_.steps[n_ - 1]};
    p.increment = p.end = 0, p.direct = true, p.from_equilibrium = first_ > 0;
    for (size_t k = first_; k < n_; ++k) {
      const InpStep& s = d_.steps[k];
      p.end += s.period();
      const double given = s.increment > 0 ? s.increment : s.period();
      p.increment = p.increment > 0 ? std::min(p.increment, given) : given;
      p.direct = p.direct && s.direct;
    }
    p.steps = static_cast<int>(n_ - std::min(first_, n_));
    d_.supports = joined(apart(d_, d_.supports, 2), &InpStep::new_supports, true);
    d_.forces = joined(apart(d_, d_.forces, 2), &InpStep::new_forces, false);
    d_.distributed = joined(by_face(d_, d_.distributed), &InpStep::new_distributed, false);
    return p;
  }

 private:
  static size_t index(int step) { return static_cast<size_t>(std::max(step, 1) - 1); }

  /// What lines have in common that speak of the same.
  using Key = std::tuple<std::string, std::int64_t, int, std::array<double, 3>>;
  static Key key_of(const InpNodal& l) { return {l.target, l.target.empty() ? l.id : 0, l.first, {}}; }
  static Key key_of(const InpDistributed& l) {
    return {l.target, l.target.empty() ? l.id : 0, l.face, l.face == -2 ? std::array<double, 3>{} : direction_of(l)};
  }

  template <class Line>
  std::vector<Line> joined(const std::vector<Line>& lines, bool InpStep::*anew, bool support) {
    std::map<Key, size_t> known;
    std::vector<Item> items;
    for (size_t i = 0; i < lines.size(); ++i) {
      const Line& l = lines[i];
      if (index(l.step) >= n_) continue;
      const auto [at, fresh] = known.try_emplace(key_of(l), items.size());
      if (fresh) items.push_back({i, std::vector<Item::Given>(n_)});
      require_same_axis(lines[items[at->second].line], l);
      give(items[at->second], l.step, l.value, l.amplitude, !support, l.place);
    }
    remove(items, anew);
    std::vector<Line> out;
    for (const Item& item : items) {
      Line l = lines[item.line];
      if (support) require_always(item, l.place);
      if (course(item, l.value, l.amplitude, l.place) || support) out.push_back(l);
    }
    return out;
  }

  static void require_same_axis(const InpNodal&, const InpNodal&) {}
  static void require_same_axis(const InpDistributed& a, const InpDistributed& b) {
    if (a.face == -2 && !is_same_axis(a, b)) throw Cannot{"CENTRIF about another axis than before", b.place};
  }

  void give(Item& item, int step, double value, const std::string& amplitude, bool add, const std::string& place) const {
    Item::Given& g = item.step[index(step)];
    if (add && g.is && g.amplitude != amplitude) throw Cannot{"a load given twice in a step, with two amplitudes", place};
    g.value = value + (add && g.is ? g.value : 0), g.is = true, g.amplitude = amplitude;
  }

  /// OP=NEW in a step takes away what it does not give.
  void remove(std::vector<Item>& items, bool InpStep::*anew) const {
    for (size_t k = 1; k < n_; ++k)
      if (d_.steps[k].*anew)
        for (Item& item : items) item.step[k].gone = !item.step[k].is;
  }

  /// What is held is held in all steps.
  void require_always(const Item& item, const std::string& place) const {
    if (!item.step[0].is) throw Cannot{"a support that is not there from the first step on", place};
    for (size_t k = 1; k < n_; ++k)
      if (item.step[k].gone) throw Cannot{"a support that is taken away", d_.steps[k].place};
  }

  double at(const std::string& amplitude, double t, const std::string& place) const {
    const auto a = d_.amplitudes.find(amplitude);
    if (a == d_.amplitudes.end() || a->second.t.empty()) throw Cannot{"an amplitude that is not read", place};
    const auto &x = a->second.t, &y = a->second.value;
    if (t <= x.front()) return y.front();
    const auto next = static_cast<size_t>(std::upper_bound(x.begin(), x.end(), t) - x.begin());
    if (next == x.size()) return y.back();
    return y[next - 1] + (y[next] - y[next - 1]) * (t - x[next - 1]) / (x[next] - x[next - 1]);
  }

  /// The value and the amplitude of what has this course; false where it is nothing all the time.
  bool course(const Item& item, double& value, std::string& amplitude, const std::string& place) {
    Points points;
    const auto put = [&](double t, double x) {
      if (points.empty() || points.back() != std::pair{t, x}) points.emplace_back(t, x);
    };
    double now = 0, total = 0, t0 = 0;
    std::string going;  // its amplitude from the step before
    for (size_t k = 0; k < n_; ++k) {
      const InpStep& s = d_.steps[k];
      const Item::Given& g = item.step[k];
      const double P = s.period();
      if (s.procedure == "*FREQUENCY") break;
      const bool in_run = k >= first_;
      const bool has_amplitude = g.is && !g.amplitude.empty();
      if (in_run && !(k == 0 && (has_amplitude || !s.ramps))) put(t0, now);
      // a run from equilibrium has what was there before at its start, as a static step has at its end, and what is there at once behind a
      // billionth of the step
      const double at_once = k > 0 && (k == first_ || s.procedure == "*STATIC") ? t0 + 1e-9 * P : t0;
      if (has_amplitude) {
        const auto a = d_.amplitudes.find(g.amplitude);
        if (a != d_.amplitudes.end() && !a->second.slopes.empty())
          throw Cannot{"a support that moves by a velocity or an acceleration", place};
        if (a != d_.amplitudes.end() && a->second.total && total > 0) throw Cannot{"an amplitude over the time of all steps", place};
        if (in_run) {
          put(at_once, g.value * at(g.amplitude, 0, place));
          for (size_t i = 0; i < a->second.t.size(); ++i)
            if (const double t = a->second.t[i]; t0 + t > at_once && t < P) put(t0 + t, g.value * a->second.value[i]);
        }
        now = g.value * at(g.amplitude, P, place), going = g.amplitude;
      } else if (g.is || g.gone) {
        now = g.is ? g.value : 0, going.clear();
        if (in_run && !s.ramps) put(at_once, now);
      } else if (!going.empty()) {
        throw Cannot{"a load that goes on from a step in which it has an amplitude", place};
      }
      if (in_run) put(t0 + P, now), t0 += P;
      total += P;
    }
    amplitude.clear(), value = now;
    const bool constant = std::ranges::all_of(points, [&](const auto& p) { return p.second == now; });
    if (constant && (now == 0 || d_.steps[n_ - 1].procedure != "*STATIC")) return now != 0;
    if (constant) points = {points.front(), points.back()};
    for (const auto& [t, x] : points)
      if (std::abs(x) > std::abs(value)) value = x;
    for (auto& [t, x] : points) x /= value;
    const auto [known, fresh] = courses_.try_emplace(points, "");
    if (fresh) known->second = amplitude_of(d_, points);
    amplitude = known->second;
    return true;
  }

  InpDeck& d_;
  size_t n_, first_ = 0;  // steps, and the first of the run itself
  std::map<Points, std::string> courses_;
};

/// How many steps one run can be, by what they compute; why not more.
size_t longest(const InpDeck& d, std::string& why) {
  for (size_t k = 1; k < d.steps.size(); ++k) {
    const InpStep &before = d.steps[k - 1], &s = d.steps[k];
    const bool is_static = s.procedure == "*STATIC", is_dynamic = s.procedure == "*DYNAMIC", is_modes = s.procedure == "*FREQUENCY";
    const bool nonlinear =
        std::any_of(d.steps.begin(), d.steps.begin() + static_cast<std::ptrdiff_t>(k), [](const InpStep& x) { return x.nlgeom; });
    why.clear();
    if (!s.not_read.empty())
      why = s.not_read + " is not read";
    else if (s.procedure == "*BUCKLE")
      why = "*BUCKLE is another run, without the loads of the steps before it";
    else if (!is_static && !is_dynamic && !is_modes)
      why = s.procedure.empty() ? "it computes what is not read" : s.procedure + " is not read";
    else if (before.procedure != "*STATIC" && !(before.procedure == "*DYNAMIC" && is_dynamic))
      why = fmt::format("{} after {} is another run", s.procedure, before.procedure.empty() ? "another analysis" : before.procedure);
    else if (s.perturbation && !is_modes)
      why = "PERTURBATION is another run";
    else if (is_modes && !s.perturbation && !nonlinear)
      why = "*FREQUENCY without PERTURBATION is that of the unloaded model, another run";
    else if (is_dynamic && !d.velocities.empty())
      why = "initial velocities after *STATIC";
    if (!why.empty()) return k;
  }
  return d.steps.size();
}

}  // namespace

bool is_same_axis(const InpDistributed& a, const InpDistributed& b) {
  const Vec3 off = b.at - a.at;
  return a.direction.cross(b.direction).norm() + a.direction.cross(off).norm() <= 1e-9 * (1 + off.norm());
}

std::vector<InpNodal> apart(const InpDeck& d, const std::vector<InpNodal>& lines, int from_step, bool vectors) {
  std::map<std::pair<std::int64_t, int>, std::set<std::pair<std::string, std::int64_t>>> names;  // of node and component
  bool overlap = false;
  for (const InpNodal& l : lines)
    for (const auto node : numbers_in(d.nset, l))
      for (int k = l.first; k <= l.last; ++k) {
        auto& said = names[{node, vectors ? 0 : k}];
        said.insert({l.target, l.target.empty() ? l.id : 0});
        overlap = overlap || (said.size() > 1 && l.step >= from_step);
      }
  std::vector<InpNodal> out;
  for (const InpNodal& l : lines)
    for (const auto node : overlap ? numbers_in(d.nset, l) : std::vector{l.id})
      for (int k = l.first; k <= l.last; ++k) {
        InpNodal& one = out.emplace_back(l);
        one.first = one.last = k, one.id = node;
        if (overlap) one.target.clear();
      }
  return out;
}

/// What AMPLITUDE of the only *STEP says of lines without an amplitude.  In a static one all are there at once, which needs a history only
/// beside lines with an amplitude: else one ramp of all of them ends where they do.
static void say_amplitude_of_step(InpDeck& d) {
  const InpStep& s = d.steps[0];
  bool any = false;
  const auto each = [&](const auto& does) {
    for (auto* lines : {&d.supports, &d.forces}) std::ranges::for_each(*lines, does);
    std::ranges::for_each(d.distributed, does);
  };
  each([&](const auto& l) { any = any || (!l.amplitude.empty() && l.value != 0); });
  const bool at_once = s.procedure == "*STATIC" && !s.ramps && any, grows = s.procedure == "*DYNAMIC" && s.ramps;
  if (!at_once && !grows) return;
  std::string name;
  each([&](auto& l) {
    if (!l.amplitude.empty() || l.value == 0) return;
    if (name.empty()) name = amplitude_of(d, {{0, at_once ? 1 : 0}, {s.period(), 1}});
    l.amplitude = name;
  });
}

std::vector<InpNodal> without(const InpNodal& line, int first, int last) {
  std::vector<InpNodal> parts{line, line};
  parts[0].last = std::min(line.last, first - 1), parts[1].first = std::max(line.first, last + 1);
  std::erase_if(parts, [](const InpNodal& part) { return part.first > part.last; });
  return parts;
}

void join_steps(InpDeck& d, Imported& in) {
  if (d.steps.empty()) return;
  std::string why, place;
  size_t n = longest(d, why);
  for (;; --n) {
    if (n == 1) {
      d.plan = {d.steps[0]};
      std::erase_if(d.supports, [](const InpNodal& l) { return l.step > 1; });
      std::erase_if(d.forces, [](const InpNodal& l) { return l.step > 1; });
      std::erase_if(d.distributed, [](const InpDistributed& l) { return l.step > 1; });
      say_amplitude_of_step(d);
      break;
    }
    const auto kept = std::tuple{d.supports, d.forces, d.distributed, d.amplitudes};
    try {
      d.plan = Joiner(d, n).plan();
      break;
    } catch (const Cannot& c) {
      std::tie(d.supports, d.forces, d.distributed, d.amplitudes) = kept, why = c.why + (c.place.empty() ? "" : ", " + c.place);
    }
  }
  if (n > 1)
    in.notes.push_back(fmt::format("{}: steps 1 to {} become one run{}", d.steps[n - 1].place, n,
                                   d.plan.from_equilibrium ? ", which begins from the equilibrium of the static ones" : ""));
  if (n < d.steps.size()) {
    in.notes.push_back(n == 1 ? fmt::format("{}: only the first step becomes scene lines: {}", d.steps[1].place, why)
                              : fmt::format("{}: steps {} and later do not become scene lines: {}", d.steps[n].place, n + 1, why));
    for (const InpStepCard& c : d.step_cards)
      if (static_cast<size_t>(c.step) > n) in.skip(fmt::format("{} in step {} and later", c.name, n + 1), c.place);
  }
}

}  // namespace hilo
