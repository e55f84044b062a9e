// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/free_memory.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>

using namespace hilo;

TEST(FreeMemory, LooksAtEveryGroupFromItsOwnToTheRoot) {
  const auto groups = [](const std::string& text) {
    std::istringstream lines(text);
    return memory_groups(lines);
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(groups("0::/user.slice/job-7\n"), (Names{"/sys/fs/cgroup/user.slice/job-7", "/sys/fs/cgroup/user.slice", "/sys/fs/cgroup"}));
  EXPECT_EQ(groups("5:cpu,cpuacct:/other\n4:memory:/slurm/job\n"),
            (Names{"/sys/fs/cgroup/memory/slurm/job", "/sys/fs/cgroup/memory/slurm", "/sys/fs/cgroup/memory"}));
  EXPECT_EQ(groups("0::/\n"), Names{"/sys/fs/cgroup"});
  EXPECT_EQ(groups("a line\n1:name=systemd:/x\n3:memory:nowhere\n"), Names{"/sys/fs/cgroup/memory"});
}

TEST(FreeMemory, IsWhatTheProcessMayStillTake) {
  EXPECT_GT(free_memory(), 1e8);
  double pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const auto taken = static_cast<rlim_t>(pages) * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
  const rlimit tight{std::min(before.rlim_max, taken + (rlim_t{64} << 20)), before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_AS, &tight), 0);
  const double room = free_memory();
  ASSERT_EQ(setrlimit(RLIMIT_AS, &before), 0);
  EXPECT_NEAR(room, 64 << 20, 4 << 20);
}
