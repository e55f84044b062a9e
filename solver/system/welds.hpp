// SPDX-License-Identifier: GPL-3.0-or-later
// Six rows, or up to twelve, between a linear region and a body: the mean motion of some of its nodes is that of the body, which may be a
// patch that joints hold, a rigid neighbour, or what another linear region shares with it.
//
// The nodes' mean is a point y = c + R r + sum_j Y_j u_j of the region.  Their mean turn T is that of least squares, min sum |x_i - y - T
// r_i|^2, where T^T sum x_i r_i^T is symmetric.  Along the principal axes e_i of the nodes, with d_i = sum_k x_k (r_k.e_i) over sum |r|^2,
//   d_i = s_i R e_i + sum_j Y_j g_ji,     t_i = T e_i,     s_i the shares of the axes in sum |r|^2,   the rows are
//   y - y_B = 0,      (t_a.d_b - t_b.d_a)/(s_a + s_b) = 0 for (a, b) = (1, 2), (2, 3), (3, 1)
// and where the region stiffens, so that a face that turns far stays as it is,
//   (d_a.d_b/(s_a s_b) - delta_ab)/2 = 0 for the axes that the nodes have an extent along,
// of degree two in all coordinates: gradients at the mid-point are difference quotients, and the rows neither work nor turn.
//
// The nodes of a plate at a fold may lie on a line, e_3.  Their turn about it is none of the plate's: the row of (1, 2) is left out.  A
// solid's single node at a hinge has none of the three.
#pragma once
#include "system/contribution.hpp"

namespace hilo {

struct Weld {
  std::string name;                            // of the set, or of the body
  int modes = -1;                              // of Points::modes
  int body = -1;                               // it is welded to
  bool of_block = false;                       // made of nodes that move as one, which may lie on a line,
  bool yields = false;                         // with a body that is of such nodes alone, held by cells and nothing else
  int left_out = 0;                            // of the rows of turns, the first: 1 on a line, 3 of a single node
  Vec3 at = Vec3::Zero();                      // the mean of the nodes, reference position [m]
  std::vector<int> nodes;                      // local ones
  Mat3 axes = Mat3::Identity();                // e_i, columns
  Vec3 share = Vec3::Constant(0.5);            // s_i
  std::vector<std::pair<int, int>> stretches;  // (a, b) of the rows that keep lengths and angles
  std::vector<Vec3> mean;                      // u_j    (3 n_blocks)       [m]
  std::vector<Mat3> stretch;                   // g_ji, columns (3 n_blocks) [1]

  /// With those that are left out.
  int n_rows() const { return 6 + static_cast<int>(stretches.size()); }
  int n_blocks() const { return (n_rows() + 2) / 3; }
  /// Turn of the nodes in linear theory [rad].
  Vec3 turn(const Modes& m, const Config& q) const;
};

class Welds final : public Contribution, public Equations, public Constraining, public Stateful {
 public:
  explicit Welds(const Points& points) : points_(points) {}
  std::vector<Weld> list;  // on all ranks the same

  Traits traits() const override { return {.constrains = !list.empty()}; }
  void number(Layout& layout) override;
  std::string owner(int block) const override;
  void evaluate(Pass& p) const override;
  void look_at_rows(const Config& q, double t, double factor, Violation& worst) const override;
  void add_row_rates(const Rates& at, std::vector<double>& rate, std::vector<double>* acceleration) const override;
  void mark_rows(std::vector<char>& on) const override;
  void commit(const Config& q, const Config* v) override;
  void archive(Archive& a) override { a("welds", told_); }
  void tie(Ties& ties) const override;
  /// The rows of a weld over the unknowns of its region (translation, turn, amplitudes) and of its body (translation, turn).
  Eigen::MatrixXd gradient(const Weld& w, const Config& q) const;

 private:
  /// Vectors that a weld speaks of, at a configuration: y and d_i of the region, y and t_i of the body, with their arms.
  struct Place {
    Vec3 y, d[3], y_body, t[3];
  };
  Place place(const Weld& w, const Config& q) const;
  std::vector<double> values(const Weld& w, const Config& q) const;
  const Points& points_;
  std::vector<int> block_, clique_;
  std::vector<char> told_;  // by weld: that it turns too far for what its strains are
};

}  // namespace hilo
