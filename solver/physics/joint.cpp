// The joints as lists of quadratic measures: every kind has its minimal number of independent rows.
#include "physics/connector.hpp"

namespace hilo {
namespace {

/// Entities of a connector under construction, in the carriers' own axes.
struct Maker {
  Connector c;
  const Config& q;

  int point(int end, const Vec3& at) {
    const int b = c.end[end].body;
    c.entities.push_back({end, b < 0 ? Vec3::Zero() : Vec3(q.R[b].transpose() * (at - q.c[b])), true});
    return static_cast<int>(c.entities.size()) - 1;
  }
  int direction(int end, const Vec3& d) {
    c.entities.push_back({end, q.R[c.end[end].body].transpose() * d, false});
    return static_cast<int>(c.entities.size()) - 1;
  }
  /// A row whose value is zero in the configuration given.
  void zero(Term t) {
    c.measures.push_back({{t}, 0});
    c.measures.back().offset = c.value(static_cast<int>(c.measures.size()) - 1, q);
  }
  void dot(int i, int j) { zero({Term::dot, i, j}); }
};

}  // namespace

Connector make_joint(const std::string& kind, const Carrier& a, const Carrier& b, const Config& q, const Vec3& at, const Vec3& at_b,
                     const Mat3& frame) {
  Maker m{{}, q};
  m.c.kind = kind;
  m.c.end[0] = a, m.c.end[1] = b;
  const int pa = m.point(0, at), pb = m.point(1, at_b);
  if (a.body >= 0) m.c.frame_a = q.R[a.body].transpose() * frame;
  if (b.body >= 0) m.c.point_b = q.R[b.body].transpose() * (at_b - q.c[b.body]);
  if (kind == "distance") {
    m.zero({Term::distance2, pa, pb});
    return std::move(m.c);
  }
  const auto same_point = [&] {
    for (int i = 0; i < 3; ++i) m.zero({Term::coordinate, pa, pb, 0, 1, Vec3::Unit(i)});
  };
  if (kind == "spherical") {
    same_point();
    return std::move(m.c);
  }
  // columns of the frame carried by a and by b, made when first asked for
  int ua[3] = {-1, -1, -1}, vb[3] = {-1, -1, -1};
  const auto u = [&](int i) { return ua[i] < 0 ? ua[i] = m.direction(0, frame.col(i)) : ua[i]; };
  const auto v = [&](int i) { return vb[i] < 0 ? vb[i] = m.direction(1, frame.col(i)) : vb[i]; };
  if (kind == "fixed") {
    same_point();
    m.dot(u(0), v(1)), m.dot(u(1), v(2)), m.dot(u(2), v(0));
  } else if (kind == "revolute") {
    same_point();
    m.dot(u(0), v(2)), m.dot(u(1), v(2));
  } else if (kind == "universal") {
    same_point();
    m.dot(u(2), v(0));
  } else if (kind == "cylindrical" || kind == "prismatic") {
    m.zero({Term::slide, u(0), pa, pb}), m.zero({Term::slide, u(1), pa, pb});
    m.dot(u(0), v(2)), m.dot(u(1), v(2));
    if (kind == "prismatic") m.dot(u(0), v(1));
  }
  return std::move(m.c);
}

}  // namespace hilo
