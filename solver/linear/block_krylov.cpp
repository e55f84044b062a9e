// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/block_krylov.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include "linear/products.hpp"

namespace hilo {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Ritz pairs by falling |nu|, and how far each is from an eigenpair.
struct Ritz {
  Vector nu, residual;
  Matrix y;
};

class Krylov {
 public:
  explicit Krylov(const Pencil& pencil) : pencil_(pencil) {}

  /// Vectors of which nothing is known but that they are in the subspace.
  Matrix fresh() {
    constexpr Index width = 6;  // free rigid motions come by six
    std::normal_distribution<double> normal;
    Matrix W(pencil_.n, width);
    for (double& value : W.reshaped()) value = normal(random_);
    return pencil_.solve(pencil_.mass(W));
  }

  /// What of W is beside the basis joins it; W^T M W of that part.
  Matrix extend(Matrix W) { return extend(W, pencil_.mass(W)); }
  Matrix extend(Matrix W, Matrix MW) {
    const auto product = [&] { return Matrix((W.transpose() * MW + MW.transpose() * W) / 2); };
    const Vector before = product().diagonal();
    take_basis_from(W, MW);
    const Matrix G = product();
    // by unit columns, so that small ones count; directions that are rounding of what was taken away do not
    Vector unit(W.cols());
    for (Index j = 0; j < W.cols(); ++j) unit[j] = G(j, j) > 1e-14 * before[j] && before[j] > 0 ? 1 / std::sqrt(G(j, j)) : 0;
    const Eigen::SelfAdjointEigenSolver<Matrix> gram(unit.asDiagonal() * G * unit.asDiagonal());
    const Vector& g = gram.eigenvalues();
    Index skip = 0;
    while (skip < g.size() && !(g[skip] > 1e-10)) ++skip;
    const Index k = V_.cols();
    const auto take = [&](const Eigen::SelfAdjointEigenSolver<Matrix>& of, const Vector& scale, Index n) {
      const Matrix turn =
          scale.asDiagonal() * of.eigenvectors().rightCols(n) * of.eigenvalues().tail(n).cwiseSqrt().cwiseInverse().asDiagonal();
      W = (W * turn).eval(), MW = (MW * turn).eval();
      take_basis_from(W, MW);  // what is kept of a small rest has lost digits
    };
    if (skip == g.size()) return G;
    take(gram, unit, g.size() - skip);
    // what then lies in the basis again was rounding: of a space that is all but exhausted nothing else is left
    const Eigen::SelfAdjointEigenSolver<Matrix> again(product());
    const Index kept = (again.eigenvalues().array() > 0.5).count();
    if (kept == 0) return G;
    take(again, Vector::Ones(W.cols()), kept);
    const Index unseen = M_unseen_.cols();
    V_.conservativeResize(pencil_.n, k + kept), M_unseen_.conservativeResize(pencil_.n, unseen + kept);
    V_.rightCols(kept) = W, M_unseen_.rightCols(kept) = MW;
    return G;
  }

  /// The inverse on the columns of the basis that it has not seen, which then joins it; as `extend`.
  Matrix apply() {
    const Index first = T_.cols(), k = V_.cols();
    Matrix W = pencil_.solve(M_unseen_), MW = pencil_.mass(W);
    M_unseen_.resize(pencil_.n, 0);
    const Matrix H = transposed_times(V_, MW), corner = H.bottomRows(W.cols());
    asymmetry_ = std::max(asymmetry_, (corner - corner.transpose()).norm());
    T_.conservativeResize(k, k);
    T_.rightCols(W.cols()) = H;
    T_.bottomLeftCorner(W.cols(), first) = H.topRows(first).transpose();
    T_.bottomRightCorner(W.cols(), W.cols()) = (corner + corner.transpose()) / 2;
    return extend(std::move(W), std::move(MW));
  }

  /// The best `wanted` pairs of the columns that the inverse has seen.  Images of all but the last of them lie in the basis; `rest`: W^T M
  /// W of what the images of these have beside it.  Of a space that is exhausted the pairs beyond are rounding: they are left out.
  Ritz ritz(Index wanted, const Matrix& rest) const {
    const Eigen::SelfAdjointEigenSolver<Matrix> all(T_);
    std::vector<Index> order(static_cast<size_t>(T_.cols()));
    std::iota(order.begin(), order.end(), 0);
    const auto size = [&](Index i) { return std::abs(all.eigenvalues()[i]); };
    std::sort(order.begin(), order.end(), [&](Index a, Index b) { return size(a) > size(b); });
    const double rounding = std::min(10 * asymmetry_, 1e-11 * size(order[0]));
    Index count = std::min(wanted, T_.cols());
    while (count > 1 && size(order[static_cast<size_t>(count) - 1]) < rounding) --count;
    Ritz out{Vector(count), Vector(count), Matrix(T_.cols(), count)};
    for (Index j = 0; j < count; ++j) {
      const Index i = order[static_cast<size_t>(j)];
      out.nu[j] = all.eigenvalues()[i], out.y.col(j) = all.eigenvectors().col(i);
      const auto last = out.y.col(j).tail(rest.cols());
      out.residual[j] = std::sqrt(std::max(0.0, last.dot(rest * last)));
    }
    return out;
  }

