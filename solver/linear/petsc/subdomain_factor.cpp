// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/petsc/subdomain_factor.hpp"

#include <algorithm>
#include <new>
#include <numeric>

namespace hilo::petsc {

SubdomainFactor::SubdomainFactor(const SubdomainMatrix& F, const Interface& interface) {
  cholmod_start(&common_);
  common_.print = 0;
  common_.supernodal = CHOLMOD_SUPERNODAL;
  common_.final_ll = 1;
  common_.postorder = 0;
  common_.nmethods = 1;
  const PetscInt n = F.n_blocks();
  std::vector<char> shared(n, 0);
  for (const auto& c : interface.classes)
    for (const PetscInt i : c.blocks) shared[i] = 1;
  order(F, interface, shared);
  // lower triangle: the matrix and the dense classes
  std::vector<std::vector<int>> extra(n);
  for (const auto& c : interface.classes)
    for (const PetscInt a : c.blocks)
      for (const PetscInt b : c.blocks)
        if (place_[b] > place_[a]) extra[place_[a]].push_back(place_[b]);
  start_.assign(1, 0);
  std::vector<int> column;
  for (PetscInt k = 0; k < n; ++k) {
    column = std::move(extra[k]);
    for (const PetscInt j : F.neighbours(block_[k]))
      if (place_[j] >= k) column.push_back(place_[j]);
    std::sort(column.begin(), column.end());
    column.erase(std::unique(column.begin(), column.end()), column.end());
    rows_.insert(rows_.end(), column.begin(), column.end());
    start_.push_back(static_cast<int>(rows_.size()));
  }
}

SubdomainFactor::~SubdomainFactor() {
  cholmod_free_factor(&L_, &common_);
  cholmod_finish(&common_);
}

/// Nested dissection of the interior, in its elimination tree's postorder; then the interface, piece after piece.
void SubdomainFactor::order(const SubdomainMatrix& F, const Interface& interface, const std::vector<char>& shared) {
  const PetscInt n = F.n_blocks();
  std::vector<int> inside(n, -1);
  std::vector<PetscInt> interior;
  for (PetscInt i = 0; i < n; ++i)
    if (!shared[i]) inside[i] = static_cast<int>(interior.size()), interior.push_back(i);
  std::vector<int> start{0}, rows;
  for (const PetscInt i : interior) {
    for (const PetscInt j : F.neighbours(i))
      if (inside[j] >= inside[i]) rows.push_back(inside[j]);
    start.push_back(static_cast<int>(rows.size()));
  }
  cholmod_sparse graph{};
  graph.nrow = graph.ncol = interior.size();
  graph.nzmax = rows.size();
  graph.p = start.data(), graph.i = rows.data();
  graph.stype = -1, graph.itype = CHOLMOD_INT, graph.xtype = CHOLMOD_PATTERN, graph.dtype = CHOLMOD_DOUBLE;
  graph.packed = 1, graph.sorted = 0;
  cholmod_common c{};
  cholmod_start(&c);
  c.print = 0, c.supernodal = CHOLMOD_SIMPLICIAL, c.nmethods = 1, c.method[0].ordering = CHOLMOD_METIS, c.postorder = 1;
  cholmod_factor* analysis = interior.empty() ? nullptr : cholmod_analyze(&graph, &c);
  block_.clear();
  if (analysis)
    for (size_t k = 0; k < interior.size(); ++k) block_.push_back(interior[static_cast<int*>(analysis->Perm)[k]]);
  else
    block_ = interior;
  if (analysis) cholmod_free_factor(&analysis, &c);
  cholmod_finish(&c);
  n_interior_ = 3 * static_cast<int>(interior.size());
  std::vector<std::vector<PetscInt>> edge(interface.n_pieces);
  for (PetscInt i = 0; i < n; ++i)
    if (shared[i]) edge[interface.piece[i]].push_back(i);
  begin_.clear();
  for (const auto& blocks : edge) {
    begin_.push_back(3 * static_cast<int>(block_.size()));
    block_.insert(block_.end(), blocks.begin(), blocks.end());
  }
  begin_.push_back(3 * n);
  place_.resize(n);
  for (PetscInt k = 0; k < n; ++k) place_[block_[k]] = k;
}

bool SubdomainFactor::factor(const SubdomainMatrix& F, const Interface& interface, const std::vector<double>& weight) {
  single_.clear();
  const int n_blocks = static_cast<int>(place_.size());
  if (n_blocks == 0) return true;
  // scalar columns: the first of a block's three holds the whole diagonal block's column, the next one less, ...
  std::vector<int> p(3 * static_cast<size_t>(n_blocks) + 1, 0), i;
  for (int k = 0; k < n_blocks; ++k)
    for (int c = 0; c < 3; ++c) p[3 * k + c + 1] = p[3 * k + c] + 3 * (start_[k + 1] - start_[k]) - c;
  i.resize(p.back());
  for (int k = 0; k < n_blocks; ++k)
    for (int c = 0; c < 3; ++c) {
      int at = p[3 * k + c];
      for (int b = start_[k]; b < start_[k + 1]; ++b)
        for (int r = b == start_[k] ? c : 0; r < 3; ++r) i[at++] = 3 * rows_[b] + r;
    }
  std::vector<double> x(i.size(), 0.0);
  const auto add = [&](int row, int column, int r, int c, double value) {  // of the lower triangle
    const auto begin = rows_.begin() + start_[column], end = rows_.begin() + start_[column + 1];
    const int b = static_cast<int>(std::lower_bound(begin, end, row) - begin);
    x[static_cast<size_t>(p[3 * column + c]) + 3 * b + r - c] += value;
  };
  F.for_each_symmetric_block([&](PetscInt a, PetscInt b, const double* block) {
    const int row = place_[a], column = place_[b];
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) {
        if (row > column) add(row, column, r, c, block[3 * r + c]);
        if (row < column) add(column, row, c, r, block[3 * r + c]);
        if (row == column && r >= c) add(row, column, r, c, block[3 * r + c]);
      }
  });
  for (size_t k = 0; k < interface.classes.size(); ++k) {
    const auto& cls = interface.classes[k];
    for (size_t a = 0; a < cls.blocks.size(); ++a)
      for (size_t b = 0; b < cls.blocks.size(); ++b) {
        const int row = place_[cls.blocks[a]], column = place_[cls.blocks[b]];
        if (row < column) continue;
        const Eigen::Matrix3d q = weight[k] * cls.q.middleRows(3 * a, 3) * cls.q.middleRows(3 * b, 3).transpose();
        for (int r = 0; r < 3; ++r)
          for (int c = 0; c < 3; ++c)
            if (row > column || r >= c) add(row, column, r, c, q(r, c));
      }
  }
  cholmod_sparse A{};
  A.nrow = A.ncol = 3 * static_cast<size_t>(n_blocks);
  A.nzmax = i.size();
  A.p = p.data(), A.i = i.data(), A.x = x.data();
  A.stype = -1, A.itype = CHOLMOD_INT, A.xtype = CHOLMOD_REAL, A.dtype = CHOLMOD_DOUBLE, A.packed = 1, A.sorted = 1;
  common_.method[0].ordering = CHOLMOD_NATURAL;
  if (!L_) L_ = cholmod_analyze(&A, &common_);
  if (!L_ || !cholmod_factorize(&A, L_, &common_)) {
    if (common_.status == CHOLMOD_OUT_OF_MEMORY || common_.status == CHOLMOD_TOO_LARGE) throw std::bad_alloc();
    return false;
  }
  return common_.status == CHOLMOD_OK && L_->minor == L_->n && L_->is_super;
}

