// SPDX-License-Identifier: GPL-3.0-or-later
// VTK's XML unstructured grids: tags looked up by name, arrays as text, base64 or raw bytes, plain or zlib.
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>

#include "base/error.hpp"
#include "import/text_input.hpp"
#include "import/vtk_grid.hpp"

namespace hilo {
namespace {

struct Tag {
  std::string name;  // "/Piece" where it closes
  std::map<std::string, std::string> attributes;
  size_t end = 0;  // behind '>'
  bool empty = false;
};

class Vtu : TextInput {
 public:
  using TextInput::TextInput;

  VtkGrid read() {
    Tag t;
    std::string section;
    VtkGrid g;
    bool piece = false;
    find_appended();
    while (next(t)) {
      if (t.name == "VTKFile") {
        if (t.attributes["type"] != "UnstructuredGrid")
          fail(fmt::format("type \"{}\" is not read, UnstructuredGrid is", t.attributes["type"]));
        swap_ = (t.attributes["byte_order"] == "BigEndian") == (std::endian::native == std::endian::little);
        wide_ = t.attributes["header_type"] == "UInt64";
        compressed_ = t.attributes.count("compressor") > 0;
        if (compressed_ && t.attributes["compressor"] != "vtkZLibDataCompressor")
          fail(fmt::format("compressor \"{}\" is not read, vtkZLibDataCompressor is", t.attributes["compressor"]));
      } else if (t.name == "Piece") {
        if (piece) fail("more than one Piece is not read");
        piece = true;
      } else if (t.name == "Points" || t.name == "Cells" || t.name == "CellData" || t.name == "PointData" || t.name == "FieldData")
        section = t.name;
      else if (t.name == "AppendedData")
        break;
      else if (t.name == "DataArray")
        take(t, section, g);
    }
    if (!piece) fail("no UnstructuredGrid with a Piece in it");
    return g;
  }

 private:
  bool next(Tag& t) {
    for (;;) {
      const size_t open = text_.find('<', at_);
      if (open == std::string::npos) return false;
      if (text_.compare(open, 4, "<!--") == 0) {
        at_ = std::min(text_.find("-->", open), text_.size());
        continue;
      }
      const size_t close = text_.find('>', open);
      if (close == std::string::npos) fail("the file ends inside a tag");
      at_ = close + 1;
      if (text_[open + 1] == '?' || text_[open + 1] == '!') continue;
      t = {};
      t.end = at_;
      std::string body = text_.substr(open + 1, close - open - 1);
      t.empty = !body.empty() && body.back() == '/';
      size_t i = body.find_first_of(" \t\r\n/", 1);
      t.name = body.substr(0, i);
      while (i != std::string::npos && (i = body.find_first_not_of(" \t\r\n/", i)) != std::string::npos) {
        const size_t eq = body.find('=', i);
        if (eq == std::string::npos || eq + 1 >= body.size()) break;
        const char quote = body[eq + 1];
        const size_t stop = body.find(quote, eq + 2);
        if (stop == std::string::npos) break;
        t.attributes[body.substr(i, eq - i)] = body.substr(eq + 2, stop - eq - 2);
        i = stop + 1;
      }
      return true;
    }
  }

  void find_appended() {
    const size_t tag = text_.find("<AppendedData");
    if (tag == std::string::npos) return;
    const size_t close = text_.find('>', tag);
    appended_raw_ = text_.substr(tag, close - tag).find("raw") != std::string::npos;
    appended_ = text_.find('_', close);
    if (appended_ != std::string::npos) ++appended_;
  }

  /// Bytes of base64 text from `at`; `need` of them at least.
  std::string base64(size_t at, size_t need) const {
    static const auto value = [] {
      std::array<int, 256> v;
      v.fill(-1);
      const char* letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
      for (int i = 0; i < 64; ++i) v[static_cast<unsigned char>(letters[i])] = i;
      return v;
    }();
    std::string out;
    unsigned word = 0;
    int bits = 0;
    for (size_t i = at; i < text_.size() && out.size() < need; ++i) {
      const auto c = static_cast<unsigned char>(text_[i]);
      if (std::isspace(c)) continue;
      if (c == '=') break;
      if (value[c] < 0) break;
      word = word << 6 | static_cast<unsigned>(value[c]);
      if ((bits += 6) >= 8) out += static_cast<char>(word >> (bits -= 8) & 255);
    }
    if (out.size() < need) fail("the file ends in the middle of an array");
    return out;
  }
  /// Where base64 text of `n` bytes that starts at `at` ends.
  size_t behind_base64(size_t at, size_t n) const {
    size_t letters = (n + 2) / 3 * 4;
    while (at < text_.size() && letters > 0)
      if (!std::isspace(static_cast<unsigned char>(text_[at++]))) --letters;
    return at;
  }
  std::string bytes(size_t& at, size_t n, bool raw) const {
    if (!raw) {
      const std::string b = base64(at, n);
      at = behind_base64(at, n);
      return b;
    }
    if (at > text_.size() || n > text_.size() - at) fail("the file ends in the middle of an array");
    at += n;
    return text_.substr(at - n, n);
  }
  std::uint64_t header(const std::string& b, size_t i) const {
    const size_t size = wide_ ? 8 : 4;
    std::uint64_t x = 0;
    for (size_t k = 0; k < size; ++k) {
      const bool big = swap_ == (std::endian::native == std::endian::little);
      x |= static_cast<std::uint64_t>(static_cast<unsigned char>(b[i * size + k])) << 8 * (big ? size - 1 - k : k);
    }
    if (x > 1ull << 40) fail("an array of absurd size");
    return x;
  }

