// SPDX-License-Identifier: GPL-3.0-or-later
// What the fuzzer found once (make -C tests fuzz), and what the readers make of it now: each refuses or reads it, in one line, and soon.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "fuzz/readers.hpp"

namespace {

/// No more than a gigabyte beside what the process has, while this lives.
class Modest {
 public:
  Modest() {
#ifndef __SANITIZE_ADDRESS__  // which takes terabytes of addresses itself
    getrlimit(RLIMIT_AS, &before_);
    rlim_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    rlimit now = before_;
    now.rlim_cur = std::min(before_.rlim_max, pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE)) + (1ul << 30));
    setrlimit(RLIMIT_AS, &now);
#endif
  }
  ~Modest() {
#ifndef __SANITIZE_ADDRESS__
    setrlimit(RLIMIT_AS, &before_);
#endif
  }

 private:
  rlimit before_{};
};

TEST(Corpus, ReadersAreNotHarmedByWhatTheFuzzerFound) {
  const std::filesystem::path corpus = std::filesystem::path(HILO_SOURCE) / "tests/faults/corpus";
  const Modest modest;
  int read = 0;
  for (const auto& reader : hilo::test::readers())
    for (const auto& entry : std::filesystem::directory_iterator(corpus))
      if (entry.path().filename().string().starts_with(std::string(reader.name) + "-")) {
        EXPECT_EQ(hilo::test::offence(reader, entry.path().string()), "") << entry.path().filename();
        ++read;
      }
  EXPECT_GT(read, 0);
}

}  // namespace
