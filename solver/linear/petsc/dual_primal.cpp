// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/petsc/dual_primal.hpp"

#include <petscvec.h>

#include <algorithm>

namespace hilo::petsc {
namespace {

void scatter(VecScatter how, Vec from, Vec to, InsertMode mode, ScatterMode direction) {
  check(VecScatterBegin(how, from, to, mode, direction));
  check(VecScatterEnd(how, from, to, mode, direction));
}

}  // namespace

Eigen::MatrixXd DualPrimal::Piece::own(const MatrixXd& primal) const {
  MatrixXd x(static_cast<Eigen::Index>(number.size()), primal.cols());
  for (Eigen::Index k = 0; k < x.rows(); ++k) x.row(k) = primal.row(number[k]);
  return x;
}

DualPrimal::DualPrimal(const SubdomainMatrix& F)
    : F_(F), interface_(find_interface(F)), factor_(F, interface_), pieces_(interface_.n_pieces), g_(3 * F.n_owned()) {
  n_ = factor_.n(), n_interior_ = factor_.n_interior(), n_edge_ = n_ - n_interior_;
  for (size_t p = 0; p < pieces_.size(); ++p) {
    pieces_[p].from = factor_.begin(static_cast<int>(p)) - n_interior_;
    pieces_[p].n = factor_.begin(static_cast<int>(p) + 1) - factor_.begin(static_cast<int>(p));
  }
  make_scatters();
}

DualPrimal::~DualPrimal() {
  VecScatterDestroy(&all_), VecScatterDestroy(&edge_);
  VecDestroy(&local_), VecDestroy(&edge_local_);
}

void DualPrimal::make_scatters() {
  std::vector<PetscInt> index;
  for (PetscInt k = 0; k < F_.n_blocks(); ++k) index.push_back(F_.global(factor_.block(k)));
  const auto make = [&](PetscInt first, Vec* local, VecScatter* out) {
    IS from;
    const auto n = static_cast<PetscInt>(index.size()) - first;
    check(VecCreateSeq(PETSC_COMM_SELF, 3 * n, local));
    check(ISCreateBlock(PETSC_COMM_WORLD, 3, n, index.data() + first, PETSC_COPY_VALUES, &from));
    check(VecScatterCreate(g_, from, *local, nullptr, out));
    check(ISDestroy(&from));
  };
  make(0, &local_, &all_);
  make(n_interior_ / 3, &edge_local_, &edge_);
}

bool DualPrimal::set_up(bool more_constraints) {
  find_weights();
  std::vector<double> regular;
  for (const auto& c : interface_.classes) {  // C^T r C about as stiff as the nodes themselves
    double sum = 0;
    for (const PetscInt i : c.blocks) sum += diagonal_.segment<3>(3 * factor_.place(i)).sum();
    regular.push_back(sum / (3. * static_cast<double>(c.blocks.size())));
  }
  const auto everywhere = [](bool good) { return comm().max(good ? 0 : 1) == 0; };
  bool good = everywhere(factor_.factor(F_, interface_, regular));
  if (good) {
    good = find_class_matrices(interface_, factor_, regular, more_constraints, of_class_);
    list_constraints(regular);
    if (good) good = form_coarse_basis();
  }
  return everywhere(good) && factor_coarse();
}

/// Weights of the interface by the subdomains' diagonals: a stiff side decides.
void DualPrimal::find_weights() {
  diagonal_ = VectorXd::Zero(n_);
  F_.for_each_symmetric_block([&](PetscInt i, PetscInt j, const double* block) {
    if (i == j)
      for (int c = 0; c < 3; ++c) diagonal_[3 * factor_.place(i) + c] = std::max(0.0, block[4 * c]);
  });
  const VectorXd own = diagonal_.tail(n_edge_);
  weight_ = own.cwiseQuotient(sum(own));
}

/// The pieces' constraints: rigid motions of their classes, made regular, then the others.
void DualPrimal::list_constraints(const std::vector<double>& regular) {
  n_constraints_ = interface_.n_constraints + of_class_.n_more;
  const auto& classes = interface_.classes;
  std::vector<Eigen::Index> count(pieces_.size(), 0), column(pieces_.size(), 0);
  for (size_t k = 0; k < classes.size(); ++k) count[classes[k].piece] += classes[k].q.cols() + of_class_.more[k].cols();
  for (size_t p = 0; p < pieces_.size(); ++p) {
    pieces_[p].number.clear();
    pieces_[p].C = MatrixXd::Zero(pieces_[p].n, count[p]), pieces_[p].regular = VectorXd::Zero(count[p]);
  }
  const auto put = [&](const InterfaceClass& c, const MatrixXd& q, int first, double r) {
    Piece& piece = pieces_[c.piece];
    auto& at = column[c.piece];
    for (size_t k = 0; k < c.blocks.size() && q.cols() > 0; ++k)
      piece.C.block(3 * factor_.place(c.blocks[k]) - n_interior_ - piece.from, at, 3, q.cols()) =
          q.middleRows(3 * static_cast<Eigen::Index>(k), 3);
    for (int m = 0; m < q.cols(); ++m) piece.number.push_back(first + m), piece.regular[at++] = r;
  };
  for (size_t k = 0; k < classes.size(); ++k) put(classes[k], classes[k].q, classes[k].first, regular[k]);
  for (size_t k = 0; k < classes.size(); ++k) put(classes[k], of_class_.more[k], interface_.n_constraints + of_class_.first_more[k], 0);
}

/// Psi = S^-1 C (C^T S^-1 C)^-1 with the regular S, and the pieces' parts of K_c.
bool DualPrimal::form_coarse_basis() {
  if (!weight_.allFinite()) return false;
  constexpr Eigen::Index at_once = 24;  // columns that share the reading of the factor
  MatrixXd x;
  for (Piece& p : pieces_) {
    const auto from = n_interior_ + static_cast<int>(p.from), to = from + static_cast<int>(p.n);
    const auto n = p.C.cols();
    p.Psi.resize(p.n, n), p.coarse.resize(n, n);
    if (n == 0) continue;
    for (Eigen::Index k = 0; k < n; k += at_once) {
      const auto some = std::min(at_once, n - k);
      x.resize(n_, some);
      x.middleRows(from, p.n) = p.C.middleCols(k, some);
      factor_.forward(from, to, x.data(), static_cast<int>(some)), factor_.backward(from, to, x.data(), static_cast<int>(some));
      p.Psi.middleCols(k, some) = x.middleRows(from, p.n);
    }
    MatrixXd compliance = p.C.transpose() * p.Psi;
    compliance = (0.5 * (compliance + compliance.transpose())).eval();
    const Eigen::LLT<MatrixXd> inverse(compliance);
    if (inverse.info() != Eigen::Success) return false;
    p.coarse = inverse.solve(MatrixXd::Identity(n, n));
    p.Psi = (p.Psi * p.coarse).eval();
    p.coarse.diagonal() -= p.regular;
    if (!p.coarse.allFinite()) return false;
  }
  return true;
}

bool DualPrimal::factor_coarse() {
  std::vector<CoarseProblem::Entry> entries;
  for (const Piece& p : pieces_)
    for (size_t a = 0; a < p.number.size(); ++a)
      for (size_t b = 0; b < p.number.size(); ++b)
        if (p.number[a] >= p.number[b])
          entries.push_back({static_cast<double>(p.number[a]), static_cast<double>(p.number[b]),
                             p.coarse(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b))});
  return coarse_.factor(n_constraints_, entries);
}

