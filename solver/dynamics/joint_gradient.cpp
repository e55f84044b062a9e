#include "dynamics/joint_gradient.hpp"

#include "physics/rolling.hpp"

namespace hilo {

std::vector<int> joint_blocks(const System& s, const Connector& joint) {
  std::vector<int> blocks;
  for (const Carrier& end : joint.ends()) {
    const int first = end.body >= 0 ? s.body_block[end.body] : s.node_block[end.node];
    for (int k = 0; first >= 0 && k < (end.body >= 0 ? 2 : 1); ++k) blocks.push_back(first + k);
  }
  return blocks;
}

DenseRows joint_rows(const System& s, const Joint& c, const Stage& stage) {
  ConnectorGradient g;
  RowLaw::Gradient law;
  gradient(c, *stage.left, g);
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
    if ((end.body >= 0 ? s.body_block[end.body] : s.node_block[end.node]) < 0) continue;
    out.middleCols<3>(used) = out.middleCols<3>(6 * k).eval(), used += 3;
    if (end.body >= 0) out.middleCols<3>(used) = (out.middleCols<3>(6 * k + 3) / s.length).eval(), used += 3;
  }
  out.conservativeResize(Eigen::NoChange, used);
  return out;
}

}  // namespace hilo
