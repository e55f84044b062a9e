// SPDX-License-Identifier: GPL-3.0-or-later
// What moves: nodes, bodies and the modes of linear regions, which node follows which body, and the blocks of unknowns of all of them.
//
// Unknowns are 3 x 3 blocks: one per free node, two per free body (translation, rotation vector), and the multipliers of constraint rows
// behind them.  A body's twelve coordinates are condensed to six by the null space of its length constraints, P = [I, -skew(x - c)], taken
// at the left configuration for the equations and at q1 for the increments [betsch-leyendecker-2006]; lengths then hold by construction.
// A linear region is a body, its mean axes, whose nodes follow modes besides: in the coordinates Q = (c, R e_k, Y_j e_k), Y_j = eta_j R,
// its mass is constant and every node is linear, as a rigid body's are.  The null space of its products has besides the rows of a body
//   mode j:  dY_j = R^ d eta_j,   R^ = (R_left)^-T, the directors themselves where they are orthonormal,
// and with the mean of Q in the rotations Q1 - Q0 = P_mid (u, theta, eta1 - eta0) exactly and P holds the rigid motions of Q_mid: energy
// and both momenta are kept (docs/design.md).
#pragma once
#include <array>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "model/local_mesh.hpp"
#include "system/layout.hpp"
#include "system/stage.hpp"

namespace hilo {

/// Left and right maps of a node: identity for a free node, lever arms for a follower, and what modes move it by where there are some.
struct NodeMap {
  int slot;  // first row block within the clique's unknowns, -1 when driven
  bool follower;
  Vec3 left, right;              // arms from the body's centre
  int mode_slot = -1;            // first row block of the modes
  std::span<const Vec3> shapes;  // of its modes at the node, body axes
  Mat3 left_turn, right_turn;    // R^ and R
};

/// Modes of a linear region.
struct Modes {
  int body = -1;                // its mean axes
  int first = 0, n_blocks = 0;  // amplitudes in Config::eta, three to a block; those beyond n_modes stay zero
  int n_modes = 0;              //
  bool stiffens = false;        // with strains of the second degree (system/quadratic_strain.hpp)
  bool of_beams = false;        // and of no cells of a mesh
  int block = -1;               // of the amplitudes
  int clique = -1;              // of body and amplitudes, whose body has blocks -1 where it is driven
  std::vector<double> lever;    // metres that a unit of the amplitudes of a block is
  /// What to write in a scene where they do not serve.
  const char* better() const {
    return of_beams ? "fidelity = \"nonlinear\"" : stiffens ? "tag it nonlinear" : "stiffening = true, or tag it nonlinear";
  }
};

/// A kind of unknowns: things with a block of three each.  What solves and steps loops over these fields and names no node and no body.
struct UnknownField {
  enum class Update { add, turn };  // to a vector of a configuration; of the directors of a body, by the Cayley rotation of the block
  Update update = Update::add;
  std::vector<Vec3> Config::*array = nullptr;              // add: which vectors
  int first = 0, stride = 1;                               // blocks: first, first + stride, ...
  std::vector<int> item;                                   // entries of the array, or bodies
  std::vector<double> lever;                               // metres that a unit of the unknown is; empty: 1
  const std::vector<std::array<bool, 3>>* held = nullptr;  // components that move by a law, by item
  size_t size() const { return item.size(); }
  int block(size_t k) const { return first + stride * static_cast<int>(k); }
  double scale(size_t k) const { return lever.empty() ? 1 : lever[k]; }
  bool turns() const { return update == Update::turn; }
  std::array<bool, 3> held_of(size_t k) const { return held ? (*held)[item[k]] : std::array<bool, 3>{}; }
};

class Points {
 public:
  std::vector<Body> bodies;             // body 0 is the ground
  std::vector<int> follower;            // body each node follows, or -1  (n_nodes)
  std::vector<Modes> modes;             // of linear regions
  std::vector<int> modes_of;            // of a body, or -1       (n_bodies)
  std::vector<Vec3> shapes;             // of modes at nodes, body axes  [m]
  std::vector<std::int64_t> shape_row;  // where those of a node begin, -1: none  (n_nodes)
  std::vector<Vec3> X;                  // reference positions            (n_nodes)  [m]
  std::vector<char> node_owned;
  std::vector<std::array<bool, 3>> fixed;  // prescribed components of nodes
  Vec3 gravity = Vec3::Zero();
  double length = 1;     // size of the scene [m]
  double mass = 0;       // of everything [kg]
  double stiffness = 1;  // a typical one, for scaling without inertia [N/m]
  double same_time = 0;  // instants closer than this are one [s]
  Config start, start_velocity;
  const Comm* comm = nullptr;
  LocalMesh* mesh = nullptr;  // null for a scene of bodies alone

