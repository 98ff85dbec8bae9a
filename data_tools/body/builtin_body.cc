// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body/builtin_body.h"

#include "data_tools/body/body_io.h"
#include "data_tools/body_making/make_builtin_body.h"

namespace bodyloom {

const BodyModel& BuiltinBody() {
  static const BodyModel body(MakeBuiltinBody(EmbeddedBuiltinBodySources()));
  return body;
}

const BodyModel& BuiltinBodyWithHands() {
  static const BodyModel body(MakeBuiltinBodyWithHands(EmbeddedBuiltinBodySources()));
  return body;
}

std::shared_ptr<const BodyModel> BodyOrBuiltin(const std::string& path) {
  if (path.empty()) return {std::shared_ptr<void>(), &BuiltinBody()};  // lives as long as the program
  if (path == kBodyWithHands) return {std::shared_ptr<void>(), &BuiltinBodyWithHands()};
  return std::make_shared<const BodyModel>(LoadBody(path));
}

}  // namespace bodyloom
