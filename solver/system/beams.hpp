// SPDX-License-Identifier: GPL-3.0-or-later
// Beams: arc elements between sections, which are bodies of their own or ride on others at an offset and a turn that stay.
//
// The mass of an element couples its two sections.  It is constant in their points x = (c, d1, d2, d3), so a step keeps energy and both
// momenta: along the axis  c = (1 - t + g) c_A + (t - g) c_B + L (t - t^2)/2 (d3A - d3B) + L g/2 (d3A + d3B)  with
// g = (2 t^3 - 3 t^2 + t)/(1 + Phi), Phi = 12 EI/(GA L^2); of d1 and d2 the mean of a consistent and a lumped one.
#pragma once
#include <array>
#include <vector>

#include "physics/beam_arc.hpp"
#include "physics/beam_cell.hpp"
#include "physics/beam_section.hpp"
#include "physics/section_mesh.hpp"
#include "system/contribution.hpp"
#include "system/loads.hpp"

namespace hilo {

struct BeamCell {
  std::array<int, 2> body{};
  arc::ArcCell<double> arc;
  /// int u (1 - t)^2 ds, int u t (1 - t) ds, int u t^2 ds, u the shares of the points of the sections in a point at t [m, m^2]: across the
  /// axis as the cell bends, and along it as it stretches
  using Shares = std::array<Eigen::Matrix<double, 8, 1>, 3>;
  Shares across, along;
  Vec3 axis;        // as drawn
  double size = 0;  // of the section [m]
};

struct Beam {
  std::string name;
  int first = 0, n_cells = 0;  // of the list
};

/// Sections at the places along_arc of a cell.
using SectionsAlong = std::array<BeamSection, along_arc.size()>;
BeamSection mean_section(const SectionsAlong& sections);

/// A meshed section of the scene.
struct NamedSection {
  std::string name;
  SectionMesh mesh;
};

/// A force per length on the cells of a beam, linear along each cell: in inertial axes, or in axes of the sections, which it then turns
/// with.
struct LineLoad {
  Load load;
  int first = 0;
  std::vector<std::array<Vec3, 2>> at;  // both ends of each cell [N/m]
};

/// Where a section is in the reference configuration: its origin, directors by columns, and the body that it rides on.
struct SectionPlace {
  Vec3 at;
  Mat3 frame;
  int body;
};

class Beams final : public Contribution, public Equations, public Stateful, public Observer {
 public:
  explicit Beams(const Points& points) : points_(points) {}
  std::vector<Beam> beams;
  std::vector<BeamCell> cells;
  std::vector<LineLoad> lines;
  std::vector<NamedSection> meshes;
  void add_cell(const SectionPlace& a, const SectionPlace& b, const SectionsAlong& sections, double beta, double alpha);
  /// w.M v of what is at a body [J].
  double inertia(int body, const Config& v, const Vec3& w, const Mat3& W) const;

  Traits traits() const override { return {.deforms = !cells.empty(), .has_rates = !cells.empty()}; }
  std::string count() const override;
  void prepare() override;
  void number(Layout& layout) override;
  void evaluate(Pass& p) const override;
  void add_energy(const Config& q, const Config& v, Energy& sum) const override;
  void add_work(const Moment& m, Work& sum) const override;
  std::string fault(const Config& q) const override;
  std::vector<Output> outputs() const override;
  void observe(const Sight& at) override;
  void tie(Ties& ties) const override;

 private:
  /// What loads by length exert on the points of a cell's sections: F + K y, of the points y.
  struct LineForces {
    Eigen::Matrix<double, 8, 3, Eigen::RowMajor> F = Eigen::Matrix<double, 8, 3, Eigen::RowMajor>::Zero();
    Eigen::Matrix<double, 8, 8, Eigen::RowMajor> K = Eigen::Matrix<double, 8, 8, Eigen::RowMajor>::Zero();
  };
  /// On each cell; empty without such loads.
  std::vector<LineForces> line_forces(const Stage& s) const;
  /// What the kernel found of a cell, one number in every `width`: see ArcCall.
  struct Found {
    int width;
    const double *f, *scale2, *K;
  };
  /// Calls use(cell, found) for the cells of this rank, or for all.
  template <class Use>
  void each_cell(const Stage& s, const std::vector<LineForces>& line, bool with_tangent, bool on_all, const Use& use) const;

  /// A cache line.
  struct alignas(64) Line {
    double v[8];
  };
  /// Cells as the kernel takes them, `width` at once, filled up by the last.
  struct Lanes {
    ArcKernel kernel{};
    std::vector<Line> data;                  // arc::ArcCell of each batch
    std::vector<std::array<int, 2>> bodies;  // of each lane
    std::vector<int> cell;                   // of each lane; -1: fills up
    bool has_beta = false, has_alpha = false;
  };
  Lanes packed(const std::vector<int>& list) const;
  Lanes own_, all_;  // of this rank; of all, where these are more: what a lane rounds may depend on its neighbours
  const Points& points_;
  std::vector<int> clique_;
};

}  // namespace hilo
