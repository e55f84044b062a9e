// SPDX-License-Identifier: GPL-3.0-or-later
// Constraint rows one by one: what chooses, drives, shares out and watches them sees a list of these (System::constraints), whatever brings
// the rows: a joint, or a later contact.
#pragma once
#include "physics/joint.hpp"
#include "system/points.hpp"

namespace hilo {

using DenseRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, max_rows, max_directions>;

/// The rows of one thing: first those of positions, then those of velocities.
class Constraint {
 public:
  virtual ~Constraint() = default;
  virtual std::string_view section() const = 0;  // of its entry in the scene: "joint"
  virtual const std::string& name() const = 0;
  std::string label() const { return std::string(section()) + " \"" + name() + "\""; }
  virtual int n_rows() const = 0;
  virtual int n_position_rows() const = 0;
  /// Where its multipliers begin in lambda, and how many numbers they take there, padding included.
  virtual int row() const = 0;
  int n_padded() const { return 3 * ((n_rows() + 2) / 3); }
  virtual const Active& active() const = 0;
  virtual void set_active(const Active& rows) = 0;
  /// The row that is held to a law, or null.
  virtual const Drive* drive() const { return nullptr; }
  bool is_driven(int r) const { return drive() && drive()->row == r; }
  /// The unknown blocks that the rows act on.
  virtual std::vector<int> blocks() const = 0;
  /// The rows over these blocks (n_rows x 3 n_blocks), unknowns that turn in units of the scene's length.
  virtual DenseRows gradient(const Stage& stage) const = 0;
  /// Values of the rows less what drives them, 0 for rows of velocities.
  virtual void gaps(const Config& q, double t, double factor, double* g) const = 0;
  /// Whether values at any instant can be asked for, whatever went before (no angle has to be unwrapped).
  virtual bool has_no_past() const = 0;
  /// A motion of the scene that moves one of its ends, or "".
  virtual std::string moved_by() const { return {}; }
};

}  // namespace hilo
