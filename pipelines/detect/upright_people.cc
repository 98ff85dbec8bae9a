// SPDX-License-Identifier: Apache-2.0
#include "pipelines/detect/upright_people.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "data_tools/observations/keypoint_conventions.h"
#include "geometry/base/check.h"

namespace bodyloom {

Trunk TrunkOf(const DetectedPerson& person, const KeypointConvention& convention) {
  const auto landmark = [&](const char* name) {
    const auto at = std::find(convention.names.begin(), convention.names.end(), name);
    BODYLOOM_CHECK(at != convention.names.end(), "landmarks of ", convention.name, " without ", name);
    return person.points[size_t(at - convention.names.begin())];
  };
  const std::array<Keypoint, 4> trunk = {landmark("left_shoulder"), landmark("right_shoulder"), landmark("left_hip"),
                                         landmark("right_hip")};
  const double right = trunk[0].x + trunk[1].x - trunk[2].x - trunk[3].x;
  const double up = trunk[2].y + trunk[3].y - trunk[0].y - trunk[1].y;
  Trunk found;
  found.is_upright = up > std::abs(right);
  for (const Keypoint& point : trunk) found.confidence += 0.25 * point.confidence;
  return found;
}

std::string AdviceOnTurn(const PeopleSequence& people) {
  int trunks = 0, upright = 0;
  for (const std::vector<DetectedPerson>& frame : people.frames) {
    for (const DetectedPerson& person : frame) {
      const Trunk trunk = TrunkOf(person, people.convention);
      if (trunk.confidence < 0.5) continue;
      ++trunks;
      upright += trunk.is_upright ? 1 : 0;
    }
  }
  if (trunks == 0 || 4 * upright > trunks) return "";
  return "most people lie on their side or are upside down; if it was the camera that lay or hung, give --rotate auto";
}

void SayAdviceOnTurn(const std::string& video, const PeopleSequence& people, const PipelineCallbacks& callbacks) {
  const std::string advice = AdviceOnTurn(people);
  if (!advice.empty()) callbacks.Message(video + ": " + advice);
}

}  // namespace bodyloom
