// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/material/principal_axes.hpp"

#include <cmath>

namespace hilo {

void principal_axes(Mat3 A, Mat3& V, Vec3& e) {
  V.setIdentity();
  for (int sweep = 0; sweep < 12; ++sweep) {
    const double off = A(0, 1) * A(0, 1) + A(0, 2) * A(0, 2) + A(1, 2) * A(1, 2), size = A.diagonal().squaredNorm();
    if (off <= 1e-34 * size || off < 1e-300) break;
    for (int p = 0; p < 2; ++p)
      for (int q = p + 1; q < 3; ++q) {
        if (A(p, q) == 0) continue;
        const double theta = (A(q, q) - A(p, p)) / (2 * A(p, q));
        const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1)), c = 1 / std::sqrt(t * t + 1), s = t * c;
        const int r = 3 - p - q;
        const double apq = A(p, q), apr = A(p, r), aqr = A(q, r);
        A(p, p) -= t * apq, A(q, q) += t * apq, A(p, q) = A(q, p) = 0;
        A(p, r) = A(r, p) = c * apr - s * aqr, A(q, r) = A(r, q) = s * apr + c * aqr;
        const Vec3 vp = V.col(p), vq = V.col(q);
        V.col(p) = c * vp - s * vq, V.col(q) = s * vp + c * vq;
      }
  }
  e = A.diagonal();
}

}  // namespace hilo
