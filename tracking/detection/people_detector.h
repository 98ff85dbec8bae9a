// SPDX-License-Identifier: Apache-2.0
/// Detects everybody in the frames of a clip with BlazePose: people are searched for at intervals and followed from
/// frame to frame in between.
///
/// Frames come in groups of up to kFramesAtOnce. All frames of a group use the regions from the frame before the group
/// (RegionAroundBody of its two region points), so that they can run in parallel; results do not depend on the number
/// of threads. New people are searched for in a group's first frame: when nobody is followed, and every
/// `search_interval` frames unless max_people are followed already. A person is lost when the network finds nobody in
/// the region in every frame of a group. Two regions that show the same landmarks (PoseDistance below 0.1) are one
/// person; the one followed longer is kept.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "render/image/image.h"
#include "tracking/detection/hands_and_face_detector.h"
#include "tracking/detection/pose_detector.h"

namespace bodyloom {

struct PeopleDetectorOptions {
  PoseNetworkSize network = PoseNetworkSize::kHeavy;
  bool masks = false;         ///< poses include masks, in the frames where Detect() is asked for them
  int max_people = 0;         ///< those of highest score are kept; 0: everybody
  int search_interval = 30;   ///< frames
  int tile_levels = 2;        ///< finest squares in which people are searched: 1/tile_levels of the longer side
  double min_presence = 0.5;  ///< below it a region counts as empty
  int num_threads = 2;
  [[nodiscard]] bool IsValid() const;
};

struct PeopleDetectorSummary {
  int frames = 0, searches = 0, regions = 0;        ///< regions evaluated
  double search_seconds = 0, landmark_seconds = 0;  ///< wall time
  HandsAndFaceSummary hands_and_faces;              ///< of FrameDetector
};

class PeopleDetector {
 public:
  static constexpr int kFramesAtOnce = 2;

  /// Reads the networks from `folder`, or where they are installed when it is empty (model_files.h). Throws
  /// std::runtime_error naming a file that is missing or no such network, std::invalid_argument for options that are
  /// not valid.
  PeopleDetector(const std::string& folder, const PeopleDetectorOptions& options);
  ~PeopleDetector();
  PeopleDetector(PeopleDetector&&) noexcept;
  PeopleDetector& operator=(PeopleDetector&&) noexcept;

  /// The next frames of the clip, all of one size: a group of 1 to kFramesAtOnce. Returns the people of
  /// each, those followed longest first. with_mask: for each frame whether its poses include masks (if the options say
  /// so); empty: all. Throws std::invalid_argument for another number or another size.
  std::vector<std::vector<DetectedPose>> Detect(std::span<const Image> frames, std::span<const char> with_mask = {});

  [[nodiscard]] const PeopleDetectorSummary& summary() const;

 private:
  class Follower;
  std::unique_ptr<Follower> follower_;
};

}  // namespace bodyloom
