// SPDX-License-Identifier: GPL-3.0-or-later
// A small machine and its run, made up from formulas: what the pictures and tables of hilo-post are tested with.
#pragma once
#include <filesystem>
#include <string>

#include "model/mesh.hpp"

namespace hilo::sample {

/// hull (rigid hexahedra), barrel (a tube of hexahedra), support (20-node hexahedra), foot (10-node tetrahedra), strut (bars).
Mesh machine();
/// A unit cube of n x n x n hexahedra, region "cube".
Mesh cube(int n);

/// Time histories: n rows, h apart.
struct Histories {
  int rows = 201;
  double h = 5e-4;  // [s]
};
/// Sensor "seat" at time t: a half sine of 100 g and 20 ms along x from 10 ms on, a high-frequency rattle along y, 1 g along z.
Vec3 seat(double t);

/// mesh.h5 and run.h5 in the folder.  The barrel bends and its von Mises stress rises with time; nodes of rigid regions have no stress.
/// `complete` false leaves the file as a running solver does.
std::string write_run(const std::filesystem::path& folder, const Mesh& mesh, int steps, bool complete = true,
                      const Histories& histories = {});
/// Largest x of the nodes, and the von Mises stress at X: 200 MPa at the front at the end, falling to 0 at x = 0 and at the start.
double front(const Mesh& mesh);
double stress(const Vec3& X, double front, double rise);

}  // namespace hilo::sample
