// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of a joint, seen one by one.
#include "physics/rolling.hpp"
#include "system/joints.hpp"

namespace hilo {
namespace {

class JointConstraint final : public Constraint {
 public:
  JointConstraint(const Points& points, Joints& joints, size_t j) : points_(points), joints_(joints), j_(j) {}
  std::string_view section() const override { return j_ < joints_.n_told() ? "joint" : "the bond of"; }
  const std::string& name() const override { return joint().name; }
  int n_rows() const override { return joint().n_rows(); }
  int n_position_rows() const override { return joint().n_position_rows(); }
  int row() const override { return joints_.row(j_); }
  const Active& active() const override { return joint().active; }
  void set_active(const Active& rows) override { joints_.list[j_].active = rows; }
  const Drive* drive() const override { return joint().drive.row >= 0 ? &joint().drive : nullptr; }
  std::vector<int> blocks() const override {
    std::vector<int> out = blocks_of_ends(points_, joint());
    std::erase_if(out, [](int block) { return block < 0; });
    return out;
  }
  DenseRows gradient(const Stage& stage) const override;
  void gaps(const Config& q, double t, double factor, double* g) const override { hilo::gaps(joint(), q, t, factor, g); }
  bool has_no_past() const override { return !joint().rows; }
  std::string moved_by() const override {
    std::string out;
    for (const Carrier& end : joint().ends())
      if (end.body >= 0 && points_.bodies[end.body].held) out = points_.bodies[end.body].motion;
    return out;
  }

 private:
  const Joint& joint() const { return joints_.list[j_]; }
  const Points& points_;
  Joints& joints_;
  size_t j_;
};

DenseRows JointConstraint::gradient(const Stage& stage) const {
  const Joint& c = joint();
  ConnectorGradient g;
  RowLaw::Gradient law;
  hilo::gradient(c, *stage.left, g);
  if (c.rows) row_gradient(c, stage, g, law);
  DenseRows out(c.n_rows(), max_directions);
  const bool slips = c.n_rows() > c.n_position_rows();
  if (slips) out.bottomRows(c.n_rows() - c.n_position_rows()).setZero();
  for (int row = 0; row < c.n_position_rows(); ++row) {
    if (!c.rows) {
      out.row(row) = g.G.row(row);
    } else {
      out.row(row).setZero();
      for (size_t m = 0; m < c.measures.size(); ++m)
        if (law.d[row][m] != 0) out.row(row) += law.d[row][m] * g.G.row(m);
    }
  }
  if (slips)
    out.bottomRows(c.n_rows() - c.n_position_rows()).leftCols<12>() =
        Slip(c, *stage.left, nullptr).A.topRows(c.n_rows() - c.n_position_rows());  // of a, then of b
  int used = 0;                                                                     // columns of what cannot move drop out
  for (int k = 0; k < c.n_ends; ++k) {
    const Carrier& end = c.end[k];
    if ((end.body >= 0 ? points_.body_block[end.body] : points_.node_block[end.node]) < 0) continue;
    out.middleCols<3>(used) = out.middleCols<3>(6 * k).eval(), used += 3;
    if (end.body >= 0) out.middleCols<3>(used) = (out.middleCols<3>(6 * k + 3) / points_.length).eval(), used += 3;
  }
  out.conservativeResize(Eigen::NoChange, used);
  return out;
}

}  // namespace

void Joints::add_constraints(std::vector<std::unique_ptr<Constraint>>& out) {
  for (size_t j = 0; j < list.size(); ++j) out.push_back(std::make_unique<JointConstraint>(points_, *this, j));
}

}  // namespace hilo
