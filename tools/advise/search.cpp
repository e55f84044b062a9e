// SPDX-License-Identifier: GPL-3.0-or-later
#include "advise/search.hpp"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace hilo {
namespace {

constexpr double most_step = 0.8;  // of a tolerance: what a step may take of it before no model can be judged

double over(double difference, double allowed) { return std::abs(difference) / std::max(allowed, 1e-300); }

/// What the quantities of a model are off by, from a run that is finer in one thing, by `factor` times what that changes; infinite where
/// one of both has no value.
std::vector<double> part(const Candidate& c, const Candidate& finer, double factor) {
  std::vector<double> out;
  for (size_t k = 0; k < c.values.size(); ++k) {
    const double change = factor * (finer.values[k].value - c.values[k].value);
    out.push_back(std::isfinite(change) ? change : HUGE_VAL);
  }
  return out;
}

class Search {
 public:
  Search(Candidates& all, const SearchOptions& o) : all_(all), o_(o), n_(all.names().size()) { find_contacts(); }

  Advice found() {
    find_base();
    find_reference();
    find_step();
    a_.all_cells = all_.price({cells()});
    tell_plan();
    if (serves(*a_.base)) {
      find_what_deforms();
      climb(rigid(), *a_.base, by_energy());
    } else {
      climb(a_.base->levels, *a_.reference, sorted([&](size_t r) { return doubt_[r]; }));
    }
    demote();
    choose();
    check_step();
    step_is_known_ = true;
    check_modes();
    find_mesh();
    return std::move(a_);
  }

 private:
  Assignment with(Level level) const {
    Assignment out(n_, level);
    for (const auto& [r, kept] : o_.kept) out[r] = kept;
    for (const auto& [r, why] : a_.kept_rigid) out[r] = Level::rigid;
    return all_.consistent(out);
  }
  Assignment rigid() const { return with(Level::rigid); }
  Assignment cells() const { return with(Level::nonlinear); }
  bool is_kept(size_t r) const { return o_.kept.contains(r) || a_.kept_rigid.contains(r); }

  /// A run of cells ends where all quantities have their values.
  Request request(const Assignment& levels) const {
    const bool cells = std::any_of(levels.begin(), levels.end(), [](Level l) { return l == Level::nonlinear; });
    return {all_.consistent(levels), 1, cells ? window_ : 0};
  }
  const Candidate& of(const Request& request, const Candidates::Beyond& beyond = {}) {
    const Candidate& c = all_.of(request, beyond);
    if (request.step == 1 && !request.finer && std::find(a_.tried.begin(), a_.tried.end(), &c) == a_.tried.end()) a_.tried.push_back(&c);
    return c;
  }

  /// Error of a model by the reference, the step and what is in doubt of the reference, over what is allowed; 1 is all of it.
  double error(const Candidate& c) const {
    if (!c.failure.empty()) return HUGE_VAL;
    double largest = 0;
    for (size_t k = 0; k < c.values.size(); ++k) {
      const QuantityValue &mine = c.values[k], &its = a_.reference->values[k];
      if (!its.why.empty()) continue;
      if (!mine.why.empty() || c.ended > 0) return HUGE_VAL;
      largest = std::max(largest, over(mine.value - its.value, its.allowed) + over(a_.step[k], its.allowed));
    }
    return largest + std::min(a_.doubt, 0.5);
  }
  /// Of a model that is not the reference: a raw peak that is too large stays so.
  Candidates::Beyond beyond() const {
    return [this](const std::vector<QuantityValue>& so_far) {
      size_t k = 0;
      for (const Entry& q : all_.scene().entries("quantity")) {
        if (q.kind == "frequency") continue;
        const QuantityValue &mine = so_far[k], &its = a_.reference->values[k];
        const double excess = std::abs(mine.value) - std::abs(its.value);
        if (q.kind == "peak" && !q.has("cfc") && mine.why.empty() && its.why.empty() && excess > 1.2 * its.allowed) return true;
        ++k;
      }
      return false;
    };
  }
  bool serves(const Candidate& c) const { return &c == a_.reference || (!rejected_.contains(&c) && error(c) <= 1); }
  bool too_dear(const Request& next, double planned = 0) const {
    const double step =
        serves(*a_.base) || step_is_known_ ? 0 : all_.price({a_.reference->levels, 0.5, window_});  // check_step may want it
    constexpr double never_below = 2;                                                               // seconds: nobody waits for these
    return all_.spent() + planned + all_.price(next) + step > std::max(o_.at_most * a_.all_cells, never_below);
  }

