// SPDX-License-Identifier: GPL-3.0-or-later
// Damaged decks: whatever a line says, it is read or refused by place, and the scene lines that come of it are a scene.
#include <random>

#include "base/error.hpp"
#include "import/imported.hpp"
#include "import_case.hpp"
#include "model/scene.hpp"

namespace hilo::test::import_attack_test {
namespace {

/// Cut, doubled, swapped and overwritten pieces; some values that no field expects.
std::string damaged(std::string s, std::mt19937& random) {
  const auto below = [&](size_t n) { return n ? static_cast<size_t>(random() % n) : 0; };
  const char* tokens[] = {"",       "0",       "-1",       "1e300", "-1e-300", "99999999999999999999",
                          "THRU",   "+",       "*",        ",",     "\t",      "$",
                          "'",      "\"",      "=",        ".",     "1",       "2",
                          "123456", "7",       "END STEP", "nan",   "\n",      " ",
                          "GRID",   "*NODE\n", "1,2,3",    "8",     "100"};
  for (size_t n = 1 + below(4); n > 0; --n) {
    const size_t line = s.rfind('\n', below(s.size())) + 1, end = std::min(s.find('\n', line), s.size());
    const size_t field = std::min(s.find(',', line + below(end - line)), end), next = std::min(s.find(',', field + 1), end);
    switch (below(7)) {
      case 0:
        s.erase(line, end - line);
        break;
      case 1:
        s.insert(line, s.substr(line, end + 1 - line));
        break;
      case 2:
        if (field < next) s.replace(field + 1, next - field - 1, tokens[below(std::size(tokens))]);
        break;
      case 3:
        s.insert(below(s.size()), tokens[below(std::size(tokens))]);
        break;
      case 4:
        s[below(s.size())] = static_cast<char>(' ' + below(95));
        break;
      case 5: {
        const size_t other = s.rfind('\n', below(s.size())) + 1, to = std::min(s.find('\n', other), s.size());
        s.insert(line, s.substr(other, to - other) + "\n");
        break;
      }
      default:
        if (below(20) == 0) s.resize(below(s.size()));
    }
    if (s.empty()) s = "\n";
  }
  return s;
}

struct Counts {
  int read = 0, refused = 0;
};

Counts attack(const std::string& name, const std::string& text, int tries, const test::Workplace& place) {
  std::mt19937 random(4711);
  Counts n;
  for (int i = 0; i < tries; ++i) {
    const std::string bad = damaged(text, random);
    place.write(name, bad);
    ImportOptions options;
    options.order = i % 5 == 0 ? 2 : 1;
    options.every_subcase = i % 4 == 1 && name.ends_with(".bdf");
    try {
      Imported in = read_any(place / name, options);
      finish(in, place / name, options);
      ++n.read;
      for (const auto& x : in.mesh.X) EXPECT_TRUE(x.allFinite());
      for (const auto& [set, nodes] : in.mesh.node_sets)
        for (const auto a : nodes) EXPECT_LT(a, in.mesh.n_nodes()) << set;
      if (in.mesh.deck_scene.empty()) continue;
      try {
        const Scene s = Scene::parse(in.mesh.deck_scene, "scene");
        for (const char* section : {"motion", "load", "point_mass"})
          for (const auto& e : s.entries(section)) {
            const bool body = std::ranges::any_of(s.entries("body"), [&](const Entry& b) { return b.name == e.text("on"); });
            EXPECT_TRUE(body || !in.mesh.nodes_of(e.text("on"), "scene").empty());
          }
      } catch (const Error& e) {
        // a value that the deck says and no law takes: told by the solver with the key
        const std::string what = e.what();
        if (what.find("beyond what can be computed") != what.npos || what.find(" is not > ") != what.npos ||
            what.find(" is not >= ") != what.npos || what.find(" is not in ") != what.npos)
          continue;
        ADD_FAILURE() << e.what() << "\n" << in.mesh.deck_scene << "\n--- of\n" << bad;
      }
    } catch (const Error& e) {
      ++n.refused;
      EXPECT_TRUE(e.exit == Exit::input || e.exit == Exit::usage) << e.what();
      EXPECT_FALSE(std::string(e.what()).empty());
    }
    if (testing::Test::HasFailure()) {
      place.write(name, bad);
      ADD_FAILURE() << i << ": " << bad;
      break;
    }
  }
  return n;
}

const std::string nastran = R"(SOL 101
CEND
TITLE = all cards
SPC = 1
SUBCASE 1
 LOAD = 9
BEGIN BULK
$HMNAME PROP                   1"block"
CORD2R,7,,0.,0.,0.,0.,0.,1.
,0.,1.,0.
CORD2C,8,7,0.,0.,0.,0.,0.,1.
,1.,0.,0.
CORD1R,9,1,2,4
GRDSET,,,,,,,456
GRID,1,,0.,0.,0.
GRID           2              1.      0.      0.
GRID*                  3                              1.              1.
*                    0.0
GRID,4,7,1.,0.,0.
GRID,5,8,0.,0.,1.
GRID,6,,1.,0.,1.
GRID,7,,1.,1.,1.,7
GRID,8,,0.,1.,1.
GRID,100,,.5,.5,2.,,0
GRID,101,,.5,.5,3.,7,0
GRID,102,9,.5,.5,-1.
CHEXA,1,1,1,2,3,4,5,6
,7,8
CQUAD4,2,5,5,6,7,8
PSOLID,1,1
MAT1,1,2.1+11,,0.3,7850.
MATS1,1,,PLASTIC,1.+9,1,1,2.5+8
RBE2,20,100,123456,5,6,7,8
RBAR,21,100,101,123456
RBE3,22,,102,123456,1.,123,1,2
,3,4
CONM2,23,101,7,3.,.1,.2,.3
,1.,.1,1.,0.,0.,1.
CONM2,24,6,,1.
CELAS1,25,30,101,2
CELAS2,26,5.,101,1,100,1
CDAMP2,27,5.,101,3
CBUSH,28,31,101,,,,,7
PELAS,30,100.
PBUSH,31,K,1.,2.,3.,4.,5.,6.
,,B,1.,2.,3.,4.,5.,6.
SPC1,1,123,1,THRU,4
SPC,1,8,2,.1
SPCADD,3,1
FORCE,2,7,8,100.,1.,0.,0.
FORCE,2,102,,100.,1.,0.,0.
MOMENT,2,101,,100.,1.,0.,0.
FORCE1,2,6,1.,1,2
PLOAD4,4,1,5.,,,,5,7
PLOAD4,4,2,5.,,,,THRU,2
,7,1.,0.,0.
PLOAD,4,5.,1,2,3,4
GRAV,5,,9.81,0.,0.,-1.
LOAD,9,1.,1.,2,1.,4,2.,5
PARAM,WTMASS,1.
ENDDATA
)";

const std::string abaqus = R"(*HEADING
all cards
*PART, NAME=block
*NODE, NSET=all
1, 0., 0., 0.
2, 1., 0., 0.
3, 1., 1., 0.
4, 0., 1., 0.
5, 0., 0., 1.
6, 1., 0., 1.
7, 1., 1., 1.
8, 0., 1., 1.
*ELEMENT, TYPE=C3D8, ELSET=e
1, 1, 2, 3, 4, 5, 6, 7, 8
*NSET, NSET=s, GENERATE
1, 4, 1
*SURFACE, NAME=f
e, S1
*ORIENTATION, NAME=o
1., 0., 0., 0., 1., 0.
*SOLID SECTION, ELSET=e, MATERIAL=m, ORIENTATION=o
*END PART
*ASSEMBLY, NAME=a
*INSTANCE, NAME=b-1, PART=block
*END INSTANCE
*NODE
1, .5, .5, 2.
2, .5, .5, 3.
*NSET, NSET=s, INSTANCE=b-1
5, 6, 7, 8
*NSET, NSET=ref
1,
*NSET, NSET=rot
2,
*SURFACE, NAME=f
b-1.e, S2
*ELEMENT, TYPE=MASS, ELSET=p
10, 1
*MASS, ELSET=p
2.
*ELEMENT, TYPE=SPRINGA, ELSET=q
11, 1, 2
*SPRING, ELSET=q

5.
*ELEMENT, TYPE=SPRING1, ELSET=r
12, 2
*SPRING, ELSET=r
1
5.
*COUPLING, REF NODE=ref, SURFACE=f, CONSTRAINT NAME=c
*KINEMATIC
1, 6
*END ASSEMBLY
*RIGID BODY, NSET=s, REF NODE=1000000000001, ROT NODE=1000000000002
*MATERIAL, NAME=m
*ELASTIC, TYPE=ENGINEERING CONSTANTS
1., 1., 1., .1, .1, .1, 1., 1.
1.
*DENSITY
1.
*AMPLITUDE, NAME=t
0., 0., 1., 1.
*BOUNDARY
b-1.s, PINNED
b-1.5, 1, 2, .1
ref, 2, 6
*INITIAL CONDITIONS, TYPE=VELOCITY
b-1.all, 1, 2.
*STEP
*DYNAMIC
.1, 1.
*CLOAD, AMPLITUDE=t
ref, 1, 2.
ref, 4, 2.
s, 3, 1.
*DSLOAD
f, P, 2.
*DLOAD
b-1.e, GRAV, 9.81, 0., 0., -1.
*END STEP
)";

