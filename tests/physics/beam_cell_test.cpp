// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel of beams: against measures and gradients of connectors, which joints have too, against differences of its own force, and in
// lanes.
#include "physics/beam_cell.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "physics/beam_arc.hpp"
#include "physics/solid_kernel.hpp"

namespace hilo {
void arc_lanes2(const ArcCall&);
void arc_lanes4(const ArcCall&);
void arc_lanes8(const ArcCall&);
}  // namespace hilo

namespace hilo::test::beam_cell_test {
namespace {

using Poses = std::array<double, 24>;

Poses poses(const Config& q) {
  Poses out;
  for (int e = 0; e < 2; ++e) {
    std::copy_n(q.c[e].data(), 3, out.data() + 12 * e);
    std::copy_n(q.R[e].data(), 9, out.data() + 12 * e + 3);
  }
  return out;
}

Config sum(double f, const Config& a, double g, const Config& b) {
  Config out = a;
  for (int e = 0; e < 2; ++e) out.c[e] = f * a.c[e] + g * b.c[e], out.R[e] = f * a.R[e] + g * b.R[e];
  return out;
}

/// Two bodies with a curved and twisted cell between points of theirs, at the start and the end of a step.
struct Step {
  std::mt19937 random;
  Config q0, q1;
  Connector ends;
  arc::ArcCell<double> cell{};
  Vec3 vector(double size) {
    std::uniform_real_distribution<double> u(-size, size);
    return Vec3(u(random), u(random), u(random));
  }
  /// So far may the sections turn against each other at the start, and in the step [rad].
  Step(int seed, double bent, double turned) : random(static_cast<unsigned>(seed)) {
    Config rest;
    for (int e = 0; e < 2; ++e) rest.c.push_back(vector(0.2) + Vec3(0.5 * e, 0, 0)), rest.R.push_back(cayley(vector(1)));
    std::array<Vec3, 2> at{vector(0.1), vector(0.1) + Vec3(0.1, 0.2, 0.9)};
    std::array<Mat3, 2> frame{cayley(vector(0.1)), cayley(vector(0.3))};
    ends.join({0, -1}, {1, -1}, rest, at[1], frame[1]);
    add_arc_measures(ends, rest, at[0], frame[0], at[1], frame[1]);
    for (int e = 0; e < 2; ++e) {
      const Vec3 arm = rest.R[e].transpose() * (at[e] - rest.c[e]);
      const Mat3 axes = rest.R[e].transpose() * frame[e];
      std::copy_n(arm.data(), 3, cell.arm[e].v);
      for (int i = 0; i < 3; ++i) std::copy_n(axes.data() + 3 * i, 3, cell.axis[e][i].v);
    }
    Mat6 C = Mat6::Identity() * 3 + 0.2 * Mat6::Random();
    C = (C + C.transpose()).eval();
    cell.law = arc_stiffness(measures(rest), {C, C, C, C}, {seed % 2 == 0, vector(1), 0.4});
    Eigen::Matrix4d M = Eigen::Matrix4d::Random();
    M = (M + M.transpose()).eval();
    std::copy_n(M.data(), 16, &cell.linked[0][0]);
    cell.across[0] = 0.3, cell.across[1] = 0.2, cell.across[2] = 0.05, cell.alpha = 0.7, cell.beta = 0.02;
    const auto moved = [&](const Config& from, double turn) {
      Config q = from;
      const Mat3 both = cayley(vector(1));
      for (int e = 0; e < 2; ++e) q.c[e] = both * from.c[e] + vector(0.1 * turn), q.R[e] = both * cayley(vector(turn)) * from.R[e];
      return q;
    };
    q0 = moved(rest, bent), q1 = moved(q0, turned);
  }
  arc::Measures<double> measures(const Config& q) const {
    const auto e = ends.values(q);
    return {{e[0], e[1], e[2]}, e[3], {e[4], e[5], e[6]}};
  }
};

struct Found {
  Vec6 f[2];
  Eigen::Matrix<double, 12, 12> K;
  Eigen::Matrix<double, 12, 1> all() const { return (Eigen::Matrix<double, 12, 1>() << f[0], f[1]).finished(); }
};

/// A stage with every term: rates of the points are those of the step.
struct Stages {
  double h = 0.3, mass_slope = 2 / (h * h), weight = 0.5;
  bool mean = false, rates_apart = false, inertia = true;
  Poses left, end, start, a, v, w0, w1;
  ArcCall call(const Step& step, const Config& q1) {
    left = poses(sum(0.5, step.q0, 0.5, q1)), start = poses(step.q0), end = poses(q1);
    a = poses(sum(-mass_slope, step.q0, mass_slope, q1)), v = poses(sum(-1 / h, step.q0, 1 / h, q1));
    if (!inertia) a.fill(0), v.fill(0);
    w0 = poses(sum(0.8, step.q0, 0.2, q1)), w1 = poses(sum(0.3, step.q0, 0.7, q1));
    ArcCall call{};
    call.cells = reinterpret_cast<const double*>(&step.cell);
    call.left = left.data(), call.end = end.data(), call.a = a.data(), call.v = v.data();
    call.slope = 0.5, call.mass_slope = inertia ? mass_slope : 0, call.alpha_slope = inertia ? 1 / h : 0;
    if (inertia) call.gravity[2] = -9.81;
    ArcCall::Pair first{.q0 = start.data(), .q1 = end.data(), .elastic = 1, .kappa = 0.1};
    first.mean = mean, first.weight = weight;
    if (mean) first.kappa = 0;
    call.pairs[call.n_pairs++] = first;
    if (rates_apart) {
      call.pairs[call.n_pairs++] = {.q0 = w0.data(), .q1 = w1.data(), .elastic = 0, .kappa = 0, .by_beta = 1 / h, .slope = 0.7};
      call.pairs[call.n_pairs++] = {
          .q0 = w1.data(), .q1 = w0.data(), .elastic = 0, .kappa = 0, .by_beta = -1 / h, .slope = 0.2, .acts = false};
    }
    return call;
  }
};

Found alone(Stages stages, const Step& step, const Config& q1) {
  ArcCall call = stages.call(step, q1);
  double f[12], scale2[4], K[144];
  call.f = f, call.scale2 = scale2, call.K = K;
  arc::run<double>(call);
  Found out;
  for (int e = 0; e < 2; ++e) out.f[e] = Eigen::Map<const Vec6>(f + 6 * e);
  out.K = Eigen::Map<const Eigen::Matrix<double, 12, 12, Eigen::RowMajor>>(K);
  return out;
}

/// Turns of a cell: little ones have few terms of the series, large ones the closed form, and one of each.
const std::pair<double, double> bent_and_turned[] = {{0.02, 0.02}, {0.1, 0.1}, {0.3, 0.3}, {0.8, 0.02},
                                                     {0.8, 1e-4},  {0.2, 1.0}, {1.0, 0.5}};

// Truth: forces along the measures of a connector, of which the discrete gradient is exact.
TEST(BeamCell, ForcesDoTheWorkOfTheStrains) {
  for (const auto& [bent, turned] : bent_and_turned)
    for (int seed = 1; seed < 5; ++seed) {
      const Step step(seed, bent, turned);
      const ArcLaw law(step.cell.law, 0);
      const auto e0 = step.ends.values(step.q0), e1 = step.ends.values(step.q1);
      Response r;
      law.elastic(e0, e1, r);
      double work = 0;
      for (int m = 0; m < ArcLaw::n_measures; ++m) work += r.s[m] * (e1[m] - e0[m]);
      const auto energy = [&](const Config& q) { return arc_energy(step.cell.law, arc_strain(step.measures(q))); };
      EXPECT_NEAR(r.energy, energy(step.q1), 1e-13);
      EXPECT_NEAR(work, energy(step.q1) - energy(step.q0), 2e-13 * (1 + energy(step.q1))) << bent << ' ' << turned << ' ' << seed;

      Stages stages;
      stages.inertia = false;
      ArcCall call = stages.call(step, step.q1);
      call.pairs[0].kappa = 0;
      double f[12], scale2[4];
      call.f = f, call.scale2 = scale2;
      arc::run<double>(call);
      ConnectorGradient g;
      gradient(step.ends, sum(0.5, step.q0, 0.5, step.q1), g);
      for (int i = 0; i < 12; ++i) {
        double want = 0;
        for (int m = 0; m < ArcLaw::n_measures; ++m) want += r.s[m] * g.G(m, i);
        EXPECT_NEAR(f[i], want, 1e-12) << i;
      }
    }
}

// Truth: central differences, of an error of 1e-10 of the tangent (h^2 of third derivatives, round-off divided by h).
TEST(BeamCell, TangentIsTheSlopeOfTheForce) {
  for (const auto& [bent, turned] : bent_and_turned)
    for (int kind = 0; kind < 3; ++kind) {
      Stages stages;
      stages.mean = kind == 1, stages.weight = kind == 1 ? 0.7 : 0.5, stages.rates_apart = kind == 2;
      const Step step(10 + kind, bent, turned);
      const Found at = alone(stages, step, step.q1);
      for (int j = 0; j < 12; ++j) {
        constexpr double h = 1e-5;
        const auto moved = [&](double by) {
          Config q = step.q1;
          const int e = j / 6;
          Vec3 d = Vec3::Zero();
          d[j % 3] = by;
          if (j % 6 < 3)
            q.c[e] += d;
          else
            q.R[e] = cayley(d) * q.R[e];
          return alone(stages, step, q).all();
        };
        const Eigen::Matrix<double, 12, 1> slope = (moved(h) - moved(-h)) / (2 * h);
        EXPECT_LT((slope - at.K.col(j)).cwiseAbs().maxCoeff(), 2e-8 * at.K.cwiseAbs().maxCoeff())
            << "column " << j << ", kind " << kind << ", turns " << bent << ' ' << turned;
      }
    }
}

// Truth: lanes hold different cells and do not touch each other; only the order of rounding may differ, and the number of terms.
TEST(BeamCell, EveryLaneIsTheCellAlone) {
  for (const auto& [width, function] : {std::pair{2, &arc_lanes2}, {4, &arc_lanes4}, {8, &arc_lanes8}}) {
    if (width > lanes()) continue;
    struct alignas(64) Block {
      double v[8];
    };
    constexpr size_t n_cell = sizeof(arc::ArcCell<double>) / sizeof(double);
    std::vector<Block> cells(n_cell), left(24), end(24), start(24), a(24), v(24), w0(24), w1(24), f(12), scale2(4), K(144);
    const auto lane_of = [](std::vector<Block>& b) { return b.front().v; };
    std::vector<Found> want;
    ArcCall call{};
    Stages stages;
    stages.rates_apart = true;
    for (int l = 0; l < width; ++l) {
      const auto& [bent, turned] = bent_and_turned[l % 7];
      const Step step(20 + l, bent, turned);
      want.push_back(alone(stages, step, step.q1));
      call = stages.call(step, step.q1);
      const auto put = [&](const double* from, size_t n, std::vector<Block>& to) {
        for (size_t i = 0; i < n; ++i) lane_of(to)[i * width + l] = from[i];
      };
      put(call.cells, n_cell, cells), put(stages.left.data(), 24, left), put(stages.end.data(), 24, end),
          put(stages.start.data(), 24, start);
      put(stages.a.data(), 24, a), put(stages.v.data(), 24, v), put(stages.w0.data(), 24, w0), put(stages.w1.data(), 24, w1);
    }
    call.cells = lane_of(cells), call.left = lane_of(left), call.end = lane_of(end), call.a = lane_of(a), call.v = lane_of(v);
    call.pairs[0].q0 = lane_of(start), call.pairs[0].q1 = lane_of(end);
    call.pairs[1].q0 = call.pairs[2].q1 = lane_of(w0), call.pairs[1].q1 = call.pairs[2].q0 = lane_of(w1);
    call.f = lane_of(f), call.scale2 = lane_of(scale2), call.K = lane_of(K);
    function(call);
    for (int l = 0; l < width; ++l) {
      const double size = want[l].K.cwiseAbs().maxCoeff();
      for (int i = 0; i < 12; ++i) {
        EXPECT_NEAR(lane_of(f)[i * width + l], want[l].all()[i], 1e-13 * size) << "lane " << l << " of " << width;
        for (int j = 0; j < 12; ++j)
          EXPECT_NEAR(lane_of(K)[(12 * i + j) * width + l], want[l].K(i, j), 1e-12 * size) << "lane " << l << " of " << width;
      }
    }
  }
}

}  // namespace
}  // namespace hilo::test::beam_cell_test
