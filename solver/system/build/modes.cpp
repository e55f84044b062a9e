// SPDX-License-Identifier: GPL-3.0-or-later
// The modes of linear regions, found on one rank from all their cells.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "linear/shared_cholesky.hpp"
#include "system/build/builder.hpp"
#include "system/build/region_parcel.hpp"
#include "system/linear_regions.hpp"
#include "system/modal_damping.hpp"
#include "system/reduction/face.hpp"
#include "system/welds.hpp"

namespace hilo {

/// Modes of every linear region, found by rank 0 from all its cells, the factor by all of one machine, and what the other ranks need of
/// them.
void Builder::reduce_linear_regions() {
  out_->modes_of.resize(out_->bodies.size(), -1);
  if (out_->modes.empty() && !files_.from.empty()) warn(files_.from, "no region is linear: the file is not read");
  if (out_->modes.empty()) return;
  out_->shape_row.assign(out_->X.size(), -1);
  int n_blocks = 0;
  for (size_t number = 0; number < out_->modes.size(); ++number) {
    Modes& modes = out_->modes[number];
    const Body& axes = out_->bodies[modes.body];
    BeamRegion* beams = beam_region(static_cast<int>(number));
    RegionParcel parcel = beams ? parcel_of_beams(*beams) : parcel_of(static_cast<int>(number));
    const bool stiffening = parcel.stiffening;
    const double modal_damping = parcel.modal_damping;
    const auto& welds = parcel.welds;
    const auto& local = parcel.local;
    Reduction found;
    const bool rigid = beams && beams->rigid;
    if (comm_.rank != 0 && !rigid) SharedCholesky(comm_).serve();
    std::vector<double> head;  // modes, first frequency left out, omega2, A, levers, then of each weld: rows left out, axes, shares, means
                               // and stretches; motions of sections of beams
    if (comm_.rank == 0) {
      const ReductionInput in = beams ? beam_input(*beams, parcel) : reduction_input(parcel, axes);
      const auto n = static_cast<int>(in.X.size());
      found = rigid ? rigid_one(in) : reduction_of(in, axes, parcel.where);
      const auto m = found.omega2.size();
      head.push_back(static_cast<double>(m));
      head.push_back(found.held_frequency);
      head.insert(head.end(), found.omega2.begin(), found.omega2.end());
      for (const Eigen::MatrixXd* M :
           std::initializer_list<const Eigen::MatrixXd*>{&found.A, &found.A_damped, &found.viscous, &found.strain.matrix(), &found.left_out,
                                                         &found.sites, &found.soft, &found.second_order}) {
        head.push_back(static_cast<double>(M->rows())), head.push_back(static_cast<double>(M->cols()));
        head.insert(head.end(), M->data(), M->data() + M->size());
      }
      for (Eigen::Index j = 0; j < m; ++j) {
        double most = 0;
        for (int i = 0; i < n; ++i) most = std::max(most, found.shapes.block<3, 1>(3 * i, j).norm());
        head.push_back(most);
      }
      for (size_t k = 1; k < parcel.interfaces.size(); ++k) {  // least squares of a rigid motion
        const auto nodes = parcel.nodes_of(k);
        const Vec3 at = welds[k - 1]->at;
        std::vector<Vec3> places_of;
        for (const int i : nodes) places_of.push_back(in.X[i]);
        const Face face(places_of, at);
        head.push_back(!welds[k - 1]->of_block ? 0 : face.is_point ? 3 : face.is_line() ? 1 : 0);
        if (!welds[k - 1]->of_block && !(face.share[0] + face.share[1] > 1e-9))
          throw Error(parcel.where,
                      fmt::format("linear region \"{}\" shares nodes on a line alone with \"{}\": they are hinged there",
                                  out_->bodies[modes.body].name, welds[k - 1]->name),
                      "let them share a face, or join them by a joint");
        head.insert(head.end(), face.axes.data(), face.axes.data() + 9), head.insert(head.end(), face.share.data(), face.share.data() + 3);
        head.push_back(stiffening ? static_cast<double>(face.stretches.size()) : 0);
        for (size_t p = 0; p < face.stretches.size() && stiffening; ++p)
          head.push_back(face.stretches[p].first), head.push_back(face.stretches[p].second);
        for (Eigen::Index j = 0; j < m; ++j) {
          Vec3 mean = Vec3::Zero();
          Mat3 stretch = Mat3::Zero();
          for (const int i : nodes) {
            const Vec3 u = found.shapes.block<3, 1>(3 * i, j);
            mean += u / static_cast<double>(nodes.size());
            if (!face.is_point) stretch += u * (in.X[i] - at).transpose() * face.axes / face.second;
          }
          head.insert(head.end(), mean.data(), mean.data() + 3), head.insert(head.end(), stretch.data(), stretch.data() + 9);
        }
      }
      if (beams) {
        const std::vector<double> motions = section_motions(*beams, found.shapes);
        head.insert(head.end(), motions.begin(), motions.end());
      }
    }
    {
      std::vector<std::vector<double>> to(comm_.size);
      if (comm_.rank == 0) std::fill(to.begin(), to.end(), head);
      head = comm_.exchange(to)[0];
    }
    size_t at = 0;
    const auto next = [&] { return head[at++]; };
    const auto next_vector = [&] {
      const Vec3 v(head[at], head[at + 1], head[at + 2]);
      at += 3;
      return v;
    };
    const int m = static_cast<int>(next());
    modes.n_modes = m, modes.n_blocks = (m + 2) / 3, modes.first = n_blocks;
    n_blocks += modes.n_blocks;
    LinearRegion made;
    made.modes = static_cast<int>(number);
    made.held_frequency = next();
    made.stiffness.resize(m);
    for (int j = 0; j < m; ++j) made.stiffness[j] = next();
    Eigen::MatrixXd strain;
    for (Eigen::MatrixXd* M :
         {&made.A, &made.A_damped, &made.viscous, &strain, &made.left_out, &made.sites, &made.soft, &made.second_order}) {
      const auto rows = static_cast<Eigen::Index>(next());
      M->resize(rows, static_cast<Eigen::Index>(next()));
      for (Eigen::Index k = 0; k < M->size(); ++k) M->data()[k] = next();
    }
    modes.stiffens = strain.size() > 0;
    if (modes.stiffens) made.strain = QuadraticStrain(std::move(strain));
    out_->part<ModalDamping>().ratio.push_back(modal_damping);
    modes.lever.assign(modes.n_blocks, 0.0);
    for (int j = 0; j < m; ++j) modes.lever[j / 3] = std::max(modes.lever[j / 3], next());
    for (Weld* w : welds) {
      const auto next_matrix = [&] {
        Mat3 out;
        for (int i = 0; i < 3; ++i) out.col(i) = next_vector();
        return out;
      };
      w->left_out = static_cast<int>(next());
      w->axes = next_matrix(), w->share = next_vector();
      const auto n_stretches = static_cast<int>(next());
      for (int p = 0; p < n_stretches; ++p) {
        const int a = static_cast<int>(next());
        w->stretches.emplace_back(a, static_cast<int>(next()));
      }
      w->mean.assign(3 * modes.n_blocks, Vec3::Zero()), w->stretch.assign(3 * modes.n_blocks, Mat3::Zero());
      for (int j = 0; j < m; ++j) w->mean[j] = next_vector(), w->stretch[j] = next_matrix();
    }
    out_->part<LinearRegions>().regions.push_back(std::move(made));
    if (beams) set_sections(*beams, std::span(head).subspan(at));
    if (!beams) spread_shapes(modes, found, local);
    if (!rigid && !reductions_.empty() && reductions_.back().found.A.size() == 0) reductions_.back().found = std::move(found);
  }
  comm_.on_first([&] {
    if (!reductions_.empty()) keep_reductions();
  });
  out_->start.eta.assign(n_blocks, Vec3::Zero());
  out_->start.Y.assign(3 * static_cast<size_t>(n_blocks), Mat3::Zero());
}

/// Cells of a region to those that stress is recovered from, and its modes at the local nodes that follow it.  Collective.
void Builder::spread_shapes(const Modes& modes, const Reduction& found, const std::map<std::int64_t, int>& local) {
  const Mesh& mesh = mesh_->mesh;
  const int m = modes.n_modes;
  std::map<std::pair<int, Shape>, SolidBatch> own;
  std::vector<std::int64_t> cell_nodes;
  for (std::int64_t e = 0; e < mesh.n_cells(); ++e) {
    if (!is_of(e, modes.body)) continue;
    const int region = mesh.region[e];
    const Shape shape = taken_as(e, cell_nodes);
    auto it = own.find({region, shape});
    if (it == own.end()) it = own.emplace(std::pair(region, shape), batch_of(region, shape)).first;
    it->second.cells.push_back(static_cast<int>(e));
    for (const std::int64_t node : cell_nodes) it->second.nodes.push_back(static_cast<int>(node));
  }
  for (auto& [kind, batch] : own)
    out_->part<LinearRegions>().cells.push_back(std::move(batch)), out_->part<LinearRegions>().body_of_cells.push_back(modes.body);

  // shapes at the local nodes that follow, so many nodes at a time
  std::vector<int> mine;
  for (size_t i = 0; i < out_->X.size(); ++i)
    if (out_->follower[i] == modes.body) mine.push_back(static_cast<int>(i));
  const size_t at_once = 100000, most = static_cast<size_t>(comm_.max(static_cast<double>(mine.size())));
  out_->shapes.reserve(out_->shapes.size() + mine.size() * 3 * static_cast<size_t>(modes.n_blocks));
  for (size_t from = 0; from < most; from += at_once) {
    const std::span some =
        std::span(mine).subspan(std::min(from, mine.size()), std::min(at_once, mine.size() - std::min(from, mine.size())));
    std::vector<std::vector<std::int64_t>> ask(comm_.size);
    for (const int i : some) ask[0].push_back(mesh_->node_global[i]);
    const auto asked = comm_.exchange(ask);
    std::vector<std::vector<double>> answer(comm_.size);
    for (int k = 0; k < comm_.size && comm_.rank == 0; ++k)
      for (const std::int64_t row : asked[k])
        for (int j = 0; j < m; ++j)
          for (int c = 0; c < 3; ++c) answer[k].push_back(found.shapes(3 * local.at(row) + c, j));
    const auto shapes = comm_.exchange(answer)[0];
    for (size_t k = 0; k < some.size(); ++k) {
      out_->shape_row[some[k]] = static_cast<std::int64_t>(out_->shapes.size());
      for (int j = 0; j < 3 * modes.n_blocks; ++j)
        out_->shapes.push_back(j < m ? Vec3(shapes[3 * (k * m + j)], shapes[3 * (k * m + j) + 1], shapes[3 * (k * m + j) + 2])
                                     : Vec3::Zero());
    }
  }
}

}  // namespace hilo
