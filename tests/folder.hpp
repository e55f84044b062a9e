// SPDX-License-Identifier: GPL-3.0-or-later
// A fresh temporary folder that removes itself, and whole files.
#pragma once
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>

namespace hilo::test {

class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / ("hilo-test-" + std::string(6, 'X'))).string();
    path_ = ::mkdtemp(name.data());
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  /// Names of all files below, relative, to compare before and after.
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& e : std::filesystem::recursive_directory_iterator(path_))
      if (!e.is_directory()) names.insert(e.path().lexically_relative(path_).string());
    return names;
  }

 private:
  std::filesystem::path path_;
};

/// Error where there is none to be read: an empty text would let a test pass that looks for nothing in it.
inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error("no file " + file.string());
  return {std::istreambuf_iterator<char>(in), {}};
}
inline void write_text(const std::filesystem::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }

}  // namespace hilo::test
