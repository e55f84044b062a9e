// SPDX-License-Identifier: GPL-3.0-or-later
// hilo-post bend: the mesh of a run with its nodes moved by shapes of the run, as a mesh to run again: a structure that is not perfect.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>

#include "base/args.hpp"
#include "base/error.hpp"
#include "model/inputs.hpp"
#include "model/mesh_source.hpp"
#include "post/commands/commands.hpp"
#include "post/run/marker.hpp"
#include "post/run/run_file.hpp"

namespace hilo {
namespace {

struct BendOptions {
  std::string run, output;
  std::vector<std::string> shapes;
};

Eigen::Map<const Eigen::Matrix3Xd> columns(const RunFile::Field& f) {
  return {f.value.data(), 3, static_cast<Eigen::Index>(f.value.size() / 3)};
}
/// The displacement of a step, of a shape without that of the drawn state.
Eigen::Matrix3Xd way_of(const RunFile& run, const Step& step) {
  const auto there = run.field(step, "displacement");
  Eigen::Matrix3Xd way = columns(there);
  if (!run.shapes.empty() && step.key != run.steps.front().key) way -= columns(run.field(run.steps.front(), "displacement"));
  return way;
}

/// "2=0.5e-3": step 2, whose largest displacement becomes 0.5 mm.
std::pair<std::string, double> read_shape(const std::string& word) {
  const size_t mark = word.find('=');
  double size = 0;
  const char* end = word.data() + word.size();
  if (mark == word.npos || std::from_chars(word.data() + mark + 1, end, size).ptr != end || !std::isfinite(size) || size == 0)
    throw Error("--shape", fmt::format("\"{}\" is not a step and the size of its largest displacement in m", word),
                "--shape 1=0.5e-3 is half a millimetre of the first shape", Exit::usage);
  return {word.substr(0, mark), size};
}

void run(const BendOptions& o) {
  RunFile file = judged_run(o.run);
  const size_t n_nodes = file.mesh().X.size();
  if (file.is_skin()) throw Error(o.run, "has the displacements of the skin alone", "run it with output.nodes = \"all\", the default");
  check_output(o.output);
  Eigen::Matrix3Xd way = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(n_nodes));
  for (const std::string& word : o.shapes) {
    const auto [number, size] = read_shape(word);
    const auto steps = file.select_steps(number, "");
    if (steps.size() != 1) throw Error("--shape", fmt::format("\"{}\" is not one step", number), "", Exit::usage);
    const Eigen::Matrix3Xd shape = way_of(file, steps.front());
    const double largest = shape.colwise().norm().maxCoeff();
    if (!(largest > 0)) throw Error(o.run, fmt::format("nothing moves in step {}", number), "steps of shapes begin with 1", Exit::usage);
    way += size / largest * shape;
  }
  Eigen::AlignedBox3d box;
  for (const Vec3& X : file.mesh().X) box.extend(X);
  if (const double most = way.colwise().norm().maxCoeff(), large = box.diagonal().norm(); most > 0.1 * large)
    warn("--shape", fmt::format("nodes move by {:.3g} m, and the mesh is {:.3g} m long: lengths are in m", most, large));

  MeshFile bent = read_mesh_file(holder(file.store(), "/mesh"));  // without the sets of the scene
  Mesh& mesh = bent.mesh;
  std::vector<std::vector<Vec3>> from(mesh.block_name.size()), to(from.size());
  for (size_t n = 0; n < n_nodes; ++n) {
    const Vec3 X = mesh.X[n];
    mesh.X[n] += way.col(static_cast<Eigen::Index>(n));
    if (!mesh.block.empty() && mesh.block[n] >= 0)
      from[static_cast<size_t>(mesh.block[n])].push_back(X), to[static_cast<size_t>(mesh.block[n])].push_back(mesh.X[n]);
  }
  for (size_t b = 0; b < from.size(); ++b)
    if (!from[b].empty()) mesh.block_at[b] = best_pose(from[b], to[b])(mesh.block_at[b]);
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c)
    if (quality(mesh, c).volume <= 0)
      throw Error("--shape", fmt::format("cell {} is turned inside out", mesh.cell_id[static_cast<size_t>(c)]), "bend it less");
  if (std::ranges::any_of(file.mesh_file().fidelity, [](Fidelity f) { return f != Fidelity::nonlinear; }))
    warn(o.output, "is not tagged, as the mesh of the run was: hilo-tag");
  bent.provenance.push_back("hilo-post bend " + o.run);
  write_mesh(o.output, mesh, bent.provenance);
}

}  // namespace

Command bend_command(CLI::App& app) {
  auto* sub = app.add_subcommand(
      "bend", "the mesh of a run, its nodes moved by shapes of buckling, by modes or by another step: an imperfect structure to run again");
  const auto o = std::make_shared<BendOptions>();
  sub->add_option("run", o->run, "run.h5 of hilo-solve, with displacements")->required();
  sub->add_option(
         "--shape", o->shapes,
         "STEP=LENGTH: that step, its largest displacement made this long [m], below zero the other way; may be repeated, they add up")
      ->required()
      ->allow_extra_args(false)
      ->take_all();
  sub->add_option("-o,--output", o->output, "the mesh.h5 to write; sets, regions and blocks stay; tag it again")->required();
  example(*sub,
          "  hilo-post bend modes.h5 --shape 1=0.5e-3 -o bent.h5\n  hilo-post bend modes.h5 --shape 1=0.5e-3 --shape 2=-0.1e-3 -o bent.h5");
  return {sub, [o] { run(*o); }};
}

}  // namespace hilo
