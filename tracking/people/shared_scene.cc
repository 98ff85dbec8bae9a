// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/people/shared_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;

constexpr double kUpFloorDeg = 2;  ///< of the spread of a person's vertical
constexpr double kSameGroundShare = 0.15;

int TrackedFrames(const TrackSequenceSummary& person) {
  const auto it = person.frames_by_status.find("tracked");
  return it == person.frames_by_status.end() ? 0 : it->second;
}

void JoinFocalLengths(const std::vector<const TrackSequenceSummary*>& people, const FocalPrior& prior,
                      SharedScene* scene) {
  double information = 0, sum = 0;
  int count = 0;
  for (const TrackSequenceSummary* person : people) {
    if (person->focal_log_sigma == 0) {
      scene->focal_px = person->focal_px;
      return;
    }
    if (!(person->focal_log_sigma > 0) || !(person->focal_px > 0)) continue;
    // A posterior is never wider than its prior but by rounding.
    const double own = 1 / std::pow(std::min(person->focal_log_sigma, prior.log_sigma), 2);
    information += own;
    sum += own * std::log(person->focal_px);
    ++count;
  }
  if (count == 0) return;
  const double again = (count - 1) / (prior.log_sigma * prior.log_sigma);
  information -= again;
  sum -= again * prior.log_mean;
  scene->focal_px = std::exp(sum / information);
  scene->focal_log_sigma = 1 / std::sqrt(information);
}

void JoinVerticals(const std::vector<const TrackSequenceSummary*>& people, SharedScene* scene) {
  Vector3d sum = Vector3d::Zero();
  for (const TrackSequenceSummary* person : people) {
    const GroundSummary& ground = person->ground;
    if (ground.has_up) sum += TrackedFrames(*person) / std::pow(ground.up_spread_deg + kUpFloorDeg, 2) * ground.up;
  }
  scene->has_up = sum.norm() > 0;
  if (scene->has_up) scene->ground.up = sum.normalized();
}

void JoinGrounds(const std::vector<const TrackSequenceSummary*>& people, SharedScene* scene) {
  std::vector<std::pair<double, int>> heights;  // of the camera, frames of contact
  int total = 0;
  for (const TrackSequenceSummary* person : people) {
    const GroundSummary& ground = person->ground;
    if (!ground.has_plane || ground.contact_frames <= 0) continue;
    heights.emplace_back(ground.camera_height_m, ground.contact_frames);
    total += ground.contact_frames;
  }
  if (heights.empty()) {
    scene->why = "nobody's feet show a ground";
    return;
  }
  std::sort(heights.begin(), heights.end());
  int sum = 0;
  const auto median = std::find_if(heights.begin(), heights.end(), [&](const std::pair<double, int>& height) {
    sum += height.second;
    return 2 * sum >= total;
  });
  double agreeing = 0, mean = 0;
  for (const auto& [height, frames] : heights) {
    if (std::abs(height - median->first) > kSameGroundShare * std::abs(median->first)) continue;
    agreeing += frames;
    mean += frames * height;
  }
  if (!(2 * agreeing > total)) {
    scene->why = "people's feet do not stand on one plane";
    return;
  }
  scene->ground.has_plane = true;
  scene->ground.camera_height_m = mean / agreeing;
  scene->why = Concatenate("feet of ", agreeing, " frames stand on it");
}

}  // namespace

SharedScene JoinScenes(const std::vector<TrackSequenceSummary>& people, const FocalPrior& prior) {
  std::vector<const TrackSequenceSummary*> usable;
  for (const TrackSequenceSummary& person : people) {
    if (person.IsUsable()) usable.push_back(&person);
  }
  SharedScene scene;
  JoinFocalLengths(usable, prior, &scene);
  JoinVerticals(usable, &scene);
  if (scene.has_up) {
    JoinGrounds(usable, &scene);
  } else {
    scene.why = "the vertical is not clear";
  }
  return scene;
}

}  // namespace bodyloom
