// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/integrator/stage_directors.hpp"

namespace hilo {

StageDirectors::StageDirectors(const Eigen::Matrix3d& A, const std::array<Vec3, 3>& w) : A_(A), w_(w) {}

const StageDirectors::Factors& StageDirectors::factors() const {
  if (factors_) return *factors_;
  Factors& f = factors_.emplace();
  const Mat3 S[3] = {skew(w_[0]), skew(w_[1]), skew(w_[2])};
  const auto block = [&](int i, int j) {
    Mat3 K = -A_(i, j) * S[j];
    if (i == j) K += Mat3::Identity();
    return K;
  };
  f.u01 = block(0, 1), f.u02 = block(0, 2);
  f.inverse[0] = block(0, 0).inverse();
  f.l10 = block(1, 0) * f.inverse[0], f.l20 = block(2, 0) * f.inverse[0];
  f.inverse[1] = Mat3(block(1, 1) - f.l10 * f.u01).inverse();
  f.u12 = block(1, 2) - f.l10 * f.u02;
  f.l21 = (block(2, 1) - f.l20 * f.u01) * f.inverse[1];
  f.inverse[2] = Mat3(block(2, 2) - f.l20 * f.u02 - f.l21 * f.u12).inverse();
  return f;
}

void StageDirectors::solve(std::array<Mat3, 3>& x) const {
  const Factors& f = factors();
  x[1] -= f.l10 * x[0];
  x[2] -= f.l20 * x[0] + f.l21 * x[1];
  x[2] = (f.inverse[2] * x[2]).eval();
  x[1] = (f.inverse[1] * (x[1] - f.u12 * x[2])).eval();
  x[0] = (f.inverse[0] * (x[0] - f.u01 * x[1] - f.u02 * x[2])).eval();
}

std::array<Mat3, 3> StageDirectors::grow(const Mat3& start, const std::array<Mat3, 3>* more) const {
  std::array<Mat3, 3> x{Mat3::Zero(), Mat3::Zero(), Mat3::Zero()};
  for (int j = 0; j < 3; ++j) {
    Mat3 part = skew(w_[j]) * start;
    if (more) part += (*more)[j];
    for (int i = 0; i < 3; ++i) x[i] += A_(i, j) * part;
  }
  solve(x);
  return x;
}

StageDirectors::Moves StageDirectors::moves(const std::array<Mat3, 3>& R) const {
  Moves out;
  const std::array<Mat3, 3> inverse{R[0].inverse(), R[1].inverse(), R[2].inverse()};
  for (int j = 0; j < 3; ++j)
    for (int c = 0; c < 3; ++c) {
      const Mat3 turned = skew(Vec3::Unit(c)) * R[j];
      std::array<Mat3, 3> dR{A_(0, j) * turned, A_(1, j) * turned, A_(2, j) * turned};
      solve(dR);
      for (int i = 0; i < 3; ++i) {
        out.dR[i][3 * j + c] = dR[i];
        out.turns.block<3, 1>(3 * i, 3 * j + c) = axial(dR[i] * inverse[i]);
      }
    }
  return out;
}

std::array<std::array<Mat3, 9>, 3> StageDirectors::moves_by_turns(const std::array<Mat3, 3>& R) const {
  const Moves m = moves(R);
  const Mat9 inverse = m.turns.inverse();
  std::array<std::array<Mat3, 9>, 3> out;
  for (int i = 0; i < 3; ++i)
    for (int c = 0; c < 9; ++c) {
      out[i][c].setZero();
      for (int d = 0; d < 9; ++d) out[i][c] += inverse(d, c) * m.dR[i][d];
    }
  return out;
}

Vec9 StageDirectors::nearly_spins(const std::array<Mat3, 3>& R, const Vec9& t) const {
  const Eigen::Matrix3d W = A_.inverse();
  std::array<Mat3, 3> dR;
  Vec9 out;
  for (int i = 0; i < 3; ++i) dR[i] = skew(t.segment<3>(3 * i)) * R[i];
  for (int i = 0; i < 3; ++i)
    out.segment<3>(3 * i) =
        axial((W(i, 0) * dR[0] + W(i, 1) * dR[1] + W(i, 2) * dR[2]) * R[i].transpose() - skew(w_[i]) * skew(t.segment<3>(3 * i)));
  return out;
}

}  // namespace hilo
