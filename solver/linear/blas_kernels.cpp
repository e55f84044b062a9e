// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/blas_kernels.hpp"

#include <dlfcn.h>
#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace hilo {

void use_kernels_of_this_processor([[maybe_unused]] char** argv) {
#ifdef __x86_64__
  constexpr const char* variable = "OPENBLAS_CORETYPE";
  const auto name = reinterpret_cast<const char* (*)()>(::dlsym(RTLD_DEFAULT, "openblas_get_corename"));
  if (std::getenv(variable) || !name || std::string_view(name()) != "Prescott") return;
  const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512cd");
  if (!avx512 && !(__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))) return;
  ::setenv(variable, avx512 ? "SKYLAKEX" : "HASWELL", 0);
  ::execv("/proc/self/exe", argv);
  ::unsetenv(variable);  // slower, but right
#endif
}

}  // namespace hilo
