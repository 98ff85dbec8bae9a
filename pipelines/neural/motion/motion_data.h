// SPDX-License-Identifier: Apache-2.0
/// Provides training data of the motion-dependent renderer from files: a single-person dataset, or a video with a
/// track.
#pragma once

#include <memory>
#include <string>

#include "data_tools/descriptors/dense_history.h"
#include "data_tools/descriptors/estimated_pixels.h"
#include "data_tools/descriptors/person_frames.h"
#include "geometry/scene/track.h"
#include "neural/motion/motion_config.h"
#include "neural/motion/motion_frame.h"

namespace bodyloom {

struct MotionDataRequest {
  std::string data;   ///< a single-person dataset, a video or a folder of images
  std::string track;  ///< empty: the single-person dataset's own
  std::string body;   ///< empty: the built-in body
  std::string iuv;    ///< what pixels show of the body: a folder of DensePose's IUV images, or kOwnIuv, the
                      ///< single-person dataset's; empty: what the tracked body says
  /// For a video: the person's mask (bodyloom detect --mask, bodyloom run --masks), and DensePose parts, used in place
  /// of clothing labels; each is optional. With one of them, labels and normals are those of the tracked body within
  /// that outline (data_tools/datasets/body_truth.h).
  std::string mask, part_labels;
  MotionDescriptor descriptor = MotionDescriptor::kSurface;
  SurfaceMotion motion;         ///< axes and velocities of the motion maps
  double pixels_per_metre = 0;  ///< of the window; 0: the largest that the profile's image_size allows
  int num_threads = 0;
};

inline constexpr const char* kOwnIuv = "own";

class MotionData {
 public:
  /// Computes the track's descriptors and places the window around the person. Throws std::runtime_error naming files
  /// that do not match (sizes, numbers of frames).
  MotionData(const MotionDataRequest& request, const MotionProfile& profile, int multiple);
  ~MotionData();
  MotionData(const MotionData&) = delete;
  MotionData& operator=(const MotionData&) = delete;

  [[nodiscard]] const PersonFrames& frames() const;
  [[nodiscard]] const Track& track() const;
  /// Scale of the window at the body's root, pixels per metre.
  [[nodiscard]] double PixelsPerMetre() const;
  [[nodiscard]] bool has_labels() const;
  [[nodiscard]] bool has_normals() const;
  [[nodiscard]] std::string notes() const;  ///< lines for the user: unused data and substitutes

  /// Fills the networks' input of frame t; images are read once and kept.
  void Fill(int t, bool with_truth, MotionFrame* frame);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Fills the part of a frame that does not need images: descriptor maps, surface coordinates, and the window's
/// position. `dense`: the descriptor in the image plane; nullptr: the surface's motion maps. `estimated`: estimated
/// surface coordinates of pixels; nullptr: those of the tracked body.
void FillMotion(const PersonFrames& frames, const DenseHistory* dense, const EstimatedPixels* estimated, int t,
                MotionFrame* frame);

// Frame rate of the motion-dependent renderer's clips. A run has one rate, as the network's input includes velocities
// of past frames and its own previous image.

/// Returns true if the frame rate of the track, apart from gaps, is `fps` within 1 %, or the track is too short to
/// tell.
bool IsAtRate(const Track& track, double fps);

/// Frame rate of the track as text: "60 frames a second".
std::string RateText(const Track& track);

/// Throws std::runtime_error unless IsAtRate(), naming the data, both rates and a remedy, as images cannot be
/// resampled.
void RequireRate(const Track& track, double fps, const std::string& data, const std::string& what_helps);

}  // namespace bodyloom
