// SPDX-License-Identifier: GPL-3.0-or-later
// Values kept and restored in the same order, by one function for both ways:
//
//   void archive(Archive& a) { a("spring", angle_, past_); }
//
// A plain struct is walked through all its members (base/members), so a member added later is not forgotten.
// Bits are kept, so what goes on from restored values goes on as it would have.  A mark goes before each list of values; a walk that
// restores others than were kept is an Error (our own fault), not a wrong number.
//
// What all ranks hold alike is kept once, from rank 0, and agrees() sees to it that they do.  What ranks have parts of (values of nodes and
// cells) goes by nodes(), cells() and increments(), in an order that does not depend on the ranks: any number of them can restore it.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/digest.hpp"
#include "base/error.hpp"
#include "base/members.hpp"
#include "base/spread.hpp"

namespace hilo {

class Archive;

/// A class that walks through its own values.
template <class T>
concept Archived = requires(T& x, Archive& a) {
  x.archive(a);
};

/// What was kept: of all ranks alike, and arrays of what they have parts of (on rank 0).
struct Kept {
  std::vector<std::byte> bytes;
  std::vector<std::vector<double>> arrays;
  bool empty() const { return bytes.empty(); }
};

/// How what ranks have parts of lies on this one.
struct Shares {
  Spread nodes;                 // those that a configuration holds, in its order
  Spread blocks;                // nodes of the first blocks of unknowns
  Spread cells;                 // by batch
  std::vector<size_t> batch;    // cells of each
  std::vector<int> remembered;  // and how many numbers each of its cells remembers
  int most_remembered = 0;      // the largest of these, over all ranks
};

class Archive {
 public:
  /// Keeps; without shares, of one rank alone.
  explicit Archive(const Shares* shares = nullptr) : shares_(shares) {}
  explicit Archive(Kept kept, const Shares* shares = nullptr) : kept_(std::move(kept)), shares_(shares), restores_(true) {}
  bool restores() const { return restores_; }
  /// Of a second solution beside that of the run, which nothing looks at: what records what is seen has no part in it.
  bool is_aside = false;
  const Kept& kept() const { return kept_; }
  /// All that was kept is restored.
  bool is_at_end() const { return at_ == kept_.bytes.size(); }
  /// Error where ranks keep different values of what they should hold alike.  Collective.
  void agrees(const Comm& comm) const {
    const std::uint64_t digest = Digest().add(kept_.bytes).value();
    bool differ = false;
    for (const auto half : {static_cast<double>(digest >> 32), static_cast<double>(digest & 0xffffffffu)}) {
      const double most = comm.max(half), least = -comm.max(-half);
      differ = differ || most != least;
    }
    if (differ) throw Error("", "ranks differ in what they should hold alike", "", Exit::fault);
  }

  template <class... T>
  void operator()(std::string_view mark, T&... values) {
    std::string found(mark);
    walk(found);
    if (found != mark) wrong(mark);
    (walk(values), ...);
  }

  /// Vectors of the nodes of a configuration, or none.  Collective, like the others of this kind.
  template <class Vector>
  void nodes(std::vector<Vector>& x) {
    static_assert(sizeof(Vector) == 3 * sizeof(double));
    if (!shares_) return walk(x);
    bool some = any(shares_->nodes, !x.empty());
    walk(some);
    if (restores_) x.resize(some ? shares_->nodes.size() : 0);
    if (some) part(shares_->nodes, reinterpret_cast<double*>(x.data()), 3);
  }
  /// Increments of all blocks of unknowns, those of nodes first, or none.
  void increments(std::vector<double>& z) {
    if (!shares_) return walk(z);
    bool some = any(shares_->blocks, !z.empty());
    walk(some);
    std::vector<double> of_nodes(some ? 3 * shares_->blocks.size() : 0), others;
    if (some && !restores_) {
      std::copy_n(z.begin(), of_nodes.size(), of_nodes.begin());
      others.assign(z.begin() + static_cast<std::ptrdiff_t>(of_nodes.size()), z.end());
    }
    walk(others);
    if (some) part(shares_->blocks, of_nodes.data(), 3);
    z = std::move(of_nodes);
    z.insert(z.end(), others.begin(), others.end());
  }
  /// What the cells of each batch remember, or nothing.
  void cells(std::vector<std::vector<double>>& batches) {
    if (!shares_) return walk(batches);
    bool some = any(shares_->cells, !batches.empty());
    walk(some);
    if (restores_) batches.assign(some ? shares_->batch.size() : 0, {});
    const int most = shares_->most_remembered;
    if (!some || most == 0) return;
    std::vector<double> values(shares_->cells.size() * most, 0.0);
    const auto each = [&](auto&& visit) {
      size_t at = 0;
      for (size_t b = 0; b < batches.size(); ++b)
        for (size_t e = 0; e < shares_->batch[b]; ++e, at += most)
          for (int k = 0; k < shares_->remembered[b]; ++k) visit(values[at + k], batches[b], e * shares_->remembered[b] + k);
    };
    if (!restores_) each([](double& value, std::vector<double>& list, size_t i) { value = list[i]; });
    part(shares_->cells, values.data(), most);
    for (size_t b = 0; b < batches.size(); ++b) batches[b].resize(shares_->batch[b] * shares_->remembered[b]);
    if (restores_) each([](double& value, std::vector<double>& list, size_t i) { list[i] = value; });
  }
  /// Values (n x width) of things that lie on the ranks as `of` tells.
  void spread(const Spread& of, std::vector<double>& x, int width) {
    if (!shares_) return walk(x);
    x.resize(of.size() * static_cast<size_t>(width));
    part(of, x.data(), width);
  }

