// SPDX-License-Identifier: GPL-3.0-or-later
// The entries of a Nastran file that are known: a name and what reads it.  Another entry is one more row of the table of its family, or
// from outside the tree `bdf_cards().add({"MATLAME", read_lame})` before the first file is read.
#pragma once
#include <optional>
#include <span>
#include <string_view>

#include "base/registry.hpp"
#include "import/bdf/deck.hpp"
#include "import/bdf/entries.hpp"

namespace hilo {

inline constexpr const char* bdf_supported =
    "supported: CTETRA, CPENTA, CHEXA, CROD, CONROD; as rigid regions CTRIA3, CTRIA6, CQUAD4, CQUAD8, CBAR, CBEAM";

struct BdfCard {
  std::string_view name;  // "CHEXA"
  void (*read)(const BdfEntry&, BdfDeck&, Imported&);
};
using BdfCards = Registry<BdfCard>;
BdfCards& bdf_cards();
/// The families, one file each.
std::vector<BdfCard> bdf_mesh_cards();      // GRID, CORD, solids, rods, shells, properties
std::vector<BdfCard> bdf_thin_cards();      // shells with their properties, beams
std::vector<BdfCard> bdf_section_cards();   // sections of beams
std::vector<BdfCard> bdf_material_cards();  // MAT1 and what goes with it
std::vector<BdfCard> bdf_load_cards();      // supports, loads, methods
std::vector<BdfCard> bdf_link_cards();      // rigid elements, masses, springs

/// The material of the number in the first field of an entry, new where none has it yet.
DeckMaterial& material_of(const BdfEntry& e, BdfDeck& deck);
/// The property of the number in the first field, with the material of that in another one where it is given; Error where it is there
/// already.
void add_property(const BdfEntry& e, BdfDeck& deck, BdfThin section, std::optional<size_t> material = 1);
/// A shell or beam becomes a cell with its section; Error where its property says none.
void add_thin_cell(const BdfDeck& deck, const BdfDeck::Thin& cell, std::span<const std::int64_t> rows, Imported& in);
/// Both ends of a beam off its grids, and the direction of plane 1; Error where it lies along the beam and the section has two stiffnesses.
struct BdfBeamPlace {
  Vec3 a, b, up;
};
BdfBeamPlace place_of_beam(const BdfDeck& deck, const BdfDeck::Thin& beam);
/// What BAROR and BEAMOR say of beams that leave it blank.
void resolve_beams(BdfDeck& deck);
/// The section of a beam; Error where its property is none of beams.
const BdfThin& section_of_beam(const BdfDeck& deck, const BdfDeck::Thin& beam);
/// MATS1 and the tables it names, into the materials.
void resolve_metals(BdfDeck& deck, Imported& in);
/// Components of a grid, "123456" in any order, as bits 0 to 5; an Error where it is none.
unsigned components(const DataLine& d, size_t field);
/// Numbers of a list from a field on, "THRU" and "BY" understood; ends at a word or a real number, whose field is returned.
size_t grid_list(const DataLine& d, size_t field, std::vector<std::int64_t>& out);
/// The same with ranges as ranges, of which not every number needs to be there.
size_t grid_list(const DataLine& d, size_t field, std::vector<std::int64_t>& out, std::vector<BdfRange>& ranges);

/// Reads the entries.  One that is not among `cards` is counted in `in.not_read`.
void parse_bdf(BdfEntries& entries, BdfDeck& deck, Imported& in, const BdfCards& cards);
/// Executive and case control: title, solution, which supports and loads a subcase takes: the one asked for, else the one that the solution
/// is of.
void read_case(const std::vector<BdfCaseLine>& lines, BdfDeck& deck, Imported& in, std::optional<std::int64_t> subcase = {});
/// The numbers of all subcases; an Error where there is none.
std::vector<std::int64_t> subcases_of(const std::vector<BdfCaseLine>& lines, const std::string& path);
/// The lines of a scene (in.scene) and the sets they name.
void write_bdf_scene(const BdfDeck& deck, Imported& in, SetNames& names, const ImportOptions& options);

}  // namespace hilo