  /// The regions that a failed run names, as themselves, as bodies of several ("a+b") or by sets of the mesh, and what to do about them:
  /// rigid where the scene wants one body, else one level more.
  bool mend(const Candidate& c, Assignment& levels) {
    bool mended = false;
    for (size_t r = 0; r < n_; ++r) {
      const std::string& name = all_.names()[r];
      const auto says = [&](const char* text) { return c.failure.find('"' + name + text) != std::string::npos; };
      const bool whole = says("\" is flexible") || says("\" is a linear region: it has no single position"), stop = says("\" is not rigid");
      if (!whole && !stop) continue;
      const char* why = whole ? "a joint or spring names it as a whole" : "a contact gives its stiffness as that of a rigid part";
      a_.kept_rigid[r] = why;
      if (o_.kept.contains(r) && o_.kept.at(r) != Level::rigid)
        throw Error("--keep", fmt::format("\"{}\" cannot be {}: {}", name, word(o_.kept.at(r)), why),
                    whole ? "let the joint name a set of its nodes" : "leave out modulus and layer of the contact", Exit::usage);
      warn(name, fmt::format("{}, so it stays rigid ({})", why,
                             whole ? "a set of its nodes would let it deform" : "without modulus and layer it may deform"));
      levels[r] = Level::rigid, mended = true;
    }
    if (mended) return true;
    for (const size_t r : all_.named_in(c.failure)) {
      if (is_kept(r) || levels[r] == Level::rigid || levels[r] == Level::nonlinear) continue;
      const bool stiffens = levels[r] == Level::linear && all_.is_large(r) && c.failure.find("stiffening = true") != std::string::npos;
      levels[r] = stiffens ? Level::stiffening : Level::nonlinear, mended = true;
    }
    return mended;
  }

  /// All regions linear, where a model like that runs.
  void find_base() {
    Assignment levels = with(Level::linear);
    while (true) {
      levels = all_.consistent(levels);
      const Candidate& c = of({levels});
      a_.base = a_.reference = &c;
      if (c.failure.empty()) break;
      const Assignment before = levels;
      if (mend(c, levels) && all_.consistent(levels) != before) continue;
      levels = cells();
      if (levels == before) throw Error("", "no model to judge by runs: " + c.failure, "", c.exit);
      warn("", fmt::format("{} does not run, and nothing says why: {}", label(before, all_.names()), c.failure));
    }
    const double end = all_.scene().table("time").number("end");
    for (const QuantityValue& v : a_.base->values)
      if (!v.why.empty())
        throw Error("", v.why,
                    v.of.starts_with("von Mises") ? fmt::format("output.interval = {:.2g}: fields at 50 instants", end / 50) : "");
    window_ = window_of(*a_.base);
  }

  /// Regions with a surface in a contact: a linear one gives way there by few modes, and no measure tells what it lacks.
  void find_contacts() {
    const auto take = [&](const std::string& name) {
      for (size_t r = 0; name == "all" && r < n_; ++r) touched_.insert(r);
      touched_.merge(all_.named_in('"' + name + '"'));
      for (const Entry& set : all_.scene().entries("set"))
        for (size_t r = 0; set.name == name && r < n_; ++r)
          if (!set.has("of") || std::ranges::any_of(set.texts("of"), [&](const std::string& of) {
                return fnmatch(of.c_str(), all_.names()[r].c_str(), 0) == 0;
              }))
            touched_.insert(r);
    };
    for (const Entry& e : all_.scene().entries("contact")) take(e.text("a")), take(e.text("b"));
  }

