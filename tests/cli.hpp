// Runs commands as a user would, with hilo's binaries first in the path.
#pragma once
#include <stdlib.h>
#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

namespace hilo::test {

struct Ran {
  int exit = -1;  // -1 when it was killed by a signal
  std::string out, err;
};

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A temporary folder, removed at the end.
class Workplace {
 public:
  Workplace() {
    std::string name = (std::filesystem::temp_directory_path() / "hilo-test-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
  }
  ~Workplace() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Workplace(const Workplace&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

  /// Run a bash command line in the folder.
  inline Ran run(const std::string& command) const;
  void write(const std::string& name, const std::string& text) const { std::ofstream(path_ / name, std::ios::binary) << text; }
  /// Names of all files in the folder, to compare before and after.
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& e : std::filesystem::recursive_directory_iterator(path_))
      if (!e.is_directory()) names.insert(e.path().lexically_relative(path_).string());
    return names;
  }

 private:
  std::filesystem::path path_;
};

/// Run a bash command line in `folder`; nothing is written there but by the command.
inline Ran run(const std::string& command, const std::filesystem::path& folder) {
  const Workplace aside;
  aside.write("command", "cd '" + folder.string() + "'\nexport PATH='" + HILO_BIN + "':$PATH\n" + command + '\n');
  Ran ran;
  std::FILE* pipe = ::popen(("bash '" + (aside / "command") + "' 2> '" + (aside / "err") + "' < /dev/null").c_str(), "r");
  char block[4096];
  while (const size_t n = std::fread(block, 1, sizeof block, pipe)) ran.out.append(block, n);
  const int status = ::pclose(pipe);
  if (WIFEXITED(status) && WEXITSTATUS(status) < 128) ran.exit = WEXITSTATUS(status);
  ran.err = text_of(aside / "err");
  return ran;
}

/// The same on several ranks, also as root and on fewer cores.
inline Ran mpirun(int ranks, const std::string& command, const std::filesystem::path& folder) {
  return run(
      "export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 "
      "OMPI_MCA_mpi_yield_when_idle=1\n"
      "mpirun -n " +
          std::to_string(ranks) + " " + command,
      folder);
}

inline Ran Workplace::run(const std::string& command) const { return test::run(command, path_); }

}  // namespace hilo::test
