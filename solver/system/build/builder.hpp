// SPDX-License-Identifier: GPL-3.0-or-later
// Scene and mesh become a System: regions to batches and bodies, names to carriers, entries to connectors, loads and motions.
#pragma once
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "model/beam_line.hpp"
#include "physics/axes.hpp"
#include "physics/spring_kinds.hpp"
#include "system/beam_cells.hpp"
#include "system/build/factor_room.hpp"
#include "system/build/mortar.hpp"
#include "system/build/pair_facet.hpp"
#include "system/build/pairs.hpp"
#include "system/reduction/reduced_file.hpp"
#include "system/solids.hpp"
#include "system/system.hpp"

namespace hilo {

struct RegionParcel;
struct Obstacle;
struct ContactPair;
struct SurfaceTie;
class TiedSurfaces;
struct Load;
class SurfacePair;

class Builder {
 public:
  Builder(const Scene& scene, LocalMesh* mesh, const Comm& comm, const ReducedFiles& files, const FactorRoom& room);
  std::unique_ptr<System> build();

 private:
  /// What a region is made of.
  struct Region {
    std::string name;
    const Entry* material = nullptr;  // null: what the deck carries, and the first kind
    double E = std::nan(""), nu = std::nan(""), density = std::nan("");
    double mass_wanted = 0, area = 0, beta = 0, alpha = 0;
    double modal_damping = 0, up_to = 0;  // of a linear one: ratio, Hz
    std::string shapes, shapes_where;     // file of its modes, where they are given
    const Entry* interface = nullptr;     // that says which nodes have modes of their own
    int n_vibrations = 40;
    bool modes_given = false, stiffening = false, shell = false;
    std::string where, place, shell_where;  // of its material, of its entry, and of `shell`, for errors
    Fidelity fidelity = Fidelity::nonlinear;
    int body = -1;               // rigid: its body; linear: its mean axes
    double mass = 0;             // integrals over its cells, all ranks
    Vec3 moment = Vec3::Zero();  // int rho (X - origin)
    Mat3 second = Mat3::Zero();  // int rho (X - origin)(X - origin)^T
    Vec3 com() const { return moment / mass; }
  };

