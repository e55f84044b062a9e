// SPDX-License-Identifier: GPL-3.0-or-later
// What a reader of hilo-import hands back: a mesh whose regions and sets are named, and what it has to say aloud.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/registry.hpp"
#include "import/scene_writer.hpp"
#include "import/thin.hpp"
#include "model/mesh.hpp"
#include "model/thin_regions.hpp"

namespace hilo {

class Sheets;

/// The options of hilo-import, as the readers see them.
struct ImportOptions {
  std::string units = "m-kg-s";                        // system of the numbers in the deck
  bool units_given = false;                            // by --units
  double scale = 1;                                    // factor on lengths alone
  int order = 1;                                       // 2: quadratic cells
  std::optional<double> merge;                         // distance below which nodes are one        [unit of the file]
  std::optional<double> size;                          // largest edge when a geometry is meshed    [unit of the file]
  std::map<std::string, double> thickness;             // surface groups become shells; "": those not named  [unit of the file]
  std::optional<double> per_turn;                      // cells around a full turn of a curved face when CAD is meshed
  std::vector<std::string> regions;                    // element sets that become regions, before what the deck says
  std::string rest;                                    // name of the region of cells in no region ("": "rest")
  std::vector<std::pair<std::string, double>> define;  // parameters of a .geo script
  bool trust = false;                                  // a .geo script may run commands and write files
  bool thicken = false;                                // shells of decks become solid-shells
  bool rigid_beams = false;             // beams of decks are cells of regions that can be rigid alone, not beams of the scene
  std::optional<std::int64_t> subcase;  // of a Nastran file; the first one when absent
  bool every_subcase = false;           // a scene for each of them
  bool flip = false;                    // cells numbered as in a mirror are turned
  bool face = false;                    // the surface is a section of beams, not the border of solids
  bool keep_apart = false;              // solids of a CAD file that touch share no nodes
  std::vector<std::string> sets;        // NAME=KIND:KEY=VALUE,..., as [set.NAME] of a scene    [unit of the file]
  std::vector<std::string> beams;       // GROUP=KIND:KEY=VALUE,...: curves become beams with this section  [unit of the file]

  double si(std::string_view unit) const { return to_si(unit, units); }
  /// A point of the geometry, which --scale scales too, in SI.
  Vec3 point(const Vec3& x) const { return x * (scale * si("m")); }
};

/// A keyword or item of the deck that has no place in the mesh or the scene lines.
struct NotRead {
  std::string what;   // "*TIE"
  std::string place;  // file:line of the first
  std::int64_t count = 0;
  bool output = false;    // a request for output: nothing is lost
  std::string hint = {};  // what it may be a slip of
};

/// A SUBCASE of a Nastran file, where each has a scene.
struct DeckCase {
  std::int64_t number;
  std::string title;
  SceneWriter scene;
  std::vector<NotRead> not_read = {};
};

struct Imported {
  Mesh mesh;                       // numbers of the deck; region -1 until assign_regions
  std::vector<std::string> notes;  // said on stderr, one line each
  std::vector<NotRead> not_read;
  SceneWriter scene;                         // what the deck becomes beside the mesh: finish() writes mesh.deck_scene
  std::vector<DeckCase> cases;               // of --subcase all; the first one is written
  std::vector<ThinRegion> thin_regions;      // by region, empty without shells and beams
  std::map<std::int64_t, ThinSection> thin;  // of the cells that are shells or beams
  std::int64_t n_beams = 0;                  // elements that are beams of the scene
  // with --thicken, of nodes of shells
  std::map<std::int64_t, std::int64_t> piece_of;     // of a cell cut along its chords: its first piece
  std::shared_ptr<const Sheets> sheets;              // of the deck's shells
  std::map<std::int64_t, unsigned> held;             // components that supports hold by themselves, bits 0 to 5
  std::map<std::int64_t, std::string> body_of_node;  // the body that the deck's scene has of one: all its pairs move with it
  std::map<std::int64_t, size_t> nodes_counted;      // what the deck's scene takes one to become
  std::map<std::int64_t, double> thickness_at;       // where the deck states it by node, in the unit of the file
  std::set<std::string> below;                       // facet sets that mean the faces against the normals of the deck's shells
  std::optional<double> metre;                       // length unit that the file states  [m]
  bool curved = false;                               // quadratic cells made here follow curved surfaces, which may turn some inside out
  std::set<std::string>
      as_listed;  // node sets that order 2 and divided shells must not complete: the deck's force acts on each of their nodes

