// SPDX-License-Identifier: Apache-2.0
/// The motion of a tracked person as 2D systems describe it: dense UV coordinates and keypoints of a frame and of those
/// before it, in the picture's plane (Wang et al., "Dance In the Wild: Monocular Human Animation With Neural Dynamic
/// Appearance Synthesis", 2021).
///
/// Keypoints are those of the tracked body, not a detector's, and so are the coordinates unless estimates are given:
/// then what the descriptor knows differs from the surface's normals and velocities (PersonFrames::MotionMaps), and not
/// how well it is known.
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
  /// Of a frame: u and v (the body's atlas coordinates, 0 off the body), 1 on the body, and the largest of Gaussians of
  /// kKeypointSigma of the window's longer side around the keypoints on the body's left, on its right and in its
  /// middle.
  static constexpr int kChannelsOfFrame = 6;
  static constexpr double kKeypointSigma = 1.0 / 64;

  /// `past`: frames, the newest the frame itself. `estimated`: where pixels lie on the body; nullptr: as the tracked
  /// body has it. Keeps references. Throws std::invalid_argument for fewer frames than one.
  DenseHistory(const PersonFrames& frames, int past, const EstimatedPixels* estimated = nullptr);

  [[nodiscard]] int channels() const { return kChannelsOfFrame * past_; }

  /// channels × height × width of frame t's window, frame t first: each earlier one as it was shown, laid where it was
  /// in the picture (what lies outside of the window now is gone). Before a gap-free run's first frame that frame
  /// again, as if the person had stood still. A frame without a result is zero. The values of a frame are kept in
  /// 1/65535, up to 512 MB of them; the same values whoever asks. May be called by several threads.
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
  mutable std::deque<int> order_;  ///< of those kept, the oldest first
};

}  // namespace bodyloom