  // regions.cpp
  std::int64_t put_active_nodes_first();
  void read_regions();
  void warn_of_idle_damping(const Entry& e) const;
  void integrate_regions();
  /// The regions of a fidelity, in groups that hang together by nodes they share; `shared`: pairs of which a rank has seen a node of both;
  /// all ranks' here afterwards.  Collective.
  std::vector<std::vector<int>> joined_regions(Fidelity fidelity, Pairs& shared) const;
  /// One body with the mass of these regions, which it becomes the body of.
  int new_body_of(const std::vector<int>& members);
  void join_by_sets(const std::vector<int>& rigid, Pairs& shared) const;
  void make_rigid_bodies();
  Material material_of(const Region& r) const;
  void make_batches();
  SolidBatch batch_of(int region, Shape shape) const;
  void add_free_bodies();
  // linear.cpp
  void make_linear_bodies();
  void weld(int linear_body, int body, const std::string& name, const std::vector<int>& nodes);
  void weld_neighbours();
  /// Velocities of a linear region that has the momenta, also those of its modes, of its nodes moving with `nodal` (n_nodes).  Collective.
  void set_modal_velocity(int body, const std::vector<Vec3>& nodal, Config& v) const;
  /// Momentum, angular momentum about the centre, momenta of modes.
  void set_velocity(int body, std::span<const double> momenta, Config& v) const;
  // reduction.cpp
  bool is_of(std::int64_t cell, int linear_body) const;
  RegionParcel parcel_of(int number);
  ReductionInput reduction_input(const RegionParcel& parcel, const Body& axes) const;
  void set_wishes(ReductionInput& in, const RegionParcel& parcel, const Body& axes) const;
  Eigen::MatrixXd given_shapes(const RegionParcel& parcel) const;
  Reduction reduction_of(const ReductionInput& in, const Body& axes, const std::string& where);
  std::string kept_place(const std::string& region, const ReductionKey& key) const;
  void keep_reductions() const;
  // interfaces.cpp
  struct Interfaces;
  void add_interfaces(int body, RegionParcel& parcel) const;
  // modes.cpp
  void reduce_linear_regions();
  void spread_shapes(const Modes& modes, const Reduction& found, const std::map<std::int64_t, int>& local);
  // beams.cpp
  void add_sections();
  void add_beams();
  // linear_beams.cpp
  struct BeamPlan;
  struct BeamRegion;
  void check_carriers(const BeamPlan& plan) const;
  void count_cell(const SectionsAlong& sections, const BeamCell& cell) const;
  void add_linear_beams();
  void add_beam_region(std::vector<int> plans, const std::function<bool(int)>& only_here);
  void add_mean_axes(BeamRegion& region);
  BeamRegion* beam_region(int number);
  RegionParcel parcel_of_beams(BeamRegion& region);
  ReductionInput beam_input(const BeamRegion& region, const RegionParcel& parcel) const;
  void add_load_shapes(const BeamRegion& region, const LineLoad& line, ReductionInput& in) const;
  void set_sections(const BeamRegion& region, std::span<const double> motions);
  std::vector<double> section_motions(const BeamRegion& region, const Eigen::MatrixXd& shapes) const;
  /// Sections of linear beams that ride on these bodies start to move.
  void start_sections(const std::vector<bool>& body, const Vec3& velocity, const Vec3& spin, const Vec3& about);
  void set_beam_velocities(Config& v) const;
  // shells.cpp
  void find_shells();
  /// The shape that a cell is taken as, and its nodes in the order of that shape.
  Shape taken_as(std::int64_t cell, std::vector<std::int64_t>& nodes) const;
  // element_limits.cpp
  void warn_of_limits() const;
  // ends.cpp
  struct Found {  // what a name means
    int body = -1;
    std::vector<int> nodes;  // local nodes of a set or flexible region
    std::int64_t n_global = 0;
    bool is_region = false;
    bool linear = false;  // some of them follow a linear region
    int region = -1;
  };
  enum class Asks { acts, looks };  // what looks at a section of a linear beam needs no unknowns there
  Found find(const std::string& name, const std::string& where, Asks asks = Asks::acts) const;
  /// The carrier of a joint's or spring's end; makes a patch of a set on a flexible region.
  Carrier carrier(const Entry& entry, std::string_view key, bool needs_orientation);
  int held_to(int node) const;
  int patch_of(const std::string& name, const Found& found, const std::string& where);
  int body_of(const std::string& name, const Found& found, const std::string& where);
  int new_body(const std::string& name, const Vec3& Xc);
  /// Of a body where no point of it is named: of a section that of the axis, else the centre of mass.
  Vec3 point_of(int body) const;
  void set_follower(int node, int body, const std::string& where);
  void follow_all(const std::vector<int>& nodes, int body, const std::string& where);
  std::vector<int> linear_bodies_at(const std::vector<int>& nodes) const;
  double count_owned(const std::vector<int>& nodes) const;
  Vec3 mean_of(const std::vector<int>& nodes) const;
  double spread_of(const std::vector<int>& nodes) const;
  int nearest_owned(const std::vector<int>& nodes, const Vec3& at) const;
  // build.cpp
  void add_contributions();
  // motions.cpp
  void add_motions();
  void set_initial_velocities();
  // loads.cpp
  struct LoadReading;
  void add_loads();
  void drop_spinning_torques();
  // line_loads.cpp
  void add_line_load(const Entry& e, const Load& load);
  // mass_loads.cpp
  std::vector<std::int64_t> cells_of(int region) const;
  /// Forces of the mass of cells, at accelerations that are linear in the reference position; by node.
  std::map<int, Vec3> forces_of_mass(const std::vector<std::int64_t>& cells, const std::function<double(const Region&)>& density,
                                     const std::function<Vec3(const Vec3&)>& acceleration) const;
  /// Those of the cells that an entry names.  Collective.
  std::map<int, Vec3> forces_of_mass(const Entry& e, const std::function<Vec3(const Vec3&)>& acceleration) const;
  /// The loads on rigid bodies that forces of nodes which follow them make; these nodes are taken out of `force`.  Collective.
  std::vector<Load> take_rigid_share(std::map<int, Vec3>& force, const Load& like) const;
  /// Collective.
  template <class Key, int n>
  std::map<Key, Eigen::Matrix<double, n, 1>> sum_over_ranks(const std::map<Key, Eigen::Matrix<double, n, 1>>& mine) const {
    struct Item {
      Key key;
      std::array<double, n> value;
    };
    std::vector<Item> items;
    for (const auto& [key, value] : mine) std::copy_n(value.data(), n, items.emplace_back(key).value.begin());
    std::map<Key, Eigen::Matrix<double, n, 1>> out;
    for (const Item& item : comm_.gather(items))
      out.try_emplace(item.key, Eigen::Matrix<double, n, 1>::Zero()).first->second +=
          Eigen::Map<const Eigen::Matrix<double, n, 1>>(item.value.data());
    return out;
  }
  /// How what acts on a set or region as a whole, or is measured there, is divided among local nodes; all ranks' sum is one.  Nodes of a
  /// set count alike, those of a region by its mass, so that it means the same at every fidelity.  Collective.
  std::vector<std::pair<int, double>> shares_of(const Found& found) const;
  /// The same where none may be below zero, as for masses.  Collective.
  std::vector<std::pair<int, double>> positive_shares_of(const Found& found) const;
  Vec3 centre_of(const std::vector<std::pair<int, double>>& shares) const;
  // entries.cpp
  /// The history of an entry; every one that acts on the system is taken through here, so that its jumps and kinks are known.
  const History& use_history(const Entry& entry, Acts acts);
  /// Nothing has inertia, nothing needs mass.
  bool is_static() const;
  bool has_axes(const std::vector<std::pair<int, double>>& shares, const Vec3& centre) const;
  void add_stations();
  void add_mass(Body& body, const std::vector<std::pair<Vec3, double>>& points);
  void add_point_masses();
  // springs.cpp
  void add_springs();
  void add_joint_forces();
  /// Rigid joints, and those that give way.
  std::vector<JointHost> joint_hosts() const;
  /// The joint that an entry names.
  JointHost joint_of(const Entry& entry) const;
  std::vector<std::string> all_names() const;
  // blocks.cpp
  void make_blocks();
  /// The nodes, and all others of the blocks that some of them are in.  Collective.
  std::vector<int> whole_blocks(std::vector<int> nodes) const;
  /// Regions that have nodes of one block, to `shared`; `region`: of each local node, or -1.  Collective.
  void join_by_blocks(const std::vector<int>& region, Pairs& shared) const;
  void hold_blocks(const std::vector<int>& body_of);
  // joints.cpp
  void add_joints();
  /// Of a rigid beam, by its mean axes, with a body.
  void add_bond(int axes, int body, const Vec3& at);
  void add_joint_coordinates();  // joint_coordinates.cpp
  // contacts.cpp
  void add_contacts();
  void add_points_of_body(const Entry& entry, const Obstacle& b, int body, ContactPair& pair);
  void add_points_of_surface(const Entry& entry, ContactPair& pair);
  // pairs.cpp
  void bring_pairs_together();
  /// The facets of all ranks in the order of the mesh, on rank 0 alone.  Collective.
  std::vector<PairFacet> on_first_rank(const std::vector<Facet>& facets) const;
  // surfaces.cpp
  /// This rank's facets of a region's outer surface, or of a set, in the order of the mesh.  Collective.
  std::vector<Facet> facets_of(const Entry& entry, std::string_view key);
  void add_surfaces(const Entry& entry, const std::vector<std::string>& obstacles);
  void fill_surfaces(const Entry& entry, const std::array<std::vector<PairFacet>, 2>& facets, SurfacePair& pair);
  // ties.cpp
  std::vector<Facet> facets_to_tie(const Entry& entry, std::string_view key);
  std::vector<MortarFacet> tied_facets(const Entry& entry, std::string_view key, const std::vector<PairFacet>& facets) const;
  void find_tie(const Entry& entry, const std::array<std::vector<PairFacet>, 2>& facets, SurfaceTie& tie);
  void close_ties();
  bool is_smoother(const std::vector<PairFacet>& one, const std::vector<PairFacet>& other) const;
  void group_tied_nodes(TiedSurfaces& ties) const;
  void add_ties();

