// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/stress_recovery.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "base/shell_shape.hpp"
#include "dynamics/linear_cell_mean.hpp"
#include "model/mesh.hpp"
#include "model/region_surface.hpp"
#include "system/linear_regions.hpp"

namespace hilo {
namespace {

bool quadratic(Shape s) { return info(s).n_nodes > info(s).n_corners; }
/// Whose samples have the stress an order better than the rest of the cell: tetrahedra and wedges have no such points [barlow-1976].
bool has_best_points(Shape s) { return quadratic(s) && info(s).n_corners == 8; }
bool is_bar(Shape s) { return info(s).dimension < 3; }

/// What a cell remembers; null where nothing is.
const double* of_cell(const SolidBatch& b, const StressRecovery::Memory& memory, size_t batch, size_t cell) {
  return b.kernel.n_state > 0 && batch < memory.size() ? memory[batch].data() + cell * static_cast<size_t>(b.kernel.n_state) : nullptr;
}

}  // namespace

struct StressRecovery::Cell {
  const SolidBatch* batch;
  std::vector<Vec3> X, x;  // of a linear region: as displaced from the mean axes
  bool linear = false, stiffens = false;
  Mat3 R;  // of these

  void points(StressPoints which, std::vector<StressPoint>& out, const double* state = nullptr) const {
    if (!linear || stiffens) {
      stress_points(batch->shape, batch->material, X, x, which, out, state);
      for (StressPoint& p : out)
        if (stiffens) p.F = R * p.F;
      return;
    }
    small_strain_points(batch->shape, batch->material, X, x, which, out);
    for (StressPoint& p : out) p.F = R;
  }
  void gradients(std::span<Mat3> F) const {
    if (!linear || stiffens) nodal_gradients(batch->shape, X, x, F);
    for (Mat3& f : F)
      if (linear) f = stiffens ? Mat3(R * f) : R;
  }
};

/// q: null for the reference configuration.
void StressRecovery::look_at(Cell& cell, size_t batch, size_t number, const Config* q) const {
  cell.batch = batches_[batch];
  const int body = body_[batch], n = info(cell.batch->shape).n_nodes;
  const int* nodes = cell.batch->nodes.data() + number * n;
  cell.linear = q && body >= 0;
  cell.stiffens = cell.linear && stiffens_[batch];
  if (cell.linear) cell.R = q->R[body];
  cell.X.resize(n), cell.x.resize(n);
  for (int i = 0; i < n; ++i) {
    cell.X[i] = cell.x[i] = system_.X[nodes[i]];
    if (!q) continue;
    if (!cell.linear)
      cell.x[i] = q->x[nodes[i]];
    else if (system_.follower[nodes[i]] == body)
      cell.x[i] = placed_[nodes[i]];
    else  // another body's too
      cell.x[i] = system_.bodies[body].Xc + cell.R.transpose() * (placed_[nodes[i]] - q->c[body]);
  }
}

/// Visit the cells of the patches: batch and its number, number of the cell in it, patches of its corners, the cell.
template <class Visit>
void StressRecovery::each_cell(const Patches& p, const Config* q, Visit&& visit) const {
  Cell at;
  for (size_t b = 0; b < batches_.size(); ++b) {
    const int corners = info(batches_[b]->shape).n_corners;
    if (p.corner[b].empty()) continue;
    for (size_t e = 0; e < batches_[b]->cells.size(); ++e) {
      look_at(at, b, e, q);
      visit(b, e, std::span(p.corner[b].data() + e * corners, corners), at);
    }
  }
}

StressRecovery::StressRecovery(const System& s) : system_(s) {
  for (const SolidBatch& b : s.part<Solids>().batches) batches_.push_back(&b), body_.push_back(-1), stiffens_.push_back(0);
  const auto& linear = s.part<LinearRegions>();
  for (size_t k = 0; k < linear.cells.size(); ++k) {
    batches_.push_back(&linear.cells[k]), body_.push_back(linear.body_of_cells[k]);
    stiffens_.push_back(s.modes[s.modes_of[body_.back()]].stiffens);
    carried_.insert(carried_.end(), linear.cells[k].nodes.begin(), linear.cells[k].nodes.end());
  }
  std::sort(carried_.begin(), carried_.end());
  carried_.erase(std::unique(carried_.begin(), carried_.end()), carried_.end());
  if (!carried_.empty()) placed_.resize(s.X.size());
  find_sites(), find_free_sides();
  const size_t n_regions = s.mesh->mesh.region_name.size();
  std::vector<double> has(2 * n_regions, 0.0);  // of each region: quadratic cells; cells without best points
  for (const SolidBatch* b : batches_) {
    if (quadratic(b->shape)) has[2 * b->region] = 1;
    if (!is_bar(b->shape) && !has_best_points(b->shape)) has[2 * b->region + 1] = 1;
  }
  s.comm->sum(has);
  std::vector<int> degree(n_regions);
  for (size_t r = 0; r < n_regions; ++r) degree[r] = has[2 * r] == 0 ? 1 : has[2 * r + 1] > 0 ? 2 : 3;
  for (const int d : {1, 2, 3}) patches_.push_back(made_patches(d, degree));
}

void StressRecovery::find_sites() {
  const System& s = system_;
  std::vector<std::int64_t> key;
  std::unordered_map<std::int64_t, int> index;
  for (const SolidBatch* batch : batches_) {
    const SolidBatch& b = *batch;
    auto& of = site_of_.emplace_back();
    const int region = 2 * b.region + is_bar(b.shape);
    for (const int node : b.nodes) {
      const std::int64_t k = region * s.mesh->n_nodes_global + s.mesh->node_global[node];
      const auto [it, fresh] = index.try_emplace(k, static_cast<int>(key.size()));
      if (fresh) key.push_back(k), site_.push_back({node, region});
      of.push_back(it->second);
    }
  }
  sites_.emplace(*s.comm, key);
}

StressRecovery::Patches StressRecovery::made_patches(int degree, const std::vector<int>& degree_of_region) const {
  const System& s = system_;
  std::vector<int> nodes;
  std::vector<std::vector<int>> corners_of(batches_.size());
  std::vector<std::int64_t> key;
  std::unordered_map<std::int64_t, int> index;
  for (size_t b = 0; b < batches_.size(); ++b) {
    const SolidBatch& batch = *batches_[b];
    if (is_bar(batch.shape) || degree_of_region[batch.region] != degree) continue;
    const int n = info(batch.shape).n_nodes, corners = info(batch.shape).n_corners;
    for (size_t e = 0; e < batch.cells.size(); ++e)
      for (int a = 0; a < corners; ++a) {
        const int node = batch.nodes[e * n + a];
        const std::int64_t k = batch.region * s.mesh->n_nodes_global + s.mesh->node_global[node];
        const auto [it, fresh] = index.try_emplace(k, static_cast<int>(key.size()));
        if (fresh) key.push_back(k), nodes.push_back(node);
        corners_of[b].push_back(it->second);
      }
  }
  Patches p{degree, std::move(nodes), {}, std::move(corners_of), Sharing(*s.comm, key)};
  const size_t n = key.size();
  std::vector<double> shape(n * PatchFit::n_shape, 0.0);
  std::vector<StressPoint> points;
  std::vector<Vec3> samples;
  const auto sample = [&](const Cell& at) {
    at.points(StressPoints::samples, points);
    samples.clear();
    if (degree > 1 && quadratic(at.batch->shape))
      for (const StressPoint& q : points) samples.push_back(q.X);
    else
      samples.push_back(LinearCellMean(points).X);
  };
  each_cell(p, nullptr, [&](size_t, size_t, std::span<const int> corner, const Cell& at) {
    sample(at);
    at.points(StressPoints::everywhere, points);
    for (const int v : corner) {
      double* to = shape.data() + static_cast<size_t>(v) * PatchFit::n_shape;
      for (const Vec3& X : samples) PatchFit::add_sample(X - s.X[p.node[v]], to);
      for (const StressPoint& q : points) PatchFit::add_extent(q.X - s.X[p.node[v]], q.w, to);
    }
  });
  p.sharing.combine(shape, PatchFit::n_shape);
  p.fit.reserve(n);
  for (size_t v = 0; v < n; ++v) p.fit.emplace_back(p.degree, shape.data() + v * PatchFit::n_shape);
  const int width = PatchFit::n_moments(p.degree);
  std::vector<double> moments(n * width, 0.0);
  each_cell(p, nullptr, [&](size_t, size_t, std::span<const int> corner, const Cell& at) {
    sample(at);
    for (const int v : corner)
      for (const Vec3& X : samples) p.fit[v].add_moments(X - s.X[p.node[v]], moments.data() + static_cast<size_t>(v) * width);
  });
  p.sharing.combine(moments, width);
  for (size_t v = 0; v < n; ++v) p.fit[v].finish(moments.data() + v * width);
  return p;
}

/// Polynomials of all patches about their corners (n x rows x 6).
std::vector<double> StressRecovery::polynomials(const Patches& p, const Config& q, const Memory& memory) const {
  const size_t n = p.node.size(), width = PatchFit::n_sums(p.degree), size = static_cast<size_t>(PatchFit::n_rows(p.degree)) * 6;
  std::vector<double> sums(n * width, 0.0), polynomial(n * size);
  std::vector<StressPoint> points;
  each_cell(p, &q, [&](size_t b, size_t e, std::span<const int> corner, const Cell& at) {
    const SolidBatch& batch = *batches_[b];
    at.points(StressPoints::samples, points, of_cell(batch, memory, b, e));
    if (p.degree > 1 && quadratic(batch.shape)) {
      for (const int v : corner)
        for (const StressPoint& q : points) p.fit[v].add_stress(q.X - system_.X[p.node[v]], q.S, sums.data() + v * width);
    } else {
      const LinearCellMean cell(points);
      for (const int v : corner) {
        p.fit[v].add_stress(cell.X - system_.X[p.node[v]], cell.S, sums.data() + v * width);
        if (p.degree == 1) PatchFit::add_slope(cell.slope, sums.data() + v * width);
      }
    }
  });
  p.sharing.combine(sums, static_cast<int>(width));
  for (size_t v = 0; v < n; ++v) p.fit[v].solve(sums.data() + v * width, polynomial.data() + v * size);
  return polynomial;
}

namespace {

/// Mean of the polynomials of a cell's corners: of the fullest patches alone, and the more the deeper a corner lies inside the region.
class CellPolynomial {
 public:
  CellPolynomial(const System& s, const std::vector<int>& node, const std::vector<PatchFit>& fit, const double* polynomial, int rows,
                 std::span<const int> corner) {
    int best = 0;
    for (const int v : corner) best = std::max(best, fit[v].rank());
    double least = 1e300, sum = 0;
    for (const int v : corner)
      if (fit[v].rank() == best) least = std::min(least, fit[v].off_centre2());
    for (const int v : corner) {
      if (fit[v].rank() < best) continue;
      const double w = std::exp(-2 * (fit[v].off_centre2() - least));
      terms_.push_back({s.X[node[v]], w, fit[v], polynomial + static_cast<size_t>(v) * rows * 6});
      sum += w;
    }
    for (Term& t : terms_) t.weight /= sum;
  }
  Vec6 operator()(const Vec3& X) const {
    Vec6 S = Vec6::Zero();
    for (const Term& t : terms_) t.fit.add_at(t.p, X - t.centre, t.weight, S);
    return S;
  }

