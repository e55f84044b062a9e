// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/left_out.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/table.hpp"

namespace hilo {
namespace {

/// "*EQUATION (3, deck.inp:12)".
std::string told(const Entry& e) {
  const std::string place = e.has("place") ? e.text("place") : "";
  std::string text = fmt::format("{} ({:.0f}{}{})", e.text("card"), e.number("count"), place.empty() ? "" : ", ", place);
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 32; }, ' ');  // a message is one line
  return text;
}

/// Something pushes, pulls or moves: what a static analysis answers to.
bool is_loaded(const Scene& scene) {
  if (scene.table("scene").vector3("gravity").norm() > 0 || !scene.entries("load").empty() || !scene.entries("motor").empty()) return true;
  const auto motions = scene.entries("motion");
  return std::ranges::any_of(motions, [](const Entry& e) { return e.kind != "fixed"; });
}

}  // namespace

void tell_left_out(const Scene& scene) {
  for (const Entry& e : scene.entries("left_out"))
    fmt::print(stderr, "{}: warning: {}: import left out {}\n", tool_name(), e.place.text(), told(e));
}

void refuse_left_out(const Scene& scene) {
  const std::string hint = "say it in the scene by other means and remove its [[left_out]], or --accept-left-out";
  const std::string& analysis = scene.table("time").text("analysis");
  const bool no_loads = (analysis == "static" || analysis == "path") && !is_loaded(scene);
  for (const Entry& e : scene.entries("left_out")) {
    const std::string& loss = e.text("loss");
    if (loss == "tie") throw Error(e.place.text(), fmt::format("import left out {}: parts would not be joined as meant", told(e)), hint);
    if (loss == "load" && analysis == "buckling")
      throw Error(e.place.text(), fmt::format("import left out {}: factors would be those of other loads", told(e)), hint);
    if (loss == "load" && no_loads)
      throw Error(e.place.text(), fmt::format("import left out {}, and nothing else loads this static analysis", told(e)), hint);
  }
}

Json left_out_json(const Scene& scene) {
  return Json::list_of(scene.entries("left_out"), [](const Entry& e) -> Json {
    return {{"loss", e.text("loss")},
            {"card", e.text("card")},
            {"count", {e.number("count"), 12}},
            {"place", e.has("place") ? e.text("place") : ""}};
  });
}

}  // namespace hilo
