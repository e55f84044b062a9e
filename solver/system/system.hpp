// SPDX-License-Identifier: GPL-3.0-or-later
// The whole model as one residual and tangent: contributions to the equations of motion of nodes and bodies.
//
//   r(q0, q1, lambda) = M a - M g + f_int(q0, q1) + G_left^T lambda - F,      g(q1) = 0
#pragma once
#include <functional>
#include <memory>

#include "base/history.hpp"
#include "model/scene.hpp"
#include "system/contribution.hpp"

namespace hilo {

/// A history that acts on the system, and the lowest of its derivatives that forces follow: the value of a load or motor, the slope of a
/// prescribed rate, the curvature of a prescribed position.
enum class Acts { as_force = 0, as_rate = 1, as_position = 2 };
struct UsedHistory {
  std::string owner;
  History history;
  Acts acts;
};

class System : public Points {
 public:
  std::vector<UsedHistory> histories;          // all of them
  std::vector<std::vector<int>> region_nodes;  // free nodes that move about together, for the predictor

  /// A further contribution; all of them are there before prepare().
  template <class T, class... Args>
  T& add(Args&&... args) {
    auto part = std::make_unique<T>(std::forward<Args>(args)...);
    T& out = *part;
    cast_.add(out);
    by_type_.emplace_back(&tag<T>, &out);
    parts_.push_back(std::move(part));
    return out;
  }
  std::span<const std::unique_ptr<Contribution>> parts() const { return parts_; }
  /// Those that play a role, in their order.
  template <class Role>
  const std::vector<Role*>& all() const {
    return cast_.all<Role>();
  }
  /// The contribution of a type, for what is about that type alone.
  template <class T>
  T& part() {
    for (const auto& [type, part] : by_type_)
      if (type == &tag<T>) return *static_cast<T*>(part);
    throw Error("", "the system lacks a contribution", "", Exit::fault);
  }
  template <class T>
  const T& part() const {
    return const_cast<System*>(this)->part<T>();
  }
  /// All constraint rows, by the things that have them; there from prepare() on.
  std::span<const std::unique_ptr<Constraint>> constraints() const { return constraints_; }

  /// Number the unknowns and list the cliques; call once after everything is filled in.  Collective.
  void prepare();
  /// Look for what can meet in a step of length h from q; where the structure becomes another one, `layout` is replaced by it and what was
  /// laid out like the old multipliers has to be carried over.  Collective.
  std::optional<Carry> search(const Config& q, const Config* v, double h);
  /// The layout of what the contributions hold, as after their state was restored.
  Carry number();
  const Traits& traits() const { return traits_; }
  /// Residual, and tangent into `K` when given.  lambda: (3 x joint blocks), indexed by block - first joint block.
  void evaluate(const Stage& stage, std::span<const double> lambda, Residual& out, KktSolver* K) const;
  /// Residual forces before reduction, for reactions.  Collective.
  void forces(const Stage& stage, std::span<const double> lambda, Forces& out) const;
  /// At the state of the step tried last (advance), or else the accepted one.
  Energy energy(const Config& q, const Config& v) const;
  /// The state of what remembers at the end of a step of this stage, then to be kept or forgotten.
  void advance(const Stage& stage);
  void settle(bool accepted);
  /// Work from s.from() to s.end.
  Work work(const Stage& stage, std::span<const double> lambda) const;
  Violation violation(const Config& q, double t, double factor = 1) const;
  /// Which rows are kept, laid out like lambda.
  std::vector<char> rows_on() const;
  /// What the unknowns of a local block belong to, or "".
  std::string owner(int block) const;
  /// The same of a multiplier block, counted from the first.
  std::string row_owner(int k) const { return k >= 0 ? owner(first_joint_block() + k) : ""; }
  /// First and, where asked for, second derivatives by time of all rows less their courses, laid out like lambda.
  void row_rates(const Config& q, const Config& v, const Config* a, double t, std::vector<double>& rate,
                 std::vector<double>* acceleration) const;
  /// Largest angle by which a body or a cell turns from q0 to q1, and which, the same on all ranks.
  struct Turn {
    double angle = 0;  // [rad]
    int part = -1, item = -1;
  };
  Turn largest_turn(const Config& q0, const Config& q1) const;
  /// Why a step from rest at q0 to rest at q1 is too long, or "".
  std::string too_far(const Config& q0, const Config& q1) const;
  /// "body \"b\"" or "a cell of region \"r\"".
  std::string name(const Turn& turn) const;
  /// The share, in (0, 1], of the way that a correction of Newton's may go: the least that a contribution allows.  Collective.
  double longest_share(const Config& from, const Config& to) const;
  /// 'a cell of region "r" is [all but] turned inside out (det F = -0.1)'.
  std::string inside_out(const LeastDet& least) const;

