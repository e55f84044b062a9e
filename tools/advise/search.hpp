// SPDX-License-Identifier: GPL-3.0-or-later
// The search for the cheapest model that answers as a base does.
#pragma once
#include <deque>

#include "advise/candidates.hpp"

namespace hilo {

enum class Check { where_in_doubt, always, never };  // of linear strains, by cells

struct SearchOptions {
  double tightest = 0.02;        // of all relative tolerances
  std::map<size_t, Level> kept;  // regions whose level is not tried
  Check check = Check::where_in_doubt;
  bool each_region = false;  // is it asked what each region is worth?
  double at_most = 3;        // what all of it may cost, in runs of all cells
};

/// What decided, and what of it is known.
struct Advice {
  const Candidate *base = nullptr, *reference = nullptr, *chosen = nullptr;  // reference: the base, or it with some regions nonlinear
  const Candidate* beside = nullptr;  // what the reference was made from, where it is no run; else the reference
  // parts of the error of the chosen model by quantity, each in its unit; empty where that is not known
  std::vector<double> step;                    // what a step of none would change
  bool is_by_half = false;                     // is that known by half the step?
  std::vector<double> modes;                   // what all modes of its linear regions would
  double modes_at_most = 0;                    // what they may change, over the tightest tolerance, by the strain they lack
  std::vector<double> mesh;                    // what cells of no size would
  double doubt = 0;                            // what strains of the second degree may change of the reference, over the tightest tolerance
  double tightest = 0;                         // that tolerance, relative; those in units by the values of the base
  std::map<size_t, const Candidate*> without;  // the chosen model with this region rigid
  std::vector<const Candidate*> tried;
  std::deque<Candidate> made;                                       // references that are no runs
  std::map<size_t, std::string> kept_rigid;                         // regions that cannot deform, and why
  double all_cells = 0;                                             // what a run of all cells costs  [s]
  double positions_off = std::numeric_limits<double>::quiet_NaN();  // of the chosen model, by the solver's estimate: a share of the motion

  /// Error of a model that is `off` the reference in quantity k, the step's included, in its unit.  Where half the step told what a step of
  /// none makes of the reference, the model is judged against that, and told a quarter of the step's part in case the estimate is off.
  double with_step(double off, size_t k) const;
};

/// Errors: no model runs; no output of fields where stress is asked for; a step that no model can be judged with.
Advice advise(Candidates& all, const SearchOptions& options);

/// Do seconds differ by no more than those of a run that is done twice?
bool about_as_long(double a, double b);

/// Largest |difference| of the quantities over what is allowed of the reference, infinite where the candidate lacks one or did not run.
double difference(const Candidate& c, const Candidate& reference, std::string* worst = nullptr);

}  // namespace hilo