  /// Until when a run has to go for the values of a model: the last instant of these, and what a filter sees behind it; 0: to its end.
  double window_of(const Candidate& c) const {
    double last = 0;
    size_t k = 0;
    for (const Entry& q : all_.scene().entries("quantity")) {
      if (q.kind == "frequency") continue;
      const double t = c.values[k++].t;
      last = std::max(last, std::isfinite(t) ? 1.1 * t + (q.kind != "injury" && q.has("cfc") ? 1.2 / q.number("cfc") : 0) : HUGE_VAL);
    }
    const Entry& time = all_.scene().table("time");
    const double step = time.number("step");
    return last < 0.9 * time.number("end") ? std::max(10.0, 2 * std::ceil(last / step / 2)) * step : 0;
  }

  /// The base with all regions nonlinear whose linear strains are in doubt, or that left their range, as far as quantities have their
  /// values; of what is then linear the doubt remains.
  void find_reference() {
    Assignment levels = a_.base->levels;
    const auto look = [&](const Candidate& c) {
      const Assignment before = levels;
      a_.doubt = 0;
      for (size_t r = 0; r < n_; ++r) {
        const auto at = c.doubt.find(r);
        const bool pressed = touched_.contains(r) && fidelity(levels[r]) == Fidelity::linear;
        const double doubt = (c.beyond.contains(r) || pressed ? 1 : 0) + (at == c.doubt.end() ? 0 : at->second / o_.tightest);
        doubt_[r] = std::max(doubt_[r], doubt);
        const bool wanted = o_.check == Check::always || (o_.check == Check::where_in_doubt && doubt > 0.5);
        if (wanted && !is_kept(r))
          levels[r] = Level::nonlinear;
        else
          a_.doubt = std::max(a_.doubt, doubt);
      }
      levels = all_.consistent(levels);
      return levels != before;
    };
    bool more = look(*a_.base);
    if (!a_.base->beyond.empty()) window_ = 0;  // its instants tell nothing
    for (bool early = window_ > 0; more;) {
      const Request next = request(levels);
      if (!is_quiet())
        fmt::print(stderr,
                   "linear strains of some regions, or how they give way in contacts, are in doubt: a run to judge by, to {:.4g} s, takes "
                   "about {:.2g} s\n",
                   window_ > 0 ? window_ : all_.scene().table("time").number("end"), all_.price(next));
      const Candidate& c = of(next);
      const auto lacking = std::ranges::find_if(c.values, [](const QuantityValue& v) { return !v.why.empty(); });
      if (early && lacking != c.values.end()) {
        early = false, window_ = 0, more = true;
        continue;
      }
      if (!c.failure.empty() || lacking != c.values.end()) {
        warn("", fmt::format("{} {}, so nothing checks linear strains: {}", label(levels, all_.names()),
                             c.failure.empty() ? "lacks a value" : "does not run", c.failure.empty() ? lacking->why : c.failure));
        a_.doubt = 1;
        break;
      }
      a_.reference = &c;
      if (early && difference(*a_.base, c) > 0.5) {  // nor are the instants those of the base
        early = false, window_ = 0, more = true;
        continue;
      }
      if (!early && c.end == 0) window_ = window_of(c);
      more = look(c);
    }
  }

