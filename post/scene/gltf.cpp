// SPDX-License-Identifier: GPL-3.0-or-later
#include "post/scene/gltf.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vtkCellArray.h>
#include <vtkCellArrayIterator.h>
#include <vtkDataArray.h>
#include <vtkPointData.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>

#include "base/error.hpp"
#include "base/table.hpp"
#include "post/run/marker.hpp"
#include "post/run/playback.hpp"
#include "post/scene/frame_options.hpp"
#include "post/surface/skin.hpp"

namespace hilo {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

/// The binary part, and the JSON that says what lies where in it.
class Buffer {
 public:
  /// Number of the accessor; `width` numbers of T each.  `bounds`: with the least and the largest of each column.
  template <class T>
  size_t add(const std::vector<T>& values, int width, bool bounds = false, int target = 0) {
    const size_t first = bytes.size(), n = values.size() / static_cast<size_t>(width);
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    views.push_back(fmt::format(R"({{"buffer":0,"byteOffset":{},"byteLength":{}{}}})", first, bytes.size() - first,
                                target ? fmt::format(R"(,"target":{})", target) : ""));
    bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
    std::string more;
    if constexpr (std::is_same_v<T, std::uint16_t>) more = R"(,"normalized":true)";
    if (bounds) {
      std::vector<T> low(values.begin(), values.begin() + width), high = low;
      for (size_t i = 0; i < values.size(); ++i) {
        T &l = low[i % static_cast<size_t>(width)], &h = high[i % static_cast<size_t>(width)];
        l = std::min(l, values[i]), h = std::max(h, values[i]);
      }
      more += fmt::format(R"(,"min":[{}],"max":[{}])", fmt::join(low, ","), fmt::join(high, ","));
    }
    const char* types[] = {"SCALAR", "", "VEC3", "VEC4"};
    const int component = std::is_same_v<T, float> ? 5126 : std::is_same_v<T, std::uint16_t> ? 5123 : 5125;
    accessors.push_back(fmt::format(R"({{"bufferView":{},"componentType":{},"count":{},"type":"{}"{}}})", views.size() - 1, component, n,
                                    types[width - 1], more));
    return accessors.size() - 1;
  }
  std::string bytes;
  std::vector<std::string> views, accessors;
};

constexpr int vertices = 34962, indices = 34963;  // what a view is for

template <class... V>
std::string list(const V&... x) {
  return fmt::format("[{}]", fmt::join(std::initializer_list<double>{x...}, ","));
}

std::vector<float> copied(const float* from, vtkIdType n) { return {from, from + n}; }
float* floats(vtkDataArray* of) { return static_cast<float*>(of->GetVoidPointer(0)); }

/// Colours of vertices are linear, those of the maps sRGB.
void add_colour(std::vector<std::uint16_t>& to, const Rgb& c) {
  for (const double x : {c.r, c.g, c.b}) {
    const double linear = x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
    to.push_back(static_cast<std::uint16_t>(std::lround(65535 * std::clamp(linear, 0.0, 1.0))));
  }
  to.push_back(65535);
}

struct Instant {
  double t;
  std::vector<Vec3> x;  // (n_nodes)
};

std::string wrapped(const std::string& json, const std::string& binary) {
  const auto padded = [](std::string s, char with) { return s.resize((s.size() + 3) / 4 * 4, with), s; };
  const std::string a = padded(json, ' '), b = padded(binary, '\0');
  std::string out;
  const auto word = [&](size_t value) {
    const auto x = static_cast<std::uint32_t>(value);
    out.append(reinterpret_cast<const char*>(&x), 4);
  };
  const size_t size = 12 + 8 + a.size() + 8 + b.size();
  if (size > 0xFFFFFFFFu) throw Error("--steps", "more than a .glb can hold, 4 GB", "fewer steps, or --show", Exit::usage);
  out += "glTF", word(2), word(size), word(a.size()), out += "JSON", out += a, word(b.size()), out.append("BIN\0", 4), out += b;
  return out;
}

/// The scene while its regions are added.
class Writer {
 public:
  Writer(RunFile& run, const GltfOptions& o) : o_(o), run_(run), file_(run.mesh_file()), mesh_(file_.mesh) {
    shown_ = shown_regions(mesh_, o.show, o.hide);
    Playback playback(run);
    for (const Step& step : o.steps) instants_.push_back({step.t, playback.positions(step.t)});
    if (o.field == "partition") throw Error("--field", "glTF has colours of points: no ranks of cells", "--field region", Exit::usage);
    if (is_named_field(o.field))
      named_ = named_cells(file_, o.field, shown_, run.path);
    else
      find_values();
    if (instants_.size() > 1) {
      std::vector<float> t;
      for (const Instant& i : instants_) t.push_back(static_cast<float>((i.t - instants_.front().t) / o.speed));
      for (size_t k = 1; k < t.size(); ++k)
        if (!(t[k] > t[k - 1]))
          throw Error("--steps", "an animation needs rising times", "give each step once, in their order", Exit::usage);
      times_ = buffer_.add(t, 1, true);
    }
  }

