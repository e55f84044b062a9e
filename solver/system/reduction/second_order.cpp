// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/reduction/second_order.hpp"

#include "linear/products.hpp"
#include "physics/cell_gradients.hpp"

namespace hilo {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;
using ByRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr Index n_lowest = 8, most_soft = 24;
constexpr Index run_of_points = 64;

/// Softest first, in modes: what the interfaces do and the lowest modes.
Matrix softest(const Matrix& modes, const Vector& omega2, const Matrix& interfaces) {
  const Index m = omega2.size(), lowest = std::min(m, n_lowest);
  Matrix V = Matrix::Zero(m, interfaces.cols() + lowest);
  V.leftCols(interfaces.cols()) = transposed_times(modes, interfaces);
  V.rightCols(lowest).topRows(lowest).setIdentity();
  for (Index k = 0; k < V.cols(); ++k)
    if (const double norm = V.col(k).norm(); norm > 0) V.col(k) /= norm;
  if (V.cols() == 0) return V;
  const Matrix G = V.transpose() * V;
  const Eigen::SelfAdjointEigenSolver<Matrix> gram(G);
  Index skip = 0;
  while (skip < V.cols() && gram.eigenvalues()[skip] < 1e-9 * gram.eigenvalues()[V.cols() - 1]) ++skip;
  const Index n = V.cols() - skip;
  V = (V * gram.eigenvectors().rightCols(n) * gram.eigenvalues().tail(n).cwiseSqrt().cwiseInverse().asDiagonal()).eval();
  const Eigen::SelfAdjointEigenSolver<Matrix> stiffness(V.transpose() * omega2.asDiagonal() * V);
  return V * stiffness.eigenvectors().leftCols(std::min(n, most_soft));
}

void gather(const ByRows& V, std::span<const int> nodes, Matrix& local) {
  local.resize(static_cast<Index>(3 * nodes.size()), V.cols());
  for (size_t a = 0; a < nodes.size(); ++a) local.middleRows(3 * static_cast<Index>(a), 3) = V.middleRows(3 * nodes[a], 3);
}

/// Gradients of the columns of `local` at a point: entry 3 i + j is du_i/dX_j   (9 x columns).
void gradients(const Matrix& local, const Vec3* dN, Eigen::Ref<Matrix> H) {
  H.setZero();
  for (Index a = 0; 3 * a < local.rows(); ++a)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) H.row(3 * i + j) += dN[a][j] * local.row(3 * a + i);
}

}  // namespace

SecondOrder second_order(const ReductionInput& in, const Matrix& modes, const Vector& omega2, const Matrix& interfaces) {
  SecondOrder out;
  out.soft = softest(modes, omega2, interfaces);
  const Index m = omega2.size(), n = 3 + out.soft.cols(), n_pairs = n * (n + 1) / 2;
  out.forces = Matrix::Zero(m + 1, n_pairs);
  const ByRows all = modes, soft = product(modes, out.soft);
  Matrix stress(6 * run_of_points, m + 1), products(6 * run_of_points, n_pairs), local, soft_local, H(9, m), Hs(9, n);
  for (int k = 0; k < 3; ++k) {
    const Mat3 turn = skew(Vec3::Unit(k));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) Hs(3 * i + j, k) = turn(i, j);
  }
  Index filled = 0;
  double volume = 0;
  const auto add = [&] {
    const int rows = static_cast<int>(6 * filled), stride = static_cast<int>(6 * run_of_points), columns = static_cast<int>(m + 1);
    if (rows > 0)
      lapack::multiply('T', rows, columns, 1., stress.data(), stride, products.data(), stride, 1., out.forces.data(), columns,
                       static_cast<int>(n_pairs));
    filled = 0;
  };
  const auto add_products = [&](Index point) {
    double* row = products.data() + 6 * point;
    for (Index j = 0; j < n; ++j)
      for (Index i = 0; i <= j; ++i, row += products.rows()) {
        const Eigen::Map<const Mat3> Hi(Hs.col(i).data()), Hj(Hs.col(j).data());  // as transposed: columns are u_i,*
        const Mat3 G = Hi * Hj.transpose();                                       // sum_k u_k,a w_k,b
        for (int c = 0; c < 3; ++c) row[c] = G(c, c), row[3 + c] = G((c + 1) % 3, (c + 2) % 3) + G((c + 2) % 3, (c + 1) % 3);
      }
  };
  CellGradients at;
  std::vector<Vec3> X;
  for (const SolidBatch& b : in.cells) {
    const Eigen::Matrix<double, 6, 6> C = moduli_at_rest(b.material);
    const auto nodes_of_cell = static_cast<size_t>(info(b.shape).n_nodes);
    for (size_t first = 0; first < b.nodes.size(); first += nodes_of_cell) {
      const std::span<const int> nodes(b.nodes.data() + first, nodes_of_cell);
      X.clear();
      for (const int i : nodes) X.push_back(in.X[i]);
      cell_gradients(b.shape, b.material, X, at);
      gather(all, nodes, local), gather(soft, nodes, soft_local);
      for (size_t p = 0; p < at.volume.size(); ++p) {
        gradients(local, at.dN.data() + p * nodes_of_cell, H);
        gradients(soft_local, at.dN.data() + p * nodes_of_cell, Hs.rightCols(n - 3));
        Eigen::Matrix<double, 6, Eigen::Dynamic> strain(6, m);
        for (int i = 0; i < 3; ++i) {
          const int j = (i + 1) % 3, k = (i + 2) % 3;
          strain.row(i) = H.row(4 * i), strain.row(3 + i) = H.row(3 * j + k) + H.row(3 * k + j);
        }
        auto S = stress.middleRows(6 * filled, 6);
        S.leftCols(m).noalias() = at.volume[p] * (C * strain);
        S.col(m) << at.volume[p], at.volume[p], at.volume[p], 0, 0, 0;
        volume += at.volume[p];
        add_products(filled);
        if (++filled == run_of_points) add();
      }
    }
  }
  for (const PointCell& c : in.points) {
    gather(all, c.nodes, local), gather(soft, c.nodes, soft_local);
    Hs.rightCols(n - 3) = c.gradient * soft_local;
    auto S = stress.middleRows(6 * filled, 6);
    S.leftCols(m) = c.stress * local;
    S.col(m) << c.length, c.length, c.length, 0, 0, 0;
    volume += c.length;
    add_products(filled);
    if (++filled == run_of_points) add();
  }
  add();
  if (volume > 0) out.forces.row(m) /= volume;
  return out;
}

}  // namespace hilo
