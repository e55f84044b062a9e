// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/integrator/given_stages.hpp"

#include <Eigen/LU>
#include <cmath>

#include "dynamics/integrator/stage_directors.hpp"
#include "dynamics/state.hpp"
#include "system/facet.hpp"

namespace hilo {

/// The accelerations a(t_j) with alpha + beta c_j besides, by which sum b_j A_j = (v1 - v0)/h and sum b_j (1 - c_j) A_j = (q1 - q0 - h
/// v0)/h^2: alpha and beta are of order h^5 and h^4.
bool GivenStages::find(const System& system, const Collocation& step, const Eigen::Matrix3d& A, const Config& q0, const Config& v0) {
  system_ = system.moves() ? &system : nullptr;
  if (!system_) return true;
  const double h = step.h, t1 = step.t + h;
  q1_ = q0, v1_ = v0;
  system.prescribe(q1_, t1), system.prescribe_rates(t1, Side::left, &v1_, nullptr);
  for (int i = 0; i < 3; ++i) {
    combine(a_[i], {{0, &v0}});
    q_[i] = q0;
    system.prescribe_rates(step.t + step.c[i] * h, Side::left, nullptr, &a_[i]);
    system.prescribe(q_[i], step.t + step.c[i] * h);
  }
  Config speed, place, alpha, beta;  // what is missing at the end
  combine(speed, {{1 / h, &v1_}, {-1 / h, &v0}, {-step.b[0], &a_[0]}, {-step.b[1], &a_[1]}, {-step.b[2], &a_[2]}});
  const double f = 1 / (h * h);
  combine(place, {{f, &q1_}, {-f, &q0}, {-1 / h, &v0}});
  for (int j = 0; j < 3; ++j) combine(place, {{1, &place}, {-step.b[j] * (1 - step.c[j]), &a_[j]}});
  combine(alpha, {{6, &place}, {-2, &speed}});
  combine(beta, {{6, &speed}, {-12, &place}});
  Config accelerations[3], way[3];
  for (int j = 0; j < 3; ++j) combine(accelerations[j], {{1, &a_[j]}, {1, &alpha}, {step.c[j], &beta}});
  for (int i = 0; i < 3; ++i)
    combine(way[i],
            {{h, &v0}, {h * h * A(i, 0), &accelerations[0]}, {h * h * A(i, 1), &accelerations[1]}, {h * h * A(i, 2), &accelerations[2]}});
  for (int i = 0; i < 3; ++i) combine(dq_[i], {{A(i, 0), &way[0]}, {A(i, 1), &way[1]}, {A(i, 2), &way[2]}});
  for (std::vector<Vec3>& t : turn_) t.assign(q0.R.size(), Vec3::Zero());
  for (size_t b = 0; b < q0.R.size(); ++b)
    if (system.bodies[b].moving && !turn(step, A, q0.R[b], v0.R[b], b)) return false;
  return true;
}

/// The same for directors R' = skew(w) R with the parts of A R^-1 that turn for accelerations.
bool GivenStages::turn(const Collocation& step, const Eigen::Matrix3d& A, const Mat3& R0, const Mat3& V0, size_t b) {
  const Eigen::Matrix3d W = A.inverse();
  const double h = step.h;
  const Mat3& R1 = q1_.R[b];
  const Vec3 rate1 = h * axial(v1_.R[b] * R1.transpose());
  std::array<Vec3, 3> wanted, w;
  for (int i = 0; i < 3; ++i) wanted[i] = h * h * axial(a_[i].R[b] * q_[i].R[b].transpose());
  for (int i = 0; i < 3; ++i) w[i] = h * axial(V0 * R0.transpose()) + A(i, 0) * wanted[0] + A(i, 1) * wanted[1] + A(i, 2) * wanted[2];
  for (int iteration = 0; iteration < 100; ++iteration) {
    const auto dR = StageDirectors(A, w).grow(R0);
    std::array<Mat3, 3> R, way, gain;
    for (int i = 0; i < 3; ++i) R[i] = R0 + dR[i], way[i] = skew(w[i]) * R[i];
    std::array<Vec3, 3> missing, change;
    Mat3 end = R0, rate = h * V0;
    Vec3 angle = Vec3::Zero(), speed = Vec3::Zero();  // that missing adds at the end
    for (int i = 0; i < 3; ++i) {
      gain[i] = W(i, 0) * way[0] + W(i, 1) * way[1] + W(i, 2) * way[2] - W.row(i).sum() * h * V0;
      missing[i] = wanted[i] - axial(gain[i] * R[i].inverse());
      end += step.b[i] * way[i], rate += step.b[i] * gain[i];
      angle += step.b[i] * (1 - step.c[i]) * missing[i], speed += step.b[i] * missing[i];
    }
    angle = rotation_increment(end, R1) - angle;
    speed = rate1 - axial(rate * end.inverse()) - speed;
    const Vec3 alpha = 6 * angle - 2 * speed, beta = 6 * speed - 12 * angle;
    for (int i = 0; i < 3; ++i) wanted[i] += alpha + step.c[i] * beta, missing[i] += alpha + step.c[i] * beta;
    double largest = 0, size = 1;
    for (int i = 0; i < 3; ++i) {
      change[i] = A(i, 0) * missing[0] + A(i, 1) * missing[1] + A(i, 2) * missing[2];
      w[i] += change[i];
      largest = std::max(largest, change[i].norm()), size = std::max(size, w[i].norm());
    }
    if (!(largest < 10)) return false;
    if (largest > 1e-15 * size) continue;
    for (int i = 0; i < 3; ++i) turn_[i][b] = w[i], dq_[i].R[b] = R[i] - R0;
    return true;
  }
  return false;
}

void GivenStages::put(int i, Config& dq, std::vector<Vec3>& turn) const {
  if (!system_) return;
  system_->copy_prescribed(dq_[i], dq);
  for (size_t b = 0; b < turn.size(); ++b)
    if (system_->bodies[b].moving) turn[b] = turn_[i][b];
}

void GivenStages::put_end(Config& q) const {
  if (system_) system_->copy_prescribed(q1_, q), system_->follow(q);
}

void GivenStages::put_rates(Config& v) const {
  if (system_) system_->copy_prescribed(v1_, v), system_->follow(v);
}

}  // namespace hilo