  Gltf finish() {
    std::vector<std::vector<Facet>> of(shown_.size());
    for (const Facet& f : boundary_facets(mesh_, shown_)) of[region_of(f.cell)].push_back(f);
    for (size_t r = 0; r < of.size(); ++r)
      if (!of[r].empty()) add_region(r, of[r]);
    for (std::int64_t c = 0; c < mesh_.n_cells(); ++c)
      out_.left_out += shown_[region_of(c)] && info(mesh_.shape[static_cast<size_t>(c)]).dimension == 1;
    if (out_.triangles == 0) throw Error(run_.path, "what is shown has no surface");
    out_.bytes = wrapped(json(), buffer_.bytes);
    return std::move(out_);
  }

 private:
  size_t region_of(std::int64_t cell) const { return static_cast<size_t>(mesh_.region[static_cast<size_t>(cell)]); }

  /// At each node the value largest in size over the steps, and the range of what is drawn.
  void find_values() {
    field_ = shown_field(o_.field, run_.fields(o_.steps.front()));
    valued_ = shown_;
    for (size_t r = 0; r < shown_.size(); ++r)
      if ((field_.flexible_only && file_.fidelity[r] == Fidelity::rigid) || !run_.gives(r, field_.array)) valued_[r] = false;
    for (const Step& step : o_.steps) {
      const auto now = reduced(run_.field(step, field_.array), field_, run_.path);
      if (value_.empty()) value_.resize(now.size());
      for (size_t n = 0; n < now.size(); ++n)
        if (std::abs(now[n]) > std::abs(value_[n])) value_[n] = now[n];
    }
    if (!o_.range.empty()) {
      std::tie(low_, high_) = parse_range(o_.range);
    } else {
      low_ = std::numeric_limits<double>::infinity(), high_ = -low_;
      for (std::int64_t c = 0; c < mesh_.n_cells(); ++c)
        if (valued_[region_of(c)])
          for (const std::int64_t n : mesh_.cell(c))
            if (run_.holds(n))
              low_ = std::min(low_, value_[static_cast<size_t>(n)]), high_ = std::max(high_, value_[static_cast<size_t>(n)]);
      if (low_ > high_) low_ = high_ = 0;  // nothing has a value
      if (field_.from_zero) low_ = 0;
    }
    if (!field_.from_zero && low_ < 0 && high_ > 0) map_ = ColourMap::diverging, high_ = std::max(high_, -low_), low_ = -high_;
  }

  std::vector<std::uint16_t> colours(size_t r, Skin& skin, const Facet& any) const {
    const vtkIdType n = skin.faces()->GetNumberOfPoints();
    std::vector<std::uint16_t> all;
    const bool named = is_named_field(o_.field), valued = !named && valued_[r];
    if (valued) skin.set_values(value_);
    const float* at = valued ? floats(skin.faces()->GetPointData()->GetScalars()) : nullptr;
    for (vtkIdType v = 0; v < n; ++v)
      add_colour(all, named     ? named_.colours[static_cast<size_t>(named_.name_of[static_cast<size_t>(any.cell)])]
                      : !valued ? neutral
                                : map_colour(map_, high_ > low_ ? (static_cast<double>(at[v]) - low_) / (high_ - low_) : 0));
    return all;
  }

