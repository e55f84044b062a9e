// SPDX-License-Identifier: GPL-3.0-or-later
// sym(A) = [ F   B ]   by  F = L L^T,  Z = F^-1 B,  S = D - B^T Z.
//          [ B^T D ]
//
// F's factor is kept in single precision: a solve reads it at memory speed, and what it preconditions mends the digits.
// F is positive definite with a factor half as large as that of an LU.  All of the matrix is symmetrised, not F alone: where a flexible
// part floats with its bodies, D and B^T F^-1 B cancel, and halves of different matrices would leave a large stiffness in their place.
//
// Where there are no bodies, what contact joins comes last in F.  The end E of its factor, E E^T = F_ee less what the rest takes away, is
// made anew for a later matrix by the change of F_ee alone: contacts change from iteration to iteration, cells little.
//
// What slides with friction has no symmetric tangent, and its symmetric part may be indefinite.  Then F_ee gets a stiffness for the
// factor that is taken from E E^T again, and the end has an LU of the whole of it.
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
  Cholesky(const std::vector<char>& is_dense, const std::vector<char>& joined) : number_(is_dense.size()) {
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
    for (size_t i = 0; i < joined.size() && dense_.empty(); ++i)
      if (joined[i]) joined_.push_back(number_[i]);
  }
  ~Cholesky() override {
    cholmod_free_dense(&y_, &common_), cholmod_free_dense(&e_, &common_), cholmod_free_dense(&u_, &common_);
    cholmod_free_factor(&L_, &common_);
    cholmod_finish(&common_);
  }

  bool factor(const BlockCsr& A) override {
    if (start_.empty()) find_pattern(A);
    fill(A);
    follows_ = false;
    single_values_.clear();
    cholmod_sparse F{};
    F.nrow = F.ncol = 3 * flexible_.size();
    F.nzmax = values_.size();
    F.p = start_.data(), F.i = rows_.data(), F.x = values_.data();
    F.stype = -1, F.itype = CHOLMOD_INT, F.xtype = CHOLMOD_REAL, F.dtype = CHOLMOD_DOUBLE, F.packed = 1, F.sorted = 1;
    if (!L_) analyse(A, F);
    if (stiffened_) stiffen(A);
    if (!factorize(F)) {
      if (joined_.empty() || std::exchange(tried_, true)) return false;
      stiffened_ = true;
      cholmod_free_factor(&L_, &common_);
      analyse(A, F);
      stiffened_ = !last_.empty();
      if (!stiffened_) return false;
      stiffen(A);
      if (!factorize(F)) return false;
    }
    if (!factor_schur(A)) return false;
    if (!last_.empty()) take_end(A);
    if (single_) single_values_.take_from(L_, common_);
    return !stiffened_ || follow(A);
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

  /// The end of the factor, of what is joined, is made anew by what has changed there.
  bool follow(const BlockCsr& A) override {
    if (last_.empty()) return true;
    const int m = static_cast<int>(3 * last_.size());
    if (end_schur_.size() == 0) {
      end_schur_.setZero(m, m);
      lapack::gram(m, m, end_factor_.data(), end_schur_.data());
      end_schur_ -= end_;
      end_schur_.triangularView<Eigen::StrictlyUpper>() = end_schur_.transpose();
    }
    const Eigen::MatrixXd end = end_of(A);
    if (stiffened_) {
      end_lu_ = (end + end_schur_).cast<float>();
      follows_ = lapack::factor_whole(m, end_lu_.data(), pivots_);
    } else {
      end_factor_ = (end + end.transpose()) / 2 + end_schur_;
      follows_ = lapack::factor(m, end_factor_.data(), m);
    }
    return follows_;
  }
  bool are_of_definite() const override { return !stiffened_; }

  bool sharpen() override { return std::exchange(single_, false); }
  double cost() const override {
    return factor_cost(common_.fl, 2 * common_.lnz) + 0.2 * static_cast<double>(touching_.size());  // columns together cost a fifth of one
  }
  std::string name() const override { return "CHOLMOD"; }
  double bytes() const override {
    if (!L_) return 0;
    return supernodal::bytes_of(L_, single_values_) + 8. * static_cast<double>(values_.size() + Z_.size() + 3 * end_.size()) +
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

  /// Nested dissection of the blocks, kept together.  What is joined comes last, where its part of the factor costs little beside the rest,
  /// or, where that is to be an LU, beside factors of the whole that are.
  void analyse(const BlockCsr& A, cholmod_sparse& F, bool ends_with_joined = true) {
    last_ = ends_with_joined ? joined_ : std::vector<int>();
    place_.clear();
    const auto m = static_cast<double>(3 * last_.size()), n = static_cast<double>(F.nrow);
    const double share = stiffened_ ? 3 : 0.5, likely = 10;  // of the work; of cells in space it is about ten times n^2
    constexpr double most = 2000;                            // unknowns there: 100 MB
    if (m > most || m * m * m > 2 * share * likely * n * n) last_.clear();
    std::vector<char> is_last(flexible_.size(), 0);
    for (const int b : last_) is_last[b] = 1;
    std::vector<int> p{0}, i, before, place(flexible_.size(), -1);
    for (size_t k = 0; k < flexible_.size(); ++k)
      if (!is_last[k]) place[k] = static_cast<int>(before.size()), before.push_back(static_cast<int>(k));
    for (const int k : before) {
      for (const int j : A.neighbours(flexible_[k]))
        if (!is_dense_[j] && number_[j] >= k && !is_last[number_[j]]) i.push_back(place[number_[j]]);
      p.push_back(static_cast<int>(i.size()));
    }
    cholmod_sparse graph{};
    graph.nrow = graph.ncol = before.size();
    graph.nzmax = i.size();
    graph.p = p.data(), graph.i = i.data();
    graph.stype = -1, graph.itype = CHOLMOD_INT, graph.xtype = CHOLMOD_PATTERN, graph.dtype = CHOLMOD_DOUBLE, graph.packed = 1;
    std::vector<int> order(before.size()), scalar;
    if (!before.empty() && !cholmod_metis(&graph, nullptr, 0, 1, order.data(), &common_)) return;
    for (int& b : order) b = before[b];
    order.insert(order.end(), last_.begin(), last_.end());
    for (const int b : order)
      for (int c = 0; c < 3; ++c) scalar.push_back(3 * b + c);
    common_.nmethods = 1, common_.method[0].ordering = CHOLMOD_GIVEN, common_.postorder = 1;
    if (last_.empty()) {
      L_ = cholmod_analyze_p(&F, scalar.data(), nullptr, 0, &common_);
      return;
    }
    std::vector<int> start{0}, rows;  // of F, with all that is joined coupled, so that it stays last
    for (int k = 0; k < static_cast<int>(F.ncol); ++k) {
      for (size_t b = 0; b < last_.size() && is_last[k / 3]; ++b)
        for (int r = std::max(k, 3 * last_[b]); r < 3 * last_[b] + 3; ++r) rows.push_back(r);
      for (int at = start_[k]; at < start_[k + 1]; ++at)
        if (!is_last[k / 3] || !is_last[rows_[at] / 3]) rows.push_back(rows_[at]);
      std::sort(rows.begin() + start.back(), rows.end());
      start.push_back(static_cast<int>(rows.size()));
    }
    cholmod_sparse pattern = F;
    pattern.nzmax = rows.size(), pattern.p = start.data(), pattern.i = rows.data(), pattern.x = nullptr, pattern.xtype = CHOLMOD_PATTERN;
    L_ = cholmod_analyze_p(&pattern, scalar.data(), nullptr, 0, &common_);
    if (!L_) return;
    const auto* at = static_cast<const int*>(L_->Perm) + L_->n - 3 * last_.size();
    const bool stays = std::all_of(at, at + 3 * last_.size(), [&](int k) { return is_last[k / 3] != 0; });
    if (stays && m * m * m <= share * common_.fl) {
      place_.assign(F.nrow, -1);
      for (size_t k = 0; k < 3 * last_.size(); ++k) place_[at[k]] = static_cast<int>(k);
      return;
    }
    cholmod_free_factor(&L_, &common_);
    analyse(A, F, false);
  }

  bool factorize(cholmod_sparse& F) {
    if (!L_ || !cholmod_factorize(&F, L_, &common_)) {
      if (common_.status == CHOLMOD_OUT_OF_MEMORY || common_.status == CHOLMOD_TOO_LARGE) throw std::bad_alloc();
      return false;
    }
    return common_.status == CHOLMOD_OK && L_->minor == L_->n && L_->is_super;
  }

  /// F_ee becomes definite, whatever of it slides: diagonals above the sums of their rows.
  void stiffen(const BlockCsr& A) {
    const Eigen::VectorXd more = stiffness_of(end_of(A));
    for (const int k : last_)
      for (int c = 0; c < 3; ++c) values_[start_[3 * k + c]] += more[place_[3 * k + c]];  // a column begins with its diagonal
  }
  static Eigen::VectorXd stiffness_of(const Eigen::MatrixXd& end) {
    return end.cwiseAbs().rowwise().sum() + end.cwiseAbs().colwise().sum().transpose();
  }

  /// The part of A of what is joined, in the factor's order.
  Eigen::MatrixXd end_of(const BlockCsr& A) const {
    const auto m = static_cast<Eigen::Index>(3 * last_.size());
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(m, m);
    for (const int k : last_) {
      const int i = flexible_[k];
      const auto list = A.neighbours(i);
      for (size_t n = 0; n < list.size(); ++n) {
        const int j = list[n];
        if (place_[3 * number_[j]] < 0) continue;
        for (int c = 0; c < 3; ++c)
          for (int r = 0; r < 3; ++r) out(place_[3 * k + r], place_[3 * number_[j] + c]) = A.entry(i, static_cast<int>(n), r, c);
      }
    }
    return out;
  }

  /// What `follow` starts from.
  void take_end(const BlockCsr& A) {
    const int m = static_cast<int>(3 * last_.size()), first = static_cast<int>(L_->n) - m;
    const auto *super = static_cast<const int*>(L_->super), *pi = static_cast<const int*>(L_->pi), *rows = static_cast<const int*>(L_->s);
    const supernodal::DoubleValues values(L_);
    end_ = end_of(A), end_schur_.resize(0, 0);
    const Eigen::VectorXd more = stiffened_ ? stiffness_of(end_) : Eigen::VectorXd();
    end_ = ((end_ + end_.transpose()) / 2).eval();
    if (stiffened_) end_.diagonal() += more;
    end_factor_.setZero(m, m);
    for (int s = static_cast<int>(L_->nsuper) - 1; s >= 0 && super[s + 1] > first; --s) {
      const int stride = pi[s + 1] - pi[s];
      for (int j = std::max(first, super[s]); j < super[s + 1]; ++j)
        for (int r = j - super[s]; r < stride; ++r)
          end_factor_(rows[pi[s] + r] - first, j - first) = values[s][r + static_cast<size_t>(j - super[s]) * stride];
    }
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
    const int end = follows_ ? n - static_cast<int>(end_factor_.rows()) : n;
    supernodal::forward(L_, values, 0, end, work.data(), scratch);
    if (follows_ && stiffened_) {
      at_end_single_ = Eigen::Map<const Eigen::Matrix<T, Eigen::Dynamic, 1>>(work.data() + end, n - end).template cast<float>();
      lapack::solve_whole(n - end, end_lu_.data(), pivots_, at_end_single_.data());
      for (int i = end; i < n; ++i) work[i] = at_end_single_[i - end];
    } else if (follows_) {
      at_end_ = Eigen::Map<const Eigen::Matrix<T, Eigen::Dynamic, 1>>(work.data() + end, n - end).template cast<double>();
      lapack::solve(n - end, 1, end_factor_.data(), at_end_.data());
      for (int i = end; i < n; ++i) work[i] = static_cast<T>(at_end_[i - end]);
    }
    supernodal::backward(L_, values, 0, end, work.data(), scratch);
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
  std::vector<int> joined_, last_, place_;        // flexible blocks; those at the end of the factor, and where there each unknown is
  Eigen::MatrixXd end_, end_schur_, end_factor_;  // of F there when factored; what the rest adds to it; its factor
  bool tried_ = false;                            // to stiffen F where it was indefinite
  bool stiffened_ = false;                        // F was indefinite there: its factor is an LU
  Eigen::MatrixXf end_lu_;
  std::vector<int> pivots_;
  Eigen::VectorXd at_end_;
  Eigen::VectorXf at_end_single_;
  bool follows_ = false;  // the end is a later matrix's
  bool single_ = true;
  supernodal::SingleValues single_values_;  // of L
  std::vector<float> single_work_, single_scratch_;
  std::vector<double> double_work_, double_scratch_;
  cholmod_common common_{};
  cholmod_factor* L_ = nullptr;
  cholmod_dense *u_ = nullptr, *y_ = nullptr, *e_ = nullptr;
};

}  // namespace

std::unique_ptr<Factors> make_cholesky(const std::vector<char>& is_dense, const std::vector<char>& joined) {
  return std::make_unique<Cholesky>(is_dense, joined);
}

}  // namespace hilo
