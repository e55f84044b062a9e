// SPDX-License-Identifier: GPL-3.0-or-later
// Where the time of a run goes: seconds, counts and messages by phase, on every rank.
#pragma once
#include <array>
#include <string>

#include "base/comm.hpp"
#include "base/json.hpp"
#include "base/traffic.hpp"
#include "linear/kkt.hpp"

namespace hilo {

/// What a phase has cost on this rank.
struct Phase {
  double seconds = 0;
  Traffic sent;
};

/// Since the start of the run.
struct Phases {
  Phase assembly, solve, output;  // a solve includes the set-up of factors and preconditioners
  long evaluations = 0, tangents = 0, solves = 0, linear_iterations = 0, records = 0;
  struct Earlier {  // what is not counted here: of solvers given up, and of processes that this one goes on from
    double set_up = 0, undivided = 0, wall = 0, processor = 0;  // [s]
    Traffic sent;
  } earlier;
};
Phases& phases();
double wall_clock();
/// Seconds that processors have spent on this process.
double processor_clock();

/// Adds its own life to a phase.
class Timed {
 public:
  explicit Timed(Phase& phase) : phase_(phase), start_(wall_clock()), sent_(traffic()) {}
  ~Timed();
  Timed(const Timed&) = delete;

 private:
  Phase& phase_;
  double start_;
  Traffic sent_;
};

/// The phases of a run over all ranks.
struct Profile {
  struct Row {
    std::string name;
    double seconds = 0, imbalance = 1;     // mean over the ranks; largest over mean
    double messages = 0, collectives = 0;  // of the rank with most of them
    double bytes = 0;                      // sent by the rank that sent most
    std::string count;                     // "12 evaluations, 4 tangents"
  };
  std::array<Row, 6> rows;                    // assembly, set-up, solve (without it), output, rest, all
  double processor_seconds = 0;               // of all ranks
  double undivided_seconds = 0;               // coarse problems, which every rank solves whole: largest
  double solver_bytes = 0, result_bytes = 0;  // matrix and factors of the rank with most; results file
  /// Collective: every rank takes part.  `began`: when the process took up the run, by both clocks.
  Profile(const Comm& comm, const KktSolver& solver, double began, double processor_began, const std::string& results);
  /// To run.json: keys profile, processor_seconds, undivided_seconds, solver_bytes, result_bytes.
  void tell(Json& run) const;
  /// A table for people.
  std::string text() const;
};

}  // namespace hilo
