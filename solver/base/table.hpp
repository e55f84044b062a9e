// SPDX-License-Identifier: GPL-3.0-or-later
// A table on stdout, aligned for people or as JSON for programs.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace hilo {

/// Text as a JSON string, quotes included.
std::string json_text(std::string_view text);
/// A number as JSON; null for what is not finite.
std::string json_number(double x);

/// Rows of cells under a header.  Columns of numbers are set to the right, and are numbers in JSON ("-" is null there).
struct Table {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
  size_t n_text = 1;  // leading columns that are text even where they look like numbers
  int digits = 0;     // significant digits of numbers in text(); 0: as they are.  JSON has all of them
  /// Lines "name   cells"; an empty table prints nothing.
  std::string text() const;
  /// [{"name": "hull", "cells": 12}, ...]
  std::string json(std::string_view indent = "  ") const;
};

}  // namespace hilo
