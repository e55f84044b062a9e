// SPDX-License-Identifier: GPL-3.0-or-later
// Stiffness and mass of the cells of a linear region.  The mass is kept; the stiffness is computed whenever it is asked for.
#pragma once
#include <Eigen/Dense>
#include <Eigen/SparseCore>

#include "system/reduction/point_cell.hpp"
#include "system/solids.hpp"

namespace hilo {

class RegionCells {
 public:
  /// Damping: beta times the stiffness, alpha times the mass.
  enum Kind { stiffness, mass, damping_by_stiffness, damping_by_mass };
  /// Cells over these nodes; all are kept by reference.
  RegionCells(const std::vector<Vec3>& X, const std::vector<SolidBatch>& cells, std::span<const PointCell> points)
      : X_(X), cells_(cells), points_(points), mass_(scalar(mass)) {}

  /// Visit nodes and matrix (3n x 3n, row major) of each cell; the stiffness is the slope of the force at the displacements u (3 n_nodes),
  /// or at rest.  The damping at u is that of the rate of strain there, int B(u)^T beta C B(u) dV.
  template <class Visit>
  void each(Kind kind, const Visit& visit, const Eigen::VectorXd* u = nullptr) const {
    each_solid(kind, visit, u);
    const bool of_mass = kind == mass || kind == damping_by_mass;
    for (const PointCell& c : points_) {
      const double factor = kind == damping_by_stiffness ? c.beta : kind == damping_by_mass ? c.alpha : 1;
      Eigen::Matrix<double, 24, 24> K = Eigen::Matrix<double, 24, 24>::Zero();
      if (!of_mass) K = factor * c.strains.transpose() * c.strains;
      for (int a = 0; a < 8 && of_mass; ++a)
        for (int b = 0; b < 8; ++b) K.block<3, 3>(3 * a, 3 * b).diagonal().setConstant(factor * c.mass(a, b));
      visit(std::span<const int>(c.nodes), K.data());
    }
  }
  template <class Visit>
  void each_solid(Kind kind, const Visit& visit, const Eigen::VectorXd* u = nullptr) const {
    const bool of_mass = kind == mass || kind == damping_by_mass;
    struct alignas(64) Line {  // as the widest kernels load them
      double value[8] = {};
    };
    std::vector<Line> scratch;
    std::vector<double> Ke;
    for (const SolidBatch& b : cells_) {
      const StVenantKirchhoff no_matter{{1, 1}};
      const SolidKernel kernel = of_mass ? solid_kernel(b.shape, place_of<StVenantKirchhoff>) : b.kernel;
      const int n = info(b.shape).n_nodes, W = kernel.width, n3 = 3 * n, count = static_cast<int>(b.nodes.size()) / n;
      const double factor = kind == damping_by_stiffness ? b.beta : kind == damping_by_mass ? b.alpha : 1;
      const bool of_rate = kind == damping_by_stiffness && u;
      const auto lines = [](size_t doubles) { return (doubles + 7) / 8; };
      const size_t vector = lines(static_cast<size_t>(n3) * W), matrix = lines(static_cast<size_t>(n3) * n3 * W);
      scratch.assign(4 * vector + matrix + lines(static_cast<size_t>(kernel.n_state) * W), {});
      double *X = scratch[0].value, *x = X + 8 * vector, *zero = x + 8 * vector, *f = zero + 8 * vector, *K = f + 8 * vector;
      Ke.resize(static_cast<size_t>(n3) * n3);
      KernelCall call{X,
                      x,
                      x,
                      of_mass || of_rate ? 0.0 : 1.0,
                      of_rate ? 1.0 : 0.0,
                      of_mass ? &no_matter : parameters(b.material),
                      f,
                      K,
                      nullptr,
                      nullptr,
                      nullptr};
      call.density = b.density, call.area = b.area, call.weight = 1;
      if (of_mass) call.a = zero, call.mass_slope = 1;
      call.h0 = K + 8 * matrix;
      for (int first = 0; first < count; first += W) {
        for (int l = 0; l < W; ++l)
          for (int i = 0; i < n3; ++i) {
            const int node = b.nodes[static_cast<size_t>(std::min(first + l, count - 1)) * n + i / 3];
            const size_t at = static_cast<size_t>(i) * W + l;
            X[at] = X_[node][i % 3], x[at] = X[at] + (u ? (*u)[3 * node + i % 3] : 0);
          }
        kernel.call(call);
        for (int l = 0; l < W && first + l < count; ++l) {
          for (size_t i = 0; i < Ke.size(); ++i) Ke[i] = factor * K[i * W + l];
          visit(std::span<const int>(b.nodes.data() + static_cast<size_t>(first + l) * n, static_cast<size_t>(n)), Ke.data());
        }
      }
    }
  }
  /// A mass matrix, the same in every direction (n_nodes x n_nodes).
  using Scalar = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  Scalar scalar(Kind kind) const;
  const Scalar& scalar_mass() const { return mass_; }
  /// Mass times vectors over all nodes (3 n_nodes x k).
  Eigen::MatrixXd times_mass(const Eigen::MatrixXd& V) const;
  /// Matrix times vectors over all nodes (3 n_nodes x k).
  Eigen::MatrixXd times(Kind kind, const Eigen::MatrixXd& V, const Eigen::VectorXd* u = nullptr) const;
  /// V^T K(u) V (k x k), or of the damping by stiffness.
  Eigen::MatrixXd projected(Kind kind, const Eigen::MatrixXd& V, const Eigen::VectorXd& u) const;

 private:
  const std::vector<Vec3>& X_;
  const std::vector<SolidBatch>& cells_;
  std::span<const PointCell> points_;
  Scalar mass_;
};

}  // namespace hilo
