// SPDX-License-Identifier: Apache-2.0
/// Requests for tracks: files by name (empty: not given), what is known besides, and what is to be written. Each job
/// takes the parts that it needs.
#pragma once

#include <optional>
#include <string>

#include "tracking/detection/frame_detector.h"
#include "tracking/problem/track_options.h"

namespace bodyloom {

/// The scene, whoever is in it: body model, camera, and what was learned.
struct SceneRequest {
  std::string video;     ///< for the image size, the frame rate and the overlay; alone: people are detected in it
  std::string body;      ///< body model; empty: the built-in one
  std::string prior;     ///< pose prior; empty: the built-in one; "none"
  std::string lifter;    ///< weights of the network that starts from 2D joints; empty: built in; "none"
  double stature_m = 0;  ///< of the person; 0: the mean body's

  std::string cameras;  ///< calibration file or folder
  std::string view;     ///< camera of a file that has several
  std::string camera;   ///< pinhole, unknown-focal or weak; empty: pinhole when intrinsics are given
  double focal_px = 0;  ///< intrinsics without a file: centred, undistorted
  /// The lens' focal length for film of 36 mm × 24 mm, where it is estimated; 0: what the video or photo says of it.
  double focal_35mm_mm = 0;
  std::string camera_path;     ///< where a camera that moves was (load_camera_path.h); empty: it stands still
  double camera_scale_m = 0;   ///< metres a unit of the path; 0: the file's, else found from the person
  int camera_path_first = -1;  ///< number of the clip's first frame in the path's (PlaceInTime)
  double camera_path_fps = 0;  ///< frames a second of the path's numbered frames; 0: they are the clip's
  int image_width = 0, image_height = 0;  ///< when neither camera, video nor detections give it
};

/// Detection of people in a video (pipelines/detect/detect_people.h).
struct DetectionSettings {
  FrameDetectorOptions detector;  ///< its masks and max_people are not used
  double detect_rate = 0;         ///< frames a second that are detected on slow motion; 0: all
  bool use_mask = true;           ///< the person's mask becomes the silhouette term
  double from_s = 0, to_s = -1;   ///< the part of the video, seconds; to_s < 0: to the end
  double fps = 0;                 ///< of frames without times; 0: the video's, else 30
  double min_confidence = 0;      ///< landmarks below count as missing
};

/// Common to the track of one person and to those of everybody in a video.
struct TrackSettings : SceneRequest, DetectionSettings {
  TrackSequenceOptions solve;            ///< its straight_knees_weight is StraightKneesWeight()
  std::optional<double> straight_knees;  ///< 1/rad; none: kBlazePoseStraightKnees for BlazePose's joints, else 0
};

/// One person's track. People are detected in the video where nothing else was seen.
struct TrackRequest : TrackSettings {
  // What was seen.
  std::string detections;                ///< 2D joints (and dense keypoints, when the file holds both)
  std::string dense;                     ///< dense surface keypoints from a file or folder of their own
  std::optional<double> dense_uv_sigma;  ///< their noise on the surface, chart units; none: their source's
  std::string part_labels;               ///< DensePose part of every pixel
  int person = 0;                        ///< 0: the largest and longest in view
  std::string convention;                ///< OpenPose model, when it should not be detected
  int video_offset = 0;                  ///< video frame of the detections' time zero
  std::string init;                      ///< poses of another system to start from and stay near, same frames
  std::optional<int> live_lag;  ///< frames; track as if the clip came from a camera (tracking/live/live_tracker.h)

  // What is wanted.
  std::string out;         ///< the track, .npz; may be empty when only the plan is wanted
  std::string overlay;     ///< video of the projected body, .mp4
  std::string json;        ///< ToJson(TrackReport)
  std::string report;      ///< the clip's page, .html (pipelines/page/write_clip_page.h)
  std::string reference;   ///< a known true track, drawn beside the estimate in the side view
  bool side_view = false;  ///< the overlay also shows the body from its side, where depth errors show
  bool plan = false;       ///< only find out what would run, what is skipped and why
};

/// Throws RequestError when fields contradict each other or one is missing. Looks at no file.
void CheckTrackRequest(const TrackRequest& request);
/// The same for what requests have in common.
void CheckTrackSettings(const TrackSettings& settings);

/// Whether people are to be detected in the video: it is all that was given.
bool DetectsPeople(const TrackRequest& request);

/// Whether the detector is to give the people's masks too: BlazePose alone has them.
bool DetectsMasks(const DetectionSettings& settings);

/// Whether 2D joints are to be read off the part labels: they are all that was seen.
bool ReadsJointsOffLabels(const TrackRequest& request);

/// Weight of straight knees for BlazePose's joints, 1/rad, whose hips lie 4 cm lower than other detectors'. Found on
/// AIST++ (docs/lab/pose_detector.md).
inline constexpr double kBlazePoseStraightKnees = 3;

/// TrackSequenceOptions::straight_knees_weight for joints of that convention (KeypointSequence::convention).
double StraightKneesWeight(const TrackSettings& settings, const std::string& convention);

/// What `camera`, `cameras` and `focal_px` amount to; `has_intrinsics`: another file has them too.
CameraKnowledge CameraKnowledgeOf(const SceneRequest& request, bool has_intrinsics = false);

}  // namespace bodyloom