 private:
  struct Term {
    Vec3 centre;
    double weight;
    const PatchFit& fit;
    const double* p;
  };
  std::vector<Term> terms_;
};

constexpr int n_values = 17;  // of a site: cells, S, F, plastic strain
constexpr int n_passes = 2;   // over what the samples of quadratic hexahedra miss

}  // namespace

/// Samples (n_cells x n_samples x 6 of each batch) against the stress at the sites, interpolated: what is missed goes to the nodes as the
/// samples did.
void StressRecovery::add_missed(const std::vector<std::vector<double>>& samples, std::vector<double>& at_site) const {
  std::vector<double> change(site_.size() * 6, 0.0);
  std::vector<StressPoint> points;
  Cell first;
  for (size_t b = 0; b < batches_.size(); ++b) {
    const SolidBatch& batch = *batches_[b];
    if (samples[b].empty()) continue;
    look_at(first, b, 0, nullptr);
    first.points(StressPoints::samples, points);
    const int n = info(batch.shape).n_nodes, m = static_cast<int>(points.size());
    Eigen::MatrixXd N(n, m), nodal(6, n), missed(6, m);
    for (int k = 0; k < m; ++k) N.col(k) = Eigen::Map<const Eigen::VectorXd>(points[k].N, n);
    const Eigen::MatrixXd back = to_nodes(batch.shape, points.size()).transpose();
    for (size_t e = 0; e < batch.cells.size(); ++e) {
      const int* site = site_of_[b].data() + e * n;
      for (int a = 0; a < n; ++a) nodal.col(a) = Eigen::Map<const Vec6>(at_site.data() + static_cast<size_t>(site[a]) * n_values + 1);
      missed = Eigen::Map<const Eigen::MatrixXd>(samples[b].data() + e * m * 6, 6, m);
      missed.noalias() -= nodal * N;
      nodal.noalias() = missed * back;
      for (int a = 0; a < n; ++a) Eigen::Map<Vec6>(change.data() + static_cast<size_t>(site[a]) * 6) += nodal.col(a);
    }
  }
  sites_->combine(change, 6);
  for (size_t i = 0; i < site_.size(); ++i)
    for (int c = 0; c < 6; ++c) at_site[i * n_values + 1 + c] += change[i * 6 + c] / at_site[i * n_values];
}

void StressRecovery::find_free_sides() {
  const System& s = system_;
  free_sides_.resize(batches_.size());
  double any = 0;
  for (const SolidBatch* b : batches_)
    if (b->shape == shell8) any = 1;
  any_shells_ = s.comm->max(any) > 0;
  if (!any_shells_) return;
  std::unordered_map<std::int64_t, std::vector<Facet>> of_cell;
  for (const Facet& f : region_surface(*s.mesh, *s.comm)) of_cell[f.cell].push_back(f);
  for (size_t b = 0; b < batches_.size(); ++b) {
    const SolidBatch& batch = *batches_[b];
    if (batch.shape != shell8) continue;
    free_sides_[b].assign(batch.cells.size(), 0);
    for (size_t e = 0; e < batch.cells.size(); ++e)
      for (const Facet& f : of_cell[batch.cells[e]]) {
        const auto nodes = s.mesh->mesh.facet_nodes(f);
        for (int k = 0; k < 4; ++k) {
          const int* node = batch.nodes.data() + e * 8;
          if (std::ranges::all_of(std::array{k, (k + 1) % 4, k + 4, (k + 1) % 4 + 4},
                                  [&](int a) { return std::ranges::find(nodes, node[a]) != nodes.end(); }))
            free_sides_[b][e] |= 1U << k;
        }
      }
  }
}

/// `own` of the shells' cells (n_cells x 8 x 6 of each batch); value: six numbers of each site, `stride` apart.  Collective.
void StressRecovery::go_on_to_edges(const std::vector<std::vector<double>>& own, const std::vector<double>& at_site, double* value,
                                    int stride) const {
  std::vector<double> change(site_.size() * 6, 0.0);
  for (size_t b = 0; b < batches_.size(); ++b)
    for (size_t e = 0; e < free_sides_[b].size(); ++e)
      for (int k = 0; k < 4; ++k)
        for (int a = k; (free_sides_[b][e] >> k & 1U) && a < k + 2; ++a)
          for (const int up : {0, 4}) {
            const int here = a % 4 + up, across = (a == k ? k + 3 : k + 2) % 4 + up;
            const auto to = static_cast<size_t>(site_of_[b][e * 8 + here]), from = static_cast<size_t>(site_of_[b][e * 8 + across]);
            for (size_t c = 0; c < 6; ++c)
              change[to * 6 + c] += own[b][(e * 8 + across) * 6 + c] - value[from * static_cast<size_t>(stride) + c];
          }
  sites_->combine(change, 6);
  for (size_t i = 0; i < site_.size(); ++i)
    for (size_t c = 0; c < 6; ++c) value[i * static_cast<size_t>(stride) + c] += change[i * 6 + c] / at_site[i * n_values];
}

/// Bars have their own stress alone: the sums of its components and of their von Mises stresses.
void StressRecovery::add_bars(const Config& q, std::vector<double>& at, std::vector<double>& cell) const {
  Cell ends;
  for (size_t b = 0; b < batches_.size(); ++b) {
    const SolidBatch& batch = *batches_[b];
    for (size_t e = 0; is_bar(batch.shape) && e < batch.cells.size(); ++e) {
      look_at(ends, b, e, &q);
      const Vec6 stress = bar_stress(batch.material, ends.X, ends.x);
      cell[batch.cells[e]] = von_mises(stress);
      for (const int end : {0, 1}) {
        double* to = at.data() + static_cast<size_t>(site_of_[b][2 * e + end]) * n_values;
        to[0] += 1, to[7] += von_mises(stress);
        for (int c = 0; c < 6; ++c) to[1 + c] += stress[c];
      }
    }
  }
}

StressRecovery::Result StressRecovery::recover(const Config& q, const Memory& memory, bool shells) const {
  const System& s = system_;
  for (const int node : carried_) {
    const int body = s.follower[node];
    if (body < 0 || !s.bodies[body].linear) {
      placed_[node] = s.at(q, node);
      continue;
    }
    placed_[node] = s.X[node];
    const auto shapes = s.shapes_at(node);
    const int first = s.modes[s.modes_of[body]].first;
    for (size_t j = 0; j < shapes.size(); ++j) placed_[node] += q.eta[first + j / 3][j % 3] * shapes[j];
  }
  Result out;
  out.cell.assign(s.mesh->mesh.n_cells(), 0.0), out.cell_plastic = out.cell;
  std::vector<double> at_site(site_.size() * n_values, 0.0);
  std::vector<std::vector<double>> samples(batches_.size());                            // of quadratic hexahedra
  std::vector<double> through(shells ? site_.size() * 6 : 0, 0.0);                      // stress with the mean and moment of shells' points
  std::vector<std::vector<double>> own(batches_.size()), own_through(batches_.size());  // of shells (n_cells x 8 x 6)
  std::vector<StressPoint> points;
  std::vector<Mat3> F;
  for (const Patches& p : patches_) {
    const auto polynomial = polynomials(p, q, memory);
    each_cell(p, &q, [&](size_t b, size_t e, std::span<const int> corner, const Cell& at) {
      const SolidBatch& batch = *batches_[b];
      const CellPolynomial P(s, p.node, p.fit, polynomial.data(), PatchFit::n_rows(p.degree), corner);
      at.points(StressPoints::samples, points, of_cell(batch, memory, b, e));
      for (size_t k = 0; p.degree == 3 && k < points.size(); ++k)
        samples[b].insert(samples[b].end(), points[k].S.data(), points[k].S.data() + 6);
      Eigen::Matrix<double, 6, Eigen::Dynamic> rest(6, points.size());
      for (size_t q = 0; q < points.size(); ++q) rest.col(q) = points[q].S - P(points[q].X);
      const Eigen::Matrix<double, 6, Eigen::Dynamic> extrapolated = rest * to_nodes(batch.shape, points.size()).transpose();
      Eigen::VectorXd plastic(points.size());
      for (size_t q = 0; q < points.size(); ++q) plastic[q] = points[q].plastic;
      const Eigen::VectorXd plastic_at_nodes = to_nodes(batch.shape, points.size()) * plastic;
      F.resize(at.X.size());
      at.gradients(F);
      for (size_t a = 0; a < at.X.size(); ++a) {
        double* to = at_site.data() + static_cast<size_t>(site_of_[b][e * at.X.size() + a]) * n_values;
        const Vec6 S = P(at.X[a]) + extrapolated.col(a);
        to[0] += 1;
        for (int c = 0; c < 6; ++c) to[1 + c] += S[c];
        for (int c = 0; c < 9; ++c) to[7 + c] += F[a].data()[c];
        to[16] += plastic_at_nodes[a];
        if (batch.shape == shell8) own[b].insert(own[b].end(), S.data(), S.data() + 6);
      }
      if (!shells || batch.shape != shell8) return;
      const Eigen::Matrix<double, 6, 8> linear = rest * shell_moments_to_nodes(points.size()).transpose();
      for (int a = 0; a < 8; ++a) {
        const Vec6 S = P(at.X[a]) + linear.col(a);
        Eigen::Map<Vec6>(through.data() + static_cast<size_t>(site_of_[b][e * 8 + a]) * 6) += S;
        own_through[b].insert(own_through[b].end(), S.data(), S.data() + 6);
      }
    });
  }
  add_bars(q, at_site, out.cell);
  sites_->combine(at_site, n_values);
  for (size_t i = 0; i < site_.size(); ++i)
    for (int c = 1; c < n_values; ++c) at_site[i * n_values + c] /= at_site[i * n_values];
  for (int pass = 0; pass < n_passes; ++pass) add_missed(samples, at_site);
  if (any_shells_) go_on_to_edges(own, at_site, at_site.data() + 1, n_values);
  if (any_shells_ && shells) {
    sites_->combine(through, 6);
    for (size_t i = 0; i < through.size(); ++i) through[i] /= at_site[i / 6 * n_values];
    go_on_to_edges(own_through, at_site, through.data(), 6);
  }

  std::vector<double> error(2 * site_.size(), 0.0);  // sum over the cells of V e^2 and of V
  for (const Patches& p : patches_)
    each_cell(p, &q, [&](size_t b, size_t e, std::span<const int>, const Cell& at) {
      const SolidBatch& batch = *batches_[b];
      const int* site = site_of_[b].data() + e * at.X.size();
      at.points(StressPoints::integration, points, of_cell(batch, memory, b, e));
      double& mean = out.cell[batch.cells[e]];
      for (const StressPoint& q : points) {
        mean += von_mises(cauchy(q.F, q.S)) / static_cast<double>(points.size());
        out.cell_plastic[batch.cells[e]] += q.plastic / static_cast<double>(points.size());
      }
      if (!has_one_set_of_points(batch.shape, batch.kernel.n_state > 0)) at.points(StressPoints::everywhere, points);
      double square = 0, volume = 0;
      for (const StressPoint& q : points) {
        Vec6 off = -q.S;
        for (size_t a = 0; a < at.X.size(); ++a)
          off += q.N[a] * Eigen::Map<const Vec6>(at_site.data() + static_cast<size_t>(site[a]) * n_values + 1);
        const double vm = von_mises(cauchy(q.F, off));
        square += q.w * vm * vm, volume += q.w;
      }
      for (size_t a = 0; a < at.X.size(); ++a) error[2 * site[a]] += square, error[2 * site[a] + 1] += volume;
    });
  sites_->combine(error, 2);
  for (size_t i = 0; i < site_.size(); ++i) {
    const double* v = at_site.data() + i * n_values;
    const Eigen::Map<const Vec6> S(v + 1);
    const bool bar = site_[i].region % 2;
    out.stress.push_back(bar ? Vec6(S) : cauchy(Eigen::Map<const Mat3>(v + 7), S));
    out.von_mises.push_back(bar ? v[7] : von_mises(out.stress.back()));
    out.plastic.push_back(std::max(0.0, v[16]));  // what is extrapolated may fall below
    out.error.push_back(bar ? 0 : std::sqrt(error[2 * i] / error[2 * i + 1]));
  }
  if (shells) add_shells(at_site, through, out);
  return out;
}

}  // namespace hilo
