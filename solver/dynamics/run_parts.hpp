// SPDX-License-Identifier: GPL-3.0-or-later
// A run on its way: what it is made of, and the steps that take it from its start to its end.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/audit.hpp"
#include "dynamics/error/step_control.hpp"
#include "dynamics/impulse.hpp"
#include "dynamics/progress.hpp"
#include "dynamics/record/recorder.hpp"
#include "dynamics/redundancy/redundancy.hpp"
#include "dynamics/run.hpp"
#include "dynamics/step_plan.hpp"

namespace hilo {

/// What run.json tells beside the report, the audit and the profile.
struct RunFigures {
  double assembled = 0, projected = 0;  // changes of positions at the start [m], of velocities [m/s]
  double local = -1;                    // sum of local position errors [m], where the tolerance chooses steps of a method of second order
  long rejected = 0;                    // steps
  long unstable = -1;                   // states of a static run that were kept though not stable
};

enum class Analysis { dynamic, statics, path, modes, buckling };

struct RunParts {
  const Scene& scene;
  System& system;
  const RunOptions& options;
  Analysis analysis;
  bool talk;
  bool is_rigid = false;              // in time: nothing bends or touches
  std::string energy_unchecked = {};  // why the audit does not check the balance of energy, or ""
  NewtonOptions newton = {};
  int max_cuts = 8;
  std::vector<Event> events = {};  // of a dynamic run; the last is the end
  std::unique_ptr<KktSolver> solver = {};
  std::unique_ptr<Integrator> integrator = {};
  std::optional<Audit> audit = {};
  std::unique_ptr<Recorder> recorder = {};
  Redundancy redundancy = {};
  State state = {};  // accepted
  RunReport report = {};
  RunFigures figures = {};
  std::vector<Json::Member> lists = {};  // of modes, load factors, turns of a path or jumps to other branches, for run.json
  Impulses impulses = {};
  StepPlan plan = {};
  ErrorEstimate estimate = {};

  /// The system has another structure: the solver, the state and the integrator follow.
  void follow(const Carry& carry);
  /// Back to what the contributions remembered, after states that led elsewhere.
  void recall(const Kept& memory);
  /// Why its error is far below what was asked, or "".
  std::string why_better() const;
  /// The run ends here for this reason.
  void stop(const std::string& reason);
};

/// What happens between two steps: why the run is to end there, or "".
using Pause = std::function<std::string()>;

/// From the start of a run to its end, or to where it stops.
class Steps {
 public:
  /// `pause` is called between two of them.
  Steps(RunParts& run, Pause pause) : run_(run), pause_(std::move(pause)) {}
  virtual ~Steps() = default;
  /// From the start, or on from where archive() has restored them to.
  virtual void take() = 0;
  /// Where it is; between two steps.
  virtual void archive(Archive& a) = 0;

 protected:
  /// What can meet in a step of length h from the state is looked for, and all that is laid out like the unknowns follows.
  void search(double h);
  /// The first row: the state at rest under this share of the loads, with the forces that it has there.
  void record_rest(const State& rest, double load_factor);
  RunParts& run_;
  Pause pause_;
};

/// Static equilibrium under the loads at the start; false, and the run stopped, where there is none.
bool settle_down(RunParts& run);

std::unique_ptr<Steps> mode_steps(RunParts& run, Pause pause);
std::unique_ptr<Steps> buckling_steps(RunParts& run, Pause pause);
std::unique_ptr<Steps> static_steps(RunParts& run, Pause pause);
std::unique_ptr<Steps> path_steps(RunParts& run, Pause pause);
std::unique_ptr<Steps> dynamic_steps(RunParts& run, Pause pause);

class Profile;
/// run.json, beside the results.
void write_run_json(const RunParts& run, const Profile& profile, double peak_memory);

}  // namespace hilo
