// SPDX-License-Identifier: GPL-3.0-or-later
// Runs commands as a user would, with hilo's binaries first in the path.
#pragma once
#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <string>

#include "folder.hpp"

namespace hilo::test {

struct Ran {
  int exit = -1;  // -1 when it was killed by a signal
  std::string out, err;
};

/// A temporary folder to run commands in.
class Workplace : public Folder {
 public:
  /// Run a bash command line in the folder.
  inline Ran run(const std::string& command) const;
  void write(const std::string& name, const std::string& text) const { write_text(path() / name, text); }
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

/// Sets what lets mpirun start ranks as root, on fewer cores than ranks and bound to none: Open MPI 4 (OMPI_MCA_) and 5 (PRTE_MCA_).
/// Without IPv6: Open MPI 5.0.7 complains of every rank on a machine that has it (open-mpi/ompi, issue 14079).
inline const std::string for_ranks =
    "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_mpi_yield_when_idle=1 OMPI_MCA_rmaps_base_oversubscribe=1 "
    "PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe OMPI_MCA_hwloc_base_binding_policy=none "
    "PRTE_MCA_hwloc_default_binding_policy=none OMPI_MCA_btl_tcp_disable_family=6 ";

/// The same on several ranks.
inline Ran mpirun(int ranks, const std::string& command, const std::filesystem::path& folder) {
  return run("export " + for_ranks + "\nmpirun -n " + std::to_string(ranks) + " " + command, folder);
}

inline Ran Workplace::run(const std::string& command) const { return test::run(command, path()); }

}  // namespace hilo::test
