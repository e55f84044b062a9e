// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/run/swept_beams.hpp"

#include <algorithm>
#include <cmath>

namespace hilo {
namespace {

/// The rectangle of the same radii of gyration.
SectionFace stand_in_face(const RunBeam::Section& section) {
  const double w = std::sqrt(3.0) * section.radii[1], h = std::sqrt(3.0) * section.radii[0];
  SectionFace face;
  for (const auto& [x, y] : {std::pair{-w, -h}, {w, -h}, {w, h}, {-w, h}}) face.points.push_back({{x, y}, {}});
  face.cells.push_back({0, 1, 2, 3});
  return face;
}

/// Where a section is.
struct Placed {
  Vec3 at;
  Mat3 frame;
};

/// Between two sections at s, on the helix through both.
Placed on_helix(const Placed& a, const Placed& b, double s) {
  const Eigen::AngleAxisd turn(a.frame.transpose() * b.frame);
  const double angle = turn.angle();
  const Vec3 p = a.frame.transpose() * (b.at - a.at);
  const auto mean = [&](double of) -> Mat3 {  // the integral of the turn from 0 to `of`
    const Mat3 W = skew(turn.axis());
    const double x = angle * of;
    if (x < 1e-6) return of * Mat3::Identity() + x * of / 2 * W;
    return of * Mat3::Identity() + (1 - std::cos(x)) / angle * W + (of - std::sin(x) / angle) * W * W;
  };
  return {a.at + a.frame * mean(s) * mean(1).inverse() * p, a.frame * Eigen::AngleAxisd(angle * s, turn.axis()).toRotationMatrix()};
}

}  // namespace

SweptBeams::SweptBeams(const RunFile& run, MeshFile& file)
    : first_node_(file.mesh.X.size()),
      first_region_(file.mesh.region_name.size()),
      beams_(run.beams()),
      t_(run.store().read<double>("/history/t")) {
  Mesh& mesh = file.mesh;
  const auto names = run.store().read_strings("/body/name");
  const auto points = run.store().read<double>("/body/points");
  size_t n_points = 0;
  for (const RunBeam& b : beams_) n_points += b.line.cells.size() * (b.has_outline() ? b.sections.front().face->points.size() : 4);
  const int slices = n_points <= 15'000 ? 4 : n_points <= 150'000 ? 2 : 1;
  for (size_t k = 0; k < beams_.size(); ++k) {
    const RunBeam& b = beams_[k];
    auto& faces = drawn_.emplace_back();
    for (const RunBeam::Section& section : b.sections) faces.push_back(b.has_outline() ? *section.face : stand_in_face(section));
    forces_.push_back(b.shows_stress() ? run.series("beam." + b.name) : Series{});
    const SectionFace& face = faces.front();
    const auto region = static_cast<std::int32_t>(mesh.region_name.size());
    mesh.region_name.push_back(b.name);
    mesh.region_data.emplace_back();
    file.fidelity.push_back(b.bears ? Fidelity::nonlinear : Fidelity::rigid);
    std::int64_t ring = -1;  // first node of the last one
    for (size_t c = 0; c < b.line.cells.size(); ++c) {
      const bool goes_on = c > 0 && (b.line.cells[c - 1].frame_b - b.line.cells[c].frame_a).norm() < 1e-9;
      const bool next = c + 1 < b.line.cells.size() && (b.line.cells[c + 1].frame_a - b.line.cells[c].frame_b).norm() < 1e-9;
      for (int j = goes_on ? 1 : 0; j <= slices; ++j) {
        const auto first = static_cast<std::int64_t>(first_node_ + nodes_.size());
        for (size_t p = 0; p < face.points.size(); ++p) nodes_.push_back({k, c, p, static_cast<double>(j) / slices, j == slices && next});
        if (j > 0)
          for (const auto& cell : face.cells) {
            const size_t n = cell[3] < 0 ? 3 : 4;
            std::array<std::int64_t, 8> of{};
            for (size_t i = 0; i < n; ++i) of[i] = ring + cell[i], of[n + i] = first + cell[i];
            mesh.add_cell(n == 3 ? Shape::wedge6 : Shape::hex8, {of.data(), 2 * n}, region, mesh.n_cells() + 1);
            if (!file.rank.empty()) file.rank.push_back(0);
            ++n_cells_;
          }
        ring = first;
      }
    }
    for (const std::string& on : b.on) {
      if (on == "ground" || carriers_.contains(on)) continue;
      Carrier& carrier = carriers_[on];
      if (const auto found = static_cast<size_t>(std::find(names.begin(), names.end(), on) - names.begin()); found < names.size()) {
        for (size_t i = 0; i < 4; ++i) carrier.X.emplace_back(&points[12 * found + 3 * i]);
        carrier.way = run.series("body." + on);
      } else {
        carrier.nodes = mesh.nodes_of(on, run.path);
        for (const std::int64_t n : carrier.nodes) carrier.X.push_back(mesh.X[static_cast<size_t>(n)]);
      }
    }
  }
  X_ = positions({});
  for (const Vec3& x : X_) mesh.node_id.push_back(mesh.n_nodes() + 1), mesh.X.push_back(x);
}

bool SweptBeams::stressed() const {
  return std::any_of(beams_.begin(), beams_.end(), [](const RunBeam& b) { return b.shows_stress(); });
}

SweptBeams::Poses SweptBeams::poses(const RunFile::Field& own, size_t wanted) const {
  Poses out;
  for (const auto& [name, c] : carriers_) {
    std::vector<Vec3> now;
    const size_t row = std::min(wanted, std::max<size_t>(1, c.way.rows()) - 1);  // a run in progress may be a row ahead in one array
    if (c.nodes.empty())
      for (size_t i = 0; i < 4; ++i) now.emplace_back(c.way.at(row, 3 * i), c.way.at(row, 3 * i + 1), c.way.at(row, 3 * i + 2));
    for (size_t i = 0; i < c.nodes.size(); ++i) now.emplace_back(c.X[i] + Eigen::Map<const Vec3>(own.value.data() + 3 * c.nodes[i]));
    Pose pose = best_pose(c.X, now);
    if (c.nodes.empty()) pose.from = c.X[0], pose.to = now[0];
    out[name] = pose;
  }
  return out;
}

std::vector<Vec3> SweptBeams::positions(const Poses& poses) const {
  std::vector<Vec3> out;
  const auto place = [&](const RunBeam& b, size_t k, const Mat3& frame) -> Placed {
    const auto found = poses.find(b.on[k]);
    return found == poses.end() ? Placed{b.line.at[k], frame} : Placed{found->second(b.line.at[k]), found->second.R * frame};
  };
  Placed at;
  for (size_t i = 0; i < nodes_.size(); ++i) {
    const Node& n = nodes_[i];
    const RunBeam& b = beams_[n.beam];
    if (n.point == 0) {
      const BeamLine::Cell& cell = b.line.cells[n.cell];
      at = on_helix(place(b, n.cell, cell.frame_a), place(b, n.cell + 1, cell.frame_b), n.s);
    }
    const auto [first, last] = faces(n);
    const Eigen::Vector2d x = (1 - n.s) * first->points[n.point].at + n.s * last->points[n.point].at;
    out.emplace_back(at.at + at.frame * Vec3(x.x(), x.y(), 0));
  }
  return out;
}

std::vector<double> SweptBeams::stress(const std::string& name, size_t wanted) const {
  std::vector<double> out;
  for (const Node& n : nodes_) {
    if (!beams_[n.beam].shows_stress()) {
      out.push_back(0);
      continue;
    }
    const Series& forces = forces_[n.beam];
    const size_t row = std::min(wanted, forces.rows() - 1);
    const auto [a, b] = faces(n);
    const auto value = [&](const SectionFace& face, const Vec6& f) {
      const SectionStress s = stress_at(face, face.points[n.point], f);
      return name == "von_mises" ? s.von_mises() : s.axial;
    };
    const Vec6 here = (1 - n.s) * beam_forces(forces, row, n.cell, 0) + n.s * beam_forces(forces, row, n.cell, 1);
    double x = (1 - n.s) * value(*a, here) + n.s * value(*b, here);
    if (n.last)  // where a force acts on a section, the larger of both sides
      if (const double other = value(*b, beam_forces(forces, row, n.cell + 1, 0)); std::abs(other) > std::abs(x)) x = other;
    out.push_back(x);
  }
  return out;
}

void SweptBeams::append(const Step& step, const std::string& name, RunFile::Field& field) const {
  const auto add = [&](const std::vector<Vec3>& values) {
    for (const Vec3& v : values) field.value.insert(field.value.end(), v.data(), v.data() + 3);
  };
  const auto row = static_cast<size_t>(
      std::min_element(t_.begin(), t_.end(), [&](double a, double b) { return std::abs(a - step.t) < std::abs(b - step.t); }) - t_.begin());
  if (name == "displacement") {
    std::vector<Vec3> x = positions(poses(field, row));
    for (size_t i = 0; i < x.size(); ++i) x[i] -= X_[i];
    add(x);
  } else if (name == "velocity") {  // between the steps beside it: for the way from one output to the next alone
    const size_t a = row > 0 ? row - 1 : row, b = std::min(row + 1, t_.size() - 1);
    RunFile::Field still{std::vector<double>(3 * first_node_), 3};
    std::vector<Vec3> x = positions(poses(still, b)), before = positions(poses(still, a));
    for (size_t i = 0; i < x.size(); ++i) x[i] = b > a ? Vec3((x[i] - before[i]) / (t_[b] - t_[a])) : Vec3::Zero();
    add(x);
  } else if (name == "von_mises" || name == "axial_stress") {
    const std::vector<double> s = stress(name, row);
    field.value.insert(field.value.end(), s.begin(), s.end());
  } else {
    const size_t n = name.starts_with("cell_") ? static_cast<size_t>(n_cells_) : nodes_.size();
    field.value.resize(field.value.size() + n * static_cast<size_t>(field.columns));
  }
}

}  // namespace hilo
