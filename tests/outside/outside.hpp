// SPDX-License-Identifier: GPL-3.0-or-later
// What this program adds to hilo's lists, and a run of a scene in it.
#pragma once
#include "dynamics/run.hpp"
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace outside {

using namespace hilo::test;  // parts of scenes

// each in the file of its name; main() calls them all before the first scene is read
void add_deck_card();
void add_integrator();
void add_joint();
void add_materials();
void add_force_law();
void add_output_field();
void add_balls();
void add_buffer();
void add_pyramid();

/// The results of a scene, of a mesh file where one is named.
inline hilo::test::Results run_scene(const hilo::test::Workplace& place, const std::string& text, const std::string& mesh = "") {
  const hilo::Comm& comm = hilo::Comm::world();
  const hilo::Scene scene = hilo::Scene::parse(text, "scene.toml");
  std::unique_ptr<hilo::LocalMesh> local;
  if (!mesh.empty()) local = std::make_unique<hilo::LocalMesh>(hilo::read_local_mesh(place / mesh, comm));
  const auto system = hilo::build_system(scene, local.get(), comm);
  hilo::RunOptions options;
  options.output = place / "run.h5", options.provenance = {"outside"}, options.quiet = true;
  const hilo::RunReport report = hilo::run(scene, *system, options);
  if (!report.complete) throw std::runtime_error(report.reason);
  return hilo::test::Results(place / "run.h5");
}

}  // namespace outside
