// SPDX-License-Identifier: Apache-2.0
/// Training data of the motion-dependent renderer from files: a single-person dataset, or a video with a track.
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
  /// For a video: where the person is (bodyloom detect --mask, bodyloom run --masks), and DensePose's parts, which
  /// stand in for a parsing of the clothes; each may do without the other. With one of them labels and normals are
  /// those of the tracked body within that outline (data_tools/datasets/body_truth.h).
  std::string mask, part_labels;
  MotionDescriptor descriptor = MotionDescriptor::kSurface;
  SurfaceMotion motion;         ///< axes and velocities of the motion maps
  double pixels_per_metre = 0;  ///< of the window; 0: as large as the profile's image_size allows
  int num_threads = 0;
};

inline constexpr const char* kOwnIuv = "own";

class MotionData {
 public:
  /// Describes the track and plans the window around the person. Throws std::runtime_error naming files that do not fit
  /// each other (sizes, numbers of frames).
  MotionData(const MotionDataRequest& request, const MotionProfile& profile, int multiple);
  ~MotionData();
  MotionData(const MotionData&) = delete;
  MotionData& operator=(const MotionData&) = delete;

  [[nodiscard]] const PersonFrames& frames() const;
  [[nodiscard]] const Track& track() const;
  /// Pixels of the window a metre at the body's root.
  [[nodiscard]] double PixelsPerMetre() const;
  [[nodiscard]] bool has_labels() const;
  [[nodiscard]] bool has_normals() const;
  [[nodiscard]] std::string notes() const;  ///< lines for the user: what is not used, what stands in for what

  /// Frames as the networks take them; pictures are read once and kept.
  void Fill(int t, bool with_truth, MotionFrame* frame);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// The part of a frame that does not need pictures: the descriptor's maps, surface coordinates, the window's place.
/// `dense`: the descriptor in the picture's plane; nullptr: the surface's motion maps. `estimated`: where pixels lie on
/// the body; nullptr: as the tracked body has it.
void FillMotion(const PersonFrames& frames, const DenseHistory* dense, const EstimatedPixels* estimated, int t,
                MotionFrame* frame);

// The frame rate of the motion-dependent renderer's clips. The network sees velocities of so many past frames and its
// own last picture, so a run is of one rate.

/// Whether the track has `fps` frames a second between its gaps, to 1 %, or is too short to say.
bool IsAtRate(const Track& track, double fps);

/// "60 frames a second", as far as it matters.
std::string RateText(const Track& track);

/// Throws std::runtime_error unless IsAtRate, naming the data, both rates, and what helps: pictures cannot be
/// resampled.
void RequireRate(const Track& track, double fps, const std::string& data, const std::string& what_helps);

}  // namespace bodyloom
