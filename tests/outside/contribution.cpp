// SPDX-License-Identifier: GPL-3.0-or-later
// A contribution whose pairs and rows change from step to step: balls that meet each other and pegs that stand in space.  Entries of a
// section of its own, [[balls]], and one call of add_contribution().
//
// The gap of two balls is |x_b - x_a| - (r_a + r_b), V = k/2 gap^2 where it is negative.  As a function of e = |x_b - x_a|^2/2, of degree
// two, V has the discrete gradient (V1 - V0)/(e1 - e0) (x_b - x_a)_mid, so that a step keeps energy and momentum at any length.  Where
// `rows` are asked for, each pair has a multiplier that is this quotient: a row lambda = (V1 - V0)/(e1 - e0) that is there while the pair
// is near.
#include "system/contribution.hpp"

#include <Eigen/Core>

#include "base/keys.hpp"
#include "dynamics/kept_run.hpp"
#include "outside.hpp"
#include "ranks.hpp"

namespace outside {
namespace {

using namespace hilo;

class Balls final : public Contribution, public Equations, public Constraining, public Stateful, public Observer {
 public:
  Balls(const System& system, const Entry& entry)
      : points_(system),
        radius_(entry.number("radius")),
        stiffness_(entry.number("stiffness")),
        margin_(entry.number("margin")),
        rows_(entry.boolean("rows")) {
    for (const std::string& name : entry.texts("on")) {
      const auto found = std::find_if(system.bodies.begin(), system.bodies.end(), [&](const Body& b) { return b.name == name; });
      if (found == system.bodies.end()) throw Error(entry.where("on"), "no body \"" + name + "\"");
      balls_.push_back({static_cast<int>(found - system.bodies.begin()), Vec3::Zero()});
    }
    const std::vector<double> pegs = entry.numbers("pegs");
    for (size_t k = 0; k + 2 < pegs.size(); k += 3) balls_.push_back({-1, Vec3(pegs[k], pegs[k + 1], pegs[k + 2])});
  }

  Traits traits() const override { return {.constrains = rows_, .searches = true}; }

  void number(Layout& layout) override {
    block_.clear(), clique_.clear();
    for (const Pair& pair : near_) {
      std::vector<int> blocks{block_of(pair.a), block_of(pair.b)};
      if (rows_) block_.push_back(layout.add_rows(pair.a * static_cast<int>(balls_.size()) + pair.b, 1)), blocks.push_back(block_.back());
      clique_.push_back(layout.cliques.add(blocks));
    }
  }

  /// Pairs that are near enough to meet within the step, until one is missing.
  bool search(const Config& q, const Config* v, double h) override {
    std::vector<Pair> now, late;
    for (int a = 0; a < static_cast<int>(balls_.size()); ++a)
      for (int b = a + 1; b < static_cast<int>(balls_.size()) && balls_[a].body >= 0; ++b) {
        const double fast = v ? ((balls_[b].body >= 0 ? v->c[balls_[b].body] : Vec3::Zero()) - v->c[balls_[a].body]).norm() : 0;
        const double gap = between(q, {a, b}).norm() - 2 * radius_ - h * fast;
        if (gap < margin_) now.push_back({a, b});
        if (gap < margin_ / 2) late.push_back({a, b});
      }
    if (std::includes(near_.begin(), near_.end(), late.begin(), late.end()) && near_.size() <= 2 * now.size()) return false;
    near_ = std::move(now), ++layouts_;
    return true;
  }

  /// A pair that nobody looked at has met.
  std::string fault(const Config& q) const override {
    for (int a = 0; a < static_cast<int>(balls_.size()); ++a)
      for (int b = a + 1; b < static_cast<int>(balls_.size()) && balls_[a].body >= 0; ++b)
        if (between(q, {a, b}).norm() < 2 * radius_ && !std::binary_search(near_.begin(), near_.end(), Pair{a, b}))
          return fmt::format("balls {} and {} met unforeseen", a, b);
    return "";
  }

