// SPDX-License-Identifier: GPL-3.0-or-later
// Loads the PETSc solvers on first use: PETSc's start costs more than a small run, so hilo-solve is not linked to it.
#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>

#include "base/error.hpp"
#include "linear/blas_room.hpp"
#include "linear/kkt.hpp"
#include "linear/petsc/module.hpp"

namespace hilo {
namespace {

constexpr const char* library = "libhilo-petsc.so";

using Make = decltype(&hilo_make_petsc_solver);

Make load() {
  std::error_code ignored;
  const auto beside = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path().parent_path() / "lib";
  // in a build folder; where the package has it, for its tools and for programs that link the libraries; or where the loader looks
  std::string path = library;
  for (const auto& place : {beside / library, beside / "hilo" / library, std::filesystem::path("/usr/lib/hilo") / library})
    if (path == library && std::filesystem::exists(place, ignored)) path = place.string();
  // PETSc and Open MPI load parts of their own, which look for their symbols among the global ones
  void* handle = dlopen(path.c_str(), RTLD_NOW | RTLD_GLOBAL);
  if (!handle)
    throw Error(path, fmt::format("cannot load the PETSc solvers: {}", dlerror()),
                "solver.kind = \"light\" does without; apt-get install libpetsc-real3.18 for the others", Exit::resources);
  const auto make = reinterpret_cast<Make>(dlsym(handle, "hilo_make_petsc_solver"));
  if (!make) throw Error(library, "is not of this version of hilo", "", Exit::resources);
  return make;
}

}  // namespace

std::unique_ptr<KktSolver> make_petsc_solver(const std::string& kind, double tolerance, int subdomains) {
  static const Make make = [] {
    make_room_for_blas();
    require_address_space(160, "PETSc and MPI need at their start");
    return load();
  }();
  return std::unique_ptr<KktSolver>(make(kind.c_str(), tolerance, subdomains, tool_name().c_str()));
}

}  // namespace hilo
