// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/files/output.hpp"

#include <cstdio>
#include <filesystem>
#include <set>

#include "base/error.hpp"
#include "model/store.hpp"

namespace hilo {

void write_out(const std::string& path, const std::string& bytes) {
  if (path == "-") {
    if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size() || std::fflush(stdout) != 0)
      throw Error("stdout", "cannot be written", "", Exit::resources);
    return;
  }
  const auto folder = std::filesystem::path(path).parent_path();
  std::error_code failed;
  if (!folder.empty()) std::filesystem::create_directories(folder, failed);
  if (failed) throw Error(path, "cannot make the folder: " + failed.message(), "", Exit::resources);
  static std::set<std::filesystem::path> written;
  if (!written.insert(std::filesystem::absolute(path).lexically_normal()).second)
    throw Error(path, "two outputs have this name", "give each its own", Exit::usage);
  write_text_file(path, bytes);
}

}  // namespace hilo
