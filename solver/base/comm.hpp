// SPDX-License-Identifier: GPL-3.0-or-later
// The ranks of a run.  One rank never starts MPI.
#pragma once
#include <cstdint>
#include <cstring>
#include <functional>
#include <numeric>
#include <source_location>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace hilo {

class Watch;

/// Calls that all ranks must make take the place in the source that makes them (base/watch.hpp).
class Comm {
  using Where = std::source_location;

 public:
  /// Starts MPI when the process was launched by mpirun with more than one rank.  For mains; all else is handed its Comm.
  static Comm& world();
  /// Of one rank that has everything, such as a whole mesh: whatever is done with it waits for nobody.
  static const Comm& alone();
  int rank = 0, size = 1;
  void sum(std::span<double> values, Where at = Where::current()) const;  // over the ranks, in place
  double sum(double value, Where at = Where::current()) const;
  double max(double value, Where at = Where::current()) const;
  std::int64_t sum(std::int64_t value, Where at = Where::current()) const;
  void max(std::span<double> values, Where at = Where::current()) const;  // in place
  /// Sum of the values of the ranks before this one.
  std::int64_t before(std::int64_t value, Where at = Where::current()) const;
  /// The values of rank `from` to all.
  void copy(std::span<double> values, int from, Where at = Where::current()) const;
  /// The lists of all ranks, one after the other; T has no pointers in it.
  template <class T>
  std::vector<T> gather(const std::vector<T>& mine, Where at = Where::current()) const {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::vector<int> count = counts(mine.size(), at);
    if (size == 1) return mine;
    std::vector<T> all(std::accumulate(count.begin(), count.end(), size_t{0}));
    gather(mine.data(), all.data(), count, sizeof(T), at);
    return all;
  }
  /// The list of rank 0, on all.
  template <class T>
  std::vector<T> of_first(std::vector<T> mine, Where at = Where::current()) const {
    if (rank != 0) mine.clear();
    return gather(mine, at);
  }
  /// The lists of all ranks, one after the other, on rank 0 alone; T has no pointers in it.
  template <class T>
  std::vector<T> to_first(const std::vector<T>& mine, Where at = Where::current()) const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<std::vector<char>> to(size);
    to[0].resize(mine.size() * sizeof(T));
    if (!mine.empty()) std::memcpy(to[0].data(), mine.data(), to[0].size());
    std::vector<T> all;
    for (const std::vector<char>& list : exchange(to, at)) {
      const size_t before = all.size();
      all.resize(before + list.size() / sizeof(T));
      if (!list.empty()) std::memcpy(all.data() + before, list.data(), list.size());
    }
    return all;
  }
  void barrier(Where at = Where::current()) const;
  /// Row i of the result is what rank i sent to this rank.  More than 2^31 values at once are an Error on all ranks (exit 4).
  template <class T>
  std::vector<std::vector<T>> exchange(const std::vector<std::vector<T>>& to_each_rank, Where at = Where::current()) const;
  /// Run what may fail on some ranks only; the Error of the lowest rank that failed is then thrown on all, so that none waits for another.
  void together(const std::function<void()>& body, Where at = Where::current()) const;
  /// While it lasts, this rank works alone and cannot call the others, which would wait for ever: an Error (exit 5) that names the call,
  /// with one rank as with many.
  class Alone {
   public:
    explicit Alone(const Comm& comm) : comm_(comm), before_(comm.works_alone_) { comm_.works_alone_ = true; }
    ~Alone() { comm_.works_alone_ = before_; }
    Alone(const Alone&) = delete;
    Alone& operator=(const Alone&) = delete;

   private:
    const Comm& comm_;
    bool before_;
  };
  /// Run on rank 0 Alone, its Error thrown on all.
  void on_first(const std::function<void()>& body, Where at = Where::current()) const;
  /// Ends all ranks with this exit code.
  [[noreturn]] void abort(int exit_code) const;
  /// Regular end of MPI, where it was started.
  void finish();

 private:
  struct OneRank {};
  class Call;
  Comm();
  explicit Comm(OneRank) {}
  std::vector<int> counts(size_t mine, Where at) const;
  void gather(const void* mine, void* all, const std::vector<int>& count, size_t bytes_each, Where at) const;
  Watch* watch_ = nullptr;  // where this process started MPI, until finish()
  mutable bool works_alone_ = false;
};

}  // namespace hilo
