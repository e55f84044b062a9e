// SPDX-License-Identifier: GPL-3.0-or-later
// Topology of a Skin: drawn points as combinations of nodes, polygons, smooth patches and edges.
#pragma once
#include <array>
#include <span>
#include <unordered_map>
#include <vector>

#include "model/mesh.hpp"
#include "post/surface/cut.hpp"

namespace hilo {

struct SkinBuilder {
  /// What `cut` takes away is left out, and the section through `cells` closes the rest.
  SkinBuilder(const Mesh& mesh, std::span<const Facet> facets, std::span<const std::int64_t> bars, const Plane* cut = nullptr,
              std::span<const std::int64_t> cells = {});

  std::vector<std::int64_t> first{0}, node;  // combination of each point
  std::vector<double> weight;
  std::vector<std::int64_t> corner, polygon{0};                                   // points, then vertices, of the polygons
  std::vector<std::int64_t> face_cell, bar_cell;                                  // cell of each polygon and bar
  std::vector<std::int64_t> vertex_point;                                         // point of each vertex
  std::vector<std::array<std::int64_t, 2>> feature_edges, facet_edges, bar_ends;  // pairs of points

  double length(const std::array<std::int64_t, 2>& edge) const {
    return (position_[static_cast<size_t>(edge[1])] - position_[static_cast<size_t>(edge[0])]).norm();
  }

 private:
  struct PairHash {
    size_t operator()(const std::array<std::int64_t, 3>& k) const {
      return static_cast<size_t>(k[0]) * 0x9E3779B97F4A7C15ull ^ static_cast<size_t>(k[1]) * 0xC2B2AE3D27D4EB4Full ^
             static_cast<size_t>(k[2]);
    }
  };
  std::int64_t point_of_node(std::int64_t n);
  std::int64_t new_point(std::span<const std::int64_t> nodes, std::span<const double> weights);
  void add_linear(std::span<const std::int64_t> nodes, std::int64_t cell);
  void add_quadratic(std::span<const std::int64_t> nodes, int n_corners, std::int64_t cell);
  std::int64_t edge_point(std::span<const std::int64_t> nodes, std::span<const double> weights, std::int64_t a, std::int64_t b,
                          int quarter);
  void add_polygon(std::span<const std::int64_t> points, std::int64_t cell);
  void keep_polygon(std::span<const std::int64_t> points, std::int64_t cell);
  // skin_cut.cpp
  double depth(const Vec3& x) const;  // behind the plane below 0; 0 very near to it
  std::int64_t between(std::int64_t p, std::int64_t q);
  std::int64_t piece_point(std::span<const std::int64_t> nodes, const std::vector<double>& weights);
  void add_clipped(std::span<const std::int64_t> points, std::int64_t cell);
  void clip_edges(std::vector<std::array<std::int64_t, 2>>& edges, std::vector<std::int64_t>* cells = nullptr);
  void add_section(std::span<const std::int64_t> cells);
  void split_at_sharp_edges();
  void find_feature_edges();
  Vec3 normal(size_t face) const;

  const Mesh& mesh_;
  std::vector<std::int64_t> node_point_;                                             // point of a node or -1
  std::unordered_map<std::array<std::int64_t, 3>, std::int64_t, PairHash> on_edge_;  // points between nodes, by edge and quarter
  std::vector<Vec3> position_;                                                       // of the points at the start
  const Plane* cut_;
  double near_ = 0;                                              // to the plane is on it  [m]
  std::unordered_map<std::uint64_t, std::int64_t> piece_point_;  // by a hash of nodes and weights
};

}  // namespace hilo
