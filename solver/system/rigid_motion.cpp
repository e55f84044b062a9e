// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/rigid_motion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace hilo {

/// Inverse iteration with a shift far below what resists.
Motions null_vectors(const Eigen::SparseMatrix<double>& N) {
  const Eigen::Index n = N.rows(), width = std::min<Eigen::Index>(n, 24);
  double top = 1;
  for (Eigen::Index i = 0; i < n; ++i) top = std::max(top, N.coeff(i, i));
  Eigen::SparseMatrix<double> shift(n, n);
  shift.setIdentity();
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(N + 1e-9 * shift);
  if (factors.info() != Eigen::Success) return Motions(n, 0);
  Motions Z(n, width);
  for (Eigen::Index i = 0; i < Z.size(); ++i) Z.data()[i] = std::sin(12.9898 * static_cast<double>(i + 1));
  for (int pass = 0; pass < 4; ++pass) {
    if (pass > 0) Z = factors.solve(Z).eval();
    Z = (Eigen::HouseholderQR<Motions>(Z).householderQ() * Motions::Identity(n, width)).eval();
  }
  const Eigen::SelfAdjointEigenSolver<Motions> ritz(Z.transpose() * (N * Z));
  std::vector<Eigen::Index> null;
  for (Eigen::Index k = 0; k < width; ++k)
    if (std::abs(ritz.eigenvalues()[k]) < 1e-13 * top) null.push_back(k);
  return Z * ritz.eigenvectors()(Eigen::all, null);
}

Motions vanishing(const Motions& all, const Motions& part) {
  if (all.cols() == 0 || part.rows() == 0) return all;
  const Eigen::JacobiSVD<Motions> svd(part, Eigen::ComputeFullV);
  const double small = 1e-6 * std::max(1e-3, svd.singularValues().size() ? svd.singularValues()[0] : 0);
  Eigen::Index rank = 0;
  while (rank < svd.singularValues().size() && svd.singularValues()[rank] > small) ++rank;
  return all * svd.matrixV().rightCols(all.cols() - rank);
}

namespace {

/// The space of the columns, by rows of reduced echelon form: directions a reader recognises.
std::vector<Eigen::VectorXd> echelon(Motions A) {
  std::vector<Eigen::VectorXd> out;
  Eigen::Index first = 0;
  A.transposeInPlace();
  for (Eigen::Index column = 0; column < A.cols() && first < A.rows(); ++column) {
    Eigen::Index pivot;
    if (A.col(column).tail(A.rows() - first).cwiseAbs().maxCoeff(&pivot) < 1e-6) continue;
    A.row(first).swap(A.row(first + pivot));
    A.row(first) /= A(first, column);
    for (Eigen::Index i = 0; i < A.rows(); ++i)
      if (i != first) A.row(i) -= A(i, column) * A.row(first).eval();
    ++first;
  }
  for (Eigen::Index i = 0; i < first; ++i) out.push_back(A.row(i));
  return out;
}

std::string vector_text(const Vec3& v, double smallest) {
  const auto clean = [&](double x) { return std::abs(x) < smallest ? 0.0 : x; };
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", clean(v[0]), clean(v[1]), clean(v[2]));
}

}  // namespace

std::string told(const Motions& Z, const Part& part) {
  const Motions orthonormal = [&] {
    const Eigen::JacobiSVD<Motions> svd(Z, Eigen::ComputeThinU);
    Eigen::Index rank = 0;
    while (rank < svd.singularValues().size() && svd.singularValues()[rank] > 1e-6) ++rank;
    return Motions(svd.matrixU().leftCols(rank));
  }();
  if (orthonormal.cols() == 6) return "free to move and to turn in every direction";
  const Motions straight = vanishing(orthonormal, orthonormal.bottomRows(3));
  std::vector<std::string> ways;
  if (straight.cols() == 3) ways.emplace_back("move in every direction");
  if (straight.cols() < 3)
    for (const Eigen::VectorXd& v : echelon(straight.topRows(3))) ways.push_back("move along " + vector_text(v.normalized(), 1e-6));
  // turns: what is left, without the translations that are free by themselves
  const Motions turns = orthonormal - straight * (straight.transpose() * orthonormal);
  Motions swapped(6, turns.cols());
  swapped << turns.bottomRows(3), turns.topRows(3);  // w first, so that the echelon form is of the axes
  if (turns.cols() > straight.cols())
    for (const Eigen::VectorXd& m : echelon(swapped)) {
      const Vec3 w = m.head<3>() / part.length, v = m.tail<3>(), axis = w.normalized();
      const double pitch = v.dot(axis) / w.norm();
      ways.push_back(fmt::format("turn about {} through {}{}", vector_text(axis, 1e-6),
                                 vector_text(part.centre + w.cross(v) / w.squaredNorm(), 1e-6 * part.length),
                                 std::abs(pitch) > 1e-6 * part.length ? fmt::format(" and {:.4g} m/rad along it", pitch) : ""));
    }
  return fmt::format("free to {}", fmt::join(ways, " and to "));
}

}  // namespace hilo
