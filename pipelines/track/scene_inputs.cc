// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/scene_inputs.h"

#include <stdexcept>

#include "data_tools/body/builtin_body.h"
#include "data_tools/learned/lifter_weights_io.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/video/video_reader.h"
#include "geometry/base/check.h"
#include "pipelines/detect/detect_people.h"
#include "pipelines/files.h"
#include "pipelines/video/track_video.h"

namespace bodyloom {
namespace {

/// Standard deviation of log(focal length) around the lens' value, from rounding to millimetres and focusing; in videos
/// also from the crop of stabilisation.
constexpr double kLensLogSigma = 0.05, kSteadiedLogSigma = 0.1;

/// Camera file, focal length and image size as far as the request gives them.
NamedCamera CameraFromRequest(const SceneRequest& request, const std::string& detections) {
  NamedCamera camera;
  camera.camera.width = request.image_width;
  camera.camera.height = request.image_height;
  if (!request.cameras.empty()) {
    camera = FindCamera(LoadCameras(request.cameras, detections), request.view, request.cameras);
    if (request.image_width > 0 &&
        (camera.camera.width != request.image_width || camera.camera.height != request.image_height)) {
      throw std::runtime_error(Concatenate(request.cameras, ": camera ", camera.name, " is for images of ",
                                           camera.camera.width, "x", camera.camera.height, ", --image-size says ",
                                           request.image_width, "x", request.image_height));
    }
  }
  return camera;
}

/// The path of a camera that moves, and its intrinsics where nothing else gives any.
void UseCameraPath(const SceneRequest& request, SceneInputs* inputs) {
  if (!request.camera_path.empty()) inputs->camera_path = LoadCameraPath(request.camera_path);
  const bool given = !request.cameras.empty() || request.focal_px > 0 || request.camera == "unknown-focal";
  const bool uses = inputs->camera_path && inputs->camera_path->camera && !given;
  inputs->camera_knowledge = CameraKnowledgeOf(request, uses);
  if (uses) {
    inputs->camera.camera = *inputs->camera_path->camera;
    inputs->camera.name = request.camera_path;
  } else if (request.camera == "pinhole" && !given) {
    throw std::runtime_error(request.camera_path + ": " + inputs->camera_path->why_no_camera +
                             ", which --camera pinhole needs; give --cameras or --focal");
  }
}

/// Takes image size and frame rate from the video. `is_calibrated`: the camera's size is that of known intrinsics.
void UseVideo(const SceneRequest& request, bool is_calibrated, SceneInputs* inputs) {
  const int turn_deg = request.turn_deg.value_or(0);
  const VideoInfo info = VideoReader(request.video, turn_deg).info();
  inputs->video = info;
  inputs->playback = PlaybackOf(info, turn_deg, request.captured_fps);
  if (inputs->focal_35mm_mm == 0 && info.focal_35mm_mm > 0) {
    inputs->focal_35mm_mm = info.focal_35mm_mm;
    inputs->focal_35mm_log_sigma = info.fps > 0 ? kSteadiedLogSigma : kLensLogSigma;
  }
  Camera& camera = inputs->camera.camera;
  const bool is_stored = camera.width == info.stored_width && camera.height == info.stored_height;
  if (camera.width > 0 && is_calibrated && is_stored && info.IsAnamorphic()) {
    // In square pixels errors of detectors are alike along both axes. Distortion is of normalised coordinates.
    const Matrix2x3d square_from_stored = ScaleOfPixels({camera.width, camera.height}, {info.width, info.height});
    camera = CameraOfMappedPixels(camera, square_from_stored, info.width, info.height);
  } else if (camera.width == 0 || is_stored) {
    camera.width = info.width;
    camera.height = info.height;
  }
}

}  // namespace

TrackSequenceInput SceneInputs::ForTracker() const {
  TrackSequenceInput input;
  input.body = body.get();
  input.prior = prior ? &*prior : nullptr;
  input.lifter = lifter ? &*lifter : nullptr;
  input.camera = camera.camera;
  input.stature_m = stature_m;
  if (!background_points.empty()) input.background_points = &background_points;
  if (focal_35mm_mm > 0 && camera.camera.width > 0) {
    input.focal_prior =
        FocalPrior::ForLens(camera.camera.width, camera.camera.height, focal_35mm_mm, focal_35mm_log_sigma);
  }
  if (focal_of_motion) input.focal_prior = *focal_of_motion;
  return input;
}

void UseFocal(const SceneRequest& request, Camera* camera) {
  if (request.focal_px > 0) *camera = MakePinhole(camera->width, camera->height, request.focal_px);
}

std::vector<std::string> RequireFiles(const SceneRequest& request, const FrameDetectorOptions& detector) {
  const std::vector<std::pair<std::string, std::string>> named_inputs = {
      {request.cameras, "cameras"},
      {request.camera_path, "camera path"},
      {request.video, "video"},
      {request.prior == "none" ? "" : request.prior, "pose prior"},
      {request.lifter == "none" ? "" : request.lifter, "lifter"}};
  RequirePoseModels(detector);
  std::vector<std::string> inputs = {detector.pose_model, detector.box_model};
  for (const auto& [path, what] : named_inputs) {
    RequireReadable(path, what);
    inputs.push_back(path);
  }
  RequireReadableBody(request.body);
  inputs.push_back(request.body);
  return inputs;
}

SceneInputs LoadSceneInputs(const SceneRequest& request, const GivenInMemory& given, const std::string& detections,
                            bool needs_lifter) {
  SceneInputs inputs;
  inputs.body = given.body != nullptr ? given.body : BodyOrBuiltin(request.body);
  inputs.stature_m = request.stature_m;
  if (given.camera) {
    inputs.camera.camera = *given.camera;
  } else {
    inputs.camera = CameraFromRequest(request, detections);
  }
  if (request.focal_35mm_mm > 0) {
    inputs.focal_35mm_mm = request.focal_35mm_mm;
    inputs.focal_35mm_log_sigma = kLensLogSigma;
  }
  UseCameraPath(request, &inputs);
  if (!request.video.empty()) {
    const bool by_path = inputs.camera_path && inputs.camera.name == request.camera_path;
    const bool is_calibrated = given.camera || !request.cameras.empty() || by_path;
    UseVideo(request, is_calibrated, &inputs);
  }
  // The lifter knows how detectors err. Joints read off labels err otherwise, and it makes worse of them than the joint
  // hypotheses do (docs/lab/part_labels.md).
  if (request.lifter != "none" && (needs_lifter || !request.lifter.empty())) {
    inputs.lifter = request.lifter.empty() ? BuiltinLifter() : ReadLifterWeights(request.lifter);
  }
  if (request.prior != "none") {
    inputs.prior = request.prior.empty() ? BuiltinPosePrior() : ReadPosePrior(request.prior);
  }
  return inputs;
}

}  // namespace bodyloom
