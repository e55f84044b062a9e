#include "physics/stretch.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "physics/shape/hex20r.hpp"
#include "physics/shape/tet10.hpp"
#include "physics/shape/wedge15.hpp"
#include "physics/solid.hpp"

namespace hilo {
namespace {

template <class S>
double least_of(std::span<const Vec3> X, std::span<const Vec3> x, double floor) {
  double least = 1e300;
  for (int p = 0; p < S::n_points; ++p) {
    double g[S::n][3], F_[3][3];
    solid::point_gradients<S>(p, X[0].data(), g);
    solid::gradient<S::n>(x[0].data(), g, F_);
    Mat3 F;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) F(i, j) = F_[i][j];
    const Mat3 C = F.transpose() * F;
    double bound = 1e300;  // Gershgorin's circles
    for (int i = 0; i < 3; ++i) bound = std::min(bound, 2 * C(i, i) - C.row(i).cwiseAbs().sum());
    if (bound > floor * floor) continue;
    least = std::min(least, std::max(0.0, Eigen::SelfAdjointEigenSolver<Mat3>(C, Eigen::EigenvaluesOnly).eigenvalues()[0]));
  }
  return std::sqrt(least);
}

}  // namespace

double least_stretch(Shape shape, std::span<const Vec3> X, std::span<const Vec3> x, double floor) {
  switch (shape) {
    case Shape::tet4:
      return least_of<Tet4>(X, x, floor);
    case Shape::tet10:
      return least_of<Tet10>(X, x, floor);
    case Shape::wedge6:
      return least_of<Wedge6>(X, x, floor);
    case Shape::wedge15:
      return least_of<Wedge15>(X, x, floor);
    case Shape::hex8:
      return least_of<Hex8>(X, x, floor);
    case Shape::hex20:
      return least_of<Hex20>(X, x, floor);
    case Shape::hex20r:
      return least_of<Hex20R>(X, x, floor);
    case Shape::bar2:
      return (x[1] - x[0]).norm() / (X[1] - X[0]).norm();
  }
  return 1;
}

}  // namespace hilo