  void add_region(size_t r, const std::vector<Facet>& facets) {
    Skin skin(mesh_, facets);
    vtkPolyData* faces = skin.faces();
    const vtkIdType n = 3 * faces->GetNumberOfPoints();
    std::vector<std::uint32_t> triangle;
    for (const auto it = vtk::TakeSmartPointer(faces->GetPolys()->NewIterator()); !it->IsDoneWithTraversal(); it->GoToNextCell()) {
      vtkIdType count = 0;
      const vtkIdType* p = nullptr;
      it->GetCurrentCell(count, p);
      for (vtkIdType k = 2; k < count; ++k)
        for (const vtkIdType v : {p[0], p[k - 1], p[k]}) triangle.push_back(static_cast<std::uint32_t>(v));
    }
    std::vector<std::int64_t> nodes;
    for (const Facet& f : facets)
      for (const std::int64_t node : mesh_.facet_nodes(f)) nodes.push_back(node);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    std::vector<Vec3> before, now;
    for (const std::int64_t i : nodes) before.push_back(mesh_.X[static_cast<size_t>(i)]);
    std::vector<Pose> pose;
    std::vector<std::vector<float>> local;  // positions in the frame that moves with the region
    std::vector<float> normal;
    std::vector<Vec3> x(mesh_.X.size(), Vec3::Zero());
    double size = 0, beyond = 0;
    for (const Instant& i : instants_) {
      now.clear();
      for (const std::int64_t node : nodes) now.push_back(i.x[static_cast<size_t>(node)]);
      pose.push_back(best_pose(before, now));
      for (const std::int64_t node : nodes) {
        Vec3& at = x[static_cast<size_t>(node)];
        const Vec3 reference = mesh_.X[static_cast<size_t>(node)] - pose.back().from;
        at = pose.back().R.transpose() * (i.x[static_cast<size_t>(node)] - pose.back().to);
        size = std::max(size, reference.norm()), beyond = std::max(beyond, (at - reference).norm());
      }
      skin.move(x);
      local.push_back(copied(floats(faces->GetPoints()->GetData()), n));
      if (normal.empty()) normal = copied(floats(faces->GetPointData()->GetNormals()), n);
    }
    const bool deforms = instants_.size() > 1 && beyond > 1e-6 * size;
    std::string targets, weights;
    for (size_t k = 1; deforms && k < local.size(); ++k) {
      for (size_t c = 0; c < local[k].size(); ++c) local[k][c] -= local[0][c];
      targets += fmt::format(R"({}{{"POSITION":{}}})", k > 1 ? "," : "", buffer_.add(local[k], 3, true, vertices));
      weights += k > 1 ? ",0" : "0";
    }
    const size_t index = buffer_.add(triangle, 1, false, indices), position = buffer_.add(local[0], 3, true, vertices),
                 turned = buffer_.add(normal, 3, false, vertices),
                 colour = buffer_.add(colours(r, skin, facets.front()), 4, false, vertices);
    const std::string name = json_text(mesh_.region_name[r]);
    meshes_.push_back(fmt::format(
        R"({{"name":{},"primitives":[{{"attributes":{{"POSITION":{},"NORMAL":{},"COLOR_0":{}}},"indices":{},"material":0{}}}]{}}})", name,
        position, turned, colour, index, deforms ? fmt::format(R"(,"targets":[{}])", targets) : "",
        deforms ? fmt::format(R"(,"weights":[{}])", weights) : ""));
    const size_t node = meshes_.size();  // behind the root
    const Eigen::Quaterniond q(pose.front().R);
    const Vec3& to = pose.front().to;
    nodes_.push_back(fmt::format(R"({{"name":{},"mesh":{},"translation":{},"rotation":{}}})", name, node - 1, list(to[0], to[1], to[2]),
                                 list(q.x(), q.y(), q.z(), q.w())));
    if (instants_.size() > 1) animate(node, pose, deforms);
    out_.triangles += triangle.size() / 3, ++out_.regions;
  }

