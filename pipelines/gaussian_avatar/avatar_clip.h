// SPDX-License-Identifier: Apache-2.0
/// Training data of a Gaussian avatar: a single-person dataset, or a video with a track and the person's mask.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "data_tools/datasets/single_person_dataset.h"
#include "geometry/base/callbacks.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track.h"
#include "render/gaussian_avatar/learning/training_view.h"
#include "render/gaussian_avatar/posed_avatar.h"
#include "render/image/lens_correction.h"

namespace bodyloom {

struct AvatarClipRequest {
  std::string data;   ///< a single-person dataset, a video or a folder of images
  std::string track;  ///< empty: the single-person dataset's own
  std::string mask;   ///< for a video: the person's mask or DensePose's parts (data_tools/observations/part_labels.h)
  std::string body;   ///< the track's body; empty: the built-in body
  int threads = 1;
};

class AvatarClip {
 public:
  /// Throws std::runtime_error naming files that cannot be used or do not match, RequestError for a video without track
  /// or mask.
  explicit AvatarClip(const AvatarClipRequest& request);

  [[nodiscard]] const BodyModel& body() const { return *body_; }
  /// Its camera has no distortion: images of a lens that distorts are corrected as they are read (LensCorrection).
  [[nodiscard]] const Track& track() const { return track_; }
  /// The camera of the track's file.
  [[nodiscard]] const Camera& camera_of_file() const { return camera_of_file_; }
  [[nodiscard]] const PosedAvatar& posed() const { return *posed_; }

  /// Mask of the person near the tracked body, in a frame with a result. Throws std::runtime_error when it cannot be
  /// read.
  [[nodiscard]] LabelImage MaskAt(int t) const;

  /// Adds a garment's bones, for every frame of the track, to all views read afterwards: those of the first run as the
  /// frame's own, those of the other runs as TrainingView::other_cloth. At least one run.
  void Wear(std::vector<GarmentBones> runs);

  /// Reads the views of these frames (ascending), in windows that enclose the person and, with `with_body`, the tracked
  /// body, plus `margin` pixels. A frame without a result or without the person has an empty window. Throws
  /// std::runtime_error when an image cannot be read; Cancelled. The stage is "reading".
  [[nodiscard]] std::vector<TrainingView> ReadViews(const std::vector<int>& frames, int margin, bool with_body,
                                                    const PipelineCallbacks& callbacks) const;

 private:
  void OpenVideo();
  void CheckSize(const std::string& file, int num_frames, int width, int height) const;
  /// Value at the pixel of the file's image that pixel (x, y) of the corrected one shows; 0 where there is none.
  [[nodiscard]] uint8_t PersonOf(const PersonAt& person_in_file, int x, int y) const;
  [[nodiscard]] TrainingView CutView(int t, const Image& image, const PersonAt& person_in_file, int margin,
                                     bool with_body) const;

  AvatarClipRequest request_;
  std::shared_ptr<const BodyModel> body_;
  std::optional<SinglePersonDataset> set_;
  std::optional<PartLabelSequence> mask_;
  Track track_;
  Camera camera_of_file_;
  std::optional<LensCorrection> lens_;  ///< where the lens distorts
  std::unique_ptr<PosedAvatar> posed_;
  std::vector<GarmentBones> other_runs_;
};

}  // namespace bodyloom
