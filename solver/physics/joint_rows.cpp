#include "physics/joint_rows.hpp"

#include <utility>

namespace hilo {

SumRows::SumRows(int n_plain, std::vector<std::vector<Part>> sums) : n_plain_(n_plain), sums_(std::move(sums)) {}

void SumRows::values(const Values& e, double* g) const {
  for (int r = 0; r < n_plain_; ++r) g[r] = e[r];
  for (size_t k = 0; k < sums_.size(); ++k) {
    double& sum = g[n_plain_ + k];
    sum = 0;
    for (const Part& p : sums_[k]) sum += p.weight * (p.angle ? turn_[p.measure].unwrap(e[p.measure], e[p.measure + 1]) : e[p.measure]);
  }
}

void SumRows::gradient(const Values& e0, const Values& e1, Gradient& out) const {
  out = {};
  for (int r = 0; r < n_plain_; ++r) out.d[r][r] = 1;
  for (size_t k = 0; k < sums_.size(); ++k) {
    auto& d = out.d[n_plain_ + k];
    auto& D = out.D[n_plain_ + k];
    for (const Part& p : sums_[k]) {
      if (!p.angle) {
        d[p.measure] += p.weight;
        continue;
      }
      const Turn::Gradient g = turn_[p.measure].gradient(&e0[p.measure], &e1[p.measure]);
      for (int i = 0; i < 2; ++i) {
        d[p.measure + i] += p.weight * g.d[i];
        for (int j = 0; j < 2; ++j) D[p.measure + i][p.measure + j] += p.weight * g.D[i][j];
      }
    }
  }
}

void SumRows::commit(const Values& e) {
  for (const auto& sum : sums_)
    for (const Part& p : sum)
      if (p.angle) turn_[p.measure].committed = turn_[p.measure].unwrap(e[p.measure], e[p.measure + 1]);
}

}  // namespace hilo
