// SPDX-License-Identifier: GPL-3.0-or-later
// What a results file says of itself before the first row.
#include <Eigen/Eigenvalues>

#include "dynamics/record/recorder.hpp"
#include "model/mesh_source.hpp"
#include "system/beams.hpp"
#include "system/bodies.hpp"
#include "system/section_meshes.hpp"

namespace hilo {

void Recorder::declare_run(Store& f, const std::vector<double>& resolved) const {
  f.set("/", "format", std::string("hilo run"));
  f.set("/", "version", std::int64_t{1});
  f.set("/", "complete", std::int64_t{0});
  f.write_strings("/provenance", setup_.provenance);
  f.write_text("/scene", scene_.text);
  f.set("/", "title", scene_.table("scene").has("title") ? scene_.table("scene").text("title") : std::string());
  if (system_.mesh) {
    const LocalMesh& m = *system_.mesh;
    link_to(f, "mesh", holder(Store::open(m.file), "mesh"));
    std::vector<std::string> words;
    for (Fidelity level : m.fidelity) words.emplace_back(word(level));
    f.write_strings("/tags/fidelity", words);
    write_array(f, "/resolved", resolved, {static_cast<std::int64_t>(resolved.size())});
    const auto lowest = std::min_element(resolved.begin(), resolved.end());
    f.set("/resolved", "region", m.mesh.region_name[lowest - resolved.begin()]);
  }
}

void Recorder::declare_bodies(Store& f) const {
  std::vector<std::string> names;
  std::vector<double> points, mass, inertia;
  for (size_t b = 1; b < system_.bodies.size(); ++b) {
    const Body& body = system_.bodies[b];
    names.push_back(body.name);
    for (const Vec3& arm : body_arms(body)) {
      const Vec3 x = body.Xc + arm;
      points.insert(points.end(), x.data(), x.data() + 3);
    }
    mass.push_back(body.mass);
    const Vec3 e = Eigen::SelfAdjointEigenSolver<Mat3>(body.J.trace() * Mat3::Identity() - body.J).eigenvalues();
    inertia.insert(inertia.end(), e.data(), e.data() + 3);
  }
  const auto n_bodies = static_cast<std::int64_t>(names.size());
  if (n_bodies > 0) {
    f.write_strings("/body/name", names);
    write_array(f, "/body/points", points, {n_bodies, 4, 3});
    write_array(f, "/body/mass", mass, {n_bodies});
    write_array(f, "/body/inertia", inertia, {n_bodies, 3});
  }
  for (const NamedSection& section : section_meshes(system_)) {
    const SectionMesh& m = section.mesh;
    std::vector<double> x;
    std::vector<std::int32_t> cells;
    for (const auto& at : m.X) x.insert(x.end(), at.data(), at.data() + 2);
    for (const auto& cell : m.cells) cells.insert(cells.end(), cell.begin(), cell.end());
    write_array(f, "/section/" + section.name + "/points", x, {static_cast<std::int64_t>(m.X.size()), 2});
    write_array(f, "/section/" + section.name + "/cells", cells, {static_cast<std::int64_t>(m.cells.size()), 9});
  }
}

}  // namespace hilo
