// SPDX-License-Identifier: GPL-3.0-or-later
// Beams: arc elements between sections, which are bodies of their own or ride on others at an offset and a turn that stay.
//
// The mass of an element couples its two sections.  It is constant in their points, so a step keeps energy and both momenta.
#pragma once
#include <array>
#include <functional>

#include "physics/section_mesh.hpp"
#include "system/beam_cells.hpp"
#include "system/contribution.hpp"

namespace hilo {

/// A meshed section of the scene.
struct NamedSection {
  std::string name;
  SectionMesh mesh;
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

/// Calls use(bodies) with the bodies at both ends of every cell of beams that deform by themselves.
void each_cell_of_beams(const System& system, const std::function<void(const std::array<int, 2>&)>& use);

}  // namespace hilo
