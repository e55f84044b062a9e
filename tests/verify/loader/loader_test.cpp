// SPDX-License-Identifier: GPL-3.0-or-later
// data/loader against its drawing: the pins of a Z-bar linkage go where circles meet, and by virtual work the forces of both cylinders
// carry the weights.  Joints with as many rows as the linkage needs have no redundant one; a revolute at every pin has three too many in
// each loop.
#include "verify/verify.hpp"

namespace hilo::test::loader_test {
namespace {

using Vec2 = Eigen::Vector2d;  // x forward, z up
Vec2 across(const Vec2& r) { return {-r.y(), r.x()}; }
double cross(const Vec2& a, const Vec2& b) { return across(a).dot(b); }

constexpr double g = 9.80665;
const Vec2 edge(3.45, 0.03);
// pins as data/loader/scene.toml draws them
const Vec2 boom_pivot(0, 1.9), lift_foot(-0.15, 0.9), lift_head(1.2, 0.98), lever_pin(1.15, 1.32), tilt_foot(0.2, 1.58),
    tilt_head(1.17, 2.18), bucket_pin(2.3, 0.45), link_rear(1.28, 0.57), link_front(2.28, 0.82);

/// The point at distances r and s from two pins, on the side of the line between them where it was drawn.
Vec2 meet(const Vec2& a, double r, const Vec2& b, double s, double side) {
  const double l = (b - a).norm(), along = (r * r - s * s + l * l) / (2 * l);
  const Vec2 u = (b - a) / l;
  return a + along * u + std::copysign(std::sqrt(r * r - along * along), side) * across(u);
}

/// A part that two of its points carry along: places, and velocities by that of the first point and the rate of the angle.
struct Part {
  Vec2 drawn, now, turn;  // turn: cosine and sine
  Vec2 v = Vec2::Zero();
  double rate = 0;
  Part(const Vec2& p, const Vec2& p1, const Vec2& q, const Vec2& q1) : drawn(p), now(p1) {
    const Vec2 a = (q - p).normalized(), b = (q1 - p1).normalized();
    turn = {a.dot(b), cross(a, b)};
  }
  Vec2 place(const Vec2& X) const { return now + turn.x() * (X - drawn) + turn.y() * across(X - drawn); }
  Vec2 velocity(const Vec2& x) const { return v + rate * across(x - now); }
};

/// All parts at two strokes, and their velocities at two rates of the strokes.
std::map<std::string, Part> linkage(double lift, double tilt, double lift_rate, double tilt_rate) {
  const auto side = [](const Vec2& a, const Vec2& b, const Vec2& p) { return cross(b - a, p - a); };
  const Vec2 head = meet(boom_pivot, (lift_head - boom_pivot).norm(), lift_foot, (lift_head - lift_foot).norm() + lift,
                         side(boom_pivot, lift_foot, lift_head));
  Part boom(boom_pivot, boom_pivot, lift_head, head);
  const Vec2 lever = boom.place(lever_pin), bucket = boom.place(bucket_pin);
  const Vec2 top =
      meet(lever, (tilt_head - lever_pin).norm(), tilt_foot, (tilt_head - tilt_foot).norm() + tilt, side(lever_pin, tilt_foot, tilt_head));
  Part bell(lever_pin, lever, tilt_head, top);
  const Vec2 rear = bell.place(link_rear);
  const Vec2 front =
      meet(bucket, (link_front - bucket_pin).norm(), rear, (link_front - link_rear).norm(), side(bucket_pin, link_rear, link_front));
  Part shovel(bucket_pin, bucket, link_front, front), link(link_rear, rear, link_front, front);
  Part lift_tube(lift_foot, lift_foot, lift_head, head), lift_rod(lift_head, head, lift_foot, lift_foot);
  Part tilt_tube(tilt_foot, tilt_foot, tilt_head, top), tilt_rod(tilt_head, top, tilt_foot, tilt_foot);

  const Vec2 u = (head - lift_foot).normalized(), w = (top - tilt_foot).normalized(), n = front - rear;
  boom.rate = lift_rate / across(head - boom_pivot).dot(u);
  bell.v = boom.velocity(lever);
  bell.rate = (tilt_rate - bell.v.dot(w)) / across(top - lever).dot(w);
  link.v = bell.velocity(rear), shovel.v = boom.velocity(bucket);
  shovel.rate = (link.v - shovel.v).dot(n) / across(front - bucket).dot(n);
  link.rate = cross(n, shovel.velocity(front) - link.v) / n.squaredNorm();
  lift_rod.v = boom.velocity(head), tilt_rod.v = bell.velocity(top);
  lift_tube.rate = lift_rod.rate = cross(u, lift_rod.v) / (head - lift_foot).norm();
  tilt_tube.rate = tilt_rod.rate = cross(w, tilt_rod.v) / (top - tilt_foot).norm();
  return {{"boom", boom},           {"lever", bell},        {"bucket", shovel},       {"link", link},
          {"lift_tube", lift_tube}, {"lift_rod", lift_rod}, {"tilt_tube", tilt_tube}, {"tilt_rod", tilt_rod}};
}

const Case& place() {
  static const Case c("loader");
  return c;
}

/// A run of data/loader; the mesh is made once.
Ran ran_with(const std::string& options, const std::string& output) {
  const std::string data = std::string(HILO_SOURCE) + "/data/loader/";
  return succeeded(place().run("[ -f tags.h5 ] || { hilo-import --quiet '" + data + "loader.geo' -o mesh.h5 && hilo-tag --quiet mesh.h5 '" +
                               data + "tags.toml' -o tags.h5; } && hilo-solve '" + data + "scene.toml' tags.h5 " + options + " -o " +
                               output));
}

/// Forces of the lift and tilt cylinders that carry the weights of all parts, by virtual work.
Vec2 forces(const Results& run, double lift, double tilt) {
  const auto names = run.file().read_strings("/body/name");
  const auto mass = run.file().read<double>("/body/mass"), points = run.file().read<double>("/body/points");
  Vec2 F = Vec2::Zero();
  for (int k = 0; k < 2; ++k) {
    const auto parts = linkage(lift, tilt, k == 0, k == 1);
    for (size_t b = 0; b < names.size(); ++b) {
      const auto part = parts.find(names[b]);
      if (part == parts.end()) continue;  // the frame
      const Vec2 centre = part->second.place({points[12 * b], points[12 * b + 2]});
      F[k] += mass[b] * g * part->second.velocity(centre).y();
    }
  }
  return F;
}

// Load steps, in which gravity grows with time: at every place of the whole way.  What is left is Newton's residual.
TEST(Loader, CylindersCarryTheWeightsByVirtualWork) {
  ran_with("--quiet --set 'time.analysis=\"static\"' --set time.steps=19 --set solver.tolerance=1e-13", "run.h5");
  const Results run = place().results();
  const auto lift = run.history("joint/lift"), tilt = run.history("joint/tilt"), slide = run.history("coordinate/lift"),
             slide2 = run.history("coordinate/tilt"), probe = run.history("probe/edge");
  ASSERT_EQ(run.t().size(), 20);
  double most = 0, farthest = 0;
  Vec2 least = Vec2::Constant(1e9), largest = Vec2::Zero();
  for (Eigen::Index i = 1; i < run.t().size(); ++i) {
    const Vec2 expected = run.t()[i] / 9.5 * forces(run, slide(i, 0), slide2(i, 0));
    most = std::max({most, std::abs(lift(i, 2) / expected[0] - 1), std::abs(tilt(i, 2) / expected[1] - 1)});
    const Part bucket = linkage(slide(i, 0), slide2(i, 0), 0, 0).at("bucket");
    farthest = std::max(farthest, (bucket.place(edge) - Vec2(probe(i, 0), probe(i, 2))).norm());
    least = least.cwiseMin(expected * 9.5 / run.t()[i]), largest = largest.cwiseMax(expected * 9.5 / run.t()[i]);
  }
  EXPECT_NEAR(slide(19, 0), 0.75, 1e-12) << "the whole way";
  EXPECT_NEAR(slide2(19, 0), -0.25, 1e-12);
  EXPECT_GT(largest[0], 1.5 * least[0]) << "the way changes the forces";
  EXPECT_LT(most, 1e-8) << "of each force";
  EXPECT_LT(farthest, 1e-10) << "m of the bucket's edge";
  std::printf("lift %.1f to %.1f kN, tilt %.1f to %.1f kN, off by %.1e; edge off by %.1e m\n", least[0] / 1e3, largest[0] / 1e3,
              least[1] / 1e3, largest[1] / 1e3, most, farthest);
}

// 48 rows for 48 freedoms, all independent.  With a revolute at every pin there are 57 for the same motion: nine too many, three in each
// loop, and what the cylinders push is the same.
TEST(Loader, NamesTheRowsThatRevolutesHaveTooMany) {
  const std::string held = "--set time.end=0.05 --set 'history.lift.value=[0,0,0,0]' --set 'history.tilt.value=[0,0,0,0,0,0]' ";
  const Ran right = ran_with(held, "run.h5");
  EXPECT_EQ(right.err.find("redundant"), std::string::npos) << right.err;
  const Results first = place().results();
  const Vec2 expected = forces(first, 0, 0);
  EXPECT_NEAR(first.history("joint/lift")(0, 2), expected[0], 1e-8 * expected[0]);
  EXPECT_NEAR(first.history("joint/tilt")(0, 2), expected[1], 1e-8 * expected[1]);

  std::string revolutes;
  for (const char* pin : {"lift_foot", "lift_head", "tilt_foot", "tilt_head", "link_rear", "link_front"})
    revolutes += fmt::format("--set 'joint.{0}.kind=\"revolute\"' --set joint.{0}.axis=[0,1,0] ", pin);
  const Ran all = ran_with(held + revolutes, "revolutes.h5");
  EXPECT_NE(all.err.find("9 of 57 joint rows are redundant"), std::string::npos) << all.err;
  for (const char* partners : {"(depends on bucket_pin, lever_pin, link_rear)", "(depends on boom_pivot, lift_foot, lift_head)",
                               "(depends on boom_pivot, lever_pin, tilt_foot, tilt_head)"})
    EXPECT_NE(all.err.find(partners), std::string::npos) << "no loop " << partners << " in " << all.err;
  const Results second = place().results("revolutes.h5");
  for (const char* name : {"joint/lift", "joint/tilt"})
    EXPECT_NEAR(second.history(name)(0, 2), first.history(name)(0, 2), 1e-8 * expected[0]) << name;
}

}  // namespace
}  // namespace hilo::test::loader_test
