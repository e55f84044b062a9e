// SPDX-License-Identifier: GPL-3.0-or-later
// The kinds of forces that entries of the scene can name: between two ends ([[spring]]), and along a joint ([[stop]], [[motor]],
// [[friction]]).  Another one is a row of its table; a law of forces of its own is a SpringLaw (force_law.hpp) and what makes a Spring of
// it.
#pragma once
#include "base/entry_values.hpp"
#include "base/param.hpp"
#include "base/registry.hpp"
#include "physics/spring.hpp"

namespace hilo {

/// What an entry is made of: its values and, found by name, its ends.
struct SpringPlace {
  const EntryValues& entry;
  Carrier a, b;
};

struct SpringKind {
  std::string_view name, meaning;
  std::vector<Param> keys;  // of the scene, besides kind, name and the two ends
  Spring (*make)(const SpringPlace& place, const Config& q);
  bool turns_a = false, turns_b = false;  // the end must be able to turn: no single node
};
Registry<SpringKind>& spring_kinds();

/// The joint along which an entry acts: its geometry, and its number among those with multipliers, or -1 where it gives way.
struct JointHost {
  const Connector& geometry;
  const JointKind& kind;
  int joint;
};

struct JointForceKind {
  std::string_view name, section, meaning;  // name "": the only one of its section
  std::vector<Param> keys;                  // of the scene, besides kind and name
  Spring (*make)(const EntryValues& entry, const JointHost& host, const Config& q);
};
Registry<JointForceKind>& joint_force_kinds();

/// Law of a stop from the keys lower, upper, stiffness, restitution and rest_speed.
StopLaw stop_law(const EntryValues& entry);
/// These keys but for the limits and the stiffness.
std::vector<Param> rebound_keys(std::string_view unit_of_speed);

}  // namespace hilo
