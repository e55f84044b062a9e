// A fresh temporary folder that removes itself.
#pragma once
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

namespace hilo::test {

struct Folder {
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "hilo-test-XXXXXX").string();
    path = ::mkdtemp(name.data());
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  Folder(const Folder&) = delete;
  std::string operator/(const std::string& name) const { return (path / name).string(); }
  /// Names of all files below, relative.
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& e : std::filesystem::recursive_directory_iterator(path))
      if (!e.is_directory()) names.insert(e.path().lexically_relative(path).string());
    return names;
  }
  std::filesystem::path path;
};

inline std::string bytes_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}
inline void write_bytes(const std::string& file, const std::string& bytes) { std::ofstream(file, std::ios::binary) << bytes; }

}  // namespace hilo::test
