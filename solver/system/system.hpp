// The whole model as one residual and tangent: flexible cells, rigid bodies, joints, springs, loads.
//
//   r(q0, q1, lambda) = M a - M g + f_int(q0, q1) + G_left^T lambda - F,      g(q1) = 0
//
// Unknowns are 3 x 3 blocks: one per free node, two per free body (translation, rotation vector), ceil(rows/3) per joint.  A body's
// twelve coordinates are condensed to six by the null space of its length constraints, P = [I, -skew(x - c)], taken at the left
// configuration for the equations and at q1 for the increments [betsch-leyendecker-2006]; lengths then hold by construction.
#pragma once
#include <functional>
#include <memory>
#include <optional>

#include "linear/kkt.hpp"
#include "model/local_mesh.hpp"
#include "model/scene.hpp"
#include "physics/connector.hpp"
#include "physics/solid_kernel.hpp"

namespace hilo {

/// Cells of one region and shape: one kernel, one set of constants.
struct SolidBatch {
  Shape shape;
  Material material;
  double density;              // [kg/m^3]
  double beta = 0, alpha = 0;  // stiffness- and mass-proportional damping [s, 1/s]
  double area = 0;             // of bars [m^2]
  int region;
  std::vector<int> cells;  // local cells
  std::vector<int> nodes;  // (n_cells x n)
  int first_clique = 0;
  SolidKernel kernel;
};

/// A load: nodal weights or facets or a body, times a history.
struct Load {
  enum class Kind { nodal, pressure, body_force, body_torque } kind;
  std::string name;
  Vec3 value = Vec3::Zero();  // force [N] or torque [N m]; for nodal loads per unit weight
  double pressure = 0;        // [Pa]
  bool follower = false;
  std::vector<int> nodes;                // nodal
  std::vector<double> weight;            // share of each node; for a traction its reference area [m^2]
  std::vector<std::vector<int>> facets;  // pressure: nodes of each facet, outward
  std::vector<int> cliques;              // of the facets
  int body = -1;
  Vec3 arm = Vec3::Zero();  // body axes
  History history;
  bool ramped = false;  // without a history: follows the load factor of a static analysis
  double factor(double t0, double t1, double ramp) const { return (ramped ? ramp : 1) * (t1 > t0 ? history.mean(t0, t1) : history(t0)); }
};

/// Prescribed motion of a body (fixed, translation, rotation) or of single components of nodes.
struct Motion {
  std::string name;
  int body = -1;           // the driven body, or -1: components of nodes
  std::vector<int> nodes;  // nodes of the components, or followers of the driven body
  std::array<bool, 3> component{true, true, true};
  Vec3 displacement = Vec3::Zero();  // at law 1 [m]
  Vec3 at = Vec3::Zero(), axis = Vec3::Zero();
  double angle = 0;     // at law 1 [rad]
  bool moving = false;  // fixed: the law rests at 0
  MotionLaw law;
};

/// A history that acts on the system, and the lowest of its derivatives that forces follow: the value of a load or motor, the slope of a
/// prescribed rate, the curvature of a prescribed position.
enum class Acts { as_force = 0, as_rate = 1, as_position = 2 };
struct UsedHistory {
  std::string owner;
  History history;
  Acts acts;
};

/// From which side an instant is reached: the end of a step from the left, its start from the right.
enum class Side { left = -1, right = 1 };

/// A measured place: mean of nodes, or a point of a body.
struct Station {
  std::string name;
  bool sensor = false;
  int body = -1;
  Vec3 arm = Vec3::Zero();       // body axes
  std::vector<int> nodes;        // owned ones
  double n_nodes = 0;            // on all ranks
  Vec3 mean = Vec3::Zero();      // reference mean of the nodes
  Mat3 axes = Mat3::Identity();  // sensor axes at the start, columns
};

/// Everything an evaluation needs besides the unknowns: where in the step an integrator takes which term.
struct Stage {
  const Config* end;                  // q1, the unknown: increments and constraint rows live here
  const Config* left;                 // configuration of the left null space and of the constraint gradients
  double slope = 0.5;                 // d left / d end
  const Config *e0, *e1;              // elastic pair: the ends of the step, or one configuration twice
  double weight = 0.5;                // share of e1 in averages; 1/2 of two different ends means discrete gradients over the step
  double chain = 1;                   // d e1 / d end
  const Config *w0, *w1;              // pair of the rate terms, rate = (e(w1) - e(w0))/h: v h/2 on either side of `left`
  double h = 0;                       // time between w0 and w1 [s]; 0: no rate terms
  double span = 0;                    // time that the stage stands for in the work of the rate terms [s]; 0: h
  const Config* a;                    // accelerations [m/s^2]
  const Config* v = nullptr;          // velocities, for mass-proportional damping
  double mass_slope = 0;              // d a / d end [1/s^2]
  const double* tempo = nullptr;      // step over the one by its own clock, of each body; null: 1
  double alpha_slope = 0;             // d v / d end [1/s]
  double chi = 0;                     // stress dissipation on flexible parts
  double t0 = 0, t1 = 0;              // loads: mean over [t0, t1], or value at t0 = t1
  double t_end = 0;                   // time of `end`: driven joints
  const Config* work_from = nullptr;  // start of the step for System::work; null: e0
  const Config* v0 = nullptr;         // start velocities, where v1 = v0 + h a: there inertia works through h (v0 + v1)/2
  bool rates_alone = false;           // how accelerations, rates and rows of velocities act on the equations of another stage
  double load_factor = 1;             // of gravity and of loads without a history, for static load steps
  /// Derivatives of w0 and w1 by `end`.
  double slope0() const {
    const double x = slope - h * alpha_slope / 2;
    return x > 1e-12 || x < -1e-12 ? x : 0;  // w0 is the start of the step
  }
  double slope1() const { return slope + h * alpha_slope / 2; }
  bool conserving() const { return weight == 0.5 && e0 != e1; }
};

/// A stage that takes everything at one configuration: statics, and methods that enforce the equations of motion at an instant.
inline Stage stage_at(const Config& q, double t) {
  Stage s{};
  s.end = s.left = s.e0 = s.e1 = s.w0 = s.w1 = &q;
  s.slope = s.weight = s.chain = 1;
  s.t0 = s.t1 = s.t_end = t;
  return s;
}

/// Elastic response of a spring at a stage, D by its measures at e1.
void spring_elastic(const Connector& c, const Stage& s, Response& out);

/// Smallest det F of a cell, and the region it is in, or -1.
struct LeastDet {
  double det = 1e300;
  int region = -1;
  void take(const LeastDet& other) {
    if (!(other.det > det)) *this = other;  // keeps a NaN
  }
};

/// Residual with the scales that judge it.
struct Residual {
  std::vector<double> r;     // (3 x n_blocks): equations, then constraint rows
  double force_scale = 0;    // largest force summed into r [N]
  LeastDet least_det;
  double sigma = 1;          // scale of the constraint rows; multipliers are found divided by it
  bool finite = true;
};

struct NodeMap;

class System {
 public:
  std::vector<Body> bodies;   // body 0 is the ground
  std::vector<int> follower;  // body each node follows, or -1  (n_nodes)
  std::vector<Vec3> X;        // reference positions            (n_nodes)  [m]
  std::vector<char> node_owned;
  std::vector<std::array<bool, 3>> fixed;  // prescribed components of nodes
  std::vector<SolidBatch> batches;         // of the cells of this rank
  bool flexible = false;                   // some rank has cells
  std::vector<Connector> joints, springs;
  std::vector<Load> loads;
  std::vector<Motion> motions;
  std::vector<UsedHistory> histories;  // all of them
  std::vector<Station> stations;
  std::vector<std::vector<int>> region_nodes;        // free nodes of each region, for the predictor
  std::vector<std::pair<int, double>> point_masses;  // node, mass [kg], owned nodes
  Vec3 gravity = Vec3::Zero();
  double length = 1;     // size of the scene [m]
  double mass = 0;       // of everything [kg]
  double stiffness = 1;  // a typical one, for scaling without inertia [N/m]
  double same_time = 0;  // instants closer than this are one [s]
  Config start, start_velocity;
  const Comm* comm = nullptr;
  LocalMesh* mesh = nullptr;  // null for a scene of bodies alone

