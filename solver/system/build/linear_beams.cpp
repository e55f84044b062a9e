// SPDX-License-Identifier: GPL-3.0-or-later
// Beams of linear fidelity to mean axes and modes, rigid ones to mean axes.
//
// A section is four nodes that move as one, so that masses at them are those of the beam exactly.  What beams ride on is a place: its
// sections move as one too.  Where something acts on its body it is an interface, welded to that body; elsewhere the region carries it.
// What a rigid one carries is joined to it as by a fixed joint, whose rows are chosen among those of all joints.
#include "system/linear_beams.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <map>

#include "base/joined.hpp"
#include "system/build/builder.hpp"
#include "system/build/region_parcel.hpp"

namespace hilo {
namespace {

constexpr int per_section = 4;

std::array<Vec3, per_section> nodes_of(const Vec3& at, double arm) {
  return {at, at + arm * Vec3::UnitX(), at + arm * Vec3::UnitY(), at + arm * Vec3::UnitZ()};
}

}  // namespace

/// After what beams ride on is known.
void Builder::add_linear_beams() {
  const auto n_bodies = static_cast<int>(out_->bodies.size());
  std::vector<char> is_section(static_cast<size_t>(n_bodies), 0);
  for (const BeamPlan& plan : beam_plans_)
    for (size_t k = 0; k < plan.body.size() && plan.by_modes(); ++k) {
      const bool rides = (k == 0 && plan.entry->given("a")) || (k + 1 == plan.body.size() && plan.entry->given("b"));
      if (!rides) is_section[static_cast<size_t>(plan.body[k])] = 1;
    }
  const auto hangs_together = [&](int b) {  // beams that ride on it
    const Body& body = out_->bodies[b];
    const auto named = body_by_name_.find(body.name);
    return is_section[static_cast<size_t>(b)] ||
           (b > 0 && body.mass == 0 && body.J.isZero(0) && !body.patch && named != body_by_name_.end() && named->second == b);
  };
  const auto n_plans = static_cast<int>(beam_plans_.size());
  Joined joined(n_plans);
  std::map<int, int> first;
  for (int k = 0; k < n_plans; ++k)
    for (const int b : beam_plans_[k].body) {
      const auto [at, fresh] = first.try_emplace(b, k);
      if (fresh) continue;
      if (beam_plans_[k].fidelity != beam_plans_[at->second].fidelity)
        acted_on_.insert(b);
      else if (hangs_together(b))
        joined.join(at->second, k);
    }
  std::map<int, std::vector<int>> groups;
  for (int k = 0; k < n_plans; ++k)
    if (beam_plans_[k].by_modes()) groups[joined.root(k)].push_back(k);
  for (auto& [root, plans] : groups) add_beam_region(std::move(plans), hangs_together);
}

void Builder::add_beam_region(std::vector<int> plans, const std::function<bool(int)>& only_here) {
  LinearBeams& beams = out_->part<LinearBeams>();
  BeamRegion region;
  region.modes = static_cast<int>(out_->modes.size());
  region.rigid = beam_plans_[plans.front()].fidelity == Fidelity::rigid;
  region.first_cell = static_cast<int>(beams.cells.size());
  std::map<int, size_t> place_of;
  const auto add_section = [&](const Vec3& at, int body) {
    const auto [place, fresh] = place_of.try_emplace(body, region.places.size());
    if (fresh) region.places.push_back({body, only_here(body), false, {}});
    const int s = static_cast<int>(beams.sections.size());
    beams.sections.push_back({region.modes, per_section * static_cast<int>(region.sections.size()), at, {}, {}});
    region.places[place->second].sections.push_back(s);
    region.sections.push_back(s);
    return s;
  };
  double shortest = 1e300;
  const BeamPlan& one = beam_plans_[plans.front()];
  for (const int p : plans) {
    const BeamPlan& plan = beam_plans_[p];
    const Entry& e = *plan.entry;
    if (e.number("modal_damping") != one.entry->number("modal_damping"))
      e.refuse(e.given("modal_damping") ? "modal_damping" : "",
               fmt::format("beams \"{}\" and \"{}\" hang together and share modes, but differ in modal_damping", one.entry->name, e.name),
               "give both the same value");
    beams.beams.push_back({e.name, static_cast<int>(beams.cells.size()), static_cast<int>(plan.line.cells.size()), region.rigid});
    const int first = add_section(plan.line.at.front(), plan.body.front());
    for (size_t k = 0, a = static_cast<size_t>(first); k < plan.line.cells.size(); ++k) {
      const BeamLine::Cell& cell = plan.line.cells[k];
      const int b = plan.line.closed && k + 1 == plan.line.cells.size() ? first : add_section(plan.line.at[k + 1], plan.body[k + 1]);
      beams.add_cell({plan.line.at[k], cell.frame_a, static_cast<int>(a)}, {plan.line.at[k + 1], cell.frame_b, b}, plan.sections[k],
                     e.number("damping"), e.number("mass_damping"));
      count_cell(plan.sections[k], beams.cells.back());
      shortest = std::min(shortest, cell.length), a = static_cast<size_t>(b);
    }
  }
  region.n_cells = static_cast<int>(beams.cells.size()) - region.first_cell;
  region.arm = shortest / 4, region.plans = std::move(plans);
  add_mean_axes(region);
  beam_regions_.push_back(std::move(region));
}

/// The body with the mass of a region's cells.
void Builder::add_mean_axes(BeamRegion& region) {
  const LinearBeams& beams = out_->part<LinearBeams>();
  const Entry& e = *beam_plans_[region.plans.front()].entry;
  double mass = 0;
  Vec3 moment = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  const Vec3 origin = beams.sections[region.sections.front()].at;
  for (int k = region.first_cell; k < region.first_cell + region.n_cells; ++k) {
    const PointCell cell = beams.point_cell(static_cast<size_t>(k), region.arm);
    Eigen::Matrix<double, 8, 3> X;
    for (int i = 0; i < 2; ++i) {
      const auto nodes = nodes_of(beams.sections[beams.cells[k].body[i]].at, region.arm);
      for (int a = 0; a < per_section; ++a) X.row(per_section * i + a) = (nodes[a] - origin).transpose();
    }
    mass += cell.mass.sum(), moment += X.transpose() * cell.mass.rowwise().sum(), second += X.transpose() * cell.mass * X;
  }
  if (!(mass > 0))
    e.refuse("fidelity", fmt::format("a beam of fidelity \"{}\" needs a mass", e.text("fidelity")),
             "density of its material, or line_mass of its section");
  const Vec3 com = moment / mass;
  std::string name = e.name;
  constexpr size_t named = 4;
  for (size_t k = 1; k < region.plans.size() && region.plans.size() <= named; ++k) name += "+" + beam_plans_[region.plans[k]].entry->name;
  if (region.plans.size() > named) name += fmt::format("+{} more", region.plans.size() - 1);
  if (body_by_name_.contains(name) || (mesh_ && mesh_->mesh.find_region(name) >= 0))
    throw Error(e.place.text(), fmt::format("{}: a body or region is called \"{}\", as the mean axes of this beam", e.label(), name));
  const int b = new_body(name, origin + com);
  Body& axes = out_->bodies[b];
  axes.mass = mass, axes.J = second - mass * com * com.transpose(), axes.linear = true;
  axes.size = std::sqrt(std::max(axes.J.trace() / mass, 1e-300));
  const Mat3 inertia = axes.J.trace() * Mat3::Identity() - axes.J;
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(inertia);
  if (!(eigen.eigenvalues()[0] > 1e-14 * eigen.eigenvalues()[2]))
    e.refuse("fidelity", "nothing of this beam has inertia about its axis", "inertia of its section, or fidelity = \"nonlinear\"");
  out_->modes_of.resize(out_->bodies.size(), -1);
  out_->modes_of[b] = region.modes;
  Modes& modes = out_->modes.emplace_back();
  modes.body = b, modes.of_beams = true;
}

Builder::BeamRegion* Builder::beam_region(int number) {
  const auto found = std::ranges::find(beam_regions_, number, &BeamRegion::modes);
  return found == beam_regions_.end() ? nullptr : &*found;
}

/// Once all entries are read: which sections are interfaces.
RegionParcel Builder::parcel_of_beams(BeamRegion& region) {
  const LinearBeams& beams = out_->part<LinearBeams>();
  auto& welds = out_->part<Welds>().list;
  RegionParcel out;
  for (const int p : region.plans) {
    const Entry& e = *beam_plans_[p].entry;
    out.modal_damping = e.number("modal_damping");
    if (e.given("up_to")) out.up_to = std::max(out.up_to, e.number("up_to"));
    out.n_vibrations = std::max(out.n_vibrations, static_cast<int>(e.number("modes")));
    out.modes_given = out.modes_given || e.given("modes");
  }
  out.where = beam_plans_[region.plans.front()].entry->place.text();
  out.interfaces.emplace_back(1);
  for (int i = 0; i < per_section * static_cast<int>(region.sections.size()); ++i) out.local[i] = i;
  for (BeamRegion::Place& place : region.places) {
    Body& body = out_->bodies[place.body];
    place.carried = place.only_here && !acted_on_.contains(place.body) && !body.held && body.mass == 0 && !body.ground;
    if (place.carried) {
      body.held = true;
      continue;
    }
    if (region.rigid) {
      add_bond(out_->modes[region.modes].body, place.body, beams.sections[place.sections.front()].at);
      continue;
    }
    Weld w;
    w.name = body.name, w.body = place.body, w.modes = region.modes;
    std::vector<std::int64_t> rows;
    Vec3 sum = Vec3::Zero();
    for (const int s : place.sections) {
      const auto nodes = nodes_of(beams.sections[s].at, region.arm);
      for (int a = 0; a < per_section; ++a) rows.push_back(beams.sections[s].node + a), sum += nodes[a];
    }
    w.at = sum / static_cast<double>(rows.size());
    out.interfaces.push_back({rows});
    welds.push_back(std::move(w));
  }
  for (Weld& w : welds)
    if (w.modes == region.modes) out.welds.push_back(&w);
  return out;
}

/// On rank 0.
ReductionInput Builder::beam_input(const BeamRegion& region, const RegionParcel& parcel) const {
  const LinearBeams& beams = out_->part<LinearBeams>();
  ReductionInput in;
  for (const int s : region.sections)
    for (const Vec3& X : nodes_of(beams.sections[s].at, region.arm)) in.X.push_back(X);
  for (int k = region.first_cell; k < region.first_cell + region.n_cells; ++k)
    in.points.push_back(beams.point_cell(static_cast<size_t>(k), region.arm));
  for (size_t k = 0; k < parcel.welds.size(); ++k)
    in.rigid.push_back(parcel.nodes_of(k + 1)), in.rigid_names.push_back(parcel.welds[k]->name);
  for (const BeamRegion::Place& place : region.places) {
    if (!place.carried) continue;
    auto& block = in.blocks.emplace_back();
    for (const int s : place.sections)
      for (int a = 0; a < per_section; ++a) block.push_back(beams.sections[s].node + a);
  }
  for (const LineLoad& line : beams.lines) add_load_shapes(region, line, in);
  set_wishes(in, parcel, out_->bodies[out_->modes[region.modes].body]);
  return in;
}

/// Of a load by length: each component of it in every direction that it may take as the region turns, or as it is where it follows.
void Builder::add_load_shapes(const BeamRegion& region, const LineLoad& line, ReductionInput& in) const {
  const LinearBeams& beams = out_->part<LinearBeams>();
  const auto add = [&](const auto& load_at) {
    std::vector<std::pair<int, Vec3>> forces;
    for (size_t c = 0; c < line.at.size(); ++c) {
      const size_t k = static_cast<size_t>(line.first) + c;
      if (static_cast<int>(k) < region.first_cell || static_cast<int>(k) >= region.first_cell + region.n_cells) continue;
      const PointCell cell = beams.point_cell(k, region.arm);
      const Eigen::Matrix<double, 8, 3> F = beams.points_of_nodes(k, region.arm).transpose() * load_at(k, c);
      for (int i = 0; i < 8; ++i)
        if (!F.row(i).isZero(0)) forces.emplace_back(cell.nodes[i], F.row(i).transpose());
    }
    if (!forces.empty()) in.loads.push_back(std::move(forces));
  };
  if (line.load.follower) {
    add([&](size_t k, size_t c) -> Eigen::Matrix<double, 8, 3> {
      LineForces f;
      f.add(line, c, beams.cells[k], 1);
      Eigen::Matrix<double, 8, 3> y = Eigen::Matrix<double, 8, 3>::Zero();  // directors as drawn
      for (int e = 0; e < 2; ++e)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) y(4 * e + 1 + i, j) = beams.cells[k].arc.axis[e][i][j];
      return f.K * y;
    });
    return;
  }
  for (int component = 0; component < 3; ++component)
    for (int way = 0; way < 3; ++way)
      add([&](size_t k, size_t c) -> Eigen::Matrix<double, 8, 3> {
        LineForces f;
        f.add(line, c, beams.cells[k], 1);
        Eigen::Matrix<double, 8, 3> out = Eigen::Matrix<double, 8, 3>::Zero();
        out.col(way) = f.F.col(component);
        return out;
      });
}