  /// Where a run ends that is compared with a model's: at its window, but not after the run itself; 0: at the end.
  double end_beside(const Candidate& c) const {
    const double window = window_of(c);
    return c.end > 0 && (window == 0 || c.end < window) ? c.end : window;
  }
  /// Error of the step of a model by (h, h/2) and its order of two; too large to judge any model?  Twice the step would be cheaper, but of
  /// a machine that rings it told .1 of a tolerance where .9 is true.
  bool is_coarse(const Candidate& c) {
    const Candidate& half = all_.of({c.levels, 0.5, end_beside(c)});
    if (!half.failure.empty()) throw Error("", "half the step does not run: " + half.failure, "", Exit::not_converged);
    a_.step = part(c, half, 4. / 3);
    return step_over(largest_step()) > most_step;
  }
  double step_over(size_t k) const { return over(a_.step[k], a_.reference->values[k].allowed); }
  size_t largest_step() const {
    size_t out = 0;
    for (size_t k = 1; k < a_.step.size(); ++k)
      if (step_over(k) > step_over(out)) out = k;
    return out;
  }
  /// What a step this long cannot tell no model will.  Far beyond its range the base may need shorter steps than the reference.
  void find_step() {
    if (difference(*a_.base, *a_.reference) < 1 && !is_coarse(*a_.base)) return;
    if (is_coarse(*a_.reference)) refuse_step();
  }
  /// Where the base does not answer as the reference, its steps are no measure of those of cells.
  void check_step() {
    if (serves(*a_.base) || a_.chosen == a_.base) return;
    if (is_coarse(*a_.chosen)) refuse_step();
    if (!serves(*a_.chosen)) a_.chosen = a_.reference;
    choose();
  }
  /// Error of the modes that linear regions of the chosen model have: by as many again; and as many again where that is too large.
  void check_modes() {
    const auto is_linear = [](Level l) { return fidelity(l) == Fidelity::linear; };
    while (std::any_of(a_.chosen->levels.begin(), a_.chosen->levels.end(), is_linear)) {
      const Candidate& c = *a_.chosen;
      const Candidate& more = of({c.levels, 1, end_beside(c), 2 * c.modes});  // which may be chosen
      if (!more.failure.empty())
        return a_.modes.clear(), warn("", "more modes do not run, so the error of those left out is unknown: " + more.failure);
      a_.modes = part(c, more, 1);
      const auto sum = [&](const Candidate& of, bool with_modes) {
        double largest = 0;
        for (size_t k = 0; k < c.values.size(); ++k) {
          const QuantityValue& its = a_.reference->values[k];
          const double levels = c.levels == a_.reference->levels ? 0 : over(of.values[k].value - its.value, its.allowed);
          largest = std::max(largest, levels + step_over(k) + (with_modes ? over(a_.modes[k], its.allowed) : 0));
        }
        return largest;
      };
      if (sum(c, true) <= 1) return;
      if (sum(more, false) > 1) {  // more modes are no help
        reject(c);
        continue;
      }
      if (c.modes >= 8)
        return warn("",
                    fmt::format("with {} times the modes of the scene the error of those left out is still above the tolerance", c.modes));
      a_.chosen = &more;
      if (a_.reference->levels == c.levels) a_.reference = &more;
    }
  }
  /// A model that does not serve with all parts of its error: the next one.
  void reject(const Candidate& c) {
    rejected_.insert(&c);
    a_.modes.clear();
    if (&c == a_.base && a_.reference != a_.base)
      climb(c.levels, *a_.reference, sorted([&](size_t r) { return doubt_[r]; }));
    else
      a_.chosen = a_.reference;
    choose();
  }
  /// Error of the mesh by the chosen model on a finer one; it falls with the square of the size of cells.
  void find_mesh() {
    if (all_.refinement() == 0) return;
    const Candidate& fine = all_.of({a_.chosen->levels, 1, end_beside(*a_.chosen), a_.chosen->modes, true});
    if (!fine.failure.empty()) return warn("", "the finer mesh does not run, so the error of the mesh is unknown: " + fine.failure);
    const double square = all_.refinement() * all_.refinement();
    a_.mesh = part(*a_.chosen, fine, square / (square - 1));
  }
  [[noreturn]] void refuse_step() const {
    const size_t k = largest_step();
    const QuantityValue& v = a_.reference->values[k];
    const Entry& time = all_.scene().table("time");
    throw Error(time.where("step"),
                fmt::format("the step alone makes {:.3g} {} of \"{}\", of {:.3g} {} allowed", std::abs(a_.step[k]), v.unit, v.name,
                            v.allowed, v.unit),
                v.of.find(", raw") != std::string::npos ? "a raw acceleration holds all frequencies: give it a cfc"
                                                        : fmt::format("time.step = {:.2g}, or a larger tolerance",
                                                                      time.number("step") * std::sqrt(most_step / 2 / step_over(k))));
  }

