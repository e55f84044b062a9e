// SPDX-License-Identifier: GPL-3.0-or-later
// Checkpoints: what a run remembers, on file beside its results, so that `hilo-solve --restart run.h5` goes on from there.
//
// Two are kept, run.checkpoint.h5 and the one before it, run.checkpoint-1.h5; each is written whole, made safe and renamed.  The rows of
// run.h5 until then are safe before it has its name.
#pragma once
#include <optional>

#include "dynamics/run.hpp"
#include "model/store.hpp"

namespace hilo {

/// When to write one, and when to stop.
struct CheckpointPolicy {
  double seconds = 15 * 60;  // between two; infinite: none by the clock
  long steps = 0;            // at multiples of these besides, 0: none
  double time_limit = 0;     // of the run by the clock [s], 0: none
  bool at_end = false;       // one stays when the run is complete, for a later end
  double began = 0;          // wall_clock() when the process began
};

/// The command that a run was made by.
struct RunCommand {
  std::string scene, mesh, modes;  // absolute paths, "-" or ""
  std::vector<std::string> overrides;
  std::string checkpoint = {};               // --checkpoint as given, or ""
  std::vector<std::string> provenance = {};  // command lines that led to the results
};

/// The checkpoints of one run.
class Checkpoints {
 public:
  /// `from`: the checkpoint that the run goes on from, or "".
  Checkpoints(const Comm& comm, const Scene& scene, RunCommand command, std::string output, CheckpointPolicy policy,
              const std::string& from);
  /// As RunOptions::between_steps.
  std::string between_steps(const StepsSoFar& so_far, const std::function<Kept()>& keep);
  /// The run is complete: they are not wanted any more, unless asked for.
  void finish();

 private:
  std::string reason_to_stop();
  void write(const StepsSoFar& so_far, const std::function<Kept()>& keep);
  const Comm& comm_;
  const Scene& scene_;
  RunCommand command_;
  std::string output_, stop_file_;
  CheckpointPolicy policy_;
  std::vector<std::string> digests_;  // of mesh and tags, found once
  double last_, looked_, took_ = 0;   // [s] of the clock: last checkpoint, last look for STOP; seconds that the last one took
  double step_began_, longest_step_ = 0;
  bool newest_is_good_;
  bool former_is_ours_;  // else it is of a run before, until the first checkpoint of this one
};

/// The newest checkpoint of results that can be read.
struct Checkpoint {
  std::string path;
  long steps = 0;
  double t = 0;
  std::string scene;  // its text
  std::vector<std::string> values, digests;
  RunCommand command;
  Kept kept;  // arrays on rank 0
};
/// Error (exit 2) where there is none.  The same on all ranks.
Checkpoint read_checkpoint(const std::string& results, const Comm& comm);
/// The results are complete and no checkpoint lies beside them, as a run leaves them: the scene that was run, else nothing.
std::optional<Scene> complete_without_checkpoint(const std::string& results);
/// Why a scene cannot go on from there: the first key that differs and may not, as an Error with its place; what may differ is another end
/// not before the checkpoint, other output, looser tolerances, another solver.  The others as warnings where `accept`.
void require_same(const Checkpoint& from, const Scene& scene, const std::string& mesh, bool accept);

}  // namespace hilo
