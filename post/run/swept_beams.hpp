// SPDX-License-Identifier: GPL-3.0-or-later
// Beams as pictures draw them: the face of their section, swept along the helix of each cell.  What is known of its shape by numbers alone
// is drawn as the rectangle of these.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "post/run/marker.hpp"
#include "post/run/run_beams.hpp"

namespace hilo {

class SweptBeams {
 public:
  /// Adds regions, nodes and cells to the mesh.
  SweptBeams(const RunFile& run, MeshFile& file);
  size_t first_node() const { return first_node_; }
  size_t first_region() const { return first_region_; }
  bool stressed() const;  // has any beam a face
  bool has_face(size_t region) const { return beams_[region - first_region_].shows_stress(); }
  /// Adds the values of the nodes, or of the cells, of beams to those of the mesh at a step.
  void append(const Step& step, const std::string& name, RunFile::Field& field) const;

 private:
  struct Carrier {
    std::vector<Vec3> X;              // reference points of a body, or the nodes of a set
    std::vector<std::int64_t> nodes;  // of the set
    Series way;                       // of the points of a body
  };
  struct Node {
    size_t beam, cell, point;
    double s;   // from 0 to 1 along the cell
    bool last;  // of a cell after which another goes on
  };
  /// The faces at both ends of the cell of a node.
  std::array<const SectionFace*, 2> faces(const Node& n) const {
    const auto& all = drawn_[n.beam];
    return {&all[all.size() > 1 ? n.cell : 0], &all[all.size() > 1 ? n.cell + 1 : 0]};
  }
  using Poses = std::map<std::string, Pose>;
  Poses poses(const RunFile::Field& own, size_t row) const;
  std::vector<Vec3> positions(const Poses& poses) const;
  std::vector<double> stress(const std::string& name, size_t row) const;

  size_t first_node_, first_region_;
  std::int64_t n_cells_ = 0;
  std::vector<RunBeam> beams_;
  std::vector<std::vector<SectionFace>> drawn_;  // of the sections of each beam
  std::vector<Series> forces_;                   // of those that have a face
  std::vector<Node> nodes_;
  std::vector<Vec3> X_;
  std::vector<double> t_;  // of the histories
  std::map<std::string, Carrier> carriers_;
};

}  // namespace hilo
