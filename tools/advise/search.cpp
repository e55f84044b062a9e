// SPDX-License-Identifier: GPL-3.0-or-later
#include "advise/search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "advise/judgement.hpp"
#include "base/error.hpp"

namespace hilo {
namespace {

class Search : Judgement {
 public:
  using Judgement::Judgement;

  Advice found() {
    search();
    if (!answers_to_the_end()) {
      judge_to_the_end();
      search();
    }
    hear_solver();
    find_mesh();
    a.all_cells = all.price(all_cells());  // they may have run by now
    return std::move(a);
  }

 private:
  void search() {
    find_step();
    if (!serves(*a.beside)) run_reference(), find_step();
    a.all_cells = all.price(all_cells());
    tell_plan();
    if (serves(*a.base)) {
      find_what_deforms();
      climb(with(Level::rigid), *a.base, by_energy());
    } else if (a.reference->step != 1) {
      a.chosen = a.beside;
    } else {
      climb(a.base->levels, *a.reference, by_doubt());
    }
    demote();
    choose();
    take_all_cells();
    check_modes();
  }
  Request all_cells() const { return {with(Level::nonlinear)}; }
  /// All cells where a smaller model saves nothing, or where they tell that it is wrong.
  void take_all_cells() {
    constexpr double nothing = 0.2;  // seconds: what so short a run takes is tried, not predicted
    const Request cells = all_cells();
    const double price = all.price(cells);
    if (o.check == Check::never || a.chosen->levels == cells.levels) return;
    if (price > std::max(nothing, a.chosen->cost) && !about_as_long(price, a.chosen->cost)) return;
    const Candidate& c = of(cells);
    if (!runs(c)) return;
    if (serves(c) && !is_cheaper(c, *a.chosen)) return;
    a.chosen = &c;
    if (serves(c)) return;
    judge_by(c);  // more than was in doubt
    find_step();
  }

  /// The chosen model to the end, where its cells ended earlier: are its values still the same?
  bool answers_to_the_end() {
    const Candidate& c = *a.chosen;
    if (c.end == 0) return true;
    Request request = c;
    request.end = 0;
    const Candidate& whole = of(request);
    if (!runs(whole) || difference(whole, c) > 0.1) return false;
    if (a.reference == &c) a.reference = &whole;
    if (a.beside == &c) a.beside = &whole;
    a.chosen = &whole;
    return true;
  }
  /// Judges anew, where a run that ended early missed what counts.
  void judge_to_the_end() {
    run_whole();
    std::erase_if(a.tried, [](const Candidate* c) { return c->end > 0; });
    rejected.clear(), a.without.clear(), a.modes.clear();
    a.reference = a.beside = &of(request(a.reference->levels));
    run_reference();
  }
  /// What the solver itself says of the positions of the chosen model, where that is cheap: of one without cells, by one run more.
  void hear_solver() {
    Request request = *a.chosen;
    request.is_estimated = !std::ranges::count(request.levels, Level::nonlinear);
    const Candidate& c = all.of(request);
    if (c.failure.empty()) a.positions_off = c.positions_off;
  }

  bool too_dear(const Request& next, double planned = 0) const {
    constexpr double never_below = 2;  // seconds: nobody waits for these
    return all.spent() + planned + all.price(next) > std::max(o.at_most * a.all_cells, never_below);
  }

  /// What saves less than a third of another model is tried within half the price of a run of all cells; where many regions deform, and
  /// such savings add up, within all of it.
  bool saves_little(const Request& next, const Request& than, double planned = 0) const {
    const double price = all.price(next);
    const auto deform = std::ranges::count_if(than.levels, [](Level l) { return l != Level::rigid; });
    return !o.each_region && price > 2. / 3 * all.price(than) && all.spent() + planned + price > (deform > 3 ? 1 : 0.5) * a.all_cells;
  }
  /// Is it vain to try it linear?
  bool needs_cells(size_t r) const { return !serves(*a.base) && is_never_linear(r); }

