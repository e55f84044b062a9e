// SPDX-License-Identifier: GPL-3.0-or-later
// The scene lines of a Nastran file, in the making: what its parts (supports, loads, links) share.
#pragma once
#include <fmt/format.h>

#include <array>
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "import/bdf/card.hpp"
#include "import/links.hpp"
#include "import/sheets.hpp"

namespace hilo {

/// A grid is a node of cells, or it becomes a body of its own when something is tied to it, or the mean of others (RBE3), or nothing.
class BdfScene {
 public:
  BdfScene(const BdfDeck& deck, Imported& in, SetNames& names, const ImportOptions& options);
  SceneWriter write();

 private:
  enum class End { nothing, node, body, mean, ground };
  using Rows = std::vector<std::int64_t>;

  // scene.cpp
  void materials();
  void turned_material(std::int64_t property, const DeckMaterial& m, SceneTable& region);
  void hold();
  void supports();
  void equations();
  std::string why_no_sum(const BdfEquation& m) const;
  bool is_slide(const BdfEquation& m) const;
  bool is_joint(const BdfEquation& m) const;
  void sum_up(const BdfEquation& m);
  void time();
  // scene_links.cpp
  void find_masses();
  void find_bodies();
  void find_bodies_of_shells();
  void join_rigid();
  void bodies();
  void rigid();
  void rigid(const BdfRigid& r);
  // scene_beams.cpp
  void beams();
  void beam(const BdfDeck::Thin& b);
  std::vector<double> sections_of(const BdfDeck::Thin& b, double length) const;
  bool nothing_twists(std::int64_t property) const;
  // scene_pairs.cpp
  std::string pair_surface(std::int64_t region);
  void pairs();
  // scene_springs.cpp
  void springs();
  void scalar_spring(const BdfSpring& s, double k, double c);
  void sliding_spring(const Vec3& axis, const std::string& name, std::int64_t a, std::int64_t b, double k, double c,
                      const std::string& place);
  void line_spring(const BdfSpring& s, double k, double c);
  void axial_spring(const std::string& name, const std::string& a, const std::string& b, const Vec3& at_a, const Vec3& at_b, double k,
                    double c, const std::string& place);
  void bush(const BdfSpring& s, const BdfSpringData& p);
  // scene_loads.cpp
  void choose_loads();
  void gravity();
  void rotation(double factor, const BdfLoad& l);
  void rotation_of_bodies();
  void varying_pressure(double factor, const BdfLoad& l);
  template <class Use>
  void each(BdfLoad::Kind kind, const Use& use) {
    for (const auto& [factor, l] : loads_)
      if (l->kind == kind) (this->*use)(factor, *l);
  }
  void nodal_loads();
  void distribute(const BdfMean& m, const Vec3& F, const Vec3& M, const std::string& place);
  void pressures();
  void line_load(double factor, const BdfLoad& l);
  Facet face_of_solid(const BdfLoad& l, std::int64_t element) const;

  double si(const char* unit) const { return options_.si(unit); }
  Vec3 point(const Vec3& x) const { return options_.point(x); }
  /// The set of just these nodes: one that is there, or a new one.  `listed`: each of its nodes counts.
  std::string set_of(Rows nodes, const std::string& wish, bool listed = false);
  std::string node_set(std::int64_t row) { return set_of({row}, fmt::format("node_{}", deck_.node_id[static_cast<size_t>(row)]), true); }
  /// Row of a grid; an Error where it is not there.
  std::int64_t row(std::int64_t grid, const std::string& place, const std::string& who) const;
  End end(std::int64_t row) const;
  static std::string body_name(std::int64_t grid) { return fmt::format("grid_{}", grid); }
  std::string end_name(std::int64_t row) {
    return row < 0 ? "ground" : end(row) == End::body ? body_name(deck_.node_id[static_cast<size_t>(row)]) : node_set(row);
  }
  const Vec3& X(std::int64_t row) const { return deck_.X[static_cast<size_t>(row)]; }
  /// The axes in which a grid has its components.
  Mat3 axes(std::int64_t row) const {
    const BdfGrid& g = deck_.grids[static_cast<size_t>(row)];
    return axes_at(deck_, g.output.value_or(0), X(row), g.place);
  }
  void joint(unsigned components, const Mat3& axes, const std::string& name, const std::string& a, const std::string& b, const Vec3& at,
             const std::string& place) {
    joints_that_hold(scene_, components, axes, name, a, b, point(at), place);
  }
  void spring_along(const Vec3& axis, const std::string& name, const std::string& a, std::int64_t b, double k, double c,
                    const std::string& place);

