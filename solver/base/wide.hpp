// SPDX-License-Identifier: GPL-3.0-or-later
// HILO_WIDE before a function: compiled once for each width of vectors; which copy is called is settled when the program starts.  Levels of
// x86-64 are told by what a processor can do; the name of a processor ("haswell") would be told by being that one alone.
#pragma once
#if defined(__x86_64__) && !defined(__clang__)
#define HILO_WIDE [[gnu::target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")]]
#else
#define HILO_WIDE
#endif
