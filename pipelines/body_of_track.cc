// SPDX-License-Identifier: Apache-2.0
#include "pipelines/body_of_track.h"

#include "data_tools/body/builtin_body.h"

namespace bodyloom {

std::shared_ptr<const BodyModel> BodyOfTrack(const std::string& path, const Track& track) {
  const bool has_fingers = path.empty() && track.motion.body == BuiltinBodyWithHands().name();
  return BodyOrBuiltin(has_fingers ? kBodyWithHands : path);
}

}  // namespace bodyloom