/// The region's modes at its sections, and the bodies that it carries.  `motions`: displacement and turn of each section by each mode.
void Builder::set_sections(const BeamRegion& region, std::span<const double> motions) {
  LinearBeams& beams = out_->part<LinearBeams>();
  const Modes& modes = out_->modes[region.modes];
  const double* at = motions.data();
  for (const int number : region.sections) {
    LinearSection& s = beams.sections[number];
    s.moves.assign(3 * static_cast<size_t>(modes.n_blocks), Vec3::Zero()), s.turns = s.moves;
    for (int j = 0; j < modes.n_modes; ++j, at += 6) s.moves[j] = Vec3(at[0], at[1], at[2]), s.turns[j] = Vec3(at[3], at[4], at[5]);
  }
  CarriedBodies& all = beams.carried.emplace_back();
  all.modes = region.modes;
  for (const BeamRegion::Place& place : region.places)
    if (place.carried) all.bodies.push_back(place.body);
  all.motions.resize(4 * std::ssize(all.bodies), 9 * modes.n_blocks);
  Eigen::Index row = 0;
  for (const BeamRegion::Place& place : region.places) {
    if (!place.carried) continue;
    const LinearSection& s = beams.sections[place.sections.front()];
    for (size_t j = 0; j < s.moves.size(); ++j) {
      auto own = all.motions.block<4, 3>(row, 3 * static_cast<Eigen::Index>(j));
      own.row(0) = s.moves[j] + s.turns[j].cross(out_->bodies[place.body].Xc - s.at);
      own.bottomRows<3>() = skew(s.turns[j]).transpose();
    }
    row += 4;
  }
}

