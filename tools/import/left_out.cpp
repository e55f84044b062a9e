// SPDX-License-Identifier: GPL-3.0-or-later
// What a model lacks by a card that was not read, and the [[left_out]] of a scene.
#include <algorithm>
#include <cctype>
#include <vector>

#include "base/param.hpp"
#include "import/imported.hpp"

namespace hilo {
namespace {

struct Loss {
  std::string_view of;
  std::vector<std::string_view> words;
};
/// With which words a card begins, by what a model lacks without it, "" for nothing; of several the longest words decide.
const std::vector<Loss>& losses() {
  static const std::vector<Loss> all{
      // Abaqus and CalculiX
      {"load",
       {"*BOUNDARY with a displacement", "*CLOAD", "*DLOAD", "*DSLOAD", "*TEMPERATURE", "*INITIAL CONDITIONS", "*AMPLITUDE", "*BASE MOTION",
        "*CFLUX", "*DFLUX", "*FILM", "*RADIATE", "turns and moments"}},
      {"support", {"*BOUNDARY"}},
      {"tie",
       {"*EQUATION", "*MPC", "*RELEASE", "*NETWORK MPC", "*COUPLING", "*KINEMATIC", "*DISTRIBUTING", "*RIGID BODY", "*FASTENER", "*SPRING",
        "*DASHPOT"}},
      {"tie",
       {"*TIE", "*CONTACT", "*CLEARANCE", "*SURFACE INTERACTION", "*SURFACE BEHAVIOR", "*FRICTION", "*MODEL CHANGE", "*MATRIX ASSEMBLE",
        "*GAP"}},
      {"tie", {"*SHELL TO SOLID COUPLING", "*EMBEDDED ELEMENT", "*CYCLIC SYMMETRY MODEL", "*PRE-TENSION SECTION", "*CONNECTOR SECTION"}},
      {"material",
       {"*ELASTIC", "*PLASTIC", "*RATE DEPENDENT", "*HYPERELASTIC", "*ORIENTATION", "*CREEP", "*CYCLIC HARDENING",
        "*DEFORMATION PLASTICITY", "*DRUCKER PRAGER", "*MOHR COULOMB", "*VISCOELASTIC", "*HYPERFOAM", "*USER MATERIAL", "*POTENTIAL",
        "*EXPANSION", "*DAMPING", "*MODAL DAMPING", "*MATERIAL"}},
      {"other",
       {"*BOUNDARY on degree of freedom", "*CONTACT DAMPING", "*CONTACT CONTROLS", "*CONTACT PAIR, ADJUST",
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE"}},
      {"", {"*NODE: the same node again", "*STATIC", "*GAP CONDUCTANCE", "*GAP HEAT GENERATION"}},
      // Nastran
      {"load", {"FORCE",  "FORCE1", "FORCE2", "MOMENT", "MOMENT1", "MOMENT2", "GRAV",   "ACCEL",  "ACCEL1",
                "RFORCE", "PLOAD",  "PLOAD1", "PLOAD2", "PLOAD4",  "LOAD",    "DLOAD",  "TLOAD1", "TLOAD2",
                "RLOAD1", "RLOAD2", "DAREA",  "TEMP",   "TEMPD",   "TEMPP1",  "DEFORM", "SPCD",   "TIC"}},
      {"load",
       {"load on an RBE3", "case control LOAD", "case control DLOAD", "case control TEMPERATURE", "case control TEMP",
        "case control STATSUB", "SPC with a displacement"}},
      {"support", {"PARAM INREL", "SPC", "SPC1", "SPCADD", "SUPORT", "SUPORT1"}},
      {"tie", {"MPC",     "RBE1",    "RBE2",   "RBE3",   "RBAR",    "RBAR1",   "RROD",    "RJOINT", "RTRPLT", "RTRPLT1", "RSSCON",
               "RSPLINE", "BCTABLE", "BCTSET", "BGSET",  "BSURF",   "BCPROP",  "BCPROPS", "CELAS1", "CELAS2", "CELAS3",  "CELAS4",
               "CDAMP1",  "CDAMP2",  "CDAMP3", "CDAMP4", "CBUSH",   "CBUSH1D", "CGAP",    "CWELD",  "CFAST",  "CVISC",   "CSHEAR",
               "CBEND",   "CBEAM3",  "CQUAD",  "CTRIAX", "CTRIAX6", "CQUADX",  "CHACAB",  "CHACBR", "CSEAM",  "CDUM1",   "GENEL"}},
      {"material", {"MATS1", "MATT1", "MAT2", "MAT3", "MAT8", "MAT9", "MAT10", "MAT11", "MATORT", "MATHE", "MATHP", "CREEP"}},
      {"other",
       {"PARAM G", "PARAM W3", "PARAM W4", "FORCE of a set", "MOMENT of a set", "GRAV of a set", "PLOAD of a set", "SPC of a set",
        "MAT8: structural damping GE"}},
      {"", {"PARAM", "SPC on a grid of no element", "CBARAO", "PLOTEL", "MDLPRM", "DEBUG"}},
      // universal files
      {"load", {"dataset 790", "dataset 793"}},
      {"support", {"dataset 791", "dataset 792"}},
  };
  return all;
}

/// "*TIE, NAME=x" begins with "*TIE", "*TIEBREAK" does not.
bool begins_with(std::string_view what, std::string_view words) {
  return what.starts_with(words) && (what.size() == words.size() || (!std::isalnum(static_cast<unsigned char>(what[words.size()])) &&
                                                                     what[words.size()] != '-' && what[words.size()] != '_'));
}

}  // namespace

std::string_view loss_of(const NotRead& n) {
  if (n.output || n.what.find(": numbers after its ") != std::string::npos) return "";
  for (const char* unused : {" of a set that the subcase does not use", " of a set that no subcase uses"})
    if (n.what.find(unused) != std::string::npos) return "";
  std::string_view lost = "other";
  size_t longest = 0;
  for (const Loss& loss : losses())
    for (const std::string_view words : loss.words)
      if (words.size() > longest && begins_with(n.what, words)) longest = words.size(), lost = loss.of;
  return lost.empty() || !n.what.ends_with(" and later") ? lost : "other";  // later steps are not in the scene at all
}

SceneWriter left_out(const std::vector<NotRead>& not_read) {
  SceneWriter out;
  for (const NotRead& n : not_read)
    if (const auto lost = loss_of(n); !lost.empty())
      out.add("left_out", "", "", {{"card", n.what}, {"loss", std::string(lost)}})
          .set_if(n.count != 1, "count", n.count)
          .set("place", n.place);
  return out;
}

}  // namespace hilo
