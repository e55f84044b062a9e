// SPDX-License-Identifier: GPL-3.0-or-later
// sym(A) = [ F   B ]   by  F = L L^T,  Z = F^-1 B,  S = D - B^T Z.
//          [ B^T D ]
//
// F's factor is kept in single precision: a solve reads it at memory speed, and what it preconditions mends the digits.
// F is positive definite with a factor half as large as that of an LU.  All of the matrix is symmetrised, not F alone: where a flexible
// part floats with its bodies, D and B^T F^-1 B cancel, and halves of different matrices would leave a large stiffness in their place.
#include <Eigen/LU>
#include <algorithm>
#include <new>
#include <utility>

#include "linear/blas_room.hpp"
#include "linear/factors.hpp"
#include "linear/supernodal.hpp"

namespace hilo {
namespace {

class Cholesky final : public Factors {
 public:
  explicit Cholesky(const std::vector<char>& is_dense) : number_(is_dense.size()) {
    make_room_for_blas();
    cholmod_start(&common_);
    common_.print = 0;
    common_.supernodal = CHOLMOD_SUPERNODAL;
    for (size_t& columns : common_.nrelax) columns *= 2;  // wider panels: a few zeros more, fewer calls
    for (size_t i = 0; i < is_dense.size(); ++i) {
      auto& list = is_dense[i] ? dense_ : flexible_;
      number_[i] = static_cast<int>(list.size());
      list.push_back(static_cast<int>(i));
    }
    is_dense_ = is_dense;
  }
  ~Cholesky() override {
    cholmod_free_dense(&y_, &common_), cholmod_free_dense(&e_, &common_), cholmod_free_dense(&u_, &common_);
    cholmod_free_factor(&L_, &common_);
    cholmod_finish(&common_);
  }

  bool factor(const BlockCsr& A) override {
    if (start_.empty()) find_pattern(A);
    fill(A);
    single_values_.clear();
    cholmod_sparse F{};
    F.nrow = F.ncol = 3 * flexible_.size();
    F.nzmax = values_.size();
    F.p = start_.data(), F.i = rows_.data(), F.x = values_.data();
    F.stype = -1, F.itype = CHOLMOD_INT, F.xtype = CHOLMOD_REAL, F.dtype = CHOLMOD_DOUBLE, F.packed = 1, F.sorted = 1;
    if (!L_) analyse(A, F);
    if (!L_ || !cholmod_factorize(&F, L_, &common_)) {
      if (common_.status == CHOLMOD_OUT_OF_MEMORY || common_.status == CHOLMOD_TOO_LARGE) throw std::bad_alloc();
      return false;
    }
    if (common_.status != CHOLMOD_OK || L_->minor != L_->n || !L_->is_super || !factor_schur(A)) return false;
    if (single_) single_values_.take_from(L_, common_);
    return true;
  }

  void solve(const double* b, double* x) override {
    const Eigen::Index n = 3 * static_cast<Eigen::Index>(flexible_.size());
    f_.resize(n), g_.resize(3 * static_cast<Eigen::Index>(dense_.size()));
    for (size_t k = 0; k < flexible_.size(); ++k) std::copy_n(b + 3 * flexible_[k], 3, f_.data() + 3 * k);
    for (size_t k = 0; k < dense_.size(); ++k) std::copy_n(b + 3 * dense_[k], 3, g_.data() + 3 * k);
    if (single_values_.exist())
      apply(single_values_, f_, single_work_, single_scratch_);
    else
      apply(supernodal::DoubleValues(L_), f_, double_work_, double_scratch_);
    double* u = f_.data();
    if (!dense_.empty()) {
      for (size_t k = 0; k < touching_.size(); ++k) {
        double sum = 0;
        for (const auto& [row, value] : columns_[k]) sum += value * u[row];
        g_[touching_[k]] -= sum;
      }
      g_ = scale_.cwiseProduct(schur_.solve(scale_.cwiseProduct(g_)));
      for (size_t k = 0; k < touching_.size(); ++k) p_[k] = g_[touching_[k]];
      Eigen::Map<Eigen::VectorXd>(u, n).noalias() -= Z_ * p_;
    }
    for (size_t k = 0; k < flexible_.size(); ++k) std::copy_n(u + 3 * k, 3, x + 3 * flexible_[k]);
    for (size_t k = 0; k < dense_.size(); ++k) std::copy_n(g_.data() + 3 * k, 3, x + 3 * dense_[k]);
  }

