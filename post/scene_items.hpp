// What of a scene can be drawn: joints, springs, loads, supports, sensors and bodies, each at its place in the model.
#pragma once
#include <string>
#include <vector>

#include "model/mesh.hpp"
#include "model/scene.hpp"
#include "post/colour.hpp"

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
  friction
};

struct SceneItem {
  Glyph glyph = Glyph::ball;
  std::string name, meaning;  // "trunnion", "revolute joint"
  Rgb colour;
  Vec3 at = Vec3::Zero();     // its point          [m]
  Vec3 to = Vec3::Zero();     // second point of links and coils  [m]
  Vec3 along = Vec3::Zero();  // axis or direction, of any length
  Vec3 above = Vec3::Zero();  // second axis of a triad
  std::vector<Vec3> nodes;    // what it holds: drawn as dots (thinned)
};

/// A body without a mesh: an ellipsoid of its inertia.
struct Ellipsoid {
  std::string name;
  Vec3 centre;
  Mat3 axes;   // columns: principal directions
  Vec3 radii;  // 0 where the body has no inertia
};

struct SceneItems {
  std::vector<SceneItem> items;
  std::vector<Ellipsoid> bodies;
};
/// `mesh` may be empty.  A name that is neither region, set nor body is an Error at its place in the scene.
SceneItems scene_items(const Scene& scene, const MeshFile* mesh);

}  // namespace hilo
