// The list of all that this program adds.
#include <gtest/gtest.h>

#include "outside.hpp"

int main(int argc, char** argv) {
  outside::add_integrator();
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
