// SPDX-License-Identifier: GPL-3.0-or-later
// The serial solver's factors: what they are chosen for, and what happens where they do not suit.
#include <gtest/gtest.h>

#include "problem.hpp"

namespace hilo {
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

TEST(Light, ChoosesItsFactorsBySize) {
  EXPECT_EQ(Light(elastic_bar(6, 2, 2, 20)).solver->name(), "light (KLU)");
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
  p.n_dense = 0, p.common.clear(), p.X.resize(3 * static_cast<size_t>(p.n_flexible));
  for (auto& list : p.cliques)
    for (auto& i : list) i = i >= p.n_flexible ? -1 : i;
  Light light(std::move(p), "cholesky");
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
  Light light(std::move(p), "cholesky");
  testing::internal::CaptureStderr();
  EXPECT_LT(light.solve(1), 1e-9);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("unsymmetric factors"), std::string::npos);
  EXPECT_TRUE(light.report.ok) << light.report.message;
  EXPECT_EQ(light.solver->name(), "light (UMFPACK)");
  EXPECT_LT(light.solve(1.5), 1e-9);
}

}  // namespace
}  // namespace hilo