  void evaluate(Pass& p) const override {
    const Stage& s = p.s;
    if (s.rates_alone) return;
    for (size_t k = 0; k < near_.size(); ++k) {
      if (!points_.counts(static_cast<int>(k))) continue;
      const Vec3 left = between(*s.left, near_[k]);
      const double e0 = half_square(*s.e0, near_[k]), e1 = half_square(*s.e1, near_[k]), w = s.weight;
      const Quotient law = s.conserving() ? quotient(e0, e1) : Quotient{slope((1 - w) * e0 + w * e1), w * curvature((1 - w) * e0 + w * e1)};
      const double unit = radius_ / stiffness_;
      const int row = rows_ ? 3 * (block_[k] - points_.first_joint_block()) : -1;
      const double force = rows_ ? p.lambda[row] : law.value;
      add_force(p, near_[k], force * left);
      if (rows_) p.out.r[3 * block_[k]] = p.sigma * unit * (law.value - force);
      if (!p.K) continue;
      const int n = rows_ ? 9 : 6;
      Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
      const Eigen::RowVector3d by_end = s.chain * law.by_e1 * between(*s.e1, near_[k]).transpose();
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) {
          const double sign = i == j ? 1 : -1;
          K.block<3, 3>(3 * i, 3 * j) = sign * force * s.slope * Mat3::Identity();
          if (!rows_) K.block<3, 3>(3 * i, 3 * j) += sign * left * by_end;
        }
      if (rows_) {
        for (int i = 0; i < 2; ++i) {
          const double sign = i == 1 ? 1 : -1;
          K.block<3, 1>(3 * i, 6) = p.sigma * sign * left;
          K.block<1, 3>(6, 3 * i) = p.sigma * sign * unit * by_end;
        }
        K(6, 6) = -p.sigma * p.sigma * unit;
        K(7, 7) = K(8, 8) = p.sigma;
      }
      const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> by_rows = K;
      p.K->add(clique_[k], by_rows.data());
    }
  }

  void add_energy(const Config& q, const Config&, Energy& sum) const override {
    for (size_t k = 0; k < near_.size(); ++k)
      if (points_.counts(static_cast<int>(k))) sum.elastic += potential(half_square(q, near_[k]));
  }
  void mark_rows(std::vector<char>& on) const override {
    for (const int block : block_) on[3 * static_cast<size_t>(block - points_.first_joint_block())] = 1;
  }
  /// What meets has no clock of its own.
  void tie(Ties& ties) const override {
    for (const Ball& ball : balls_)
      if (ball.body >= 0) ties.exclude(ball.body);
  }
  void archive(Archive& a) override {
    std::vector<int> list;
    for (const Pair& pair : near_) list.push_back(pair.a), list.push_back(pair.b);
    a("balls", list, layouts_);
    near_.clear();
    for (size_t k = 0; k + 1 < list.size(); k += 2) near_.push_back({list[k], list[k + 1]});
  }
  std::vector<Output> outputs() const override { return {}; }
  void observe(const Sight&) override {}
  void add_to_report(Json& run) const override { run.add("layouts", layouts_); }

 private:
  struct Ball {
    int body;  // or -1: a peg
    Vec3 at;
  };
  struct Pair {
    int a, b;
    auto operator<=>(const Pair&) const = default;
  };
  struct Quotient {
    double value, by_e1;
  };
  int block_of(int ball) const { return balls_[ball].body < 0 ? -1 : points_.body_block[balls_[ball].body]; }
  Vec3 at(const Config& q, int ball) const { return balls_[ball].body < 0 ? balls_[ball].at : q.c[balls_[ball].body]; }
  Vec3 between(const Config& q, const Pair& p) const { return at(q, p.b) - at(q, p.a); }
  double half_square(const Config& q, const Pair& p) const { return 0.5 * between(q, p).squaredNorm(); }
  double gap(double e) const { return std::min(0.0, std::sqrt(2 * e) - 2 * radius_); }
  double potential(double e) const { return 0.5 * stiffness_ * gap(e) * gap(e); }
  double slope(double e) const { return stiffness_ * gap(e) / std::sqrt(2 * e); }
  double curvature(double e) const { return gap(e) < 0 ? stiffness_ * 2 * radius_ / std::pow(2 * e, 1.5) : 0; }
  Quotient quotient(double e0, double e1) const {
    if (std::abs(e1 - e0) < 1e-7 * (e0 + e1)) return {slope((e0 + e1) / 2), curvature((e0 + e1) / 2) / 2};
    const double value = (potential(e1) - potential(e0)) / (e1 - e0);
    return {value, (slope(e1) - value) / (e1 - e0)};
  }
  void add_force(Pass& p, const Pair& pair, const Vec3& force) const {
    if (balls_[pair.a].body >= 0) p.body[balls_[pair.a].body].head<3>() -= force;
    if (balls_[pair.b].body >= 0) p.body[balls_[pair.b].body].head<3>() += force;
    p.scale(force.norm());
  }

