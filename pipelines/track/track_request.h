// SPDX-License-Identifier: Apache-2.0
/// Requests for tracks: input files by name (empty: not given), other knowledge, and output files. Each job uses the
/// parts that it needs.
#pragma once

#include <optional>
#include <string>

#include "tracking/detection/frame_detector.h"
#include "tracking/problem/track_options.h"

namespace bodyloom {

/// Parts of the scene that do not depend on the person: body model, camera, and learned models.
struct SceneRequest {
  std::string video;                ///< for image size, frame rate and overlay; alone: people are detected in it
  std::optional<int> turn_deg = 0;  ///< clockwise turn of the video's frames, 0, 90, 180 or 270; none: FindTurn()
  /// Rate at which a slow-motion video was filmed: the track's clock then is that of the scene. 0: as it is played.
  double captured_fps = 0;
  std::string body;      ///< body model; empty: the built-in one
  std::string prior;     ///< pose prior; empty: the built-in one; "none"
  std::string lifter;    ///< weights of the lifter of 2D joints; empty: the built-in ones; "none"
  double stature_m = 0;  ///< of the person; 0: the mean body's

  std::string cameras;  ///< calibration file or folder
  std::string view;     ///< name of the camera in a file with several
  std::string camera;   ///< pinhole, unknown-focal or weak; empty: pinhole when intrinsics are given
  double focal_px = 0;  ///< intrinsics without a file: centred, undistorted
  /// 35 mm equivalent focal length (36 mm × 24 mm) where the focal length is estimated; 0: from the metadata of the
  /// video or photo.
  double focal_35mm_mm = 0;
  std::string camera_path;         ///< poses of a moving camera (load_camera_path.h); empty: static camera
  double camera_scale_m = 0;       ///< metres per unit of the path; 0: the file's, else estimated from the person
  int camera_path_first = -1;      ///< index of the clip's first frame in the path (PlaceInTime)
  double camera_path_fps = 0;      ///< frame rate of the path's numbered frames; 0: the clip's
  bool find_camera_motion = true;  ///< without a path: look whether the video's camera moved
  std::string camera_path_out;     ///< the path found, .json or COLMAP's images.txt; empty: not written
  bool use_lines = true;  ///< the picture's straight lines tell the vertical (tracking/room/picture_vertical.h)
  int image_width = 0, image_height = 0;  ///< used if neither camera, video nor detections give it
};

/// Detection of people in a video (pipelines/detect/detect_people.h).
struct DetectionSettings {
  FrameDetectorOptions detector;  ///< its masks and max_people are not used
  double detect_rate = 0;         ///< detection rate in slow motion, frames per second; 0: all frames
  bool use_mask = true;           ///< the person's mask becomes the silhouette term
  bool all_masks = false;         ///< detect masks in all frames, not only in those that the term uses
  double from_s = 0, to_s = -1;   ///< range of the video, or of the detections, seconds; to_s < 0: to the end
  double fps = 0;                 ///< frame rate without timestamps; 0: the video's, else 30
  double min_confidence = 0;      ///< landmarks below it are treated as missing
};

/// Settings common to tracking one person and everybody in a video.
struct TrackSettings : SceneRequest, DetectionSettings {
  TrackSequenceOptions solve;            ///< its straight_knees_weight is StraightKneesWeight()
  std::optional<double> straight_knees;  ///< 1/rad; none: StraightKneesWeight()'s own
};

/// Request for one person's track. People are detected in the video if no observations are given.
struct TrackRequest : TrackSettings {
  // Observations.
  std::string detections;                ///< 2D joints (and dense keypoints, when the file holds both)
  std::string dense;                     ///< dense surface keypoints from a file or folder of their own
  std::optional<double> dense_uv_sigma;  ///< their standard deviation on the surface, chart units; none: by source
  std::string part_labels;               ///< DensePose part of every pixel
  int person = 0;                        ///< 0: the largest and longest in view
  std::string convention;                ///< landmark order of OpenPose files; empty: recognised from the file
  int video_offset = 0;                  ///< video frame of the detections' time zero
  std::string init;                      ///< initial poses of another system, also used as a prior; same frames
  std::optional<int> live_lag;  ///< lag in frames of live tracking (tracking/live/live_tracker.h); none: offline

  // Outputs.
  std::string out;         ///< the track, .npz; may be empty with `plan`
  std::string overlay;     ///< video of the projected body, .mp4
  std::string json;        ///< ToJson(TrackReport)
  std::string report;      ///< the clip's page, .html (pipelines/page/write_clip_page.h)
  std::string reference;   ///< a known true track, drawn beside the estimate in the side view
  bool side_view = false;  ///< the overlay also shows a side view, in which depth errors are visible
  bool plan = false;       ///< only report which steps would run or be skipped, and why
};

/// Throws RequestError for contradictory or missing fields. Does not access files.
void CheckTrackRequest(const TrackRequest& request);
/// The same for the settings common to all requests.
void CheckTrackSettings(const TrackSettings& settings);

/// Returns true if people are detected in the video, as nothing else was given.
bool DetectsPeople(const TrackRequest& request);

/// Returns true if the detector also provides masks, which only BlazePose has.
bool DetectsMasks(const DetectionSettings& settings);

/// Returns true if 2D joints are derived from the part labels, as no other observations were given.
bool ReadsJointsOffLabels(const TrackRequest& request);

/// Weight of the straight-knees term, 1/rad, and that for BlazePose's joints, whose hips lie 4 cm lower than other
/// detectors'. Determined on AIST++ (docs/lab/world.md, docs/lab/pose_detector.md).
inline constexpr double kStraightKnees = 2, kBlazePoseStraightKnees = 3;

/// TrackSequenceOptions::straight_knees_weight for joints of that convention (KeypointSequence::convention).
double StraightKneesWeight(const TrackSettings& settings, const std::string& convention);

/// Camera knowledge given by `camera`, `cameras` and `focal_px`; `has_intrinsics`: another file has intrinsics.
CameraKnowledge CameraKnowledgeOf(const SceneRequest& request, bool has_intrinsics = false);

}  // namespace bodyloom
