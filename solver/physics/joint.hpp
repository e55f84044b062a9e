// SPDX-License-Identifier: GPL-3.0-or-later
// Joints: rows that hold the measures of a connector, or functions of them, or velocities.
#pragma once
#include <array>
#include <memory>
#include <string_view>

#include "base/entry_values.hpp"
#include "base/param.hpp"
#include "base/registry.hpp"
#include "physics/curve.hpp"
#include "physics/motion_law.hpp"
#include "physics/row_law.hpp"

namespace hilo {

class VelocityRows;
struct JointKind;

/// Which rows of a constraint are on.
using Active = std::array<bool, max_rows>;
inline constexpr Active all_active{true, true, true, true, true, true};

struct Joint : Connector {
  Joint();
  Joint(Joint&&) noexcept;
  Joint& operator=(Joint&&) noexcept;
  ~Joint();
  const JointKind* kind = nullptr;
  std::unique_ptr<RowLaw> rows;                 // null: the rows are the measures
  std::unique_ptr<VelocityRows> velocity_rows;  // rows of velocities, which follow the others (rolling.hpp); or none
  Drive drive;
  Active active = all_active;  // rows kept by the redundancy check

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
  std::vector<double> own{};                                       // what else a kind reads from its entry
  bool gives_way = false;                                          // on springs: rows are lengths and angles, however large
};
/// The joint with its ends at rest in `q`; Error for a kind that there is none of.
Joint make_joint(const JointPlace& place, const Config& q);

/// A motion of b relative to a that a joint leaves free: a displacement along its axis [m], or an angle about it [rad]; both are zero at
/// the start and positive along the axis.
enum class Freedom { slide, angle };

/// A kind of joint: a row of the table in joint_kinds.cpp.
struct JointKind {
  std::string_view name, meaning;
  std::vector<Param> keys;  // of the scene, besides kind, name and the two ends
  Joint (*make)(const JointPlace& place, const Config& q);
  std::string_view holds;         // by its rows in their order: slides x y z and turns A B C about them; "": it cannot give way
  std::vector<Freedom> freedoms;  // free directions that are single coordinates, the usual one first
  std::vector<int> pressing;      // rows whose multipliers press surfaces together; none: it has no friction
  enum class Turns { both, first, none } turns = Turns::both;  // ends that must be able to turn; a node may carry the others
  /// Its own keys to the place, of which ends, point and frame are known.
  void (*read)(const EntryValues& entry, JointPlace& place) = nullptr;
  void (*soften)(Joint& joint,
                 std::vector<double>& free) = nullptr;  // what its rows need besides to become springs, with their free lengths
  bool follows_curve = false;                           // needs JointPlace::curve
  bool frees(Freedom f) const;
};
Registry<JointKind>& joint_kinds();

/// Keys of a joint with a point and, where asked for, an axis, and further ones of its own.
std::vector<Param> joint_keys(bool with_axis, std::initializer_list<Param> own = {});
/// Keys that make such a joint give way, put behind: of all rows, or of one row along a line.
std::vector<Param> giving_way(std::vector<Param> keys);
std::vector<Param> giving_way_along(std::vector<Param> keys);

}  // namespace hilo
