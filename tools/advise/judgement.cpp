// SPDX-License-Identifier: GPL-3.0-or-later
#include "advise/judgement.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace hilo {

double over(double difference, double allowed) { return std::abs(difference) / std::max(allowed, 1e-300); }

std::vector<double> part(const Candidate& c, const Candidate& other, double factor) {
  std::vector<double> out;
  for (size_t k = 0; k < c.values.size(); ++k) {
    const double change = factor * (other.values[k].value - c.values[k].value);
    out.push_back(std::isfinite(change) ? change : HUGE_VAL);
  }
  return out;
}

double Advice::with_step(double off, size_t k) const {
  const double apart = std::abs(off) + std::abs(step[k]);
  return is_by_half && reference->step == 1 ? std::min(apart, std::abs(off - step[k]) + 0.25 * std::abs(step[k])) : apart;
}

Judgement::Judgement(Candidates& all_models, const SearchOptions& options) : all(all_models), o(options), n(all_models.names().size()) {
  a.tightest = o.tightest;
  find_contacts();
  find_base();
  find_reference();
}

Assignment Judgement::with(Level level) const {
  Assignment out(n, level);
  for (const auto& [r, kept] : o.kept) out[r] = kept;
  for (const auto& [r, why] : a.kept_rigid) out[r] = Level::rigid;
  return all.consistent(out);
}

/// A run of cells ends where all quantities have their values.
Request Judgement::request(const Assignment& levels) const {
  const bool cells = std::any_of(levels.begin(), levels.end(), [](Level l) { return l == Level::nonlinear; });
  return {all.consistent(levels), 1, cells ? window_ : 0};
}

const Candidate& Judgement::of(const Request& request, const Candidates::Beyond& beyond) {
  const Candidate& c = all.of(request, beyond);
  if (request.step == 1 && !request.finer && std::find(a.tried.begin(), a.tried.end(), &c) == a.tried.end()) a.tried.push_back(&c);
  return c;
}

double Judgement::error(const Candidate& c) const {
  if (!c.failure.empty()) return HUGE_VAL;
  double largest = 0;
  for (size_t k = 0; k < c.values.size(); ++k) {
    const QuantityValue &mine = c.values[k], &its = a.reference->values[k];
    if (!its.why.empty()) continue;
    if (!mine.why.empty() || c.ended > 0) return HUGE_VAL;
    largest = std::max(largest, over(a.with_step(mine.value - its.value, k), its.allowed));
  }
  return largest + std::min(a.doubt, 0.5);
}

Candidates::Beyond Judgement::beyond() const {
  return [this](const std::vector<QuantityValue>& so_far) {
    size_t k = 0;
    for (const Entry& q : all.scene().entries("quantity")) {
      if (is_of_shapes(q.kind)) continue;
      const QuantityValue &mine = so_far[k], &its = a.reference->values[k];
      const double excess = std::abs(mine.value) - std::abs(its.value);
      if (q.kind == "peak" && !q.has("cfc") && mine.why.empty() && its.why.empty() && excess > 1.2 * its.allowed + std::abs(a.step[k]))
        return true;
      ++k;
    }
    return false;
  };
}

/// The regions that a failed run names, as themselves, as bodies of several ("a+b") or by sets of the mesh, and what to do about them:
/// rigid where the scene wants one body, else one level more.
bool Judgement::mend(const Candidate& c, Assignment& levels) {
  bool mended = false;
  for (size_t r = 0; r < n; ++r) {
    const std::string& name = all.names()[r];
    const auto says = [&](const char* text) { return c.failure.find('"' + name + text) != std::string::npos; };
    const bool whole = says("\" is flexible") || says("\" is a linear region: it has no single position"), stop = says("\" is not rigid");
    if (!whole && !stop) continue;
    const char* why =
        whole ? "a joint, spring, load or mass takes it as one body" : "a contact gives its stiffness as that of a rigid part";
    a.kept_rigid[r] = why;
    if (o.kept.contains(r) && o.kept.at(r) != Level::rigid)
      throw Error("--keep", fmt::format("\"{}\" cannot be {}: {}", name, word(o.kept.at(r)), why),
                  whole ? "let the joint name a set of its nodes" : "leave out modulus and layer of the contact", Exit::usage);
    warn(name, fmt::format("{}, so it stays rigid ({})", why,
                           whole ? "a set of its nodes would let it deform" : "without modulus and layer it may deform"));
    levels[r] = Level::rigid, mended = true;
  }
  if (mended) return true;
  for (const size_t r : all.named_in(c.failure)) {
    if (is_kept(r) || levels[r] == Level::rigid || levels[r] == Level::nonlinear) continue;
    const bool stiffens = levels[r] == Level::linear && all.is_large(r) && c.failure.find("stiffening = true") != std::string::npos;
    levels[r] = stiffens ? Level::stiffening : Level::nonlinear, mended = true;
  }
  return mended;
}