  // unknowns
  std::vector<int> node_block;         // block of each node, -1 for followers
  std::vector<int> body_block;         // first of two blocks, -1 for driven bodies
  std::vector<int> body_clique;        // of these two, -1 for driven bodies
  std::vector<UnknownField> unknowns;  // all of these
  Layout layout;
  int n_blocks() const { return layout.n_blocks(); }
  int first_joint_block() const { return layout.first_row; }  // multipliers begin here
  int n_joint_blocks() const { return static_cast<int>(layout.rows.size()); }

  /// Shapes of the modes at a node; none where it follows no linear region.
  std::span<const Vec3> shapes_at(int node) const {
    if (shape_row.empty() || shape_row[node] < 0) return {};
    return {shapes.data() + shape_row[node], static_cast<size_t>(3 * modes[modes_of[follower[node]]].n_blocks)};
  }
  /// q <- q moved by the increments z (3 x n_blocks); bodies turn by the Cayley rotation of theirs.
  void move(Config& q, std::span<const double> z) const;
  /// Velocities or accelerations v, at q, by the increments z; the largest change [m/s or m/s^2].
  double add_rates(Config& v, const Config& q, std::span<const double> z) const;
  /// Largest difference of a point of two poses, or of two velocities; a turn counts at the size of its body, or at `arm` where given.
  double largest_difference(const Config& a, const Config& b, double arm = 0) const;
  /// Largest velocity or acceleration of a point or of a director at the size of its body.
  double largest_rate(const Config& v) const;
  /// Whether a local block belongs to this rank: each to one.
  bool owns(int block) const {
    const std::int64_t k = layout.map.global[block] - layout.map.first;
    return k >= 0 && k < layout.map.n_owned;
  }
  /// Followers from their bodies and modes; the map is linear, so it holds for positions, velocities and accelerations alike.
  void follow(Config& q) const;
  /// Positions, velocities or accelerations of all nodes (n_nodes): a configuration holds the first of them, which something acts on or is
  /// asked for at every step.
  std::vector<Vec3> all_nodes(const Config& q) const;
  Vec3 at(const Config& q, int node) const { return static_cast<size_t>(node) < q.x.size() ? q.x[node] : followed(q, node); }
  /// The products of a pose, and then the followers.
  void place(Config& q) const;
  /// Zeros in the rows of prescribed components.
  void mask_fixed(std::span<double> r) const;
  /// A time on the given side of t, by which the laws are asked.
  double beside(double t, Side side) const { return t + static_cast<int>(side) * same_time; }
  /// Whether this rank counts what all ranks hold of a body.
  bool counts(int body) const { return body % comm->size == comm->rank; }

  /// Blocks of nodes, those of free nodes first, then those of the bodies that the others follow.
  std::vector<int> blocks_of(std::span<const int> nodes) const;
  void make_maps(std::span<const int> nodes, std::span<const int> blocks, const Stage& s, std::vector<NodeMap>& maps,
                 std::vector<std::array<bool, 3>>& masks) const;
  /// Lowest value of each node over the ranks that share it.
  void lowest_over_ranks(std::vector<std::int64_t>& value) const;

 private:
  Vec3 followed(const Config& q, size_t node) const;

 protected:
  /// The layout of what moves alone: local blocks of nodes, bodies and modes, the cliques of bodies, and the numbers over all ranks.
  /// Collective.
  Layout layout_of_points();

 private:
  std::pair<int, int> number_points(Cliques& cliques);
  BlockMap number_globally(int n_node_blocks, int n_local) const;
};

/// K (3n x 3n over nodes, row major) reduced to the unknowns of the clique's blocks (m blocks) and added to the solver.
/// Rows go through the left maps, columns through the right ones; prescribed components drop out.
void add_reduced(KktSolver& solver, int clique, int n, const double* K, const NodeMap* maps, int m, const std::array<bool, 3>* fixed);

}  // namespace hilo
