// SPDX-License-Identifier: GPL-3.0-or-later
// PETSc's start and end, and its errors.
#pragma once
#define OMPI_SKIP_MPICXX 1
#include <petscsys.h>

#include <string>

#include "base/comm.hpp"

namespace hilo::petsc {

/// Start PETSc once.  It ends before MPI does, or with the process where PETSc started MPI.
void start();

/// Throw what PETSc said as an Error (exit 4 where memory ran out, else 5).  With several ranks all of them are ended instead: the others
/// may be waiting for this one.
void check(PetscErrorCode code);

/// An Error of one rank that the others do not share; like check().
[[noreturn]] void fail(const std::string& what, int exit_code);

/// The ranks; PETSc runs on all of them.
inline const Comm& comm() { return Comm::world(); }
inline int rank() { return comm().rank; }
inline int size() { return comm().size; }

}  // namespace hilo::petsc