 private:
  /// Whether any rank has something to keep: one without nodes or cells takes part for the others.
  bool any(const Spread& spread, bool here) const { return !restores_ && spread.any(here); }
  void part(const Spread& spread, double* local, int width) {
    const size_t n = spread.size() * width;
    if (!restores_) {
      kept_.arrays.push_back(spread.gather(std::vector<double>(local, local + n), width));
      return;
    }
    static const std::vector<double> none;
    const std::vector<double> mine = spread.pick(array_ < kept_.arrays.size() ? kept_.arrays[array_] : none, width);
    ++array_;
    std::copy(mine.begin(), mine.end(), local);
  }

  [[noreturn]] static void wrong(std::string_view what) {
    throw Error("", "kept and restored values differ at \"" + std::string(what) + "\"", "", Exit::fault);
  }
  void raw(void* value, size_t n) {
    auto* at = static_cast<std::byte*>(value);
    if (!restores_) {
      kept_.bytes.insert(kept_.bytes.end(), at, at + n);
      return;
    }
    if (n > kept_.bytes.size() - at_) wrong("the end");
    if (n > 0) std::memcpy(at, kept_.bytes.data() + at_, n);
    at_ += n;
  }
  template <class List>
  void size(List& list) {
    auto n = static_cast<std::uint64_t>(list.size());
    raw(&n, sizeof n);
    if (!restores_) return;
    if (n > kept_.bytes.size()) wrong("the size of a list");
    list.resize(n);
  }
  template <class T>
  requires(Archived<T> || std::is_arithmetic_v<T> || std::is_enum_v<T>) void walk(T& x) {
    if constexpr (Archived<T>)
      x.archive(*this);
    else
      raw(&x, sizeof x);
  }
  template <class T>
  requires(std::is_aggregate_v<T>&& std::is_class_v<T> && !Archived<T>) void walk(T& x) {
    with_members(x, [this](auto&... member) { (walk(member), ...); });
  }
  template <class T, int rows, int columns, int options>
  void walk(Eigen::Matrix<T, rows, columns, options>& x) {
    static_assert(rows > 0 && columns > 0);
    raw(x.data(), sizeof(T) * static_cast<size_t>(x.size()));
  }
  void walk(std::string& text) { size(text), raw(text.data(), text.size()); }
  template <class T, size_t n>
  void walk(std::array<T, n>& list) {
    for (T& x : list) walk(x);
  }
  template <class T>
  void walk(std::vector<T>& list) {
    size(list);
    if constexpr (std::is_arithmetic_v<T>)
      raw(list.data(), sizeof(T) * list.size());
    else
      for (T& x : list) walk(x);
  }
  template <class T>
  void walk(std::deque<T>& list) {
    size(list);
    for (T& x : list) walk(x);
  }
  template <class T>
  void walk(std::optional<T>& x) {
    bool has = x.has_value();
    walk(has);
    if (!has) x.reset();
    if (has && !x) x.emplace();
    if (has) walk(*x);
  }

  Kept kept_;
  const Shares* shares_ = nullptr;
  size_t at_ = 0, array_ = 0;
  bool restores_ = false;
};

}  // namespace hilo
