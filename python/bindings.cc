// SPDX-License-Identifier: Apache-2.0
#include "python/bindings.h"

#include <set>

#include "data_tools/observations/keypoint_conventions.h"
#include "geometry/base/check.h"

namespace bodyloom::python {

std::pair<std::string, std::vector<std::string>> ConventionFrom(const LandmarkNames& names) {
  if (const auto* list = std::get_if<std::vector<std::string>>(&names)) {
    BODYLOOM_CHECK(!list->empty(), "names: expected at least one landmark, found none");
    std::set<std::string> seen;
    for (const std::string& name : *list) {
      BODYLOOM_CHECK(seen.insert(name).second, "names: \"", name, "\" stands there twice");
    }
    return {"custom", *list};
  }
  const std::string& wanted = std::get<std::string>(names);
  std::string all;
  for (const KeypointConvention* convention : KnownConventions()) {
    if (convention->name == wanted) return {convention->name, convention->names};
    all += (all.empty() ? "" : ", ") + convention->name;
  }
  BODYLOOM_CHECK(false, "names: \"", wanted, "\", expected a list of landmarks or one of ", all);
  return {};
}

}  // namespace bodyloom::python
