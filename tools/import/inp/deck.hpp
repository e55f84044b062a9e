// SPDX-License-Identifier: GPL-3.0-or-later
// What an Abaqus or CalculiX deck says, in its own numbers and units, before it becomes a mesh and a scene.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "base/error.hpp"
#include "import/deck_beams.hpp"
#include "import/deck_material.hpp"
#include "import/imported.hpp"
#include "import/inp/lines.hpp"
#include "import/inp/parameter.hpp"

namespace hilo {

/// *NSET or *ELSET: numbers of the deck.
struct InpSet {
  std::string name;  // as first written
  std::vector<std::int64_t> members;
  bool unsorted = false;  // UNSORTED: *NFILL takes them in this order, not by number
};
/// What a line speaks of: a set, or a node or element by its number.
struct InpTarget {
  std::string target;  // upper case, "" for a number
  std::int64_t id = 0;
  std::string place = {};
};
/// *SURFACE: lines "target, face"; face 0 means the free faces, and in a node surface nothing.
struct InpSurface {
  struct Line : InpTarget {
    int face = 0;
    bool of_shell = false;  // SPOS or SNEG: face 2 or 1
  };
  std::string name;
  bool of_nodes = false;
  std::vector<Line> lines;
};
/// *ORIENTATION of rectangular axes: a on axis 1, b in the plane of axes 1 and 2.
struct InpOrientation {
  std::string name;
  Vec3 a = Vec3::UnitX(), b = Vec3::UnitY();
  std::string not_read = {};  // "*ORIENTATION, SYSTEM=CYLINDRICAL"
  std::string place;
  int about = 0;       // the axis that its second line names
  Mat3 frame() const;  // its axes, as columns
};
struct InpSection {
  std::string elset, material;  // upper case, and as written
  std::string elset_name, material_name;
  std::string place, material_place;
  double area = 0;  // of bars
  std::string orientation = {}, orientation_name = {}, orientation_place = {};
  std::string law = {};  // key of InpDeck::laws
  std::string card = "*SOLID SECTION";
  double thickness = 0, offset = 0;   // of shells: the mid-surface off the nodes, along the normal
  std::string no_solid = {};          // of shells: why a solid-shell cannot stand for them
  double turn = 0;                    // of shells: the axes of their material about the normal, in degrees
  bool several_directions = false;    // of shells: layers of one material, turned
  DeckSection beam = {};              // of beams
  bool along_n2 = false;              // of beams: axis 2 of `beam` is n2, not n1
  Vec3 n1 = Vec3(0, 0, -1);           // of beams
  Vec3 off = Vec3::Zero();            // of beams: their line off the nodes, along n1 and n2; OFFSET1 and 2 say where the nodes are
  std::optional<DeckMaterial> own{};  // *BEAM GENERAL SECTION says its moduli itself
};
/// *ELEMENT of beams, which are cells only where they are to be rigid.
struct InpBeam {
  std::string type;  // "B31"
  std::int64_t id;
  std::vector<std::int64_t> nodes;  // numbers of the deck, two or three
  std::string place;
  const std::string* file = nullptr;
  int line = 0;
};
/// One line of *BOUNDARY, *CLOAD or *INITIAL CONDITIONS, TYPE=VELOCITY: a value on degrees of freedom first..last of a node or node set.
struct InpNodal : InpTarget {
  int first = 0, last = 0;
  double value = 0;
  std::string amplitude = {};  // upper case, "" without
  int step = 0;                // 0 before the first
  int rate = 0;                // of a support: 1 where the value is a velocity, 2 an acceleration
};
/// *BASE MOTION: what is held in a component moves along it.
struct InpBaseMotion {
  int component = 1, rate = 2, step = 1;
  double scale = 1;
  std::string amplitude, place;  // upper case
};
/// One line of *DLOAD or *DSLOAD: pressure on a face of elements, or gravity.
struct InpDistributed : InpTarget {
  int face;      // 1.., 0: a whole surface, -1: gravity, -2: centrifugal, -3: along the normal of shells, -4: by length of beams
  double value;  // of the last the square of the speed
  Vec3 direction;
  std::string amplitude;
  int step = 0;
  Vec3 at = Vec3::Zero();  // a point of the axis of rotation
};
struct InpAmplitude {
  std::string name;
  std::vector<double> t, value;
  bool total = false;               // TIME=TOTAL TIME
  std::vector<double> slopes = {};  // at both ends, of a cubic spline; empty: linear between the points
};
/// *STEP.
/// *STEADY STATE DYNAMICS: frequencies, and the ratio of damping of all modes.
struct InpSweep {
  double from = 0, to = 0, ratio = 0;
  int points = 0;  // 0: there is none
};
/// *MODAL DAMPING: ratios, as first mode, last mode, ratio; or factors of mass and stiffness.
struct InpModalDamping {
  std::vector<std::array<double, 3>> ratios = {};
  double alpha = 0, beta = 0;
  bool rayleigh = false;
  std::string place = {};
};
struct InpStep {
  std::string place, procedure;  // "*STATIC"
  std::string not_read;          // a card in it that is not
  bool nlgeom = false, perturbation = false;
  bool ramps = true, ramps_said = false;                                   // loads without an amplitude; by AMPLITUDE of *STEP
  bool new_supports = false, new_forces = false, new_distributed = false;  // OP=NEW
  double increment = 0, end = 0;
  bool direct = false;  // increments of just that length
  int n_modes = 0;      // of *FREQUENCY
  int points = 20;      // of *STEADY STATE DYNAMICS, whose band are increment and end
  InpModalDamping damping = {};
  double alpha = 0, beta = 0, ratio = 0;  // of its regions
  bool modal = false;                     // modes are summed: *DAMPING of materials says nothing
  InpSweep sweep = {};
  double period() const { return end > 0 ? end : 1; }
};
/// *NODAL THICKNESS of shells.
struct InpThickness : InpTarget {
  double value = 0;
};
/// *TRANSFORM: axes of nodes.
struct InpTransform : InpTarget {
  bool cylindrical = false, is_read = true;
  Vec3 a = Vec3::UnitX(), b = Vec3::UnitY();
  /// As columns, at a point; zero where there are none.
  Mat3 axes(const Vec3& at) const;
};
/// *EQUATION: a sum of displacements, times factors, is zero.
struct InpEquation {
  struct Term {
    InpTarget node;
    int component;
    double factor;
  };
  std::vector<Term> terms;
  std::string place;
};
/// Displacements along one axis that are equal: rows of nodes of cells.
struct InpSlide {
  int component = 0;  // 1 to 3
  Vec3 X;
  std::vector<std::int64_t> rows;
  std::string place;
};
/// An *EQUATION of other than equal displacements: factors times axes of rows of nodes of cells and of slides.
struct InpSum {
  struct OfBody {
    std::int64_t id;  // the node that is a body
    int component;    // 1 to 6
    double factor;
  };
  std::map<std::int64_t, Vec3> rows;
  std::map<int, double> slides;
  std::vector<OfBody> bodies = {};
  std::string place;
};
/// *MPC: nodes that keep their distance (BEAM, LINK) or stay on a line (STRAIGHT) or in a plane (PLANE), wherever these go.
struct InpMpc {
  std::string kind;
  std::vector<InpTarget> nodes;
  std::string place;
};
/// A card of a later step that becomes scene lines only where one run can say that step too.
struct InpStepCard {
  std::string name, place;
  int step;
};
/// What the scene runs: the last of its steps, with the time of all.
struct InpPlan : InpStep {
  int steps = 1;                  // static ones, one behind the other
  bool from_equilibrium = false;  // of static steps before it
};

/// *COUPLING or *RIGID BODY: what follows a reference node, or what it is the mean of.
struct InpTie {
  enum class Of { nodes, cells, surface, weighted } kind = Of::nodes;
  std::string name, of, place;  // card, upper-case name of the set or surface
  InpTarget reference, turns;   // turns: the ROT NODE, whose displacements are the reference node's rotations
  bool mean = false, undecided = false;
  bool no_node = false;                                    // *RIGID BODY without REF NODE: one of its own
  std::vector<std::pair<InpTarget, double>> weights = {};  // of a DCOUP3D, whose element set `reference` names
  bool own_axes = false;                                   // of an ORIENTATION, which say something where only some components are tied
  bool left_out = false;                                   // told already
  unsigned components = 0;                                 // bits 0 to 5
};
/// *TIE or *CONTACT PAIR of two surfaces, by upper-case name.
struct InpPair {
  std::string name, slave, master, place;
  double tolerance = -1;         // of *TIE, POSITION TOLERANCE; below 0: none
  bool adjust = true;            // of *TIE: nodes are moved onto the other surface
  std::string interaction = {};  // of *CONTACT PAIR
};
/// *SURFACE INTERACTION: what happens between two surfaces that meet.
struct InpInteraction {
  std::string name;
  std::string law = {};  // its pressure against overclosure, as named: LINEAR, EXPONENTIAL, TIED; HARD is ""
  double friction = 0;
};
/// *ELEMENT of one or two points: MASS, SPRINGA, SPRING1, DASHPOTA and their like; and the values of *MASS, *SPRING, *DASHPOT.
struct InpPoint {
  std::string type;
  std::int64_t id;
  std::vector<std::int64_t> nodes;
  std::string place;
};
struct InpPointValue {
  std::string elset, name, place;
  std::vector<double> first, second = {};  // numbers of its lines
  bool more = false;                       // further numbers on the last
  bool table = false;                      // NONLINEAR: forces, and extensions or their rates
};
/// A reference node that became a body, with the nodes it carries; or the mean of nodes with weights.
struct InpCarried {
  std::string name, place;
  std::vector<std::int64_t> rows;
  unsigned components = 7;  // of *KINEMATIC: displacements that follow
};
struct InpBody {
  Vec3 X;
  std::string place;
  std::vector<InpCarried> carries;
  std::vector<std::pair<std::int64_t, unsigned>> bodies = {};  // nodes that are bodies too and that it carries, by number; components
};
struct InpMean {
  Vec3 X;
  std::map<std::int64_t, double> of;  // row -> weight
  std::string place;
};

/// `did you mean "low"?` for a name of which the case does not count.
template <class Named>
std::string suggest_name(const std::string& name, const std::map<std::string, Named>& known) {
  std::vector<std::string> keys;
  for (const auto& [key, one] : known) keys.push_back(key);
  std::string hint = suggest(upper(name), keys);
  for (const auto& [key, one] : known)
    if (const auto at = hint.find('"' + key + '"'); at != std::string::npos) return hint.replace(at + 1, key.size(), one.name);
  return hint;
}

struct InpDeck {
  std::set<std::string> files;  // that lines came from, for messages
  std::vector<Vec3> X;
  std::vector<std::int64_t> node_id;
  std::unordered_map<std::int64_t, std::int64_t> node;  // number in the deck -> row of X, of nodes that a cell uses
  std::unordered_set<std::int64_t> unused;              // nodes of no cell
  std::unordered_set<std::int64_t> pyramids;            // elements, and their second halves
  std::vector<std::uint8_t> shape;
  std::vector<std::int64_t> cell_id, offset{0}, cell_nodes;  // nodes as numbers of the deck
  std::vector<int> cell_line;
  std::vector<const std::string*> cell_file;
  std::unordered_map<std::int64_t, std::int64_t> cell;
  std::map<std::string, InpSet> nset, elset;  // by upper-case name
  std::vector<std::string> nset_order, elset_order;
  std::vector<InpSurface> surfaces;
  std::map<std::string, DeckMaterial> materials;   // by upper-case name
  std::map<std::string, std::string> material_at;  // where these are said
  std::map<std::string, InpOrientation> orientations;
  std::map<std::string, DeckMaterial> laws;  // those that sections use, turned by their orientation
  std::string material;                      // the one that *ELASTIC and *DENSITY speak of
  std::vector<InpSection> sections;
  std::vector<InpTie> ties;
  std::vector<InpPair> tied, contacts;
  std::map<std::string, InpInteraction> interactions;  // by upper-case name
  std::string interaction;                             // the one that *SURFACE BEHAVIOR and *FRICTION speak of
  std::string every_pair, every_interaction;           // place of *CONTACT INCLUSIONS, ALL EXTERIOR; what happens there
  std::map<std::int64_t, InpBeam> beams;               // by number; empty where they are cells
  std::unordered_set<std::int64_t> beam_cells;         // elements of bars that are beams
  std::map<std::int64_t, std::int64_t> towards;        // of beams: the node to which direction 1 points from their first, not their section
  std::map<std::int64_t, InpPoint> points;             // by number of the element
  std::vector<InpPointValue> point_values;
  std::unordered_map<std::int64_t, Vec3> loose;  // nodes of no cell
  std::map<std::int64_t, InpBody> bodies;        // by node, as found
  std::map<std::int64_t, InpMean> means;
  std::map<std::int64_t, std::int64_t> turns_of;       // ROT NODE -> reference node
  std::vector<InpNodal> supports, forces, velocities;  // degrees of freedom up to 6, which only reference nodes have
  std::vector<InpBaseMotion> base_motions;
  std::vector<InpDistributed> distributed;
  std::map<std::string, InpAmplitude> amplitudes;
  std::map<std::string, InpParameter> parameters;
  // *ASSEMBLY: its nodes have numbers of their own, and its sets stand beside those of the part that have the same name ("INSTANCE.NAME")
  bool in_assembly = false;
  std::string instance;  // as written
  // of several instances: what is added to the numbers of the one being read, and in front of its names
  std::int64_t shift = 0;
  std::string prefix;                                             // "PART-1-1."
  std::map<std::string, std::int64_t> shift_of;                   // by upper-case name
  size_t first_node = 0, first_section = 0, first_transform = 0;  // of that instance
  std::int64_t node_shift() const;
  struct Placed {
    Vec3 by = Vec3::Zero(), at = Vec3::Zero();
    Mat3 turn = Mat3::Identity();
  } placed;                                       // of the instance
  std::set<std::string> part_nsets, part_elsets;  // upper case
  Vec3 system_at = Vec3::Zero();                  // *SYSTEM, in which nodes are given
  Mat3 system_axes = Mat3::Identity();            // as columns
  std::int64_t generated = 0;                     // nodes and elements by *NGEN, *NFILL, *ELGEN
  std::vector<InpTransform> transformed;          // nodes with axes of their own
  std::vector<InpThickness> thicknesses;
  std::vector<InpEquation> equations;
  std::vector<InpMpc> mpcs;
  std::vector<InpSlide> slides;
  std::map<std::pair<std::int64_t, int>, int> slide_of;  // node and component
  std::vector<InpSum> sums;
  std::string title;
  std::vector<InpStep> steps;
  std::vector<InpStepCard> step_cards;
  InpPlan plan;
  std::vector<std::string> printed;  // node sets of *NODE PRINT, upper case

  bool has_element(std::int64_t id) const { return points.contains(id) || beams.contains(id) || cell.contains(id); }
  /// `at`: the line that makes it, in a file of `files`.
  void add_cell(std::int64_t id, Shape of, std::span<const std::int64_t> nodes, const std::string* at_file, int at_line);
};

/// Added to the numbers of nodes of an assembly, and for each of several instances.
inline constexpr std::int64_t assembly_numbers = 1'000'000'000'000, instance_numbers = 1'000'000'000;
inline std::int64_t InpDeck::node_shift() const { return in_assembly ? assembly_numbers : shift; }
/// The set of this name, new where there is none; one of the part makes room in an assembly.
InpSet& set_of_cells(const std::string& name, InpDeck& deck);
InpSet& set_of_nodes(const std::string& name, InpDeck& deck);
/// The shape of an element type, or an Error at the card that says why there is none.
Shape inp_shape(const Card& card);

}  // namespace hilo
