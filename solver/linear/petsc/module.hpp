// SPDX-License-Identifier: GPL-3.0-or-later
// What libhilo-petsc.so offers to its loader.
#pragma once
#include "linear/kkt.hpp"

/// "direct", "cg", "iterative", "bddc" or "feti-dp"; starts PETSc (and MPI where it does not run yet) at the first call.  `tool` is named
/// in errors.
extern "C" hilo::KktSolver* hilo_make_petsc_solver(const char* kind, double tolerance, int subdomains, const char* tool);
