// SPDX-License-Identifier: GPL-3.0-or-later
// An approximate inverse made exact on the rigid motions of each connected flexible part [nabben-vuik-2008]:
//
//     M' = Q + (1 - Q F) M (1 - F Q),    Q = R (R^T F R)^-1 R^T,    so that  M' F R = R  and  R^T F M' = R^T.
//
// Where a part floats together with the bodies that hold it, its rigid motion costs next to no force: D p and C F^-1 B p cancel in the
// Schur complement.  Any error of M there would leave a large stiffness of the wrong sign.
#include <Eigen/Dense>
#include <algorithm>

#include "linear/petsc/interface.hpp"
#include "linear/petsc/solver.hpp"

namespace hilo::petsc {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

class Deflated final : public FlexibleInverse {
 public:
  Deflated(std::unique_ptr<FlexibleInverse> inner, const FlexibleMatrix& F, std::vector<double> positions, const std::vector<int>& part)
      : inner_(std::move(inner)), F_(F) {
    make_motions(positions, part);
  }

  bool set_up() override {
    if (!inner_->set_up()) return false;
    const auto n = R_.rows(), m = R_.cols();
    if (!v_.exists()) v_ = Vector(static_cast<PetscInt>(n)), w_ = Vector(static_cast<PetscInt>(n));
    FR_.resize(n, m), FtR_.resize(n, m);
    for (Eigen::Index k = 0; k < m; ++k) {  // of all parts at once: F does not join them
      {
        const Values v(v_);
        std::copy(R_.col(k).data(), R_.col(k).data() + n, v.data());
      }
      check(MatMult(F_.mat(), v_, w_));
      take(FR_.col(k));
      check(MatMultTranspose(F_.mat(), v_, w_));
      take(FtR_.col(k));
    }
    MatrixXd E = MatrixXd::Zero(6 * n_parts_, 6 * n_parts_);
    for (const Run& r : runs_)
      E.block<6, 6>(6 * r.part, 6 * r.part) += R_.middleRows(r.from, r.n).transpose() * FR_.middleRows(r.from, r.n);
    sum(E.data(), static_cast<int>(E.size()));
    scale_ = E.diagonal().cwiseAbs().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    E = (scale_.asDiagonal() * E * scale_.asDiagonal()).eval();
    E_.setThreshold(1e-12);
    E_.compute(E);
    return E.allFinite();
  }

  void apply(Eigen::Ref<MatrixXd> X) override {
    MatrixXd c = solve(along(R_, X));
    add(FR_, -c, X);
    inner_->apply(X);
    c -= solve(along(FtR_, X));
    add(R_, c, X);
  }

  bool strengthen(int iterations, bool failed) override { return inner_->strengthen(iterations, failed); }
  bool varies() const override { return inner_->varies(); }
  bool has_failed() const override { return inner_->has_failed(); }
  int most_iterations() const override { return inner_->most_iterations(); }
  Within take_iterations() override { return inner_->take_iterations(); }
  double undivided_seconds() const override { return inner_->undivided_seconds(); }
  std::string name() const override { return inner_->name(); }
  double bytes() const override { return inner_->bytes() + 24. * static_cast<double>(R_.size()); }

 private:
  void make_motions(const std::vector<double>& X, const std::vector<int>& part) {
    const int n = static_cast<int>(part.size());
    int n_parts = 0;
    for (const int p : part) n_parts = std::max(n_parts, p + 1);
    n_parts_ = n_parts = static_cast<int>(comm().max(n_parts));
    R_ = MatrixXd::Zero(3 * n, 6);
    for (int i = 0; i < n; ++i) {
      if (runs_.empty() || runs_.back().part != part[i]) runs_.push_back({part[i], 3 * i, 0});
      runs_.back().n += 3;
    }
    MatrixXd centre = MatrixXd::Zero(4, n_parts);
    for (int i = 0; i < n; ++i) centre.col(part[i]) += Eigen::Vector4d(X[3 * i], X[3 * i + 1], X[3 * i + 2], 1);
    sum(centre.data(), static_cast<int>(centre.size()));
    VectorXd radius = VectorXd::Zero(n_parts);
    const auto arm = [&](int i) -> Eigen::Vector3d {
      return Eigen::Vector3d(X[3 * i], X[3 * i + 1], X[3 * i + 2]) - centre.col(part[i]).head<3>() / centre(3, part[i]);
    };
    for (int i = 0; i < n; ++i) radius[part[i]] = std::max(radius[part[i]], arm(i).norm());
    comm().max(std::span(radius.data(), static_cast<size_t>(n_parts)));
    for (int i = 0; i < n; ++i) {
      R_.block<3, 3>(3 * i, 0).setIdentity();
      if (!(radius[part[i]] > 0)) continue;
      const Eigen::Vector3d r = arm(i) / radius[part[i]];
      R_.block<3, 3>(3 * i, 3) << 0, r[2], -r[1], -r[2], 0, r[0], r[1], -r[0], 0;
    }
  }
  /// The sums of M^T X over each part, this rank's share.
  MatrixXd along(const MatrixXd& M, const Eigen::Ref<MatrixXd>& X) const {
    MatrixXd c = MatrixXd::Zero(6 * n_parts_, X.cols());
    for (const Run& r : runs_) c.middleRows<6>(6 * r.part).noalias() += M.middleRows(r.from, r.n).transpose() * X.middleRows(r.from, r.n);
    return c;
  }
  void add(const MatrixXd& M, const MatrixXd& c, Eigen::Ref<MatrixXd> X) const {
    for (const Run& r : runs_) X.middleRows(r.from, r.n).noalias() += M.middleRows(r.from, r.n) * c.middleRows<6>(6 * r.part);
  }
  template <class Column>
  void take(Column&& to) {
    const Values w(w_);
    std::copy(w.data(), w.data() + to.size(), to.data());
  }
  static void sum(double* values, int n) {
    if (n > 0) comm().sum({values, static_cast<size_t>(n)});
  }
  /// E^-1 of what the ranks sum to; motions that cost nothing are left out.
  MatrixXd solve(MatrixXd share) const {
    sum(share.data(), static_cast<int>(share.size()));
    return scale_.asDiagonal() * E_.solve(scale_.asDiagonal() * share);
  }

  std::unique_ptr<FlexibleInverse> inner_;
  const FlexibleMatrix& F_;
  struct Run {  // owned unknowns of one part that follow each other
    int part;
    Eigen::Index from, n;
  };
  std::vector<Run> runs_;
  int n_parts_ = 0;
  MatrixXd R_, FR_, FtR_;  // (owned unknowns x 6): each of the motions of its part
  VectorXd scale_;
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> E_;
  Vector v_, w_;
};

}  // namespace

std::unique_ptr<FlexibleInverse> make_deflated(std::unique_ptr<FlexibleInverse> inner, const SubdomainMatrix& F,
                                               std::vector<double> positions) {
  const auto part = connected_parts(F);
  return std::make_unique<Deflated>(std::move(inner), F, std::move(positions), part);
}

}  // namespace hilo::petsc
