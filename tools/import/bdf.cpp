// Nastran bulk data: GRID, solids, rods and their properties and materials, in small, large and free fields.
// (gmsh loses names and the mid-side nodes of long fields, so the reader is ours.)  Shell elements are read where they lie on solids, as
// facet sets.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <unordered_map>

#include "base/error.hpp"
#include "import/imported.hpp"
#include "import/inp_lines.hpp"

namespace hilo {
namespace {

/// A bulk entry: its name, and its fields from the second on, continuations joined.
struct Entry {
  std::string name;
  DataLine data;
};

struct SolidKind {
  const char* name;
  size_t corners, nodes;
  Shape linear, quadratic;
  std::vector<int> p;  // quadratic: ours[i] = Nastran's[p[i]]
};
const std::vector<SolidKind> solids = {
    {"CTETRA", 4, 10, Shape::tet4, Shape::tet10, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}},
    {"CPENTA", 6, 15, Shape::wedge6, Shape::wedge15, {0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11}},
    {"CHEXA", 8, 20, Shape::hex8, Shape::hex20r, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15}},
};
const std::map<std::string, std::string> refused = {{"CPYRAM", "pyramids are not read"},
                                                    {"CBEAM", "beams are not read"},
                                                    {"CBAR", "beams are not read"},
                                                    {"CTRAX3", "axisymmetric elements are not three-dimensional"},
                                                    {"CTRAX6", "axisymmetric elements are not three-dimensional"},
                                                    {"CELAS1", "springs are not read; say [[spring]] in the scene"},
                                                    {"CELAS2", "springs are not read; say [[spring]] in the scene"},
                                                    {"CBUSH", "bushings are not read; say [[spring]] in the scene"},
                                                    {"INCLUDE", "INCLUDE is not read; paste the file"},
                                                    {"CONM2", "point masses are not read; say [[point_mass]] in the scene"},
                                                    {"RBE2", "rigid elements are not read; a set serves as a patch in the scene"},
                                                    {"RBE3", "rigid elements are not read; a set serves as a patch in the scene"}};

class BdfReader {
 public:
  BdfReader(const std::string& path, const ImportOptions& o) : path_(path), o_(o), text_(read_gz(path, "")) {}

  Imported read() {
    Entry e;
    while (next(e)) take(e);
    if (in_.mesh.X.empty()) throw Error(path_, "no GRID", "a Nastran file has GRID entries");
    if (raw_.empty()) throw Error(path_, "no solid elements and no rods", "supported: CTETRA, CPENTA, CHEXA, CROD, CONROD");
    build();
    return std::move(in_);
  }

 private:
  struct Raw {
    Shape shape;
    std::int64_t id, pid;
    std::vector<std::int64_t> nodes;
    std::string place;
  };

  bool line(std::string_view& l) {
    if (at_ >= text_.size()) return false;
    const size_t end = std::min(text_.find('\n', at_), text_.size());
    l = std::string_view(text_).substr(at_, end - at_);
    at_ = end + 1;
    ++line_;
    if (!l.empty() && l.back() == '\r') l.remove_suffix(1);
    return true;
  }

  void comment(std::string_view l) {  // names that pre-processors leave: $HMNAME PROP 3"hull"
    const std::string s(l);
    int id;
    char name[200];
    if (std::sscanf(s.c_str(), "$HMNAME PROP %d\"%199[^\"]", &id, name) == 2 ||
        std::sscanf(s.c_str(), "$ANSA_NAME_COMMENT;%d;PSOLID;%199[^;]", &id, name) == 2 ||
        std::sscanf(s.c_str(), "$ Femap with NX Nastran Property %d : %199[^\n]", &id, name) == 2 ||
        std::sscanf(s.c_str(), "$ Femap Property %d : %199[^\n]", &id, name) == 2)
      names_[id] = clean_name(name);
  }

