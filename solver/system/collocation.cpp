// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/collocation.hpp"

#include <Eigen/LU>
#include <cmath>

#include "system/facet.hpp"
#include "system/stage.hpp"

namespace hilo {
namespace {

using Values = MeasurePath::Values;

using Vector = Eigen::Matrix<double, max_measures, 1>;
using Vectors = std::array<Vector, Collocation::n>;

Vector vector_of(const Values& x) { return Eigen::Map<const Vector>(x.data()); }
Vectors ways_of(const MeasurePath& path) { return {vector_of(path.way[0]), vector_of(path.way[1]), vector_of(path.way[2])}; }

}  // namespace

Vec3 turned(const Stage& s, int body) {
  const Mat3 &R = s.end->R[body], &R0 = s.from().R[body];
  if (!s.step) return rotation_increment(R0, R);
  return axial((R - R0) * R.inverse());  // b_i h w_i, directors are not orthonormal
}

MeasurePath::MeasurePath(const Connector& c, const Collocation& step) : e0(c.values(*step.start)), e1(e0) {
  for (int j = 0; j < Collocation::n; ++j) way[j] = way_of(c, step, j);
  for (int i = 0; i < Collocation::n; ++i) {
    at[i] = e0;
    for (int j = 0; j < Collocation::n; ++j)
      for (size_t m = 0; m < max_measures; ++m) at[i][m] += step.a[i][j] * way[j][m];
  }
  for (size_t m = 0; m < max_measures; ++m) e1[m] += step.b[0] * way[0][m] + step.b[1] * way[1][m] + step.b[2] * way[2][m];
}

Values MeasurePath::way_of(const Connector& c, const Collocation& step, int j) {
  Values out = c.values(*step.after[j]);
  const Values behind = c.values(*step.before[j]);
  for (size_t m = 0; m < c.measures.size(); ++m) out[m] -= behind[m];
  return out;
}

void elastic_along(const SpringLaw& law, const MeasurePath& path, const Collocation& step, int i, Response& out) {
  Vectors slopes;
  Response r;
  for (int j = 0; j < Collocation::n; ++j) {
    law.elastic(path.at[j], path.at[j], r = {});
    slopes[j] = vector_of(r.s);
    if (j == i) out = r;
  }
  for (auto& row : out.D)  // so far the derivative by the second argument alone
    for (double& d : row) d *= 2;
  law.elastic(path.e0, path.e1, r = {});
  Vector stiffness, force = slopes[i];
  for (int m = 0; m < max_measures; ++m) stiffness[m] = std::abs(r.D[m][m]);
  complete(vector_of(r.s), slopes, ways_of(path), stiffness, step, i, force);
  Eigen::Map<Vector>(out.s.data()) = force;
}

void gradient_along(const RowLaw& rows, const MeasurePath& path, const Collocation& step, int i, RowLaw::Gradient& out) {
  RowLaw::Gradient at[Collocation::n], whole;
  for (int j = 0; j < Collocation::n; ++j) rows.gradient(path.at[j], path.at[j], at[j]);
  rows.gradient(path.e0, path.e1, whole);
  out = at[i];
  const Vectors ways = ways_of(path);
  for (int r = 0; r < rows.n_rows(); ++r) {
    const Vector mean = vector_of(whole.d[r]);
    Vector d = vector_of(at[i].d[r]);
    complete(mean, {vector_of(at[0].d[r]), vector_of(at[1].d[r]), vector_of(at[2].d[r])}, ways, Vector(mean.cwiseAbs2()), step, i, d);
    Eigen::Map<Vector>(out.d[r].data()) = d;
  }
}

}  // namespace hilo
