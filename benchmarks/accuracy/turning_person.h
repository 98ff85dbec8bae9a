// SPDX-License-Identifier: Apache-2.0
/// Synthesises a person who repeatedly turns left and right on the spot in front of one camera: the motion with which
/// Yoon et al. (CVPR 2022, Fig. 4) compare descriptors of motion.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct TurningPersonOptions {
  int cycles = 6;             ///< after one initial cycle
  double period_s = 2;        ///< left, right and back
  double amplitude_deg = 60;  ///< to each side of facing the camera
  double variation = 0.1;     ///< amplitudes and periods vary by up to this share, arms by up to 40° times it
  double pose_noise_deg = 0;  ///< of every joint and frame, like a tracker's; standard deviation per axis
  double fps = 30;
  int image_size = 512;
  uint64_t seed = 1;
};

struct TurningPerson {
  Track track;                         ///< camera frame, pinhole, 4 m away
  std::vector<int> cycle;              ///< by frame; −1: the initial cycle
  std::vector<double> yaw_deg;         ///< of the chest, positive to the person's left
  std::vector<double> yaw_rate_deg_s;  ///< its rate, without noise
};

/// Yaw between two turning points is half a cosine, so its rate is zero there and continuous. A cycle goes from left to
/// left. The pelvis takes 40 % of the turn, the spine the rest; arms hang. Throws std::invalid_argument for options out
/// of range or a body without SMPL's 24 joints.
TurningPerson MakeTurningPerson(const BodyModel& body, const TurningPersonOptions& options = {});

}  // namespace bodyloom
