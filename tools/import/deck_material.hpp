// SPDX-License-Identifier: GPL-3.0-or-later
// A material as a deck says it: a law of hilo with the values of its keys, or why it has none.
#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "import/imported.hpp"

namespace hilo {

/// A key of [material.NAME] in units of the deck.
struct DeckKey {
  std::string key;
  std::vector<double> values;
  const char* unit = "1";
  bool list = false;  // written as one, however many they are
};

struct DeckMaterial {
  std::string name;
  RegionData data;                 // units of the deck
  double G = std::nan("");         // shear modulus where the deck gives one beside E
  std::string kind = "stvk";       // of the law
  std::vector<DeckKey> keys = {};  // besides E, nu and density
  double alpha = 0, beta = 0;      // damping by mass and by stiffness, which regions have
  std::string no_law = {};         // what has none in hilo, with its place; "" where all has
  bool elastic() const { return no_law.empty() && kind == "stvk"; }
  void become(const std::string& other);  // of another kind; two of them are none
  void set(DeckKey k);                    // in place of an earlier value of the key

  /// What a region of it carries: moduli only where they say all, so that no metal or rubber becomes elastic where the scene lines are left
  /// out.
  RegionData carried() const;
  /// [material.NAME] in SI.
  void write(SceneWriter& scene, const ImportOptions& options) const;
};

/// A yield stress by equivalent plastic strain becomes a metal's keys; "" or why it cannot.  `kinematic`: the share of hardening that moves
/// the yield surface; a share above 0 asks for one slope.
std::string set_hardening(DeckMaterial& m, const std::vector<double>& strain, const std::vector<double>& stress, double kinematic);

}  // namespace hilo
