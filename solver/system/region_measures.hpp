// SPDX-License-Identifier: GPL-3.0-or-later
// How far linear regions are from what their strains are good for, during a run:
//
//   quadratic strain   strains of the second degree that nothing can take back: with f their force on the softest shapes, K the stiffness
//                      of these, C what supports let them give way by, the strain energy f.(K^-1 - C) f/2.  A beam that bends between ends
//                      that cannot come nearer is stretched by it; one whose ends can, shortens without strain
//   buckling           the largest u at which K u + K_sigma is singular on what the supports leave free, K_sigma of the stress of that
//                      instant: the load over that at which the region buckles.  Deflections grow by 1/(1 - u); by 1/(1 - u_axes) they do
//                      in the run too, whose mean axes turn under their loads: u_axes is u without K_sigma among the shapes
//   load band          the frequency of what the modes left out answer to, over that of the first of them: beyond one half what
//                      /history/left_out tells is too little
//
//   tension            how many times as far linear strains bend: (1 + p)/(1 + p_axes), p as u of the opposite stress
//   shortening         what bends comes shorter by C f, quadratic in s, and what hangs on it is pulled along: the acceleration of that,
//                      2 sqrt(3) times its root mean square over the region (of one that shortens evenly, that of end to end), over the
//                      largest acceleration less gravity of the region.  After an impact small bends do this, by the square of their
//                      frequency
//   stress over yield  von Mises stress of a metal, which does not flow here, over its yield stress (system/stress_over_yield.hpp)
//
// They take part in no equation.
#pragma once
#include <array>
#include <optional>

#include "system/linear_regions.hpp"
#include "system/region_support.hpp"
#include "system/stress_over_yield.hpp"

namespace hilo {

class RegionMeasures final : public Contribution, public Observer {
 public:
  /// Of modes and of buckling it sees shapes, whose size says nothing.
  RegionMeasures(const System& system, const std::string& analysis)
      : system_(system), of_modes_(analysis == "modes"), of_shapes_(of_modes_ || analysis == "buckling") {}

  void archive(Archive& a) override;
  std::vector<Output> outputs() const override;
  void observe(const Sight& at) override;
  void add_to_report(Json& run) const override;

  /// The largest so far, and when.
  struct Peak {
    double value = 0, t = 0;
    void look(double x, double at) {
      if (x > value) value = x, t = at;
    }
  };

 private:
  struct Region {
    // of the supports of `pose`
    std::vector<double> pose;               // of the bodies, in the axes of the region
    Eigen::MatrixXd stress, axes;           // K_sigma of each mode on the softest motions, and without what is among the shapes (n n x m)
    Eigen::MatrixXd held;                   // K^-1 - C   (S x S)
    Eigen::MatrixXd second_order;           // of the softest shapes alone (S x pairs)
    Eigen::MatrixXd compliance;             // C   (S x S)
    std::vector<double> rate;               // df/dt at the end of the last step (S) [J s^-1 m^-1 kg^-0.5], which ended at
    double t = 0;                           // [s]
    Peak energy, quadratic, share, growth;  // of strain, of quadratic strain [J]; load over buckling load; (1 - u_axes)/(1 - u)
    Peak tension;                           // (1 + p)/(1 + p_axes)
    Peak shortening, inertia;               // accelerations [m/s^2]
    Peak over_yield;                        // von Mises stress over yield stress
    auto peaks() { return std::array{&energy, &quadratic, &share, &growth, &tension, &shortening, &inertia, &over_yield}; }
  };
  Region& region(size_t k, const Config& q);
  static double shortening(Region& at, double t, const Eigen::VectorXd& s, const Eigen::VectorXd& speed);
  void look_at_stress(const Sight& seen);
  const System& system_;
  const bool of_modes_, of_shapes_;
  std::vector<Region> regions_;
  std::optional<StressOverYield> stress_;
};

}  // namespace hilo
