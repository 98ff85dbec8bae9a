// SPDX-License-Identifier: Apache-2.0
#include "tracking/live/live_ground.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"
#include "tracking/problem/track_summary.h"
#include "tracking/room/shared_scene.h"

namespace bodyloom {
namespace {

constexpr size_t kMostSeen = 1024;  ///< frames
constexpr double kEstimateEvery_s = 0.5;
constexpr double kMove_s = 1;  ///< time constant

}  // namespace

LiveGround::LiveGround(const BodyModel& body, double seconds)
    : ankles_{body.FindJoint("l_ankle"), body.FindJoint("r_ankle")}, seconds_(seconds) {
  BODYLOOM_CHECK(seconds > 0, "live ground: ", seconds, " s of frames, expected more than 0");
  for (const char* name : {"l_ankle", "r_ankle", "l_foot", "r_foot"}) {
    if (const int joint = body.FindJoint(name); joint >= 0) lowest_joints_.push_back(joint);
  }
}

const WorldFrame& LiveGround::Add(const LiveFrame& frame, const MatrixX3d& joints) {
  if (frame.status == FrameStatus::kLost) return world_;
  Seen& seen = seen_.emplace_back();
  seen.timestamp = frame.timestamp;
  seen.lowest = joints;
  if (!lowest_joints_.empty()) seen.lowest = joints(lowest_joints_, Eigen::all);
  if (frame.standing) {
    seen.lifted.seen = true;
    seen.lifted.up = frame.standing->up;
    seen.lifted.up_sigma = frame.standing->up_sigma;
  }
  for (size_t foot = 0; foot < 2; ++foot) {
    if (ankles_[foot] < 0) continue;
    seen.feet[foot].ankle_m = joints.row(ankles_[foot]).transpose();
    seen.feet[foot].contact = frame.standing ? frame.standing->contact[Eigen::Index(foot)] : 0;
    seen.feet[foot].seen = frame.status == FrameStatus::kTracked;
  }
  while (seen_.size() > kMostSeen || seen_.front().timestamp < frame.timestamp - seconds_) seen_.pop_front();
  if (!estimate_ || frame.timestamp - estimated_at_ >= kEstimateEvery_s) {
    const bool is_first = !estimate_;
    estimate_ = Estimate();
    estimated_at_ = frame.timestamp;
    if (is_first) world_ = *estimate_;
  }
  MoveTowards(*estimate_, frame.timestamp - moved_at_);
  moved_at_ = frame.timestamp;
  return world_;
}

WorldFrame LiveGround::Estimate() const {
  std::vector<MatrixX3d> joints;
  std::vector<LiftedFrame> lifted;
  std::vector<std::array<FootPlace, 2>> feet;
  std::vector<double> timestamps;
  for (const Seen& seen : seen_) {
    joints.push_back(seen.lowest);
    lifted.push_back(seen.lifted);
    feet.push_back(seen.feet);
    timestamps.push_back(seen.timestamp);
  }
  GroundSummary ground;
  const UpEstimate up = EstimateUp(lifted);
  ground.has_up = up.found;
  ground.up = up.up;
  if (up.found && timestamps.size() > 1) {
    const GroundPlane plane = EstimateGroundPlane(feet, timestamps, up.up, {});
    if (plane.found) {
      ground.has_plane = true;
      ground.up = plane.normal;
      ground.camera_height_m = kAnkleHeight - plane.offset_m;
      ground.up_sigma_deg = 180 / M_PI * plane.up_sigma_rad;
      ground.height_sigma_m = plane.offset_sigma_m;
    }
  }
  return WorldOfGround(ground, joints);
}

void LiveGround::MoveTowards(const WorldFrame& estimate, double seconds) {
  const double share = 1 - std::exp(-std::max(seconds, 0.0) / kMove_s);
  const Eigen::Vector3d up = world_.up_in_camera() + share * (estimate.up_in_camera() - world_.up_in_camera());
  const double height = world_.camera_height_m() + share * (estimate.camera_height_m() - world_.camera_height_m());
  world_ = WorldOverGround(up.norm() > 0 ? up : estimate.up_in_camera(), height);
  world_.source = estimate.source;
  world_.vertical_sigma_deg = estimate.vertical_sigma_deg;
  world_.height_sigma_m = estimate.height_sigma_m;
}

}  // namespace bodyloom
