// SPDX-License-Identifier: Apache-2.0
/// Poses and draws a Gaussian avatar frame by frame in a motion, with its garment simulated.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "data_tools/avatar/avatar_file.h"
#include "geometry/base/callbacks.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"
#include "render/gaussian_avatar/avatar_painter.h"
#include "render/gaussian_avatar/posed_avatar.h"

namespace bodyloom {

// A Gaussian avatar as written by `bodyloom train avatar`, with the body that it was trained on.

struct LearnedAvatar {
  std::string run;  ///< the folder or file that it was read from, for messages
  AvatarFile file;
  std::shared_ptr<const BodyModel> body;
};

/// Reads an avatar. `run`: the folder of a run, or its avatar.npz. `body`: a file; empty: the built-in body. Throws
/// std::runtime_error naming a file that cannot be used, or for a body that is not the avatar's.
LearnedAvatar ReadLearnedAvatar(const std::string& run, const std::string& body);

struct ShownMotion {
  Track track;        ///< of the person's body
  std::string where;  ///< the track's file, for messages
  /// True: the track's shape is kept; false: the avatar's shape is used.
  bool keeps_shape = false;
  std::string view_yaw;  ///< how far the view is turned (pipelines/animate/animation_limits.h)
  std::string freeze;    ///< frames shown repeatedly (pipelines/animate/animation_limits.h); empty: none
  int size = 0;          ///< pixels of the image's longer side; 0: as the track's
};

class ShownAvatar {
 public:
  /// Shown without the distortion of the track's lens, by a camera that stands still (WithStillCamera). Simulates the
  /// garment along the whole motion, which takes most of the time. Keeps a reference to `avatar`. An avatar of an
  /// earlier version with a learned network of the motion is shown without it, with a message. Throws
  /// std::runtime_error naming what cannot be used, RequestError for an invalid view or freeze, Cancelled.
  ShownAvatar(const LearnedAvatar& avatar, ShownMotion motion, int num_threads, const PipelineCallbacks& callbacks);
  ShownAvatar(const ShownAvatar&) = delete;
  ShownAvatar& operator=(const ShownAvatar&) = delete;

  /// The track as shown: with the shape that is used, frozen frames repeated.
  [[nodiscard]] const Track& track() const { return track_; }
  [[nodiscard]] int num_frames() const { return track_.num_frames(); }
  [[nodiscard]] int width() const { return posed_->width(); }
  [[nodiscard]] int height() const { return posed_->height(); }
  /// True if the frame shows the person; other frames cannot be drawn.
  [[nodiscard]] bool HasResult(int t) const { return posed_->HasResult(t); }
  [[nodiscard]] Camera CameraAt(int t) const { return posed_->CameraAt(t); }
  /// Poses of the garment's nodes in the motion's own frames; no frames: no garment.
  [[nodiscard]] const GarmentBones& garment() const { return posed_->garment(); }

  /// Draws frame t, which must have a result. References returned by this class are valid until the next Draw.
  const SplatImage& Draw(int t);
  /// Draws a given pose from a given view.
  const SplatImage& Draw(const AvatarFrame& frame, const AvatarView& view);

  // Results of the last Draw.
  [[nodiscard]] const SplatImage& image() const { return painter_.image(); }
  [[nodiscard]] const CameraGaussians& posed() const { return painter_.posed(); }
  [[nodiscard]] const AvatarFrame& frame() const { return frame_; }  ///< of Draw(t)
  /// Share of the garment in each pixel, in [0, 1]; empty without a garment.
  [[nodiscard]] std::vector<float> GarmentShare();

 private:
  void Pose(const ShownMotion& motion, const PipelineCallbacks& callbacks);

  const LearnedAvatar& avatar_;
  const int threads_;
  Track track_;
  std::optional<PosedAvatar> posed_;
  AvatarFrame frame_;
  AvatarPainter painter_;
};

}  // namespace bodyloom
