// Lists of values from every rank to every rank.
#pragma once
#include <limits>
#include <type_traits>
#include <vector>

#include "base/error.hpp"
#include "linear/petsc/session.hpp"

namespace hilo::petsc {

/// Row i of the result is what rank i sent here.
template <class T>
std::vector<std::vector<T>> exchange(const std::vector<std::vector<T>>& to) {
  const int n = size();
  if (n == 1) return to;
  const MPI_Datatype type = std::is_same_v<T, double> ? MPI_DOUBLE : MPIU_INT;
  static_assert(std::is_same_v<T, double> || std::is_same_v<T, PetscInt>);
  std::vector<int> n_send(n), n_recv(n), at_send(n, 0), at_recv(n, 0);
  size_t total = 0;
  for (int r = 0; r < n; ++r) n_send[r] = static_cast<int>(to[r].size()), total += to[r].size();
  if (total > std::numeric_limits<int>::max())
    fail("more than 2^31 values travel between ranks at once", static_cast<int>(Exit::resources));
  MPI_Alltoall(n_send.data(), 1, MPI_INT, n_recv.data(), 1, MPI_INT, PETSC_COMM_WORLD);
  for (int r = 1; r < n; ++r) at_send[r] = at_send[r - 1] + n_send[r - 1], at_recv[r] = at_recv[r - 1] + n_recv[r - 1];
  std::vector<T> out, in(static_cast<size_t>(at_recv[n - 1]) + n_recv[n - 1]);
  out.reserve(total);
  for (const auto& list : to) out.insert(out.end(), list.begin(), list.end());
  MPI_Alltoallv(out.data(), n_send.data(), at_send.data(), type, in.data(), n_recv.data(), at_recv.data(), type, PETSC_COMM_WORLD);
  std::vector<std::vector<T>> from(n);
  for (int r = 0; r < n; ++r) from[r].assign(in.begin() + at_recv[r], in.begin() + at_recv[r] + n_recv[r]);
  return from;
}

}  // namespace hilo::petsc