  bool sharpen() override { return std::exchange(single_, false); }
  double cost() const override {
    return factor_cost(common_.fl, 2 * common_.lnz) + 0.2 * static_cast<double>(touching_.size());  // columns together cost a fifth of one
  }
  std::string name() const override { return "CHOLMOD"; }
  double bytes() const override {
    if (!L_) return 0;
    return supernodal::bytes_of(L_, single_values_) + 8. * static_cast<double>(values_.size() + Z_.size()) +
           4. * static_cast<double>(rows_.size());
  }

 private:
  /// The lower triangle of F by columns, and which unknowns of the dense blocks meet F.
  void find_pattern(const BlockCsr& A) {
    start_.assign(1, 0);
    std::vector<char> touches(dense_.size(), 0);
    for (size_t k = 0; k < flexible_.size(); ++k) {
      const auto list = A.neighbours(flexible_[k]);
      for (int c = 0; c < 3; ++c) {
        for (const int j : list)
          if (!is_dense_[j] && number_[j] >= static_cast<int>(k))
            for (int r = j == flexible_[k] ? c : 0; r < 3; ++r) rows_.push_back(3 * number_[j] + r);
        start_.push_back(static_cast<int>(rows_.size()));
      }
      for (const int j : list)
        if (is_dense_[j]) touches[number_[j]] = 1;
    }
    values_.resize(rows_.size());
    for (size_t d = 0; d < dense_.size(); ++d)
      for (int c = 0; c < 3 && touches[d]; ++c) touching_.push_back(3 * static_cast<int>(d) + c);
    columns_.resize(touching_.size());
    p_.resize(static_cast<Eigen::Index>(touching_.size()));
  }

  void fill(const BlockCsr& A) {
    size_t at = 0;
    for (size_t k = 0; k < flexible_.size(); ++k) {
      const int i = flexible_[k];
      const auto list = A.neighbours(i);
      for (int c = 0; c < 3; ++c)
        for (size_t n = 0; n < list.size(); ++n) {
          const int j = list[n];
          if (is_dense_[j] || number_[j] < static_cast<int>(k)) continue;
          const int back = A.place(j, i);
          for (int r = j == i ? c : 0; r < 3; ++r) values_[at++] = (A.entry(i, static_cast<int>(n), c, r) + A.entry(j, back, r, c)) / 2;
        }
    }
  }

  /// Nested dissection of the blocks, kept together.
  void analyse(const BlockCsr& A, cholmod_sparse& F) {
    std::vector<int> p{0}, i;
    for (size_t k = 0; k < flexible_.size(); ++k) {
      for (const int j : A.neighbours(flexible_[k]))
        if (!is_dense_[j] && number_[j] >= static_cast<int>(k)) i.push_back(number_[j]);
      p.push_back(static_cast<int>(i.size()));
    }
    cholmod_sparse graph{};
    graph.nrow = graph.ncol = flexible_.size();
    graph.nzmax = i.size();
    graph.p = p.data(), graph.i = i.data();
    graph.stype = -1, graph.itype = CHOLMOD_INT, graph.xtype = CHOLMOD_PATTERN, graph.dtype = CHOLMOD_DOUBLE, graph.packed = 1;
    std::vector<int> order(flexible_.size()), scalar;
    if (!cholmod_metis(&graph, nullptr, 0, 1, order.data(), &common_)) return;
    for (const int b : order)
      for (int c = 0; c < 3; ++c) scalar.push_back(3 * b + c);
    common_.nmethods = 1, common_.method[0].ordering = CHOLMOD_GIVEN, common_.postorder = 1;
    L_ = cholmod_analyze_p(&F, scalar.data(), nullptr, 0, &common_);
  }

