// Free directions of joints, for what acts along them: stops, motors, friction.
#pragma once
#include <optional>
#include <string_view>

#include "physics/coordinates.hpp"

namespace hilo {

/// A motion of b relative to a that a joint leaves free: a displacement along its axis [m], or an angle about it [rad]; both are zero at
/// the start and positive along the axis.
enum class Freedom { slide, angle };

/// Free directions of a kind of joint, the usual one first; empty where none is a single coordinate.
std::vector<Freedom> freedoms(std::string_view joint_kind);

/// `law` along a free direction of a joint, which stands as in q.
Connector along_joint(const Connector& joint, const Config& q, Freedom freedom, std::unique_ptr<SpringLaw> law);

/// Whether friction_in knows the kind.
bool has_friction(std::string_view joint_kind);
/// Friction in a revolute, cylindrical, prismatic, screw or spherical joint at the radius of its surfaces; Connector::load_rows says which
/// of the joint's multipliers press them together.
Connector friction_in(const Connector& joint, const Config& q, double coefficient, double radius, double preload, double slip_velocity);

}  // namespace hilo
