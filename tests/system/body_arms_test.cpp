// SPDX-License-Identifier: GPL-3.0-or-later
// The points of a body that results have do not hang on rounding, or runs on other ranks would have others.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "system/bodies.hpp"

namespace hilo::test::body_arms_test {

TEST(BodyArms, AreTheSameWhereMomentsAreEqualButForRounding) {
  const Mat3 turned = Eigen::AngleAxisd(0.7, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  for (const Vec3& moments : {Vec3(2, 2, 2), Vec3(3, 1, 1), Vec3(3, 3, 1), Vec3(3, 2, 1), Vec3(1, 0, 0)})
    for (const Mat3& R : {Mat3(Mat3::Identity()), turned}) {
      const Mat3 J = R * moments.asDiagonal() * R.transpose();
      Body body;
      body.mass = 1, body.size = 0.5, body.J = J;
      const auto arms = body_arms(body);
      Mat3 axes;
      for (int i = 0; i < 3; ++i) axes.col(i) = arms[1 + i] / 0.5;
      EXPECT_NEAR(axes.determinant(), 1, 1e-12);
      EXPECT_LT((axes.transpose() * J * axes - Mat3(moments.asDiagonal())).norm(), 1e-12) << moments.transpose();
      for (int k = 0; k < 20; ++k) {
        const Mat3 noise = 1e-14 * Mat3::Random();
        body.J = J + noise + noise.transpose();
        for (int i = 0; i < 3; ++i) EXPECT_LT((body_arms(body)[1 + i] / 0.5 - axes.col(i)).norm(), 1e-9) << moments.transpose();
      }
    }
}

}  // namespace hilo::test::body_arms_test
