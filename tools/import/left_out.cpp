// SPDX-License-Identifier: GPL-3.0-or-later
// What a model lacks by a card that was not read, and the [[left_out]] of a scene.
#include <algorithm>
#include <cctype>
#include <utility>

#include "base/param.hpp"
#include "import/imported.hpp"

namespace hilo {
namespace {

constexpr const char *load = "load", *support = "support", *tie = "tie", *material = "material", *other = "other", *not_missed = "";

/// The first row whose words the card begins with says what is lost.
constexpr std::pair<std::string_view, const char*> losses[] = {
    // Abaqus and CalculiX
    {"*NODE: the same node again", not_missed},
    {"*STATIC", not_missed},
    {"*BOUNDARY on degree of freedom", other},
    {"*BOUNDARY with a displacement", load},
    {"*BOUNDARY", support},
    {"*CLOAD", load},
    {"*DLOAD", load},
    {"*DSLOAD", load},
    {"*TEMPERATURE", load},
    {"*INITIAL CONDITIONS", load},
    {"*AMPLITUDE", load},
    {"*BASE MOTION", load},
    {"*CFLUX", load},
    {"*DFLUX", load},
    {"*FILM", load},
    {"*RADIATE", load},
    {"turns and moments", load},
    {"*EQUATION", tie},
    {"*MPC", tie},
    {"*RELEASE", tie},
    {"*NETWORK MPC", tie},
    {"*TIE", tie},
    {"*CONTACT DAMPING", other},
    {"*CONTACT CONTROLS", other},
    {"*CONTACT PAIR", tie},
    {"*CONTACT", tie},
    {"*CONTACT INCLUSIONS", tie},
    {"*CLEARANCE", tie},
    {"*SURFACE INTERACTION", tie},
    {"*SURFACE BEHAVIOR", tie},
    {"*FRICTION", tie},
    {"*MODEL CHANGE", tie},
    {"*MATRIX ASSEMBLE", tie},
    {"*GAP CONDUCTANCE", not_missed},
    {"*GAP HEAT GENERATION", not_missed},
    {"*GAP", tie},
    {"*COUPLING", tie},
    {"*KINEMATIC", tie},
    {"*KINEMATIC COUPLING", tie},
    {"*DISTRIBUTING", tie},
    {"*DISTRIBUTING COUPLING", tie},
    {"*RIGID BODY", tie},
    {"*SHELL TO SOLID COUPLING", tie},
    {"*EMBEDDED ELEMENT", tie},
    {"*CYCLIC SYMMETRY MODEL", tie},
    {"*PRE-TENSION SECTION", tie},
    {"*CONNECTOR SECTION", tie},
    {"*FASTENER", tie},
    {"*SPRING", tie},
    {"*DASHPOT", tie},
    {"*ELASTIC", material},
    {"*PLASTIC", material},
    {"*RATE DEPENDENT", material},
    {"*HYPERELASTIC", material},
    {"*ORIENTATION", material},
    {"*CREEP", material},
    {"*CYCLIC HARDENING", material},
    {"*DEFORMATION PLASTICITY", material},
    {"*DRUCKER PRAGER", material},
    {"*MOHR COULOMB", material},
    {"*VISCOELASTIC", material},
    {"*HYPERFOAM", material},
    {"*USER MATERIAL", material},
    {"*POTENTIAL", material},
    {"*EXPANSION", material},
    {"*DAMPING", material},
    {"*MODAL DAMPING", material},
    {"*MATERIAL", material},
    // Nastran
    {"PARAM G", other},
    {"PARAM W3", other},
    {"PARAM W4", other},
    {"PARAM INREL", support},
    {"PARAM", not_missed},
    {"FORCE of a set", other},
    {"MOMENT of a set", other},
    {"GRAV of a set", other},
    {"PLOAD of a set", other},
    {"SPC of a set", other},
    {"load on an RBE3", load},
    {"FORCE", load},
    {"FORCE1", load},
    {"FORCE2", load},
    {"MOMENT", load},
    {"MOMENT1", load},
    {"MOMENT2", load},
    {"GRAV", load},
    {"ACCEL", load},
    {"ACCEL1", load},
    {"RFORCE", load},
    {"PLOAD", load},
    {"PLOAD1", load},
    {"PLOAD2", load},
    {"PLOAD4", load},
    {"LOAD", load},
    {"DLOAD", load},
    {"TLOAD1", load},
    {"TLOAD2", load},
    {"RLOAD1", load},
    {"RLOAD2", load},
    {"DAREA", load},
    {"TEMP", load},
    {"TEMPD", load},
    {"TEMPP1", load},
    {"DEFORM", load},
    {"SPCD", load},
    {"TIC", load},
    {"case control LOAD", load},
    {"case control DLOAD", load},
    {"case control TEMPERATURE", load},
    {"case control TEMP", load},
    {"SPC with a displacement", load},
    {"SPC on a grid of no element", not_missed},
    {"SPC", support},
    {"SPC1", support},
    {"SPCADD", support},
    {"SUPORT", support},
    {"SUPORT1", support},
    {"MPC", tie},
    {"RBE1", tie},
    {"RBE2", tie},
    {"RBE3", tie},
    {"RBAR", tie},
    {"RBAR1", tie},
    {"RROD", tie},
    {"RTRPLT", tie},
    {"RSPLINE", tie},
    {"BCTABLE", tie},
    {"BCTSET", tie},
    {"BGSET", tie},
    {"BSURF", tie},
    {"BCPROP", tie},
    {"BCPROPS", tie},
    {"CELAS1", tie},
    {"CELAS2", tie},
    {"CELAS3", tie},
    {"CELAS4", tie},
    {"CDAMP1", tie},
    {"CDAMP2", tie},
    {"CDAMP3", tie},
    {"CDAMP4", tie},
    {"CBUSH", tie},
    {"CBUSH1D", tie},
    {"CGAP", tie},
    {"CWELD", tie},
    {"CFAST", tie},
    {"CVISC", tie},
    {"CSHEAR", tie},
    {"CBEND", tie},
    {"CBEAM3", tie},
    {"CQUAD", tie},
    {"CTRIAX6", tie},
    {"CQUADX", tie},
    {"CHACAB", tie},
    {"CHACBR", tie},
    {"CSEAM", tie},
    {"CDUM1", tie},
    {"GENEL", tie},
    {"CBARAO", not_missed},
    {"PLOTEL", not_missed},
    {"MDLPRM", not_missed},
    {"DEBUG", not_missed},
    {"MATS1", material},
    {"MATT1", material},
    {"MAT2", material},
    {"MAT3", material},
    {"MAT8: structural damping GE", other},
    {"MAT8", material},
    {"MAT9", material},
    {"MAT10", material},
    {"MAT11", material},
    {"MATORT", material},
    {"MATHE", material},
    {"MATHP", material},
    {"CREEP", material},
    // universal files
    {"dataset 790", load},
    {"dataset 791", support},
    {"dataset 792", support},
    {"dataset 793", load},
};

/// "*TIE, NAME=x" begins with "*TIE", "*TIEBREAK" does not.
bool begins_with(std::string_view what, std::string_view words) {
  return what.starts_with(words) && (what.size() == words.size() || (!std::isalnum(static_cast<unsigned char>(what[words.size()])) &&
                                                                     what[words.size()] != '-' && what[words.size()] != '_'));
}

}  // namespace

std::string_view loss_of(const NotRead& n) {
  if (n.output || n.what.find(": numbers after its ") != std::string::npos) return not_missed;
  for (const char* unused : {" of a set that the first subcase does not use", " of a set that no subcase uses"})
    if (n.what.find(unused) != std::string::npos) return not_missed;
  const bool of_later_steps = n.what.ends_with(" and later");  // which are not in the scene at all
  for (const auto& [words, lost] : losses)
    if (begins_with(n.what, words)) return of_later_steps && lost != not_missed ? other : lost;
  return other;
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