  Index size() const { return V_.cols(); }
  Matrix shapes(const Matrix& y) const { return V_.leftCols(y.rows()) * y; }
  double asymmetry() const { return asymmetry_; }

 private:
  /// Of M V the columns that the inverse has not seen alone are kept: all would be as large as the basis.
  void take_basis_from(Matrix& W, Matrix& MW) const {
    if (V_.cols() == 0) return;
    add_product(-1, V_, transposed_times(V_, MW), W);
    MW = pencil_.mass(W);
  }

  const Pencil& pencil_;
  Matrix V_, M_unseen_, T_;  // the basis, M of its last columns, and V^T M (K + s M)^-1 M V
  double asymmetry_ = 0;
  std::mt19937_64 random_{20041};  // the same modes in every run
};

}  // namespace

Eigenmodes lowest_modes(const Pencil& pencil, int wanted, double tolerance, bool doubt, const std::function<void(int)>& tell) {
  constexpr int further = 2;  // blocks that a doubt takes
  const Index most = 300 + 4 * static_cast<Index>(wanted);
  Krylov krylov(pencil);
  krylov.extend(krylov.fresh());
  Ritz ritz;
  Vector doubted;
  bool sure = krylov.size() == 0;  // nothing has mass
  for (int left = 0; !sure && krylov.size() <= most;) {
    const Index k = krylov.size();
    const Matrix rest = krylov.apply();
    ritz = krylov.ritz(wanted, rest);
    const bool exhausted = krylov.size() == k, are_all = exhausted || ritz.nu.size() < std::min<Index>(wanted, k);
    const auto good = exhausted ? ritz.nu.size() : ((ritz.residual.array() <= tolerance * ritz.nu.array().abs()).count());
    if (tell) tell(static_cast<int>(good));
    if (exhausted) left = 0;
    if (left > 0) --left;
    if (left > 0 || good < ritz.nu.size() || (!are_all && good < wanted)) continue;
    if (!doubt && !exhausted) {
      sure = true;
      break;
    }
    const bool same = doubted.size() == ritz.nu.size() && ((doubted - ritz.nu).array().abs() <= 1e-8 * ritz.nu.array().abs()).all();
    const Index before = krylov.size();
    if (!same) krylov.extend(krylov.fresh());
    sure = same || krylov.size() == before;
    if (exhausted && krylov.size() == k) sure = true;
    doubted = ritz.nu, left = further;
  }
  Eigenmodes out;
  out.converged = sure;
  out.asymmetry = ritz.nu.size() > 0 ? krylov.asymmetry() / ritz.nu.cwiseAbs().maxCoeff() : 0;
  if (ritz.nu.size() == 0) return out;
  Matrix shapes = krylov.shapes(ritz.y);
  Vector nu = ritz.nu;
  if (doubt) {  // a step of inverse iteration with all of them: what rounding has left outside of the subspace, where joints are open, goes
    const Matrix X = pencil.solve(pencil.mass(shapes * nu.cwiseInverse().asDiagonal())), MX = pencil.mass(X), Y = pencil.solve(MX);
    const Matrix G = X.transpose() * MX, H = MX.transpose() * Y;
    const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> pairs((H + H.transpose()) / 2, (G + G.transpose()) / 2);
    nu = pairs.eigenvalues(), shapes = X * pairs.eigenvectors();
    if (!nu.allFinite() || !shapes.allFinite()) {  // so many were wanted that rounding is among them
      out.converged = false;
      return out;
    }
  }
  std::vector<Index> order(static_cast<size_t>(nu.size()));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return 1 / nu[a] < 1 / nu[b]; });
  out.omega2.resize(nu.size()), out.shapes.resize(pencil.n, nu.size());
  for (size_t j = 0; j < order.size(); ++j) {
    const auto at = static_cast<Index>(j);
    out.omega2[at] = 1 / nu[order[j]] - pencil.shift;
    out.shapes.col(at) = shapes.col(order[j]);
  }
  return out;
}

}  // namespace hilo
