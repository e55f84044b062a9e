// SPDX-License-Identifier: GPL-3.0-or-later
// How time.tolerance is met: by passes over the whole run.
//
// A local control cannot know what the motion makes of an early error later.  A pass tells its error at the end (dynamics/companion), and
// where that is more than was asked, another one follows, with the local demand that the order of the method and the passes so far make of
// it.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "dynamics/error/error_estimate.hpp"
#include "model/scene.hpp"
#include "system/system.hpp"

namespace hilo {

struct RunReport;

struct StepPlan {
  double asked = 0;             // error of positions at the end [m]; 0: steps are equal
  bool chooses_method = false;  // the scene does not name one
  struct Pass {
    std::string method;  // the word of the scene for it
    double demand = 0;   // of StepControl
    double error = 0;    // at the end [m]
    long steps = 0;
  };
  std::vector<Pass> passes = {};  // the last one is at work
  std::string unmet = "";         // why the error is larger than asked, or not known, or ""
  Config end = {};                // positions that the pass before came to

  const Pass& now() const { return passes.back(); }
};

StepPlan first_plan(const Scene& scene, const System& system);
/// Note what the pass at work came to and plan another one; false where none is needed or none would do.  `q`: its end; `order`: of its
/// method.
bool plan_another(StepPlan& plan, const RunReport& report, const Config& q, const ErrorEstimate& estimate, int order, const System& system,
                  double end);
/// Step that a run in time may take at most [s].
double longest_step(const Entry& time);
/// Why a run that met what was asked has an error at the end of less than a tenth of that, or "".  `order`: of its method; `length`: of the
/// scene [m].
std::string why_better(const StepPlan& plan, const RunReport& report, const ErrorEstimate& estimate, int order, double length,
                       const Entry& time);

}  // namespace hilo
