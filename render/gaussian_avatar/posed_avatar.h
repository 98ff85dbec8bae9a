// SPDX-License-Identifier: Apache-2.0
/// Provides poses and views of a track's frames for rendering a person of Gaussians.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "render/gaussian_avatar/avatar_painter.h"
#include "render/gaussian_avatar/worn_garment.h"
#include "render/uv_maps/posed_track.h"

namespace bodyloom {

/// Keeps references to body and track.
class PosedAvatar {
 public:
  /// `yaw_deg`: as for PosedTrack. `scale`: size of the images relative to the track's. Throws
  /// std::invalid_argument naming `where` when the camera's lens is distorted.
  PosedAvatar(const BodyModel& body, const Track& track, std::vector<double> yaw_deg, double scale, int num_threads,
              const std::string& where);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] bool HasResult(int t) const { return track_.HasResult(t) && !extents_[t].empty(); }

  /// Adds the bones of a garment to frames from now on: to frame t those of shown[t], or of t if `shown` is empty.
  void Wear(GarmentBones bones, std::vector<int> shown = {});
  [[nodiscard]] const GarmentBones& garment() const { return garment_; }  ///< without frames: none

  /// Creates the frame t, which must have a result.
  void MakeFrame(int t, AvatarFrame* frame) const;
  /// Bones of another run of the garment in frame t, in the format in which MakeFrame() appends those of the worn one.
  [[nodiscard]] std::vector<float> SeenCloth(int t, const GarmentBones& run) const;
  [[nodiscard]] Camera CameraAt(int t) const;
  /// Box of the bare body, grown by `share` of its longer side; clipped to the image.
  [[nodiscard]] PixelBox BoxAt(int t, double share) const;
  /// Camera, window with a margin for clothes, and the light of the track's own view.
  [[nodiscard]] AvatarView ViewAt(int t) const;

 private:
  [[nodiscard]] CameraPose CameraPoseAt(int t) const;
  const BodyModel& body_;
  const Track& track_;
  PosedTrack posed_;
  AvatarFrames frames_;
  double scale_;
  int num_threads_, width_, height_;
  std::vector<PersonExtent> extents_;  ///< pixels of the track's image
  GarmentBones garment_;
  std::vector<int> shown_;
};

}  // namespace bodyloom
