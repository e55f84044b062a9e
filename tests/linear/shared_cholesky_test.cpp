// SPDX-License-Identifier: GPL-3.0-or-later
// The factor that all ranks of one machine hold once: a block of elastic cubes, held at one face, against a dense factor.
#include "linear/shared_cholesky.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "../ranks.hpp"
#include "problem.hpp"

namespace hilo::test::shared_cholesky_test {
namespace {

using Eigen::MatrixXd;

/// nx x ny x nz cubes; nodes at x = 0 are held.
struct Cubes {
  Cliques cliques;
  int n_blocks = 0;
  test::Matrix K = test::cube_stiffness(0.1);
  Cubes(int nx, int ny, int nz) {
    const auto block = [&](int i, int j, int k) { return i == 0 ? -1 : ((i - 1) * (ny + 1) + j) * (nz + 1) + k; };
    n_blocks = nx * (ny + 1) * (nz + 1);
    for (int i = 0; i < nx; ++i)
      for (int j = 0; j < ny; ++j)
        for (int k = 0; k < nz; ++k)
          cliques.add(std::vector{block(i, j, k), block(i + 1, j, k), block(i + 1, j + 1, k), block(i, j + 1, k), block(i, j, k + 1),
                                  block(i + 1, j, k + 1), block(i + 1, j + 1, k + 1), block(i, j + 1, k + 1)});
  }
  MatrixXd whole() const {
    MatrixXd A = MatrixXd::Zero(3 * n_blocks, 3 * n_blocks);
    for (int e = 0; e < cliques.size(); ++e)
      for (int a = 0; a < 8; ++a)
        for (int b = 0; b < 8; ++b)
          if (cliques[e][a] >= 0 && cliques[e][b] >= 0) A.block<3, 3>(3 * cliques[e][a], 3 * cliques[e][b]) += K.block<3, 3>(3 * a, 3 * b);
    return A;
  }
  MatrixXd forces(int columns) const {
    MatrixXd F(3 * n_blocks, columns);
    for (int c = 0; c < columns; ++c) F.col(c) = test::random_vector(3 * n_blocks, 7 + static_cast<unsigned>(c));
    return F;
  }
  /// On rank 0, the others serving; empty on these, and where the factor breaks down.
  MatrixXd solved(int columns, bool single, const std::string& folder = "", double softer = 0) const {
    const Comm& comm = Comm::world();
    SharedCholesky factor(comm);
    if (comm.rank != 0) return factor.serve(), MatrixXd();
    factor.structure(cliques, n_blocks);
    for (int e = 0; e < cliques.size(); ++e) factor.add(e, K.data());
    const double d[3] = {0, -softer, 0};
    factor.add_diagonal(n_blocks / 2, d);
    double done = 0;
    const auto tell = [&](double part) {
      EXPECT_GE(part, done);
      done = part;
    };
    if (!factor.factor(single, folder, tell)) return MatrixXd();
    EXPECT_NEAR(done, 1, 1e-12);
    MatrixXd X = forces(columns);
    factor.solve(X);
    return X;
  }
};

class SharedFactor : public testing::Test {};

TEST_F(SharedFactor, SolvesAsADenseOne) {
  const Cubes cubes(9, 3, 4);
  const MatrixXd truth = cubes.whole().llt().solve(cubes.forces(30));
  EXPECT_LT((cubes.solved(30, false) - truth).norm(), 1e-11 * truth.norm());
  EXPECT_LT((cubes.solved(1, false) - truth.col(0)).norm(), 1e-11 * truth.col(0).norm());
  const double off = (cubes.solved(30, true) - truth).norm() / truth.norm();
  EXPECT_LT(off, 1e-4);
  EXPECT_GT(off, 1e-9) << "single precision";
}

TEST_F(SharedFactor, InAFileIsTheSameAndLeavesNothing) {
  const Cubes cubes(5, 2, 2);
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("hilo-factor-{}", getpid());
  std::filesystem::create_directory(folder);
  EXPECT_EQ(cubes.solved(3, false, folder.string()), cubes.solved(3, false));
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  std::filesystem::remove(folder);
}

TEST_F(SharedFactor, OfWhatIsNotPositiveFails) {
  const Cubes cubes(5, 2, 2);
  EXPECT_EQ(cubes.solved(2, false, "", 10).size(), 0);
  EXPECT_GT(cubes.solved(2, false, "", 0).size(), 0);
}

TEST_F(SharedFactor, SaysHowLargeItIsBeforehand) {
  const Cubes cubes(8, 2, 2);
  SharedCholesky factor(Comm::world());
  factor.structure(cubes.cliques, cubes.n_blocks);
  // a factor has entries wherever its matrix has some; in the order of the nodes a column reaches no farther than the next section
  const MatrixXd lower = cubes.whole().triangularView<Eigen::Lower>();
  const double n = 3 * cubes.n_blocks, width = 2 * 27;
  EXPECT_GE(factor.entries(), static_cast<double>((lower.array() != 0).count()));
  EXPECT_LE(factor.entries(), 2 * n * width);
}

/// Each rank count gives the bits of a rank on its own, which writes them down.
class DISABLED_SharedFactor : public testing::Test {};
TEST_F(DISABLED_SharedFactor, IsTheSameBitByBit) {
  for (const bool single : {false, true}) {
    const Cubes cubes(24, 3, 3);
    const MatrixXd X = cubes.solved(61, single);
    if (Comm::world().rank != 0) continue;
    const std::string name = fmt::format("bits-{}", int{single});
    if (Comm::world().size == 1) {
      std::ofstream(name, std::ios::binary).write(reinterpret_cast<const char*>(X.data()), static_cast<std::streamsize>(8 * X.size()));
      continue;
    }
    MatrixXd alone = MatrixXd::Zero(X.rows(), X.cols());
    std::ifstream(name, std::ios::binary).read(reinterpret_cast<char*>(alone.data()), static_cast<std::streamsize>(8 * alone.size()));
    EXPECT_EQ(X, alone);
  }
}
TEST(SharedFactorOnRanks, IsTheSameBitByBit) {
  const auto folder = std::filesystem::temp_directory_path() / fmt::format("hilo-ranks-{}", getpid());
  std::filesystem::create_directory(folder);
  for (const int ranks : {1, 2, 3}) test::expect_passes_on(ranks, "SharedFactor", folder.string());
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace hilo::test::shared_cholesky_test
