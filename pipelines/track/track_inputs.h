// SPDX-License-Identifier: Apache-2.0
/// The tracker's inputs from file names: everything that a request names, checked against each other.
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

namespace bodyloom {

struct TrackInputs : SceneInputs {
  std::optional<KeypointSequence> keypoints;
  std::optional<DenseSequence> dense;
  std::optional<PartLabelSequence> part_labels;
  bool joints_from_labels = false;            ///< `keypoints` were read off `part_labels`
  std::vector<CameraPose> camera_from_scene;  ///< of every frame, or empty: the camera stands still
  CameraPathReport camera_path_report;
  double camera_scale_m = 1;
  std::optional<InitialPoses> initialiser;
  std::vector<LiftedFrame>
      lifted;  ///< the lifter's landmarks with the initialiser's in their place, when it gives such
  std::optional<Track> reference;

  /// Keypoints are always there when only part labels were given: those read off the labels.
  [[nodiscard]] int num_frames() const { return keypoints ? keypoints->num_frames() : dense->num_frames(); }
  [[nodiscard]] const std::vector<double>& timestamps() const {
    return keypoints ? keypoints->timestamps : dense->timestamps;
  }
  /// Pointers into this object.
  [[nodiscard]] TrackSequenceInput ForTracker() const;
};

/// Every file that the request names. Throws std::runtime_error naming one that is not there or cannot be read.
std::vector<std::string> RequireTrackInputs(const TrackRequest& request);

/// Reads what the request names and is not given (request.detections then names the keypoints in messages), and detects
/// people when there is nothing but a video. Throws Cancelled, and std::runtime_error naming file and place, also when
/// two files contradict each other (image sizes, number of frames).
TrackInputs LoadTrackInputs(const TrackRequest& request, const PipelineCallbacks& callbacks = {},
                            const GivenInMemory& given = {});

}  // namespace bodyloom
