// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/reduction/region_cells.hpp"

namespace hilo {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using CellMatrix = Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>;

void gather(const MatrixXd& V, std::span<const int> nodes, MatrixXd& local) {
  local.resize(static_cast<Index>(3 * nodes.size()), V.cols());
  for (size_t a = 0; a < nodes.size(); ++a) local.middleRows(3 * static_cast<Index>(a), 3) = V.middleRows(3 * nodes[a], 3);
}

}  // namespace

RegionCells::Scalar RegionCells::scalar(Kind kind) const {
  const auto n = static_cast<Index>(X_.size());
  std::vector<Eigen::Triplet<double>> entries;
  each(kind, [&](std::span<const int> nodes, const double* Me) {
    const size_t n3 = 3 * nodes.size();
    for (size_t a = 0; a < nodes.size(); ++a)
      for (size_t b = 0; b < nodes.size(); ++b) entries.emplace_back(nodes[a], nodes[b], Me[3 * a * n3 + 3 * b]);
  });
  Scalar out(n, n);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

MatrixXd RegionCells::times_mass(const MatrixXd& V) const {
  using Nodal = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
  MatrixXd out(V.rows(), V.cols());
  for (Index k = 0; k < V.cols(); ++k)
    Eigen::Map<Nodal>(out.col(k).data(), mass_.rows(), 3).noalias() = mass_ * Eigen::Map<const Nodal>(V.col(k).data(), mass_.rows(), 3);
  return out;
}

MatrixXd RegionCells::times(Kind kind, const MatrixXd& V, const VectorXd* u) const {
  MatrixXd out = MatrixXd::Zero(V.rows(), V.cols()), local, product;
  const auto add = [&](std::span<const int> nodes) {
    for (size_t a = 0; a < nodes.size(); ++a) out.middleRows(3 * nodes[a], 3) += product.middleRows(3 * static_cast<Index>(a), 3);
  };
  each_solid(
      kind,
      [&](std::span<const int> nodes, const double* Ke) {
        gather(V, nodes, local);
        product.noalias() = CellMatrix(Ke, local.rows(), local.rows()) * local;
        add(nodes);
      },
      u);
  for (const PointCell& c : points_) {  // by their strains
    gather(V, c.nodes, local);
    product.noalias() = (kind == damping_by_stiffness ? c.beta : 1) * c.strains.transpose() * (c.strains * local).eval();
    add(c.nodes);
  }
  return out;
}

MatrixXd RegionCells::projected(Kind kind, const MatrixXd& V, const VectorXd& u) const {
  MatrixXd out = MatrixXd::Zero(V.cols(), V.cols()), local, product;
  each(
      kind,
      [&](std::span<const int> nodes, const double* Ke) {
        gather(V, nodes, local);
        product.noalias() = CellMatrix(Ke, local.rows(), local.rows()) * local;
        out.noalias() += local.transpose() * product;
      },
      &u);
  return out;
}

}  // namespace hilo
