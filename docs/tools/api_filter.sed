# SPDX-License-Identifier: GPL-3.0-or-later
# What Doxygen sees of a header: the comment at its top describes the file, words in angle brackets are no HTML, formulas keep their signs.
1,/^#pragma once/{
  s,^// SPDX.*,/// @file,
  s,^// ,/// ,
  s,^//$,///,
}
/\/\//{
  s/<\([a-z]*\)>/\&lt;\1\&gt;/g
}
