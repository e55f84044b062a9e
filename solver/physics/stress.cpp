// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/stress.hpp"

#include "base/error.hpp"
#include "physics/shape/from_outside.hpp"
#include "physics/stress_of_law.hpp"

namespace hilo {

double von_mises(const Vec6& s) {
  return std::sqrt(((s[0] - s[1]) * (s[0] - s[1]) + (s[1] - s[2]) * (s[1] - s[2]) + (s[2] - s[0]) * (s[2] - s[0])) / 2 +
                   3 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

Vec6 cauchy(const Mat3& F, const Vec6& s) {
  Mat3 S;
  S << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
  const Mat3 t = F * S * F.transpose() / F.determinant();
  Vec6 out;
  out << t(0, 0), t(1, 1), t(2, 2), t(1, 2), t(0, 2), t(0, 1);
  return out;
}

Vec6 bar_stress(const Material& material, std::span<const Vec3> X, std::span<const Vec3> x) {
  const Vec3 d0 = X[1] - X[0], d = x[1] - x[0];
  const double e = (d.squaredNorm() / d0.squaredNorm() - 1) / 2;
  const BarState bar = std::visit(
      [&]<class M>(const M& law) {
        if constexpr (std::is_same_v<M, LawFromOutside>)
          return law.functions->bar ? law.functions->bar(law.parameters.get(), e) : BarState{};
        else if constexpr (requires { law.bar(e); })
          return law.bar(e);
        else
          return BarState{};  // has no bars
      },
      material);
  const Vec3 n = d.normalized();
  const double s = bar.S * d.norm() / d0.norm() / bar.t;
  Vec6 out;
  out << s * n[0] * n[0], s * n[1] * n[1], s * n[2] * n[2], s * n[1] * n[2], s * n[0] * n[2], s * n[0] * n[1];
  return out;
}

void stress_points(Shape shape, const Material& material, std::span<const Vec3> X, std::span<const Vec3> x, StressPoints which,
                   std::vector<StressPoint>& out, const double* state) {
  if (const ShapeFunctions* other = shape_from_outside(shape)) {
    if (!other->stress_points(material, X, x, state, which, out))
      throw Error("", "a shape from outside the tree lacks a law", "add_shape<S, M>()", Exit::fault);
    return;
  }
  std::visit(
      [&]<class M>(const M& law) {
        if constexpr (std::is_same_v<M, LawFromOutside>)
          law.functions->stress_points(shape, law.parameters.get(), X, x, state, which, out);
        else
          stress::points_of_law(shape, law, X, x, state, which, out);
      },
      material);
}

void small_strain_points(Shape shape, const Material& material, std::span<const Vec3> X, std::span<const Vec3> x, StressPoints which,
                         std::vector<StressPoint>& out) {
  const bool done = shape == Shape::hex8 && std::visit(
                                                [&]<class M>(const M& law) {
                                                  if constexpr (std::is_same_v<M, LawFromOutside> || Remembers<M>)
                                                    return false;
                                                  else
                                                    return stress::hex8_points<true>(law, X, x, out), true;
                                                },
                                                material);
  if (done) return;
  constexpr double part = 1e-3;  // of the displacements: small, and far above round-off
  std::vector<Vec3> moved(X.size());
  std::vector<StressPoint> back;
  const auto at = [&](double share, std::vector<StressPoint>& to) {
    for (size_t a = 0; a < X.size(); ++a) moved[a] = X[a] + share * (x[a] - X[a]);
    stress_points(shape, material, X, moved, which, to);
  };
  at(-part, back), at(part, out);
  for (size_t k = 0; k < out.size(); ++k) out[k].S = (out[k].S - back[k].S) / (2 * part);
}

bool has_one_set_of_points(Shape shape, bool remembers) { return shape == Shape::hex8 || shape == shell8 || remembers; }

const Eigen::MatrixXd& to_nodes(Shape shape, size_t n_samples) {
  if (shape == shell8 && n_samples == Shell8Full::n_points) {
    static const Eigen::MatrixXd table = stress::samples_to_nodes<Shell8Full>();
    return table;
  }
  if (const ShapeFunctions* other = shape_from_outside(shape)) return other->to_nodes();
  static const Eigen::MatrixXd none;
  return *of_shape(shape, &none, []<class S>() {
    static const Eigen::MatrixXd table = stress::samples_to_nodes<S>();
    return &table;
  });
}

const Eigen::MatrixXd& shell_moments_to_nodes(size_t n_samples) {
  static const Eigen::MatrixXd full = stress::fitted<Shell8>(Shell8Full::rule(), true);
  return n_samples == Shell8Full::n_points ? full : to_nodes(shell8, n_samples);
}

void nodal_gradients(Shape shape, std::span<const Vec3> X, std::span<const Vec3> x, std::span<Mat3> F) {
  if (const ShapeFunctions* other = shape_from_outside(shape)) return other->nodal_gradients(X, x, F);
  of_shape(shape, false, [&]<class S>() {
    stress::gradients_at_nodes<S>(X, x, F);
    return true;
  });
}

}  // namespace hilo
