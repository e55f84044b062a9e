// SPDX-License-Identifier: GPL-3.0-or-later
// Geometry and Exodus files are handed to a program that is linked to gmsh and Exodus: their start takes thirty times as long as the rest.
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "import/imported.hpp"

namespace hilo {
namespace {

/// The same command by the other program, in the place of this one.
[[noreturn]] void hand_over() {
  namespace fs = std::filesystem;
  constexpr const char* program = "hilo-import-geometry";
  std::error_code ignored;
  const fs::path lib = fs::read_symlink("/proc/self/exe", ignored).parent_path().parent_path() / "lib";
  std::vector<std::string> words;
  std::ifstream given("/proc/self/cmdline", std::ios::binary);
  for (std::string word; std::getline(given, word, '\0');) words.push_back(word);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  std::fflush(nullptr);
  for (const fs::path& folder : {lib, lib / "hilo", fs::path("/usr/lib/hilo")}) {  // of a build, of a package
    ::execv((folder / program).c_str(), argv.data());
    if (errno != ENOENT) break;
  }
  throw Error((lib / program).string(), fmt::format("cannot be started: {}", std::strerror(errno)), "it reads geometry and Exodus files",
              Exit::resources);
}

}  // namespace

Imported read_geometry(const std::string&, const ImportOptions&) { hand_over(); }
Imported read_exodus(const std::string&, const ImportOptions&) { hand_over(); }
std::string face_of(const std::string&, const ImportOptions&) { hand_over(); }

}  // namespace hilo
