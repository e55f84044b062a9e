// SPDX-License-Identifier: GPL-3.0-or-later
// Springs, dampers, stops, motors, friction and joints that give way: forces of connectors, without rows.
#pragma once
#include "physics/spring.hpp"
#include "system/contact/surface_pair.hpp"
#include "system/joints.hpp"

namespace hilo {

class Springs final : public Contribution, public Equations, public Stateful, public Observer, public Clocked {
 public:
  Springs(const Points& points, const Joints& joints) : points_(points), joints_(joints) {}
  std::vector<Spring> list;

  Traits traits() const override;
  std::string count() const override;
  void number(Layout& layout) override;
  void evaluate(Pass& p) const override;
  void add_energy(const Config& q, const Config& v, Energy& sum) const override;
  void add_work(const Moment& m, Work& sum) const override;
  void advance(const Stage& stage) override;
  void settle(bool accepted) override;
  void commit(const Config& q, const Config* v) override;
  void archive(Archive& a) override;
  std::vector<Output> outputs() const override;
  void observe(const Sight& at) override;
  void add_to_report(Json& run) const override;
  void tie(Ties& ties) const override;
  void add_timed(std::span<const int> group, double t, double T, std::span<double> sum) const override;
  /// `takes_most` (system/brake.hpp).
  std::pair<std::string, std::string> takes_most(const Stage& s, std::span<const double> lambda) const;
  void add_taken(std::span<const int> group, const Stage& s, std::span<const double> lambda, std::span<double> sum) const override;

 private:
  /// What the rate forces of a spring may ask of a stage; `slope`, when given, receives d load / d multiplier for its load rows.
  Interval interval(const Spring& c, const Stage& s, std::span<const double> lambda, double* slope = nullptr) const;
  /// Rate forces of a stage, added to `out`.
  void viscous(const Spring& c, const Stage& s, std::span<const double> lambda, Response& out) const;
  const Points& points_;
  const Joints& joints_;
  std::vector<int> clique_;
  std::vector<char> owned_;
  std::vector<char> told_;                           // of what a law has passed
  std::vector<ContactSums> impacts_;                 // of stops that keep a part of the speed
  std::vector<std::pair<int, std::string>> passed_;  // by the step that is tried: springs, and what to tell
};

/// The measures between which rate forces act: those at w0 and w1 over a step that keeps energy; at an instant, as far on both sides of it
/// as its exact rates go.
std::array<SpringLaw::Values, 2> rate_pair(const Spring& c, const Stage& s);
/// Elastic response of a spring at a stage, D by its measures at e1.
void spring_elastic(const Spring& c, const Stage& s, Response& out);

/// Whether the forces of all springs and dampers are without kinks.
bool springs_are_smooth(const System& system);
/// Joints whose friction is pressed by rows at one of these places in lambda, rising.
std::vector<std::string> pressed_by(const System& system, std::span<const int> places);
/// Whether there are springs or compliant joints, on which bodies may vibrate.
bool is_sprung(const System& system);

}  // namespace hilo
