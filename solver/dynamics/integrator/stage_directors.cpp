// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/integrator/stage_directors.hpp"

namespace hilo {
namespace {

using Columns = Eigen::Matrix<double, 9, 3>;

Mat9 matrix_of(const Eigen::Matrix3d& A, const std::array<Vec3, 3>& w) {
  Mat9 K = Mat9::Identity();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) K.block<3, 3>(3 * i, 3 * j) -= A(i, j) * skew(w[j]);
  return K;
}

std::array<Mat3, 3> parts(const Columns& x) { return {x.topRows<3>(), x.middleRows<3>(3), x.bottomRows<3>()}; }

}  // namespace

StageDirectors::StageDirectors(const Eigen::Matrix3d& A, const std::array<Vec3, 3>& w) : A_(A), w_(w), matrix_(matrix_of(A, w)) {}

std::array<Mat3, 3> StageDirectors::grow(const Mat3& start, const std::array<Mat3, 3>* more) const {
  Columns rhs = Columns::Zero();
  for (int j = 0; j < 3; ++j) {
    Mat3 part = skew(w_[j]) * start;
    if (more) part += (*more)[j];
    for (int i = 0; i < 3; ++i) rhs.middleRows<3>(3 * i) += A_(i, j) * part;
  }
  return parts(matrix_.solve(rhs));
}

StageDirectors::Moves StageDirectors::moves(const std::array<Mat3, 3>& R) const {
  Moves out;
  const std::array<Mat3, 3> inverse{R[0].inverse(), R[1].inverse(), R[2].inverse()};
  for (int j = 0; j < 3; ++j)
    for (int c = 0; c < 3; ++c) {
      Columns rhs;
      for (int i = 0; i < 3; ++i) rhs.middleRows<3>(3 * i) = A_(i, j) * skew(Vec3::Unit(c)) * R[j];
      const std::array<Mat3, 3> dR = parts(matrix_.solve(rhs));
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
