// SPDX-License-Identifier: GPL-3.0-or-later
// The kernels that OpenBLAS takes.
#pragma once

namespace hilo {

/// OpenBLAS knows the processors of its time and takes its oldest kernels (Prescott, of 2004) on later ones.  Where it has, and the
/// processor has AVX2 or AVX-512, the process starts anew with OPENBLAS_CORETYPE, which the library reads before any main.  Call it first
/// of all.
void use_kernels_of_this_processor(char** argv);

}  // namespace hilo
