// SPDX-License-Identifier: Apache-2.0
/// The motion of a tracked person as described by 2D systems: dense UV coordinates and keypoints of a frame and its
/// predecessors in the image plane (Wang et al., "Dance In the Wild: Monocular Human Animation With Neural Dynamic
/// Appearance Synthesis", 2021).
///
/// Keypoints are those of the tracked body, not of a detector, and so are the coordinates unless estimates are given,
/// so that the descriptor differs from surface normals and velocities (PersonFrames::MotionMaps) in content and not in
/// accuracy.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "data_tools/descriptors/estimated_pixels.h"
#include "data_tools/descriptors/person_frames.h"

namespace bodyloom {

class DenseHistory {
 public:
  /// Channels of a frame: u and v (the body's atlas coordinates, 0 off the body), 1 on the body, and the largest of
  /// Gaussians of kKeypointSigma of the window's longer side around the keypoints on the body's left, on its right and
  /// in its middle.
  static constexpr int kChannelsOfFrame = 6;
  static constexpr double kKeypointSigma = 1.0 / 64;

  /// `past`: number of frames, the frame itself included. `estimated`: surface coordinates of the pixels; nullptr:
  /// those of the tracked body. Keeps references. Throws std::invalid_argument for fewer frames than one.
  DenseHistory(const PersonFrames& frames, int past, const EstimatedPixels* estimated = nullptr);

  [[nodiscard]] int channels() const { return kChannelsOfFrame * past_; }

  /// Writes channels × height × width of frame t's window, frame t first: each earlier frame at its position in the
  /// image, cropped to the current window. Before the first frame of a gap-free run that frame is repeated, as if the
  /// person had stood still. A frame without a result is zero. Frames are cached in units of 1/65535, up to 512 MB; the
  /// values do not depend on the caching. May be called by several threads.
  void Maps(int t, std::span<float> maps) const;

 private:
  using Planes = std::vector<uint16_t>;
  [[nodiscard]] std::shared_ptr<const Planes> PlanesOf(int t) const;
  [[nodiscard]] Planes MakePlanes(int t) const;

  const PersonFrames& frames_;
  int past_;
  const EstimatedPixels* estimated_;
  mutable std::mutex mutex_;
  mutable std::map<int, std::shared_ptr<const Planes>> kept_;
  mutable std::deque<int> order_;  ///< cached frames, oldest first
};

}  // namespace bodyloom
