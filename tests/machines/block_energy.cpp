// SPDX-License-Identifier: GPL-3.0-or-later
#include "machines/block_energy.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "physics/hourglass.hpp"
#include "physics/shape/hex20.hpp"
#include "physics/shape/hex8.hpp"
#include "physics/shape/tet10.hpp"
#include "physics/shape/tet4.hpp"
#include "physics/shape/wedge15.hpp"
#include "physics/shape/wedge6.hpp"

namespace hilo::test {
namespace {

/// Strain of a displacement gradient H = F - I, and det C - 1 = 2 tr E + 4 tr cof E + 8 det E, without the loss of digits that F and
/// det F would bring where strains are small.
struct Strain {
  Mat3 E;
  double swelling;
  explicit Strain(const Mat3& H) : E((H + H.transpose() + H.transpose() * H) / 2) {
    swelling = 2 * E.trace() + 2 * (E.trace() * E.trace() - E.squaredNorm()) + 8 * E.determinant();
  }
};

/// St. Venant-Kirchhoff or compressible neo-Hookean energy [J/m^3].
double density(bool neo_hookean, double mu, double lambda, const Strain& s) {
  const double log_J = std::log1p(s.swelling) / 2, trace = s.E.trace();
  return neo_hookean ? mu * (trace - log_J) + lambda / 2 * log_J * log_J : lambda / 2 * trace * trace + mu * s.E.squaredNorm();
}

/// Poisson's ratio above which the rest of lambda acts on the cell's mean dilatation (docs/elements.md); shapes of one point have no other.
template <class S>
double pointwise_nu() {
  return S::n == 4 || S::n == 8 ? 0.5 : S::n == 10 || S::n == 6 ? 0.40 : 0.45;
}

template <class S>
void add_cell(const MachineBlock& block, const Vec3* X, const Vec3* x, const Vec3* v, const Vec3& gravity, BlockEnergy& out) {
  using Nodal = Eigen::Matrix<double, 3, S::n>;
  Nodal at, now, speed;
  for (int a = 0; a < S::n; ++a) at.col(a) = X[a], now.col(a) = x[a], speed.col(a) = v[a];
  const auto gradients = [&](const double(*dN)[3], double& det) {  // dN/dX (n x 3)
    const Eigen::Matrix<double, S::n, 3> g = Eigen::Map<const Eigen::Matrix<double, S::n, 3, Eigen::RowMajor>>(&dN[0][0]);
    const Mat3 J = at * g;
    det = J.determinant();
    return Eigen::Matrix<double, S::n, 3>(g * J.inverse());
  };
  const auto mass_rule = S::mass_rule();
  for (int p = 0; p < S::n_mass_points; ++p) {
    double N[S::n], dN[S::n][3], det = 0;
    S::values(mass_rule.xi[p], N), S::gradients(mass_rule.xi[p], dN);
    gradients(dN, det);
    const Eigen::Map<const Eigen::Matrix<double, S::n, 1>> weight(N);
    const Vec3 place = now * weight, velocity = speed * weight;
    const double m = mass_rule.w[p] * det * block.density;
    out.mass += m, out.first_moment += m * place, out.momentum += m * velocity, out.angular += m * place.cross(velocity);
    out.kinetic += m / 2 * velocity.squaredNorm(), out.gravity -= m * gravity.dot(place);
  }
  const double mu = block.E / (2 * (1 + block.nu)), lambda = block.E * block.nu / ((1 + block.nu) * (1 - 2 * block.nu));
  const double nu = std::min(block.nu, pointwise_nu<S>()), at_points = block.nu > nu ? 2 * mu * nu / (1 - 2 * nu) : lambda;
  const auto rule = S::rule();
  double volume = 0, trace = 0, swelling = 0;  // the last two: integrals over the cell
  for (int p = 0; p < S::n_points; ++p) {
    double dN[S::n][3], det = 0;
    S::gradients(rule.xi[p], dN);
    const Mat3 H = (now - at) * gradients(dN, det);  // boxes: the gradients at the centre of a hexahedron are its mean ones
    const Strain strain(H);
    const double weight = rule.w[p] * det;
    out.least_det = std::min(out.least_det, (Mat3::Identity() + H).determinant());
    out.elastic += weight * density(block.neo_hookean, mu, at_points, strain);
    volume += weight, trace += weight * strain.E.trace(), swelling += weight * strain.swelling;
  }
  const double mean = block.neo_hookean ? std::log1p(swelling / volume) / 2 : trace / volume;
  out.elastic += volume * (lambda - at_points) / 2 * mean * mean;
  if constexpr (S::n == 8) {
    const Hourglass<double> hourglass(at.data(), Lame{lambda, mu});
    double u[3][3], h[4][3], b[4][3], t[4][3];
    hourglass.measure(now.data(), u, h, b);
    hourglass.conjugate(b, t);
    for (int r = 0; r < 4; ++r)
      for (int A = 0; A < 3; ++A) out.elastic += t[r][A] * b[r][A] / 2;
  }
}

}  // namespace

BlockEnergy block_energy(const MachineBlock& block, const Mesh& mesh, const std::vector<Vec3>& x, const std::vector<Vec3>& v,
                         const Vec3& gravity) {
  BlockEnergy out;
  for (std::int64_t c = 0; c < mesh.n_cells(); ++c) {
    Vec3 X[20], xc[20], vc[20];
    int n = 0;
    for (const auto node : mesh.cell(c)) X[n] = mesh.X[node], xc[n] = x[node], vc[n] = v[node], ++n;
    switch (block.shape) {
      case Shape::tet4:
        add_cell<Tet4>(block, X, xc, vc, gravity, out);
        break;
      case Shape::tet10:
        add_cell<Tet10>(block, X, xc, vc, gravity, out);
        break;
      case Shape::wedge6:
        add_cell<Wedge6>(block, X, xc, vc, gravity, out);
        break;
      case Shape::wedge15:
        add_cell<Wedge15>(block, X, xc, vc, gravity, out);
        break;
      case Shape::hex8:
        add_cell<Hex8>(block, X, xc, vc, gravity, out);
        break;
      default:
        add_cell<Hex20>(block, X, xc, vc, gravity, out);
    }
  }
  return out;
}

}  // namespace hilo::test
