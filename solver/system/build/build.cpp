// SPDX-License-Identifier: GPL-3.0-or-later
// The system of a scene, step by step.
#include <Eigen/Geometry>
#include <algorithm>

#include "model/scene_sets.hpp"
#include "system/beams.hpp"
#include "system/bodies.hpp"
#include "system/buckling_modes.hpp"
#include "system/build/builder.hpp"
#include "system/contact/contacts.hpp"
#include "system/joint_coordinates.hpp"
#include "system/joints.hpp"
#include "system/linear_beams.hpp"
#include "system/linear_regions.hpp"
#include "system/load_path.hpp"
#include "system/loads.hpp"
#include "system/modal_damping.hpp"
#include "system/mode_output.hpp"
#include "system/motions.hpp"
#include "system/point_masses.hpp"
#include "system/region_measures.hpp"
#include "system/solids.hpp"
#include "system/springs.hpp"
#include "system/stations.hpp"
#include "system/tied_surfaces.hpp"
#include "system/welds.hpp"

namespace hilo {

namespace {

struct OutsideKind {
  std::string_view name;
  std::function<void(const Scene&, System&)> make;
};
Registry<OutsideKind>& outside_kinds() {
  static Registry<OutsideKind> kinds{"contribution", {}};
  return kinds;
}

}  // namespace

void add_contribution(const OwnSection& words, std::function<void(const Scene&, System&)> make) {
  own_sections().add(words);
  outside_kinds().add({words.name, std::move(make)});
}

Builder::Builder(const Scene& scene, LocalMesh* mesh, const Comm& comm, const ReducedFiles& files, const FactorRoom& room)
    : scene_(scene), mesh_(mesh), comm_(comm), files_(files), room_(room) {}

/// All that takes part in the equations; evaluations, results and the line that tells them go in this order.
void Builder::add_contributions() {
  System& s = *out_;
  s.add<Solids>(s);
  s.add<Bodies>(s);
  s.add<LinearRegions>(s);
  s.add<PointMasses>(s);
  const Beams& beams = s.add<Beams>(s);
  s.add<LinearBeams>(s);
  s.add<Welds>(s);
  const Joints& joints = s.add<Joints>(s);
  s.add<Springs>(s, joints);
  s.add<Contacts>(s, is_static()).plain = scene_.table("time").text("integrator") != "energy-momentum";
  s.add<TiedSurfaces>(s);
  s.add<Loads>(s);
  s.add<Motions>(s, beams, [&joints](const Moment& at, int j) { return joints.held_points(at, j); });
  s.add<Stations>(s);
  s.add<JointCoordinates>();
  const std::string& analysis = scene_.table("time").text("analysis");
  s.add<RegionMeasures>(s, analysis);
  s.add<ModalDamping>(s);
  if (analysis == "modes") s.add<ModeOutput>(static_cast<int>(scene_.table("time").number("modes")));
  if (analysis == "buckling") s.add<BucklingModes>();
  if (analysis == "path") s.add<LoadPath>();
}

bool Builder::is_static() const {
  const std::string& analysis = scene_.table("time").text("analysis");
  return analysis == "static" || analysis == "path" || analysis == "buckling";
}

std::unique_ptr<System> Builder::build() {
  out_ = std::make_unique<System>();
  add_contributions();
  out_->comm = &comm_;
  out_->mesh = mesh_;
  out_->gravity = scene_.table("scene").vector3("gravity");
  if (mesh_) {
    add_scene_sets(scene_, *mesh_, comm_);
    bring_pairs_together();
    n_active_ = put_active_nodes_first();
    out_->X = mesh_->mesh.X;
    out_->node_owned = mesh_->node_owned;
    out_->length = mesh_->length;
  }
  out_->start.x.assign(out_->X.begin(), out_->X.begin() + n_active_);
  out_->follower.assign(out_->X.size(), -1);
  out_->fixed.assign(out_->X.size(), {false, false, false});
  held_by_.resize(out_->X.size());
  new_body("ground", Vec3::Zero());
  out_->bodies[0].ground = true;
  read_regions();
  close_ties();
  integrate_regions();
  find_shells();
  make_rigid_bodies();
  make_linear_bodies();
  add_free_bodies();
  add_sections();
  comm_.together([&] { make_batches(); });  // a region that lacks something may have its cells on one rank
  weld_neighbours();
  add_point_masses();
  add_beams();
  add_motions();
  add_joints();
  add_joint_coordinates();
  add_springs();
  add_joint_forces();
  add_contacts();
  add_loads();
  add_stations();
  make_blocks();
  add_ties();
  drop_spinning_torques();
  for (const OutsideKind& kind : outside_kinds()) kind.make(scene_, *out_);
  if (!mesh_) {  // size of a scene of bodies: what its points span
    Eigen::AlignedBox3d box;
    for (size_t b = 1; b < out_->bodies.size(); ++b) box.extend(out_->bodies[b].Xc);
    for (const BeamCell& cell : out_->part<Beams>().cells)
      for (int e = 0; e < 2; ++e) box.extend(Vec3(out_->bodies[cell.body[e]].Xc + Eigen::Map<const Vec3>(cell.arc.arm[e].v)));
    for (const LinearSection& s : out_->part<LinearBeams>().sections) box.extend(s.at);
    for (const Joint& j : out_->part<Joints>())
      for (const Entity& e : j.entities)
        if (e.point && j.end[e.end].body >= 0) box.extend(Vec3(out_->bodies[j.end[e.end].body].Xc + e.r));
    out_->length = box.isEmpty() ? 1 : std::max(box.diagonal().norm(), 1e-9);
    if (out_->length < 1e-8) out_->length = out_->bodies.size() > 1 ? out_->bodies[1].size : 1;
  }
  const bool is_static = this->is_static();
  if (!(out_->mass > 0) && !is_static)
    throw Error(scene_.path, "the scene has no mass: nothing can move", "give a mesh or [[body]] entries, and densities");
  reduce_linear_regions();
  out_->stiffness = comm_.max(out_->stiffness);  // cells are on their ranks
  out_->prepare();
  out_->part<Bodies>().look_at_lines(*out_);
  if (comm_.sum(static_cast<double>(out_->n_blocks())) == 0) warn(scene_.path, "nothing is free to move: every region and body is held");
  set_initial_velocities();
  return std::move(out_);
}

std::unique_ptr<System> build_system(const Scene& scene, LocalMesh* mesh, const Comm& comm, const ReducedFiles& files) {
  return build_system(scene, mesh, comm, files, {});
}
std::unique_ptr<System> build_system(const Scene& scene, LocalMesh* mesh, const Comm& comm, const ReducedFiles& files,
                                     const FactorRoom& room) {
  return Builder(scene, mesh, comm, files, room).build();
}

}  // namespace hilo
