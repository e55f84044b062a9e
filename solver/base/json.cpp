// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/json.hpp"

#include <fmt/format.h>

#include <cmath>

namespace hilo {

std::string json_text(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += '\\', out += c;
    else if (c == '\n')
      out += "\\n";
    else if (c == '\t')
      out += "\\t";
    else if (static_cast<unsigned char>(c) < 0x20)
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      out += c;
  }
  return out + '"';
}

Json::Json(double x, int digits)
    : text_(!std::isfinite(x) ? "null"
            : digits > 0      ? fmt::format("{:.{}g}", x, digits)
                              : fmt::format("{}", x)) {}

std::string Json::text(size_t indent) const {
  if (!brackets_) return text_;
  const bool lines = in_ == In::lines && !members_.empty();
  const std::string next = lines ? "\n" + std::string(indent + 2, ' ') : "";
  std::string out{brackets_[0]};
  for (const auto& [key, value] : members_) {
    if (out.size() > 1) out += lines ? "," : ", ";
    out += next;
    if (brackets_[0] == '{') out += json_text(key) + ": ";
    out += value.text(indent + 2 * lines);
  }
  return out + (lines ? "\n" + std::string(indent, ' ') : "") + brackets_[1];
}

}  // namespace hilo
