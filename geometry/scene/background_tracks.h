// SPDX-License-Identifier: Apache-2.0
/// Background points of a clip followed from frame to frame: found by tracking/detection/background_tracker.h, read by
/// tracking/camera_motion/camera_motion.h.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace bodyloom {

/// Points chosen in one frame, the anchor, and their places in later frames. Every place is measured against the
/// anchor's own picture, so that errors do not add up from frame to frame.
struct BackgroundTracks {
  /// Places of an anchor's points in another frame.
  struct Sight {
    int frame = 0;                        ///< index in the clip
    std::vector<Eigen::Vector2f> pixels;  ///< one per point of the anchor; NaN: not seen there
  };
  struct Anchor {
    int frame = 0;
    std::vector<Eigen::Vector2f> pixels;  ///< in the anchor's own frame
    /// Names of the points, distinct; a point of an earlier anchor that is followed on keeps its name.
    std::vector<int> points;
    /// In rising order of frames, all later than the anchor. The next anchor's frame is the last one, unless the
    /// points were lost before it. Sights of anchors before (loop closures) follow those of the frames in between.
    std::vector<Sight> sights;
    bool after_break = false;  ///< nothing links it to the anchor before: a cut, or points lost
  };

  int width = 0, height = 0;       ///< of the frames, pixels
  std::vector<double> timestamps;  ///< seconds, of every frame of the clip
  std::vector<Anchor> anchors;     ///< in rising order of frames
};

}  // namespace bodyloom