// Nodes and elements generated and copied, springs and dampers by tables, supports by velocity and acceleration.
const std::string generated = R"(*SYSTEM
0., 0., 0., 1., 0., 0.
0., 1., 0.
*NODE, SYSTEM=C
1, 0., 0., 0.
3, 2., 0., 0.
*NODE
21, 0, 2, 0
23, 2, 2, 0
201, 0, 0, 4
203, 2, 0, 4
221, 0, 2, 4
223, 2, 2, 4
*NGEN, NSET=front
1, 3
*NGEN, NSET=back
21, 23, 1
*NFILL, NSET=floor, BIAS=1.5
front, back, 2, 10
*NGEN
201, 203
*NSET, NSET=up, GENERATE
201, 203
*NSET, NSET=up2, GENERATE
221, 223
*NGEN
221, 223
*NFILL, NSET=roof, BIAS=1.5
up, up2, 2, 10
*NFILL, TWO STEP
floor, roof, 2, 100
*ELEMENT, TYPE=C3D8, ELSET=block
1, 1, 2, 12, 11, 101, 102, 112, 111
*ELGEN, ELSET=block
1, 2, 1, 1, 2, 10, 10, 2, 100, 100
*NCOPY, OLD SET=roof, CHANGE NUMBER=1000, SHIFT, MULTIPLE=2, NEW SET=far
0., 0., 3.
0., 0., 0., 0., 0., 1., 30.
*NCOPY, OLD SET=roof, CHANGE NUMBER=5000, REFLECT=MIRROR
0., 0., 7., 1., 0., 7.
0., 1., 7.
*NODE
901, 5., 0., 0.
903, 5., 2., 0.
*NGEN, LINE=C
901, 903, 1, , 5., 1., 0., 0., 0., 1.
*ELEMENT, TYPE=MASS, ELSET=p
901, 901
*ELGEN, ELSET=p
901, 3
*MASS, ELSET=p
2.
*ELEMENT, TYPE=SPRING1, ELSET=s
910, 901
*SPRING, ELSET=s, NONLINEAR
1
-1., -1.
1., 1.
*ELEMENT, TYPE=DASHPOT2, ELSET=d
911, 901, 902
*DASHPOT, ELSET=d, NONLINEAR
2, 2
-1., -1.
1., 1.
*ELEMENT, TYPE=DASHPOTA, ELSET=da
912, 902, 903
*DASHPOT, ELSET=da, NONLINEAR

