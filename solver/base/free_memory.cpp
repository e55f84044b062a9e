// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/free_memory.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>

namespace hilo {
namespace {

/// The number after `key` of a file of keys and numbers, or the first of all; infinite where there is none.
double number_in(const std::string& path, const std::string& key = "") {
  std::ifstream file(path);
  std::string word;
  while (file >> word)
    if (key.empty() || (word == key && file >> word)) {
      char* end = nullptr;
      const double value = std::strtod(word.c_str(), &end);
      if (end != word.c_str()) return value;
      break;
    }
  return std::numeric_limits<double>::infinity();
}

}  // namespace

std::vector<std::string> memory_groups(std::istream& membership) {
  std::vector<std::string> out;
  for (std::string line; std::getline(membership, line);) {
    const size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    if (controllers != ",," && controllers.find(",memory,") == std::string::npos) continue;
    const std::string root = controllers == ",," ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
    for (std::string path = line.substr(second + 1); path.size() > 1 && path[0] == '/'; path.resize(path.rfind('/')))
      out.push_back(root + path);
    out.push_back(root);
  }
  return out;
}

double free_memory() {
  double out = 1024 * number_in("/proc/meminfo", "MemAvailable:");
  const auto within = [&](double most, double used, double reclaimable) {
    if (std::isfinite(most) && std::isfinite(used))
      out = std::min(out, std::max(0.0, most - used + (std::isfinite(reclaimable) ? reclaimable : 0)));
  };
  std::ifstream membership("/proc/self/cgroup");
  for (const std::string& group : memory_groups(membership)) {
    const std::string stat = group + "/memory.stat";
    within(number_in(group + "/memory.max"), number_in(group + "/memory.current"), number_in(stat, "inactive_file"));
    within(number_in(group + "/memory.limit_in_bytes"), number_in(group + "/memory.usage_in_bytes"),
           number_in(stat, "total_inactive_file"));
  }
  rlimit own{};
  if (!getrlimit(RLIMIT_AS, &own) && own.rlim_cur != RLIM_INFINITY)
    within(static_cast<double>(own.rlim_cur), number_in("/proc/self/statm") * static_cast<double>(sysconf(_SC_PAGESIZE)), 0);
  return out;
}

}  // namespace hilo
