// SPDX-License-Identifier: Apache-2.0
/// What a request says of the scene, whoever is in it: body model, camera, and what was learned.
#pragma once

#include <memory>
#include <optional>

#include "data_tools/observations/load_camera_path.h"
#include "data_tools/observations/load_cameras.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/lifter_weights.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/pose_prior.h"
#include "pipelines/track/track_request.h"
#include "tracking/problem/track_input.h"

namespace bodyloom {

/// What a program holds in memory: it takes the place of the file that a request would name.
struct GivenInMemory {
  const KeypointSequence* keypoints = nullptr;  ///< of one person; borrowed
  std::shared_ptr<const BodyModel> body;        ///< null: the request's
  std::optional<Camera> camera;                 ///< all of it is known
};

struct SceneInputs {
  std::shared_ptr<const BodyModel> body;
  std::optional<PosePrior> prior;
  std::optional<LifterWeights> lifter;
  NamedCamera camera;  ///< intrinsics, pose and the way to the video's pixels, as far as known (UseFocal)
  std::optional<RecordedCameraPath> camera_path;  ///< of a camera that moves
  CameraKnowledge camera_knowledge = CameraKnowledge::kKnown;
  double focal_35mm_mm = 0;         ///< of the lens, as requested or as the video notes it; 0: not known
  double focal_35mm_log_sigma = 0;  ///< how well that tells the focal length
  double video_fps = 0;
  double stature_m = 0;  ///< of whoever is tracked; 0: the mean body's

  /// What the tracker is told of the scene, without the camera's path, which each person has their frames of; pointers
  /// into this object.
  [[nodiscard]] TrackSequenceInput ForTracker() const;
};

/// Every file that the request and the detector name. Throws std::runtime_error naming one that is not there or cannot
/// be read.
std::vector<std::string> RequireFiles(const SceneRequest& request, const FrameDetectorOptions& detector);

/// Reads what the request names and is not given; the camera has the video's size where nothing else says.
/// `detections`: the file of what was seen in the view, if any, which may tell the camera of a calibration folder.
/// `needs_lifter`: otherwise the built-in one is left out. Throws std::runtime_error naming file and place.
SceneInputs LoadSceneInputs(const SceneRequest& request, const GivenInMemory& given = {},
                            const std::string& detections = "", bool needs_lifter = true);

/// A focal length of the request's, if any, makes the camera a pinhole of its image size, which must be known by now.
void UseFocal(const SceneRequest& request, Camera* camera);

}  // namespace bodyloom
