// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/comm.hpp"

#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <new>
#include <thread>
#include <utility>

#include "base/crowd.hpp"
#include "base/error.hpp"
#include "base/watch.hpp"

namespace hilo {

/// A call that all ranks make, while it lasts.
class Comm::Call {
 public:
  Call(const Comm& comm, const Where& at) : watch_(comm.watch_) {
    if (comm.works_alone_)
      throw Error("", "a rank that works alone calls the others at " + Watch::text(at) + ", and would wait for ever", "", Exit::fault);
    if (watch_) watch_->waits(at);
  }
  ~Call() {
    if (watch_) watch_->goes_on();
  }
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

 private:
  Watch* watch_;
};

Comm& Comm::world() {
  static Comm comm;
  return comm;
}

const Comm& Comm::alone() {
  static const Comm comm{OneRank{}};
  return comm;
}

Comm::Comm() {
  const char* n = std::getenv("OMPI_COMM_WORLD_SIZE");
  if (!n) n = std::getenv("PMI_SIZE");
  if (!n || std::atoi(n) < 2) return;
  int runs = 0;
  MPI_Initialized(&runs);  // a module with a copy of this object (libhilo-petsc.so) finds it running
  if (!runs) {
    setenv("HWLOC_COMPONENTS", "-gl", 0);  // hwloc asks an X server for its screens: seconds where names are not resolved
    MPI_Init(nullptr, nullptr);
  }
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  if (runs) return;
  watch_ = new Watch(rank, size);
  if (const Crowd here = crowd(*this); here.ranks > here.cores) sleep_while_waiting();
}

void Comm::sum(std::span<double> v, Where at) const {
  const Call call(*this, at);
  if (size > 1) MPI_Allreduce(MPI_IN_PLACE, v.data(), static_cast<int>(v.size()), MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
}
double Comm::sum(double v, Where at) const {
  sum(std::span<double>(&v, 1), at);
  return v;
}
double Comm::max(double v, Where at) const {
  max(std::span<double>(&v, 1), at);
  return v;
}
std::int64_t Comm::sum(std::int64_t v, Where at) const {
  const Call call(*this, at);
  if (size > 1) MPI_Allreduce(MPI_IN_PLACE, &v, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
  return v;
}
void Comm::max(std::span<double> v, Where at) const {
  const Call call(*this, at);
  for (double& x : v)
    if (std::isnan(x)) x = std::numeric_limits<double>::infinity();  // MPI_MAX would let it pass or not by the order of ranks
  if (size > 1) MPI_Allreduce(MPI_IN_PLACE, v.data(), static_cast<int>(v.size()), MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
}
std::int64_t Comm::before(std::int64_t v, Where at) const {
  const Call call(*this, at);
  std::int64_t out = 0;
  if (size > 1) MPI_Exscan(&v, &out, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
  return rank == 0 ? 0 : out;  // Exscan leaves that of rank 0 undefined
}
void Comm::copy(std::span<double> v, int from, Where at) const {
  const Call call(*this, at);
  if (size > 1) MPI_Bcast(v.data(), static_cast<int>(v.size()), MPI_DOUBLE, from, MPI_COMM_WORLD);
}
void Comm::barrier(Where at) const {
  const Call call(*this, at);
  if (size > 1) MPI_Barrier(MPI_COMM_WORLD);
}
void Comm::abort(int exit_code) const {
  if (size > 1) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));  // Open MPI 5 has lost what was said just before
    MPI_Abort(MPI_COMM_WORLD, exit_code);
  }
  std::exit(exit_code);
}
void Comm::finish() {
  delete std::exchange(watch_, nullptr);
  if (size > 1) MPI_Finalize();
}

namespace {

/// A value of any type, as so many bytes.
class Bytes {
 public:
  explicit Bytes(size_t n) { MPI_Type_contiguous(static_cast<int>(n), MPI_BYTE, &type), MPI_Type_commit(&type); }
  ~Bytes() { MPI_Type_free(&type); }
  Bytes(const Bytes&) = delete;
  Bytes& operator=(const Bytes&) = delete;
  MPI_Datatype type;
};

constexpr std::int64_t most = std::numeric_limits<int>::max();  // values that MPI counts
[[noreturn]] void too_many() { throw Error("", "more than 2^31 values travel between ranks at once", "use more ranks", Exit::resources); }

}  // namespace

std::vector<int> Comm::counts(size_t mine, Where where) const {
  const Call call(*this, where);
  const auto n = static_cast<std::int64_t>(mine);
  if (size == 1) return {static_cast<int>(n)};
  std::vector<std::int64_t> all(size);
  MPI_Allgather(&n, 1, MPI_INT64_T, all.data(), 1, MPI_INT64_T, MPI_COMM_WORLD);
  if (std::accumulate(all.begin(), all.end(), std::int64_t{0}) > most) too_many();
  return {all.begin(), all.end()};
}

void Comm::gather(const void* mine, void* all, const std::vector<int>& count, size_t bytes_each, Where where) const {
  const Call call(*this, where);
  std::vector<int> at(size, 0);
  for (int r = 1; r < size; ++r) at[r] = at[r - 1] + count[r - 1];
  const Bytes value(bytes_each);
  MPI_Allgatherv(mine, count[rank], value.type, all, count.data(), at.data(), value.type, MPI_COMM_WORLD);
}

template <class T>
std::vector<std::vector<T>> Comm::exchange(const std::vector<std::vector<T>>& to, Where at) const {
  const Call call(*this, at);
  if (size == 1) return to;
  std::int64_t n_out = 0, n_in = 0;
  for (const auto& list : to) n_out += static_cast<std::int64_t>(list.size());
  std::vector<std::int64_t> n_send(size), n_recv(size);
  for (int r = 0; r < size; ++r) n_send[r] = n_out > most ? -1 : static_cast<std::int64_t>(to[r].size());
  MPI_Alltoall(n_send.data(), 1, MPI_INT64_T, n_recv.data(), 1, MPI_INT64_T, MPI_COMM_WORLD);
  bool too_much = n_out > most;
  for (const auto n : n_recv) too_much = too_much || n < 0, n_in += n;
  std::int64_t beyond = too_much || n_in > most;
  MPI_Allreduce(MPI_IN_PLACE, &beyond, 1, MPI_INT64_T, MPI_MAX, MPI_COMM_WORLD);
  if (beyond) too_many();
  std::vector<int> send(n_send.begin(), n_send.end()), recv(n_recv.begin(), n_recv.end()), at_send(size), at_recv(size);
  std::vector<T> out, in(static_cast<size_t>(n_in));
  out.reserve(static_cast<size_t>(n_out));
  for (int r = 0, at = 0; r < size; at += recv[r++]) {
    at_send[r] = static_cast<int>(out.size());
    out.insert(out.end(), to[r].begin(), to[r].end());
    at_recv[r] = at;
  }
  const Bytes value(sizeof(T));
  MPI_Alltoallv(out.data(), send.data(), at_send.data(), value.type, in.data(), recv.data(), at_recv.data(), value.type, MPI_COMM_WORLD);
  std::vector<std::vector<T>> from(size);
  for (int r = 0; r < size; ++r) from[r].assign(in.begin() + at_recv[r], in.begin() + at_recv[r] + recv[r]);
  return from;
}
template std::vector<std::vector<double>> Comm::exchange(const std::vector<std::vector<double>>&, Where) const;
template std::vector<std::vector<std::int32_t>> Comm::exchange(const std::vector<std::vector<std::int32_t>>&, Where) const;
template std::vector<std::vector<std::int64_t>> Comm::exchange(const std::vector<std::vector<std::int64_t>>&, Where) const;
template std::vector<std::vector<char>> Comm::exchange(const std::vector<std::vector<char>>&, Where) const;

void Comm::on_first(const std::function<void()>& body, Where at) const {
  together(
      [&] {
        if (rank != 0) return;
        const Alone now(*this);
        body();
      },
      at);
}

void Comm::together(const std::function<void()>& body, Where at) const {
  if (size == 1) return body();
  std::string parts[3];
  int code = 0;
  const auto note = [&](const std::string& where, const std::string& what, const std::string& hint, Exit exit) {
    parts[0] = where, parts[1] = what, parts[2] = hint, code = static_cast<int>(exit);
  };
  try {
    body();
  } catch (const Error& e) {
    note(e.where, e.message, e.hint, e.exit);
  } catch (const std::bad_alloc&) {
    note("", "out of memory", "", Exit::resources);
  }
  if (max(static_cast<double>(code), at) == 0) return;
  std::vector<char> said;
  if (code) {
    said.push_back(static_cast<char>(code));
    for (const auto& part : parts) said.insert(said.end(), part.begin(), part.end()), said.push_back('\0');
  }
  for (const auto& list : exchange(std::vector<std::vector<char>>(size, said), at)) {
    if (list.empty()) continue;
    const char* at = list.data() + 1;
    for (auto& part : parts) part = at, at += part.size() + 1;
    throw Error(parts[0], parts[1], parts[2], static_cast<Exit>(list[0]));
  }
}

}  // namespace hilo
