// SPDX-License-Identifier: Apache-2.0
/// Follows points of the background through a clip, frame by frame as they come; pictures are not kept.
///
/// Frames are shrunk by a whole number to at most 640 pixels and made grey. In an *anchor* frame the best corner of
/// every cell of 32 × 32 pixels is chosen, or of 16 × 16 if that gives fewer than 80 (least eigenvalue of the
/// gradient's covariance; Shi and Tomasi 1994), outside people and the picture's border. Each is sought in later frames
/// by OpenCV's pyramidal search (Lucas and Kanade; Bouguet 2001) in the anchor's own picture, from where it is expected
/// after the latest sights, and back again: a place is kept if the way back ends within 0.4 pixels of the start and
/// nobody covers it. When less than six tenths of the points that were seen at first are left, the frame becomes the
/// next anchor: points that are seen there live on under their names, at the places where they are seen, and corners of
/// cells without any are added. Frames with fewer than 12, or three tenths of those before, are passed over. From 0.1 s
/// of them on earlier anchors are sought in them, and one in which half of an anchor's points are is the next anchor,
/// in which they live on; after 0.7 s the next anchor begins anew (a cut, a whip pan, a blank wall).
///
/// While the points rest, only one frame in a fifth of a second is looked at. Once they move (their median by more than
/// 0.3 shrunk pixels) every frame is, those that were passed over included: their small pictures are kept until then.
/// After a second of rest frames are passed over again.
///
/// Every anchor is also sought in up to 24 earlier ones whose pictures are kept, some 40 MB (every other one is dropped
/// when there are more): a camera that comes back closes the loop.
#pragma once

#include <memory>
#include <span>

#include "geometry/scene/background_tracks.h"
#include "geometry/scene/label_image.h"
#include "render/image/image.h"

namespace bodyloom {

/// Pixels where somebody may be: the mask, if it has pixels, otherwise the rectangle.
struct CoveredRegion {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< pixels of the frame, margin included; empty: x1 < x0
  LabelImage mask;                        ///< without margin
};

class BackgroundTracker {
 public:
  BackgroundTracker();
  ~BackgroundTracker();
  BackgroundTracker(BackgroundTracker&&) noexcept;
  BackgroundTracker& operator=(BackgroundTracker&&) noexcept;

  /// The clip's next frame. Throws std::invalid_argument for an empty frame, one of another size than the first, or
  /// times that do not increase.
  void Push(const Image& frame, double time_s, std::span<const CoveredRegion> covered);

  /// The points of all frames so far. Call once, after the last frame.
  BackgroundTracks Finish();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bodyloom