  /// Fields of one physical line behind its first; `first` is that one.
  void cut(std::string_view l, std::string_view& first, std::vector<Field>& fields) const {
    const auto strip = [](std::string_view s) {
      while (!s.empty() && s.front() == ' ') s.remove_prefix(1);
      while (!s.empty() && (s.back() == ' ' || s.back() == '\t')) s.remove_suffix(1);
      return s;
    };
    if (const auto dollar = l.find('$'); dollar != std::string_view::npos) l = l.substr(0, dollar);
    if (l.find(',') != std::string_view::npos) {
      size_t from = 0, n = 0;
      for (size_t i = 0; i <= l.size(); ++i)
        if (i == l.size() || l[i] == ',') {
          const auto f = strip(l.substr(from, i - from));
          if (n == 0)
            first = f;
          else if (n < 9)
            fields.push_back({f, static_cast<int>(from) + 1});
          from = i + 1, ++n;
        }
      while (n++ < 9) fields.push_back({"", 1});
      return;
    }
    first = strip(l.substr(0, 8));
    const bool large = !first.empty() && (first.back() == '*' || first.front() == '*');
    const size_t width = large ? 16 : 8, count = large ? 4 : 8;
    for (size_t i = 0; i < count; ++i) {
      const size_t from = 8 + i * width;
      fields.push_back({from < l.size() ? strip(l.substr(from, width)) : std::string_view{}, static_cast<int>(from) + 1});
    }
  }

  bool next(Entry& e) {
    std::string_view l;
    for (;;) {
      if (ahead_)
        l = *ahead_, ahead_.reset();
      else if (!line(l))
        return false;
      if (!l.empty() && l.front() == '$') {
        comment(l);
        continue;
      }
      if (l.find_first_not_of(" \t") == std::string_view::npos) continue;
      if (upper(l.substr(0, 10)) == "BEGINBULK") {  // all before it was case control
        in_bulk_ = true;
        continue;
      }
      if (!in_bulk_ && has_bulk()) continue;
      if (upper(l).rfind("ENDDATA", 0) == 0) return false;
      break;
    }
    if (l.find('\t') != std::string_view::npos) throw Error(place(), "a tab in a Nastran entry", "write blanks or commas");
    e.data = {&path_, line_, {}};
    std::string_view first;
    cut(l, first, e.data.fields);
    e.name = upper(first);
    if (!e.name.empty() && e.name.back() == '*') e.name.pop_back();
    while (line(l)) {
      if (!l.empty() && l.front() == '$') {
        comment(l);
        continue;
      }
      const bool more = !l.empty() && (l.front() == '+' || l.front() == '*' || l.front() == ',' ||
                                       (l.front() == ' ' && l.find_first_not_of(' ') != std::string_view::npos));
      if (!more) {
        ahead_ = l;
        break;
      }
      cut(l, first, e.data.fields);
    }
    while (!e.data.fields.empty() && e.data.fields.back().text.empty()) e.data.fields.pop_back();
    return true;
  }

  bool has_bulk() {
    if (bulk_ < 0) {
      const std::string head = upper(std::string_view(text_).substr(0, 100000));
      bulk_ = head.find("BEGINBULK") != std::string::npos;
    }
    return bulk_ > 0;
  }
  std::string place() const { return fmt::format("{}:{}", path_, line_); }

