// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/reduction/reduced_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/digest.hpp"
#include "model/inputs.hpp"
#include "model/schema.hpp"

namespace hilo {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using ByRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

std::string group_of(const std::string& region) { return "/reduced/" + to_link_name(region); }

/// The matrices that may be absent, by the names of their arrays.
struct Part {
  const char* name;
  Matrix Reduction::*matrix;
};
constexpr Part parts[] = {{"A", &Reduction::A},
                          {"A_damped", &Reduction::A_damped},
                          {"viscous", &Reduction::viscous},
                          {"sites", &Reduction::sites},
                          {"held", &Reduction::held},
                          {"shapes", &Reduction::shapes},
                          {"left_out", &Reduction::left_out},
                          {"soft", &Reduction::soft},
                          {"second_order", &Reduction::second_order}};

void write(Store& store, const std::string& array, const Matrix& m) {
  const auto& row = *find_array("reduced.h5", "/reduced/any/" + array.substr(array.rfind('/') + 1));
  const ByRows rows = m;
  store.write<double>(array, {rows.data(), static_cast<size_t>(rows.size())}, {m.rows(), m.cols()}, std::string(row.unit),
                      std::string(row.meaning));
}

Matrix read_matrix(const Store& store, const std::string& array) {
  if (!store.has(array)) return {};
  const auto shape = store.shape(array);
  const auto values = store.read<double>(array);
  if (shape.size() != 2 || static_cast<std::int64_t>(values.size()) != shape[0] * shape[1])
    throw Error(store.path(), "damaged: " + array + " is no matrix");
  return Eigen::Map<const ByRows>(values.data(), shape[0], shape[1]);
}

std::uint64_t of_nodes(std::span<const int> nodes) {
  Digest d;
  for (const int i : nodes) d.add(i);
  return d.value();
}

}  // namespace

/// What ranks bring in any order is added up.
ReductionKey key_of(const ReductionInput& in) {
  ReductionKey key;
  std::uint64_t cells = 0, materials = 0, loads = 0;
  for (size_t k = 0; k < in.cells.size(); ++k) {
    const SolidBatch& b = in.cells[k];
    const auto n = static_cast<size_t>(info(b.shape).n_nodes);
    std::uint64_t own = 0;
    for (size_t at = 0; at < b.nodes.size(); at += n)
      own += Digest().add(static_cast<int>(b.shape)).add(of_nodes({b.nodes.data() + at, n})).value();
    cells += own;
    materials += Digest().add(in.made_of[k]).add(b.density).add(b.area).add(b.alpha).add(b.beta).add(own).value();
  }
  for (const PointCell& c : in.points) {
    cells += of_nodes(c.nodes);
    Digest own;
    for (const double x : c.strains.reshaped()) own.add(x);
    for (const double x : c.mass.reshaped()) own.add(x);
    materials += own.add(c.beta).add(c.alpha).value();
  }
  Digest mesh;
  for (const Vec3& X : in.X)
    for (const double x : X) mesh.add(x);
  key.mesh = mesh.add(cells).text(), key.material = Digest().add(materials).text();
  for (const auto& load : in.loads) {
    std::uint64_t sum = 0;
    for (const auto& [node, force] : load) sum += Digest().add(node).add(force[0]).add(force[1]).add(force[2]).value();
    loads += Digest().add(sum).value();
  }
  key.loads = Digest().add(loads).text();
  constexpr int how = 4;  // one more when regions are reduced in another way: what was found before then serves no longer
  Digest basis;
  basis.add(how).add(in.n_vibrations).add(in.up_to).add(in.stiffening).add(in.stiffening && in.may_be_fewer);
  for (const double x : in.given.reshaped()) basis.add(x);
  key.basis = basis.text();
  for (size_t k = 0; k < in.rigid.size(); ++k)
    key.interfaces.push_back(in.rigid_names[k]), key.digests.push_back(Digest().add(of_nodes(in.rigid[k])).text());
  if (!in.free.empty())
    key.interfaces.emplace_back("nodes of nonlinear regions"), key.digests.push_back(Digest().add(of_nodes(in.free)).text());
  for (size_t k = 0; k < in.tied.size(); ++k)
    key.interfaces.push_back(in.tied_names[k]), key.digests.push_back(Digest().add(of_nodes(in.tied[k])).text());
  Digest folds;
  for (const auto& block : in.blocks) folds.add(of_nodes(block));
  if (!in.blocks.empty()) key.interfaces.emplace_back("nodes of folds"), key.digests.push_back(folds.text());
  return key;
}

ReducedFile::ReducedFile(const std::string& path) : store_(Store::open(path)) {
  if (store_.text_attribute("/", "format").value_or("") != "hilo reduced")
    throw Error(path, "not a file of reduced regions", "hilo-reduce scene.toml tags.h5 -o reduced.h5 makes one");
  if (store_.number_attribute("/", "complete").value_or(0) != 1) throw Error(path, "incomplete file");
}

