// SPDX-License-Identifier: GPL-3.0-or-later
// Shells and beams of decks: rigid regions with their mass, centre and inertia, and no word but rigid.
#include "import_case.hpp"
#include "model/thin_regions.hpp"

namespace hilo::test::import_thin_test {
namespace {

/// Volume, centre and int (r.r I - r r^T) about it, of a region of out.h5.
struct Mass {
  double V;
  Vec3 c;
  Mat3 J;
};
Mass mass_of(const test::Workplace& place, const Mesh& m, const std::string& region) {
  const ThinRegion t = read_thin_regions(place / "out.h5").at(static_cast<size_t>(m.find_region(region)));
  const Vec3 c = t.first() / t.volume();
  const Mat3 S = t.second() - t.volume() * c * c.transpose();
  return {t.volume(), c, S.trace() * Mat3::Identity() - S};
}
/// Moments of a box about its centre.
Mat3 box(double V, double x, double y, double z) {
  return Mat3(Vec3(V / 12 * (y * y + z * z), V / 12 * (x * x + z * z), V / 12 * (x * x + y * y)).asDiagonal());
}

class ImportThin : public test::Import {};

const std::string plate =
    "GRID,1,,0.,0.,0.\nGRID,2,,2.,0.,0.\nGRID,3,,4.,0.,0.\nGRID,4,,4.,1.,0.\nGRID,5,,2.,1.,0.\nGRID,6,,0.,1.,0.\n"
    "CQUAD4,1,7,1,2,5,6\nCTRIA3,2,7,2,3,4\nCTRIA3,3,7,2,4,5\nMAT1,1,2.1+11,,.3,7850.\n";

TEST_F(ImportThin, APlateOfShellsHasTheMassOfTheBoxThatItIs) {
  const Mesh m = imported_deck("a.bdf", plate + "PSHELL,7,1,.1\n");
  const Mass mass = mass_of(place, m, "pid_7");
  EXPECT_NEAR(mass.V, 0.4, 1e-14);
  EXPECT_LT((mass.c - Vec3(2, .5, 0)).norm(), 1e-14);
  EXPECT_LT((mass.J - box(.4, 4, 1, .1)).norm(), 1e-13);
  EXPECT_NEAR(read_thin_regions(place / "out.h5")[0].thickness, .1, 1e-15);
  EXPECT_EQ(m.region_data[0].density, 7850);
  expect_said("region \"pid_7\" has shells or beams: it can be rigid alone (--thicken makes solid-shells)");
  const Mass scaled = mass_of(place, imported_deck("b.bdf", plate + "PSHELL,7,1,100.\n", "--units mm-t-s"), "pid_7");
  EXPECT_NEAR(scaled.V, 0.4e-6, 1e-18);
  EXPECT_NEAR(scaled.J(2, 2), box(.4e-6, 4e-3, 1e-3, .1)(2, 2), 1e-18);
}

TEST_F(ImportThin, OffsetsAndLayersMoveTheMidSurface) {
  const Mass mass = mass_of(place,
                            imported_deck("a.bdf",
                                          "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,1.,1.,0.\nGRID,4,,0.,1.,0.\nCQUAD4,1,7,1,2,3,4,,.2\n"
                                          "PCOMP,7,0.,,,,,,,+\n+,1,.01,,,,.02,,,+\n+,1,.03\nMAT1,1,1.,,.3,1.\n"),
                            "pid_7");  // layers from the grids' plane up, all .2 higher
  EXPECT_NEAR(mass.V, .06, 1e-15);
  EXPECT_NEAR(mass.c.z(), .2 + .03, 1e-15);
}

// Layers of one material are one plate of their thickness; of several, a region with thickness alone, which is told, and no solid-shell.
TEST_F(ImportThin, LayersOfInpDecksAreOnePlateOrAreTold) {
  const auto deck = [](const std::string& layers) {
    return "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n*ELEMENT,TYPE=S4,ELSET=E\n1,1,2,3,4\n*MATERIAL,NAME=M\n*ELASTIC\n2e11,.3\n*"
           "DENSITY\n1.\n"
           "*MATERIAL,NAME=N\n*ELASTIC\n1e10,.3\n*DENSITY\n2.\n*SHELL SECTION,ELSET=E,COMPOSITE,OFFSET=-.5\n" +
           layers;
  };
  const Mass mass = mass_of(place, imported_deck("a.inp", deck(".01,,M\n.03,3,m\n.02,,M\n")), "E");
  EXPECT_NEAR(mass.V, .06, 1e-15);
  EXPECT_NEAR(mass.c.z(), .03, 1e-15);
  EXPECT_NEAR(volume(imported("a.inp", "--thicken")), .06, 1e-12);
  EXPECT_NEAR(mass_of(place, imported_deck("b.inp", deck(".01,,M\n.03,,N\n.01,,M\n")), "E").V, .05, 1e-15);
  expect_said("*SHELL SECTION, COMPOSITE of several materials: no stiffness, no density");
  refused("b.inp -o b.h5 --thicken", 2,
          "b.inp: element 1: *SHELL SECTION, COMPOSITE of several materials is no plate of one material (leave them as they "
          "are: regions that are rigid)");
  refused_deck("c.inp", deck(".01,,\n"), "-o c.h5", 2,
               "c.inp:19: *SHELL SECTION, COMPOSITE: a layer without a material (thickness, , MATERIAL)");
  refused_deck("d.inp", deck("0,,M\n"), "-o d.h5", 2, "d.inp:19:1: *SHELL SECTION: a layer of thickness 0");
}

TEST_F(ImportThin, ABarHasTheInertiaOfItsSection) {
  const Mesh m = imported_deck(
      "a.bdf",
      "GRID,1,,0.,0.,0.\nGRID,2,,3.,0.,0.\nCBAR,1,5,1,2,0.,1.,0.\nPBARL,5,1,,BAR,,,,,+\n+,.2,.4\nMAT1,1,1.,,.3,1.\n"
      "GRID,3,,0.,0.,5.\nGRID,4,,0.,0.,6.\nGRID,9,,0.,9.,5.\nCBEAM,2,6,3,4,9,,,,+\n+,,,.5,0.,0.,.5,0.,0.\nPBEAM,6,1,.02,3.,2.\n",
      "--rigid-beams");
  const Mass bar = mass_of(place, m, "pid_5");  // .4 high along y, .2 wide along z
  EXPECT_NEAR(bar.V, 3 * .08, 1e-15);
  EXPECT_LT((bar.J - box(bar.V, 3, .4, .2)).norm(), 1e-14);
  const Mass beam = mass_of(place, m, "pid_6");  // along z, plane 1 towards y; its ends are .5 off along x
  EXPECT_LT((beam.c - Vec3(.5, 0, 5.5)).norm(), 1e-14);
  EXPECT_NEAR(beam.J(2, 2), 3 + 2, 1e-12) << "I1 + I2, of a beam of length 1";
  EXPECT_NEAR(beam.J(0, 0), 3 + .02 / 12, 1e-12) << "about x: int y^2, and its length";
}

TEST_F(ImportThin, ShellsAndBeamsOfInpDecksToo) {
  const std::string deck =
      "*NODE\n1,0,0,0\n2,4,0,0\n3,4,1,0\n4,0,1,0\n5,2,0,0\n6,4,.5,0\n7,2,1,0\n8,0,.5,0\n11,0,0,3\n12,0,0,5\n"
      "*ELEMENT, TYPE=S8R, ELSET=PLATE\n1,1,2,3,4,5,6,7,8\n*ELEMENT, TYPE=B31, ELSET=BEAM\n2,11,12\n"
      "*MATERIAL, NAME=M\n*ELASTIC\n1e9,.3\n*DENSITY\n2\n";
  place.write(
      "a.inp",
      deck + "*SHELL SECTION, ELSET=PLATE, MATERIAL=M, OFFSET=.5\n.1\n*BEAM SECTION, ELSET=BEAM, MATERIAL=M, SECTION=RECT\n.2,.4\n1,0,0\n");
  const Mesh m = imported("a.inp");
  const Mass plate = mass_of(place, m, "PLATE"), beam = mass_of(place, m, "BEAM");
  EXPECT_LT((plate.c - Vec3(2, .5, -.05)).norm(), 1e-14) << "the nodes are on its top";
  EXPECT_LT((plate.J - box(.4, 4, 1, .1)).norm(), 1e-13);
  EXPECT_LT((beam.J - box(.16, .2, .4, 2)).norm(), 1e-14) << ".2 along direction 1, x";
  refused_deck("b.inp", deck + "*SHELL SECTION, ELSET=PLATE, MATERIAL=M\n.1\n", "-o b.h5", 2,
               "b.inp:15: element 2 has no section (shells need *SHELL SECTION, beams *BEAM SECTION)");
  // the section of another kind of element, each way around
  const std::string solid = "*NODE\n21,0,0,9\n22,1,0,9\n23,0,1,9\n24,0,0,10\n*ELEMENT, TYPE=C3D4, ELSET=SOLID\n3,21,22,23,24\n",
                    beam_section = "*BEAM SECTION, ELSET=BEAM, MATERIAL=M, SECTION=RECT\n.2,.4\n1,0,0\n",
                    plate_section = "*SHELL SECTION, ELSET=PLATE, MATERIAL=M\n.1\n";
  const std::pair<std::string, const char*> wrong[] = {
      {"*SHELL SECTION, ELSET=SOLID, MATERIAL=M\n.1\n" + plate_section + beam_section,
       "*SHELL SECTION on element 3 (it needs *SOLID SECTION)"},
      {"*SOLID SECTION, ELSET=PLATE, MATERIAL=M\n" + beam_section, "*SOLID SECTION on element 1 (it needs *SHELL SECTION)"},
  };
  for (const auto& [sections, message] : wrong) {
    refused_deck("c.inp", deck + solid + sections, "-o c.h5", 2, std::string("c.inp:28:23: ") + message);
  }
  for (const char* type : {"S8", "S8R"}) {
    std::string text = deck;
    text.replace(text.find("S8R"), 3, type);
    const Mesh all = imported_deck("c.inp", text + solid + "*SOLID SECTION, ELSET=SOLID, MATERIAL=M\n" + plate_section + beam_section);
    EXPECT_EQ(cells_of(all, "PLATE"), 1) << type;
    EXPECT_EQ(cells_of(all, "SOLID"), 1) << type;
  }
}

TEST_F(ImportThin, ShellsOnSolidsStaySetsOfFacets) {
  const Mesh m = imported_deck(
      "a.bdf",
      "GRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nGRID,3,,0.,1.,0.\nGRID,4,,0.,0.,1.\nCTETRA,1,1,1,2,3,4\nPSOLID,1,1\nMAT1,1,1.,,.3,1.\n"
      "CTRIA3,2,7,1,2,3\nPSHELL,7,1,.1\n");
  EXPECT_EQ(m.n_cells(), 1);
  EXPECT_EQ(m.facet_sets.at("pid_7").size(), 1u);
}

/// A plate of shells swings about an edge: J = m b^2/3 + m t^2/12, small angles.
TEST_F(ImportThin, OnlyRigidMayBeSaidOfThemAndAPlateSwingsAsItShould) {
  imported_deck("a.bdf", plate + "PSHELL,7,1,.1\n");
  expect_end(place.run("hilo-tag out.h5 --nonlinear pid_7 -o tags.h5"), 2,
             "region \"pid_7\" has shells or beams: there is no element of them, it can be rigid alone, not nonlinear");
  place.write(
      "scene.toml",
      "gravity = [0, -9.81, 0]\n[[joint]]\nkind = \"revolute\"\nname = \"hinge\"\na = \"ground\"\nb = \"pid_7\"\nat = [0, 1, 0]\n"
      "axis = [1, 0, 0]\n[[probe]]\nname = \"edge\"\non = \"pid_7\"\nat = [0, 0, 0]\n[[load]]\nkind = \"force\"\nname = \"push\"\non = "
      "\"pid_7\"\nat = [2, 0, 0]\nforce = [0, 0, 1]\n[time]\nend = 0.6\nstep = 1e-3\n");
  expect_end(place.run("hilo-solve scene.toml out.h5 -o run.h5"), 2,
             "there is no element of them, it can be rigid alone (hilo-tag --rigid 'pid_7')");
  const auto tagged = succeeded(place.run("hilo-tag out.h5 -o tags.h5"));
  EXPECT_NE(tagged.err.find("region \"pid_7\" has shells or beams, so it is rigid"), std::string::npos) << tagged.err;
  const auto ran = succeeded(place.run("hilo-solve --quiet scene.toml tags.h5 -o run.h5 && hilo-post series run.h5 probe.edge.z -o -"));
  const double z = std::strtod(ran.out.substr(ran.out.rfind(',') + 1).c_str(), nullptr);  // at the end
  // angle = M/(m g s) (1 - cos w t) with the force's moment M = 1 N m, s = 1/2 m
  const double mass = 7850 * .4, J = mass * (1. / 3 + .01 / 12), w = std::sqrt(mass * 9.81 * .5 / J);
  EXPECT_NEAR(z, 1 / (mass * 9.81 * .5) * (1 - std::cos(w * .6)), 1e-9);
  EXPECT_EQ(place.run("hilo-post mesh tags.h5 -o mesh.png && hilo-post render run.h5 --field displacement --times 0.6 -o run.png").exit, 0);
}

}  // namespace
}  // namespace hilo::test::import_thin_test
