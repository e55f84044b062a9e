// SPDX-License-Identifier: GPL-3.0-or-later
// The kinds of obstacles that entries [[obstacle]] of the scene can name.
#pragma once
#include "base/entry_values.hpp"
#include "base/param.hpp"
#include "base/registry.hpp"
#include "physics/contact/distance.hpp"

namespace hilo {

/// A shape with its place in reference coordinates.
struct Obstacle {
  Distance shape;
  Vec3 at = Vec3::Zero();
  Mat3 axes = Mat3::Identity();  // columns
};

struct ObstacleKind {
  std::string_view name, meaning;
  std::vector<Param> keys;  // of the scene, besides kind, name and what carries it
  Obstacle (*make)(const EntryValues& entry);
};
Registry<ObstacleKind>& obstacle_kinds();

/// Keys of [[contact]].
std::vector<Param> contact_keys();

}  // namespace hilo
