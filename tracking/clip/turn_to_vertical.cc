// SPDX-License-Identifier: Apache-2.0
#include "tracking/clip/turn_to_vertical.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>

#include "tracking/initialise/ground_plane.h"
#include "tracking/lifter/lifter_reading.h"
#include "tracking/problem/track_options.h"
#include "tracking/room/picture_vertical.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

void TurnLandmarks(const Matrix3d& turn, LiftedFrame* frame) {
  frame->points = (frame->points * turn.transpose()).eval();
  for (auto& limb : frame->limbs) {
    for (LiftedLimb& guess : limb) {
      for (Vector3d& point : guess.points) point = turn * point;
    }
  }
}

}  // namespace

double TurnToVertical(const TrackSequenceInput& input, const StartFocal& focal, const std::vector<char>& cut_before,
                      LiftedStart* lifted, std::vector<FrameState>* states) {
  const bool knows = input.ground != nullptr || (input.picture_vertical != nullptr && input.picture_vertical->found);
  if (!knows || input.camera_from_scene != nullptr || lifted->frames.empty()) return 0;
  double largest = 0;
  const size_t T = lifted->frames.size();
  for (size_t begin = 0, end = 0; begin < T; begin = end) {
    for (end = begin + 1; end < T && cut_before[end] == 0;) ++end;
    const UpEstimate own = EstimateUp(std::span(lifted->frames).subspan(begin, end - begin));
    if (!own.found) continue;
    const Vector3d up =
        input.ground != nullptr
            ? input.ground->up
            : JoinVerticals(own.up, GroundPlaneOptions().up_rad, *input.picture_vertical, focal.px, focal.log_sigma).up;
    const Matrix3d turn = Eigen::Quaterniond::FromTwoVectors(own.up, up).toRotationMatrix();
    largest = std::max(largest, std::acos(std::clamp(own.up.dot(up), -1.0, 1.0)));
    for (size_t t = begin; t < end; ++t) {
      TurnLandmarks(turn, &lifted->frames[t]);
      (*states)[t].rotations[0] = turn * (*states)[t].rotations[0];
    }
  }
  return largest;
}

}  // namespace bodyloom