  /// A beam whose sections are known, but for those that ride on what is made later.
  struct BeamPlan {
    const Entry* entry;
    BeamLine line;
    std::vector<int> body;  // of each section, -1: not yet known
    Fidelity fidelity = Fidelity::nonlinear;
    bool by_modes() const { return fidelity != Fidelity::nonlinear; }
    std::vector<SectionsAlong> sections{};  // of each cell
  };
  /// Beams of one fidelity that hang together by their sections and by bodies without mass: one set of mean axes, and modes if linear.
  struct BeamRegion {
    int modes = -1;
    bool rigid = false;
    std::vector<int> plans;
    struct Place {
      int body;
      bool only_here;             // nothing but this region moves it: carried, unless something acts on it
      bool carried = false;       // known last
      std::vector<int> sections;  // of LinearBeams, which ride on it
    };
    std::vector<Place> places;
    std::vector<int> sections;  // of LinearBeams
    int first_cell = 0, n_cells = 0;
    double arm = 0;  // of the nodes from the origins of their sections [m]
  };

  const Scene& scene_;
  LocalMesh* mesh_;
  const Comm& comm_;
  const ReducedFiles& files_;
  const FactorRoom& room_;
  std::vector<KeptReduction> reductions_;  // on rank 0, that go to a file
  std::int64_t n_active_ = 0;              // nodes that a configuration holds
  std::unique_ptr<System> out_;
  std::vector<Region> regions_;
  std::vector<double> reduced_;              // by region: hex20 taken as hex20r on this rank
  std::vector<char> shell_axis_;             // by cell: 1 + the axis of a shell's thickness, 0: none; empty: no shells
  Vec3 origin_ = Vec3::Zero();               // of the mass integrals
  std::map<std::string, int> body_by_name_;  // [[body]] entries
  std::map<std::string, int> patch_by_name_;
  std::vector<BeamPlan> beam_plans_;
  std::map<int, Vec3> section_at_;  // of bodies that are sections of beams, the point of the axis
  std::vector<BeamRegion> beam_regions_;
  std::map<int, std::array<Vec3, 2>> section_starts_;      // velocity and spin of sections of linear beams
  mutable std::set<int> acted_on_;                         // bodies that an entry joins, loads or moves, and does not only look at
  std::vector<std::vector<MortarRow>> mortar_;             // by tie
  std::vector<std::pair<std::string, std::string>> tied_;  // place and label, by tie
  std::vector<std::string> held_by_;                       // per node: the entry that made it a follower of a patch or motion
};

}  // namespace hilo
