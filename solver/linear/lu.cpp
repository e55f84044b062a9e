// SPDX-License-Identifier: GPL-3.0-or-later
#include <suitesparse/amd.h>
#include <suitesparse/colamd.h>
#include <suitesparse/klu.h>
#include <suitesparse/umfpack.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "base/wide.hpp"
#include "linear/blas_room.hpp"
#include "linear/factors.hpp"

namespace hilo {
namespace {

// Rows read as columns are the transpose: both factor it and solve transposed.

HILO_WIDE long differing_from_zero(const double* x, size_t n) {
  long count = 0;
  for (size_t k = 0; k < n; ++k) count += x[k] != 0;
  return count;
}

/// The entries that have ever differed from zero: many of a joint's never do, and a plane mechanism's motions out of its plane come apart
/// from those within.
class KeptEntries {
 protected:
  /// The entries of the pattern; false where another one differs from zero.
  bool gather(const BlockCsr& A) {
    const double* from = A.values().data();
    const int* place = place_.data();
    double* to = value_.data();
    for (size_t j = 0; j < place_.size(); ++j) to[j] = from[place[j]];
    return differing_from_zero(to, value_.size()) == differing_from_zero(from, A.values().size());
  }
  /// A new pattern, with these entries too.
  void widen(const BlockCsr& A) {
    if (++n_patterns_ == most_patterns) kept_.assign(A.values().size(), 1);
    find_pattern(A), gather(A);
  }

  int n_ = 0;
  std::vector<int> start_, column_;  // the pattern
  std::vector<double> value_;

 private:
  void find_pattern(const BlockCsr& A) {
    n_ = A.n();
    const auto& values = A.values();
    kept_.resize(values.size(), 0);
    start_.assign(1, 0), column_.clear(), place_.clear();
    for (int i = 0; i < n_; ++i) {
      for (int k = A.row_start()[i]; k < A.row_start()[i + 1]; ++k)
        if (kept_[k] |= values[k] != 0; kept_[k]) column_.push_back(A.column()[k]), place_.push_back(k);
      start_.push_back(static_cast<int>(column_.size()));
    }
    value_.resize(column_.size());
  }

  static constexpr int most_patterns = 20;  // before all entries are taken
  int n_patterns_ = 0;
  std::vector<char> kept_;  // of the matrix's entries
  std::vector<int> place_;  // of the pattern's among them
};

class Klu final : public Factors, KeptEntries {
 public:
  explicit Klu(bool of_bodies) : of_bodies_(of_bodies) {
    klu_defaults(&common_);
    common_.btf = 0;  // the saddle point is one block
    common_.scale = 2;
  }
  ~Klu() override { forget(); }
  bool factor(const BlockCsr& A) override {
    if (!symbolic_ || !gather(A)) {
      forget();
      widen(A);
      std::vector<int> order = least_fill();
      if (order.empty()) return false;
      symbolic_ = klu_analyze_given(n_, start_.data(), column_.data(), order.data(), order.data(), &common_);
      if (!symbolic_) return false;
    }
    if (numeric_) klu_free_numeric(&numeric_, &common_);
    numeric_ = klu_factor(start_.data(), column_.data(), value_.data(), symbolic_, &common_);
    return numeric_ && common_.status == KLU_OK;
  }
  bool refactor(const BlockCsr& A) override {
    return numeric_ && gather(A) && klu_refactor(start_.data(), column_.data(), value_.data(), symbolic_, numeric_, &common_);
  }
  void solve(const double* b, double* x) override {
    std::copy(b, b + n_, x);
    klu_tsolve(symbolic_, numeric_, n_, 1, x, &common_);
  }
  double cost() const override { return 10; }
  std::string name() const override { return "KLU"; }
  double bytes() const override { return static_cast<double>(common_.memusage); }

