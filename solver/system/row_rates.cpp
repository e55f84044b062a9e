// Rates of the joint rows, for consistent velocities and accelerations.
#include <algorithm>

#include "physics/rolling.hpp"
#include "system/system.hpp"

namespace hilo {

/// First and second derivatives of the joint rows by time, less those of their courses, laid out like lambda.  The measures are of degree
/// two, so differences along q + tau v and q + tau a are exact; rows that are functions of them follow by the chain rule.
void System::row_rates(const Config& q, const Config& v, const Config* a, double t, std::vector<double>& rate,
                       std::vector<double>* acceleration) const {
  const auto combined = [&](double f, const Config& d) {
    Config out = q;
    for (size_t i = 0; i < q.x.size(); ++i) out.x[i] += f * d.x[i];
    for (size_t i = 0; i < q.c.size(); ++i) out.c[i] += f * d.c[i], out.R[i] += f * d.R[i];
    return out;
  };
  // steps over which the differences are as large as the values themselves
  const auto reach = [&](const Config& d) {
    double top = 0;
    for (const Vec3& x : d.x) top = std::max(top, x.norm());
    for (size_t i = 0; i < d.c.size(); ++i) top = std::max({top, d.c[i].norm(), d.R[i].norm() * bodies[i].size});
    return top > 0 ? length / top : 1;
  };
  const double tau = reach(v), sigma = a ? reach(*a) : 1;
  const Config forward = combined(tau, v), backward = combined(-tau, v);
  Config up, down;
  if (a) up = combined(sigma, *a), down = combined(-sigma, *a);
  rate.assign(3 * n_joint_blocks(), 0.0);
  if (acceleration) acceleration->assign(rate.size(), 0.0);
  RowLaw::Gradient g;
  for (size_t j = 0; j < joints.size(); ++j) {
    if (!owns_joint_[j]) continue;
    const Connector& c = joints[j];
    const int n = static_cast<int>(c.measures.size()), base = 3 * (joint_block[j] - first_joint_block());
    const auto e = c.values(q), ep = c.values(forward), em = c.values(backward);
    std::array<double, max_measures> de{}, dde{};
    for (int m = 0; m < n; ++m) de[m] = (ep[m] - em[m]) / (2 * tau);
    if (acceleration) {
      const auto eu = c.values(up), ed = c.values(down);
      for (int m = 0; m < n; ++m) dde[m] = (ep[m] + em[m] - 2 * e[m]) / (tau * tau) + (eu[m] - ed[m]) / (2 * sigma);
    }
    if (c.rows) c.rows->gradient(e, e, g);
    if (c.velocity_rows) {
      const Slip slip(c, q, &v);
      const auto along = [&](int body) {
        return Slip::Move{v.c[body], a ? a->c[body] : Vec3::Zero(), v.R[body], a ? a->R[body] : Mat3::Zero()};
      };
      const Slip::Change change = slip.change(along(c.end[0].body), along(c.end[1].body));
      for (int r = 0; r < slip.n; ++r) {
        rate[base + c.n_position_rows() + r] = slip.value[r];
        if (acceleration) (*acceleration)[base + c.n_position_rows() + r] = change.value[r];
      }
    }
    for (int r = 0; r < c.n_position_rows(); ++r) {
      double first = c.rows ? 0 : de[r], second = c.rows ? 0 : dde[r];
      for (int m = 0; m < n && c.rows; ++m) {
        first += g.d[r][m] * de[m], second += g.d[r][m] * dde[m];
        for (int k = 0; k < n; ++k) second += 2 * g.D[r][m][k] * de[m] * de[k];
      }
      if (r == c.drive.row) {
        const Course course = c.drive.law.at(t, beside(t, Side::right));
        first -= course.rate, second -= course.acceleration;
      }
      rate[base + r] = first;
      if (acceleration) (*acceleration)[base + r] = second;
    }
  }
  comm->sum(rate);
  if (acceleration) comm->sum(*acceleration);
}

}  // namespace hilo
