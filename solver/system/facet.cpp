// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/facet.hpp"

#include <algorithm>
#include <cmath>

namespace hilo {
namespace {

struct FacetPoint : FacetShape {
  double w;
};

/// The integration points of a facet with n nodes.
std::vector<FacetPoint> points_of(size_t n) {
  std::vector<FacetPoint> points;
  if (n == 3 || n == 6) {
    static constexpr double at[6][3] = {
        {0.445948490915965, 0.445948490915965, 0.223381589678011 / 2}, {0.108103018168070, 0.445948490915965, 0.223381589678011 / 2},
        {0.445948490915965, 0.108103018168070, 0.223381589678011 / 2}, {0.091576213509771, 0.091576213509771, 0.109951743655322 / 2},
        {0.816847572980459, 0.091576213509771, 0.109951743655322 / 2}, {0.091576213509771, 0.816847572980459, 0.109951743655322 / 2}};
    for (const auto& [r, s, w] : at) points.push_back({facet_shape(n, r, s), w});
    return points;
  }
  const double g = std::sqrt(0.6), x[3] = {-g, 0, g}, w[3] = {5. / 9, 8. / 9, 5. / 9};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) points.push_back({facet_shape(n, x[i], x[j]), w[i] * w[j]});
  return points;
}

const std::vector<FacetPoint>& table(size_t n) {
  static const std::vector<FacetPoint> tables[4] = {points_of(3), points_of(4), points_of(6), points_of(8)};
  return tables[n == 3 ? 0 : n == 4 ? 1 : n == 6 ? 2 : 3];
}

}  // namespace

FacetShape facet_shape(size_t n, double r, double s) {
  FacetShape p{};
  if (n == 3 || n == 6) {
    const double L[3] = {1 - r - s, r, s}, Lr[3] = {-1, 1, 0}, Ls[3] = {-1, 0, 1};
    for (int a = 0; a < 3; ++a) {
      if (n == 3) {
        p.N[a] = L[a], p.dr[a] = Lr[a], p.ds[a] = Ls[a];
      } else {
        const int b = (a + 1) % 3;
        p.N[a] = L[a] * (2 * L[a] - 1), p.dr[a] = (4 * L[a] - 1) * Lr[a], p.ds[a] = (4 * L[a] - 1) * Ls[a];
        p.N[3 + a] = 4 * L[a] * L[b], p.dr[3 + a] = 4 * (Lr[a] * L[b] + L[a] * Lr[b]), p.ds[3 + a] = 4 * (Ls[a] * L[b] + L[a] * Ls[b]);
      }
    }
    return p;
  }
  static constexpr double corner[8][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0, -1}, {1, 0}, {0, 1}, {-1, 0}};
  for (size_t a = 0; a < n; ++a) {
    const double cr = corner[a][0], cs = corner[a][1];
    if (n == 4) {
      p.N[a] = (1 + cr * r) * (1 + cs * s) / 4, p.dr[a] = cr * (1 + cs * s) / 4, p.ds[a] = cs * (1 + cr * r) / 4;
    } else if (a < 4) {
      const double u = (1 + cr * r) * (1 + cs * s), v = cr * r + cs * s - 1;
      p.N[a] = u * v / 4, p.dr[a] = (cr * (1 + cs * s) * v + u * cr) / 4, p.ds[a] = (cs * (1 + cr * r) * v + u * cs) / 4;
    } else if (cr == 0) {
      p.N[a] = (1 - r * r) * (1 + cs * s) / 2, p.dr[a] = -r * (1 + cs * s), p.ds[a] = cs * (1 - r * r) / 2;
    } else {
      p.N[a] = (1 - s * s) * (1 + cr * r) / 2, p.dr[a] = cr * (1 - s * s) / 2, p.ds[a] = -s * (1 + cr * r);
    }
  }
  return p;
}

std::vector<double> facet_weights(std::span<const Vec3> X) {
  std::vector<double> weight(X.size(), 0.0);
  for (const FacetPoint& p : table(X.size())) {
    Vec3 r = Vec3::Zero(), s = Vec3::Zero();
    for (size_t a = 0; a < X.size(); ++a) r += p.dr[a] * X[a], s += p.ds[a] * X[a];
    for (size_t a = 0; a < X.size(); ++a) weight[a] += p.w * p.N[a] * r.cross(s).norm();
  }
  return weight;
}

void pressure_force(double pressure, std::span<const Vec3> x0, std::span<const Vec3> x1, std::span<Vec3> f, double* K) {
  const int n = static_cast<int>(x0.size());
  std::fill(f.begin(), f.end(), Vec3::Zero());
  const double at[2] = {0.5 - std::sqrt(3.0) / 6, 0.5 + std::sqrt(3.0) / 6};
  for (const FacetPoint& p : table(x0.size()))
    for (double w : at) {
      Vec3 r = Vec3::Zero(), s = Vec3::Zero();
      for (int a = 0; a < n; ++a) {
        const Vec3 x = x0[a] + w * (x1[a] - x0[a]);
        r += p.dr[a] * x, s += p.ds[a] * x;
      }
      const double weight = -pressure * p.w / 2;
      const Vec3 normal = weight * r.cross(s);
      for (int a = 0; a < n; ++a) f[a] += p.N[a] * normal;
      if (!K) continue;
      const Mat3 R = weight * w * skew(r), S = weight * w * skew(s);  // d(r x s) = r x ds - s x dr
      for (int b = 0; b < n; ++b) {
        const Mat3 D = p.ds[b] * R - p.dr[b] * S;
        for (int a = 0; a < n; ++a)
          for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) K[(3 * a + i) * 3 * n + 3 * b + j] += p.N[a] * D(i, j);
      }
    }
}

Vec3 rotation_increment(const Mat3& R0, const Mat3& R1) {
  // Cayley vector of Q = R1 R0^T: skew(w)/2 = (Q - I)(Q + I)^-1, so w = 2 axial(Q - Q^T)/(1 + tr Q)
  const Mat3 Q = R1 * R0.transpose();
  return 2 / (1 + Q.trace()) * Vec3(Q(2, 1) - Q(1, 2), Q(0, 2) - Q(2, 0), Q(1, 0) - Q(0, 1));
}

}  // namespace hilo
