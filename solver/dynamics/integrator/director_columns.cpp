#include "dynamics/integrator/director_columns.hpp"

#include <Eigen/LU>

namespace hilo {
namespace {

using Mat9 = Eigen::Matrix<double, 9, 9>;
using Vec9 = Eigen::Matrix<double, 9, 1>;

std::array<Mat3, 3> make_bases() {
  Mat3 signs = Mat3::Zero(), cycle = Mat3::Zero();
  signs.diagonal() << 1, -1, 0;
  cycle(0, 2) = cycle(1, 0) = cycle(2, 1) = 1;
  return {Mat3::Identity(), signs, cycle};
}

}  // namespace

const std::array<Mat3, 3> director_bases = make_bases();

DirectorSums director_sums(const std::array<Mat3, 3>& N) {
  static const Mat9 inverse = [] {
    Mat9 B;
    for (int a = 0; a < 3; ++a)
      for (int k = 0; k < 3; ++k) {
        const Mat3 S = skew(Vec3::Unit(k)) * director_bases[a];
        B.col(3 * a + k) = Eigen::Map<const Vec9>(S.data());
      }
    return Mat9(B.inverse());
  }();
  DirectorSums out;
  for (int c = 0; c < 3; ++c) {
    const Vec9 factors = inverse * Eigen::Map<const Vec9>(N[c].data());
    for (int a = 0; a < 3; ++a) out[a].col(c) = factors.segment<3>(3 * a);
  }
  return out;
}

void DirectorColumns::add(int clique, const double* K) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto blocks = system_.cliques[clique];
  const int n = static_cast<int>(blocks.size()), width = 3 * n, first_joint = system_.first_joint_block();
  const Eigen::Map<const Rows> from(K, width, width);
  const double scale = sigma_ / sigma_here_;
  for (int j = 0; j < n_stages; ++j) {
    part_.assign(static_cast<size_t>(width) * width, 0.0);
    Eigen::Map<Rows> to(part_.data(), width, width);
    for (int k = 0; k < n; ++k) {
      const int block = blocks[k];
      if (block >= first_joint) {
        if (with_multipliers_ && j == row_) to.middleCols<3>(3 * k) = scale * from.middleCols<3>(3 * k);
      } else if (block >= 0 && body_of_[block] >= 0) {
        to.middleCols<3>(3 * k) = from.middleCols<3>(3 * k) * (*change_.directors[j])[body_of_[block]][base_];
      } else if (block >= 0 && base_ == 0) {
        to.middleCols<3>(3 * k) = change_.factor[j] * from.middleCols<3>(3 * k);
      }
      if (block < first_joint)
        for (int r = 0; r < n; ++r)
          if (blocks[r] >= first_joint) to.block<3, 3>(3 * r, 3 * k) *= scale;
    }
    whole_.add_part(clique, n * row_, n * j, n, part_.data());
  }
}

}  // namespace hilo
