// SPDX-License-Identifier: GPL-3.0-or-later
// What is made of an .inp deck between its cards and its scene.
#pragma once
#include <functional>

#include "import/inp/deck.hpp"

namespace hilo {

using Rows = std::vector<std::int64_t>;

// names, numbers and rows
/// A qualified name, "ASSEMBLY.TOP" or "PART-1-1.TOP", as the deck's own where that is what it has.
std::string unqualified(const std::string& name);
/// Supports, loads, surfaces and sections name sets as the deck has them; numbers behind a dot become numbers.
void unqualify(InpDeck& deck);
/// The set of a target, by its name or without what qualifies it; Error where there is none.
const InpSet& set_of(const std::map<std::string, InpSet>& sets, const InpTarget& target, const char* of, bool qualified = true);
/// The numbers of the deck that a target names among such sets, whether they are there or not; none of a set that is not there.
std::vector<std::int64_t> numbers_in(const std::map<std::string, InpSet>& sets, const InpTarget& target);
/// Rows of the nodes, or cells, that a target names; numbers that no cell uses are left out.
std::vector<std::int64_t> inp_nodes(const InpDeck& deck, const InpTarget& target);
std::vector<std::int64_t> inp_cells(const InpDeck& deck, const InpTarget& target);
/// The place of a node, of a cell or not; null where there is none.
const Vec3* point_of(const InpDeck& deck, const Mesh& mesh, std::int64_t node);
/// Whether a node is of shells that become pairs of nodes.
bool is_of_pairs(const InpDeck& deck, const Imported& in, std::int64_t node);
/// The section of each cell, the last one that has it; null where none has.
std::vector<const InpSection*> section_of_cells(const InpDeck& deck);
/// Facets of the deck's faces: the local facet that has the corners of face `face` of an Abaqus element; -1 where there is none.
int inp_facet(Shape shape, int face);

// steps, in this order
/// *FREQUENCY and *MODAL DYNAMIC or *STEADY STATE DYNAMICS behind it become one step.
void take_modal(InpDeck& deck, Imported& in);
/// Velocities and accelerations of supports, and *BASE MOTION, become displacements; of lengths alone --scale has its say.
void find_motions(InpDeck& deck, Imported& in, double scale);
/// Supports and loads of the first steps become those of one run, with amplitudes over its whole time, and `deck.plan` says what is run:
/// static steps one behind the other, or what follows from their equilibrium, dynamic steps or modes.  Steps that this cannot say are
/// named, with what is in them.
void join_steps(InpDeck& deck, Imported& in);
/// A line for each component.  Where lines, from that step on, speak of a component of a node (`vectors`: of a node) that others name
/// otherwise, each node has its own.
std::vector<InpNodal> apart(const InpDeck& deck, const std::vector<InpNodal>& lines, int from_step, bool vectors = false);
/// Whether two CENTRIF turn about one line.
bool is_same_axis(const InpDistributed& a, const InpDistributed& b);
/// What is left of a line without the components from `first` to `last`.
std::vector<InpNodal> without(const InpNodal& line, int first, int last);

/// The law of each section: its material.  Where that differs with direction, it has the section's axes, in shells laid into their surface.
void turn_materials(InpDeck& deck, Imported& in, bool thicken);

// beams, and shells that become pairs of nodes
/// Beams as cells of bars; an Error where one has three nodes.
void beams_as_cells(InpDeck& deck);
/// Of a beam that begins at `from`: towards a node, or as its section says.
Vec3 direction_1(const InpDeck& deck, const Mesh& mesh, const InpSection& section, std::int64_t element, const Vec3& from);
/// Nodes of beams are bodies.
void find_beams(InpDeck& deck, Imported& in);
/// Nodes of shells that pairs of nodes cannot stand for are bodies.
void find_bodies_of_shells(InpDeck& deck, Imported& in);

// *EQUATION: displacements that are equal, as a body of no mass that slides and takes the nodes along
/// Numbers of the nodes that a term names.
std::vector<std::int64_t> numbers_of(const InpDeck& deck, const InpTarget& target);
/// Terms of one node become supports, those of two equal displacements `deck.slides`; others are named.
void find_equations(InpDeck& deck, Imported& in);
/// The slide of a displacement (1 to 3) of a node, or -1.
int slide_of(const InpDeck& deck, std::int64_t node, int component);
/// A node of no cell whose displacement an equation speaks of.
bool is_slide(const InpDeck& deck, std::int64_t node);
std::string slide_name(const InpDeck& deck, int slide);

// reference nodes, springs and masses
/// Which nodes of no cell become bodies or means; what no scene can say is told.
void find_ties(InpDeck& deck, Imported& in, const std::map<std::string, std::string>& surface);
/// Whether a node of no cell is a body or a mean.
bool is_tied(const InpDeck& deck, std::int64_t id);
/// Calls `use(node, first, last)` for the tied nodes that a line speaks of, with degrees of freedom from 1 to 6.
void tied_lines(const InpDeck& deck, const InpNodal& line, const std::function<void(std::int64_t, int, int)>& use);
/// Of the elements that have one, by number.
std::map<std::int64_t, double> masses_of(const InpDeck& deck);
/// Of the model, 1 where it has none: for points beside others.
double size_of(const InpDeck& deck, const Mesh& mesh);
std::string body_name(const InpDeck& d, std::int64_t id);
/// A name that no set and no surface of the deck has: the wish, or with _body behind it.
std::string free_body_name(const InpDeck& deck, std::string wish);

// nodes that are held or pushed, in groups that each become one entry of the scene
/// A group of nodes held in the same components to the same values.
struct Held {
  std::string target, amplitude, place;
  std::array<bool, 3> on{};
  Vec3 value = Vec3::Zero();
  bool moved = false;
  Rows nodes = {};
};
/// A component of a node held along an axis that is none of the model's.
struct HeldAskew {
  std::int64_t node;
  Vec3 axis;
  std::string place;
};
/// *BOUNDARY by set, or equal supports of single nodes together; the last line that speaks of a component of a node holds it.
/// `askew`: those in axes of *TRANSFORM.
std::vector<Held> held_groups(const InpDeck& deck, const std::vector<int>& turned, Imported& in, std::vector<HeldAskew>& askew);

/// A vector on each node of a group.
struct Nodal {
  std::string target, amplitude, place;
  Vec3 value = Vec3::Zero();
  Rows nodes;
};
/// *CLOAD (values on the same node add up) or initial velocities (the last one holds): by set, or equal vectors of single nodes together.
std::vector<Nodal> nodal_groups(const InpDeck& deck, const std::vector<InpNodal>& lines, const char* what, bool add,
                                const std::vector<int>& turned, Imported& in);

/// Which *TRANSFORM each node has, or -1.
std::vector<int> turned_nodes(const InpDeck& deck, const Mesh& mesh);

// springs and dampers whose force is a table, or acts along one component of nodes that are not in a line along it
/// An end of a spring: its name in the scene and its place, in units of the deck.
struct InpSpringEnd {
  std::string name;
  Vec3 X;
  bool turns = false;  // a body, not a node
};

/// The element, its value and its ends: one for SPRING1 and DASHPOT1.
struct InpPointSpring {
  const InpPoint& element;
  const InpPointValue& value;
  std::vector<InpSpringEnd> ends;
};

/// Why no line of a scene says it; "" where one does.
std::string why_no_spring(const InpPointSpring& spring);
/// `size` of the model, in units of the deck.
void write_point_spring(const InpDeck& deck, double size, const InpPointSpring& spring, const ImportOptions& options, SceneWriter& scene);

// lines of the scene
/// [[body]], [[point_mass]], [[joint]] and [[spring]].
void write_ties(const InpDeck& deck, Imported& in, SetNames& names, const ImportOptions& options, SceneWriter& scene);
/// Sections, materials, beams and what ties their nodes to solids, as scene lines.
void write_beams(const InpDeck& deck, Imported& in, SetNames& names, const ImportOptions& options, SceneWriter& scene);
/// Scene lines of the deck's materials, supports and loads (in.scene), and the sets that they name.  `node_set` gives the final name
/// of a node set of the deck, `surface` that of a surface.
void write_inp_scene(const InpDeck& deck, Imported& in, SetNames& names, const std::map<std::string, std::string>& node_set,
                     const std::map<std::string, std::string>& surface, const ImportOptions& options);

}  // namespace hilo
