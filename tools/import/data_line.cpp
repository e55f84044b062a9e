// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/data_line.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "base/error.hpp"
#include "model/inputs.hpp"

namespace hilo {

std::string_view strip(std::string_view s) {
  while (!s.empty() && std::isspace(static_cast<unsigned char>(s.front()))) s.remove_prefix(1);
  while (!s.empty() && std::isspace(static_cast<unsigned char>(s.back()))) s.remove_suffix(1);
  return s;
}

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
  if (bad == std::errc() && end == s.data() + s.size() && std::isfinite(x)) return x;
  // Fortran: 1.d-3, 1.5-3
  std::string f(s);
  for (size_t i = 0; i < f.size(); ++i)
    if (f[i] == 'd' || f[i] == 'D') f[i] = 'e';
  for (size_t i = 1; i < f.size(); ++i)
    if ((f[i] == '+' || f[i] == '-') && (std::isdigit(static_cast<unsigned char>(f[i - 1])) || f[i - 1] == '.')) f.insert(i++, 1, 'e');
  if (const auto plus = f.find("e+"); plus != std::string::npos) f.erase(plus + 1, 1);
  auto [end2, bad2] = std::from_chars(f.data(), f.data() + f.size(), x);
  if (bad2 != std::errc() || end2 != f.data() + f.size() || !std::isfinite(x))
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
  if (x != std::floor(x) || !(std::abs(x) < 1e15))
    throw Error(place(field), fmt::format("expected a whole number, found \"{}\"", text(field)));
  return static_cast<std::int64_t>(x);
}

std::string read_gz(const std::string& path, const std::string& place) {
  std::error_code too_long;
  if (!std::filesystem::exists(path, too_long))
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

}  // namespace hilo
