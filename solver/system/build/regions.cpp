// SPDX-License-Identifier: GPL-3.0-or-later
// Regions: material, mass integrals, rigid super-elements, batches of flexible cells.
#include <fmt/format.h>
#include <fnmatch.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <set>

#include "model/region_surface.hpp"
#include "model/scaled_jacobian.hpp"
#include "model/thin_regions.hpp"
#include "system/build/builder.hpp"
#include "system/contact/contact_entries.hpp"
#include "system/solids.hpp"

namespace hilo {
namespace {

const char* const give_material = "give it with [region.NAME] material = \"...\" and [material....]";

}  // namespace

/// Nodes that a step asks for come first: those of nonlinear cells, and of every set (or linear region) that an entry names.  Joints and
/// springs ask for none: they act on bodies.  Most loads ask for none of a rigid region.  The others follow where results want them.
std::int64_t Builder::put_active_nodes_first() {
  const Mesh& mesh = mesh_->mesh;
  std::vector<char> active(mesh.X.size(), 0), in_cell(mesh.X.size(), 0), rigid(mesh.X.size(), 0);
  for (std::int64_t e = 0; e < mesh.n_cells(); ++e)
    for (const std::int64_t i : mesh.cell(e)) {
      in_cell[i] = 1;
      if (mesh_->fidelity[mesh.region[e]] == Fidelity::nonlinear) active[i] = 1;
      if (mesh_->fidelity[mesh.region[e]] == Fidelity::rigid) rigid[i] = 1;
    }
  for (size_t i = 0; i < active.size(); ++i)
    if (!in_cell[i]) active[i] = 1;
  enum class Asked { body, what_deforms, all };
  std::map<std::string_view, Asked> named;
  const auto asks = [](const Entry& e) {
    if (e.section == "joint" || e.section == "spring") return Asked::body;
    return e.section == "load" && e.kind != "torque" && e.kind != "line" ? Asked::what_deforms : Asked::all;
  };
  std::set<std::string_view> sections;
  for (const KindSchema& kind : scene_schema()) sections.insert(kind.section);
  for (const char* asks_nothing : {"material", "quantity", "region", "set"}) sections.erase(asks_nothing);
  for (const std::string_view section : sections)
    for (const Entry& e : scene_.entries(section))
      for (const auto& [key, value] : e.values)
        for (const std::string& text : value.texts)
          if (key != "name") named[text] = std::max(named[text], asks(e));
  for (const std::string& name : mesh.all_names()) {
    const auto it = named.find(name);
    const int region = mesh.find_region(name);
    if (it == named.end() || it->second == Asked::body || (region >= 0 && mesh_->fidelity[region] != Fidelity::linear)) continue;
    for (const std::int64_t i : mesh_->nodes_of(name, ""))
      if (it->second == Asked::all || !rigid[i]) active[i] = 1;
    if (const auto facets = mesh.facet_sets.find(name); facets != mesh.facet_sets.end())
      for (const Facet& f : facets->second)
        if (mesh_->fidelity[mesh.region[f.cell]] != Fidelity::rigid)
          for (const std::int64_t i : mesh.facet_nodes(f)) active[i] = 1;
  }
  for (size_t b = 0; b < mesh.block_name.size(); ++b)
    if (named.contains(mesh.block_name[b]))
      for (size_t i = 0; i < active.size(); ++i)
        if (mesh.block[i] == static_cast<std::int64_t>(b)) active[i] = 1;
  std::set<int> meet;  // rigid regions, and those that no text names: their surfaces meet others
  const auto take_sides = [&](const Entry& e, bool of_all) {
    for (const char* side : {"a", "b"})
      if (const int r = mesh.find_region(e.text(side)); r >= 0 && (of_all || mesh_->fidelity[r] == Fidelity::rigid)) meet.insert(r);
  };
  for (const ContactEntry& pair : contact_entries(scene_, mesh_, comm_)) take_sides(pair.entry, pair.of_all);
  for (const Entry& e : scene_.entries("tie")) take_sides(e, false);
  if (!meet.empty())
    for (const Facet& f : outer_surface(*mesh_, comm_))
      if (meet.contains(mesh.region[f.cell]))
        for (const std::int64_t i : mesh.facet_nodes(f)) active[i] = 1;
  return mesh_->put_first(active);
}

void Builder::read_regions() {
  if (!mesh_) return;
  const auto thin = mesh_->file.empty() ? std::vector<ThinRegion>{} : read_thin_regions(mesh_->file);
  const auto entries = scene_.entries("region");
  std::map<std::string_view, size_t> plain;  // entries of names without wild cards
  std::vector<size_t> globs;
  for (size_t k = 0; k < entries.size(); ++k)
    if (entries[k].name.find_first_of("*?[\\") == std::string::npos)
      plain.emplace(entries[k].name, k);
    else
      globs.push_back(k);
  std::vector<char> used(entries.size(), 0);
  for (size_t r = 0; r < mesh_->mesh.region_name.size(); ++r) {
    Region region;
    region.name = mesh_->mesh.region_name[r];
    for (const Entry& e : scene_.entries("motion"))
      if (e.text("on") == region.name && mesh_->fidelity[r] == Fidelity::linear &&
          (!e.has("components") || e.texts("components").size() == 3))
        mesh_->fidelity[r] = Fidelity::rigid;  // moved as a whole: nothing of it can bend
    region.fidelity = mesh_->fidelity[r];
    const RegionData& deck = mesh_->mesh.region_data[r];
    region.E = deck.E, region.nu = deck.nu, region.density = deck.density;
    if (!thin.empty() && thin[r].any() && region.fidelity != Fidelity::rigid)
      throw Error(mesh_->file,
                  fmt::format("region \"{}\" is {}, and has shells or beams: there is no element of them, it can be rigid alone",
                              region.name, word(region.fidelity)),
                  fmt::format("hilo-tag --rigid '{}'", region.name));
    std::string material;
    std::vector<size_t> its;
    if (const auto own = plain.find(region.name); own != plain.end()) its.push_back(own->second);
    for (const size_t k : globs)
      if (fnmatch(entries[k].name.c_str(), region.name.c_str(), 0) == 0) its.push_back(k);
    std::sort(its.begin(), its.end());
    for (const size_t k : its) {
      const Entry& e = entries[k];
      used[k] = 1, region.place = e.place.text();
      if (e.given("material")) material = e.text("material"), region.where = e.where("material");
      if (e.given("mass")) region.mass_wanted = e.number("mass");
      if (e.given("area")) region.area = e.number("area");
      if (e.given("damping")) region.beta = e.number("damping");
      if (e.given("mass_damping")) region.alpha = e.number("mass_damping");
      if (e.given("modal_damping")) region.modal_damping = e.number("modal_damping");
      if (e.given("modes")) region.n_vibrations = static_cast<int>(e.number("modes")), region.modes_given = true;
      if (e.given("shapes")) region.shapes = e.text("shapes"), region.shapes_where = e.where("shapes");
      if (e.given("interface")) region.interface = &e;
      if (e.given("up_to")) region.up_to = e.number("up_to");
      if (e.given("shell")) region.shell = e.boolean("shell"), region.shell_where = e.where("shell");
      if (e.given("stiffening")) region.stiffening = e.boolean("stiffening");
    }
    if (!material.empty()) {
      const Entry* found = nullptr;
      std::vector<std::string> names;
      for (const Entry& m : scene_.entries("material")) {
        names.push_back(m.name);
        if (m.name == material) found = &m;
      }
      if (!found) throw Error(region.where, fmt::format("no material \"{}\"", material), suggest(material, names));
      region.material = found;
      if (found->has("E")) region.E = found->number("E");
      if (found->has("nu")) region.nu = found->number("nu");
      if (found->has("density")) region.density = found->number("density");
      region.where = found->place.text();
    }
    if (region.where.empty()) region.where = scene_.path;
    if (region.place.empty()) region.place = scene_.path;
    regions_.push_back(std::move(region));
  }
  for (size_t k = 0; k < entries.size(); ++k) {
    const Entry& e = entries[k];
    if (!used[k]) throw Error(e.place.text(), fmt::format("no region matches \"{}\"", e.name), suggest(e.name, mesh_->mesh.region_name));
    warn_of_idle_damping(e);
  }
}

/// Warns of keys of damping without effect on any region that they are given for.
void Builder::warn_of_idle_damping(const Entry& e) const {
  const auto tell = [&](const char* key, auto&& feels, const char* why) {
    if (comm_.rank != 0 || !e.given(key) || e.number(key) == 0) return;
    constexpr int shown = 3;
    std::string names;
    int count = 0;
    for (const Region& r : regions_) {
      if (fnmatch(e.name.c_str(), r.name.c_str(), 0) != 0) continue;
      if (feels(r.fidelity)) return;
      if (++count <= shown) names += (names.empty() ? "\"" : ", \"") + r.name + "\" (" + std::string(word(r.fidelity)) + ")";
    }
    if (count > shown) names = fmt::format("{} regions ({}, ...)", count, names);
    warn(e.where(key), fmt::format("has no effect on {}: {}", names, why));
  };
  tell(
      "damping", [](Fidelity f) { return f != Fidelity::rigid; }, "rigid regions do not deform; mass_damping brakes them");
  tell(
      "modal_damping", [](Fidelity f) { return f == Fidelity::linear; },
      "only linear regions have modes; use damping or mass_damping for the others");
}

/// int rho, int rho X, int rho X X^T of every region by the mass rule of its cells: the collapsed mass of a rigid region is exactly
/// sum N^T M_e N over its elements [taylor-2001].
void Builder::integrate_regions() {
  if (!mesh_) return;
  const Mesh& mesh = mesh_->mesh;
  const auto thin = mesh_->file.empty() ? std::vector<ThinRegion>{} : read_thin_regions(mesh_->file);
  double lo[3] = {1e300, 1e300, 1e300}, hi[3] = {-1e300, -1e300, -1e300};
  for (const Vec3& x : mesh.X)
    for (int i = 0; i < 3; ++i) lo[i] = std::min(lo[i], x[i]), hi[i] = std::max(hi[i], x[i]);
  for (int i = 0; i < 3; ++i) origin_[i] = (comm_.max(hi[i]) - comm_.max(-lo[i])) / 2;
  const int W = lanes();
  const StVenantKirchhoff no_matter{{1, 1}};  // the mass alone is asked for
  struct alignas(64) Line {                   // as the widest kernels load them
    double value[8];
  };
  std::vector<Line> scratch;
  std::int64_t inverted = -1;
  for (std::int64_t e = 0; e < mesh.n_cells(); ++e) {
    Region& r = regions_[mesh.region[e]];
    if (inverted < 0 && info(mesh.shape[e]).dimension == 3 && !(scaled_jacobian(mesh, e) > 0)) inverted = e;
    if (const int dimension = info(mesh.shape[e]).dimension;
        dimension == 2 || (dimension == 1 && !thin.empty() && thin[mesh.region[e]].any()))
      continue;  // a shell or beam, which the region's moments have
    const double density = std::isnan(r.density) ? 0 : r.density;
    const auto nodes = mesh.cell(e);
    const SolidKernel kernel = solid_kernel(static_cast<Shape>(mesh.shape[e]), place_of<StVenantKirchhoff>);
    const int n3 = 3 * static_cast<int>(nodes.size()), w = std::min(W, kernel.width);
    scratch.resize(9 * nodes.size());
    double *X = scratch[0].value, *a = scratch[n3].value, *f = scratch[2 * static_cast<size_t>(n3)].value;
    const auto integrate = [&](auto&& value) {
      for (int i = 0; i < n3; ++i)
        for (int l = 0; l < w; ++l) X[i * w + l] = mesh.X[nodes[i / 3]][i % 3] - origin_[i % 3], a[i * w + l] = value(i);
      kernel.call({X, X, X, 0, 0, &no_matter, f, nullptr, nullptr, nullptr, nullptr, density, a, 0, r.area});
    };
    integrate([](int i) { return i % 3 == 0 ? 1.0 : 0.0; });
    for (int i = 0; i < n3; i += 3) r.mass += f[i * w];
    integrate([&](int i) { return mesh.X[nodes[i / 3]][i % 3] - origin_[i % 3]; });
    for (int i = 0; i < n3; i += 3) {
      const Vec3 fa(f[i * w], f[(i + 1) * w], f[(i + 2) * w]);
      r.moment += fa;
      r.second += (mesh.X[nodes[i / 3]] - origin_) * fa.transpose();
    }
  }
  comm_.together([&] {
    if (inverted >= 0)
      throw Error(mesh_->file, fmt::format("a cell of region \"{}\" is inside out", mesh.region_name[mesh.region[inverted]]),
                  "hilo-import --flip turns cells that are numbered as in a mirror");
  });
  for (Region& r : regions_) {
    double all[13] = {r.mass};
    for (int i = 0; i < 3; ++i) all[1 + i] = r.moment[i];
    for (int i = 0; i < 9; ++i) all[4 + i] = r.second(i / 3, i % 3);
    comm_.sum(all);
    r.mass = all[0];
    for (int i = 0; i < 3; ++i) r.moment[i] = all[1 + i];
    for (int i = 0; i < 9; ++i) r.second(i / 3, i % 3) = all[4 + i];
    if (const auto i = static_cast<size_t>(&r - regions_.data()); !thin.empty() && thin[i].any() && !std::isnan(r.density)) {
      const double V = thin[i].volume();
      const Vec3 first = thin[i].first();
      r.mass += r.density * V, r.moment += r.density * (first - V * origin_);  // moments about `origin_` from those about the origin
      r.second +=
          r.density * (thin[i].second() - first * origin_.transpose() - origin_ * first.transpose() + V * origin_ * origin_.transpose());
    }
    if (r.mass_wanted > 0) {
      if (!(r.mass > 0))
        throw Error(r.where, fmt::format("region \"{}\" has a mass but no density to scale", r.name), "give its material a density");
      const double s = r.mass_wanted / r.mass;
      r.density *= s, r.mass *= s, r.moment *= s, r.second *= s;
    }
    out_->mass += r.mass;
  }
}

/// The law of a region: its kind in the list of materials, its values from the scene, or from the deck.
Material Builder::material_of(const Region& r) const {
  const auto& kinds = material_kinds();
  const MaterialKind& kind = r.material ? kinds.at(r.material->kind, r.where) : kinds[0];
  const auto number = [&](std::string_view key) {
    const Param& p = *std::find_if(kind.keys.begin(), kind.keys.end(), [&](const Param& k) { return k.key == key; });
    const double value = key == "E"                           ? r.E
                         : key == "nu"                        ? r.nu
                         : r.material && r.material->has(key) ? r.material->number(key)
                                                              : std::nan("");
    const bool of_nothing = !r.material && std::isnan(r.E) && std::isnan(r.nu);
    const std::string_view what = of_nothing ? "material" : p.meaning.substr(0, p.meaning.find_first_of(",("));
    if (std::isnan(value)) throw Error(r.where, fmt::format("region \"{}\" has no {}", r.name, what), give_material);
    if (!p.range.contains(value))
      throw Error(r.where, fmt::format("region \"{}\": {} {} is not in {}", r.name, what, value, p.range.text()));
    return value;
  };
  const auto has = [&](std::string_view key) { return r.material && r.material->has(key); };
  const auto numbers = [&](std::string_view key) { return has(key) ? r.material->numbers(key) : std::vector<double>{}; };
  const auto refuse = [&](std::string_view key, const std::string& why) {
    throw Error(r.material ? r.material->where(key) : r.where, fmt::format("region \"{}\": {}", r.name, why));
  };
  return kind.make({has, number, numbers, refuse});
}

void Builder::make_batches() {
  if (!mesh_) return;
  const Mesh& mesh = mesh_->mesh;
  std::map<std::pair<int, int>, SolidBatch> by_kind;
  std::vector<std::int64_t> nodes;
  for (std::int64_t e = 0; e < mesh.n_cells(); ++e) {
    const Region& r = regions_[mesh.region[e]];
    if (r.fidelity != Fidelity::nonlinear) continue;
    SolidBatch& b = by_kind[{mesh.region[e], static_cast<int>(taken_as(e, nodes))}];
    b.cells.push_back(static_cast<int>(e));
    for (std::int64_t node : nodes) b.nodes.push_back(static_cast<int>(node));
  }
  std::vector<double> reduced(regions_.size(), 0.0);
  for (auto& [key, b] : by_kind) {
    SolidBatch made = batch_of(key.first, static_cast<Shape>(key.second));
    made.cells = std::move(b.cells), made.nodes = std::move(b.nodes);
    b = std::move(made);
    if (b.shape != static_cast<Shape>(key.second)) reduced[b.region] = 1;
    b.h0.assign(b.cells.size() * static_cast<size_t>(b.kernel.n_state), 0.0), b.h1 = b.h0;
    out_->stiffness =
        std::max(out_->stiffness, young_of(linear_moduli(b.material)) * (b.area > 0 ? b.area / mesh_->length : mesh_->length / 100));
    out_->part<Solids>().batches.push_back(std::move(b));
  }
  reduced_.swap(reduced);
  warn_of_limits();
}

namespace {

/// Infinite where a law never flows.
double yield_stress(const Material& m) {
  return std::visit(
      [](const auto& law) {
        if constexpr (requires { law.yield; })
          return law.yield;
        else
          return HUGE_VAL;
      },
      m);
}

}  // namespace

/// A batch of a region, without cells.
SolidBatch Builder::batch_of(int region, Shape shape) const {
  const Region& r = regions_[region];
  SolidBatch b;
  b.region = region;
  b.shape = shape;
  b.material = material_of(r), b.yield = yield_stress(b.material);
  if (r.fidelity == Fidelity::linear && r.stiffening && !std::holds_alternative<Orthotropic>(b.material))
    b.material = StVenantKirchhoff{linear_moduli(b.material)};  // strains of the second degree, stress linear in them
  const bool is_static = this->is_static();
  if (std::isnan(r.density) && !is_static) throw Error(r.where, fmt::format("region \"{}\" has no density", r.name), give_material);
  if (b.shape == Shape::bar2 && r.area <= 0)
    throw Error(r.where, fmt::format("region \"{}\" is made of bars and has no area", r.name), "give [region.NAME] area");
  b.density = std::isnan(r.density) ? 0 : r.density;
  b.beta = r.beta, b.alpha = r.alpha, b.area = r.area;
  b.kernel = solid_kernel(b.shape, law_index(b.material));
  if (b.kernel.n_state > 0 && b.shape == Shape::hex20) {  // 27 points are more conditions on the volume of flow than 20 nodes can meet
    b.shape = Shape::hex20r, b.kernel = solid_kernel(b.shape, law_index(b.material));
  }
  if (!b.kernel.call) {
    std::string have;
    for (size_t k = 0; k < material_kinds().size(); ++k)
      if (solid_kernel(b.shape, k).call) have += (have.empty() ? "" : ", ") + std::string(material_kinds()[k].name);
    throw Error(r.where,
                fmt::format("region \"{}\" is made of {}: kind = \"{}\" has none", r.name,
                            b.shape == Shape::bar2 ? "bars" : info(b.shape).name, kind_of(b.material).name),
                "kinds that have: " + have);
  }
  return b;
}

void Builder::add_free_bodies() {
  for (const Entry& e : scene_.entries("body")) {
    const int b = new_body(e.name, e.vector3("com"));
    Body& body = out_->bodies[b];
    body.mass = e.number("mass");
    const auto& J = e.numbers("inertia");
    if (J.size() != 3 && J.size() != 6) throw Error(e.where("inertia"), e.label() + ": inertia has 3 or 6 numbers");
    Mat3 inertia = Vec3(J[0], J[1], J[2]).asDiagonal();
    if (J.size() == 6) inertia(0, 1) = inertia(1, 0) = J[3], inertia(0, 2) = inertia(2, 0) = J[4], inertia(1, 2) = inertia(2, 1) = J[5];
    if (e.given("axes")) {
      if (e.numbers("axes").size() != 9) throw Error(e.where("axes"), e.label() + ": axes has nine numbers, the rows of a rotation");
      Mat3 A;
      for (int i = 0; i < 9; ++i) A(i / 3, i % 3) = e.numbers("axes")[i];
      if ((A * A.transpose() - Mat3::Identity()).norm() > 1e-6) throw Error(e.where("axes"), e.label() + ": axes is no rotation");
      inertia = A.transpose() * inertia * A;
    }
    body.J = inertia.trace() / 2 * Mat3::Identity() - inertia;
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(body.J);
    if (eigen.eigenvalues().minCoeff() < -1e-9 * inertia.norm())
      throw Error(e.where("inertia"), e.label() + ": no body has this inertia",
                  "each principal moment is at most the sum of the other two");
    body.size = std::sqrt(std::max(body.mass > 0 ? body.J.trace() / body.mass : 1.0, 1e-12));
    if (body_by_name_.contains(e.name) || (mesh_ && mesh_->mesh.find_region(e.name) >= 0))
      throw Error(e.where("name"), e.label() + ": a region of the mesh has this name too");
    body_by_name_[e.name] = b;
    out_->mass += body.mass;
  }
}

}  // namespace hilo