  const BdfDeck& deck_;
  Imported& in_;
  SetNames& names_;
  const ImportOptions& options_;
  double size_ = 1;                              // of the model, in units of the deck
  std::vector<char> used_;                       // by cells (n grids)
  std::vector<BdfMass> masses_;                  // CONM2, and what CMASS1 and CMASS2 are together
  std::vector<BdfRigid> rigid_;                  // those that share a turning node as one
  std::map<std::int64_t, std::string> body_;     // row -> what makes a body of it
  std::map<std::int64_t, const BdfMean*> mean_;  // row -> the mean that it follows
  struct HeldBody {
    unsigned bits = 0;  // components
    Prescribed by;
  };
  std::map<std::int64_t, HeldBody> body_held_;  // by row
  struct Held {
    unsigned bits = 0;
    std::array<double, 6> value{};
    std::string place;  // of the first
    void hold(unsigned components, double at, const std::string& where) {
      if (place.empty()) place = where;
      bits |= components;
      for (size_t k = 0; k < 6; ++k)
        if (components >> k & 1) value[k] = at;
    }
  };
  std::map<std::int64_t, Held> held_;  // by row: components that a grid is held in, and at which values
  std::set<std::int64_t> of_solids_;   // rows, beside shells that become pairs
  /// The sheets that a grid of shells is in, where these become pairs of nodes.
  const std::vector<Sheets::Part>& sheets(std::int64_t row) const { return sheets_at(in_, row); }
  bool is_of_shell(std::int64_t row) const { return !sheets(row).empty(); }
  std::unordered_map<std::int64_t, const BdfDeck::Thin*> shell_;  // by number
  std::map<std::int64_t, std::string> on_beam_;                   // row of a grid of beams -> place
  struct MadeBeam {
    std::string name;
    Mat3 axes;                        // x along, y in plane 1
    Vec3 start;                       // of its first section, as lengths below in units of the deck
    std::vector<double> sections;     // where they stand along it
    std::array<std::string, 2> ends;  // bodies that its ends are fixed to; "" at a pin
    bool apart = false;               // its neutral axis is off its shear centre
    double length() const { return sections.back(); }
    size_t section(double s) const;
    std::string body(size_t section) const;
  };
  struct Spin {
    Vec3 at, omega;  // in units of the deck
    std::string place;
  };
  std::vector<Spin> spins_;                                      // RFORCE
  std::multimap<std::int64_t, const BdfLoad*> by_beam_;          // PLOAD1
  std::map<std::int64_t, MadeBeam> made_beams_;                  // by element
  std::map<std::int64_t, std::array<DeckSection, 2>> sections_;  // of beams, by property
  std::vector<std::pair<double, const BdfLoad*>> loads_;
  struct Sum {
    Vec3 value = Vec3::Zero();
    std::string place;  // of the first
    void add(const Vec3& more, const std::string& where) {
      value += more;
      if (place.empty()) place = where;
    }
  };
  std::map<std::int64_t, Sum> force_, moment_;     // by row
  std::map<std::int64_t, std::string> glue_name_;  // region -> set
  std::map<Rows, std::string> set_by_rows_;
  SceneWriter scene_;
  SceneValue gravity_;
};

}  // namespace hilo
