// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/render/avatar/pose_options.h"

#include "bodyloom/geometry/base/in_range.h"

namespace bodyloom {

bool PoseGaussiansOptions::IsValid(std::string* why) const {
  const InRange in_range(why);
  for (const float entry : light_from_frame) {
    if (!in_range("light_from_frame", entry, -1.001, 1.001)) return false;
  }
  return in_range("num_threads", num_threads, 1, 1024);
}

}  // namespace bodyloom
