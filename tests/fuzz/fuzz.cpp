// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer's entry: bytes become a file in memory, which the reader named by HILO_FUZZ reads.  make -C tests fuzz
#include <fmt/format.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "base/error.hpp"
#include "fuzz/readers.hpp"

namespace {
const hilo::test::Reader* reader = nullptr;
std::string path;
}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  const char* wanted = std::getenv("HILO_FUZZ");
  for (const auto& r : hilo::test::readers())
    if (wanted && r.name == wanted) reader = &r;
  if (!reader) {
    for (const auto& r : hilo::test::readers()) fmt::print("{}\n", r.name);
    std::exit(wanted ? 1 : 0);
  }
  path = fmt::format("/dev/shm/hilo-fuzz-{}{}", getpid(), reader->ending);
  std::atexit([] { std::remove(path.c_str()); });
  hilo::quiet_warnings(true);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, size_t n) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (!file || std::fwrite(bytes, 1, n, file) != n || std::fclose(file)) std::abort();
  if (const std::string wrong = hilo::test::offence(*reader, path); !wrong.empty()) {
    fmt::print(stderr, "{}: {}\n", reader->name, wrong);
    std::abort();
  }
  return 0;
}
