// SPDX-License-Identifier: Apache-2.0
/// Runs BlazePose on one image: the person detector and the landmark network of MediaPipe Pose, from their .tflite
/// files.
///
/// Networks run on the processor. An object serves one thread at a time; copies share the kernels, so that one for each
/// thread costs little.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/image/image.h"
#include "tracking/detection/pose_landmarks.h"
#include "tracking/detection/pose_region.h"

namespace bodyloom {

/// The landmark network's size. Errors and times: docs/lab/pose_detector.md.
enum class PoseNetworkSize { kLite, kFull, kHeavy };

/// "lite", "full" or "heavy".
std::string ToText(PoseNetworkSize size);

/// The networks' files, read once for any number of detectors.
class PoseModels;

/// Reads the person detector and one landmark network from a folder, or where they are installed when it is empty
/// (model_files.h). Throws std::runtime_error naming a file that is missing or not such a network.
std::shared_ptr<const PoseModels> ReadPoseModels(const std::string& folder, PoseNetworkSize size);

class PoseDetector {
 public:
  /// with_mask: poses include a mask, at a tenth more time for `heavy` and half more for `full`
  /// (docs/lab/pose_detector.md).
  PoseDetector(const std::shared_ptr<const PoseModels>& models, bool with_mask);
  PoseDetector(const PoseDetector& other);
  PoseDetector& operator=(const PoseDetector&) = delete;
  ~PoseDetector();
  PoseDetector(PoseDetector&&) noexcept;
  PoseDetector& operator=(PoseDetector&&) noexcept;

  /// Regions of the people that the person detector finds in an upright square of the image, highest score first;
  /// people shorter than about 0.28 of the square's side are not found.
  [[nodiscard]] std::vector<PoseRegion> FindPeople(const Image& image, const PoseRegion& square,
                                                   double min_score = 0.5);

  /// The pose of the person in a region, which may be empty: DetectedPose::presence. with_mask: false leaves the mask
  /// out, and the time it takes; the rest has the same bits.
  [[nodiscard]] DetectedPose PoseIn(const Image& image, const PoseRegion& region, bool with_mask = true);

 private:
  class Networks;
  std::unique_ptr<Networks> networks_;
};

}  // namespace bodyloom