  /// Positions of what moves by a law at time t: driven bodies and components of nodes.
  void prescribe(Config& q, double t, double ramp = 1) const;
  /// Their velocities and accelerations (either may be null), the limits from one side.
  void prescribe_rates(double t, Side side, Config* v, Config* a) const;
  /// What moves by a law in `to` becomes that of `from`.
  void copy_prescribed(const Config& from, Config& to) const;
  /// Why a step from t0 to t1 is too long for a law, or nothing: a body that turns by more than a quarter of a turn in it has no mean.
  std::string too_far(double t0, double t1) const;
  bool moves() const { return moves_; }  // whether anything moves by a law of its own

  /// Why q cannot be ("joint ... ran off the end of its curve"), or nothing; the same on all ranks.
  std::string fault(const Config& q) const;
  /// Accept q, with velocities v, as the state to go on from.
  void commit(const Config& q, const Config* v = nullptr);
  /// What the contributions remember.
  void archive(Archive& a);
  /// This rank's part of it, as it is now, and back to that: turns are counted from state to state, so a state alone does not tell them.
  Kept memory();
  void recall(const Kept& memory);
  /// How configurations and cells lie on this rank.  Collective.
  Shares shares() const;

  /// Motions of parts as rigid bodies that neither stiffness nor joints nor prescribed motions resist at a static stage.
  struct Loose {
    std::string text;                           // 'region "bar" is free to turn about ...', or nothing
    std::vector<std::vector<double>> straight;  // increments of those in which nothing turns
  };
  Loose loose(const Stage& stage, bool with_loads) const;

 private:
  void add_all(const Stage& stage, std::span<const double> lambda, Residual& out, KktSolver* K, std::vector<Vec3>& node,
               std::vector<Vec6>& body, bool loads) const;
  double constraint_scale(const Stage& s) const;
  void reduce(Pass& p) const;
  std::vector<std::unique_ptr<Contribution>> parts_;
  std::vector<std::unique_ptr<Constraint>> constraints_;
  Traits traits_;
  bool moves_ = false;
  Layout points_;  // the layout without contributions
  Cast cast_;
  template <class T>
  static constexpr char tag = 0;                        // its address is the type's
  std::vector<std::pair<const char*, void*>> by_type_;  // for `part`, which is asked at every step
};

/// Where the modes of linear regions are kept: `from` is taken instead of finding them, and must fit; where there is a `to`, what fits of
/// `from` is taken, the rest found, and all of it written.  A folder `from` serves as far as it has them, and gets those it lacks.
struct ReducedFiles {
  std::string from, to;
  std::vector<std::string> provenance;
};
/// Build the system of a scene.  Errors carry the scene's places.
std::unique_ptr<System> build_system(const Scene& scene, LocalMesh* mesh, const Comm& comm, const ReducedFiles& files = {});

/// From outside this tree, before the first scene is read: entries [[words.name]] of a scene, and what adds a contribution made of them to
/// the system, of which bodies, nodes, joints and loads are there.
void add_contribution(const OwnSection& words, std::function<void(const Scene&, System&)> make);

}  // namespace hilo