  void tell_plan() const {
    if (is_quiet()) return;
    const double n = static_cast<double>(n_), runs = std::log2(n + 1) + n;
    fmt::print(stderr, "judged by: {}\nup to {:.0f} runs more, about {:.2g} s each; a run of all cells takes about {:.2g} s\n",
               label(a_.reference->levels, all_.names()), runs, all_.price({(serves(*a_.base) ? a_.base : a_.reference)->levels}),
               a_.all_cells);
  }

  /// Regions by their strain energy in the base, largest first; before them what stress is asked of, and what is nonlinear there.
  std::vector<size_t> by_energy() const {
    std::vector<double> of(n_, 0);
    for (size_t r = 0; r < n_; ++r) {
      if (const auto at = a_.base->energy.find(r); at != a_.base->energy.end()) of[r] = at->second;
      if (a_.base->levels[r] == Level::nonlinear) of[r] += 1e150;
      if (must_deform(r)) of[r] += 1e200;
    }
    return sorted([&](size_t r) { return of[r]; });
  }
  template <class Key>
  std::vector<size_t> sorted(Key&& key) const {
    std::vector<size_t> out;
    for (size_t r = 0; r < n_; ++r)
      if (!is_kept(r)) out.push_back(r);
    std::stable_sort(out.begin(), out.end(), [&](size_t a, size_t b) { return key(a) > key(b); });
    return out;
  }

  /// Regions that the scene does not take as rigid, by what a run says that ends before its first step.
  void find_what_deforms() {
    for (bool more = true; more;) {
      Assignment levels = rigid();
      for (size_t r = 0; r < n_; ++r)
        if (must_deform(r) && !is_kept(r)) levels[r] = a_.base->levels[r];
      const Candidate& c = of(request(levels), beyond());
      more = false;
      for (size_t r = 0; r < n_ && !c.failure.empty(); ++r)
        if (c.failure.find("region \"" + all_.names()[r] + "\" is rigid") != std::string::npos && !is_kept(r))
          more = deform_.insert(r).second || more;
    }
  }
  bool must_deform(size_t r) const { return wants_stress(r) || deform_.contains(r); }

  /// The shortest head of `order` that, at the levels of `high` and the rest at those of `low`, serves; all of it is `top`, which does.
  void climb(const Assignment& low, const Candidate& top, const std::vector<size_t>& order) {
    const Assignment& high = top.levels;
    const auto head = [&](size_t k) {
      Assignment levels = low;
      for (size_t i = 0; i < k; ++i) levels[order[i]] = high[order[i]];
      return levels;
    };
    size_t least = 0, most = order.size();
    while (least < most && low[order[least]] == Level::rigid && must_deform(order[least])) ++least;
    a_.chosen = &top;
    size_t stride = 1;  // small models are cheap: from the start on by 1, 2, 4, ..., then halving
    for (size_t k = least; least < most;) {
      const Request next = request(head(k));
      if (k > 0 && too_dear(next)) break;
      const Candidate& c = of(next, beyond());
      if (serves(c))
        most = k, stride = 0, a_.chosen = &c;
      else
        least = k + 1;
      k = stride > 0 && least + stride - 1 < most ? least + stride - 1 : (least + most) / 2;
      stride *= 2;
    }
  }

