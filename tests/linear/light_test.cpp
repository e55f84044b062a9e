// SPDX-License-Identifier: GPL-3.0-or-later
// The serial solver's factors: what they are chosen for, and what happens where they do not suit.
#include <gtest/gtest.h>

#include <functional>

#include "problem.hpp"

namespace hilo::test::light_test {
namespace {

using test::elastic_bar;
using test::Problem;
using test::random_vector;
using test::Share;

struct Light {
  Problem p;
  Share share{p, 0, 1};
  std::unique_ptr<KktSolver> solver = make_light_solver();
  SolveReport report;

  explicit Light(Problem problem, const std::string& kind = "light") : p(std::move(problem)), solver(make_light_solver(kind)) {
    solver->structure(share.cliques, share.map);
  }
  /// Of `factor` times the matrix; the residual of the whole in the Euclidean norm.
  double solve(double factor, double tolerance = 0) {
    const Eigen::VectorXd b = random_vector(p.size(), 3);
    std::vector<double> x(3 * share.map.global.size());
    share.fill(p, *solver, 0, 1, factor);
    report = solver->solve(share.of(b), x, tolerance);
    Eigen::VectorXd whole(p.size());
    for (int g = 0; g < p.n_blocks(); ++g)
      for (int c = 0; c < 3; ++c) whole[3 * g + c] = x[3 * static_cast<size_t>(share.local[g]) + c];
    return (factor * (assembled(p) * whole) - b).norm() / b.norm();
  }
};

/// Without the blocks from `first` on.
Problem cut(Problem p, int first) {
  p.n_dense = first - p.n_flexible, p.common.clear(), p.X.resize(3 * static_cast<size_t>(first));
  for (auto& list : p.cliques)
    for (auto& i : list) i = i >= first ? -1 : i;
  return p;
}

TEST(Light, ChoosesItsFactorsByTheirWork) {
  EXPECT_EQ(Light(elastic_bar(6, 2, 2, 20)).solver->name(), "light (KLU)");
  EXPECT_EQ(Light(elastic_bar(6, 6, 5, 20)).solver->name(), "light (CHOLMOD)") << "small, but of a compact mesh";
  EXPECT_EQ(Light(elastic_bar(30, 4, 4, 20)).solver->name(), "light (CHOLMOD)");
}

TEST(Light, EveryKindSolvesTheBarWithBodiesAndJoints) {
  for (const char* kind : {"klu", "cholesky", "umfpack"}) {
    Light light(elastic_bar(16, 4, 4, 30), kind);
    EXPECT_LT(light.solve(1), 1e-9) << kind;
    EXPECT_TRUE(light.report.ok) << kind << light.report.message;
  }
}

TEST(Light, FactorsOfOneMatrixServeTheNext) {
  Light light(elastic_bar(16, 4, 4, 30), "cholesky");
  light.solve(1);
  const int fresh = light.report.iterations;
  EXPECT_LE(fresh, 4);  // single precision: about six digits an iteration
  for (const double factor : {1.05, 1.1, 0.9}) {
    EXPECT_LT(light.solve(factor), 1e-9);
    EXPECT_LE(light.report.iterations, fresh + 3);
  }
  for (const double factor : {1e3, 1e-3}) EXPECT_LT(light.solve(factor), 1e-9);
}

TEST(Light, StopsAtTheToleranceAskedFor) {
  Light light(elastic_bar(16, 4, 4, 30), "cholesky");
  light.solve(1);
  light.p.matrix = [matrix = light.p.matrix](int e) {  // a matrix that its factors are not of
    test::Matrix K = matrix(e);
    if (e % 2 && K.rows() >= 12) K *= 2;
    return K;
  };
  const double loose = light.solve(1, 1e-3);
  const int few = light.report.iterations;
  EXPECT_LT(loose, 1e-2);
  EXPECT_LT(light.solve(1), 1e-9);
  EXPECT_LT(few, light.report.iterations);
}

TEST(Light, CholeskyFactorsAnewWhereTheOldFactorsDoNotServe) {
  Light light(elastic_bar(16, 4, 4, 30), "cholesky");
  for (const double jump : {1., 1e4, 1e-4, 1.}) {
    light.p.matrix = [matrix = elastic_bar(16, 4, 4, 30).matrix, jump](int e) {
      const test::Matrix K = matrix(e);
      return test::Matrix(e % 2 && K.rows() >= 12 ? jump * K : K);
    };
    EXPECT_LT(light.solve(1), 1e-9) << jump;
    EXPECT_EQ(light.solver->name(), "light (CHOLMOD)") << jump;
  }
}

TEST(Light, IllConditionedBarIsSolvedInDoublePrecision) {
  Problem p = elastic_bar(3000, 1, 1, 1e9);  // bends 1e12 times softer than a cell
  const int n = p.n_flexible;
  Light light(cut(std::move(p), n), "cholesky");
  light.solve(1);
  light.solve(1);  // single precision takes an iteration a digit and more
  EXPECT_TRUE(light.report.ok) << light.report.message;
  EXPECT_LE(light.report.iterations, 5);
  EXPECT_EQ(light.solver->name(), "light (CHOLMOD)");
}

TEST(Light, GoesOnWithUnsymmetricFactorsWhereTheMatrixIsIndefinite) {
  Problem p = elastic_bar(12, 4, 4, 20);
  p.matrix = [matrix = p.matrix](int e) {
    test::Matrix K = matrix(e);
    if (K.rows() >= 12) K.diagonal().array() -= 0.3;
    return K;
  };
  const int n = p.n_flexible;
  for (const bool has_rows : {false, true}) {  // these may hold what is free without them: that the factor fails says nothing then
    Light light(has_rows ? p : cut(p, n), "cholesky");
    testing::internal::CaptureStderr();
    EXPECT_LT(light.solve(1), 1e-9);
    const std::string told = testing::internal::GetCapturedStderr();
    EXPECT_EQ(told.find("the matrix is not positive definite; unsymmetric factors") == std::string::npos, has_rows) << told;
    EXPECT_TRUE(light.report.ok) << light.report.message;
    EXPECT_EQ(light.solver->name(), "light (UMFPACK)");
    EXPECT_LT(light.solve(1.5), 1e-9);
  }
}

/// A bar with 17 nodes that one clique joins by this matrix (51 x 51).
Problem bar_with_joined(const std::function<test::Matrix()>& of_joined) {
  Problem p = elastic_bar(16, 6, 6, 1e3);
  const int n_cells = static_cast<int>(p.cliques.size()), n = p.n_flexible;
  p = cut(std::move(p), n);
  std::vector<int> joined;
  for (int i = 0; i < 17; ++i) joined.push_back(40 * i % p.n_flexible);
  p.cliques.push_back(joined), p.rank.push_back(0), p.everywhere.push_back(true);
  p.matrix = [matrix = p.matrix, n_cells, of_joined](int e) { return e < n_cells ? matrix(e) : of_joined(); };
  return p;
}

// The stiffness of 17 nodes that one clique joins, as pairs of facets do, comes and goes: where the factor keeps its end for it, neither
// new factors nor iterations are spent on it.  With that end left as it was, changes take up to twenty iterations and new factors.
TEST(Light, FactorsFollowWhatContactChanges) {
  double stiffness = 0;
  Problem p = bar_with_joined([&stiffness] {
    test::Matrix K = test::Matrix::Zero(51, 51);
    K.setConstant(-1 / 51.), K.diagonal().array() += 1;
    return test::Matrix(stiffness * K);
  });
  Light light(std::move(p), "cholesky");
  EXPECT_LT(light.solve(1), 1e-9);
  const int fresh = light.report.iterations;
  for (const double k : {10., 1e3}) {  // the first changes tell that they are worth it
    stiffness = k;
    EXPECT_LT(light.solve(1), 1e-9);
  }
  const double set_up = light.solver->set_up_seconds();
  for (const double k : {10., 1e-2, 0., 1e2}) {
    stiffness = k;
    EXPECT_LT(light.solve(1), 1e-9);
    EXPECT_LE(light.report.iterations, fresh + 2) << k;
    EXPECT_EQ(light.solver->set_up_seconds(), set_up) << k << ": new factors";
  }
}

// Nodes that one clique joins slide with friction: its matrix has no symmetry, and its symmetric part is indefinite.  The factor of the
// cells stays, and the end of it has an LU.
TEST(Light, FactorsServeWhatSlides) {
  double stiffness = 0;
  Problem p = bar_with_joined([&stiffness] {
    test::Matrix K = test::Matrix::Zero(51, 51);
    for (int i = 0; i < 17; ++i) K(3 * i + 2, 3 * i + 2) = stiffness, K(3 * i, 3 * i + 2) = 0.5 * stiffness;
    return K;
  });
  Light light(std::move(p), "cholesky");
  for (const double k : {1e3, 1e2, 1e4, 10., 0., 1e3}) {
    stiffness = k;
    EXPECT_LT(light.solve(1), 1e-8) << k;
    EXPECT_LE(light.report.iterations, 12) << k;
    EXPECT_EQ(light.solver->name(), "light (CHOLMOD)") << k;
  }
}

}  // namespace
}  // namespace hilo::test::light_test
