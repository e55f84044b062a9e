// SPDX-License-Identifier: GPL-3.0-or-later
// A second solution beside a run, in steps as long as two of its own, for the estimate of its error.
#pragma once
#include <deque>
#include <functional>
#include <memory>

#include "dynamics/error/error_estimate.hpp"
#include "dynamics/impulse.hpp"
#include "dynamics/integrator.hpp"

namespace hilo {

class Companion {
 public:
  /// `make_solver`: for its matrices, which are none of the run's; `begin` begins it.
  Companion(System& system, std::unique_ptr<Integrator> integrator, std::function<std::unique_ptr<KktSolver>()> make_solver,
            const NewtonOptions& newton)
      : system_(system), integrator_(std::move(integrator)), make_solver_(std::move(make_solver)), newton_(newton) {
    renew_solver();
  }
  Integrator& integrator() { return *integrator_; }
  bool has_begun() const { return begun_; }
  int waiting() const { return waiting_; }  // steps of the run that it has not followed yet
  /// From the state of the run.
  void begin(const State& s);
  /// The run has taken a step, to s.  Every second one is followed.
  void follow(const State& s, double added, ErrorEstimate& estimate);
  /// At an event, where the run may restart (then velocities are struck, and history that is needed begins anew) and at the end.
  void catch_up(const State& s, double added, ErrorEstimate& estimate);
  void restart(const State& of_run, bool strikes, double jerk_step);
  /// Its solver keeps factors: they are made anew.
  void renew_solver();
  void archive(Archive& a);

 private:
  bool step(double to, int cuts, ErrorEstimate& estimate);
  bool try_step(double to);
  void swap_memory();
  System& system_;
  std::unique_ptr<Integrator> integrator_;
  std::function<std::unique_ptr<KktSolver>()> make_solver_;
  std::unique_ptr<KktSolver> solver_;
  NewtonOptions newton_;
  bool begun_ = false;
  State state_, reached_;
  Config start_;  // of the run
  int waiting_ = 0;
  bool turns_far_ = false;  // the step tried last turned a part further than a step may
  Kept memory_;             // what the contributions remember, of the other solution
  Impulses untold_;
};

}  // namespace hilo
