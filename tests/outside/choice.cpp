// SPDX-License-Identifier: GPL-3.0-or-later
// A contribution that chooses by the answer of a step and searches nothing: buffers, each a spring along x that holds a body back where it
// ends a step beyond a gap.  What does not ask it again is refused by name.
#include <Eigen/Core>

#include "base/keys.hpp"
#include "outside.hpp"
#include "system/contribution.hpp"
#include "system/revising.hpp"

namespace outside {
namespace {

using namespace hilo;

class Buffer final : public Contribution, public Equations, public Revising {
 public:
  Buffer(const System& system, const Entry& entry) : points_(system), gap_(entry.number("gap")), stiffness_(entry.number("stiffness")) {
    for (size_t b = 0; b < system.bodies.size(); ++b)
      if (system.bodies[b].name == entry.text("on")) body_ = static_cast<int>(b);
  }
  void number(Layout& layout) override { clique_ = layout.cliques.add(std::vector<int>{points_.body_block[body_]}); }
  bool revise(const Stage& s) override {
    const bool before = closed_;
    closed_ = s.e1->c[body_][0] > gap_;
    return closed_ != before;
  }
  void evaluate(Pass& p) const override {
    if (p.s.rates_alone || !closed_ || !points_.counts(body_)) return;
    const double w = p.s.conserving() ? 0.5 : 1;
    const double force = stiffness_ * ((1 - w) * p.s.e0->c[body_][0] + w * p.s.e1->c[body_][0] - gap_);
    p.body[body_][0] += force;
    p.scale(std::abs(force));
    Eigen::Matrix3d K = Eigen::Matrix3d::Zero();
    K(0, 0) = w * stiffness_;
    if (p.K) p.K->add(clique_, K.data());
  }
  void tie(Ties& ties) const override { ties.exclude(body_); }

 private:
  const Points& points_;
  int body_ = 0, clique_ = -1;
  double gap_, stiffness_;
  bool closed_ = false;
};

std::string scene(const std::string& time) {
  return pushed_cart(200) + R"([[buffer]]
name = "end"
on = "cart"
gap = 1
stiffness = 300
[time]
)" + time;
}

}  // namespace

void add_buffer() {
  using enum Type;
  add_contribution({"buffer",
                    "springs along x that hold a body back beyond a gap",
                    {keys::name,
                     {"on", text, "", "!", "body"},
                     {"gap", number, "m", "!", "where it begins"},
                     {"stiffness", number, "N/m", "!", "of the spring", above(0)}}},
                   [](const Scene& scene, System& system) {
                     for (const Entry& entry : scene.entries("buffer")) system.add<Buffer>(system, entry);
                   });
}

// Truth: 100 x + 300 (x - 1) = 200.
TEST(OutsideChoice, IsAskedAgainThoughNothingSearches) {
  const test::Workplace place;
  const auto r = run_scene(place, scene("analysis = \"static\"\nsteps = 2\n"));
  EXPECT_NEAR(r.history("probe/cart").bottomRows(1)(0, 0), 1.25, 1e-9);
}

TEST(OutsideChoice, IsAskedAgainAlongAPath) {
  const test::Workplace place;
  const auto r = run_scene(place, scene("analysis = \"path\"\nsteps = 4\n"));
  const Eigen::VectorXd x = r.history("probe/cart").col(0), share = r.history("path").col(0);
  for (Eigen::Index k = 0; k < x.rows(); ++k) EXPECT_NEAR(100 * x[k] + 300 * std::max(0., x[k] - 1), 200 * share[k], 1e-7) << k;
  EXPECT_NEAR(x[x.rows() - 1], 1.25, 1e-9);
}

TEST(OutsideChoice, IsRefusedByWhatNeverAsks) {
  const test::Workplace place;
  const auto refusal = [&](const std::string& time) {
    try {
      run_scene(place, scene(time));
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string("none");
  };
  for (const std::string method : {"radau", "gauss"}) {
    const std::string told = refusal("end = 0.1\nstep = 0.01\nintegrator = \"" + method + "\"\n");
    EXPECT_NE(told.find(method + " does not choose again what meets"), std::string::npos) << told;
  }
  EXPECT_EQ(refusal("end = 0.1\nstep = 0.01\n"), "none");
}

}  // namespace outside
