// SPDX-License-Identifier: Apache-2.0
/// Finds the hands and faces of people whose bodies were detected, frame by frame.
///
/// A hand is left out when the body's wrist has a visibility below 0.1, when its narrowed region is smaller than
/// `min_side_px`, when the network sees none in it (presence below `min_presence`), or when it is somebody's other
/// hand: its wrist farther from the body's than a third of the region's side (a hand's length from wrist to middle
/// knuckle), or its points those of the other hand, which then lies nearer to its wrist. Frames are independent of each
/// other: following a hand's points from frame to frame found a few hands more, and held on to wrong places
/// (docs/lab/hands.md).
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "geometry/scene/hands_and_face.h"
#include "render/image/image.h"
#include "tracking/detection/pose_landmarks.h"

namespace bodyloom {

enum class HandsAndFaceChoice {
  kOff,
  kAuto,  ///< where they are large enough, and if the networks are there
  kOn     ///< however small they are
};

/// "off", "auto" or "on".
std::string ToText(HandsAndFaceChoice choice);
/// Throws std::invalid_argument for another name.
HandsAndFaceChoice HandsAndFaceChoiceNamed(const std::string& name);

/// Side of the smallest region that kAuto looks at: hands of 16 pixels from wrist to middle knuckle, faces of 16
/// between the eyes' outer corners. In pictures made smaller, points move by 7 % of the hand's length at that size and
/// by 10 % at two thirds of it, as much as they err by in large ones (docs/lab/hands.md).
inline constexpr double kMinHandSidePx = 48;

/// Fate of the parts looked for.
struct PartCounts {
  int parts = 0;  ///< two hands, or a face, for every person and frame
  int found = 0;
  int hidden = 0;  ///< of hands
  int small = 0;
  int absent = 0;     ///< the network sees none
  int elsewhere = 0;  ///< of hands: at the other hand's place
};

struct HandsAndFaceSummary {
  PartCounts hands, faces;
  double seconds = 0;   ///< wall time
  std::string why_not;  ///< the networks were wanted and are not there; "" otherwise
};

/// "hands    1,210 of 1,468 found; 20 hidden, …" and a line of faces; "" when none was looked for.
std::string ToText(const HandsAndFaceSummary& summary);

struct HandsAndFaceOptions {
  double min_side_px = kMinHandSidePx, min_presence = 0.5;
  int num_threads = 2;
};

class HandsAndFaceDetector {
 public:
  /// Reads the networks from `folder`, or where they are installed when it is empty. Throws std::runtime_error naming a
  /// file that is missing or no such network.
  HandsAndFaceDetector(const std::string& folder, const HandsAndFaceOptions& options);
  ~HandsAndFaceDetector();

  /// Hands and faces of the people of each frame; null where nothing was found. Results do not depend on the number of
  /// threads.
  std::vector<std::vector<std::shared_ptr<const HandsAndFace>>> Detect(
      std::span<const Image> frames, std::span<const std::vector<DetectedPose>> people);

  [[nodiscard]] const HandsAndFaceSummary& summary() const { return summary_; }

 private:
  class Networks;
  std::unique_ptr<const Networks> networks_;
  HandsAndFaceOptions options_;
  HandsAndFaceSummary summary_;
};

}  // namespace bodyloom
