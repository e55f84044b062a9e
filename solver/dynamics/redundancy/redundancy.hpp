// SPDX-License-Identifier: GPL-3.0-or-later
// Redundant joint rows: found by rank, and switched off.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "system/system.hpp"

namespace hilo {

/// What the rank check found.
struct Redundancy {
  int rows = 0, rank = 0;
  static constexpr size_t told = 12;
  std::vector<std::string> dropped;  // "joint \"b\" row 3 (depends on joints a, c)", of the first `told` rows
  struct Held {
    int constraint;
    std::string by;  // those that leave its drive nothing to drive
  };
  std::vector<Held> held;
  std::vector<int> undetermined;  // multipliers of rows that were dropped and of those that they depend on, by place in lambda, rising
  // A singular position (a mechanism drawn flat, a dead point) has fewer independent rows than the poses beside it:
  std::vector<Active> at_pose;  // rows independent there, for solves at that very pose; empty where it is not singular
  int rank_at_pose = 0;
  std::vector<std::string> singular_joints;  // those with a row that depends on others there alone
  bool singular() const { return !at_pose.empty(); }
};
/// Rank of the joint rows at q by QR, group by group of connected rows; dependent ones are switched off in the system's joints.  Whether
/// they depend on the others beside q too is seen by moving there: what opens is no redundant row and stays.  Drives come last.
Redundancy drop_redundant_rows(System& system, const Config& q, double t);
/// The same at a later q, where a step failed: another choice of as many rows or more is taken, fewer (a singular position) are not.
/// True where the choice has changed.
bool recheck_redundant_rows(System& system, const Config& q, double t, Redundancy& now);
/// The rows of all joints that are on, and switching them; an empty list changes nothing.
std::vector<Active> active_rows(const System& system);
void set_rows(System& system, const std::vector<Active>& rows);
/// A pose on a branch that all rows but those of drives allow, ahead of q along v by `far` of the scene's length; nothing at rest.
std::optional<Config> pose_ahead(const System& system, const Config& q, const Config& v, double t, double far);
/// The same along some direction, the same on all ranks.
std::optional<Config> pose_aside(const System& system, const Config& q, unsigned seed, double t, double far);
/// Rows independent at q, a pose beside the singular one.
void choose_rows_beside(System& system, const Config& q, Redundancy& now);

}  // namespace hilo