  std::string block(size_t at, bool raw) const {
    const size_t word = wide_ ? 8 : 4;
    size_t here = at;
    if (!compressed_) {  // header and data are one base64 run
      const auto n = header(bytes(here, word, raw), 0);
      here = at;
      return bytes(here, word + n, raw).substr(word);
    }
    const auto blocks = header(bytes(here, 3 * word, raw), 0);
    here = at;
    const std::string head = bytes(here, (3 + blocks) * word, raw);
    const auto size = header(head, 1), last = header(head, 2);
    std::uint64_t packed = 0;
    for (size_t i = 0; i < blocks; ++i) packed += header(head, 3 + i);
    const std::string data = bytes(here, packed, raw);
    std::string out;
    size_t from = 0;
    for (size_t i = 0; i < blocks; ++i) {
      const std::uint64_t whole = i + 1 == blocks && last ? last : size;
      if (whole > 1100 * header(head, 3 + i) + 64) fail("a compressed array is damaged");  // deflate packs by 1032 at most
      std::string part(whole, '\0');
      uLongf n = part.size();
      if (uncompress(reinterpret_cast<Bytef*>(part.data()), &n, reinterpret_cast<const Bytef*>(data.data() + from), header(head, 3 + i)) !=
              Z_OK ||
          n != part.size())
        fail("a compressed array is damaged");
      from += header(head, 3 + i);
      out += part;
    }
    return out;
  }

  std::vector<double> values(Tag& t) {
    const std::string format = t.attributes["format"], type = t.attributes["type"];
    std::vector<double> v;
    if (format == "ascii") {
      size_t i = t.end;
      const size_t stop = std::min(text_.find('<', i), text_.size());
      while (i < stop) {
        while (i < stop && std::isspace(static_cast<unsigned char>(text_[i]))) ++i;
        if (i >= stop) break;
        double x;
        const auto [end, bad] = std::from_chars(text_.data() + i, text_.data() + stop, x);
        if (bad != std::errc()) fail(fmt::format("DataArray \"{}\": not a number", t.attributes["Name"]));
        v.push_back(x);
        i = static_cast<size_t>(end - text_.data());
      }
      return v;
    }
    std::string b;
    if (format == "appended") {
      if (appended_ == std::string::npos || appended_ == 0) fail("an appended array, but no AppendedData");
      b = block(appended_ + std::stoull("0" + t.attributes["offset"]), appended_raw_);
    } else if (format == "binary")
      b = block(t.end, false);
    else
      fail(fmt::format("DataArray format \"{}\" is not read", format));
    const bool known = with_vtk_type(type, [&]<class U>(U) {
      for (size_t i = 0; i + sizeof(U) <= b.size(); i += sizeof(U)) v.push_back(static_cast<double>(vtk_number<U>(&b[i], swap_)));
    });
    if (!known) fail(fmt::format("DataArray type \"{}\" is not read", type));
    return v;
  }

  void take(Tag& t, const std::string& section, VtkGrid& g) {
    const std::string name = t.attributes["Name"];
    const bool one = t.attributes["NumberOfComponents"].empty() || t.attributes["NumberOfComponents"] == "1";
    if (section == "Points")
      g.points = values(t);
    else if (section == "CellData" && one && t.attributes["type"] != "String")
      g.cell_data[name] = values(t);
    else if (section == "CellData" || section == "PointData")
      g.not_read.insert(fmt::format("{} array \"{}\"", section == "CellData" ? "cell" : "node", name));
    else if (section == "Cells") {
      const auto v = values(t);
      const double most = name == "types" ? 255 : 1e15;
      if (!std::ranges::all_of(v, [&](double x) { return x >= 0 && x <= most; }))
        fail(fmt::format("{} of a cell are no such numbers", name));
      if (name == "connectivity") g.connectivity.assign(v.begin(), v.end());
      if (name == "types") g.types.assign(v.begin(), v.end());
      if (name == "offsets") {
        g.offsets = {0};
        g.offsets.insert(g.offsets.end(), v.begin(), v.end());
      }
    }
  }

  size_t appended_ = std::string::npos;
  bool appended_raw_ = false, swap_ = false, wide_ = false, compressed_ = false;
};

}  // namespace

VtkGrid read_vtu(const std::string& path, std::string bytes) { return Vtu(path, std::move(bytes)).read(); }

}  // namespace hilo
