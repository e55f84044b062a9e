// SPDX-License-Identifier: GPL-3.0-or-later
// What the points of a linear cell say of its stress.
#pragma once
#include <Eigen/LU>
#include <vector>

#include "physics/stress.hpp"

namespace hilo {

/// Mean stress of a linear cell, where it is, and the slope of its assumed strains: least squares over its points.
struct LinearCellMean {
  Vec3 X = Vec3::Zero();
  Vec6 S = Vec6::Zero();
  Eigen::Matrix<double, 6, 3> slope = Eigen::Matrix<double, 6, 3>::Zero();
  explicit LinearCellMean(const std::vector<StressPoint>& points) {
    double w = 0;
    for (const StressPoint& p : points) X += p.w * p.X, S += p.w * p.S, w += p.w;
    X /= w, S /= w;
    if (points.size() < 4) return;
    Mat3 spread = Mat3::Zero();
    Eigen::Matrix<double, 6, 3> with = Eigen::Matrix<double, 6, 3>::Zero();
    for (const StressPoint& p : points) {
      spread += p.w * (p.X - X) * (p.X - X).transpose();
      with += p.w * (p.S - S) * (p.X - X).transpose();
    }
    slope = with * spread.inverse();
  }
};

}  // namespace hilo
