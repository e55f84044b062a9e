// The ranks of a run.  One rank never starts MPI.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
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
};

}  // namespace hilo
