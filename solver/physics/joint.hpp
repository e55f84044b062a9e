// Joints: rows that hold the measures of a connector, or functions of them, or velocities.
#pragma once
#include <array>
#include <memory>
#include <string_view>

#include "physics/curve.hpp"
#include "physics/motion_law.hpp"
#include "physics/row_law.hpp"

namespace hilo {

/// A row that is held to a law: g = law(t).
struct Drive {
  int row = -1;
  MotionLaw law;
  const char* unit = "";  // of its rate
};

class VelocityRows;
struct JointKind;

struct Joint : Connector {
  Joint();
  Joint(Joint&&) noexcept;
  Joint& operator=(Joint&&) noexcept;
  ~Joint();
  const JointKind* kind = nullptr;
  std::unique_ptr<RowLaw> rows;                 // null: the rows are the measures
  std::unique_ptr<VelocityRows> velocity_rows;  // rows of velocities, which follow the others (rolling.hpp); or none
  Drive drive;
  std::array<bool, max_rows> active{true, true, true, true, true, true};  // rows kept by the redundancy check

  int n_position_rows() const { return rows ? rows->n_rows() : static_cast<int>(measures.size()); }
  int n_rows() const;
  /// Rows from the values of the measures, 0 for velocity rows; what a drive wants is not yet taken off.
  void row_values(const std::array<double, max_measures>& e, double* g) const;
};

/// Where a joint is, what it joins, and what its kind needs besides.
struct JointPlace {
  std::string kind;
  Carrier a, b, carrier{0, -1};          // the carrier of a gear or rack
  Vec3 at, at_b;                         // joint point on a and on b; they differ for the distance joint only [m]
  Mat3 frame = Mat3::Identity();         // third column the axis
  Vec3 axis_b = Vec3::Zero();            // axis of b: gear, constant-velocity; direction of a rack; zero: the axis
  double ratio = 1;                      // turns of b per turn of a; [m/rad] of a rack or screw
  double length = 0;                     // of a distance joint, 0: as placed [m]
  std::shared_ptr<const Curve> curve{};  // of point-on-curve: points in inertial axes from `at`
  enum class Driven { none, angle, slide } driven = Driven::none;  // a row held to a course: angle or slide of b along the axis
};
/// The joint with its ends at rest in `q`; a kind that there is none of is an Error.
Joint make_joint(const JointPlace& place, const Config& q);

/// A motion of b relative to a that a joint leaves free: a displacement along its axis [m], or an angle about it [rad]; both are zero at
/// the start and positive along the axis.
enum class Freedom { slide, angle };

/// A kind of joint: a row of the table in joint_kinds.cpp.
struct JointKind {
  std::string_view name;
  Joint (*make)(const JointPlace& place, const Config& q);
  std::string_view holds;         // by its rows in their order: slides x y z and turns A B C about them; "": it cannot give way
  std::vector<Freedom> freedoms;  // free directions that are single coordinates, the usual one first
  std::vector<int> pressing;      // rows whose multipliers press surfaces together; none: it has no friction
  void (*soften)(Joint& joint,
                 std::vector<double>& free) = nullptr;  // what its rows need besides to become springs, with their free lengths
  bool frees(Freedom f) const;
};
const std::vector<JointKind>& joint_kinds();
/// Error, with the kinds that there are, where there is none of this name.
const JointKind& joint_kind(std::string_view name);

}  // namespace hilo
