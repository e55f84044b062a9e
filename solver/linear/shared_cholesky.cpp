// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/shared_cholesky.hpp"

#include <algorithm>
#include <exception>

#include "linear/blas_room.hpp"
#include "linear/lapack.hpp"

namespace hilo {
namespace {

constexpr size_t most_values = size_t{1} << 25;  // of the columns that share a pass over the factor, 8 to 24 of them
constexpr int branches_each = 6;                 // branches of a rank, at least

/// X := L^-1 X, then L^-T X, (n x columns).
template <class T>
void sweep(const FrontOrder& order, const std::vector<size_t>& start, const T* values, T* X, int columns) {
  const int n = 3 * static_cast<int>(order.place.size());
  std::vector<T> below;
  const auto at = [&](int f, auto&& visit) {
    const int m = 3 * order.columns(f), height = 3 * order.height(f);
    below.resize(static_cast<size_t>(height - m) * columns);
    visit(m, height, height - m, values + start[f], X + 3 * static_cast<size_t>(order.first[f]),
          order.rows.data() + order.from[f] + order.columns(f));
  };
  for (int f = 0; f < order.n_fronts(); ++f)
    at(f, [&](int m, int height, int n_below, const T* L, T* x, const int* rows) {
      lapack::solve_triangle('N', m, L, height, x, n, columns);
      if (n_below == 0) return;
      lapack::multiply('N', n_below, m, T(-1), L + m, height, x, n, T(0), below.data(), n_below, columns);
      for (int c = 0; c < columns; ++c) {
        T* to = X + static_cast<size_t>(c) * n;
        const T* part = below.data() + static_cast<size_t>(c) * n_below;
        for (int k = 0; k < n_below; k += 3)
          for (int i = 0; i < 3; ++i) to[3 * rows[k / 3] + i] += part[k + i];
      }
    });
  for (int f = order.n_fronts(); f-- > 0;)
    at(f, [&](int m, int height, int n_below, const T* L, T* x, const int* rows) {
      for (int c = 0; c < columns; ++c) {
        const T* of = X + static_cast<size_t>(c) * n;
        T* part = below.data() + static_cast<size_t>(c) * n_below;
        for (int k = 0; k < n_below; k += 3)
          for (int i = 0; i < 3; ++i) part[k + i] = of[3 * rows[k / 3] + i];
      }
      if (n_below > 0) lapack::multiply('T', n_below, m, T(-1), L + m, height, below.data(), n_below, T(1), x, n, columns);
      lapack::solve_triangle('T', m, L, height, x, n, columns);
    });
}

}  // namespace

struct SharedCholesky::Work {
  std::vector<int> local;     // place of each block among the rows of the front at hand
  std::vector<double> panel;  // its columns
  std::vector<std::vector<int>> children;
};

SharedCholesky::SharedCholesky(const Comm& comm) : comm_(comm) { make_room_for_blas(); }

SharedCholesky::~SharedCholesky() {
  if (!std::uncaught_exceptions()) end();
}

void SharedCholesky::end() {
  if (comm_.rank == 0 && !ended_) call(Call::end);
  ended_ = true;
  matrix_ = {}, handed_updates_ = {}, columns_ = {}, double_values_ = {}, single_values_ = {};
  order_.reset(), lower_.reset();
}

void SharedCholesky::call(Call what) {
  double word = static_cast<double>(what);
  comm_.copy({&word, 1}, 0);
}

void SharedCholesky::serve() {
  for (;;) {
    double word = 0;
    comm_.copy({&word, 1}, 0);
    switch (static_cast<Call>(static_cast<int>(word))) {
      case Call::structure:
        share_structure();
        break;
      case Call::factor:
        factor_shared();
        break;
      case Call::solve:
        solve_shared();
        break;
      case Call::end:
        return;
    }
  }
}

void SharedCholesky::structure(Cliques cliques, int n_blocks) {
  order_.emplace(cliques, n_blocks);
  for (int& i : cliques.blocks)
    if (i >= 0) i = order_->place[i];
  lower_ = std::make_unique<LowerBlocks>(cliques, n_blocks);
  cliques_ = std::move(cliques);
  call(Call::structure);
  share_structure();
}

/// What rank 0 has found, to all.
void SharedCholesky::share_structure() {
  if (!order_) order_.emplace(), lower_ = std::make_unique<LowerBlocks>();
  const bool leads = comm_.rank == 0;
  const auto share = [&](auto& list) {
    using T = typename std::decay_t<decltype(list)>::value_type;
    if (comm_.size == 1) return true;
    const SharedArray<T> shared(comm_, list.size());
    if (leads) std::copy(list.begin(), list.end(), shared.begin());
    comm_.barrier();
    if (!leads && shared.seen()) list.assign(shared.begin(), shared.end());
    comm_.barrier();
    return shared.seen();
  };
  bool seen = share(order_->place);
  for (auto* list : {&order_->first, &order_->rows, &order_->parent, &lower_->rows}) seen &= share(*list);
  for (auto* list : {&order_->from, &lower_->start}) seen &= share(*list);
  matrix_ = SharedArray<double>(comm_, 9 * lower_->rows.size());
  const auto all = comm_.gather(std::vector<int>{seen && matrix_.seen() ? comm_.rank : -1});
  helpers_.clear();
  for (const int rank : all)
    if (rank >= 0) helpers_.push_back(rank);
  at_once_ = static_cast<int>(std::clamp<size_t>(most_values / std::max<size_t>(n(), 1), 8, 24));
  divide();
}

/// Branches of the elimination tree to the ranks; what is above them to rank 0.
void SharedCholesky::divide() {
  const auto n = order_->parent.size();
  start_.assign(1, 0);
  for (int f = 0; f < static_cast<int>(n); ++f)
    start_.push_back(start_.back() + 9 * static_cast<size_t>(order_->height(f)) * order_->columns(f));
  rank_.assign(n, 0), handed_at_.assign(n + 1, 0);
  if (helpers_.size() < 2) return;
  std::vector<double> flops(n);
  std::vector<std::vector<int>> children(n + 1);
  double total = 0;
  for (size_t f = 0; f < n; ++f) {
    const double own = order_->flops_of(static_cast<int>(f));
    flops[f] += own, total += own;
    if (order_->parent[f] >= 0) flops[order_->parent[f]] += flops[f];
    children[order_->parent[f] >= 0 ? order_->parent[f] : n].push_back(static_cast<int>(f));
  }
  std::vector<int> branches = children[n];
  const auto less = [&](int a, int b) { return flops[a] != flops[b] ? flops[a] < flops[b] : a < b; };
  std::make_heap(branches.begin(), branches.end(), less);
  std::fill(rank_.begin(), rank_.end(), -1);
  while (!branches.empty() && flops[branches.front()] > total / (branches_each * static_cast<double>(helpers_.size()))) {
    const int f = branches.front();
    std::pop_heap(branches.begin(), branches.end(), less), branches.pop_back();
    rank_[f] = 0;
    for (const int child : children[f]) branches.push_back(child), std::push_heap(branches.begin(), branches.end(), less);
  }
  std::sort(branches.rbegin(), branches.rend(), less);
  std::vector<double> load(helpers_.size(), 0.0);
  std::vector<char> is_branch(n, 0);
  for (const int f : branches) {
    const auto least = std::min_element(load.begin(), load.end()) - load.begin();
    rank_[f] = helpers_[least], load[least] += flops[f], is_branch[f] = 1;
  }
  for (size_t f = n; f-- > 0;)
    if (rank_[f] < 0) rank_[f] = rank_[order_->parent[f]];
  for (size_t f = 0; f < n; ++f) {
    const size_t below = 3 * static_cast<size_t>(order_->height(static_cast<int>(f)) - order_->columns(static_cast<int>(f)));
    handed_at_[f + 1] = handed_at_[f] + (is_branch[f] && rank_[f] != 0 ? below * below : 0);
  }
}

double* SharedCholesky::handed(int front) const {
  return handed_at_[front + 1] > handed_at_[front] ? handed_updates_.data() + handed_at_[front] : nullptr;
}

void SharedCholesky::add(int clique, const double* K) {
  const auto blocks = cliques_[clique];
  const size_t n3 = 3 * blocks.size();
  for (size_t b = 0; b < blocks.size(); ++b) {
    if (blocks[b] < 0) continue;
    const auto begin = lower_->rows.begin() + lower_->start[blocks[b]], end = lower_->rows.begin() + lower_->start[blocks[b] + 1];
    for (size_t a = 0; a < blocks.size(); ++a) {
      if (blocks[a] < blocks[b]) continue;
      double* to = matrix_.data() + 9 * (std::lower_bound(begin, end, blocks[a]) - lower_->rows.begin());
      for (size_t r = 0; r < 3; ++r)
        for (size_t c = 0; c < 3; ++c) to[3 * c + r] += K[(3 * a + r) * n3 + 3 * b + c];
    }
  }
}

void SharedCholesky::add_diagonal(int block, const double d[3]) {
  double* to = matrix_.data() + 9 * lower_->start[order_->place[block]];
  for (int c = 0; c < 3; ++c) to[4 * c] += d[c];
}

bool SharedCholesky::factor(bool single, const std::string& folder, const Told& tell) {
  single_ = single, folder_ = folder, tell_ = tell;
  call(Call::factor);
  return factor_shared();
}

bool SharedCholesky::factor_shared() {
  double single = single_;
  comm_.copy({&single, 1}, 0);
  single_ = single > 0;
  if (single_)
    single_values_ = SharedArray<float>(comm_, start_.back(), folder_);
  else
    double_values_ = SharedArray<double>(comm_, start_.back(), folder_);
  handed_updates_ = SharedArray<double>(comm_, handed_at_.back());
  const bool helps = std::find(helpers_.begin(), helpers_.end(), comm_.rank) != helpers_.end();
  bool good = true;
  double done = 0, mine = 0;
  Work work;
  if (helps) {
    work.local.resize(order_->place.size()), work.children.resize(order_->parent.size());
    for (int f = 0; f < order_->n_fronts(); ++f) {
      if (order_->parent[f] >= 0) work.children[order_->parent[f]].push_back(f);
      if (rank_[f] == comm_.rank) mine += order_->flops_of(f);
    }
    updates_.clear(), updates_.resize(order_->parent.size());
  }
  std::vector<char> is_top(helps ? order_->parent.size() : 0, 0);  // above branches of several ranks: once all of these are done
  if (helpers_.size() > 1)
    for (int f = 0; helps && f < order_->n_fronts(); ++f)
      for (const int child : work.children[f])
        if (is_top[child] || rank_[child] != rank_[f] || handed(child)) is_top[f] = 1;
  for (const char top : {0, 1}) {
    for (int f = 0; helps && good && f < order_->n_fronts(); ++f) {
      if (rank_[f] != comm_.rank || is_top[f] != top) continue;
      good = eliminate(f, work);
      done += order_->flops_of(f);
      if (tell_) tell_(done / mine);
    }
    good = comm_.max(good ? 0 : 1) == 0;
  }
  updates_.clear();
  matrix_ = {}, handed_updates_ = {};
  if (good) columns_ = SharedArray<double>(comm_, n() * at_once_ * helpers_.size());
  return good;
}

bool SharedCholesky::eliminate(int f, Work& work) {
  const FrontOrder& o = *order_;
  const int c = o.columns(f), h = o.height(f), m = 3 * c, height = 3 * h, below = height - m;
  const int* rows = o.rows.data() + o.from[f];
  for (int k = 0; k < h; ++k) work.local[rows[k]] = k;
  auto& panel = work.panel;
  panel.assign(static_cast<size_t>(height) * m, 0.0);
  for (int p = o.first[f]; p < o.first[f + 1]; ++p)
    for (std::int64_t k = lower_->start[p]; k < lower_->start[p + 1]; ++k) {
      const double* from = matrix_.data() + 9 * k;
      for (int column = 0; column < 3; ++column)
        std::copy_n(from + 3 * column, 3,
                    panel.data() + static_cast<size_t>(3 * (p - o.first[f]) + column) * height + 3 * work.local[lower_->rows[k]]);
    }
  const auto square = static_cast<size_t>(below) * below;
  double* update = handed(f);
  if (!update && below > 0) updates_[f] = std::make_unique<double[]>(square), update = updates_[f].get();
  for (const int child : work.children[f]) {  // what they leave is added to the same rows of this one
    const int n = o.height(child) - o.columns(child);
    const int* of = o.rows.data() + o.from[child] + o.columns(child);
    const double* left = handed(child) ? handed(child) : updates_[child].get();
    for (int j = 0; j < n; ++j)
      for (int column = 0; column < 3; ++column, left += 3 * n) {
        const int at = work.local[of[j]];
        double* to = at < c ? panel.data() + static_cast<size_t>(3 * at + column) * height
                            : update + static_cast<size_t>(3 * (at - c) + column) * below - m;
        for (int i = j; i < n; ++i) {
          double* block = to + 3 * work.local[of[i]];
          for (int r = 0; r < 3; ++r) block[r] += left[3 * i + r];
        }
      }
    updates_[child].reset();
  }
  if (!lapack::factor(m, panel.data(), height)) return false;
  if (below > 0) {
    lapack::solve_triangle_right(below, m, panel.data(), height, panel.data() + m, height);
    lapack::subtract_gram(below, m, panel.data() + m, height, update);
  }
  if (single_)
    std::transform(panel.begin(), panel.end(), single_values_.data() + start_[f], [](double v) { return static_cast<float>(v); });
  else
    std::copy(panel.begin(), panel.end(), double_values_.data() + start_[f]);
  return true;
}

void SharedCholesky::solve(Eigen::Ref<Eigen::MatrixXd> X) {
  const Eigen::Index width = columns_at_once();
  for (Eigen::Index k = 0; k < X.cols(); k += width) {
    const auto some = std::min(width, X.cols() - k);
    for (Eigen::Index c = 0; c < some; ++c) {
      double* to = columns_.data() + static_cast<size_t>(c) * n();
      for (size_t i = 0; i < order_->place.size(); ++i) std::copy_n(X.col(k + c).data() + 3 * i, 3, to + 3 * order_->place[i]);
    }
    call(Call::solve);
    n_columns_ = static_cast<int>(some);
    solve_shared();
    for (Eigen::Index c = 0; c < some; ++c) {
      const double* from = columns_.data() + static_cast<size_t>(c) * n();
      for (size_t i = 0; i < order_->place.size(); ++i) std::copy_n(from + 3 * order_->place[i], 3, X.col(k + c).data() + 3 * i);
    }
  }
}

/// Each rank the columns of one pass, so that these are the same ones on any number of ranks.
void SharedCholesky::solve_shared() {
  double columns = n_columns_;
  comm_.copy({&columns, 1}, 0);
  const auto which = std::find(helpers_.begin(), helpers_.end(), comm_.rank) - helpers_.begin();
  const int from = at_once_ * static_cast<int>(which), mine = std::min(at_once_, static_cast<int>(columns) - from);
  if (mine > 0 && which < static_cast<std::ptrdiff_t>(helpers_.size())) {
    double* X = columns_.data() + static_cast<size_t>(from) * n();
    if (single_) {
      Eigen::Map<Eigen::MatrixXd> x(X, static_cast<Eigen::Index>(n()), mine);
      const Eigen::RowVectorXd scale = x.cwiseAbs().colwise().maxCoeff().cwiseMax(1e-300);  // within the range of single precision
      Eigen::MatrixXf y = (x * scale.cwiseInverse().asDiagonal()).cast<float>();
      sweep(*order_, start_, single_values_.data(), y.data(), mine);
      x = y.cast<double>() * scale.asDiagonal();
    } else {
      sweep(*order_, start_, double_values_.data(), X, mine);
    }
  }
  comm_.barrier();
}

}  // namespace hilo
