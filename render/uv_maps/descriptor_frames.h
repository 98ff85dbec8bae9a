// SPDX-License-Identifier: Apache-2.0
/// Motion descriptors of the frames of a track, in memory: the input of the neural renderers.
///
/// Frame t holds, as maps over the body's UV atlas, the unit normals of the posed surface and the velocities of the
/// surface in this and the past frames:
///   [ N_t (3), V_t (3), V_{t−1} (3), …, V_{t−past+1} (3) ],     33 channels for past = 10
/// with N = ∂p/∂X and V = ∂p/∂t of Yoon et al., "Learning Motion-Dependent Appearance for High-Fidelity Rendering of
/// Dynamic Humans from a Single Camera", eq. 4–5. V_{t−k} is the velocity of the surface at frame t−k, in that frame's
/// own axes, identical to the map V of frame t−k. Normals have length 1, velocities are in m/s.
///
/// Each channel is a plane of height × width floats: row r, column c is centred at u = (c + 0.5) / width,
/// v = 1 − (r + 0.5) / height. A frame's planes follow one another in the order above (C×H×W).
///
/// Before the first frame of a gap-free run (geometry/uv_maps/velocity_stencil.h) velocities are zero. Frames without a
/// fit are zero throughout, as are empty texels. Never NaN.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"
#include "geometry/uv_maps/descriptor_options.h"
#include "geometry/uv_maps/uv_texels.h"

namespace bodyloom {

/// Caches past velocity maps: frames in ascending order cost one normal map and one velocity map each; any other order
/// gives the same values. Not for use by two threads at once.
class DescriptorFrames {
 public:
  /// Borrows body and track. Throws std::invalid_argument when options are not valid, the track has no frames, is not
  /// this body's, its times do not increase (naming the frame), the body has no UV map, or seen_only is requested for a
  /// track without an image size.
  DescriptorFrames(const BodyModel& body, const Track& track, const DescriptorOptions& options = {});
  ~DescriptorFrames();
  DescriptorFrames(DescriptorFrames&&) noexcept;
  DescriptorFrames& operator=(DescriptorFrames&&) noexcept;

  [[nodiscard]] int num_frames() const;
  [[nodiscard]] int channels() const;
  [[nodiscard]] int height() const;
  [[nodiscard]] int width() const;
  /// Number of values per frame: channels() · height() · width().
  [[nodiscard]] size_t frame_size() const;
  /// Surface point of each texel, and counts of the used texels of the atlas.
  [[nodiscard]] const UvTexelTable& texels() const;
  /// True if frame t has a fit; without one its planes are zero.
  [[nodiscard]] bool HasFit(int t) const;

  /// Computes the planes of frame t, C×H×W: the same bytes as the record of DescribeTrack()'s float32 file. Throws
  /// std::invalid_argument when t is not a frame of the track or `planes` is not of frame_size().
  void Planes(int t, std::span<float> planes);

  /// Computes the planes of several frames (ascending), one after another, with DescriptorOptions::num_threads threads.
  /// Throws std::invalid_argument as above, and for frames that do not ascend.
  void Planes(std::span<const int> frames, std::span<float> planes);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bodyloom