 private:
  void forget() {
    if (numeric_) klu_free_numeric(&numeric_, &common_);
    if (symbolic_) klu_free_symbolic(&symbolic_, &common_);
  }
  /// By AMD where every row of bodies has its diagonal, as of springs and contacts alone: half the fill and less of that by COLAMD.
  std::vector<int> least_fill() const {
    if (!of_bodies_) return least_fill_by_columns();
    for (int i = 0; i < n_; ++i) {
      const auto first = column_.begin() + start_[i], last = column_.begin() + start_[i + 1];
      const auto at = std::lower_bound(first, last, i);
      if (at == last || *at != i || value_[static_cast<size_t>(at - column_.begin())] == 0) return least_fill_by_columns();
    }
    std::vector<int> order(n_);
    if (amd_order(n_, start_.data(), column_.data(), order.data(), nullptr, nullptr) < 0) return {};
    return order;
  }
  /// By COLAMD: multipliers have no diagonal, so that pivots move.  Rows of what has many neighbours, the body in the middle of a star, say
  /// nothing of the order and would fill all of it: they go to the end.  Empty where memory fails.
  std::vector<int> least_fill_by_columns() const {
    double knobs[COLAMD_KNOBS];
    colamd_set_defaults(knobs);
    knobs[COLAMD_DENSE_ROW] = knobs[COLAMD_DENSE_COL] = std::max(1.5, 64 / std::sqrt(static_cast<double>(n_)));
    const auto entries = static_cast<int>(column_.size());
    std::vector<int> work(colamd_recommended(entries, n_, n_)), order(start_);
    int stats[COLAMD_STATS];
    std::copy(column_.begin(), column_.end(), work.begin());
    if (!colamd(n_, n_, static_cast<int>(work.size()), work.data(), order.data(), knobs, stats)) return {};
    order.resize(n_);
    return order;
  }
  const bool of_bodies_;  // all unknowns are of bodies and joints
  klu_common common_{};
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
};

class Umfpack final : public Factors, KeptEntries {
 public:
  Umfpack() {
    make_room_for_blas();
    umfpack_di_defaults(control_);
    control_[UMFPACK_ORDERING] = UMFPACK_ORDERING_CHOLMOD;  // nested dissection where minimum degree would fill much
    control_[UMFPACK_IRSTEP] = 0;
  }
  ~Umfpack() override {
    if (numeric_) umfpack_di_free_numeric(&numeric_);
    if (symbolic_) umfpack_di_free_symbolic(&symbolic_);
  }
  bool factor(const BlockCsr& A) override {
    if (!symbolic_ || !gather(A)) {
      if (symbolic_) umfpack_di_free_symbolic(&symbolic_);
      widen(A);
    }
    const int *p = start_.data(), *i = column_.data();
    const double* a = value_.data();
    if (!symbolic_ && umfpack_di_symbolic(n_, n_, p, i, a, &symbolic_, control_, info_) != UMFPACK_OK) return false;
    if (numeric_) umfpack_di_free_numeric(&numeric_);
    const int status = umfpack_di_numeric(p, i, a, symbolic_, &numeric_, control_, info_);
    if (status == UMFPACK_ERROR_out_of_memory) throw std::bad_alloc();
    return status == UMFPACK_OK;
  }
  void solve(const double* b, double* x) override {
    double info[UMFPACK_INFO];
    umfpack_di_solve(UMFPACK_Aat, nullptr, nullptr, nullptr, x, b, numeric_, control_, info);
  }
  double cost() const override { return factor_cost(info_[UMFPACK_FLOPS], info_[UMFPACK_LNZ] + info_[UMFPACK_UNZ]); }
  std::string name() const override { return "UMFPACK"; }
  double bytes() const override { return info_[UMFPACK_NUMERIC_SIZE] * info_[UMFPACK_SIZE_OF_UNIT]; }

 private:
  double control_[UMFPACK_CONTROL], info_[UMFPACK_INFO] = {};
  void *symbolic_ = nullptr, *numeric_ = nullptr;
};

}  // namespace

std::unique_ptr<Factors> make_klu(bool of_bodies) { return std::make_unique<Klu>(of_bodies); }
std::unique_ptr<Factors> make_umfpack() { return std::make_unique<Umfpack>(); }

}  // namespace hilo
