// SPDX-License-Identifier: GPL-3.0-or-later
// Regions that share nodes have their own stress there: a stiff layer, one cell thick, within a soft block that is pulled.
#include "scene_parts.hpp"
#include "verify/verify.hpp"

namespace hilo::test::shared_nodes_test {
namespace {

constexpr double strain = 1e-4, soft = 1e9, stiff = 2e11;

std::string pulled(const std::string& more) {
  return solid(soft, 0, 1000, "soft") + solid(stiff, 0, 1000, "stiff", more) + held("xmin") +
         motion("translation", "pull", "xmax", "displacement = [1e-4, 0, 0]") + in_steps(1) +
         "[[quantity]]\nname = \"in soft\"\nkind = \"peak\"\nstress = \"soft\"\n"
         "[[quantity]]\nname = \"in stiff\"\nkind = \"peak\"\nstress = \"stiff\"\n";
}

/// The number behind these words in a text.
double behind(const std::string& text, const std::string& words) {
  const auto at = text.find(words);
  return at == text.npos ? std::nan("") : std::stod(text.substr(at + words.size()));
}

// Truth: E times the strain in each, whichever region comes first: of quantities, of peaks (by envelopes too), at a point and along a line.
TEST(SharedNodes, HaveTheStressOfEachRegion) {
  for (const bool stiff_first : {false, true}) {
    SceneCase c(pulled(""));
    c.use(block_mesh({.n = {4, 2, 3},
                      .regions = stiff_first ? std::vector<std::string>{"stiff", "soft"} : std::vector<std::string>{"soft", "stiff"},
                      .region_of = [&](const Vec3& x) { return (std::abs(x[2] - 0.5) < 0.1) != stiff_first; }}));
    for (const std::string envelope : {"false", "true"}) {
      c.solve("--quiet --set output.envelope=" + envelope);
      const std::string quantities = c.run("hilo-post quantity run.h5 --json").out, peaks = c.run("hilo-post peak run.h5 --unit Pa").out;
      for (const auto& [name, E] : {std::pair{"soft", soft}, {"stiff", stiff}}) {
        EXPECT_NEAR(behind(peaks, std::string("\n") + name + " ") / (E * strain), 1, 1e-3) << name << "\n" << peaks;
        const std::string there =
            c.run(std::string("hilo-post at run.h5 von_mises --point 0.5,0.5,0.5 --unit Pa --steps last --show ") + name).out;
        if (E == stiff) {
          EXPECT_NEAR(behind(there.substr(there.find('\n')), "1 ") / (E * strain), 1, 1e-3) << there;
        }
        const auto entry = quantities.find(std::string("in ") + name);
        ASSERT_NE(entry, std::string::npos) << quantities;
        EXPECT_NEAR(behind(quantities.substr(entry), "\"value\": ") / (E * strain), 1, 1e-3) << quantities;
      }
    }
  }
}

}  // namespace
}  // namespace hilo::test::shared_nodes_test