  /// Linear regions of the chosen model that the reference has as cells lack nothing that the difference from it does not hold.
  bool has_modes_left_out(size_t r) const { return is_linear(a.chosen->levels[r]) && is_linear(a.reference->levels[r]); }
  /// Is it vain to try it rigid?  Of 13 trials where cells were needed, 11 were of a region with the largest strain energy, and off by two
  /// tolerances or more; of two with less than a hundredth of it one served.
  bool bears_load(size_t r) const {
    constexpr double little = 0.05;
    if (serves(*a.base) || o.each_region || !is_told_alone(r)) return false;
    double largest = 0;
    for (const auto& [region, energy] : a.base->energy) largest = std::max(largest, energy);
    const auto mine = a.base->energy.find(r);
    return mine != a.base->energy.end() && mine->second > little * largest;
  }
  /// What modes left out may change by the strain that such regions say they lack, over the tightest tolerance: of 45 models of beams it
  /// was at most three times that strain, so ten times is taken (docs/advise.md).  Unknown, infinite, where answers are local or of all
  /// frequencies.
  double modes_at_most() const {
    double strain = 0;
    bool is_local = false;
    for (const Entry& q : all.scene().entries("quantity"))
      is_local = is_local || q.has("stress") || q.kind == "injury" || (q.has("sensor") && !q.has("cfc"));
    for (size_t r = 0; r < n; ++r) {
      if (!has_modes_left_out(r)) continue;
      const auto lack = a.chosen->lack.find(r);
      if (is_local || lack == a.chosen->lack.end() || is_touched(r)) return HUGE_VAL;
      strain = std::max(strain, lack->second);
    }
    return 10 * strain / a.tightest;
  }
  static bool is_linear(Level l) { return fidelity(l) == Fidelity::linear; }
  /// Error of the modes that linear regions of the chosen model have: by as many again; and as many again where that is too large.
  void check_modes() {
    while (std::ranges::any_of(a.chosen->levels, is_linear)) {
      a.modes_at_most = modes_at_most();
      if (a.modes_at_most < 0.1 && error(*a.chosen) + a.modes_at_most <= 1) return;
      const Candidate& c = *a.chosen;
      Request richer{c.levels, 1, c.end, 2 * c.modes};
      for (size_t r = 0; r < n; ++r)
        if (has_modes_left_out(r)) richer.richer.insert(r);
      const Candidate& more = of(richer);  // which may be chosen
      if (!more.failure.empty())
        return a.modes.clear(), warn("", "more modes do not run, so the error of those left out is unknown: " + more.failure);
      a.modes = part(c, more, 1);
      const auto sum = [&](const Candidate& of, bool with_modes) {
        double largest = 0;
        for (size_t k = 0; k < c.values.size(); ++k) {
          const QuantityValue& its = a.reference->values[k];
          const double levels = c.levels == a.reference->levels ? 0 : of.values[k].value - its.value;
          largest = std::max(largest, over(a.with_step(levels, k), its.allowed) + (with_modes ? over(a.modes[k], its.allowed) : 0));
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
      a.chosen = &more;
      if (a.reference->levels == c.levels) a.reference = &more;
    }
  }
  /// The reference itself, where only what it changes has run.
  void run_reference() {
    if (a.reference->step != 1) a.reference = a.beside = &of(request(a.reference->levels));
    if (!a.reference->failure.empty())
      throw Error("", "the model to judge by does not run: " + a.reference->failure, "", a.reference->exit);
  }
  /// A model that does not serve with all parts of its error: the next one.
  void reject(const Candidate& c) {
    rejected.insert(&c);
    a.modes.clear();
    run_reference();
    if (&c == a.base && &c != a.reference)
      climb(c.levels, *a.reference, by_doubt());
    else
      a.chosen = a.reference;
    choose();
  }
  /// Error of the mesh by the chosen model on a finer one, to the end: there a peak may come later.  It falls with the square of the size
  /// of cells.
  void find_mesh() {
    if (all.refinement() == 0) return;
    const Candidate& fine = all.of({a.chosen->levels, 1, 0, a.chosen->modes, true, a.chosen->richer});
    if (!fine.failure.empty()) return warn("", "the finer mesh does not run, so the error of the mesh is unknown: " + fine.failure);
    const double square = all.refinement() * all.refinement();
    a.mesh = part(*a.chosen, fine, square / (square - 1));
  }
  void tell_plan() const {
    if (is_quiet()) return;
    const double regions = static_cast<double>(n), runs = std::log2(regions + 1) + regions;
    fmt::print(stderr, "judged by: {}\nup to {:.0f} runs more, about {:.2g} s each; a run of all cells takes about {:.2g} s\n",
               label(a.reference->levels, all.names()), runs, all.price({(serves(*a.base) ? a.base : a.reference)->levels}), a.all_cells);
  }

  /// Regions by their strain energy in the base, largest first; before them what stress is asked of, and what is nonlinear there.
  std::vector<size_t> by_energy() const {
    std::vector<double> largest(n, 0);
    for (size_t r = 0; r < n; ++r) {
      if (const auto at = a.base->energy.find(r); at != a.base->energy.end()) largest[r] = at->second;
      if (a.base->levels[r] == Level::nonlinear) largest[r] += 1e150;
      if (must_deform(r)) largest[r] += 1e200;
    }
    return sorted([&](size_t r) { return largest[r]; });
  }

  std::vector<size_t> by_doubt() const {
    return sorted([&](size_t r) { return doubt(r); });
  }

  /// Regions that the scene does not take as rigid, by what a run says that ends before its first step.
  void find_what_deforms() {
    for (bool more = true; more;) {
      Assignment levels = with(Level::rigid);
      for (size_t r = 0; r < n; ++r)
        if (must_deform(r) && !is_kept(r)) levels[r] = a.base->levels[r];
      const Candidate& c = of(request(levels), beyond());
      more = false;
      for (size_t r = 0; r < n && !c.failure.empty(); ++r)
        if (c.failure.find("region \"" + all.names()[r] + "\" is rigid") != std::string::npos && !is_kept(r))
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
    const auto is_vain = [&](size_t r) { return low[r] == Level::rigid ? must_deform(r) : needs_cells(r); };
    while (least < most && is_vain(order[least])) ++least;
    a.chosen = &top;
    size_t stride = 1;  // small models are cheap: from the start on by 1, 2, 4, ..., then halving
    for (size_t k = least; least < most;) {
      const Request next = request(head(k));
      if (k > 0 && (too_dear(next) || saves_little(next, request(high)))) break;
      const Candidate* c = is_off_at_twice(next.levels) ? nullptr : &of(next, beyond());
      if (c && serves(*c))
        most = k, stride = 0, a.chosen = c;
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
    const Assignment from = a.chosen->levels;
    std::vector<Request> singles;
    std::vector<size_t> which;
    double planned = 0;  // seconds
    for (const size_t r : by_energy()) {
      if (to(from[r]) == from[r] || (to(from[r]) == Level::rigid && wants_stress(r)) || (large_alone && !all.is_large(r))) continue;
      if (to(from[r]) == Level::linear && needs_cells(r)) continue;
      if (to(from[r]) == Level::rigid && bears_load(r)) continue;
      Assignment levels = from;
      levels[r] = to(from[r]);
      const Request single = request(levels);
      if (single.levels == from || is_off_at_twice(single.levels)) continue;  // the same: a beam
      if (!all.knows(single)) {
        if (too_dear(single, planned) || saves_little(single, request(from), planned)) continue;
        planned += all.price(single);
      }
      singles.push_back(single), which.push_back(r);
    }
    all.run(singles, beyond());
    std::vector<std::pair<double, size_t>> good;  // error, and region
    for (size_t i = 0; i < singles.size(); ++i) {
      const Candidate& c = of(singles[i], beyond());
      if (singles[i].levels[which[i]] == Level::rigid) a.without[which[i]] = &c;
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
      if (c.cost < 1.1 * a.chosen->cost) a.chosen = &c;
      return true;
    };
    if (good.size() > 1 && take(0, good.size())) return;
    for (size_t i = 0; i < good.size(); ++i) take(i, i + 1);
  }
  bool wants_stress(size_t r) const {
    for (const Entry& q : all.scene().entries("quantity"))
      if (q.has("stress") && q.text("stress") == all.names()[r]) return true;
    return false;
  }

  static bool runs(const Candidate& c) {
    return c.failure.empty() && c.ended == 0 && std::ranges::all_of(c.values, [](const QuantityValue& v) { return v.why.empty(); });
  }
  /// Where two take about as long, the one with fewer unknowns counts as cheaper.
  static bool is_cheaper(const Candidate& c, const Candidate& than) {
    return about_as_long(c.cost, than.cost) ? c.unknowns < than.unknowns : c.cost < than.cost;
  }
  /// The cheapest that serves.
  void choose() {
    for (const Candidate* c : a.tried)
      if (serves(*c) && is_cheaper(*c, *a.chosen)) a.chosen = c;
  }

  std::set<size_t> deform_;  // regions that may not be rigid
};

}  // namespace

Advice advise(Candidates& all, const SearchOptions& options) { return Search(all, options).found(); }

bool about_as_long(double a, double b) {
  constexpr double noise = 0.02;  // seconds
  return std::abs(a - b) < noise || (a < 1.15 * b && b < 1.15 * a);
}

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
