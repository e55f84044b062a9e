// Scenes and runs of what moves by a law.
#pragma once
#include "model/scene.hpp"
#include "verify/verify.hpp"

namespace hilo::test {

inline const std::vector<std::string>& integrators() {
  static const std::vector<std::string> words = choices("time", "integrator");
  return words;
}

inline std::string with(const std::string& integrator) { return "--set 'time.integrator=\"" + integrator + "\"' "; }

class Motions : public Workplace, public testing::Test {
 protected:
  Results solved(const std::string& options = "", const std::string& mesh = "") {
    const Ran ran = run("hilo-solve scene.toml " + mesh + " " + options + " -o run.h5");
    err = ran.err;
    if (ran.exit != 0) throw std::runtime_error("hilo-solve: " + ran.err);
    return Results(*this / "run.h5");
  }
  double reported(const std::string& key) const {
    const std::string text = text_of(*this / "run.json");
    const auto at = text.find("\"" + key + "\": ");
    return at == std::string::npos ? std::nan("") : std::stod(text.substr(at + key.size() + 4));
  }
  std::string err;
};

}  // namespace hilo::test