  void take(const Entry& e) {
    const auto& d = e.data;
    if (const auto no = refused.find(e.name); no != refused.end())
      throw Error(d.place() + ":1", fmt::format("{}: {}", e.name, no->second), "supported: CTETRA, CPENTA, CHEXA, CROD, CONROD");
    if (e.name == "GRID") {
      const auto id = d.integer(0);
      if (!d.empty(1) && d.integer(1) != 0)
        throw Error(d.place(1), fmt::format("GRID {} is in coordinate system {}", id, d.integer(1)), "write the grids in the basic system");
      if (!row_.try_emplace(id, in_.mesh.n_nodes()).second)
        throw Error(d.place(0), fmt::format("node {} is given twice", id), "number each node once");
      in_.mesh.X.emplace_back(d.number(2), d.number(3), d.number(4));
      in_.mesh.node_id.push_back(id);
      return;
    }
    for (const auto& k : solids)
      if (e.name == k.name) return solid(e, k);
    if (e.name == "CROD" || e.name == "CONROD") {
      const bool own = e.name == "CONROD";  // carries its material itself
      add({Shape::bar2, d.integer(0), own ? 0 : d.integer(1), {d.integer(own ? 1 : 2), d.integer(own ? 2 : 3)}, d.place(0)});
    } else if (e.name == "CTRIA3" || e.name == "CTRIA6" || e.name == "CQUAD4" || e.name == "CQUAD8") {
      const size_t corners = e.name[1] == 'T' ? 3 : 4;
      Raw r{Shape::tet4, d.integer(0), d.integer(1), {}, d.place(0)};
      for (size_t i = 0; i < corners; ++i) r.nodes.push_back(d.integer(2 + i));
      shells_.push_back(std::move(r));
    } else if (e.name == "PSOLID" || e.name == "PROD")
      material_of_[d.integer(0)] = d.integer(1);
    else if (e.name == "MAT1") {
      RegionData m;
      if (!d.empty(1)) m.E = d.number(1);
      if (!d.empty(3))
        m.nu = d.number(3);
      else if (!d.empty(1) && !d.empty(2))
        m.nu = d.number(1) / (2 * d.number(2)) - 1;
      if (!d.empty(4)) m.density = d.number(4);
      if (m.E <= 0) throw Error(d.place(1), fmt::format("MAT1 {}: Young's modulus {:g} is not positive", d.integer(0), m.E));
      if (m.nu <= -1 || m.nu >= 0.5)
        throw Error(d.place(3), fmt::format("MAT1 {}: Poisson's ratio {:g} is not in (-1, 0.5)", d.integer(0), m.nu));
      if (m.density <= 0) throw Error(d.place(4), fmt::format("MAT1 {}: density {:g} is not positive", d.integer(0), m.density));
      materials_[d.integer(0)] = m;
    } else if (e.name == "SPC1") {
      auto& set = sets_[fmt::format("SPC_{}", d.integer(0))];
      if (upper(d.text(3)) == "THRU" && d.integer(4) - d.integer(2) > 1'000'000'000) throw Error(d.place(4), "SPC1: no usable range");
      if (upper(d.text(3)) == "THRU")
        for (auto i = d.integer(2); i <= d.integer(4); ++i) set.push_back(i);
      else
        for (size_t i = 2; i < d.fields.size(); ++i)
          if (d.is_integer(i)) set.push_back(d.integer(i));
      in_.skip("SPC1 (its nodes are a set)", d.place());
    } else if (e.name == "SPC") {
      sets_[fmt::format("SPC_{}", d.integer(0))].push_back(d.integer(1));
      if (d.is_integer(4)) sets_[fmt::format("SPC_{}", d.integer(0))].push_back(d.integer(4));
      in_.skip("SPC (its nodes are a set)", d.place());
    } else
      in_.skip(e.name.substr(0, 40), d.place());
  }

  void solid(const Entry& e, const SolidKind& k) {
    const auto& d = e.data;
    const size_t given = d.fields.size() < 2 ? 0 : d.fields.size() - 2;
    Raw r{k.linear, d.integer(0), d.integer(1), {}, d.place(0)};
    size_t filled = 0;
    std::vector<std::int64_t> n;
    for (size_t i = 0; i < k.nodes; ++i) {
      n.push_back(i < given && !d.empty(2 + i) ? d.integer(2 + i) : 0);
      if (n.back()) ++filled;
    }
    const bool corners = std::all_of(n.begin(), n.begin() + static_cast<std::ptrdiff_t>(k.corners), [](std::int64_t i) { return i != 0; });
    if (!corners || given > k.nodes)
      throw Error(d.place(), fmt::format("{} {} has {} nodes, {} or {} are due", k.name, r.id, given, k.corners, k.nodes));
    if (filled == k.corners)
      r.nodes.assign(n.begin(), n.begin() + static_cast<std::ptrdiff_t>(k.corners));
    else if (filled == k.nodes) {
      r.shape = k.quadratic;
      for (const int i : k.p) r.nodes.push_back(n[static_cast<size_t>(i)]);
    } else
      throw Error(d.place(), fmt::format("{} {} has mid-side nodes on some edges only", k.name, r.id), "give all of them or none");
    add(std::move(r));
  }

  void add(Raw r) {
    if (!ids_.insert(r.id).second) throw Error(r.place, fmt::format("element {} is given twice", r.id), "number each element once");
    raw_.push_back(std::move(r));
  }

  std::vector<std::int64_t> rows(const Raw& r) const {
    std::vector<std::int64_t> nodes;
    for (const auto id : r.nodes) {
      const auto a = row_.find(id);
      if (a == row_.end()) throw Error(r.place, fmt::format("element {} names node {}, which does not exist", r.id, id));
      nodes.push_back(a->second);
    }
    return nodes;
  }
  std::string property_name(std::int64_t pid) const {
    const auto n = names_.find(pid);
    return n == names_.end() ? fmt::format("pid_{}", pid) : n->second;
  }

  void build() {
    Mesh& m = in_.mesh;
    std::map<std::int64_t, CellGroup> by_property;
    for (const auto& r : raw_) {
      auto& g = by_property[r.pid];
      g.name = property_name(r.pid);
      g.cells.push_back(m.n_cells());
      m.add_cell(r.shape, rows(r), -1, r.id);
    }
    std::vector<CellGroup> regions;
    for (auto& [pid, g] : by_property) regions.push_back(g);
    assign_regions(in_, path_, regions, false, {}, o_);
    for (const auto& [pid, g] : by_property) {
      const auto mid = material_of_.find(pid);
      const auto mat = mid == material_of_.end() ? materials_.end() : materials_.find(mid->second);
      for (const auto c : g.cells)
        if (mat != materials_.end()) m.region_data[m.region[c]] = mat->second;
    }
    SetNames names(in_);
    std::vector<std::vector<std::int64_t>> faces;
    for (const auto& s : shells_) faces.push_back(rows(s));
    const auto found = match_facets(m, faces);
    std::map<std::int64_t, std::vector<Facet>> facets;
    for (size_t i = 0; i < shells_.size(); ++i) {
      if (found[i].cell < 0)
        throw Error(shells_[i].place, fmt::format("shell element {} lies on no solid: shells are not read", shells_[i].id),
                    "supported: CTETRA, CPENTA, CHEXA, CROD, CONROD");
      facets[shells_[i].pid].push_back(found[i]);
    }
    for (auto& [pid, f] : facets) names.facets(property_name(pid), std::move(f));
    for (auto& [name, ids] : sets_) {
      std::vector<std::int64_t> nodes;
      for (const auto id : ids)
        if (const auto a = row_.find(id); a != row_.end()) nodes.push_back(a->second);
      names.nodes(name, std::move(nodes));
    }
  }

  std::string path_;
  const ImportOptions& o_;
  std::string text_;
  Imported in_;
  size_t at_ = 0;
  int line_ = 0, bulk_ = -1;
  bool in_bulk_ = false;
  std::optional<std::string_view> ahead_;
  std::unordered_map<std::int64_t, std::int64_t> row_;
  std::set<std::int64_t> ids_;
  std::vector<Raw> raw_, shells_;
  std::map<std::int64_t, std::int64_t> material_of_;
  std::map<std::int64_t, RegionData> materials_;
  std::map<std::int64_t, std::string> names_;
  std::map<std::string, std::vector<std::int64_t>> sets_;
};

}  // namespace

Imported read_bdf(const std::string& path, const ImportOptions& options) { return BdfReader(path, options).read(); }

}  // namespace hilo
