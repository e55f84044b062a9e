#include <suitesparse/klu.h>
#include <suitesparse/umfpack.h>

#include <algorithm>
#include <new>

#include "linear/factors.hpp"

namespace hilo {
namespace {

// Rows read as columns are the transpose: both factor it and solve transposed.

class Klu final : public Factors {
 public:
  Klu() {
    klu_defaults(&common_);
    common_.btf = 0;  // the saddle point is one block
    common_.scale = 2;
    common_.ordering = 1;  // COLAMD: multipliers have no diagonal, so that pivots move
  }
  ~Klu() override {
    if (numeric_) klu_free_numeric(&numeric_, &common_);
    if (symbolic_) klu_free_symbolic(&symbolic_, &common_);
  }
  bool factor(const BlockCsr& A) override {
    n_ = A.n();
    int *p = const_cast<int*>(A.row_start().data()), *i = const_cast<int*>(A.column().data());
    if (numeric_) klu_free_numeric(&numeric_, &common_);
    if (!symbolic_) symbolic_ = klu_analyze(n_, p, i, &common_);
    if (!symbolic_) return false;
    numeric_ = klu_factor(p, i, const_cast<double*>(A.values().data()), symbolic_, &common_);
    return numeric_ && common_.status == KLU_OK;
  }
  bool refactor(const BlockCsr& A) override {
    return numeric_ && klu_refactor(const_cast<int*>(A.row_start().data()), const_cast<int*>(A.column().data()),
                                    const_cast<double*>(A.values().data()), symbolic_, numeric_, &common_);
  }
  void solve(const double* b, double* x) override {
    std::copy(b, b + n_, x);
    klu_tsolve(symbolic_, numeric_, n_, 1, x, &common_);
  }
  double cost() const override { return 10; }
  std::string name() const override { return "KLU"; }
  double bytes() const override { return static_cast<double>(common_.memusage); }

 private:
  int n_ = 0;
  klu_common common_{};
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
};

class Umfpack final : public Factors {
 public:
  Umfpack() {
    umfpack_di_defaults(control_);
    control_[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
    control_[UMFPACK_IRSTEP] = 0;
  }
  ~Umfpack() override {
    if (numeric_) umfpack_di_free_numeric(&numeric_);
    if (symbolic_) umfpack_di_free_symbolic(&symbolic_);
  }
  bool factor(const BlockCsr& A) override {
    const int *p = A.row_start().data(), *i = A.column().data();
    const double* a = A.values().data();
    if (!symbolic_ && umfpack_di_symbolic(A.n(), A.n(), p, i, a, &symbolic_, control_, info_) != UMFPACK_OK) return false;
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

std::unique_ptr<Factors> make_klu() { return std::make_unique<Klu>(); }
std::unique_ptr<Factors> make_umfpack() { return std::make_unique<Umfpack>(); }

}  // namespace hilo
