# SPDX-License-Identifier: GPL-3.0-or-later
# find_package(hilo), then target_link_libraries(program PRIVATE hilo::dynamics): scenes, and runs of them (docs/library.md).
include(CMakeFindDependencyMacro)
foreach(package Eigen3 fmt CLI11 tomlplusplus)
  find_dependency(${package} CONFIG)
endforeach()
find_dependency(MPI COMPONENTS C)
include(${CMAKE_CURRENT_LIST_DIR}/hilo-targets.cmake)