/// Displacement and turn of each section by each mode (shapes are of nodes).
std::vector<double> Builder::section_motions(const BeamRegion& region, const Eigen::MatrixXd& shapes) const {
  std::vector<double> out;
  for (size_t k = 0; k < region.sections.size(); ++k)
    for (Eigen::Index j = 0; j < shapes.cols(); ++j) {
      const auto u = [&](size_t a) -> Vec3 { return shapes.block<3, 1>(3 * static_cast<Eigen::Index>(per_section * k + a), j); };
      Vec3 turn = Vec3::Zero();
      for (size_t a = 0; a < 3; ++a) turn += Vec3::Unit(static_cast<Eigen::Index>(a)).cross(u(1 + a) - u(0)) / (2 * region.arm);
      const Vec3 move = u(0);
      out.insert(out.end(), move.data(), move.data() + 3), out.insert(out.end(), turn.data(), turn.data() + 3);
    }
  return out;
}

void Builder::start_sections(const std::vector<bool>& body, const Vec3& velocity, const Vec3& spin, const Vec3& about) {
  for (const BeamRegion& region : beam_regions_)
    for (const BeamRegion::Place& place : region.places)
      for (const int s : place.sections)
        if (body[static_cast<size_t>(place.body)])
          section_starts_[s] = {velocity + spin.cross(out_->part<LinearBeams>().sections[s].at - about), spin};
}

void Builder::set_beam_velocities(Config& v) const {
  const LinearBeams& beams = out_->part<LinearBeams>();
  std::vector<Vec3> moves(beams.sections.size(), Vec3::Zero()), turns = moves;
  std::set<int> starts;
  for (const auto& [s, start] : section_starts_)
    moves[static_cast<size_t>(s)] = start[0], turns[static_cast<size_t>(s)] = start[1], starts.insert(beams.sections[s].modes);
  for (const int m : starts) set_velocity(out_->modes[m].body, beams.momenta(m, moves, turns), v);
}

}  // namespace hilo
