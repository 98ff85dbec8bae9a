// SPDX-License-Identifier: Apache-2.0
/// What the network of a person's motion is told of a frame (render/avatar/motion/motion_network.h): maps over the UV
/// atlas, in the axes of the pelvis as it is turned in this frame, so that a dance is the same whichever way it faces.
///
/// Channels, with N normals, V_k velocities in space of k frames ago, in body lengths a second, and up the vertical:
///   N, V_0 … V_9, mean of V_10 … V_19, mean of V_20 … V_29, up (the same everywhere)
/// three each: the last third of a second frame by frame and the rest of the last second at 30 frames a second in two
/// strides. Where a run of frames begins, what lies before is zero. A track of another rate than the network learned from
/// is looked back at by the clock: k frames ago means k steps of the network's rate, the nearest frame of the track.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "bodyloom/data_tools/descriptors/person_frames.h"

namespace bodyloom {

class AvatarMotionMaps {
 public:
  static constexpr int kSingle = 10, kStrides = 2;
  static constexpr int kChannels = 6 + 3 * kSingle + 3 * kStrides;

  /// `fps` is the network's rate. `shown`: which frame of the track is shown when (PersonFramesOptions); empty: each in
  /// turn. Keeps references to body and track. Throws as PersonFrames.
  AvatarMotionMaps(const BodyModel& body, const Track& track, int side, double fps, std::vector<int> shown,
                   int num_threads);

  /// kChannels × side × side. Zero for a frame without a result.
  void Maps(int t, std::span<float> maps);

 private:
  [[nodiscard]] Eigen::Matrix3f PelvisFromCamera(int t) const;

  const Track& track_;
  std::vector<int> shown_;
  Eigen::Vector3f up_;     ///< camera frame
  std::vector<int> back_;  ///< frames of the track, by k
  PersonFrames frames_;
  std::vector<float> all_;  ///< of PersonFrames
};

/// Frames a second of a track's runs, 30 where it has no times.
double MotionRate(const Track& track);

}  // namespace bodyloom
