// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/text_input.hpp"

#include <algorithm>
#include <cctype>

#include "base/error.hpp"

namespace hilo {

void TextInput::fail(const std::string& what, const std::string& hint) const { throw Error(place(), what, hint); }

std::string TextInput::place() const {
  const auto here = text_.begin() + static_cast<std::ptrdiff_t>(std::min(at_, text_.size()));
  return fmt::format("{}:{}", path_, 1 + std::count(text_.begin(), here, '\n'));
}

void TextInput::blanks() {
  for (; at_ < text_.size(); ++at_)
    if (comment_ != '\0' && text_[at_] == comment_)
      at_ = std::min(text_.find('\n', at_), text_.size()) - 1;
    else if (!std::isspace(static_cast<unsigned char>(text_[at_])))
      return;
}

std::string_view TextInput::word() {
  blanks();
  const size_t from = at_;
  while (at_ < text_.size() && !std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
  return std::string_view(text_).substr(from, at_ - from);
}

std::string_view TextInput::line() {
  const size_t from = at_, end = std::min(text_.find('\n', at_), text_.size());
  at_ = std::min(end + 1, text_.size());
  return std::string_view(text_).substr(from, end - from - (end > from && text_[end - 1] == '\r'));
}

}  // namespace hilo
