// SPDX-License-Identifier: GPL-3.0-or-later
// What models of a scene are judged by: a base, a reference, the step, and what each of them may be off by.
#pragma once
#include "advise/search.hpp"

namespace hilo {

double over(double difference, double allowed);

/// What the quantities of a model are off by, from a run that differs in one thing, by `factor` times what that changes; infinite where one
/// of both has no value.
std::vector<double> part(const Candidate& c, const Candidate& other, double factor);

class Judgement {
 public:
  /// Finds base and reference.  Errors: no model runs; no output of fields where stress is asked for.
  Judgement(Candidates& all, const SearchOptions& o);

  /// What a step of none would change; Error: too much for any model.  (step.cpp)
  void find_step();

  /// All regions at a level, but for those that are kept.
  Assignment with(Level level) const;
  bool is_kept(size_t r) const { return o.kept.contains(r) || a.kept_rigid.contains(r); }
  /// Regions that are not kept, largest key first.
  template <class Key>
  std::vector<size_t> sorted(Key&& key) const {
    std::vector<size_t> out;
    for (size_t r = 0; r < n; ++r)
      if (!is_kept(r)) out.push_back(r);
    std::stable_sort(out.begin(), out.end(), [&](size_t x, size_t y) { return key(x) > key(y); });
    return out;
  }

  /// A run of cells ends where all quantities have their values.
  Request request(const Assignment& levels) const;
  const Candidate& of(const Request& request, const Candidates::Beyond& beyond = {});
  /// Takes a run of all cells as the reference.
  void judge_by(const Candidate& cells);
  /// From now on cells run to the end.
  void run_whole() { window_ = 0; }

  /// Error of a model by the reference, the step and what is in doubt of the reference, over what is allowed; 1 is all of it.
  double error(const Candidate& c) const;
  bool serves(const Candidate& c) const { return &c == a.reference || (!rejected.contains(&c) && error(c) <= 1); }
  double step_over(size_t k) const { return over(a.step[k], a.reference->values[k].allowed); }
  /// Of a model that is not the reference: a raw peak that is too large stays so.
  Candidates::Beyond beyond() const;
  bool is_off_at_twice(const Assignment& levels);
  double doubt(size_t r) const { return doubt_.contains(r) ? doubt_.at(r) : 0; }
  bool is_told_alone(size_t r) const;
  /// Regions that could be linear had doubts of up to 12 tolerances.
  bool is_never_linear(size_t r) const { return doubt(r) > 15 && is_told_alone(r); }
  bool is_touched(size_t r) const { return touched_.contains(r); }

  Candidates& all;
  const SearchOptions& o;
  const size_t n;  // regions
  Advice a;
  std::set<const Candidate*> rejected;

 private:
  void find_contacts();
  void find_base();
  void find_reference();
  bool doubts(const Candidate& c, Assignment& levels);
  const Candidate* by_twice(const Request& cells);
  bool needs_cells_beside(const Assignment& levels, const Assignment& cells) const;
  bool is_measured_method() const;
  bool mend(const Candidate& c, Assignment& levels);
  double window_of(const Candidate& c) const;
  std::string take_step(const Candidate& c);
  bool may_be_twice() const;
  bool is_known_by_twice(double off);
  size_t largest_step() const;
  [[noreturn]] void refuse_step() const;

  double window_ = 0;               // in which all quantities have their values, 0: the whole run  [s]
  std::set<size_t> touched_;        // regions with a surface in a contact
  std::map<size_t, double> doubt_;  // by region, the largest so far, over the tightest tolerance
};

}  // namespace hilo
