// The rows of a joint over the unknowns they act on.
#pragma once
#include "system/system.hpp"

namespace hilo {

using DenseRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, 6, max_directions>;

/// The unknown blocks that a joint's rows act on: of bodies two, displacement and rotation; of nodes one.
std::vector<int> joint_blocks(const System& s, const Connector& joint);
/// A joint's rows over its blocks (n_rows x 3 n_blocks), rotations in units of the scene's length.
DenseRows joint_rows(const System& s, const Joint& c, const Stage& stage);

}  // namespace hilo
