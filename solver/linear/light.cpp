// The light solve: sparse LU with the pattern found once, for scenes too small to start PETSc for.
#include <fmt/format.h>
#include <suitesparse/klu.h>
#include <suitesparse/umfpack.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "linear/kkt.hpp"

namespace hilo {
namespace {

class LightSolver final : public KktSolver {
 public:
  LightSolver() {
    klu_defaults(&common_);
    common_.btf = 0;  // the saddle point is one block
    common_.scale = 2;
    umfpack_di_defaults(control_);
    control_[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
    control_[UMFPACK_IRSTEP] = 0;
  }
  ~LightSolver() override { release(); }

  void structure(const Cliques& cliques, const BlockMap& map) override {
    release();
    const int nb = static_cast<int>(map.global.size());
    cliques_ = &cliques;
    n_ = 3 * nb;
    std::vector<std::vector<int>> neighbours(nb);
    for (int i = 0; i < nb; ++i) neighbours[i].push_back(i);
    for (int e = 0; e < cliques.size(); ++e)
      for (int i : cliques[e])
        for (int j : cliques[e])
          if (i >= 0 && j >= 0) neighbours[i].push_back(j);
    // CSR of the matrix; read as CSC it is the transpose, which the factorisation solves transposed
    block_start_.assign(nb + 1, 0);
    std::vector<int> columns;
    for (int i = 0; i < nb; ++i) {
      auto& list = neighbours[i];
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
      columns.insert(columns.end(), list.begin(), list.end());
      block_start_[i + 1] = static_cast<int>(columns.size());
      std::vector<int>().swap(list);
    }
    Ap_.assign(n_ + 1, 0);
    Ai_.clear();
    for (int i = 0; i < nb; ++i)
      for (int r = 0; r < 3; ++r) {
        for (int k = block_start_[i]; k < block_start_[i + 1]; ++k)
          for (int c = 0; c < 3; ++c) Ai_.push_back(3 * columns[k] + c);
        Ap_[3 * i + r + 1] = static_cast<int>(Ai_.size());
      }
    Ax_.assign(Ai_.size(), 0);
    position_.clear();
    clique_position_.assign(1, 0);
    for (int e = 0; e < cliques.size(); ++e) {
      for (int i : cliques[e])
        for (int j : cliques[e]) {
          if (i < 0 || j < 0) {
            position_.push_back(-1);
            continue;
          }
          const auto begin = columns.begin() + block_start_[i], end = columns.begin() + block_start_[i + 1];
          position_.push_back(Ap_[3 * i] + 3 * static_cast<int>(std::lower_bound(begin, end, j) - begin));
        }
      clique_position_.push_back(position_.size());
    }
    diagonal_.resize(nb);
    for (int i = 0; i < nb; ++i) {
      const auto begin = columns.begin() + block_start_[i], end = columns.begin() + block_start_[i + 1];
      diagonal_[i] = Ap_[3 * i] + 3 * static_cast<int>(std::lower_bound(begin, end, i) - begin);
    }
    small_ = n_ < 1500;
  }

  void zero() override { std::fill(Ax_.begin(), Ax_.end(), 0.0), factored_ = false; }

  void add(int clique, const double* K) override {
    const auto blocks = (*cliques_)[clique];
    const size_t n = blocks.size();
    const int* position = position_.data() + clique_position_[clique];
    for (size_t i = 0; i < n; ++i) {
      if (blocks[i] < 0) continue;
      const int length = 3 * (block_start_[blocks[i] + 1] - block_start_[blocks[i]]);
      for (size_t j = 0; j < n; ++j) {
        const int p = position[i * n + j];
        if (p < 0) continue;
        for (int r = 0; r < 3; ++r) {
          double* to = Ax_.data() + p + r * length;
          const double* from = K + (3 * i + r) * 3 * n + 3 * j;
          to[0] += from[0], to[1] += from[1], to[2] += from[2];
        }
      }
    }
  }

  void add_diagonal(int block, const double d[3]) override {
    const int length = 3 * (block_start_[block + 1] - block_start_[block]);
    for (int r = 0; r < 3; ++r) Ax_[diagonal_[block] + r * length + r] += d[r];
  }

  void sum_shared(std::span<double>) override {}

  SolveReport solve(std::span<const double> b, std::span<double> x) override {
    if (factored_ && small_) return apply_inverse(b.data(), x.data()), SolveReport{};
    if (factored_) return refined(b, x, 2);
    factored_ = true;
    // pivots of the factorisation before serve again while the residual says that they are good ones
    if (small_ && klu_numeric_ && klu_refactor(Ap_.data(), Ai_.data(), Ax_.data(), klu_symbolic_, klu_numeric_, &common_))
      if (const SolveReport report = refined(b, x, 1); report.ok) return report;
    // above the size of KLU a factorisation costs a dozen solves: the last one, refined, often serves this matrix too
    if (!small_ && umf_numeric_)
      if (const SolveReport report = refined(b, x, 10, 0.2); report.residual < 1e-9) return report;
    const bool ok = small_ ? factor_klu() : factor_umfpack();
    if (!ok) return factored_ = false, SolveReport{false, 1, 0, "the matrix is singular"};
    return refined(b, x, 3);
  }
  bool repeats_cheaply() const override { return small_; }  // UMFPACK: its solves with lagged factors are what a step costs

  std::string name() const override { return small_ ? "light (KLU)" : "light (UMFPACK)"; }

 private:
  /// x from the factors, refined until the residual is at round-off or shrinks by less than `contraction` in a pass; not ok when it
  /// stays above 1e-6.
  SolveReport refined(std::span<const double> b, std::span<double> x, int passes, double contraction = 1e300) {
    SolveReport report;
    double before = 1e300, backward = 0;
    apply_inverse(b.data(), x.data());
    residual_.resize(n_), correction_.resize(n_);
    for (int pass = 0;; ++pass) {
      double worst = 0, norm = 0, terms = 0;  // of the residual, of b, and of the terms summed
      for (int i = 0; i < n_; ++i) {
        double s = b[i], sum = std::abs(b[i]);
        for (int k = Ap_[i]; k < Ap_[i + 1]; ++k) {
          const double term = Ax_[k] * x[Ai_[k]];
          s -= term, sum += std::abs(term);
        }
        residual_[i] = s;
        norm = std::max(norm, std::abs(b[i])), terms = std::max(terms, sum);
        if (!(std::abs(s) <= worst)) worst = std::abs(s);
      }
      constexpr double tiny = 1e-280;  // what is at rest but for numbers below the normal ones has no relative residual
      report.residual = norm > tiny ? worst / norm : worst;
      backward = terms > tiny ? worst / terms : 0;
      if (!std::isfinite(report.residual)) return {false, report.residual, 0, "the matrix is singular to working precision"};
      if (report.residual < (contraction < 1 ? 1e-9 : 1e-11) || pass == passes || report.residual > contraction * before) break;
      before = report.residual;
      apply_inverse(residual_.data(), correction_.data());
      for (int i = 0; i < n_; ++i) x[i] += correction_[i];
    }
    // an ill-conditioned matrix leaves no better residual than round-off of what the rows sum
    if (report.residual > 1e-6 && backward > 1e-12)
      report.ok = false, report.message = fmt::format("linear residual {:.1e}", report.residual);
    return report;
  }

  bool factor_klu() {
    if (klu_numeric_) klu_free_numeric(&klu_numeric_, &common_);
    if (!klu_symbolic_) klu_symbolic_ = klu_analyze(n_, Ap_.data(), Ai_.data(), &common_);
    if (!klu_symbolic_) return false;
    klu_numeric_ = klu_factor(Ap_.data(), Ai_.data(), Ax_.data(), klu_symbolic_, &common_);
    return klu_numeric_ && common_.status == KLU_OK;
  }
  bool factor_umfpack() {
    double info[UMFPACK_INFO];
    if (!umf_symbolic_ && umfpack_di_symbolic(n_, n_, Ap_.data(), Ai_.data(), Ax_.data(), &umf_symbolic_, control_, info) != UMFPACK_OK)
      return false;
    if (umf_numeric_) umfpack_di_free_numeric(&umf_numeric_);
    const int status = umfpack_di_numeric(Ap_.data(), Ai_.data(), Ax_.data(), umf_symbolic_, &umf_numeric_, control_, info);
    if (status == UMFPACK_ERROR_out_of_memory) throw std::bad_alloc();
    return status == UMFPACK_OK;
  }
  void apply_inverse(const double* b, double* x) {
    if (small_) {
      std::copy(b, b + n_, x);
      klu_tsolve(klu_symbolic_, klu_numeric_, n_, 1, x, &common_);
    } else {
      double info[UMFPACK_INFO];
      umfpack_di_solve(UMFPACK_Aat, Ap_.data(), Ai_.data(), Ax_.data(), x, b, umf_numeric_, control_, info);
    }
  }
  void release() {
    if (klu_numeric_) klu_free_numeric(&klu_numeric_, &common_);
    if (klu_symbolic_) klu_free_symbolic(&klu_symbolic_, &common_);
    if (umf_numeric_) umfpack_di_free_numeric(&umf_numeric_);
    if (umf_symbolic_) umfpack_di_free_symbolic(&umf_symbolic_);
  }

  const Cliques* cliques_ = nullptr;
  int n_ = 0;
  bool small_ = true, factored_ = false;  // factored_: the factors at hand are those of the matrix, or serve it refined
  std::vector<int> block_start_, Ap_, Ai_, position_, diagonal_;
  std::vector<size_t> clique_position_;
  std::vector<double> Ax_, residual_, correction_;
  klu_common common_{};
  klu_symbolic* klu_symbolic_ = nullptr;
  klu_numeric* klu_numeric_ = nullptr;
  double control_[UMFPACK_CONTROL];
  void *umf_symbolic_ = nullptr, *umf_numeric_ = nullptr;
};

}  // namespace

std::unique_ptr<KktSolver> make_light_solver() { return std::make_unique<LightSolver>(); }

}  // namespace hilo
