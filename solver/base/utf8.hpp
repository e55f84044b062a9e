// SPDX-License-Identifier: GPL-3.0-or-later
// Text of older programs as UTF-8.
#pragma once
#include <string>

namespace hilo {

/// The text with each byte that is no UTF-8 taken as Latin-1: "K\xF6rper" becomes "Körper".  What is UTF-8 stays.
std::string as_utf8(std::string text);

}  // namespace hilo
