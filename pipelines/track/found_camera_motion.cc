// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/found_camera_motion.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "data_tools/export/camera_writers.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/observations/load_camera_path.h"
#include "data_tools/video/image_file.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/base/percentile.h"
#include "geometry/base/units.h"
#include "pipelines/detect/detect_people.h"
#include "pipelines/video/track_video.h"
#include "tracking/camera_motion/camera_motion.h"
#include "tracking/detection/background_tracker.h"

namespace bodyloom {
namespace {

/// Least σ of log f taken from the background: a lens' distortion and the picture's centre are not modelled.
constexpr double kLeastFocalSigma = 0.02;

/// Pixels of the video a pixel of the camera; 0: the video is not a scaled copy of the camera's image.
double VideoScale(const SceneRequest& request, const SceneInputs& scene) {
  try {
    return VideoFromCameraPixels(scene.camera.video_px_from_camera_px, scene.camera.camera, scene.video, request.video)(
        0, 0);
  } catch (const std::runtime_error&) {
    return 0;
  }
}

/// COLMAP's text model: the images' names have the numbers of the video's frames, and the camera is the video's.
void WriteColmapPath(const std::string& images_file, const BackgroundTracks& background, const CameraMotion& motion) {
  const Camera camera = MakePinhole(background.width, background.height, std::exp(motion.log_focal));
  std::string images = ColmapImagesHeading(), points = ColmapPointsHeading();
  for (size_t i = 0; i < motion.path.poses.size(); ++i) {
    const auto at =
        std::lower_bound(background.timestamps.begin(), background.timestamps.end(), motion.path.timestamps[i]);
    const auto frame = static_cast<int>(at - background.timestamps.begin());
    images += ColmapImageLine(i + 1, motion.path.poses[i], 1, FrameFile("", frame));
  }
  for (size_t i = 0; i < motion.points.size(); ++i) {
    const Eigen::Vector3d& at = motion.points[i];
    points += Concatenate(i + 1, " ", at.x(), " ", at.y(), " ", at.z(), " 128 128 128 0\n");
  }
  const std::filesystem::path folder = std::filesystem::path(images_file).parent_path();
  WriteFileAtomically((folder / "cameras.txt").string(), ColmapCamerasHeading() + ColmapCameraLine(1, camera));
  WriteFileAtomically((folder / "points3D.txt").string(), points);
  WriteFileAtomically(images_file, images);
}

}  // namespace

std::string WhyNoCameraMotion(const SceneRequest& request) {
  if (request.video.empty()) return "no video";
  if (!request.find_camera_motion) return "switched off";
  if (!request.camera_path.empty()) return "its path is given";
  if (request.camera == "weak") return "weak perspective has no place in a scene";
  return "";
}

BackgroundTracks BackgroundOfVideo(const TrackRequest& request, const KeypointSequence* keypoints,
                                   const SceneInputs& scene) {
  const FrameSpan span{request.fps, request.from_s, request.to_s, scene.playback.turn_deg, request.captured_fps};
  FrameSource source(request.video, span);
  const double offset_s = request.video_offset / source.fps();
  const Matrix2x3d map =
      VideoFromCameraPixels(scene.camera.video_px_from_camera_px, scene.camera.camera, source.info(), request.video);
  BackgroundTracker tracker;
  Image frame;
  double time_s = 0;
  while (source.Read(&frame, &time_s)) {
    const double at = time_s - offset_s;
    std::vector<CoveredRegion> covered;
    if (keypoints != nullptr && keypoints->num_frames() > 0) {
      const std::vector<double>& stamps = keypoints->timestamps;
      const auto after = std::lower_bound(stamps.begin(), stamps.end(), at);
      const auto nearest = std::min<std::ptrdiff_t>(after - stamps.begin(), std::ptrdiff_t(stamps.size()) - 1);
      const size_t joints = keypoints->names.size();
      const std::span<const Keypoint> points(keypoints->points.data() + size_t(nearest) * joints, joints);
      covered.push_back(CoveredByPoints(points, map));
    }
    tracker.Push(frame, at, covered);
  }
  return tracker.Finish();
}

void UseCameraMotion(const TrackSettings& request, const BackgroundTracks& background,
                     const PipelineCallbacks& callbacks, SceneInputs* scene, CameraPathReport* report) {
  const double video_scale = VideoScale(request, *scene);
  CameraMotionOptions options;
  options.num_threads = ThreadsFor(request.solve.num_threads);
  const Camera& camera = scene->camera.camera;
  options.focal_known = scene->camera_knowledge == CameraKnowledge::kKnown && video_scale > 0;
  options.focal = options.focal_known
                      ? FocalPrior{.log_mean = std::log(camera.fx * video_scale)}
                      : scene->ForTracker().focal_prior.value_or(FocalPrior::ForImage(camera.width, camera.height));
  const CameraMotion motion = FindCameraMotion(background, options);
  report->motion = ToString(motion.kind) + ": " + motion.why;
  report->is_still = motion.kind == CameraMotionKind::kStill;
  const bool zooms = motion.zoom > 1;
  if ((motion.kind == CameraMotionKind::kMoving && !motion.has_path()) || zooms) {
    callbacks.Message("the camera " + std::string(zooms ? "zooms" : "moves") + ": " + motion.why +
                      "; give its path with --camera-path, without it places and speeds are the camera's too");
  }
  if (!motion.has_path()) return;
  const bool goes = motion.kind == CameraMotionKind::kMoving;
  RecordedCameraPath path;
  path.poses = motion.path.poses;
  path.seconds = motion.path.timestamps;
  path.is_metric = !goes;
  if (LowerExtension(request.camera_path_out) == ".txt") {
    WriteColmapPath(request.camera_path_out, background, motion);
  } else if (!request.camera_path_out.empty()) {
    WriteCameraPath(request.camera_path_out, motion.path, path.is_metric);
  }
  if (zooms) return;
  scene->camera_path = std::move(path);
  scene->background_points = motion.points;
  report->found = true;
  report->goes = goes;
  report->turned_deg = motion.turned_deg;
  report->sigma_deg = *std::max_element(motion.of_frames.rad.begin(), motion.of_frames.rad.end()) / kDegree;
  report->background_points = static_cast<int>(motion.points.size());
  if (goes) report->sigma_place = Percentile(motion.of_frames.place, 50) / motion.extent;
  if (scene->camera_knowledge == CameraKnowledge::kUnknownFocal) {
    scene->focal_of_motion =
        FocalPrior{.log_mean = motion.log_focal, .log_sigma = std::max(kLeastFocalSigma, motion.log_focal_sigma)};
  }
}

}  // namespace bodyloom
