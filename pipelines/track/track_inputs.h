// SPDX-License-Identifier: Apache-2.0
/// Loads the tracker's inputs from the files that a request names, and checks them against each other.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track.h"
#include "pipelines/track/clip_camera_path.h"
#include "pipelines/track/initial_poses.h"
#include "pipelines/track/scene_inputs.h"
#include "pipelines/track/track_request.h"
#include "tracking/lifter/lifter_reading.h"
#include "tracking/room/picture_vertical.h"

namespace bodyloom {

struct TrackInputs : SceneInputs {
  std::optional<KeypointSequence> keypoints;
  HandsAndFaceSequence hands_and_face;  ///< in the frames of the keypoints; without frames: not used
  std::optional<DenseSequence> dense;
  std::optional<PartLabelSequence> part_labels;
  bool joints_from_labels = false;            ///< `keypoints` were derived from `part_labels`
  std::vector<CameraPose> camera_from_scene;  ///< of every frame, or empty: static camera
  CameraPathReport camera_path_report;
  double camera_scale_m = 1;
  std::optional<InitialPoses> initialiser;
  std::vector<LiftedFrame>
      lifted;  ///< the lifter's landmarks, replaced by those of the initialiser in frames where it gives some
  std::optional<Track> reference;
  std::optional<PictureVertical> picture_vertical;  ///< with a video

  /// With only part labels given, keypoints are those derived from the labels.
  [[nodiscard]] int num_frames() const { return keypoints ? keypoints->num_frames() : dense->num_frames(); }
  [[nodiscard]] const std::vector<double>& timestamps() const {
    return keypoints ? keypoints->timestamps : dense->timestamps;
  }
  /// Pointers into this object.
  [[nodiscard]] TrackSequenceInput ForTracker() const;
};

/// Files named by the request. Throws std::runtime_error naming one that is missing or unreadable.
std::vector<std::string> RequireTrackInputs(const TrackRequest& request);

/// Reads the files of the request that are not replaced by `given` (request.detections then names the keypoints in
/// messages), and detects people if only a video is given. Throws Cancelled, and std::runtime_error naming file and
/// place, also for files that contradict each other (image sizes, number of frames).
TrackInputs LoadTrackInputs(const TrackRequest& request, const PipelineCallbacks& callbacks = {},
                            const GivenInMemory& given = {});

}  // namespace bodyloom