  const Points& points_;
  std::vector<Ball> balls_;
  double radius_, stiffness_, margin_;
  bool rows_;
  std::vector<Pair> near_;           // ascending
  std::vector<int> block_, clique_;  // of these
  int layouts_ = 0;                  // so far
};

}  // namespace

void add_balls() {
  using enum Type;
  add_contribution({"balls",
                    "bodies as balls that meet each other and pegs",
                    {keys::name,
                     {"on", texts, "", "!", "bodies"},
                     {"radius", number, "m", "!", "of balls and pegs", above(0)},
                     {"stiffness", number, "N/m", "!", "of what meets", above(0)},
                     {"pegs", numbers, "m", "[]", "centres of pegs, three numbers each"},
                     {"margin", number, "m", "0.1", "pairs nearer than this are looked at", above(0)},
                     {"rows", boolean, "", "false", "a multiplier for each near pair"}}},
                   [](const Scene& scene, System& system) {
                     for (const Entry& entry : scene.entries("balls")) system.add<Balls>(system, entry);
                   });
}

namespace {

struct Chain {
  double margin = 0.1;
  bool rows = false;
  std::string integrator = "energy-momentum", more = "";
  double step = 2e-3, end = 1.2;
};

/// Beads on a chain of light rods that falls on three pegs; its ends are free.
std::string scene(const Chain& chain) {
  constexpr int n = 12;
  std::string text = "gravity = [0, 0, -9.81]\n", names, pegs;
  for (int k = 0; k < n; ++k) {
    text += fmt::format("[[body]]\nname = \"b{0}\"\nmass = 0.2\ncom = [{1}, {2}, 0]\ninertia = [1e-4, 1e-4, 1e-4]\n", k, 0.12 * k,
                        0.01 * std::sin(2.0 * k));
    if (k > 0)
      text += fmt::format(
          "[[joint]]\nkind = \"distance\"\nname = \"rod{0}\"\na = \"b{1}\"\nb = \"b{0}\"\nat_a = [{2}, {3}, 0]\n"
          "at_b = [{4}, {5}, 0]\n",
          k, k - 1, 0.12 * (k - 1), 0.01 * std::sin(2.0 * (k - 1)), 0.12 * k, 0.01 * std::sin(2.0 * k));
    names += fmt::format("{}\"b{}\"", k ? ", " : "", k);
  }
  return text + fmt::format(
                    "[[balls]]\nname = \"beads\"\non = [{}]\nradius = 0.05\nstiffness = 4e3\nmargin = {}\nrows = {}\n"
                    "pegs = [0.2, 0, -0.3, 0.66, 0.01, -0.42, 1.15, 0, -0.33]\n[time]\nend = {}\nstep = {}\nintegrator = \"{}\"\n{}\n",
                    names, chain.margin, chain.rows, chain.end, chain.step, chain.integrator, chain.more);
}

/// Where the beads end, and what the run tells.
struct Outcome {
  Eigen::MatrixXd energy;
  std::vector<double> places;
  int layouts = 0;
};

Outcome run_chain(const Chain& chain) {
  const test::Workplace place;
  std::string probes;
  for (int k = 0; k < 12; ++k) probes += fmt::format("[[probe]]\nname = \"b{0}\"\non = \"b{0}\"\n", k);
  const auto r = run_scene(place, scene(chain) + probes);
  Outcome out{r.history("energy"), {}, 0};
  for (int k = 0; k < 12; ++k)
    for (int i = 0; i < 3; ++i) out.places.push_back(r.history(fmt::format("probe/b{}", k)).bottomRows(1)(0, i));
  const std::string told = test::text_of(place / "run.json"), key = "\"layouts\": ";
  if (const size_t at = told.find(key); at != told.npos) out.layouts = std::stoi(told.substr(at + key.size()));
  return out;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

// The answer does not know how often the structure changed: with all pairs in it from the first step to the last, or only those that are
// near, whose list is another one every few steps.
TEST(OutsideContribution, PairsThatComeAndGoAreTheAnswerOfPairsThatStay) {
  const Outcome whole = run_chain({.margin = 100});
  EXPECT_LE(whole.layouts, 2);
  EXPECT_GT(whole.energy.col(1).maxCoeff(), 0.01) << "the beads meet the pegs";
  for (const bool rows : {false, true})
    for (const double margin : {0.02, 0.1}) {
      const Outcome now = run_chain({.margin = margin, .rows = rows});
      EXPECT_GT(now.layouts, margin < 0.1 ? 20 : 4);
      EXPECT_LT(largest_difference(now.places, whole.places), 1e-7) << margin << rows;
      EXPECT_LT(now.energy.col(5).cwiseAbs().maxCoeff(), 1e-9) << "the balance of energy";
    }
}

class ChangingStructure : public testing::TestWithParam<std::string> {};

TEST_P(ChangingStructure, IsTheAnswerOfOneThatStaysWithEveryIntegrator) {
  const Chain all{.margin = 100, .integrator = GetParam(), .end = 0.5};
  Chain near = all;
  near.margin = 0.02;
  const Outcome whole = run_chain(all), now = run_chain(near);
  EXPECT_GT(now.layouts, 5);
  EXPECT_LT(largest_difference(now.places, whole.places), 1e-7);
}

TEST_P(ChangingStructure, GoesOnBitByBit) {
  const test::Folder folder;
  const std::string& method = GetParam();
  // accelerations that are solved for take no row that is a law of forces
  const bool rows = method == "energy-momentum" || method == "mid-point" || method == "radau";
  test::expect_goes_on(folder.path(), scene({.margin = 0.02, .rows = rows, .integrator = method, .end = 0.5}), "", {90, 130, 170, 200});
}

INSTANTIATE_TEST_SUITE_P(Integrators, ChangingStructure, testing::ValuesIn(choices("time", "integrator")), [](const auto& p) {
  std::string name = p.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

// A ball on a slide above a peg sinks by its weight over the stiffness.
TEST(OutsideContribution, MeetsInStatics) {
  for (const bool rows : {false, true}) {
    const test::Workplace place;
    const auto r = run_scene(place, fmt::format(R"(
gravity = [0, 0, -9.81]
[[body]]
name = "ball"
mass = 2
com = [0, 0, 0.099]
inertia = [1, 1, 1]
[[joint]]
kind = "prismatic"
name = "slide"
a = "ground"
b = "ball"
at = [0, 0, 0.1]
axis = [0, 0, 1]
[[balls]]
name = "pair"
on = ["ball"]
radius = 0.05
stiffness = 4e3
pegs = [0, 0, 0]
rows = {}
[[probe]]
name = "ball"
on = "ball"
[time]
analysis = "static"
steps = 4
)",
                                                rows));
    EXPECT_NEAR(r.history("probe/ball").bottomRows(1)(0, 2), 0.1 - 2 * 9.81 / 4e3, 1e-10);
  }
}

TEST(DISABLED_ChangingOnRanks, GoesOnBitByBit) {
  test::expect_goes_on(".", scene({.margin = 0.02, .rows = true, .end = 0.5}), "", {120, 190});
}

TEST(OutsideContribution, GoesOnOnTwoRanks) {
  const test::Folder folder;
  test::expect_passes_on(2, "ChangingOnRanks", folder.path().string());
}

const Chain short_chain{.margin = 0.02, .rows = true, .end = 0.4};
TEST(DISABLED_ChangingOnMore, Runs) { EXPECT_TRUE(test::KeptRun(".", scene(short_chain), "", {}).run("run.h5", {}).complete); }

TEST(OutsideContribution, IsTheSameOnThreeRanks) {
  const test::Folder one, three;
  test::expect_passes_on(1, "ChangingOnMore", one.path().string());
  test::expect_passes_on(3, "ChangingOnMore", three.path().string());
  const test::Results a(one / "run.h5"), b(three / "run.h5");
  for (int k = 0; k < 12; ++k) {
    const std::string body = fmt::format("body/b{}", k);
    EXPECT_LT((a.history(body) - b.history(body)).cwiseAbs().maxCoeff(), 1e-6) << body;
  }
}

}  // namespace
}  // namespace outside
