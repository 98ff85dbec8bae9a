// SPDX-License-Identifier: Apache-2.0
/// Straight line segments of what stands still behind the people of a clip, or of one picture.
///
/// A few frames spread over the clip are kept in grey, shrunk to at most 1280 pixels. Their median over the frames in
/// which nobody covers the pixel shows the room without the people; pixels that people cover in more than four fifths
/// of the frames are masked. Segments come from OpenCV's detector (von Gioi et al. 2012, LSD).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/scene/line_segment.h"
#include "render/image/image.h"
#include "tracking/detection/small_picture.h"

namespace bodyloom {

/// A shrunk frame of a clip.
struct GreySample {
  int frame = 0;              ///< index in the clip
  std::vector<uint8_t> grey;  ///< rows from top to bottom
};

/// Keeps evenly spaced frames of a clip whose length need not be known: every n-th, and n doubles when there are
/// 2·kFewestSamples.
class FrameSamples {
 public:
  static constexpr int kFewestSamples = 12;

  /// Adds the next frame; returns true if it was kept. Throws std::invalid_argument for an empty one or one of another
  /// size.
  bool Add(const Image& frame);

  [[nodiscard]] int image_width() const { return image_width_; }
  [[nodiscard]] int image_height() const { return image_height_; }
  [[nodiscard]] const SmallPicture& small() const { return small_; }  ///< of the samples
  [[nodiscard]] const std::vector<GreySample>& samples() const { return samples_; }

 private:
  int image_width_ = 0, image_height_ = 0;
  SmallPicture small_;
  int next_ = 0, step_ = 1;
  std::vector<GreySample> samples_;
};

/// The room behind the people.
struct StillPicture {
  int width = 0, height = 0;
  double scale = 1;             ///< SmallPicture::scale
  std::vector<uint8_t> grey;    ///< median
  std::vector<uint8_t> people;  ///< not 0: masked
  /// Of the pixels that are not masked: share whose median absolute deviation over the frames exceeds 8 levels. Above
  /// kMaxRestlessShare the camera moves, or the clip has cuts.
  double restless_share = 0;
};

inline constexpr double kMaxRestlessShare = 0.1;

/// `covered`: of each of the samples; empty: nobody there. Throws std::invalid_argument for another number or size.
StillPicture MedianPicture(const FrameSamples& samples, std::span<const CoveredPixels> covered, int num_threads = 1);

/// The same as a camera that turns sees it in one of its directions. `moved_from_sample`: of each of the samples the
/// homography of the frames' pixels from its direction to that one; pixels beyond the sample are hidden in it.
StillPicture MedianPicture(const FrameSamples& samples, std::span<const CoveredPixels> covered,
                           std::span<const Eigen::Matrix3d> moved_from_sample, int num_threads = 1);

/// Segments of at least `min_share` of the picture's longer side, in pixels of the frames; those of which more than a
/// tenth is masked are left out, and so are the picture's own borders and the edges of black bars beside it.
std::vector<LineSegment> FindLineSegments(const StillPicture& picture, double min_share = 0.02);

}  // namespace bodyloom
