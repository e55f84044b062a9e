// SPDX-License-Identifier: GPL-3.0-or-later
// What of a scene can be drawn: joints, springs, loads, supports, sensors and bodies, each at its place in the model.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "model/mesh.hpp"
#include "model/scene.hpp"
#include "post/picture/colour.hpp"
#include "post/run/ellipsoid.hpp"

namespace hilo {

enum class Glyph {
  ball,
  hinge,
  slider,
  block,
  link,
  coil,
  spiral,
  bushing,
  ground,
  arrow,
  turn,
  clamp,
  triad,
  cross,
  mass,
  stop,
  friction,
  outline
};

struct SceneItem {
  Glyph glyph = Glyph::ball;
  std::string name, meaning;  // "trunnion", "revolute joint"
  Rgb colour;
  Vec3 at = Vec3::Zero();                  // its point          [m]
  Vec3 to = Vec3::Zero();                  // second point of links and coils  [m]
  Vec3 along = Vec3::Zero();               // axis or direction, of any length
  Vec3 above = Vec3::Zero();               // second axis of a triad
  std::vector<Vec3> nodes;                 // what it holds: drawn as dots (thinned)
  std::vector<std::vector<Vec3>> lines{};  // of an outline
};

struct SceneItems {
  std::vector<SceneItem> items;
  std::vector<Ellipsoid> bodies;
};
/// The symbol of a kind of joint, spring, stop, motor, friction, load or motion; one that has none is an Error (exit 5).
Glyph glyph_of(std::string_view section, std::string_view kind);
/// `mesh` may be empty.  A name that is neither region, set nor body is an Error at its place in the scene.
SceneItems scene_items(const Scene& scene, const MeshFile* mesh);

}  // namespace hilo
