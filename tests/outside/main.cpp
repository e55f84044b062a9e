// SPDX-License-Identifier: GPL-3.0-or-later
// The list of all that this program adds.
#include <gtest/gtest.h>

#include "outside.hpp"

int main(int argc, char** argv) {
  outside::add_deck_card();
  outside::add_integrator();
  outside::add_joint();
  outside::add_materials();
  outside::add_force_law();
  outside::add_output_field();
  outside::add_balls();
  outside::add_buffer();
  outside::add_pyramid();
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