  void skip(const std::string& what, const std::string& place, std::int64_t count = 1, bool output = false, const std::string& hint = "");
};

/// What the model lacks by it: "load", "support", "tie", "material", "other", or "" where nothing is lost.
std::string_view loss_of(const NotRead& n);
/// Notes the solids that share no node with another and that no line of the deck's scene acts on.
void tell_untouched(Imported& in);
/// The [[left_out]] of a scene.
SceneWriter left_out(const std::vector<NotRead>& not_read);

/// Rising, once each, by what `key` says of them.
template <class T, class Key = std::identity>
void sort_unique(std::vector<T>& list, Key key = {}) {
  std::ranges::sort(list, {}, key);
  const auto rest = std::ranges::unique(list, {}, key);
  list.erase(rest.begin(), rest.end());
}

/// The first of a list, for a message: "1, 2, 3 and 4 more".
template <class List>
std::string some(const List& list, size_t most, const char* between = ", ", const char* rest = " and {} more") {
  std::string out;
  size_t n = 0;
  for (const auto& one : list)
    if (++n <= most) out += fmt::format("{}{}", n > 1 ? between : "", one);
  return n > most ? out + fmt::format(fmt::runtime(rest), n - most) : out;
}

/// A named group of cells; `tag` is its number in the file.
struct CellGroup {
  std::string name;
  std::vector<std::int64_t> cells;
};

/// Give every cell its region: the groups of --regions first, then `regions` (the later or the earlier group wins where two overlap), then
/// --rest.  A group that lost cells to another becomes a cell set too.  Cells left over are a region of their own, and that is said;
/// `groups` are the other element sets, offered there and to --regions.
void assign_regions(Imported& in, const std::string& file, const std::vector<CellGroup>& regions, bool later_wins,
                    const std::vector<CellGroup>& groups, const ImportOptions& options);

/// Adds sets under names that no region and no other set has: a name already taken gets _facets, _nodes or _cells behind it, and is noted.
/// Members are sorted, once each.  An empty set is left out and noted; a set equal to the region of its name is left out (the region
/// serves).
class SetNames {
 public:
  explicit SetNames(Imported& in) : in_(in) {}
  std::string facets(const std::string& name, std::vector<Facet> members);
  std::string nodes(const std::string& name, std::vector<std::int64_t> members);
  std::string cells(const std::string& name, std::vector<std::int64_t> members);

