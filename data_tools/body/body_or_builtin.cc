// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/body/body_or_builtin.h"

#include "bodyloom/data_tools/body/body_io.h"
#include "bodyloom/data_tools/body/builtin_body.h"

namespace bodyloom {

std::shared_ptr<const BodyModel> BodyOrBuiltin(const std::string& path) {
  if (path.empty()) return {std::shared_ptr<void>(), &BuiltinBody()};  // lives as long as the program
  return std::make_shared<const BodyModel>(LoadBody(path));
}

}  // namespace bodyloom