/// All primal unknowns, for forces on the interface.
Eigen::MatrixXd DualPrimal::solve_coarse(const Columns& f) {
  MatrixXd all = MatrixXd::Zero(n_constraints_, f.cols());
  if (n_constraints_ == 0) return all;
  for (const Piece& p : pieces_) {
    const MatrixXd share = p.Psi.transpose() * f.middleRows(p.from, p.n);
    for (Eigen::Index k = 0; k < share.rows(); ++k) all.row(p.number[k]) += share.row(k);
  }
  comm().sum({all.data(), static_cast<size_t>(all.size())});
  coarse_.solve(all);
  return all;
}

/// D x, or D^T x.
Eigen::MatrixXd DualPrimal::weigh(const Columns& x, bool transposed) const {
  MatrixXd y = weight_.asDiagonal() * x, part;
  for (size_t k = 0; k < of_class_.weight.size(); ++k) {
    const MatrixXd& W = of_class_.weight[k];
    if (W.size() == 0) continue;
    const auto& blocks = interface_.classes[k].blocks;
    part.resize(W.rows(), x.cols());
    const auto rows = [&](auto& m, size_t i) { return m.middleRows(3 * factor_.place(blocks[i]) - n_interior_, 3); };
    for (size_t i = 0; i < blocks.size(); ++i) part.middleRows(3 * static_cast<Eigen::Index>(i), 3) = rows(x, i);
    part = transposed ? MatrixXd(W.transpose() * part) : MatrixXd(W * part);
    for (size_t i = 0; i < blocks.size(); ++i) rows(y, i) = part.middleRows(3 * static_cast<Eigen::Index>(i), 3);
  }
  return y;
}

