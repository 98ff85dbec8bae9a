// SPDX-License-Identifier: Apache-2.0
/// A person of Gaussians in a motion, drawn frame by frame: posed, its garment simulated.
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

// A person of Gaussians as `bodyloom train avatar` left it, with the body that it was learned on.

struct LearnedAvatar {
  std::string run;  ///< the folder or file that it was read from, for messages
  AvatarFile file;
  std::shared_ptr<const BodyModel> body;
};

/// `run`: the folder of a run, or its avatar.npz. `body`: a file; empty: the built-in body. Throws std::runtime_error
/// naming a file that cannot be used, and for another body than the person's.
LearnedAvatar ReadLearnedAvatar(const std::string& run, const std::string& body);

struct ShownMotion {
  Track track;        ///< of the person's body
  std::string where;  ///< the track's file, for messages
  /// The track's shape is kept; otherwise it is the person's.
  bool keeps_shape = false;
  std::string view_yaw;  ///< how far the view is turned (pipelines/animate/animation_limits.h)
  std::string freeze;    ///< where time stands still (pipelines/animate/animation_limits.h); empty: nowhere
  int size = 0;          ///< pixels of the picture's longer side; 0: as the track's
};

class ShownAvatar {
 public:
  /// The garment is simulated along the whole motion, which is most of what this takes. Keeps a reference to `avatar`.
  /// A person who learned a network of the motion, as those of earlier versions did, is shown without it, and a message
  /// says so.
  /// Throws std::runtime_error naming what cannot be used, RequestError for a view or freeze that is none, Cancelled.
  ShownAvatar(const LearnedAvatar& avatar, ShownMotion motion, int num_threads, const PipelineCallbacks& callbacks);
  ShownAvatar(const ShownAvatar&) = delete;
  ShownAvatar& operator=(const ShownAvatar&) = delete;

  /// As it is shown: of the person's shape, its frames repeated where time stands still.
  [[nodiscard]] const Track& track() const { return track_; }
  [[nodiscard]] int num_frames() const { return track_.num_frames(); }
  [[nodiscard]] int width() const { return posed_->width(); }
  [[nodiscard]] int height() const { return posed_->height(); }
  /// Whether a frame shows the person; others cannot be drawn.
  [[nodiscard]] bool HasResult(int t) const { return posed_->HasResult(t); }
  [[nodiscard]] Camera CameraAt(int t) const { return posed_->CameraAt(t); }
  /// Where the garment's nodes are in the motion's own frames; without frames: none is worn.
  [[nodiscard]] const GarmentBones& garment() const { return posed_->garment(); }

  /// Frame t, which has a result. The references that this class gives are valid until the next Draw.
  const SplatPicture& Draw(int t);
  /// Posed and looked at as given.
  const SplatPicture& Draw(const AvatarFrame& frame, const AvatarView& view);

  // Of the picture last drawn.
  [[nodiscard]] const SplatPicture& picture() const { return painter_.picture(); }
  [[nodiscard]] const CameraGaussians& posed() const { return painter_.posed(); }
  [[nodiscard]] const AvatarFrame& frame() const { return frame_; }  ///< of Draw(t)
  /// How much of each pixel is the garment, in [0, 1]; empty: none is worn.
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
