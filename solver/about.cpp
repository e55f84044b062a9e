// SPDX-License-Identifier: GPL-3.0-or-later
// The one unit that a new commit compiles (solver/commit.cmake writes commit.hpp); the tools alone are linked to it.
#include "about.hpp"

#include <fmt/format.h>
#include <metis.h>

#include <CLI/Version.hpp>
#include <Eigen/Core>
#define OMPI_SKIP_MPICXX 1
#include <mpi.h>
#include <toml++/toml.h>

#include "commit.hpp"

namespace hilo {

std::string about(const std::vector<std::string>& own) {
  std::vector<std::string> libraries{fmt::format("Eigen {}.{}.{}", EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION),
                                     fmt::format("HDF5 {}", HILO_HDF5_VERSION),
                                     fmt::format("Open MPI {}.{}.{}", OMPI_MAJOR_VERSION, OMPI_MINOR_VERSION, OMPI_RELEASE_VERSION),
                                     fmt::format("fmt {}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100),
                                     fmt::format("CLI11 {}", CLI11_VERSION),
                                     fmt::format("toml++ {}.{}.{}", TOML_LIB_MAJOR, TOML_LIB_MINOR, TOML_LIB_PATCH)};
  libraries.insert(libraries.end(), own.begin(), own.end());
  return fmt::format("commit {}\nwith {}", HILO_COMMIT, fmt::join(libraries, ", "));
}

std::string metis() { return fmt::format("METIS {}.{}.{}", METIS_VER_MAJOR, METIS_VER_MINOR, METIS_VER_SUBMINOR); }

}  // namespace hilo