/// All regions linear, where a model like that runs.
void Judgement::find_base() {
  Assignment levels = with(Level::linear);
  std::string passed_over;
  while (true) {
    levels = all.consistent(levels);
    const Candidate& c = of({levels});
    a.base = a.reference = a.beside = &c;
    if (c.failure.empty()) break;
    const Assignment before = levels;
    if (mend(c, levels) && all.consistent(levels) != before) continue;
    levels = with(Level::nonlinear);
    if (c.failure.find(": no file ") != std::string::npos) throw Error("", c.failure, "", c.exit);
    if (levels == before) throw Error("", "no model to judge by runs: " + c.failure, "", c.exit);
    passed_over = fmt::format("{} does not run, so all of them are nonlinear, for what the run says names no region: {}",
                              label(before, all.names()), c.failure);
  }
  if (!passed_over.empty()) warn("", passed_over);
  const double end = all.scene().table("time").number("end");
  const Entry& output = all.scene().table("output");
  const double instants = output.given("interval") ? end / output.number("interval") : 50;
  for (const QuantityValue& v : a.base->values) {
    const bool is_seldom = v.measured == Measured::stress && instants < 10;
    if (v.why.empty() && !is_seldom) continue;
    throw Error("", v.why.empty() ? fmt::format("quantity \"{}\": stress at {:.2g} instants is no history", v.name, instants) : v.why,
                is_seldom ? fmt::format("output.interval = {:.2g}: fields at 50 instants", all.written("s", end / 50)) : "");
  }
  for (const QuantityValue& v : a.base->values)  // those in units too: their share is known now
    if (v.allowed > 0 && v.value != 0) a.tightest = std::min(a.tightest, v.allowed / std::abs(v.value));
  window_ = window_of(*a.base);
}

/// Regions with a surface in a contact: a linear one gives way there by few modes, and no measure tells what it lacks.
void Judgement::find_contacts() {
  const auto take = [&](const std::string& name) {
    for (size_t r = 0; name == "all" && r < n; ++r)
      if (!all.is_beam(r)) touched_.insert(r);
    touched_.merge(all.named_in('"' + name + '"'));
    for (const Entry& set : all.scene().entries("set"))
      for (size_t r = 0; set.name == name && r < n; ++r)
        if (!all.is_beam(r) && (!set.has("of") || std::ranges::any_of(set.texts("of"), [&](const std::string& of) {
              return fnmatch(of.c_str(), all.names()[r].c_str(), 0) == 0;
            })))
          touched_.insert(r);
  };
  for (const Entry& e : all.scene().entries("contact")) take(e.text("a")), take(e.text("b"));
}

/// Until when cells have to run for the values of a model: as long as its peaks may be outdone, where it still reaches half of them, and
/// what a filter sees behind that; 0: to the end.
double Judgement::window_of(const Candidate& c) const {
  double last = 0;
  size_t k = 0;
  for (const Entry& q : all.scene().entries("quantity")) {
    if (is_of_shapes(q.kind)) continue;
    const double t = c.values[k++].until;
    last = std::max(last, std::isfinite(t) ? 1.1 * t + (q.kind != "injury" && q.has("cfc") ? 1.2 / q.number("cfc") : 0) : HUGE_VAL);
  }
  const Entry& time = all.scene().table("time");
  const double step = time.number("step");
  return last < 0.9 * time.number("end") ? std::max(10.0, 2 * std::ceil(last / step / 2)) * step : 0;
}

/// Makes regions nonlinear of which a run says that linear strains are in doubt, or that left their range; the doubt of the others remains.
bool Judgement::doubts(const Candidate& c, Assignment& levels) {
  const Assignment before = levels;
  a.doubt = 0;
  for (size_t r = 0; r < n; ++r) {
    const auto at = c.doubt.find(r);
    const bool pressed = is_touched(r) && fidelity(levels[r]) == Fidelity::linear;
    const double doubt = (c.beyond.contains(r) || pressed ? 1 : 0) + (at == c.doubt.end() ? 0 : at->second / a.tightest);
    doubt_[r] = std::max(doubt_[r], doubt);
    const bool wanted = o.check == Check::always || (o.check == Check::where_in_doubt && doubt > 0.5);
    if (wanted && !is_kept(r))
      levels[r] = Level::nonlinear;
    else
      a.doubt = std::max(a.doubt, doubt);
  }
  levels = all.consistent(levels);
  return levels != before;
}

void Judgement::judge_by(const Candidate& cells) {
  a.reference = a.beside = &cells;
  a.modes.clear(), a.modes_at_most = 0;
  Assignment levels = cells.levels;
  doubts(cells, levels);
}

