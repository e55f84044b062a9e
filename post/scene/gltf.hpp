// SPDX-License-Identifier: GPL-3.0-or-later
// A run as glTF 2.0 (ISO/IEC 12113), which browsers, slides and Blender show: the surface of each region, coloured by a field.
#pragma once
#include <string>
#include <vector>

#include "post/scene/shown_field.hpp"

namespace hilo {

struct GltfOptions {
  std::vector<Step> steps;   // one: a still picture; several: an animation
  std::string field, range;  // range: "low,high" in the stored unit, or ""
  std::vector<std::string> show, hide;
  double speed = 1;  // seconds of the run in a second of the animation
};

struct Gltf {
  std::string bytes;                                // of a .glb
  size_t regions = 0, triangles = 0, left_out = 0;  // left_out: bars
};
/// Bodies and beams are in it where they were drawn into the run (RunFile).  Positions are those that pictures have (shapes of modes are
/// drawn larger), turned so that z points up (y in glTF).  Each region moves with a node of its own by its best rigid motion, linear
/// between the steps; what it deforms beyond that are morph targets, one for each step.  Colours show at every vertex the value largest in
/// size over the steps.  Error (exit 1) for a field of cells that is not one of regions.
Gltf gltf_of(RunFile& run, const GltfOptions& o);

}  // namespace hilo
