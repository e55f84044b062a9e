// SPDX-License-Identifier: GPL-3.0-or-later
// HILO_WIDE before a function: compiled once for each generation of vectors; which copy is called is settled when the program starts.
#pragma once
#if defined(__x86_64__)
#define HILO_WIDE [[gnu::target_clones("arch=skylake-avx512", "arch=haswell", "default")]]
#else
#define HILO_WIDE
#endif
