// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/bdf/axes.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "import/bdf/card.hpp"

namespace hilo {
namespace {

using Kind = BdfSystem::Kind;
using State = BdfSystem::State;

/// Coordinates of a system as a vector along its axes.
Vec3 rectangular(Kind kind, const Vec3& x) {
  constexpr double degree = std::numbers::pi / 180;
  // quarter turns exact: a hole's nodes stay on its planes of symmetry
  const auto turn = [&](double angle) {
    const double quarter = angle / 90;
    if (quarter == std::floor(quarter) && std::abs(quarter) < 1e15) {
      const int k = static_cast<int>(std::fmod(std::fmod(quarter, 4) + 4, 4));
      return std::array<double, 2>{k == 0 ? 1. : k == 2 ? -1. : 0., k == 1 ? 1. : k == 3 ? -1. : 0.};
    }
    return std::array<double, 2>{std::cos(angle * degree), std::sin(angle * degree)};
  };
  if (kind == Kind::rectangular) return x;
  const auto [c1, s1] = turn(x[1]);
  if (kind == Kind::cylindrical) return Vec3(x[0] * c1, x[0] * s1, x[2]);
  const auto [c2, s2] = turn(x[2]);
  return Vec3(x[0] * s1 * c2, x[0] * s1 * s2, x[0] * c1);
}

class Resolver {
 public:
  explicit Resolver(BdfDeck& deck) : d_(deck) {}

  const Vec3& grid(size_t a) {
    BdfGrid& g = d_.grids[a];
    if (g.state == State::done) return d_.X[a];
    if (g.state == State::at_work) throw Error(g.place, fmt::format("GRID {}: its coordinate system depends on it", d_.node_id[a]));
    g.state = State::at_work;
    if (!g.system) g.system = d_.grid_default.system.value_or(0);
    if (!g.output) g.output = d_.grid_default.output.value_or(0);
    if (g.held.empty()) g.held = d_.grid_default.held;
    if (g.held.find_first_not_of('0') == std::string::npos) g.held.clear();
    if (*g.system != 0) {
      const BdfSystem& s = system(*g.system, g.place, fmt::format("GRID {}", d_.node_id[a]));
      d_.X[a] = s.origin + s.axes * rectangular(s.kind, d_.X[a]);
    }
    g.state = State::done;
    return d_.X[a];
  }

  const BdfSystem& system(std::int64_t id, const std::string& place, const std::string& who) {
    const auto at = d_.systems.find(id);
    if (at == d_.systems.end())
      throw Error(place, fmt::format("{}: no coordinate system {}", who, id), "give it by CORD2R or another CORD");
    BdfSystem& s = at->second;
    if (s.state == State::done) return s;
    const std::string name = fmt::format("coordinate system {}", id);
    if (s.state == State::at_work) throw Error(s.place, name + " depends on itself");
    if (++depth_ > 1000) throw Error(s.place, name + " hangs on a chain of more than 1000 others");
    s.state = State::at_work;
    std::array<Vec3, 3> p;
    for (size_t i = 0; i < 3; ++i)
      if (s.grids[i] != 0) {
        const auto a = d_.row.find(s.grids[i]);
        if (a == d_.row.end()) throw Error(s.place, fmt::format("{}: no GRID {}", name, s.grids[i]));
        p[i] = grid(static_cast<size_t>(a->second));
      } else if (s.reference != 0) {
        const BdfSystem& r = system(s.reference, s.place, name);
        p[i] = r.origin + r.axes * rectangular(r.kind, s.points[i]);
      } else
        p[i] = s.points[i];
    const Vec3 z = p[1] - p[0], y = z.cross(p[2] - p[0]);
    if (!(y.norm() > 1e-10 * z.norm() * (p[2] - p[0]).norm()) || !y.allFinite())
      throw Error(s.place, name + ": its three points lie on a line");
    s.origin = p[0];
    s.axes.col(2) = z.normalized();
    s.axes.col(1) = y.normalized();
    s.axes.col(0) = s.axes.col(1).cross(s.axes.col(2));
    s.state = State::done;
    --depth_;
    return s;
  }

 private:
  BdfDeck& d_;
  int depth_ = 0;
};

const BdfSystem& known(const BdfDeck& d, std::int64_t id, const std::string& place) {
  const auto at = d.systems.find(id);
  if (at == d.systems.end()) throw Error(place, fmt::format("no coordinate system {}", id), "give it by CORD2R or another CORD");
  return at->second;
}

}  // namespace

void resolve_axes(BdfDeck& deck) {
  deck.grids.resize(deck.X.size());  // nodes of other entries are as they are
  Resolver r(deck);
  for (size_t a = 0; a < deck.grids.size(); ++a) r.grid(a);
  for (const auto& [id, s] : deck.systems) r.system(id, s.place, "");
}

Mat3 axes_at(const BdfDeck& deck, std::int64_t system, const Vec3& at, const std::string& place) {
  if (system == 0) return Mat3::Identity();
  const BdfSystem& s = known(deck, system, place);
  if (s.kind == Kind::rectangular) return s.axes;
  const Vec3 x = s.axes.transpose() * (at - s.origin);
  const double rho = std::hypot(x[0], x[1]), r = x.norm();
  const double c = rho > 0 ? x[0] / rho : 1, sn = rho > 0 ? x[1] / rho : 0;  // on the axis: as at theta = 0
  Mat3 local;
  if (s.kind == Kind::cylindrical) {
    local << c, -sn, 0, sn, c, 0, 0, 0, 1;
  } else {
    const double ct = r > 0 ? x[2] / r : 1, st = r > 0 ? rho / r : 0;
    local << st * c, ct * c, -sn, st * sn, ct * sn, c, ct, -st, 0;
  }
  return s.axes * local;
}

}  // namespace hilo
