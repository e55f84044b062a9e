// SPDX-License-Identifier: GPL-3.0-or-later
// What a Nastran file says, in its own numbers and units, before it becomes a mesh and a scene.
#pragma once
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "import/bdf/axes.hpp"
#include "import/data_line.hpp"
#include "import/deck_beams.hpp"
#include "import/deck_material.hpp"
#include "import/imported.hpp"

namespace hilo {

/// first THRU last BY by: of what there is among these numbers.
struct BdfRange {
  std::int64_t first, last, by;
};
/// A line of SPC or SPC1: grids held in components (bits 0 to 5), at a value in SPC.
struct BdfSupport {
  std::vector<std::int64_t> grids;
  unsigned components;
  double value;
  std::string place;
  std::vector<BdfRange> ranges = {};
};
/// FORCE, MOMENT and their like: a vector at a grid; GRAV: an acceleration; pressures on faces; SPCD: where a support goes.
struct BdfLoad {
  enum class Kind { force, moment, gravity, rotation, pressure, displacement, line } kind;
  std::int64_t grid = 0, system = 0;
  double size_end = 0;                       // of a line: at the end of the beam
  double size = 0;                           // N, N m, m/s^2, turns/s, Pa, m, rad or N/m in units of the deck
  unsigned components = 0;                   // SPCD: bits 0 to 5
  Vec3 direction = Vec3::Zero();             // in `system`; of a pressure: zero for one along the normal
  std::array<std::int64_t, 2> towards{};     // FORCE1, MOMENT1: along the line of two grids
  std::vector<std::int64_t> elements = {};   // of a pressure
  std::vector<BdfRange> ranges = {};         // the same, of which not every number needs to be there
  std::array<std::int64_t, 2> face{};        // PLOAD4 on solids: G1, and G3 or G4
  std::vector<std::int64_t> corners = {};    // PLOAD: a face by its grids
  std::vector<double> at_corners = {};       // PLOAD4 that varies: P1 to P4
  bool own_axes = false, projected = false;  // PLOAD1: in axes of the beam; per length across the load
  std::array<double, 2> from_to{};           // PLOAD1: where it begins and ends, of the length or in units of the deck; equal: at a point
  bool as_share = false, turns = false;      // the former; a moment
  std::string place = {};
};
/// LOAD: sets of loads with factors; SPCADD and its like: sets.
struct BdfSum {
  double factor = 1;
  std::vector<std::pair<double, std::int64_t>> parts;
  std::string place;
};
/// Lines by the number of their set, and the sums of sets.
template <class Line>
struct BdfSets {
  std::map<std::int64_t, std::vector<Line>> lines;
  std::map<std::int64_t, BdfSum> sums;
  /// Null for none.
  const BdfSum* sum(std::int64_t id) const {
    const auto at = sums.find(id);
    return at == sums.end() ? nullptr : &at->second;
  }
  bool has(std::int64_t id) const { return lines.contains(id) || sums.contains(id); }
  /// The one that is meant where no case control says so, or -1.
  std::int64_t only() const { return sums.size() == 1 ? sums.begin()->first : lines.size() == 1 ? lines.begin()->first : -1; }
  /// Whether a set is the one that is chosen, or of its sum.
  bool takes(std::int64_t chosen, std::int64_t id) const {
    const BdfSum* s = sum(chosen);
    return id == chosen || (s && std::ranges::find(s->parts, id, &std::pair<double, std::int64_t>::second) != s->parts.end());
  }
};
/// RBE2, RBAR: grids that follow one.
struct BdfRigid {
  std::string name, place;  // "RBE2"
  std::int64_t id, hub;
  unsigned components;
  std::vector<std::int64_t> grids;
};
/// RBE3: a grid that follows the weighted mean of others.
struct BdfMean {
  std::int64_t id, grid;
  unsigned components;
  struct Of {
    std::int64_t grid;
    double weight;
    bool turns;  // its turns count too
  };
  std::vector<Of> of;
  std::string not_read, place;
};
/// CONM2: offset from the grid and inertia about the centre of mass, in `system`; -1: the offset is the point itself.
struct BdfMass {
  std::int64_t id, grid, system;
  double mass;
  Vec3 offset;
  Mat3 inertia;
  std::string place;
};
/// CELAS, CDAMP: one component of each of two grids, 0 is the ground.  CBUSH: six of them in axes of its own.
struct BdfSpring {
  std::string name, place;
  std::int64_t id = 0, property = 0;
  std::array<std::int64_t, 2> grids{};
  std::array<int, 2> component{};  // 1 to 6; 0: all of a CBUSH, -1: along the line (CBUSH1D)
  std::array<double, 6> k{}, c{};
  std::optional<std::int64_t> system = {}, towards = {};  // of a CBUSH: CID, G0
  Vec3 plane = Vec3::Zero();                              // of a CBUSH: X1 to X3
  double share = 0.5;                                     // of a CBUSH: where between its grids it stands
};
struct BdfSpringData {
  std::array<double, 6> k{}, c{};
};
/// BSURFS: a face of a solid by three of its corners.
struct BdfGlueFace {
  std::int64_t element;
  std::array<std::int64_t, 3> grids;
  std::string place;
};
/// BGSET: regions that are glued, and how far apart they may be; 0: not said.  BCTSET: regions that may meet.
struct BdfGlue {
  std::int64_t source, target;
  double distance;
  std::string place;
  double friction = 0;
};
/// What a subcase takes; -1: none named.
struct BdfCase {
  std::string title, subtitle, label, solution;  // "101"
  std::int64_t spc = -1, load = -1, mpc = -1, glue = -1, contact = -1, method = -1, step = -1, number = -1;
  struct Statsub {
    std::int64_t subcase = -1;
    std::string place = {};
  };
  Statsub loads_of, preload_of;                // STATSUB, STATSUB(PRELOAD)
  bool any = false;                            // case control is there: CEND is said
  bool heats = false, loaded_at_rest = false;  // the latter: modes about the equilibrium under the loads
  bool is_static() const {
    return std::set<std::string>{"101", "1", "SESTATIC", "SESTATICS", "STATICS", "106", "NLSTATIC", "NLSTATICS"}.contains(solution);
  }
  bool finds_modes() const { return std::set<std::string>{"103", "3", "SEMODES", "MODES", "NORMAL"}.contains(solution); }
  bool buckles() const { return solution == "105" || solution == "5" || solution == "SEBUCKL" || solution == "BUCKLING"; }
};

/// PSHELL, PCOMP: thickness, offset of the mid-surface.  PBAR, PBEAM and their like: a section, axis 2 in plane 1.
struct BdfThin {
  double thickness = 0, offset = 0;
  DeckSection section = {}, end = {};                 // of beams; end: of those that taper
  std::array<std::array<double, 2>, 2> neutral = {};  // of beams, at ends A and B: the centre of area from the shear centre, along y and z
  bool bends_only = false;                            // PSHELL without MID1
  double angle = 0;                                   // of all layers of a PCOMP, in degrees
  std::string turned_layers = {};                     // place of one whose angle is another
  std::string no_solid;                               // why a solid-shell cannot stand for it
  std::string place = {};
};

/// BAROR, BEAMOR: what beams that leave it blank have.
struct BdfBeamDefault {
  std::int64_t property = 0, towards = 0;
  Vec3 v = Vec3::Zero();
  std::string axes, place;
};
/// CMASS1, CMASS2: a mass along one component of a grid.
struct BdfScalarMass {
  std::string name, place;
  std::int64_t id = 0, property = 0, grid = 0;  // property 0: the mass is given
  int component = 0;                            // 1 to 6
  double mass = 0;
};

/// MPC: the sum of displacements, times factors, is zero.
struct BdfEquation {
  struct Term {
    std::int64_t grid, component;
    double factor;
  };
  std::vector<Term> terms;
  std::string place;
};

struct BdfDeck {
  struct Cell {
    Shape shape;
    std::int64_t id, property;
    std::vector<std::int64_t> nodes;
    std::string place;
  };
  /// A shell (`nodes`: its corners) or a beam.
  struct Thin : Cell {
    std::vector<std::int64_t> middles = {};
    double offset = 0;                       // of a shell, along its normal
    std::array<double, 4> own = {};          // of a shell: T1 to T4, 0 where that of its property is taken
    bool own_are_shares = false;             // TFLAG 1: they are factors of that
    double theta = 0;                        // of a shell: from its first edge to axis 1 of its material, in degrees
    std::int64_t material_system = -1;       // MCID instead; -1: none
    std::int64_t towards = 0;                // of a beam: G0
    Vec3 v = Vec3::Zero();                   // of a beam: in its plane 1
    Vec3 start = Vec3::Zero(), end = start;  // of a beam: offsets of its ends
    std::string card = "beam", axes = "";    // of a beam: OFFT, which axes v and both offsets are in
    unsigned pins[2] = {0, 0};               // of a beam: components that its ends leave free, in its own axes
  };
  std::vector<Vec3> X;
  std::vector<std::int64_t> node_id;
  std::vector<BdfGrid> grids;                          // beside X
  BdfGrid grid_default;                                // GRDSET
  std::map<std::int64_t, BdfSystem> systems;           // by CID
  std::unordered_map<std::int64_t, std::int64_t> row;  // number of a grid -> row of X
  std::vector<Cell> cells;
  std::vector<Thin> shells, beams;
  std::map<std::string, BdfBeamDefault> beam_default;  // of "CBAR", "CBEAM"
  std::map<std::int64_t, BdfThin> thin;                // by property
  std::set<std::int64_t> cell_ids;
  std::set<std::int64_t> pyramids;                          // elements, and their second halves
  std::unordered_map<std::int64_t, std::int64_t> cell_row;  // number of a cell -> row of cells
  std::map<std::int64_t, std::int64_t> material_of;         // property -> material
  std::map<std::int64_t, double> area_of;                   // property of rods -> cross-section
  std::map<std::int64_t, std::string> property_name;
  std::map<std::int64_t, DeckMaterial> materials;                         // by MID
  std::map<std::int64_t, std::string> without_density;                    // MID -> place
  std::map<std::int64_t, std::string> other_shear;                        // MID -> place of a G that is not that of E and NU
  std::vector<DataLine> metals;                                           // MATS1
  std::map<std::int64_t, std::vector<std::pair<double, double>>> tables;  // TABLES1: x, y
  double mass_factor = 1;                                                 // PARAM, WTMASS
  BdfCase chosen;
  BdfSets<BdfSupport> supports;                                 // SPC, SPCADD
  BdfSets<BdfEquation> ties;                                    // MPC, MPCADD
  std::map<std::int64_t, std::vector<BdfGlueFace>> glue_faces;  // BSURFS
  BdfSets<BdfGlue> glue, contacts;                              // BGSET, BGADD; BCTSET, BCTADD
  BdfSets<BdfLoad> loads;                                       // and LOAD
  std::map<std::int64_t, int> modes;                            // EIGRL, EIGR: how many, 0 not said
  std::map<std::int64_t, std::pair<double, double>> steps;      // TSTEP: end, step
  std::vector<BdfRigid> rigid;
  std::vector<BdfMean> means;
  std::vector<BdfMass> masses;
  std::vector<BdfScalarMass> scalar_masses;
  std::map<std::int64_t, double> mass_of;  // PMASS
  std::vector<BdfSpring> springs;
  std::map<std::pair<std::string, std::int64_t>, BdfSpringData> spring_data;  // by "PELAS", PDAMP, PBUSH, PBUSH1D and number

  /// The material of a property, and its number; null where there is none.
  const std::pair<const std::int64_t, DeckMaterial>* material(std::int64_t property) const {
    const auto id = material_of.find(property);
    const auto at = id == material_of.end() ? materials.end() : materials.find(id->second);
    return at == materials.end() ? nullptr : &*at;
  }
  std::string name_of(std::int64_t property) const {
    const auto name = property_name.find(property);
    return name == property_name.end() ? fmt::format("pid_{}", property) : name->second;
  }
  /// The row of a grid; an Error where it is not there, "{who} {id} names node ...".
  std::int64_t row_of(std::int64_t grid, const std::string& place, const char* who, std::int64_t id) const;
};

}  // namespace hilo