  /// Z = F^-1 B and the factors of S = D - B^T Z, scaled to equal rows: those of bodies and of constraints differ by many orders.
  bool factor_schur(const BlockCsr& A) {
    const auto m = 3 * static_cast<Eigen::Index>(dense_.size()), n = 3 * static_cast<Eigen::Index>(flexible_.size());
    if (m == 0) return true;
    Eigen::MatrixXd S = Eigen::MatrixXd::Zero(m, m);
    std::vector<int> column_of(m, -1);
    for (size_t k = 0; k < touching_.size(); ++k) column_of[touching_[k]] = static_cast<int>(k), columns_[k].clear();
    for (size_t d = 0; d < dense_.size(); ++d) {
      const int i = dense_[d];
      const auto list = A.neighbours(i);
      for (size_t k = 0; k < list.size(); ++k) {
        const int j = list[k], back = A.place(j, i);
        for (int r = 0; r < 3; ++r)
          for (int c = 0; c < 3; ++c) {
            const double value = (A.entry(i, static_cast<int>(k), r, c) + A.entry(j, back, c, r)) / 2;
            const int row = 3 * static_cast<int>(d) + r, column = 3 * number_[j] + c;
            if (is_dense_[j])
              S(row, column) = value;
            else if (value != 0)
              columns_[column_of[row]].emplace_back(column, value);
          }
      }
    }
    Z_.setZero(n, static_cast<Eigen::Index>(touching_.size()));
    for (size_t k = 0; k < columns_.size(); ++k)
      for (const auto& [row, value] : columns_[k]) Z_(row, static_cast<Eigen::Index>(k)) = value;
    if (Z_.size() > 0) {
      const double* solved = solve_flexible(Z_.data(), static_cast<int>(touching_.size()));
      std::copy_n(solved, Z_.size(), Z_.data());
    }
    for (size_t k = 0; k < columns_.size(); ++k)
      for (Eigen::Index l = 0; l < Z_.cols(); ++l) {
        double sum = 0;
        for (const auto& [row, value] : columns_[k]) sum += value * Z_(row, l);
        S(touching_[k], touching_[l]) -= sum;
      }
    if (!S.allFinite()) return false;
    scale_ = S.cwiseAbs().rowwise().maxCoeff();
    if (!(scale_.minCoeff() > 0)) return false;
    scale_ = scale_.cwiseSqrt().cwiseInverse();
    schur_.compute(scale_.asDiagonal() * S * scale_.asDiagonal());
    return schur_.rcond() > 1e-14;
  }

  /// u := F^-1 u
  template <class T, class Values>
  void apply(const Values& values, Eigen::VectorXd& u, std::vector<T>& work, std::vector<T>& scratch) {
    const double largest = u.size() > 0 ? u.cwiseAbs().maxCoeff() : 0;
    if (!(largest > 0)) return;
    const auto* order = static_cast<const int*>(L_->Perm);
    const int n = static_cast<int>(u.size());
    work.resize(n);
    for (int i = 0; i < n; ++i) work[i] = static_cast<T>(u[order[i]] / largest);  // within the range of single precision
    supernodal::forward(L_, values, 0, n, work.data(), scratch);
    supernodal::backward(L_, values, 0, n, work.data(), scratch);
    for (int i = 0; i < n; ++i) u[order[i]] = largest * work[i];
  }

  /// F^-1 of columns in double precision; valid until the next call.
  double* solve_flexible(double* b, int n_columns) {
    cholmod_dense B{};
    B.nrow = B.d = 3 * flexible_.size(), B.ncol = n_columns, B.nzmax = B.nrow * B.ncol;
    B.x = b, B.xtype = CHOLMOD_REAL, B.dtype = CHOLMOD_DOUBLE;
    if (!cholmod_solve2(CHOLMOD_A, L_, &B, nullptr, &u_, nullptr, &y_, &e_, &common_)) throw std::bad_alloc();
    return static_cast<double*>(u_->x);
  }

  std::vector<char> is_dense_;
  std::vector<int> number_, flexible_, dense_;  // of each block among its like; blocks of each kind
  std::vector<int> start_, rows_, touching_;    // of F; dense unknowns that meet F
  std::vector<double> values_;
  std::vector<std::vector<std::pair<int, double>>> columns_;  // of B
  Eigen::MatrixXd Z_;
  Eigen::VectorXd scale_, f_, g_, p_;
  Eigen::PartialPivLU<Eigen::MatrixXd> schur_;
  bool single_ = true;
  supernodal::SingleValues single_values_;  // of L
  std::vector<float> single_work_, single_scratch_;
  std::vector<double> double_work_, double_scratch_;
  cholmod_common common_{};
  cholmod_factor* L_ = nullptr;
  cholmod_dense *u_ = nullptr, *y_ = nullptr, *e_ = nullptr;
};

}  // namespace

std::unique_ptr<Factors> make_cholesky(const std::vector<char>& is_dense) { return std::make_unique<Cholesky>(is_dense); }

}  // namespace hilo
