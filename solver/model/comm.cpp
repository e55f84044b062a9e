#include "model/comm.hpp"

#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include <cstdlib>

namespace hilo {

Comm& Comm::world() {
  static Comm comm;
  return comm;
}

Comm::Comm() {
  const char* n = std::getenv("OMPI_COMM_WORLD_SIZE");
  if (!n) n = std::getenv("PMI_SIZE");
  if (!n || std::atoi(n) < 2) return;
  MPI_Init(nullptr, nullptr);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
}

void Comm::sum(std::span<double> v) const {
  if (size > 1) MPI_Allreduce(MPI_IN_PLACE, v.data(), static_cast<int>(v.size()), MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
}
double Comm::sum(double v) const {
  sum(std::span<double>(&v, 1));
  return v;
}
double Comm::max(double v) const {
  if (size > 1) MPI_Allreduce(MPI_IN_PLACE, &v, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  return v;
}
std::int64_t Comm::sum(std::int64_t v) const {
  if (size > 1) MPI_Allreduce(MPI_IN_PLACE, &v, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
  return v;
}
void Comm::barrier() const {
  if (size > 1) MPI_Barrier(MPI_COMM_WORLD);
}
void Comm::abort(int exit_code) const {
  if (size > 1) MPI_Abort(MPI_COMM_WORLD, exit_code);
  std::exit(exit_code);
}
void Comm::finish() {
  if (size > 1) MPI_Finalize();
}

template <class T>
std::vector<std::vector<T>> Comm::exchange(const std::vector<std::vector<T>>& to) const {
  if (size == 1) return to;
  std::vector<int> n_send(size), n_recv(size), at_send(size), at_recv(size);
  std::vector<char> out, in;
  for (int r = 0; r < size; ++r) {
    at_send[r] = static_cast<int>(out.size());
    const char* p = reinterpret_cast<const char*>(to[r].data());
    out.insert(out.end(), p, p + to[r].size() * sizeof(T));
    n_send[r] = static_cast<int>(out.size()) - at_send[r];
  }
  MPI_Alltoall(n_send.data(), 1, MPI_INT, n_recv.data(), 1, MPI_INT, MPI_COMM_WORLD);
  int total = 0;
  for (int r = 0; r < size; ++r) at_recv[r] = total, total += n_recv[r];
  in.resize(total);
  MPI_Alltoallv(out.data(), n_send.data(), at_send.data(), MPI_CHAR, in.data(), n_recv.data(), at_recv.data(), MPI_CHAR, MPI_COMM_WORLD);
  std::vector<std::vector<T>> from(size);
  for (int r = 0; r < size; ++r) {
    const T* p = reinterpret_cast<const T*>(in.data() + at_recv[r]);
    from[r].assign(p, p + n_recv[r] / sizeof(T));
  }
  return from;
}
template std::vector<std::vector<double>> Comm::exchange(const std::vector<std::vector<double>>&) const;
template std::vector<std::vector<std::int64_t>> Comm::exchange(const std::vector<std::vector<std::int64_t>>&) const;

}  // namespace hilo