  void animate(size_t node, const std::vector<Pose>& pose, bool deforms) {
    std::vector<float> to, turn, weight;
    Eigen::Quaterniond last = Eigen::Quaterniond::Identity();
    for (size_t k = 0; k < pose.size(); ++k) {
      for (const double c : pose[k].to) to.push_back(static_cast<float>(c));
      Eigen::Quaterniond q(pose[k].R);
      if (q.dot(last) < 0) q.coeffs() *= -1;  // the short way
      last = q;
      for (const double c : {q.x(), q.y(), q.z(), q.w()}) turn.push_back(static_cast<float>(c));
      for (size_t target = 1; target < pose.size(); ++target) weight.push_back(target == k ? 1 : 0);
    }
    const auto channel = [&](const char* path, const std::vector<float>& values, int width) {
      samplers_.push_back(fmt::format(R"({{"input":{},"output":{},"interpolation":"LINEAR"}})", times_, buffer_.add(values, width)));
      channels_.push_back(fmt::format(R"({{"sampler":{},"target":{{"node":{},"path":"{}"}}}})", samplers_.size() - 1, node, path));
    };
    channel("translation", to, 3), channel("rotation", turn, 4);
    if (deforms) channel("weights", weight, 1);
  }

  std::string json() const {
    std::vector<size_t> children;
    for (size_t k = 1; k <= nodes_.size(); ++k) children.push_back(k);
    const std::string field = is_named_field(o_.field) ? fmt::format(R"({{"field":"{}"}})", o_.field)
                                                       : fmt::format(R"({{"field":"{}","unit":"{}","low":{},"high":{}}})", o_.field,
                                                                     field_.unit, Json(low_).text(), Json(high_).text());
    const double half = std::sqrt(0.5);
    std::string out = fmt::format(
        R"({{"asset":{{"version":"2.0","generator":"hilo-post"}},"scene":0,"scenes":[{{"name":{0},"nodes":[0],"extras":{1}}}],)"
        R"("nodes":[{{"name":{0},"rotation":{2},"children":[{3}]}},{4}],"meshes":[{5}],)"
        R"("materials":[{{"name":"values","doubleSided":true,"pbrMetallicRoughness":{{"metallicFactor":0,"roughnessFactor":0.6}}}}],)",
        json_text(run_.title), field, list(-half, 0.0, 0.0, half), fmt::join(children, ","), fmt::join(nodes_, ","),
        fmt::join(meshes_, ","));
    if (!channels_.empty())
      out += fmt::format(R"("animations":[{{"name":"run","samplers":[{}],"channels":[{}]}}],)", fmt::join(samplers_, ","),
                         fmt::join(channels_, ","));
    return out + fmt::format(R"("accessors":[{}],"bufferViews":[{}],"buffers":[{{"byteLength":{}}}]}})", fmt::join(buffer_.accessors, ","),
                             fmt::join(buffer_.views, ","), buffer_.bytes.size());
  }

  const GltfOptions& o_;
  RunFile& run_;
  const MeshFile& file_;
  const Mesh& mesh_;
  std::vector<bool> shown_, valued_;  // per region
  std::vector<Instant> instants_;
  ShownField field_;
  NamedCells named_;
  ColourMap map_ = ColourMap::viridis;
  std::vector<double> value_;  // (n_nodes)
  double low_ = 0, high_ = 0;  // of the colours, in the stored unit
  Buffer buffer_;
  size_t times_ = 0;  // accessor
  std::vector<std::string> meshes_, nodes_, samplers_, channels_;
  Gltf out_;
};

}  // namespace

Gltf gltf_of(RunFile& run, const GltfOptions& o) { return Writer(run, o).finish(); }

}  // namespace hilo
