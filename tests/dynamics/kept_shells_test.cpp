// SPDX-License-Identifier: GPL-3.0-or-later
// Shells whose law is not linear keep modes of their cells from step to step: a run that goes on has them, bit by bit.
#include "dynamics/kept_run.hpp"
#include "verify/block_mesh.hpp"

namespace hilo::test {
namespace {

std::string strip(const std::filesystem::path& folder, const std::string& law) {
  BlockOptions o;
  o.n[0] = 6, o.n[1] = 2, o.high = Vec3(1.2, 0.4, 0.02), o.regions = {"strip"};
  if (Comm::world().rank == 0) write_mesh((folder / "mesh.h5").string(), block_mesh(o), {"test"});
  Comm::world().barrier();
  return "gravity = [0, 0, -9.81]\n[material.m]\nE = 1e8\nnu = 0.3\ndensity = 1000\n" + law +
         "[region.strip]\nmaterial = \"m\"\nshell = true\ndamping = 1e-4\n[[motion]]\nkind = \"fixed\"\nname = \"wall\"\non = \"xmin\"\n"
         "[output]\ninterval = 0.05\nfields = [\"displacement\", \"stress\"]\n[time]\nend = 0.2\nstep = 0.01\n";
}
const char* const laws[] = {"kind = \"stvk\"\n", "kind = \"neo-hookean\"\n", "kind = \"j2\"\nyield = 3e5\nhardening = 1e6\n"};

TEST(KeptShells, GoOnBitByBit) {
  for (const char* law : laws) {
    Folder w;
    expect_goes_on(w.path(), strip(w.path(), law), "mesh.h5", {3, 14});
  }
}

}  // namespace
}  // namespace hilo::test
