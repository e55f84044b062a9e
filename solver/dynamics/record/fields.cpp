// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/record/fields.hpp"

#include "model/scene.hpp"

namespace hilo {

Registry<FieldKind>& field_kinds() {
  static Registry<FieldKind> kinds{"source of fields", {{"motion", motion_fields}, {"stress", stress_fields}, {"contact", contact_fields}}};
  return kinds;
}

void add_field(const FieldKind& kind, const std::vector<std::string_view>& words, const std::vector<ArraySchema>& arrays) {
  field_kinds().add(kind);
  for (const std::string_view word : words) words_of("output", "fields")->add({word});
  for (const ArraySchema& array : arrays) add_array(array);
}

}  // namespace hilo
