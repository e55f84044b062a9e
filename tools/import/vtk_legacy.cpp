// SPDX-License-Identifier: GPL-3.0-or-later
// Legacy VTK files: keyword, numbers, keyword, numbers.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <type_traits>

#include "base/error.hpp"
#include "import/data_line.hpp"
#include "import/text_input.hpp"
#include "import/vtk_grid.hpp"

namespace hilo {
namespace {

/// Words and big-endian numbers, one after the other.
class Stream : public TextInput {
 public:
  using TextInput::TextInput;
  bool binary = false;

  std::int64_t count(const std::string& what) {
    const std::string_view w = word();
    std::int64_t n = -1;
    const auto [end, bad] = std::from_chars(w.data(), w.data() + w.size(), n);
    if (bad != std::errc() || end != w.data() + w.size() || n < 0 || n > static_cast<std::int64_t>(text_.size()))
      fail(fmt::format("{}: expected a count, found \"{}\"", what, w));
    return n;
  }
  /// A number of the file as T: of whole ones none is rounded.
  template <class T, class U>
  T as(U x) {
    if constexpr (std::is_integral_v<T> && std::is_floating_point_v<U>)
      if (!(std::abs(x) <= 9e15 && x == std::floor(x))) fail(fmt::format("expected a whole number, found {}", x));
    return static_cast<T>(x);
  }
  template <class T>
  std::vector<T> numbers(std::int64_t n, const std::string& type) {
    if (n < 0 || static_cast<size_t>(n) > text_.size()) fail(fmt::format("an array of {} numbers in a file of {} bytes", n, text_.size()));
    std::vector<T> v;
    v.reserve(static_cast<size_t>(n));
    if (!binary) {
      for (std::int64_t i = 0; i < n; ++i) {
        const std::string_view w = word();
        double x = 0;
        const char* first = w.data() + (!w.empty() && w[0] == '+');
        const auto [end, bad] = std::from_chars(first, w.data() + w.size(), x);
        if (w.empty()) fail("the file ends in the middle of an array");
        if (bad != std::errc() || end != w.data() + w.size()) fail(fmt::format("expected a number, found \"{}\"", w));
        v.push_back(as<T>(x));
      }
      return v;
    }
    if (at_ < text_.size() && text_[at_] == '\r') ++at_;
    if (at_ < text_.size() && text_[at_] == '\n') ++at_;
    static const std::map<std::string, std::string_view> types{
        {"double", "Float64"},     {"float", "Float32"},         {"int", "Int32"},          {"unsigned_int", "UInt32"},
        {"long", "Int64"},         {"vtkidtype", "Int64"},       {"vtktypeint64", "Int64"}, {"unsigned_long", "UInt64"},
        {"short", "Int16"},        {"unsigned_short", "UInt16"}, {"char", "Int8"},          {"signed_char", "Int8"},
        {"unsigned_char", "UInt8"}};
    const auto known = types.find(type);
    if (known == types.end()) fail(fmt::format("unknown type \"{}\"", type));
    with_vtk_type(known->second, [&]<class U>(U) {
      if (at_ + static_cast<size_t>(n) * sizeof(U) > text_.size()) fail("the file ends in the middle of an array");
      for (std::int64_t i = 0; i < n; ++i, at_ += sizeof(U))
        v.push_back(as<T>(vtk_number<U>(text_.data() + at_, std::endian::native == std::endian::little)));
    });
    return v;
  }
  size_t mark() const { return at_; }
  void back(size_t at) { at_ = at; }