void SubdomainFactor::narrow() {
  if (L_) single_.take_from(L_, common_);
}

/// Rows from `from` on rounded, and those up to `to` back, within the range of single precision.
template <class Solve>
void SubdomainFactor::in_single(int from, int to, double* x, int columns, const Solve& solve) const {
  auto X = Eigen::Map<Eigen::MatrixXd>(x, n(), columns).bottomRows(n() - from);
  x_.resize(static_cast<size_t>(n()) * columns);
  auto Y = Eigen::Map<Eigen::MatrixXf>(x_.data(), n(), columns).bottomRows(n() - from);
  if (X.size() == 0) return;
  const Eigen::RowVectorXd scale = X.cwiseAbs().colwise().maxCoeff().cwiseMax(1e-300);
  for (int k = 0; k < columns; ++k) Y.col(k) = (X.col(k) / scale[k]).cast<float>();
  solve(x_.data());
  for (int k = 0; k < columns; ++k) X.col(k).head(to - from) = scale[k] * Y.col(k).head(to - from).cast<double>();
}

void SubdomainFactor::forward(int from, int to, double* x, int columns) const {
  if (from >= to) return;  // a rank without unknowns has no factor
  if (single_.exist())
    in_single(from, n(), x, columns, [&](float* y) { supernodal::forward(L_, single_, from, to, y, below_single_, columns); });
  else
    supernodal::forward(L_, supernodal::DoubleValues(L_), from, to, x, below_, columns);
}
void SubdomainFactor::backward(int from, int to, double* x, int columns) const {
  if (from >= to) return;
  if (single_.exist())
    in_single(from, to, x, columns, [&](float* y) { supernodal::backward(L_, single_, from, to, y, below_single_, columns); });
  else
    supernodal::backward(L_, supernodal::DoubleValues(L_), from, to, x, below_, columns);
}
void SubdomainFactor::multiply_schur(double* x, int columns) const {
  if (n_interior_ < n()) supernodal::multiply(L_, n_interior_, x, below_, columns);
}

Eigen::MatrixXd SubdomainFactor::schur_rows(int piece, const std::vector<int>& unknowns) const {
  const int from = begin_[piece], to = begin_[piece + 1];
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(unknowns.size()), to - from);
  std::vector<int> wanted(to - from, -1);
  for (size_t k = 0; k < unknowns.size(); ++k) wanted[unknowns[k] - from] = static_cast<int>(k);
  const auto* super = static_cast<const int*>(L_->super);
  const auto *pi = static_cast<const int*>(L_->pi), *rows = static_cast<const int*>(L_->s);
  const supernodal::DoubleValues values(L_);
  for (int s = static_cast<int>(std::upper_bound(super, super + L_->nsuper, from) - super) - 1;
       s < static_cast<int>(L_->nsuper) && super[s] < to; ++s) {
    const int stride = pi[s + 1] - pi[s];
    for (int c = std::max(from, super[s]); c < std::min(to, super[s + 1]); ++c)
      for (int r = c - super[s]; r < stride; ++r)
        if (const int k = wanted[rows[pi[s] + r] - from]; k >= 0)
          M(k, c - from) = values[s][static_cast<size_t>(c - super[s]) * stride + r];
  }
  return M;
}

Eigen::MatrixXd SubdomainFactor::inverse_root(int piece, int most) const {
  const int n = begin_[piece + 1] - begin_[piece];
  if (n == 0 || n > most) return {};
  std::vector<int> unknowns(n);
  std::iota(unknowns.begin(), unknowns.end(), begin_[piece]);
  Eigen::MatrixXd L = schur_rows(piece, unknowns);
  lapack::invert_triangle(n, L.data());
  return L;
}

double SubdomainFactor::bytes() const { return L_ ? supernodal::bytes_of(L_, single_) : 0; }

}  // namespace hilo::petsc
