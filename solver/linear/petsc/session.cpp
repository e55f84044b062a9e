// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/petsc/session.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "base/error.hpp"

namespace hilo::petsc {
namespace {

std::string& said() {
  static std::string text;
  return text;
}

/// Keeps the first message of an error on its way up.
PetscErrorCode note(MPI_Comm, int, const char* function, const char*, PetscErrorCode code, PetscErrorType type, const char* message,
                    void*) {
  if (type == PETSC_ERROR_INITIAL) said() = fmt::format("{} in {}", message && *message ? message : "error", function);
  return code;
}

int finish(MPI_Comm, int, void*, void*) {
  PetscFinalize();
  return MPI_SUCCESS;
}

}  // namespace

void start() {
  static const bool once = [] {
    int runs = 0;
    MPI_Initialized(&runs);
    if (!runs) setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);  // or a run alone starts a daemon, for a quarter of a second
    PetscOptionsSetValue(nullptr, "-skip_petscrc", nullptr);
    PetscOptionsSetValue(nullptr, "-no_signal_handler", nullptr);
    if (PetscInitializeNoArguments()) throw Error("PETSc", "cannot start", "", Exit::resources);
    PetscPushErrorHandler(note, nullptr);
    if (runs) {  // MPI_Finalize frees the attributes of MPI_COMM_SELF first
      int key;
      MPI_Comm_create_keyval(MPI_COMM_NULL_COPY_FN, finish, &key, nullptr);
      MPI_Comm_set_attr(MPI_COMM_SELF, key, nullptr);
    } else {
      std::atexit([] { PetscFinalize(); });
    }
    return true;
  }();
  (void)once;
}

void fail(const std::string& what, int exit_code) {
  const std::string line = what.substr(0, what.find('\n'));
  if (size() > 1) {
    fmt::print(stderr, "{}: PETSc: {} (on rank {})\n", tool_name(), line, rank());
    std::fflush(stderr);
    MPI_Abort(PETSC_COMM_WORLD, exit_code);
  }
  throw Error("PETSc", line, "", static_cast<Exit>(exit_code));
}

void check(PetscErrorCode code) {
  if (code == 0) return;
  const bool memory = code == PETSC_ERR_MEM;
  fail(memory           ? "out of memory"
       : said().empty() ? fmt::format("error {}", code)
                        : said(),
       static_cast<int>(memory ? Exit::resources : Exit::fault));
}

}  // namespace hilo::petsc
