#include "system/region_cells.hpp"

namespace hilo {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using CellMatrix = Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>;

void gather(const MatrixXd& V, std::span<const int> nodes, MatrixXd& local) {
  local.resize(static_cast<Index>(3 * nodes.size()), V.cols());
  for (size_t a = 0; a < nodes.size(); ++a) local.middleRows(3 * static_cast<Index>(a), 3) = V.middleRows(3 * nodes[a], 3);
}

}  // namespace

MatrixXd RegionCells::times(Kind kind, const MatrixXd& V, const VectorXd* u) const {
  MatrixXd out = MatrixXd::Zero(V.rows(), V.cols()), local, product;
  each(
      kind,
      [&](std::span<const int> nodes, const double* Ke) {
        gather(V, nodes, local);
        product.noalias() = CellMatrix(Ke, local.rows(), local.rows()) * local;
        for (size_t a = 0; a < nodes.size(); ++a) out.middleRows(3 * nodes[a], 3) += product.middleRows(3 * static_cast<Index>(a), 3);
      },
      u);
  return out;
}

MatrixXd RegionCells::projected_stiffness(const MatrixXd& V, const VectorXd& u) const {
  MatrixXd out = MatrixXd::Zero(V.cols(), V.cols()), local, product;
  each(
      stiffness,
      [&](std::span<const int> nodes, const double* Ke) {
        gather(V, nodes, local);
        product.noalias() = CellMatrix(Ke, local.rows(), local.rows()) * local;
        out.noalias() += local.transpose() * product;
      },
      &u);
  return out;
}

}  // namespace hilo