  // unknowns
  std::vector<int> node_block;   // block of each node, -1 for followers
  std::vector<int> body_block;   // first of two blocks, -1 for driven bodies
  std::vector<int> joint_block;  // first block of its multipliers
  BlockMap map;
  Cliques cliques;
  int n_blocks() const { return static_cast<int>(map.global.size()); }

  /// Number the unknowns and list the cliques; call once after everything is filled in.
  void number();
  /// Residual, and tangent into `K` when given.  lambda: (3 x joint blocks), indexed by block - first joint block.
  void evaluate(const Stage& stage, std::span<const double> lambda, Residual& out, KktSolver* K) const;
  void mask_fixed(std::span<double> r) const;
  /// q <- q moved by the increments z (3 x n_blocks); bodies turn by the Cayley rotation of theirs.
  void move(Config& q, std::span<const double> z) const;
  /// Followers from their bodies; the map is linear, so it holds for positions, velocities and accelerations alike.
  void follow(Config& q) const;
  /// Positions of what moves by a law at time t: driven bodies and components of nodes.
  void prescribe(Config& q, double t, double ramp = 1) const;
  /// Largest |g| of the joint rows that are kept and of those dropped as redundant [m, 1], with their joints, or -1.
  struct Violation {
    double kept = 0, dropped = 0;
    int kept_joint = -1, dropped_joint = -1;
    double worst() const { return std::max(kept, dropped); }
  };
  Violation violation(const Config& q, double t, double factor = 1) const;
  /// Largest angle by which a body or a cell turns from q0 to q1, and which, the same on all ranks.
  struct Turn {
    double angle = 0;  // [rad]
    int body = -1, region = -1;
  };
  Turn largest_turn(const Config& q0, const Config& q1) const;
  /// "body \"b\"" or "a cell of region \"r\"".
  std::string name(const Turn& turn) const;
  /// 'a cell of region "r" is [all but] turned inside out (det F = -0.1)'.
  std::string inside_out(const LeastDet& least) const;
  /// Their velocities and accelerations (either may be null), the limits from one side.
  void prescribe_rates(double t, Side side, Config* v, Config* a) const;
  /// What moves by a law in `to` becomes that of `from`.
  void copy_prescribed(const Config& from, Config& to) const;
  /// Why a step from t0 to t1 is too long for a law, or nothing: a body that turns by more than a quarter of a turn in it has no mean.
  std::string too_far(double t0, double t1) const;
  bool moves() const { return moves_; }  // whether anything moves by a law of its own
  /// A time on the given side of t, by which the laws are asked.
  double beside(double t, Side side) const { return t + static_cast<int>(side) * same_time; }
  /// First and, where asked for, second derivatives by time of all joint rows less their courses, laid out like lambda.
  void row_rates(const Config& q, const Config& v, const Config* a, double t, std::vector<double>& rate,
                 std::vector<double>* acceleration) const;
  int first_joint_block() const { return joint_block.empty() ? n_blocks() : joint_block.front(); }
  int n_joint_blocks() const { return n_blocks() - first_joint_block(); }
  bool has_damping() const;

