#include "import/inp_lines.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "base/error.hpp"
#include "model/inputs.hpp"

namespace hilo {
namespace {

std::string_view strip(std::string_view s) {
  while (!s.empty() && std::isspace(static_cast<unsigned char>(s.front()))) s.remove_prefix(1);
  while (!s.empty() && std::isspace(static_cast<unsigned char>(s.back()))) s.remove_suffix(1);
  return s;
}

/// Cut at commas outside double quotes.
void cut(std::string_view line, std::vector<Field>& fields) {
  fields.clear();
  size_t from = 0;
  bool quoted = false;
  for (size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') quoted = !quoted;
    if (i < line.size() && (line[i] != ',' || quoted)) continue;
    const auto raw = line.substr(from, i - from);
    const auto text = strip(raw);
    const size_t lead = text.empty() ? 0 : static_cast<size_t>(text.data() - raw.data());
    fields.push_back({text, static_cast<int>(from + lead) + 1});
    from = i + 1;
  }
  while (!fields.empty() && fields.back().text.empty()) fields.pop_back();
}

std::string unquote(std::string_view s) {
  if (s.size() > 1 && s.front() == '"' && s.back() == '"') s = s.substr(1, s.size() - 2);
  return std::string(s);
}

}  // namespace

std::string upper(std::string_view s) {
  std::string u;
  for (const char c : s)
    if (!std::isspace(static_cast<unsigned char>(c))) u += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return u;
}

std::string DataLine::place() const { return fmt::format("{}:{}", *file, line); }
std::string DataLine::place(size_t field) const {
  return fmt::format("{}:{}:{}", *file, line, field < fields.size() ? fields[field].column : 1);
}

double DataLine::number(size_t field, double fallback) const {
  std::string_view s = text(field);
  if (s.empty()) return fallback;
  if (s.front() == '+') s.remove_prefix(1);
  double x;
  auto [end, bad] = std::from_chars(s.data(), s.data() + s.size(), x);
  if (bad == std::errc() && end == s.data() + s.size()) return x;
  // Fortran: 1.d-3, 1.5-3
  std::string f(s);
  for (size_t i = 0; i < f.size(); ++i)
    if (f[i] == 'd' || f[i] == 'D') f[i] = 'e';
  for (size_t i = 1; i < f.size(); ++i)
    if ((f[i] == '+' || f[i] == '-') && (std::isdigit(static_cast<unsigned char>(f[i - 1])) || f[i - 1] == '.')) f.insert(i++, 1, 'e');
  if (const auto plus = f.find("e+"); plus != std::string::npos) f.erase(plus + 1, 1);
  auto [end2, bad2] = std::from_chars(f.data(), f.data() + f.size(), x);
  if (bad2 != std::errc() || end2 != f.data() + f.size())
    throw Error(place(field), fmt::format("expected a number, found \"{}\"", text(field)));
  return x;
}

bool DataLine::is_integer(size_t field) const {
  const auto s = text(field);
  if (s.empty()) return false;
  for (size_t i = 0; i < s.size(); ++i)
    if (!std::isdigit(static_cast<unsigned char>(s[i])) && !(i == 0 && s.size() > 1 && (s[i] == '-' || s[i] == '+'))) return false;
  return true;
}

std::int64_t DataLine::integer(size_t field) const {
  std::string_view s = text(field);
  if (!s.empty() && s.front() == '+') s.remove_prefix(1);
  std::int64_t n;
  const auto [end, bad] = std::from_chars(s.data(), s.data() + s.size(), n);
  if (bad != std::errc()) throw Error(place(field), fmt::format("expected a whole number, found \"{}\"", text(field)));
  if (end == s.data() + s.size()) return n;
  const double x = number(field);  // "3." is read by CalculiX as 3
  if (x != std::floor(x)) throw Error(place(field), fmt::format("expected a whole number, found \"{}\"", text(field)));
  return static_cast<std::int64_t>(x);
}

std::string Card::place() const { return fmt::format("{}:{}", *file, line); }
std::string Card::place(const std::string& param) const {
  const auto p = params.find(param);
  return fmt::format("{}:{}:{}", *file, line, p == params.end() ? 1 : p->second.column);
}
std::string Card::value(const std::string& param, const std::string& fallback) const {
  const auto p = params.find(param);
  return p == params.end() ? fallback : p->second.value;
}
std::string Card::word(const std::string& param) const { return upper(value(param)); }
std::string Card::need(const std::string& param) const {
  const auto p = params.find(param);
  if (p == params.end() || p->second.value.empty()) throw Error(fmt::format("{}:1", place()), fmt::format("{} lacks {}=", name, param));
  return p->second.value;
}

std::string read_gz(const std::string& path, const std::string& place) {
  if (!std::filesystem::exists(path))
    throw Error(place.empty() ? path : place, place.empty() ? "no such file" : fmt::format("no file \"{}\"", path));
  if (std::filesystem::is_directory(path)) throw Error(place.empty() ? path : place, "a folder, not a file");
  note_input(path);
  gzFile in = gzopen(path.c_str(), "rb");
  if (!in) throw Error(place.empty() ? path : place, fmt::format("cannot read \"{}\"", path), "", Exit::resources);
  gzbuffer(in, 1 << 18);
  std::string text;
  std::vector<char> part(1 << 18);
  int n;
  while ((n = gzread(in, part.data(), static_cast<unsigned>(part.size()))) > 0) text.append(part.data(), static_cast<size_t>(n));
  const bool broken = n < 0;
  const bool cut_short = gzclose_r(in) != Z_OK;
  if (broken || cut_short) throw Error(place.empty() ? path : place, fmt::format("\"{}\" is truncated or damaged", path));
  return text;
}

InpLines::InpLines(const std::string& path) : folder_(std::filesystem::path(path).parent_path().string()) { open(path, ""); }

void InpLines::open(const std::string& path, const std::string& place) {
  Source s{std::make_shared<const std::string>(path), std::make_shared<const std::string>(read_gz(path, place)), 0, 0};
  if (s.text->substr(0, 65536).find('\0') != std::string::npos)
    throw Error(path, "not a text file", "hilo-import reads .inp decks as text");
  stack_.push_back(s);
  kept_.push_back(s);
}

void InpLines::include(std::string_view line, const std::string& place) {
  namespace fs = std::filesystem;
  std::vector<Field> fields;
  cut(line, fields);
  std::string name;
  for (const auto& f : fields)
    if (const auto eq = f.text.find('='); eq != std::string_view::npos && upper(f.text.substr(0, eq)) == "INPUT")
      name = unquote(strip(f.text.substr(eq + 1)));
  if (name.empty()) throw Error(place + ":1", "*INCLUDE lacks INPUT=");
  if (stack_.size() > 20)
    throw Error(place, fmt::format("*INCLUDE nested more than 20 deep at \"{}\"", name), "does a file include itself?");
  const fs::path p = fs::path(name).is_absolute() ? fs::path(name) : fs::path(folder_) / name;
  open(p.string(), place);
}

bool InpLines::next_line(std::string_view& line) {
  if (ahead_) {
    line = *ahead_;
    ahead_.reset();
    return true;
  }
  while (!stack_.empty()) {
    Source& s = stack_.back();
    if (s.at >= s.text->size()) {
      stack_.pop_back();
      continue;
    }
    const size_t end = std::min(s.text->find('\n', s.at), s.text->size());
    line = std::string_view(*s.text).substr(s.at, end - s.at);
    s.at = end + 1;
    ++s.line;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    const auto bare = strip(line);
    if (bare.empty() || bare.substr(0, 2) == "**") continue;
    if (bare.size() > 8 && bare.front() == '*' && upper(bare.substr(0, 8)) == "*INCLUDE") {
      include(bare, fmt::format("{}:{}", *s.path, s.line));
      continue;
    }
    return true;
  }
  return false;
}

bool InpLines::next_data(DataLine& data) {
  std::string_view line;
  if (!next_line(line)) return false;
  if (strip(line).front() == '*') {
    ahead_ = line;
    return false;
  }
  data.file = stack_.back().path.get();
  data.line = stack_.back().line;
  cut(line, data.fields);
  return true;
}

bool InpLines::next_card(Card& card) {
  std::string_view line;
  skipped_ = 0;
  for (;;) {
    if (!next_line(line)) return false;
    if (strip(line).front() == '*') break;
    ++skipped_;
  }
  card.file = stack_.back().path.get();
  card.line = stack_.back().line;
  card.params.clear();
  std::vector<Field> fields;
  for (bool first = true, more = true; more; first = false) {
    cut(line, fields);
    more = strip(line).back() == ',';
    for (const auto& f : fields) {
      if (first && &f == &fields.front()) {
        card.key = upper(f.text.substr(1));
        card.name.assign(1, '*');
        for (const char c : strip(f.text.substr(1)))
          if (!(std::isspace(static_cast<unsigned char>(c)) && card.name.back() == ' '))
            card.name += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
        continue;
      }
      const auto eq = f.text.find('=');
      const auto key = upper(f.text.substr(0, eq));
      if (key.empty()) continue;
      const auto value = eq == std::string_view::npos ? std::string_view{} : strip(f.text.substr(eq + 1));
      const int column =
          eq == std::string_view::npos || value.empty() ? f.column : f.column + static_cast<int>(value.data() - f.text.data());
      card.params[key] = {unquote(value), column};
    }
    if (more && !next_line(line)) break;
    if (more && strip(line).front() == '*') {  // a comma at the end with nothing behind it
      ahead_ = line;
      break;
    }
    // CalculiX decks end a card with a comma by mistake: a line of plain numbers is data
    if (more && line.find('=') == std::string_view::npos && !std::isalpha(static_cast<unsigned char>(strip(line).front()))) {
      ahead_ = line;
      break;
    }
  }
  return true;
}

}  // namespace hilo
