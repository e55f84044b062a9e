// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/inputs.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "base/error.hpp"
#include "model/store.hpp"

namespace hilo {
namespace fs = std::filesystem;
namespace {

/// Absolute path, and the name it was read by.
std::map<std::string, std::string>& inputs() {
  static std::map<std::string, std::string> list;
  return list;
}

}  // namespace

void note_input(const std::string& path) {
  std::error_code ignored;
  const fs::path full = fs::absolute(path, ignored);
  if (!ignored) inputs().try_emplace(full.string(), path);
}

void release_input(const std::string& path) { inputs().erase(fs::absolute(path).string()); }

void check_output(const std::string& path) {
  refuse_special(path);
  std::error_code ignored;
  if (!tool_name().starts_with("hilo-")) return;  // a tool is one task; tests, and who uses the library, write what they have read
  for (const auto& [full, name] : inputs())
    if (fs::equivalent(full, path, ignored))  // device and inode
      throw Error(path, name == path ? "would overwrite the file it reads" : fmt::format("would overwrite {}, which is read", name),
                  "give another -o", Exit::usage);
}

}  // namespace hilo
