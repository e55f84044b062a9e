// SPDX-License-Identifier: GPL-3.0-or-later
// The ranks of a run.  One rank never starts MPI.
#pragma once
#include <cstdint>
#include <functional>
#include <numeric>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace hilo {

class Comm {
 public:
  /// Starts MPI when the process was launched by mpirun with more than one rank.
  static Comm& world();
  int rank = 0, size = 1;
  void sum(std::span<double> values) const;  // over the ranks, in place
  double sum(double value) const;
  double max(double value) const;
  std::int64_t sum(std::int64_t value) const;
  void max(std::span<double> values) const;  // in place
  /// Sum of the values of the ranks before this one.
  std::int64_t before(std::int64_t value) const;
  /// The values of rank `from` to all.
  void copy(std::span<double> values, int from) const;
  /// The lists of all ranks, one after the other; T has no pointers in it.
  template <class T>
  std::vector<T> gather(const std::vector<T>& mine) const {
    static_assert(std::is_trivially_copyable_v<T>);
    if (size == 1) return mine;
    const std::vector<int> count = counts(mine.size());
    std::vector<T> all(std::accumulate(count.begin(), count.end(), size_t{0}));
    gather(mine.data(), all.data(), count, sizeof(T));
    return all;
  }
  void barrier() const;
  /// Row i of the result is what rank i sent to this rank.  More than 2^31 values at once are an Error on all ranks (exit 4).
  template <class T>
  std::vector<std::vector<T>> exchange(const std::vector<std::vector<T>>& to_each_rank) const;
  /// Run what may fail on some ranks only; the Error of the lowest rank that failed is then thrown on all, so that none waits for another.
  void together(const std::function<void()>& body) const;
  /// Ends all ranks with this exit code.
  [[noreturn]] void abort(int exit_code) const;
  /// Regular end of MPI, where it was started.
  void finish();

 private:
  Comm();
  std::vector<int> counts(size_t mine) const;
  void gather(const void* mine, void* all, const std::vector<int>& count, size_t bytes_each) const;
};

}  // namespace hilo