  struct Energy {
    double kinetic = 0, elastic = 0, gravity = 0;
    Vec3 momentum = Vec3::Zero(), angular = Vec3::Zero();
  };
  Energy energy(const Config& q, const Config& v) const;
  /// Work of the loads and of prescribed motions, and dissipation of rate terms, over the step of `stage` (from q0 to q1).
  struct Work {
    double external = 0, dissipated = 0;
  };
  Work work(const Stage& stage, std::span<const double> lambda) const;
  /// Residual forces before reduction, for reactions: per node, and per body (force, moment about its centre).
  struct Forces {
    std::vector<Vec3> node;
    std::vector<Vec6> body;
  };
  void forces(const Stage& stage, std::span<const double> lambda, Forces& out) const;
  /// Force and moment on what a motion holds.
  Vec6 reaction(const Motion& m, const Forces& f, const Config& q) const;
  /// Motions of parts as rigid bodies that neither stiffness nor joints nor prescribed motions resist at a static stage.
  struct Loose {
    std::string text;                           // 'region "bar" is free to turn about ...', or nothing
    std::vector<std::vector<double>> straight;  // increments of those in which nothing turns
  };
  Loose loose(const Stage& stage, bool with_loads) const;
  /// Why a joint cannot be at q ("joint ... ran off the end of its curve"), or nothing; the same on all ranks.
  std::string fault(const Config& q) const;
  /// Accept q, with velocities v, as the state springs and joints go on from.
  void commit(const Config& q, const Config* v = nullptr);
  /// What the rate forces of a spring may ask of a stage; `slope`, when given, receives d load / d multiplier for its load rows.
  Interval interval(const Connector& spring, const Stage& s, std::span<const double> lambda, double* slope = nullptr) const;

 private:
  struct Pass;
  /// Lowest value of each node over the ranks that share it.
  void lowest_over_ranks(std::vector<std::int64_t>& value) const;
  /// Cluster of each free node, numbered over all ranks, the highest integer for a node of no cell; how many there are.
  int clusters(std::vector<std::int64_t>& cluster_of) const;
  void number_globally(int n_node_blocks, int n_local);
  double constraint_scale(const Stage& s) const;
  double motion_work(const Stage& s, std::span<const double> lambda, const Config& from) const;
  void add_solids(Pass& p) const;
  void add_bodies(Pass& p) const;
  void add_connectors(Pass& p) const;
  void add_loads(Pass& p) const;
  void reduce(Pass& p) const;
  void make_maps(std::span<const int> nodes, std::span<const int> blocks, const Stage& s, std::vector<NodeMap>& maps,
                 std::vector<std::array<bool, 3>>& masks) const;
  double solid_dissipation(const Stage& s) const;
  int body_clique(int body) const { return body_clique_[body]; }
  std::vector<int> body_clique_, joint_clique_, spring_clique_;
  std::vector<char> owns_joint_, owns_spring_;
  void watch_strain(const Config& q);
  std::vector<char> strain_told_;  // by region: its compression has been told
  bool moves_ = false;
};

/// Gradient of a joint's rows by its measures as the stage takes it: over the step where it conserves energy, else at `left`.
void row_gradient(const Connector& c, const Stage& s, const ConnectorGradient& left, RowLaw::Gradient& out);
/// Forces conjugate to the measures of a joint for the multipliers of its rows.
void joint_forces(const Connector& c, const Stage& s, const ConnectorGradient& left, const double* lambda, double* force);

/// Build the system of a scene.  Errors carry the scene's places.
std::unique_ptr<System> build_system(const Scene& scene, LocalMesh* mesh, const Comm& comm);

}  // namespace hilo