/// Values of the interface added to those of g, columns of owned unknowns (or nothing), and the sums back to all that share them.
Eigen::MatrixXd DualPrimal::add(const Columns& x, const double* g) {
  MatrixXd sums(n_edge_, x.cols());
  const auto n_owned = 3 * static_cast<size_t>(F_.n_owned());
  for (Eigen::Index k = 0; k < x.cols(); ++k) {
    {
      const Values e(edge_local_), own(g_);
      std::copy_n(x.col(k).data(), n_edge_, e.data());
      if (g)
        std::copy_n(g + k * n_owned, n_owned, own.data());
      else
        std::fill_n(own.data(), n_owned, 0.0);
    }
    scatter(edge_, edge_local_, g_, ADD_VALUES, SCATTER_REVERSE);
    scatter(edge_, g_, edge_local_, INSERT_VALUES, SCATTER_FORWARD);
    const Values e(edge_local_);
    std::copy_n(e.data(), n_edge_, sums.col(k).data());
  }
  return sums;
}

Eigen::MatrixXd DualPrimal::condense(const Columns& b) {
  work_.resize(n_, b.cols());
  for (Eigen::Index k = 0; k < b.cols(); ++k) {
    check(VecPlaceArray(g_, b.col(k).data()));
    scatter(all_, g_, local_, INSERT_VALUES, SCATTER_FORWARD);
    check(VecResetArray(g_));
    const Values y(local_);
    std::copy_n(y.data(), n_interior_, work_.col(k).data());
  }
  work_.bottomRows(n_edge_).setZero();
  factor_.forward(0, n_interior_, work_.data(), static_cast<int>(b.cols()));
  return weigh(add(work_.bottomRows(n_edge_), b.data()), true);
}

void DualPrimal::expand(const Columns& w, Eigen::Ref<MatrixXd> x) {
  work_.bottomRows(n_edge_) = average(w);
  factor_.backward(0, n_interior_, work_.data(), static_cast<int>(w.cols()));  // y_I := L_II^-T (y_I - L_GI^T w)
  for (Eigen::Index k = 0; k < w.cols(); ++k) {
    {
      const Values y(local_);
      std::copy_n(work_.col(k).data(), n_, y.data());
    }
    check(VecPlaceArray(g_, x.col(k).data()));
    scatter(all_, local_, g_, INSERT_VALUES, SCATTER_REVERSE);
    check(VecResetArray(g_));
  }
}

Eigen::MatrixXd DualPrimal::solve(const Columns& f) {
  const auto columns = static_cast<int>(f.cols());
  work_.bottomRows(n_edge_) = f;
  factor_.forward(n_interior_, n_, work_.data(), columns), factor_.backward(n_interior_, n_, work_.data(), columns);
  MatrixXd w = work_.bottomRows(n_edge_);
  const MatrixXd primal = solve_coarse(f);
  for (const Piece& p : pieces_) w.middleRows(p.from, p.n) += p.Psi * (p.own(primal) - p.C.transpose() * w.middleRows(p.from, p.n));
  return w;
}

Eigen::MatrixXd DualPrimal::multiply(const Columns& w) {
  work_.bottomRows(n_edge_) = w;
  factor_.multiply_schur(work_.data(), static_cast<int>(w.cols()));
  MatrixXd f = work_.bottomRows(n_edge_);
  for (const Piece& p : pieces_) {
    const MatrixXd primal = p.regular.asDiagonal() * (p.C.transpose() * w.middleRows(p.from, p.n));
    f.middleRows(p.from, p.n) -= p.C * primal;
  }
  return f;
}

double DualPrimal::bytes() const {
  double sum = factor_.bytes() + coarse_.bytes();
  for (const Piece& p : pieces_) sum += 16. * static_cast<double>(p.C.size());
  for (const MatrixXd& w : of_class_.weight) sum += 8. * static_cast<double>(w.size());
  return sum;
}

}  // namespace hilo::petsc