std::string ReducedFile::unfit(const std::string& region, const ReductionKey& wanted) const {
  const std::string group = group_of(region);
  if (!store_.has(group)) return "it lacks the region";
  const auto differs = [&](const char* what, const std::string& digest) { return store_.text_attribute(group, what) != digest; };
  if (differs("mesh", wanted.mesh)) return "it is of another mesh";
  if (differs("material", wanted.material)) return "it is of another material, density, damping or area";
  std::vector<std::string> names, digests;
  if (store_.has(group + "/interfaces")) {
    names = store_.read_strings(group + "/interfaces"), digests = store_.read_strings(group + "/interface_digests");
    if (names.size() != digests.size()) throw Error(store_.path(), "damaged: interfaces of " + group);
  }
  for (size_t k = 0; k < wanted.interfaces.size(); ++k) {
    const auto at = std::find(names.begin(), names.end(), wanted.interfaces[k]);
    if (at == names.end()) return fmt::format("it lacks the interface \"{}\"", wanted.interfaces[k]);
    if (digests[static_cast<size_t>(at - names.begin())] != wanted.digests[k])
      return fmt::format("its interface \"{}\" has other nodes", wanted.interfaces[k]);
  }
  for (const auto& name : names)
    if (std::find(wanted.interfaces.begin(), wanted.interfaces.end(), name) == wanted.interfaces.end())
      return fmt::format("its modes were found with the interface \"{}\" held, and nothing holds it here", name);
  if (differs("loads", wanted.loads)) return "it is of other loads";
  if (differs("basis", wanted.basis)) return "it was made for other modes, up_to (0.1 divided by the step, where not given) or stiffening";
  return "";
}

Reduction ReducedFile::read(const std::string& region, size_t n_nodes) const {
  const std::string group = group_of(region);
  Reduction out;
  const auto omega2 = store_.read<double>(group + "/omega2");
  out.omega2 = Eigen::Map<const Eigen::VectorXd>(omega2.data(), static_cast<Index>(omega2.size()));
  for (const Part& part : parts) out.*part.matrix = read_matrix(store_, group + "/" + part.name);
  if (Matrix KK = read_matrix(store_, group + "/strain"); KK.size() > 0) out.strain = QuadraticStrain(std::move(KK));
  out.held_frequency = store_.number_attribute(group, "held_frequency").value_or(0);
  const Index m = out.omega2.size(), blocks = 4 + 3 * m;
  const auto square = [](const Matrix& M, Index n) { return M.size() == 0 || (M.rows() == n && M.cols() == n); };
  if (out.shapes.cols() != m || (m > 0 && out.shapes.rows() != 3 * static_cast<Index>(n_nodes)) || out.sites.cols() != m ||
      out.soft.rows() != m || out.second_order.rows() != m + 1 ||
      2 * out.second_order.cols() != (out.soft.cols() + 3) * (out.soft.cols() + 4) || out.A.size() == 0 || !square(out.A, blocks) ||
      !square(out.A_damped, blocks) || !square(out.viscous, out.strain.used() ? out.strain.matrix().rows() : m) ||
      !square(out.left_out, m) || !square(out.strain.matrix(), m + m * (m + 1) / 2))
    throw Error(store_.path(), "damaged: the arrays of " + group + " do not fit each other");
  return out;
}

void write_reduced(const std::string& path, const std::vector<KeptReduction>& regions, const std::vector<std::string>& provenance) {
  release_input(path);  // regions in it that still serve are among these
  Store store = Store::create(path);
  store.set("/", "format", std::string("hilo reduced"));
  store.set("/", "version", schema_version);
  store.set("/", "complete", std::int64_t{1});
  store.write_strings("/provenance", provenance);
  for (const KeptReduction& r : regions) {
    const std::string group = group_of(r.region);
    const auto& row = *find_array("reduced.h5", "/reduced/any/omega2");
    store.write<double>(group + "/omega2", {r.found.omega2.data(), static_cast<size_t>(r.found.omega2.size())}, {r.found.omega2.size()},
                        std::string(row.unit), std::string(row.meaning));
    for (const Part& part : parts)
      if ((r.found.*part.matrix).size() > 0) write(store, group + "/" + part.name, r.found.*part.matrix);
    if (r.found.strain.used()) write(store, group + "/strain", r.found.strain.matrix());
    store.set(group, "held_frequency", r.found.held_frequency);
    store.set(group, "mesh", r.key.mesh), store.set(group, "material", r.key.material);
    store.set(group, "loads", r.key.loads), store.set(group, "basis", r.key.basis);
    if (r.key.interfaces.empty()) continue;
    store.write_strings(group + "/interfaces", r.key.interfaces);
    store.write_strings(group + "/interface_digests", r.key.digests);
  }
  store.publish();
}

}  // namespace hilo