  /// Single regions of the chosen model lower, then together as far as that serves.
  void demote() {
    lower([](Level l) { return l > Level::rigid ? Level::rigid : l; });
    lower([](Level l) { return l == Level::nonlinear ? Level::linear : l; });
    lower([](Level l) { return l == Level::nonlinear ? Level::stiffening : l; }, true);
  }
  template <class To>
  void lower(To&& to, bool large_alone = false) {
    const Assignment from = a_.chosen->levels;
    std::vector<Request> singles;
    std::vector<size_t> which;
    double planned = 0;  // seconds
    for (const size_t r : by_energy()) {
      if (to(from[r]) == from[r] || (to(from[r]) == Level::rigid && wants_stress(r)) || (large_alone && !all_.is_large(r))) continue;
      Assignment levels = from;
      levels[r] = to(from[r]);
      const Request single = request(levels);
      if (!all_.knows(single)) {
        // what saves little is tried within the price of one run of all cells
        const double price = all_.price(single), all = all_.price(request(from));
        const bool little = !o_.each_region && price > 2. / 3 * all;
        if (too_dear(single, planned) || (little && all_.spent() + planned + price > a_.all_cells)) continue;
        planned += price;
      }
      singles.push_back(single), which.push_back(r);
    }
    all_.run(singles, beyond());
    std::vector<std::pair<double, size_t>> good;  // error, and region
    for (size_t i = 0; i < singles.size(); ++i) {
      const Candidate& c = of(singles[i], beyond());
      if (singles[i].levels[which[i]] == Level::rigid) a_.without[which[i]] = &c;
      if (serves(c)) good.emplace_back(error(c), i);
    }
    std::sort(good.begin(), good.end());
    Assignment now = from;
    const auto take = [&](size_t first, size_t last) {
      Assignment levels = now;
      for (size_t i = first; i < last; ++i) levels[which[good[i].second]] = singles[good[i].second].levels[which[good[i].second]];
      const Request next = request(levels);
      if (next.levels == now || too_dear(next)) return false;
      const Candidate& c = of(next, beyond());
      if (!serves(c)) return false;
      now = next.levels;
      if (c.cost < 1.1 * a_.chosen->cost) a_.chosen = &c;
      return true;
    };
    if (good.size() > 1 && take(0, good.size())) return;
    for (size_t i = 0; i < good.size(); ++i) take(i, i + 1);
  }
  bool wants_stress(size_t r) const {
    for (const Entry& q : all_.scene().entries("quantity"))
      if (q.has("stress") && q.text("stress") == all_.names()[r]) return true;
    return false;
  }

  /// The cheapest that serves; where the seconds of two are about the same, the one with fewer unknowns.
  void choose() {
    for (const Candidate* c : a_.tried)
      if (serves(*c) && (c->cost < 0.85 * a_.chosen->cost || (c->cost < 1.15 * a_.chosen->cost && c->unknowns < a_.chosen->unknowns)))
        a_.chosen = c;
  }

  Candidates& all_;
  const SearchOptions& o_;
  const size_t n_;
  Advice a_;
  double window_ = 0;           // in which all quantities have their values, 0: the whole run  [s]
  bool step_is_known_ = false;  // of the chosen model
  std::set<const Candidate*> rejected_;
  std::set<size_t> deform_;         // regions that may not be rigid
  std::set<size_t> touched_;        // regions with a surface in a contact
  std::map<size_t, double> doubt_;  // by region, the largest so far, over the tightest tolerance
};

}  // namespace

Advice advise(Candidates& all, const SearchOptions& options) { return Search(all, options).found(); }

double difference(const Candidate& c, const Candidate& reference, std::string* worst) {
  if (!c.failure.empty()) return HUGE_VAL;
  double largest = -1;
  for (size_t k = 0; k < reference.values.size(); ++k) {
    const QuantityValue &a = c.values[k], &b = reference.values[k];
    if (!b.why.empty()) continue;
    if (c.ended > 0 && (!a.why.empty() || a.kind != "peak")) continue;
    const double d = a.why.empty() ? over(a.value - b.value, b.allowed) : HUGE_VAL;
    if (d <= largest) continue;
    largest = d;
    if (worst) *worst = b.name;
  }
  return std::max(largest, 0.0);
}

}  // namespace hilo
