// SPDX-License-Identifier: Apache-2.0
/// Loads the inputs of a scene that do not depend on the person: body model, camera, and learned models.
#pragma once

#include <memory>
#include <optional>

#include "data_tools/observations/load_camera_path.h"
#include "data_tools/observations/load_cameras.h"
#include "data_tools/video/video_reader.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/hands_and_face.h"
#include "geometry/scene/lifter_weights.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/pose_prior.h"
#include "geometry/scene/track.h"
#include "pipelines/track/track_request.h"
#include "tracking/problem/track_input.h"

namespace bodyloom {

/// Inputs given in memory, which replace the files named by a request.
struct GivenInMemory {
  const KeypointSequence* keypoints = nullptr;  ///< of one person; borrowed
  /// In the frames of the keypoints, or null; borrowed.
  const HandsAndFaceSequence* hands_and_face = nullptr;
  std::shared_ptr<const BodyModel> body;  ///< null: the request's
  std::optional<Camera> camera;           ///< fully known
};

struct SceneInputs {
  std::shared_ptr<const BodyModel> body;
  std::optional<PosePrior> prior;
  std::optional<LifterWeights> lifter;
  NamedCamera camera;  ///< intrinsics, pose and map to the video's pixels, as far as known (UseFocal)
  std::optional<RecordedCameraPath> camera_path;  ///< of a moving camera
  /// The background in the frame of the path's first pose, its units; empty: the path was not found in the video.
  std::vector<Eigen::Vector3d> background_points;
  CameraKnowledge camera_knowledge = CameraKnowledge::kKnown;
  double focal_35mm_mm = 0;         ///< of the lens, from the request or the video's metadata; 0: unknown
  double focal_35mm_log_sigma = 0;  ///< standard deviation of log(focal length)
  /// Of a camera that turns or goes somewhere, from its background (found_camera_motion.h); takes the place of the
  /// lens' prior.
  std::optional<FocalPrior> focal_of_motion;
  VideoInfo video;         ///< of the turned video; width 0: there is none
  VideoPlayback playback;  ///< of the video
  /// Rate of the video's frames on the track's clock; 0: unknown.
  [[nodiscard]] double video_fps() const { return video.fps * playback.slowdown; }
  double stature_m = 0;  ///< of the tracked person; 0: the mean body's

  /// The tracker's input for the scene, without the camera's path, of which each person needs different frames; holds
  /// pointers into this object.
  [[nodiscard]] TrackSequenceInput ForTracker() const;
};

/// Files named by the request and the detector. Throws std::runtime_error naming one that is missing or unreadable.
std::vector<std::string> RequireFiles(const SceneRequest& request, const FrameDetectorOptions& detector);

/// Reads the files of the request that are not replaced by `given`; the camera has the video's size if nothing else
/// defines it. `detections`: the file of the observations in the view, if any, which may identify the camera in a
/// calibration folder. `needs_lifter`: false skips the built-in lifter. Throws std::runtime_error naming file and
/// place.
SceneInputs LoadSceneInputs(const SceneRequest& request, const GivenInMemory& given = {},
                            const std::string& detections = "", bool needs_lifter = true);

/// Makes the camera a pinhole with the request's focal length, if any, and its image size, which must be known.
void UseFocal(const SceneRequest& request, Camera* camera);

}  // namespace bodyloom
