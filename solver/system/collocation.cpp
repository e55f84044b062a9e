#include "system/collocation.hpp"

#include <cmath>

namespace hilo {
namespace {

using Values = MeasurePath::Values;

/// Adds to `d`, the slopes at stage i, what makes their sum along the ways that of the mean slopes over the step, sum b_j mean.way_j;
/// `slopes`: of the stages, `norm`: weights of the measures.
void complete(const Values& mean, const std::array<Values, Collocation::n>& slopes, const Values& norm, const MeasurePath& path,
              const Collocation& step, int i, Values& d) {
  double missing = 0, size = 0;
  for (int j = 0; j < Collocation::n; ++j)
    for (size_t m = 0; m < norm.size(); ++m) {
      const double way = path.way[j][m];
      missing += step.b[j] * (mean[m] - slopes[j][m]) * way, size += step.b[j] * norm[m] * way * way;
    }
  if (size < 1e-280) return;  // the measures rest
  for (size_t m = 0; m < norm.size(); ++m) d[m] += missing / size * norm[m] * path.way[i][m];
}

}  // namespace

MeasurePath::MeasurePath(const Connector& c, const Collocation& step) : e0(c.values(*step.start)), e1(e0) {
  for (int j = 0; j < Collocation::n; ++j) {
    way[j] = c.values(*step.after[j]);
    const Values behind = c.values(*step.before[j]);
    for (size_t m = 0; m < max_measures; ++m) way[j][m] = m < c.measures.size() ? way[j][m] - behind[m] : 0;
  }
  for (int i = 0; i < Collocation::n; ++i) {
    at[i] = e0;
    for (int j = 0; j < Collocation::n; ++j)
      for (size_t m = 0; m < max_measures; ++m) at[i][m] += step.a[i][j] * way[j][m];
  }
  for (size_t m = 0; m < max_measures; ++m) e1[m] += step.b[0] * way[0][m] + step.b[1] * way[1][m] + step.b[2] * way[2][m];
}

void elastic_along(const SpringLaw& law, const MeasurePath& path, const Collocation& step, int i, Response& out) {
  std::array<Values, Collocation::n> slopes;
  Response r;
  for (int j = 0; j < Collocation::n; ++j) {
    law.elastic(path.at[j], path.at[j], r = {});
    slopes[j] = r.s;
    if (j == i) out = r;
  }
  for (auto& row : out.D)  // so far the derivative by the second argument alone
    for (double& d : row) d *= 2;
  law.elastic(path.e0, path.e1, r = {});
  Values stiffness;
  for (size_t m = 0; m < stiffness.size(); ++m) stiffness[m] = std::abs(r.D[m][m]);
  complete(r.s, slopes, stiffness, path, step, i, out.s);
}

void gradient_along(const RowLaw& rows, const MeasurePath& path, const Collocation& step, int i, RowLaw::Gradient& out) {
  RowLaw::Gradient at[Collocation::n], whole;
  for (int j = 0; j < Collocation::n; ++j) rows.gradient(path.at[j], path.at[j], at[j] = {});
  rows.gradient(path.e0, path.e1, whole = {});
  out = at[i];
  for (int r = 0; r < rows.n_rows(); ++r) {
    Values norm;
    for (size_t m = 0; m < norm.size(); ++m) norm[m] = whole.d[r][m] * whole.d[r][m];
    complete(whole.d[r], {at[0].d[r], at[1].d[r], at[2].d[r]}, norm, path, step, i, out.d[r]);
  }
}

}  // namespace hilo
