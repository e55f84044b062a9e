// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/traffic.hpp"

#define OMPI_SKIP_MPICXX 1
#include <mpi.h>

#include <map>

namespace {

hilo::Traffic sum;

double bytes_of(int count, MPI_Datatype type) {
  int size = 0;
  PMPI_Type_size(type, &size);
  return static_cast<double>(count) * size;
}
void message(double bytes) { ++sum.messages, sum.bytes += bytes; }
void collective(double bytes, MPI_Comm comm) {
  int size = 1;
  PMPI_Comm_size(comm, &size);
  if (size > 1) ++sum.collectives, sum.bytes += bytes;
}
std::map<MPI_Request, double>& prepared() {  // bytes of the persistent sends
  static std::map<MPI_Request, double> list;
  return list;
}
void started(MPI_Request request) {
  if (const auto it = prepared().find(request); it != prepared().end()) message(it->second);
}

}  // namespace

namespace hilo {
const Traffic& traffic() { return sum; }
}  // namespace hilo

// The profiling interface of the standard [mpi-4.0, ch. 15]: an MPI_ function of the program's own comes before the library's, which is
// still there under its name with a P.
extern "C" {

int MPI_Send(const void* data, int n, MPI_Datatype type, int to, int tag, MPI_Comm comm) {
  message(bytes_of(n, type));
  return PMPI_Send(data, n, type, to, tag, comm);
}
int MPI_Isend(const void* data, int n, MPI_Datatype type, int to, int tag, MPI_Comm comm, MPI_Request* request) {
  message(bytes_of(n, type));
  return PMPI_Isend(data, n, type, to, tag, comm, request);
}
int MPI_Issend(const void* data, int n, MPI_Datatype type, int to, int tag, MPI_Comm comm, MPI_Request* request) {
  message(bytes_of(n, type));
  return PMPI_Issend(data, n, type, to, tag, comm, request);
}
int MPI_Send_init(const void* data, int n, MPI_Datatype type, int to, int tag, MPI_Comm comm, MPI_Request* request) {
  const int code = PMPI_Send_init(data, n, type, to, tag, comm, request);
  if (code == MPI_SUCCESS) prepared()[*request] = bytes_of(n, type);
  return code;
}
int MPI_Request_free(MPI_Request* request) {
  prepared().erase(*request);
  return PMPI_Request_free(request);
}
int MPI_Start(MPI_Request* request) {
  started(*request);
  return PMPI_Start(request);
}
int MPI_Startall(int n, MPI_Request requests[]) {
  for (int i = 0; i < n; ++i) started(requests[i]);
  return PMPI_Startall(n, requests);
}
int MPI_Alltoall(const void* data, int n, MPI_Datatype type, void* to, int n_to, MPI_Datatype to_type, MPI_Comm comm) {
  int size = 1;
  PMPI_Comm_size(comm, &size);
  collective((size - 1) * bytes_of(n, type), comm);
  return PMPI_Alltoall(data, n, type, to, n_to, to_type, comm);
}
int MPI_Alltoallv(const void* data, const int n[], const int at[], MPI_Datatype type, void* to, const int n_to[], const int at_to[],
                  MPI_Datatype to_type, MPI_Comm comm) {
  int size = 1, rank = 0;
  PMPI_Comm_size(comm, &size), PMPI_Comm_rank(comm, &rank);
  for (int r = 0; r < size && data != MPI_IN_PLACE; ++r)
    if (r != rank && n[r] > 0) message(bytes_of(n[r], type));
  return PMPI_Alltoallv(data, n, at, type, to, n_to, at_to, to_type, comm);
}
int MPI_Allreduce(const void* data, void* to, int n, MPI_Datatype type, MPI_Op op, MPI_Comm comm) {
  collective(bytes_of(n, type), comm);
  return PMPI_Allreduce(data, to, n, type, op, comm);
}
int MPI_Exscan(const void* data, void* to, int n, MPI_Datatype type, MPI_Op op, MPI_Comm comm) {
  collective(bytes_of(n, type), comm);
  return PMPI_Exscan(data, to, n, type, op, comm);
}
int MPI_Iallreduce(const void* data, void* to, int n, MPI_Datatype type, MPI_Op op, MPI_Comm comm, MPI_Request* request) {
  collective(bytes_of(n, type), comm);
  return PMPI_Iallreduce(data, to, n, type, op, comm, request);
}
int MPI_Reduce(const void* data, void* to, int n, MPI_Datatype type, MPI_Op op, int root, MPI_Comm comm) {
  collective(bytes_of(n, type), comm);
  return PMPI_Reduce(data, to, n, type, op, root, comm);
}
int MPI_Bcast(void* data, int n, MPI_Datatype type, int root, MPI_Comm comm) {
  collective(bytes_of(n, type), comm);
  return PMPI_Bcast(data, n, type, root, comm);
}
int MPI_Allgather(const void* data, int n, MPI_Datatype type, void* to, int n_to, MPI_Datatype to_type, MPI_Comm comm) {
  collective(data == MPI_IN_PLACE ? bytes_of(n_to, to_type) : bytes_of(n, type), comm);
  return PMPI_Allgather(data, n, type, to, n_to, to_type, comm);
}
int MPI_Allgatherv(const void* data, int n, MPI_Datatype type, void* to, const int n_to[], const int at_to[], MPI_Datatype to_type,
                   MPI_Comm comm) {
  collective(data == MPI_IN_PLACE ? 0 : bytes_of(n, type), comm);
  return PMPI_Allgatherv(data, n, type, to, n_to, at_to, to_type, comm);
}

}  // extern "C"
