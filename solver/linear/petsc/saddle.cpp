// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/petsc/saddle.hpp"

#include <fmt/format.h>

#include "base/error.hpp"

namespace hilo::petsc {
namespace {

/// Z is kept up to so many values per rank (320 MB); beyond, F~ is applied a second time per iteration.  In double precision: where a body
/// hangs on stiff parts and little else, the forces of its motions cancel.
constexpr double values_kept = 4e7;
/// Columns of Z that go through F~ together, which reads its factors once for them.
constexpr Eigen::Index columns_at_once = 24;
/// Dense unknowns that may touch flexible nodes: the dense matrix of them takes 288 MB, on every rank.
constexpr Eigen::Index most_columns = 6000;

void sum(std::span<double> values) {
  if (!values.empty()) comm().sum(values);
}

}  // namespace

Saddle::Saddle(const Cliques& cliques, const BlockMap& map, const SharedBlocks& shared, Flexible flexible)
    : cliques_(cliques),
      matrix_(std::move(flexible.matrix)),
      inverse_(std::move(flexible.inverse)),
      coupling_(cliques, map, shared),
      m_(coupling_.m()) {
  for (int e = 0; e < cliques.size(); ++e) touches_dense_.push_back(coupling_.couples(cliques[e]));
  n_flexible_ = 3 * static_cast<size_t>(matrix_->n_owned());
  n_all_ = 3 * static_cast<size_t>(shared.n_owned());
  f_ = Vector(static_cast<PetscInt>(n_flexible_)), u_ = Vector(static_cast<PetscInt>(n_flexible_));
  p_.assign(m_, 0.0), q_.assign(m_, 0.0);
}

void Saddle::add(int clique, const double* K) {
  matrix_->add(clique, cliques_[clique], K);
  if (touches_dense_[clique]) coupling_.add(cliques_[clique], K);
}

void Saddle::add_diagonal(int block, const double d[3]) {
  if (coupling_.is_dense(block))
    coupling_.add_diagonal(block, d);
  else
    matrix_->add_diagonal(block, d);
}

SolveReport Saddle::set_up() {
  if (!inverse_->set_up()) return {.ok = false, .residual = 1, .message = "the flexible block is singular", .is_singular = true};
  if (factor_schur()) return {};
  return inverse_->has_failed() ? SolveReport::failed(inverse_->name() + " does not converge")
                                : SolveReport::singular(" (bodies and joints)");
}

/// Z = F~^-1 B and S = D - C Z.  False when S is singular.
bool Saddle::factor_schur() {
  if (m_ == 0) return true;
  const auto& columns = coupling_.columns();
  const auto n_columns = static_cast<Eigen::Index>(columns.size()), n = static_cast<Eigen::Index>(n_flexible_);
  keep_ = comm().max(static_cast<double>(n_columns) * static_cast<double>(n)) <= values_kept;
  Z_.resize(n, keep_ ? n_columns : std::min(n_columns, columns_at_once));
  if (n_columns > most_columns)
    throw Error("", fmt::format("{} unknowns of bodies and joints touch flexible nodes: too many for this solver", n_columns),
                "solver.kind = \"direct\"", Exit::resources);
  Eigen::MatrixXd of_touched(n_columns, n_columns);  // C touches no other rows
  std::vector<double> change(m_);
  for (Eigen::Index k = 0; k < n_columns; k += columns_at_once) {
    const auto some = std::min(columns_at_once, n_columns - k);
    auto Z = Z_.middleCols(keep_ ? k : 0, some);
    for (Eigen::Index j = 0; j < some; ++j) coupling_.column(columns[k + j], Z.col(j).data(), n_flexible_);
    inverse_->apply(Z);
    if (inverse_->has_failed()) return false;
    for (Eigen::Index j = 0; j < some; ++j) {
      std::fill(change.begin(), change.end(), 0.0);
      coupling_.add_C(-1, Z.col(j).data(), change.data());
      for (Eigen::Index i = 0; i < n_columns; ++i) of_touched(i, k + j) = change[columns[i]];
    }
  }
  if (!keep_) Z_.resize(0, 0);
  sum({of_touched.data(), static_cast<size_t>(of_touched.size())});
  return schur_.factor(coupling_, columns, of_touched);
}

/// The dense part of a vector, from the end of the last rank's unknowns to all.
void Saddle::get_dense(const double* x) {
  if (m_ == 0) return;
  if (n_all_ > n_flexible_) std::copy_n(x + n_flexible_, m_, p_.begin());
  comm().copy(std::span(p_.data(), static_cast<size_t>(m_)), size() - 1);
}

void Saddle::multiply(Vec x, Vec y) {
  const double* in;
  check(VecGetArrayRead(x, &in));
  const Values out(y);
  get_dense(in);
  check(VecPlaceArray(f_, in)), check(VecPlaceArray(u_, out.data()));
  check(MatMult(matrix_->mat(), f_, u_));
  check(VecResetArray(f_)), check(VecResetArray(u_));
  if (m_ > 0) {
    coupling_.add_B(1, p_.data(), out.data());
    std::fill(q_.begin(), q_.end(), 0.0);
    coupling_.add_C(1, in, q_.data());
    sum(q_);
    if (n_all_ > n_flexible_) {
      coupling_.add_D(p_.data(), q_.data());
      std::copy_n(q_.data(), m_, out.data() + n_flexible_);
    }
  }
  check(VecRestoreArrayRead(x, &in));
}

void Saddle::precondition(Vec x, Vec y) {
  const double* in;
  check(VecGetArrayRead(x, &in));
  {
    const Values out(y);
    std::copy_n(in, n_flexible_, out.data());
    inverse_->apply(Eigen::Map<Eigen::MatrixXd>(out.data(), static_cast<Eigen::Index>(n_flexible_), 1));
    if (m_ > 0) {
      get_dense(in);
      std::fill(q_.begin(), q_.end(), 0.0);
      coupling_.add_C(1, out.data(), q_.data());
      sum(q_);
      for (int i = 0; i < m_; ++i) p_[i] -= q_[i];
      schur_.solve(p_.data());
      subtract_Z(out.data());
      if (n_all_ > n_flexible_) std::copy_n(p_.begin(), m_, out.data() + n_flexible_);
    }
  }
  check(VecRestoreArrayRead(x, &in));
}

/// u -= Z p.
void Saddle::subtract_Z(double* u) {
  const auto& columns = coupling_.columns();
  if (columns.empty()) return;
  const auto n = static_cast<Eigen::Index>(n_flexible_);
  if (keep_) {
    Eigen::VectorXd p(Z_.cols());
    for (Eigen::Index k = 0; k < p.size(); ++k) p[k] = p_[columns[k]];
    Eigen::Map<Eigen::VectorXd>(u, n).noalias() -= Z_ * p;
    return;
  }
  Eigen::MatrixXd w = Eigen::MatrixXd::Zero(n, 1);
  coupling_.add_B(1, p_.data(), w.data());
  inverse_->apply(w);
  Eigen::Map<Eigen::VectorXd>(u, n) -= w;
}

}  // namespace hilo::petsc
