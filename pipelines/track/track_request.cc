// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/track_request.h"

#include <filesystem>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/observations/keypoint_conventions.h"
#include "geometry/base/callbacks.h"
#include "geometry/base/check.h"

namespace bodyloom {

CameraKnowledge CameraKnowledgeOf(const SceneRequest& request, bool has_intrinsics) {
  if (request.camera == "weak") {
    return CameraKnowledge::kWeak;
  }
  has_intrinsics = has_intrinsics || !request.cameras.empty() || request.focal_px > 0;
  return request.camera == "pinhole" || (request.camera.empty() && has_intrinsics) ? CameraKnowledge::kKnown
                                                                                   : CameraKnowledge::kUnknownFocal;
}

double StraightKneesWeight(const TrackSettings& settings, const std::string& convention) {
  return settings.straight_knees.value_or(convention == MediaPipe33().name ? kBlazePoseStraightKnees : kStraightKnees);
}

bool DetectsPeople(const TrackRequest& request) {
  return request.detections.empty() && request.dense.empty() && request.part_labels.empty() && !request.video.empty();
}

bool DetectsMasks(const DetectionSettings& settings) {
  return settings.use_mask && settings.detector.pose_model.empty();
}

bool ReadsJointsOffLabels(const TrackRequest& request) {
  return request.detections.empty() && request.dense.empty() && !request.part_labels.empty();
}

void CheckTrackSettings(const TrackSettings& request) {
  if (request.turn_deg && *request.turn_deg != 0 && *request.turn_deg != 90 && *request.turn_deg != 180 &&
      *request.turn_deg != 270) {
    throw RequestError(Concatenate("--rotate ", *request.turn_deg, ": expected 90, 180, 270 or auto"));
  }
  if (request.video.empty() && (request.turn_deg != 0 || request.captured_fps > 0)) {
    throw RequestError("--rotate and --captured-fps are of a video: give --video");
  }
  if (request.camera == "pinhole" && request.cameras.empty() && request.focal_px == 0 && request.camera_path.empty()) {
    throw RequestError("--camera pinhole needs the intrinsics: give --cameras FILE or --focal PIXELS");
  }
  const std::filesystem::path path_out(request.camera_path_out);
  if (LowerExtension(request.camera_path_out) == ".txt" && path_out.filename() != "images.txt") {
    throw RequestError("--camera-path-out " + request.camera_path_out +
                       ": COLMAP's text is written as images.txt, with cameras.txt and points3D.txt beside it");
  }
  if (!request.camera_path_out.empty() &&
      (request.video.empty() || !request.find_camera_motion || !request.camera_path.empty())) {
    throw RequestError(
        "--camera-path-out writes the path that is found in the video: leave out --still and --camera-path");
  }
  if (request.camera_path.empty() &&
      (request.camera_scale_m > 0 || request.camera_path_first >= 0 || request.camera_path_fps > 0)) {
    throw RequestError("--camera-scale, --camera-path-first and --camera-path-fps are of a path: give --camera-path");
  }
  if (!request.camera_path.empty() && request.camera == "weak") {
    throw RequestError("weak perspective has no place in a scene: leave out --camera weak or --camera-path");
  }
  if (request.focal_35mm_mm > 0 && (!request.cameras.empty() || request.focal_px > 0 || request.camera == "weak")) {
    throw RequestError(
        "--focal-35mm is where to look for a focal length that is estimated: leave it out beside --cameras, "
        "--focal and --camera weak");
  }
  if (!request.cameras.empty() && request.focal_px > 0) {
    throw RequestError("--cameras and --focal both give the focal length, expected one of them");
  }
  if (request.stature_m > 0 && !request.solve.estimate_shape) {
    throw RequestError("--stature changes the shape that --no-shape keeps, expected one of them");
  }
}

void CheckTrackRequest(const TrackRequest& request) {
  if (request.detections.empty() && request.dense.empty() && request.part_labels.empty() && request.video.empty()) {
    throw RequestError("--video is required (or --detections, --dense or --part-labels)");
  }
  if (request.plan && DetectsPeople(request)) {
    throw RequestError("--plan needs detections: what runs depends on them (bodyloom detect makes them)");
  }
  if (!request.turn_deg && !DetectsPeople(request)) {
    throw RequestError("--rotate auto asks the detector, and the detections are given: say --rotate 90, 180 or 270");
  }
  if (!request.detector.pose_model.empty() && !DetectsPeople(request)) {
    throw RequestError("--pose-model detects people in a video: leave out the detections");
  }
  if (request.dense_uv_sigma && request.dense.empty() && !request.detections.ends_with(".npz")) {
    throw RequestError("--dense-uv-sigma is the noise of dense keypoints: give --dense");
  }
  if (request.out.empty() && !request.plan) {
    throw RequestError("--out is required (or --plan, to see what would be done)");
  }
  CheckTrackSettings(request);
  if (!request.camera_path.empty() && request.live_lag) {
    throw RequestError("--live is for a camera that stands still: leave out --camera-path or --live");
  }
  if (request.detector.hands_and_faces.value_or(HandsAndFaceChoice::kOff) != HandsAndFaceChoice::kOff &&
      request.live_lag) {
    throw RequestError("--live follows neither hands nor faces: leave out --hands or --live");
  }
  if (request.stature_m > 0 && request.live_lag) {
    throw RequestError("--live does not use --stature: leave it out");
  }
  if (!request.overlay.empty() && !request.overlay.ends_with(".mp4")) {
    throw RequestError("--overlay " + request.overlay + ": expected a name that ends in .mp4");
  }
  if (request.solve.velocity_weight > 0 && request.live_lag) {
    throw RequestError("--live does not use --velocity-weight: leave it out");
  }
  if (request.live_lag && request.solve.solver == SequenceSolver::kCeres) {
    throw RequestError("--live runs on the chain solver: leave out --solver " + ToString(request.solve.solver));
  }
  if (request.live_lag && ReadsJointsOffLabels(request)) {
    throw RequestError("--live does not use part labels: give --detections or --dense");
  }
  if (request.side_view && request.overlay.empty()) {
    throw RequestError("--side-view is a part of the overlay: give --overlay FILE");
  }
  if (!request.reference.empty() && !request.side_view) {
    throw RequestError("--reference is drawn in the side view: give --side-view");
  }
}

}  // namespace bodyloom
