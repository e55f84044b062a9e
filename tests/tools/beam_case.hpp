// SPDX-License-Identifier: GPL-3.0-or-later
// Decks of beams that are imported, run and compared with closed forms.
#pragma once
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "import_case.hpp"

namespace hilo::test::beam_decks {

using std::numbers::pi;

class ImportBeam : public ImportAndRun {
 protected:
  /// Imports and runs a deck.
  void solve(const std::string& text, const std::string& file = "a.bdf", const std::string& options = "") {
    place.write(file, text);
    const auto ran = succeeded(
        place.run("hilo-import --quiet " + file + " -o out.h5 --scene-out a.toml " + options + " && hilo-solve a.toml -o run.h5"));
    table = ran.out;
    told = ran.err;
  }
  Vec3 moved(const std::string& body) {
    const auto v = change("body." + body + "*");
    return {v[0], v[1], v[2]};
  }
  std::string told;
};

inline const std::string stat = "SOL 101\nCEND\nSPC = 1\nLOAD = 2\nBEGIN BULK\n";
inline const std::string modes = "SOL 103\nCEND\nSPC = 1\nMETHOD = 3\nBEGIN BULK\nEIGRL,3,,,3\n";
inline const std::string steel = "MAT1,1,2.1+11,,.3,7850.\n";
inline constexpr double E = 2.1e11, G = E / 2.6;

/// A block of nodes 11 to 18 at x = 2 to 3, and the rest of a deck whose beams are in E.
inline const std::string block =
    "11,2,0,0\n12,3,0,0\n13,3,1,0\n14,2,1,0\n15,2,0,1\n16,3,0,1\n17,3,1,1\n18,2,1,1\n*ELEMENT,TYPE=C3D8,ELSET=S\n50,11,12,13,14,15,16,17,"
    "18\n";
inline const std::string section =
    "*BEAM SECTION,ELSET=E,MATERIAL=M,SECTION=RECT\n.04,.04\n0,1,0\n*SOLID "
    "SECTION,ELSET=S,MATERIAL=M\n*MATERIAL,NAME=M\n*ELASTIC\n2.1e11,.3\n*DENSITY\n7850.\n";

}  // namespace hilo::test::beam_decks