-1., -1.
1., 1.
*MATERIAL, NAME=m
*ELASTIC
1e9, 0.
*DENSITY
1000.
*SOLID SECTION, ELSET=block, MATERIAL=m
*MPC
PLANE, floor
STRAIGHT, 201, 202,
203
BEAM, 101, 223
*AMPLITUDE, NAME=q
0., 0., 1., 1., 1., 2., 3., 0.
*BOUNDARY
floor, 1, 3
901, 1, 6
*STEP
*DYNAMIC, DIRECT
.1, 1.
*BASE MOTION, DOF=1, AMPLITUDE=q, SCALE=2.
*BOUNDARY, TYPE=VELOCITY, AMPLITUDE=q
903, 2, 2, 1.
*END STEP
)";

TEST(ImportAttack, DamagedDecksThatGenerateAreReadOrRefused) {
  const test::Workplace place;
  const Counts n = attack("a.inp", generated, 600, place);
  EXPECT_GT(n.read, 100);
  EXPECT_GT(n.refused, 100);
}

TEST(ImportAttack, DamagedNastranFilesAreReadOrRefused) {
  const test::Workplace place;
  const Counts n = attack("a.bdf", nastran, 2000, place);
  EXPECT_GT(n.read, 300);
  EXPECT_GT(n.refused, 300);
}

TEST(ImportAttack, DamagedDecksOfPartsAreReadOrRefused) {
  const test::Workplace place;
  const Counts n = attack("a.inp", abaqus, 2000, place);
  EXPECT_GT(n.read, 300);
  EXPECT_GT(n.refused, 300);
}

TEST(ImportAttack, DamagedInpDecksAreReadOrRefused) {
  const test::Workplace place;
  place.write("loads_mesh.inp", test::text_of(std::string(HILO_SOURCE) + "/tests/tools/decks/loads_mesh.inp"));
  const Counts n = attack("a.inp", test::text_of(std::string(HILO_SOURCE) + "/tests/tools/decks/loads.inp"), 2000, place);
  EXPECT_GT(n.read, 300);
  EXPECT_GT(n.refused, 300);
}

}  // namespace
}  // namespace hilo::test::import_attack_test
