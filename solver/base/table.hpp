// SPDX-License-Identifier: GPL-3.0-or-later
// A table on stdout, aligned for people or as JSON for programs.
#pragma once
#include <string>
#include <vector>

#include "base/json.hpp"

namespace hilo {

/// Rows of cells under a header.  Columns of numbers are set to the right, and are numbers in JSON ("-" is null there).
struct Table {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
  size_t n_text = 1;  // leading columns that are text even where they look like numbers
  int digits = 0;     // significant digits of numbers in text(); 0: as they are.  JSON has all of them
  /// Lines "name   cells"; an empty table prints nothing.
  std::string text() const;
  /// [{"name": "hull", "cells": 12}, ...]
  Json json() const;
};

}  // namespace hilo
