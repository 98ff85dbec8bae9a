// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body/builtin_body.h"

#include "data_tools/body/body_io.h"

// Made by bodyloom_embed() in data_tools/CMakeLists.txt.
extern "C" {
extern const char bodyloom_builtin_body_cage_begin[], bodyloom_builtin_body_cage_end[];
extern const char bodyloom_builtin_body_parts_begin[], bodyloom_builtin_body_parts_end[];
}

namespace bodyloom {

BuiltinBodySources EmbeddedBuiltinBodySources() {
  BuiltinBodySources sources;
  sources.cage_text.assign(bodyloom_builtin_body_cage_begin, bodyloom_builtin_body_cage_end);
  sources.parts_bytes.assign(bodyloom_builtin_body_parts_begin, bodyloom_builtin_body_parts_end);
  return sources;
}

const BodyModel& BuiltinBody() {
  static const BodyModel body(MakeBuiltinBody(EmbeddedBuiltinBodySources()));
  return body;
}

std::shared_ptr<const BodyModel> BodyOrBuiltin(const std::string& path) {
  if (path.empty()) return {std::shared_ptr<void>(), &BuiltinBody()};  // lives as long as the program
  return std::make_shared<const BodyModel>(LoadBody(path));
}

}  // namespace bodyloom
