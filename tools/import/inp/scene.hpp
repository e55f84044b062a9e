// SPDX-License-Identifier: GPL-3.0-or-later
// The scene lines of an .inp deck, in the making: what its parts (supports, loads) share.
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "import/inp/passes.hpp"

namespace hilo {

/// Writes the lines in the order of a scene file.
class InpScene {
 public:
  InpScene(const InpDeck& deck, Imported& in, SetNames& names, const std::map<std::string, std::string>& node_set,
           const std::map<std::string, std::string>& surface, const ImportOptions& options);
  SceneWriter write();

 private:
  // scene.cpp
  void materials();
  void histories();
  double dynamic_step(double end);
  void time();
  // scene_supports.cpp
  void supports();
  void hold(const Held& h);
  Mat3 axes_of(std::int64_t id) const;
  void supports_of_ties();
  void slides();
  void sums();
  // scene_mpcs.cpp
  struct MpcEnd {
    std::string name;
    Vec3 X;
    std::int64_t row;  // of a node of a cell, or -1
  };
  std::string why_no_end(const InpMpc& mpc, std::int64_t id) const;
  std::vector<MpcEnd> ends_of(const InpMpc& mpc, const std::vector<std::int64_t>& ids);
  void keep_distances(const InpMpc& mpc);
  void stay_together(const InpMpc& mpc);
  std::int64_t row_beside(const std::vector<MpcEnd>& ends, const Vec3& along);
  void mpcs();
  // scene_pairs.cpp
  const std::string* facets_of(const InpPair& pair, const std::string& surface, const char* card);
  void tied();
  void contacts();
  // scene_loads.cpp
  void tell_empty_sets();
  void gravity();
  void centrifugal();
  void load_of_mass(const InpDistributed& p, const char* kind, const std::string& wish, std::initializer_list<SceneKey> keys);
  bool turns(std::int64_t mass) const;
  void tell_turns(const InpDistributed& p);
  void load_of_points(const InpDistributed& p, const std::function<Vec3(const Vec3&)>& acceleration);
  void forces();
  std::map<size_t, Rows> by_number_of_nodes(const Rows& nodes);
  std::string end_of(std::int64_t row, const std::string& wish);
  void forces_of_ties();
  void pressures();
  void line_loads();
  void velocities();

  Vec3 point(const Vec3& x) const { return o_.point(x); }
  double si(const char* unit) const { return o_.si(unit); }
  /// The set that holds just these nodes: the one named in the deck where it is that, else a new one.
  std::string set_of(const std::string& target, Rows nodes, const std::string& wish, bool each);
  /// The name of an amplitude's [history.NAME], "" without one; nothing when the deck's amplitude was not read.
  std::optional<std::string> history(const std::string& amplitude, const std::string& what, const std::string& place);

  const InpDeck& d_;
  Imported& in_;
  SetNames& names_;
  const std::map<std::string, std::string>&node_set_, &surface_;
  const ImportOptions& o_;
  std::set<std::int64_t> own_axes_;        // the same by number, nodes of no cell too
  std::vector<int> turned_;                // *TRANSFORM of each node, or -1
  std::set<std::int64_t> of_solids_;       // rows, beside shells that become pairs
  std::set<std::int64_t> of_beams_;        // numbers of nodes
  std::map<std::int64_t, double> masses_;  // by element
  std::set<std::string> wanted_;           // amplitudes that a load or motion is scaled by
  std::vector<std::int64_t> a_cell_;       // a solid one of each node, or -1; empty until asked for
  std::map<std::string, int> made_;        // sets made of single nodes or elements
  SceneWriter scene_;
  SceneValue gravity_;
};

}  // namespace hilo