/// A model and what cells change of it, by a run of each at twice the step, at half the price of cells.  The model is the base, or where a
/// whole run says that cells change too much of it, the base with the first one, two, four, ... regions nonlinear, those in most doubt
/// first.  None where that would not do: the model's own step is to be known as small, and what cells change too.
const Candidate* Judgement::by_twice(const Request& cells) {
  constexpr double most_step = 0.3, most_change = 0.9;  // of a tolerance
  if (!is_measured_method() || !may_be_twice() || o.check == Check::always) return nullptr;
  const Candidate& before = all.of({a.base->levels, 2, cells.end});
  if (difference(before, *a.base) > 3 * most_step) return nullptr;
  const Candidate& after = all.of({cells.levels, 2, cells.end});
  const auto made = [&](const Candidate& model, const Candidate& at_twice) {
    a.beside = &model;
    Candidate& out = a.made.emplace_back(after);
    for (size_t k = 0; k < out.values.size(); ++k) {
      out.values[k].value += model.values[k].value - at_twice.values[k].value;
      out.values[k].allowed = model.values[k].allowed;
    }
    return &out;
  };
  if (difference(after, before) <= most_change) return made(*a.base, before);
  if (cells.end != 0 || !after.failure.empty()) return nullptr;
  Assignment levels = a.base->levels;
  size_t changed = 0, next = 1;
  for (const size_t r : sorted([&](size_t region) { return doubt(region); })) {
    if (levels[r] == cells.levels[r]) continue;
    levels[r] = cells.levels[r], ++changed;
    const Request model{all.consistent(levels)}, at_twice{model.levels, 2};
    if (changed < next || needs_cells_beside(model.levels, cells.levels)) continue;
    next = 2 * changed;
    if (model.levels == cells.levels || all.price(model) > 0.7 * all.price(cells)) break;
    const Candidate& twice = all.of(at_twice);
    if (!twice.failure.empty() || difference(after, twice) > most_change) continue;
    const Candidate& once = of(model);
    return !once.failure.empty() || difference(twice, once) > 3 * most_step ? nullptr : made(once, twice);
  }
  return nullptr;
}

/// Did a run at twice the step, beside the reference's, say that a model does not answer as the reference does?
bool Judgement::is_off_at_twice(const Assignment& levels) {
  const Request mine{all.consistent(levels), 2, a.reference->end}, its{a.reference->levels, 2, a.reference->end};
  return all.knows(mine) && all.knows(its) && difference(all.of(its), all.of(mine)) > 1;
}

/// Of linear regions that share nodes a run tells what they do together, not what each of them does.
bool Judgement::is_told_alone(size_t r) const {
  return std::ranges::none_of(all.neighbours(r),
                              [&](size_t other) { return other != r && fidelity(a.base->levels[other]) == Fidelity::linear; });
}

/// Is a region of `cells` not yet one of `levels` that is too far off to be linear?
bool Judgement::needs_cells_beside(const Assignment& levels, const Assignment& cells) const {
  for (size_t r = 0; r < n; ++r)
    if (levels[r] != cells[r] && is_never_linear(r)) return true;
  return false;
}

/// The base with cells where its linear strains are in doubt, as far as quantities have their values.
void Judgement::find_reference() {
  Assignment levels = a.base->levels;
  bool more = doubts(*a.base, levels);
  if (!a.base->beyond.empty()) window_ = 0;  // its instants tell nothing
  for (bool early = window_ > 0; more;) {
    const Request next = request(levels);
    if (!is_quiet())
      fmt::print(stderr,
                 "linear strains of some regions, or how they give way in contacts, are in doubt: a run to judge by, to {:.4g} s, takes "
                 "about {:.2g} s\n",
                 window_ > 0 ? window_ : all.scene().table("time").number("end"), all.price(next));
    const Candidate* twice = by_twice(next);
    const Candidate& c = twice ? *twice : of(next);
    const auto lacking = std::ranges::find_if(c.values, [](const QuantityValue& v) { return !v.why.empty(); });
    const bool lacks = lacking != c.values.end(), runs = c.failure.empty() && !lacks;
    if (!runs && !(early && lacks)) {
      warn("", fmt::format("{} {}, so nothing checks linear strains: {}", label(levels, all.names()),
                           c.failure.empty() ? "lacks a value" : "does not run", c.failure.empty() ? lacking->why : c.failure));
      a.doubt = 1;
      break;
    }
    if (runs) a.reference = &c;
    if (runs && !twice) a.beside = &c;
    if (early && (!runs || difference(*a.base, c) > 0.5)) {  // nor are the instants those of the base
      early = false, window_ = 0;
      continue;
    }
    if (!early && c.end == 0) window_ = window_of(c);
    more = doubts(c, levels);
  }
}

}  // namespace hilo
