// SPDX-License-Identifier: GPL-3.0-or-later
// A results file as pictures and tables see it: mesh, tags, field steps and histories, read a step at a time.  A run in progress can be
// read.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/mesh.hpp"
#include "model/scene.hpp"
#include "model/store.hpp"

namespace hilo {

/// One output of the fields: the name of its group and its time.
struct Step {
  std::string key;  // "000012"
  double t;         // [s]
};

/// One history: a table over time.
struct Series {
  std::string name;                 // "joint.trunnion"
  std::vector<std::string> column;  // Fx, Fy, ...         (n_columns)
  std::vector<std::string> unit;    //                     (n_columns)
  std::vector<double> t;            //                     (n_t)  [s]
  std::vector<double> value;        // row by row          (n_t x n_columns)
  size_t rows() const { return t.size(); }
  double at(size_t row, size_t c) const { return value[row * column.size() + c]; }
};

struct RunBeam;
class SweptBeams;

class RunFile {
 public:
  /// Error when the file is missing, is no run, or its mesh.h5 has gone.
  explicit RunFile(const std::string& path);

  const std::string path;
  bool complete = false;  // false while the run goes on, and for a run that was stopped
  std::string title;      // of the scene, or its file's name
  std::vector<Step> steps;
  std::vector<double>
      shapes;            // of an analysis of modes [Hz] or of buckling [1], whose steps are the state of rest and the shapes; else empty
  bool buckles = false;  // one of buckling

  /// Mesh with the fidelity it was run at and the ranks of a parallel run; read at the first call.  Error for a scene of bodies alone.
  const MeshFile& mesh_file();
  const Mesh& mesh() { return mesh_file().mesh; }
  /// For a scene of bodies alone: ellipsoids of their inertia stand for a mesh, a region each, and the rows of the histories for outputs of
  /// displacements.  Nothing changes where there is a mesh.
  void stand_in_bodies();
  /// Beams join the mesh, swept along their axes: regions of their names, with displacements, axial_stress and von_mises where the section
  /// has a face.  After stand_in_bodies.
  void draw_beams();
  /// Does a region have values of a field of nodes?  A drawn beam has the three above, and nothing else has axial_stress.
  bool gives(size_t region, const std::string& field) const;
  bool has_mesh() const { return store_->linked("/mesh") || store_->has("/mesh"); }

  /// A nodal or cell field of a step and its number of columns; Error with the names there are.  Of a run with output.envelope each step
  /// has von_mises_envelope, acceleration_envelope and displacement_envelope, the largest over all steps, and von_mises_envelope_time ...
  struct Field {
    std::vector<double> value;
    int columns;
  };
  Field field(const Step& step, const std::string& name) const;
  /// A nodal field as a region has it: of nodes that it shares with another flexible region, its own stress; -1: as nodes have it.
  Field field_in(int region, const Step& step, const std::string& name) const;
  /// Nodes whose stress this region has besides that of the node.
  const std::vector<std::int64_t>& own_nodes(int region) const;
  std::vector<std::string> fields(const Step& step) const;
  bool has_field(const Step& step, const std::string& name) const;
  /// Does the run hold the fields of a node?  One that keeps the skin of its regions alone gives each inner node the values of the nearest
  /// node of the skin, counted in cells: in no picture without a cut are they seen.
  bool holds(std::int64_t node) const {
    return row_.empty() || node >= static_cast<std::int64_t>(row_.size()) || held_[static_cast<size_t>(node)];
  }
  bool is_skin() const { return store_->has("/skin/node"); }
  /// Steps by "all", "first", "last" or numbers "0,5,10:20"; by times "0.01,0.02" the nearest ones, or all from "0.01:0.02".
  std::vector<Step> select_steps(const std::string& numbers, const std::string& times) const;

  /// Beams of the scene, read at the first call; none where the scene cannot be read.
  const std::vector<RunBeam>& beams() const;
  /// Names of all histories: "energy", "joint.trunnion", ...; beam_stress.NAME is made of beam.NAME where the section has a face.
  std::vector<std::string> series_names() const;
  /// Columns and units without the values.
  Series describe(const std::string& name) const;
  Series series(const std::string& name) const;
  const Store& store() const { return *store_; }
  /// Close the file, and open it again: two processes must not share a handle.  What was read stays.
  void close();
  void open();

 private:
  std::optional<Store> store_;
  void read_skin();
  std::optional<MeshFile> mesh_;
  std::vector<std::int64_t> row_;  // of the fields, for each node; empty: the node's own
  std::vector<bool> held_;         // by the fields
  struct Border {
    std::vector<std::int64_t> entry, node;  // of the arrays of /border
  };
  void read_borders();
  std::vector<Border> borders_;  // of each region; empty: there are none
  struct Body {
    std::vector<Vec3> X;  // reference points
    Series way;           // of these points
    size_t first, last;   // its nodes
  };
  const RunBeam* stressed_beam(const std::string& series) const;  // null where the name is of another history
  mutable std::shared_ptr<const std::vector<RunBeam>> beams_;
  Field own_field(const Step& step, const std::string& name) const;  // of the mesh, or of bodies that stand in for it
  std::shared_ptr<SweptBeams> swept_;
  Field bodies_displacement(const Step& step) const;
  std::vector<Body> bodies_;  // that stand in for a mesh
};

/// A run that is to be judged: warns where it is not complete.
RunFile judged_run(const std::string& path);

/// The scene of a run without its histories: their CSV files may be elsewhere by now.
Scene scene_of(const RunFile& run);

/// Does a name match a glob (* ? [abc])?
bool matches(const std::string& glob, const std::string& name);

/// Sensors of a run that match any of the globs.
std::vector<std::string> sensor_names(const RunFile& run, const std::vector<std::string>& globs);

}  // namespace hilo
