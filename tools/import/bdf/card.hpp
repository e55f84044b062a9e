// The entries of a Nastran file that are known: a name and what reads it.  Another entry is one more row of the table in cards.cpp,
// or from outside the tree `bdf_cards().add({"MATLAME", read_lame})` before the first file is read.
#pragma once
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/registry.hpp"
#include "import/bdf/entries.hpp"
#include "import/deck_material.hpp"
#include "import/imported.hpp"

namespace hilo {

inline constexpr const char* bdf_supported = "supported: CTETRA, CPENTA, CHEXA, CROD, CONROD";

/// What a Nastran file says, in its own numbers, before it becomes a mesh.
struct BdfDeck {
  struct Cell {
    Shape shape;
    std::int64_t id, property;
    std::vector<std::int64_t> nodes;
    std::string place;
  };
  std::vector<Vec3> X;
  std::vector<std::int64_t> node_id;
  std::unordered_map<std::int64_t, std::int64_t> row;  // number of a grid -> row of X
  std::vector<Cell> cells, shells;
  std::set<std::int64_t> cell_ids;
  std::map<std::int64_t, std::int64_t> material_of;                       // property -> material
  std::map<std::int64_t, DeckMaterial> materials;                         // by MID
  std::vector<DataLine> metals;                                           // MATS1
  std::map<std::int64_t, std::vector<std::pair<double, double>>> tables;  // TABLES1: x, y
  std::map<std::string, std::vector<std::int64_t>> sets;
};

struct BdfCard {
  std::string_view name;  // "CHEXA"
  void (*read)(const BdfEntry&, BdfDeck&, Imported&);
};
using BdfCards = Registry<BdfCard>;
BdfCards& bdf_cards();
std::span<const BdfCard> bdf_material_cards();
/// The material of the number in the first field of an entry, new where none has it yet.
DeckMaterial& material_of(const BdfEntry& e, BdfDeck& deck);
/// MATS1 and the tables it names, into the materials.
void resolve_metals(BdfDeck& deck, Imported& in);

/// Reads the entries.  One that is not among `cards` is counted in `in.not_read`.
void parse_bdf(BdfEntries& entries, BdfDeck& deck, Imported& in, const BdfCards& cards);

}  // namespace hilo