 private:
  std::string place() const override { return binary ? path_ : TextInput::place(); }
};

std::string lower(std::string_view text) {
  std::string s(text);
  for (auto& c : s) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return s;
}

}  // namespace

VtkGrid read_vtk_legacy(const std::string& path, std::string bytes) {
  Stream s(path, std::move(bytes));
  VtkGrid g;
  if (s.line().rfind("# vtk DataFile Version", 0) != 0) throw Error(path + ":1", "not a VTK file: no \"# vtk DataFile Version\"");
  s.line();
  const std::string mode = upper(s.line());
  if (mode != "ASCII" && mode != "BINARY") throw Error(path + ":3", fmt::format("expected ASCII or BINARY, found \"{}\"", mode));
  s.binary = mode == "BINARY";
  bool of_cells = false, of_nodes = false;
  std::int64_t n_data = 0;
  const auto keep = [&](const std::string& name, std::int64_t components, std::vector<double> v) {
    if (of_cells && components == 1)
      g.cell_data[name] = std::move(v);
    else if (of_cells || of_nodes)
      g.not_read.insert(fmt::format("{} array \"{}\"", of_cells ? "cell" : "node", name));
  };
  for (std::string w = upper(s.word()); !w.empty(); w = upper(s.word())) {
    if (w == "DATASET") {
      if (const std::string kind = upper(s.word()); kind != "UNSTRUCTURED_GRID")
        s.fail(fmt::format("DATASET {} is not read, UNSTRUCTURED_GRID is", kind));
    } else if (w == "POINTS") {
      const auto n = s.count(w);
      const auto type = lower(s.word());
      g.points = s.numbers<double>(3 * n, type);
    } else if (w == "CELLS") {
      const auto n = s.count(w), size = s.count(w);
      const size_t here = s.mark();
      if (upper(s.word()) == "OFFSETS") {  // version 5: n and size count offsets and connectivity
        const auto type = lower(s.word());
        g.offsets = s.numbers<std::int64_t>(n, type);
        if (upper(s.word()) != "CONNECTIVITY") s.fail("expected CONNECTIVITY");
        const auto type2 = lower(s.word());
        g.connectivity = s.numbers<std::int64_t>(size, type2);
      } else {
        s.back(here);
        const auto flat = s.numbers<std::int64_t>(size, "int");
        g.offsets = {0};
        for (size_t i = 0; i < flat.size();) {
          const auto k = flat[i];
          if (k < 0 || i + 1 + static_cast<size_t>(k) > flat.size()) s.fail("CELLS: a cell has more nodes than the list");
          g.connectivity.insert(g.connectivity.end(), flat.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                                flat.begin() + static_cast<std::ptrdiff_t>(i + 1) + k);
          g.offsets.push_back(static_cast<std::int64_t>(g.connectivity.size()));
          i += 1 + static_cast<size_t>(k);
        }
        if (static_cast<std::int64_t>(g.offsets.size()) != n + 1)
          s.fail(fmt::format("CELLS: {} cells announced, {} found", n, g.offsets.size() - 1));
      }
    } else if (w == "CELL_TYPES")
      g.types = s.numbers<int>(s.count(w), "int");
    else if (w == "CELL_DATA" || w == "POINT_DATA") {
      of_cells = w == "CELL_DATA", of_nodes = !of_cells;
      n_data = s.count(w);
    } else if (w == "SCALARS") {
      const std::string rest(s.line());  // name type [components]
      char name[256] = "", type[64] = "";
      int components = 1;
      if (std::sscanf(rest.c_str(), "%255s %63s %d", name, type, &components) < 2) s.fail("SCALARS: expected name and type");
      if (components < 1 || components > 9) s.fail(fmt::format("SCALARS of {} components", components));
      const size_t here = s.mark();
      if (upper(s.word()) == "LOOKUP_TABLE")
        s.word();
      else
        s.back(here);
      auto v = s.numbers<double>(n_data * components, lower(type));
      keep(name, components, std::move(v));
    } else if (w == "VECTORS" || w == "NORMALS" || w == "TENSORS") {
      const std::string name(s.word());
      keep(name, 3, {});
      const auto type = lower(s.word());
      s.numbers<double>(n_data * (w == "TENSORS" ? 9 : 3), type);
    } else if (w == "FIELD") {
      s.word();
      const auto arrays = s.count(w);
      for (std::int64_t i = 0; i < arrays; ++i) {
        std::string name(s.word());
        while (name == "METADATA") {  // runs to an empty line
          s.line();
          while (!s.line().empty()) {
          }
          name = s.word();
        }
        const auto components = s.count(name), tuples = s.count(name);
        const auto type = lower(s.word());
        if (type == "string") s.fail(fmt::format("array {} of strings is not read", name));
        auto v = s.numbers<double>(components * tuples, type);
        keep(name, components, std::move(v));
      }
    } else if (w == "LOOKUP_TABLE") {
      s.word();
      const auto n = s.count(w);
      s.numbers<double>(4 * n, s.binary ? "unsigned_char" : "float");
    } else if (w == "METADATA") {
      s.line();
      while (!s.line().empty()) {
      }
    } else
      s.fail(fmt::format("unknown keyword \"{}\"", w));
  }
  return g;
}

}  // namespace hilo