 private:
  bool taken(const std::string& name) const;
  std::string free_name(const std::string& name, const std::string& suffix);
  template <class Members>
  std::string add(std::map<std::string, Members>& sets, const char* kind, const std::string& name, Members members, const char* suffix);
  Imported& in_;
};

/// A name fit for a file: no '/', no blanks at its ends, never empty.
std::string clean_name(const std::string& name);

/// Local numbers of the corners of a facet, in its outward order.
std::vector<int> facet_corners(const ShapeInfo& shape, size_t facet);
/// Faces given by their nodes, found among the facets of the cells.  A face between two cells goes to the one whose outward facet turns the
/// same way.  facet[i].cell is -1 where no cell has face i.
std::vector<Facet> match_facets(const Mesh& mesh, const std::vector<std::vector<std::int64_t>>& faces);
/// Of `candidates`, the facets that no second cell shares.
std::vector<Facet> free_facets(const Mesh& mesh, const std::vector<std::int64_t>& cells);

/// The facets that no second cell shares and whose nodes are all among these.
std::vector<Facet> facets_within(const Mesh& mesh, const std::vector<std::int64_t>& nodes);

/// Of `lines`, given by their ends, those that have both ends in one solid cell: edges of a solid, not bars.
using LineEnds = std::set<std::pair<std::int64_t, std::int64_t>>;
LineEnds lines_on_solids(const Mesh& mesh, const std::vector<std::pair<std::int64_t, std::int64_t>>& lines);

/// A file of `flat` triangles and quadrangles without a solid: the lines in it are their edges, and no bars.  Throws Error where it is one.
void refuse_flat(const std::string& file, std::int64_t flat, std::int64_t solids);

/// A pyramid of five nodes, base first, as two tetrahedra: its base is cut through its lowest node, so that two pyramids on a base agree.
std::array<std::vector<std::int64_t>, 2> halves_of_pyramid(std::span<const std::int64_t> nodes);
inline constexpr std::int64_t second_half = 1'000'000'000'000'000;  // added to the number of a deck's pyramid for the second one
/// The facets of each face, given by its corners: one, none, or the two that the base of a pyramid is cut into.
std::vector<std::vector<Facet>> facets_of(const Mesh& mesh, const std::vector<std::vector<std::int64_t>>& faces);
/// What is said of them: fields are continuous at the nodes of a base alone where a cell with a quadrangle there is its neighbour.
void tell_pyramids(Imported& in, std::int64_t n);

/// The readers.  Each throws Error with file:line where the file has lines.
Imported read_inp(const std::string& path, const ImportOptions& options);
Imported read_bdf(const std::string& path, const ImportOptions& options);
Imported read_unv(const std::string& path, const ImportOptions& options);
Imported read_vtk(const std::string& path, const ImportOptions& options);
Imported read_msh(const std::string& path, const ImportOptions& options);
Imported read_med(const std::string& path, const ImportOptions& options);
Imported read_exodus(const std::string& path, const ImportOptions& options);
Imported read_medit(const std::string& path, const ImportOptions& options);
Imported read_stl(const std::string& path, const ImportOptions& options);
Imported read_geometry(const std::string& path, const ImportOptions& options);

/// The face of a section of beams, meshed or read, as the text of a .msh file in the unit of the file.  Error where there is no surface.
std::string face_of(const std::string& path, const ImportOptions& options);

/// A kind of file by the ending of its name.
struct MeshFormat {
  std::string_view name;  // its ending, ".inp"
  Imported (*read)(const std::string&, const ImportOptions&);
  bool geometry = false;      // is meshed: --size has a meaning
  bool has_surfaces = false;  // of which --thickness makes shells
};
/// Those there are; another reader is one file and a row here, from outside the tree `mesh_formats().add({".cube", read_cube})`.
Registry<MeshFormat>& mesh_formats();
/// The reader for the file's ending; Error with the endings known when there is none, or when the file cannot be opened.
Imported read_any(const std::string& path, const ImportOptions& options, const Registry<MeshFormat>& formats = mesh_formats());

/// What follows every reader: nodes merged, unused nodes dropped, order raised, sets by place, lengths brought to SI; then the checks
/// (inverted, degenerate; slivers are told).
void finish(Imported& in, const std::string& file, const ImportOptions& options);
/// tet4, wedge6, hex8 to tet10, wedge15, hex20r with straight edges; `metres`: of a unit of the mesh.
void raise_order(Imported& in, double metres);
/// The last nodes of the mesh are in the middle between these: the scene holds each in what it holds both ends in.
void hold_middles(Imported& in, const std::vector<std::array<std::int64_t, 2>>& ends, double metres);
/// Curved cells that are inverted get straight edges, and those their neighbours become inverted by; returns how many.
std::int64_t straighten(Mesh& mesh);
/// Nodes nearer than `distance` become one; returns how many went.
std::int64_t merge_nodes(Imported& in, double distance);
/// Shells become solid-shells (shell8), with facet sets REGION_bottom and REGION_top: a pair of nodes for each sheet that a node is in
/// (sheets.hpp).  Nodes of several sheets, of solids too, and those that the deck's scene has bodies of are blocks of the mesh.
void thicken(Imported& in, const std::string& file);
/// Before: where shells have triangles or mid-side nodes, all of them become quadrangles, three of a triangle and four of a quadrangle.
void divide_surfaces(Imported& in, const std::string& file);
/// Before: whether that will happen.
bool is_divided(const Imported& in);
/// These in the place of the cells of a mesh.
void replace_cells(Mesh& mesh, Mesh&& cells);
/// Nodes of no cell are dropped, from the sets too; returns how many.
std::int64_t drop_unused(Imported& in);
/// Adds the sets of --set, by the words and the code of [set.NAME] of scenes; lengths are still in the unit of the file.
void add_placed_sets(Imported& in, const std::vector<std::string>& sets);
/// Whether a solid cell has a negative volume: its facets look inwards.
bool is_mirrored(const Mesh& mesh, std::int64_t cell);
/// Cells of negative volume are numbered the other way round, in sets of facets too; returns how many.
std::int64_t flip(Mesh& mesh);
/// Throws Error naming the cells when any is inverted or has no volume.
void check_cells(const Mesh& mesh, const std::string& file);

/// The table on stdout, and the same as JSON; `scenes` are the files of the subcases, "" where none is written.
std::string import_table(const Imported& in, const std::vector<std::string>& scenes = {});
std::string import_json(const Imported& in, const std::string& file, const std::string& output,
                        const std::vector<std::string>& scenes = {});

}  // namespace hilo
