// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/reduction/reduction.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>
#include <utility>

#include "linear/block_krylov.hpp"
#include "linear/products.hpp"
#include "linear/shared_cholesky.hpp"
#include "system/reduction/face.hpp"
#include "system/reduction/flexibility.hpp"
#include "system/reduction/second_order.hpp"
#include "system/reduction/stiffening.hpp"

namespace hilo {

Eigen::MatrixXd smooth_functions(const std::vector<Vec3>& at) {
  constexpr int degree = 5;
  Eigen::AlignedBox3d box;
  for (const Vec3& x : at) box.extend(x);
  const auto n = static_cast<Eigen::Index>(at.size());
  Eigen::MatrixXd P(n, 56);
  for (Eigen::Index i = 0; i < n; ++i) {
    Eigen::Index column = 0;
    double T[3][degree + 1];  // Chebyshev polynomials over the box
    for (int k = 0; k < 3; ++k) {
      const double x = box.sizes()[k] > 0 ? 2 * (at[static_cast<size_t>(i)][k] - box.center()[k]) / box.sizes()[k] : 0;
      T[k][0] = 1, T[k][1] = x;
      for (int d = 2; d <= degree; ++d) T[k][d] = 2 * x * T[k][d - 1] - T[k][d - 2];
    }
    for (int a = 0; a <= degree; ++a)
      for (int b = 0; a + b <= degree; ++b)
        for (int c = 0; a + b + c <= degree; ++c) P(i, column++) = T[0][a] * T[1][b] * T[2][c];
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(P);
  qr.setThreshold(1e-6);
  return qr.householderQ() * Eigen::MatrixXd::Identity(n, qr.rank());
}
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

constexpr Index n_bending = 6;        // soft modes, lowest first, that derivatives are made of,
constexpr Index n_held = 4;           // and the vibrations between interfaces that they come from
constexpr Index most_stiffened = 60;  // modes of a region whose products are kept

Matrix rigid_motions(const std::vector<Vec3>& X, const Vec3& about) {
  Matrix out = Matrix::Zero(3 * static_cast<Index>(X.size()), 6);
  for (size_t i = 0; i < X.size(); ++i) {
    const auto at = 3 * static_cast<Index>(i);
    out.block<3, 3>(at, 0).setIdentity();
    out.block<3, 3>(at, 3) = -skew(Vec3(X[i] - about));
  }
  return out;
}

/// Motions of the interfaces, zero elsewhere, rigid ones first.
struct InterfaceMotions {
  Matrix columns;
  Index n_rigid = 0, n_first = 0;  // of all rigid interfaces, of the first; 0 where that moves with others
};

/// Axes that nodes can turn about: nodes on a line turn about the two across it alone, a single one about none.
std::vector<Vec3> turns_of(const Face& face) {
  if (face.is_point) return {};
  if (face.is_line()) return {face.axes.col(0), face.axes.col(1)};
  return {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
}

/// Many blocks of nodes along folds, each moved and turned as smooth functions of its place say.
void add_smooth_blocks(const ReductionInput& in, const std::vector<std::vector<int>>& sets, std::vector<Vector>& columns) {
  std::vector<Vec3> means;
  std::vector<Face> faces;
  double arm = 0;
  for (const auto& set : sets) {
    std::vector<Vec3> at;
    for (const int i : set) at.push_back(in.X[i]);
    means.push_back(std::accumulate(at.begin(), at.end(), Vec3(Vec3::Zero())) / static_cast<double>(at.size()));
    faces.emplace_back(at, means.back());
    for (const Vec3& x : at) arm = std::max(arm, (x - means.back()).norm());
  }
  const Matrix functions = smooth_functions(means);
  const auto rows = 3 * static_cast<Index>(in.X.size());
  for (Index j = 0; j < functions.cols(); ++j)
    for (int k = 0; k < 6; ++k) {
      Vector v = Vector::Zero(rows);
      for (size_t b = 0; b < sets.size(); ++b) {
        Vec3 turn = Vec3::Zero();
        if (k >= 3)
          for (const Vec3& axis : turns_of(faces[b])) turn += axis[k - 3] * axis;
        for (const int i : sets[b])
          v.segment<3>(3 * i) = functions(static_cast<Index>(b), j) * (k < 3 ? Vec3(Vec3::Unit(k)) : turn.cross(in.X[i] - means[b]));
      }
      if (k < 3 || v.norm() > 1e-6 * arm) columns.push_back(std::move(v));  // plates do not turn about their normal
    }
}

/// Where the region stiffens, rigid interfaces can be stretched too, as a linear map that turns them does (system/welds.hpp).
InterfaceMotions interface_motions(const ReductionInput& in) {
  const auto rows = 3 * static_cast<Index>(in.X.size());
  std::vector<Vector> columns;
  InterfaceMotions out;
  const std::set<std::vector<int>> blocks(in.blocks.begin(), in.blocks.end());
  std::vector<std::vector<int>> many;
  for (const auto& set : in.rigid)
    if (blocks.contains(set)) many.push_back(set);
  if (many.size() <= most_free / 2) many.clear();  // they turn too
  for (size_t k = 0; k < in.rigid.size(); ++k) {
    if (!many.empty() && blocks.contains(in.rigid[k])) continue;
    const auto& set = in.rigid[k];
    Vec3 mean = Vec3::Zero();
    for (const int i : set) mean += in.X[i] / static_cast<double>(set.size());
    std::vector<Vec3> at;
    for (const int i : set) at.push_back(in.X[i]);
    const Face face(at, mean);
    const auto add = [&](auto&& motion) {
      Vector v = Vector::Zero(rows);
      for (const int i : set) v.segment<3>(3 * i) = motion(Vec3(in.X[i] - mean));
      columns.push_back(std::move(v));
    };
    for (int c = 0; c < 3; ++c) add([&](const Vec3&) { return Vec3(Vec3::Unit(c)); });
    for (const Vec3& axis : turns_of(face)) add([&](const Vec3& r) { return Vec3(axis.cross(r)); });
    if (k == 0) out.n_first = static_cast<Index>(columns.size());
    if (!in.stiffening) continue;
    for (const auto& [a, b] : face.stretches) {
      const Mat3 E = face.axes.col(a) * face.axes.col(b).transpose();
      add([&](const Vec3& r) { return Vec3((E + E.transpose()) * r); });
    }
  }
  if (!many.empty()) add_smooth_blocks(in, many, columns);
  out.n_rigid = in.stiffening ? 6 * static_cast<Index>(in.rigid.size()) : static_cast<Index>(columns.size());
  std::vector<const std::vector<int>*> moved{&in.free};
  for (const auto& set : in.tied) moved.push_back(&set);
  for (const auto* set : moved) {
    std::vector<Vec3> free;
    for (const int i : *set) free.push_back(in.X[i]);
    const auto n_free = static_cast<Index>(free.size());
    const Matrix functions = free.size() > most_free ? smooth_functions(free) : Matrix::Identity(n_free, n_free);
    for (Index j = 0; j < functions.cols(); ++j)
      for (int k = 0; k < 3; ++k) {
        Vector v = Vector::Zero(rows);
        for (Index i = 0; i < n_free; ++i) v[3 * (*set)[i] + k] = functions(i, j);
        columns.push_back(std::move(v));
      }
  }
  out.columns.resize(rows, static_cast<Index>(columns.size()));
  for (size_t k = 0; k < columns.size(); ++k) out.columns.col(static_cast<Index>(k)) = columns[k];
  return out;
}

/// What the nodes that lie farthest out along the axes and diagonals of space are displaced by, over the distance between them.
Matrix at_sites(const std::vector<Vec3>& X, const Matrix& shapes) {
  std::vector<size_t> sites;
  for (int k = 0; k < 27; ++k) {
    const Vec3 way(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1), tilted = way + Vec3(1e-4, 2e-4, 3.7e-4);  // of nodes as far it chooses one
    size_t far = 0;
    for (size_t i = 0; i < X.size(); ++i)
      if ((X[i] - X[far]).dot(tilted) > 0) far = i;
    if (way != Vec3::Zero()) sites.push_back(far);
  }
  double length = 0;
  for (const size_t a : sites)
    for (const size_t b : sites) length = std::max(length, (X[a] - X[b]).norm());
  Matrix out(3 * static_cast<Index>(sites.size()), shapes.cols());
  for (size_t k = 0; k < sites.size(); ++k)
    out.middleRows(3 * static_cast<Index>(k), 3) = shapes.middleRows(3 * static_cast<Index>(sites[k]), 3) / length;
  return out;
}

/// The lowest vibration modes, orthonormal in mass, and one frequency more.
Matrix vibrations(const ReductionInput& in, const RegionCells& cells, const Flexibility& flexibility, Reduction& out) {
  const auto rows = 3 * static_cast<Index>(in.X.size());
  const int most = flexibility.n_unknowns() - 7;
  if (in.n_vibrations <= 0 || most < 2) return Matrix(rows, 0);
  const Pencil pencil{rows, [&](const Matrix& V) { return cells.times_mass(V); }, [&](const Matrix& F) { return flexibility.solve(F); }, 0};
  int told = 0, wanted = std::min(in.up_to > 0 ? std::min(in.n_vibrations, 8) : in.n_vibrations, most);
  for (;;) {
    const Eigenmodes found = lowest_modes(pencil, std::min(wanted + 1, most), 1e-5, false, [&](int n) {
      if (in.progress && std::exchange(told, n) != n) in.progress(fmt::format("vibration modes, {} of {}", n, std::min(wanted + 1, most)));
    });
    if (!found.converged) throw Error("", "the vibration modes of the region were not found", "ask for fewer: [region.NAME] modes");
    const Vector& lambda = found.omega2;
    Index keep = 0;
    const double limit = std::pow(2 * std::numbers::pi * in.up_to, 2);
    while (keep < std::min<Index>(wanted, lambda.size()) && (in.up_to == 0 || keep < 4 || lambda[keep] <= limit)) ++keep;
    if (keep == wanted && wanted < std::min(in.n_vibrations, most)) {
      wanted = std::min(2 * wanted, std::min(in.n_vibrations, most));
      continue;
    }
    const auto hertz = [&](Index k) { return std::sqrt(std::max(0.0, lambda[k])) / (2 * std::numbers::pi); };
    out.held_frequency = keep < lambda.size() ? hertz(keep) : 0;
    Matrix shapes = found.shapes.leftCols(keep), along = Matrix::Zero(rows, 3);
    for (Index i = 0; i < rows; ++i) along(i, i % 3) = 1;
    const Matrix M_along = cells.times_mass(along);
    out.held.resize(keep, 4);
    for (Index k = 0; k < keep; ++k) out.held(k, 0) = hertz(k);
    out.held.rightCols(3) = (shapes.transpose() * M_along).cwiseAbs2() / M_along.col(0).dot(along.col(0));
    return shapes;
  }
}

/// Modes orthonormal in mass that span what is given, but for rigid motions, with their frequencies.
struct ModeBasis {
  const RegionCells& cells;
  const Matrix &rigid, &M_rigid;
  Index spanned;  // first columns of the first part that rigid motions and the others span: to take both away would leave rounding
  const ReductionInput& in;
  ModeBasis(const RegionCells& c, const Matrix& r, const Matrix& Mr, Index n, const ReductionInput& input)
      : cells(c), rigid(r), M_rigid(Mr), spanned(n), in(input) {}

  void find(const std::vector<Matrix>& parts, Reduction& out) const {
    Index columns = -spanned;
    for (const Matrix& p : parts) columns += p.cols();
    Matrix V(rigid.rows(), columns);
    columns = 0;
    for (const Matrix& p : parts) {
      const Index n = p.cols() - (&p == &parts.front() ? spanned : 0);
      V.middleCols(columns, n) = p.rightCols(n), columns += n;
    }
    Matrix MV = cells.times_mass(V);
    const auto norms = [&] { return Vector(V.cwiseProduct(MV).colwise().sum().cwiseMax(0).cwiseSqrt().transpose()); };
    const Vector before = norms();
    const Matrix turns = transposed_times(M_rigid, V);
    add_product(-1, rigid, turns, V), add_product(-1, M_rigid, turns, MV);
    const Vector after = norms();
    Index kept = 0;
    for (Index k = 0; k < V.cols(); ++k)
      if (after[k] > 1e-8 * before[k] && after[k] > 0)
        V.col(kept) = (V.col(k) / after[k]).eval(), MV.col(kept) = (MV.col(k) / after[k]).eval(), ++kept;
    V.conservativeResize(Eigen::NoChange, kept), MV.conservativeResize(Eigen::NoChange, kept);
    in.points.empty() ? by_mass(std::move(V), MV, out) : by_energy(std::move(V), MV, out);
    add_product(-1, rigid, transposed_times(M_rigid, out.shapes), out.shapes);
    settle(out);
    check(out);
  }

  /// Modes have no sign, and those of one frequency no axes of their own: rounding would choose, on other ranks otherwise.  Waves through
  /// the region, which no symmetry makes zero, choose instead: of modes of one frequency the first alone meets the first wave, and so on.
  /// Waves differ in direction and in how they move: by phase alone they would be alike for all even modes, and for all odd ones.
  void settle(Reduction& out) const {
    constexpr double same = 1e-6;  // of squared frequencies
    const Index m = out.omega2.size();
    for (Index first = 0, next = 0; first < m; first = next) {
      for (next = first + 1; next < m && out.omega2[next] - out.omega2[next - 1] < same * out.omega2[next];) ++next;
      const Index n = next - first;
      Matrix met = Matrix::Zero(n, n);  // modes x waves
      for (Index w = 0; w < n; ++w) {
        const auto k = static_cast<double>(w);
        const Vec3 along(1.3 + std::sin(1.9 * k), 2.1 + std::sin(0.8 * k), 3.7),
            moves(std::sin(1.6 + 2.4 * k), std::sin(0.8 + 1.3 * k), std::sin(0.4 + 0.7 * k));
        for (size_t i = 0; i < in.X.size(); ++i)
          met.col(w) += std::sin(along.dot(in.X[i] - in.centre) / in.length + 0.6) *
                        out.shapes.block(3 * static_cast<Index>(i), first, 3, n).transpose() * moves;
      }
      const Eigen::HouseholderQR<Matrix> qr(met);
      const Vector sign = qr.matrixQR().diagonal().unaryExpr([](double x) { return x < 0 ? -1.0 : 1.0; });
      out.shapes.middleCols(first, n) *= Matrix(qr.householderQ()) * sign.asDiagonal();
    }
  }

  void by_mass(Matrix V, const Matrix& MV, Reduction& out) const {
    V = cut(V, transposed_times(V, MV), 1e-9);
    const Matrix Kr = transposed_times(V, cells.times(RegionCells::stiffness, V)), Mr = transposed_times(V, cells.times_mass(V));
    const Eigen::GeneralizedSelfAdjointEigenSolver<Matrix> modes((Kr + Kr.transpose()) / 2, (Mr + Mr.transpose()) / 2);
    out.omega2 = modes.eigenvalues();
    if (V.cols() > 0 && !(out.omega2[0] > 1e-12 * out.omega2[V.cols() - 1]))
      throw Error("", "the cells of the region do not hold together", "one piece, with no hinges of single nodes");
    out.shapes = product(V, modes.eigenvectors());
  }

  /// Of slender beams, whose stretch is 1e8 times as stiff as their bending: in the norm of mass the stretch of an answer would be lost in
  /// rounding of its bending, in that of K + w2 M, w2 a squared frequency of the softest, it is not.  In this norm masses are 1/(w^2 + w2).
  void by_energy(Matrix V, const Matrix& MV, Reduction& out) const {
    const Matrix KV = cells.times(RegionCells::stiffness, V);
    const Vector stiff = V.cwiseProduct(KV).colwise().sum().transpose();
    const double w2 = V.cols() > 0 ? stiff.minCoeff() : 0;
    const auto scale = (stiff.array() + w2).rsqrt().matrix().asDiagonal();
    V = cut(V * scale, scale * (transposed_times(V, KV) + w2 * transposed_times(V, MV)) * scale, 1e-11);
    V = orthonormal(V, transposed_times(V, cells.times(RegionCells::stiffness, V)) + w2 * transposed_times(V, cells.times_mass(V)));
    const Matrix Mr = transposed_times(V, cells.times_mass(V));
    const Eigen::SelfAdjointEigenSolver<Matrix> masses((Mr + Mr.transpose()) / 2);
    const Matrix y = masses.eigenvectors() * masses.eigenvalues().cwiseSqrt().cwiseInverse().asDiagonal();
    Matrix& U = out.shapes = product(V, y.rowwise().reverse());  // softest first
    U = orthonormal(U, transposed_times(U, cells.times_mass(U)));
    out.omega2 = U.cwiseProduct(cells.times(RegionCells::stiffness, U)).colwise().sum().transpose();
  }

  /// Once more, where rounding has left G all but one: each column less those before it.
  static Matrix orthonormal(const Matrix& V, const Matrix& G) { return G.llt().matrixU().solve<Eigen::OnTheRight>(V); }

  /// Combinations of V that are orthonormal in the norm that G is of, without those of a length below `least` of the largest.
  Matrix cut(const Matrix& V, const Matrix& G, double least) const {
    const Eigen::SelfAdjointEigenSolver<Matrix> gram((G + G.transpose()) / 2);
    Index skip = 0;
    while (skip < V.cols() && gram.eigenvalues()[skip] < least * gram.eigenvalues()[V.cols() - 1]) ++skip;
    const Index m = V.cols() - skip;
    Matrix out = product(V, gram.eigenvectors().rightCols(m) * gram.eigenvalues().tail(m).cwiseSqrt().cwiseInverse().asDiagonal());
    add_product(-1, rigid, transposed_times(M_rigid, out), out);
    return out;
  }

  /// Modes are orthogonal in mass and stiffness, or the answers that they come from were wrong.
  void check(const Reduction& out) const {
    const Vector scale = out.omega2.cwiseSqrt().cwiseInverse();
    const auto off = [](Matrix G) {
      G.diagonal().array() -= 1;
      return G.size() > 0 ? G.cwiseAbs().maxCoeff() : 0.0;
    };
    const double of_mass = off(transposed_times(out.shapes, cells.times_mass(out.shapes)));
    const double of_stiffness =
        off(scale.asDiagonal() * transposed_times(out.shapes, cells.times(RegionCells::stiffness, out.shapes)) * scale.asDiagonal());
    if (!(of_mass < 1e-8 && of_stiffness < 1e-6))
      throw Error("", fmt::format("its modes are not orthogonal: {:.1e} in mass, {:.1e} in stiffness", of_mass, of_stiffness),
                  "cells of less different sizes and stiffness", Exit::not_converged);
  }
};

/// Constraint, static, load and vibration modes.
std::vector<Matrix> found_modes(const ReductionInput& in, const RegionCells& cells, const Flexibility& flexibility,
                                const Matrix& at_interfaces, Reduction& out) {
  const auto tell = [&](const std::string& what) {
    if (in.progress) in.progress(what);
  };
  const auto rows = 3 * static_cast<Index>(in.X.size());
  std::vector<Matrix> parts;
  tell("static modes");
  Matrix fields = Matrix::Zero(rows, 12);
  for (size_t i = 0; i < in.X.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      fields(3 * static_cast<Index>(i) + k, k) = 1;
      for (int j = 0; j < 3; ++j) fields(3 * static_cast<Index>(i) + k, 3 + 3 * j + k) = in.X[i][j] - in.centre[j];
    }
  const Index n_loads = static_cast<Index>(in.loads.size()), n_interface = at_interfaces.cols();
  Matrix forces = Matrix::Zero(rows, n_interface + 12 + n_loads);  // all of them at once: a pass over the factor is what costs
  forces.leftCols(n_interface) = -cells.times(RegionCells::stiffness, at_interfaces);
  forces.middleCols(n_interface, 12) = cells.times_mass(fields);
  for (Index k = 0; k < n_loads; ++k)
    for (const auto& [node, force] : in.loads[static_cast<size_t>(k)]) forces.col(n_interface + 12 + k).segment<3>(3 * node) += force;
  const Matrix answers = flexibility.solve(std::move(forces));
  parts.emplace_back(at_interfaces + answers.leftCols(n_interface));
  parts.emplace_back(answers.rightCols(12 + n_loads));
  tell("vibration modes");
  parts.push_back(vibrations(in, cells, flexibility, out));
  return parts;
}

/// What the modes lack of the static answer u to the forces of their own inertia: its strain energy less that of its share in the modes.
Matrix energy_left_out(const RegionCells& cells, const Flexibility& flexibility, const Reduction& found) {
  const Matrix F = cells.times_mass(found.shapes), u = flexibility.solve(F);
  const Matrix share = transposed_times(found.shapes, cells.times(RegionCells::stiffness, u)), L = transposed_times(u, F);
  return (L + L.transpose()) / 2 - share.transpose() * found.omega2.cwiseInverse().asDiagonal() * share;
}

/// B^T M B of the columns b, a few of them at a time.
Matrix moments(const ReductionInput& in, const Matrix& shapes, const RegionCells::Scalar& M) {
  constexpr Index at_once = 48;
  const auto n = static_cast<Index>(in.X.size()), count = 4 + 3 * shapes.cols();
  const auto columns = [&](Index from) {
    Matrix B(n, std::min(at_once, count - from));
    for (Index c = 0; c < B.cols(); ++c)
      for (Index i = 0; i < n; ++i) {
        const Index k = from + c;
        B(i, c) = k == 0 ? 1 : k < 4 ? in.X[i][k - 1] - in.centre[k - 1] : shapes(3 * i + (k - 4) % 3, (k - 4) / 3);
      }
    return B;
  };
  Matrix out(count, count);
  for (Index j = 0; j < count; j += at_once) {
    Matrix MB = columns(j);
    MB = (M * MB).eval();
    for (Index i = 0; i <= j; i += at_once) {
      const Matrix part = transposed_times(columns(i), MB);
      out.block(i, j, part.rows(), part.cols()) = part;
      if (i < j) out.block(j, i, part.cols(), part.rows()) = part.transpose();
    }
  }
  return (out + out.transpose()) / 2;
}

bool any(const ReductionInput& in, double SolidBatch::*of_batch, double PointCell::*of_cell) {
  return std::ranges::any_of(in.cells, [&](const SolidBatch& b) { return b.*of_batch > 0; }) ||
         std::ranges::any_of(in.points, [&](const PointCell& c) { return c.*of_cell > 0; });
}

void add_moments(const ReductionInput& in, const RegionCells& cells, Reduction& out) {
  out.A = moments(in, out.shapes, cells.scalar_mass());
  if (any(in, &SolidBatch::alpha, &PointCell::alpha)) out.A_damped = moments(in, out.shapes, cells.scalar(RegionCells::damping_by_mass));
}

}  // namespace

Reduction rigid_one(const ReductionInput& in) {
  Reduction out;
  out.shapes.resize(3 * std::ssize(in.X), 0);
  add_moments(in, RegionCells(in.X, in.cells, in.points), out);
  return out;
}

Reduction reduced(const ReductionInput& in, SharedCholesky& factor) {
  const auto tell = [&](const std::string& what) {
    if (in.progress) in.progress(what);
  };
  const RegionCells cells(in.X, in.cells, in.points);
  Matrix rigid = rigid_motions(in.X, in.centre);
  {  // orthonormal in mass
    const Matrix G = rigid.transpose() * cells.times_mass(rigid);
    rigid = rigid * Matrix(Matrix(G.llt().matrixL()).inverse().transpose());
  }
  const Matrix M_rigid = cells.times_mass(rigid);
  tell("factor");
  const Flexibility flexibility(in, cells, rigid, M_rigid, factor);
  Reduction out;
  const bool is_given = in.given.cols() > 0;
  const InterfaceMotions interfaces = is_given ? InterfaceMotions{} : interface_motions(in);
  std::vector<Matrix> parts = is_given ? std::vector<Matrix>{in.given} : found_modes(in, cells, flexibility, interfaces.columns, out);

  tell("basis");
  const ModeBasis basis(cells, rigid, M_rigid, interfaces.n_first, in);  // moved alike, all interfaces make a rigid motion
  basis.find(parts, out);
  if (in.stiffening && !is_given) {
    tell("modal derivatives");
    Reduction bending;  // what the region does where it is soft: its vibrations between interfaces, and what those do
    const Matrix& found = parts.back();
    basis.find({parts.front(), found.leftCols(std::min<Index>(n_held, found.cols()))}, bending);
    const Index n = std::min<Index>(n_bending, bending.omega2.size());
    parts.push_back(modal_derivatives(cells, bending.shapes.leftCols(n), bending.omega2.head(n), in.length,
                                      [&](const Matrix& F) { return flexibility.solve(F); }));
    basis.find(parts, out);
    for (Matrix& vibrations = parts[2]; in.may_be_fewer && out.omega2.size() > most_stiffened && vibrations.cols() > 0;) {
      const Index keep = std::max<Index>(0, vibrations.cols() - (out.omega2.size() - most_stiffened));
      out.held_frequency = out.held(keep, 0), out.held.conservativeResize(keep, Eigen::NoChange);
      vibrations.conservativeResize(Eigen::NoChange, keep);
      basis.find(parts, out);
    }
    if (out.omega2.size() > most_stiffened)
      throw Error(
          "", fmt::format("{} modes, the most that can stiffen is {}", out.omega2.size(), most_stiffened),
          parts[2].cols() > 0 ? "fewer vibration modes: [region.NAME] modes" : "tag it nonlinear: its interfaces and loads make as many");
    out.strain = quadratic_strain(cells, out.shapes, out.omega2, in.length, tell);
  }
  out.sites = at_sites(in.X, out.shapes);
  tell("error");
  out.left_out = energy_left_out(cells, flexibility, out);
  SecondOrder second = second_order(in, out.shapes, out.omega2, cells.times_mass(parts.front().leftCols(interfaces.n_rigid)));
  out.soft = std::move(second.soft), out.second_order = std::move(second.forces);
  factor.end();
  add_moments(in, cells, out);
  if (any(in, &SolidBatch::beta, &PointCell::beta)) {
    if (out.strain.used()) {
      out.viscous = viscous_strain(cells, out.shapes, in.length, tell);
    } else {
      const Matrix C = transposed_times(out.shapes, cells.times(RegionCells::damping_by_stiffness, out.shapes));
      out.viscous = (C + C.transpose()) / 2;
    }
  }
  return out;
}

}  // namespace hilo
