// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/detected_people.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "data_tools/observations/frame_numbers.h"
#include "data_tools/observations/load_detections.h"
#include "pipelines/video/track_video.h"

namespace bodyloom {

ClipFrames WholeClip(const DetectedClip& clip) { return {0, int(clip.people.frames.size()) - 1}; }

ClipFrames SpanOf(const PersonTrack& person) {
  return {person.detections.front().first, person.detections.back().first};
}

DetectPeopleRequest DetectionOf(const TrackSettings& request, int max_people) {
  DetectPeopleRequest detect;
  detect.video = request.video;
  detect.span = {request.fps, request.from_s, request.to_s};
  detect.detector = request.detector;
  detect.detector.blazepose.masks = DetectsMasks(request);
  detect.detector.blazepose.max_people = max_people;
  detect.detect_rate = request.detect_rate;
  detect.keep_samples = request.use_lines;
  return detect;
}

DetectedClip DetectForTracking(const TrackSettings& request, const PipelineCallbacks& callbacks, int max_people) {
  callbacks.Begin("detecting people");
  return DetectPeople(DetectionOf(request, max_people), callbacks);
}

DetectedObservations ObservationsOf(const DetectedClip& clip, const PersonTrack& person, ClipFrames frames,
                                    const TrackSettings& request, const SceneInputs& scene) {
  // The camera has a size by now: that of its calibration, or the video's.
  const Camera& camera = scene.camera.camera;
  const Matrix2x3d map = VideoFromCameraPixels(scene.camera.video_px_from_camera_px, camera, clip.people.image_width,
                                               clip.people.image_height, request.video);
  const bool same_pixels = map.isApprox(NamedCamera().video_px_from_camera_px);
  DetectedObservations seen;
  seen.keypoints = CutFrames(KeypointsOf(clip.people, person), frames.first, frames.second);
  DropUnsure(request.min_confidence, &seen.keypoints);
  if (DetectsMasks(request)) seen.mask = CutFrames(MaskOfPerson(clip, person), frames.first, frames.second);
  if (same_pixels) return seen;
  seen.keypoints = MovedToCamera(std::move(seen.keypoints), map, camera.width, camera.height);
  if (seen.mask) seen.mask = MovedToCamera(*seen.mask, map, camera.width, camera.height);
  return seen;
}

namespace {

Matrix2x3d Inverse(const Matrix2x3d& map) {
  Matrix2x3d inverse;
  inverse.leftCols<2>() = map.leftCols<2>().inverse();
  inverse.col(2) = -inverse.leftCols<2>() * map.col(2);
  return inverse;
}

Eigen::Vector2d Apply(const Matrix2x3d& map, double x, double y) { return map * Eigen::Vector3d(x, y, 1); }

LabelImage Moved(const LabelImage& labels, const Matrix2x3d& video_from_camera, const Matrix2x3d& camera_from_video,
                 int width, int height) {
  LabelImage moved;
  if (labels.labels.empty()) return moved;
  Eigen::Array2d low(1e9, 1e9), high(-1e9, -1e9);
  for (const double x : {labels.x_begin - 0.5, labels.x_begin + labels.width - 0.5}) {
    for (const double y : {labels.y_begin - 0.5, labels.y_begin + labels.height - 0.5}) {
      const Eigen::Array2d corner = Apply(camera_from_video, x, y).array();
      low = low.min(corner);
      high = high.max(corner);
    }
  }
  const auto first = [](double v) { return std::max(0, int(std::floor(v))); };
  moved.x_begin = first(low.x());
  moved.y_begin = first(low.y());
  moved.width = std::min(width, int(std::ceil(high.x())) + 1) - moved.x_begin;
  moved.height = std::min(height, int(std::ceil(high.y())) + 1) - moved.y_begin;
  if (moved.width <= 0 || moved.height <= 0) return {};
  moved.labels.resize(size_t(moved.width) * moved.height);
  for (int y = 0; y < moved.height; ++y) {
    for (int x = 0; x < moved.width; ++x) {
      const Eigen::Vector2d at = Apply(video_from_camera, moved.x_begin + x, moved.y_begin + y);
      moved.labels[size_t(y) * moved.width + x] = labels.At(int(std::lround(at.x())), int(std::lround(at.y())));
    }
  }
  return moved;
}

}  // namespace

KeypointSequence MovedToCamera(KeypointSequence keypoints, const Matrix2x3d& video_from_camera, int camera_width,
                               int camera_height) {
  const Matrix2x3d camera_from_video = Inverse(video_from_camera);
  for (Keypoint& point : keypoints.points) {
    const Eigen::Vector2d moved = Apply(camera_from_video, point.x, point.y);
    point.x = float(moved.x());
    point.y = float(moved.y());
  }
  keypoints.image_width = camera_width;
  keypoints.image_height = camera_height;
  return keypoints;
}

PartLabelSequence MovedToCamera(const PartLabelSequence& labels, const Matrix2x3d& video_from_camera, int camera_width,
                                int camera_height) {
  const Matrix2x3d camera_from_video = Inverse(video_from_camera);
  PartLabelSequence moved = labels;
  for (PackedLabels& frame : moved.frames) {
    frame = Moved(frame.Unpacked(), video_from_camera, camera_from_video, camera_width, camera_height);
  }
  moved.image_width = camera_width;
  moved.image_height = camera_height;
  return moved;
}

}  // namespace bodyloom
