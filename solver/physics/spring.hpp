// SPDX-License-Identifier: GPL-3.0-or-later
// Force elements: a law along the measures of a connector.
#pragma once
#include <optional>

#include "base/history.hpp"
#include "physics/coordinates.hpp"
#include "physics/joint.hpp"

namespace hilo {

struct Spring : Connector {
  std::unique_ptr<SpringLaw> law;
  std::string group = "spring";                                  // of the results: the section of the scene
  double stiffness = 0;                                          // a typical one, for scaling without inertia [N/m]
  enum class Axes { inertial, of_joint } axes = Axes::inertial;  // of the force that the results show
  const JointKind* gives_way = nullptr;                          // the kind of joint that it stands for; null: none
  std::optional<History> history;                                // Interval::factor, its mean over a step; 1 without
  struct Pressing {
    int joint = -1;  // whose multipliers of `rows` make up Interval::load; -1: none
    std::vector<int> rows;
  } pressing;
};

/// Along the distance of two points.
struct AxialSpring {
  Carrier a, b;
  Vec3 at_a, at_b;
  double stiffness = 0, damping = 0;  // [N/m, N s/m]
  double length = 0;                  // without force [m]
};
Spring make_axial_spring(const AxialSpring& s, const Config& q);

/// About the third column of the frame.
struct TorsionSpring {
  Carrier a, b;
  Mat3 frame;
  double stiffness = 0, damping = 0;  // [N m/rad, N m s/rad]
  double angle = 0;                   // without torque [rad]
};
Spring make_torsion_spring(const TorsionSpring& s, const Config& q);

/// Stiffness and damping along and about three axes.
struct Stiffness {
  Vec3 along = Vec3::Zero(), damping = Vec3::Zero();          // [N/m, N s/m]
  Vec3 about = Vec3::Zero(), angular_damping = Vec3::Zero();  // [N m/rad, N m s/rad]
};
/// The columns of its frame are the axes.  Stiff about three of them it measures the rotation vector; about one or two, the tilt of one
/// axis and the twist about it, over any number of turns; where it only damps, the angular velocity.
struct Bushing {
  Carrier a, b;
  Vec3 at;
  Mat3 frame;
  Stiffness stiffness;
};
Spring make_bushing(const Bushing& s, const Config& q);

/// A stop of the distance of two points.
struct DistanceStop {
  Carrier a, b;
  Vec3 at_a, at_b;
  StopLaw stop;
};
Spring make_distance_stop(const DistanceStop& s, const Config& q);
/// Any law along the distance of two points.
Spring along_distance(const Carrier& a, const Carrier& b, const Vec3& at_a, const Vec3& at_b, const Config& q,
                      std::unique_ptr<SpringLaw> law);

/// Unilateral: with a damper, or with a restitution below 1.  The gap opens along the third column of the frame.
struct Support {
  Carrier a, b;
  Vec3 at;
  Mat3 frame;
  double stiffness = 0, damping = 0, restitution = 1, rest_speed = 0, clearance = 0;
  Vec3 tangential_stiffness = Vec3::Zero(), tangential_damping = Vec3::Zero();
};
Spring make_support(const Support& s, const Config& q);

/// A joint whose rows give way along and about the columns of its frame, by angles: what it holds of all three is the rotation vector, of
/// two the tilt of its axis, of one an angle.  It keeps its kind, ends, point and frame, so forces have the axes and the sign of the
/// joint's reactions.
Spring make_compliant(JointPlace place, const Stiffness& stiffness, const Config& q);
/// The key that leaves a row of the joint without a spring, or nothing.
std::string missing_stiffness(const JointKind& kind, const Stiffness& stiffness);

/// `law` along a free direction of a joint (of its geometry), which stands as in q.
Spring along_joint(const Connector& joint, const Config& q, Freedom freedom, std::unique_ptr<SpringLaw> law);

/// The free directions of a joint as measures, zero as it stands in q: the slide where it has one [m], then sine and cosine of the angle.
Connector coordinates_of(const Connector& joint, const JointKind& kind, const Config& q);

/// Friction in a joint at the radius of its surfaces; Spring::pressing says which of the joint's multipliers press them together.
struct FrictionIn {
  double coefficient = 0, radius = 0;
  double preload = 0;        // [N]
  double slip_velocity = 0;  // [m/s]
};
Spring friction_in(const Connector& joint, const JointKind& kind, const Config& q, const FrictionIn& friction);

}  // namespace hilo
