// SPDX-License-Identifier: GPL-3.0-or-later
// Mid-surfaces that become solid-shells, and how far they bend.
#pragma once
#include <fmt/format.h>

#include "import_case.hpp"

namespace hilo::test::shell_decks {

class ImportShell : public Import {
 protected:
  /// Length of the last way of a probe of run.h5.
  Vec3 way(const std::string& probe) {
    const Store run = Store::open(place / "run.h5");
    const auto x = run.read<double>("/history/probe/" + probe);
    const size_t n = x.size() / run.shape("/history/probe/" + probe)[0];
    return Vec3(x[x.size() - n] - x[0], x[x.size() - n + 1] - x[1], x[x.size() - n + 2] - x[2]);
  }
};

/// A quarter of a cylinder of radius 1 about y, 2 long.
inline const std::string arch =
    "Point(1) = {1, 0, 0}; Point(2) = {0, 0, 1}; Point(3) = {0, 0, 0}; Circle(1) = {1, 3, 2};\n"
    "e[] = Extrude {0, 2, 0} { Curve{1}; Layers{4}; Recombine; };\nTransfinite Curve{1} = 11;\n"
    "Physical Surface(\"roof\") = {e[1]}; Physical Curve(\"front\") = {1}; Physical Point(\"corner\") = {1};\n";

/// The strip of CQUAD4 with its load and these lines.
inline std::string cquad4_strip(const std::string& lines) {
  std::string deck = "SOL 101\nCEND\nSPC = 1\nLOAD = 2\nBEGIN BULK\nMAT1,1,1.+9,,0.,1000.\nPSHELL,7,1,.1,1,,1\n" + lines;
  for (int i = 0; i <= 20; ++i) deck += fmt::format("GRID,{},,{:.1f},0.,0.\nGRID,{},,{:.1f},1.,0.\n", 2 * i + 1, i / 2., 2 * i + 2, i / 2.);
  for (int i = 0; i < 20; ++i) deck += fmt::format("CQUAD4,{},7,{},{},{},{}\n", i + 1, 2 * i + 1, 2 * i + 3, 2 * i + 4, 2 * i + 2);
  return deck + "FORCE,2,41,,1.,0.,0.,1.\nFORCE,2,42,,1.,0.,0.,1.\nENDDATA\n";
}

}  // namespace hilo::test::shell_decks
