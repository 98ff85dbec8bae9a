// SPDX-License-Identifier: Apache-2.0
#include "tracking/problem/input_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "geometry/base/check.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/hands_and_face.h"
#include "tracking/problem/stature.h"

namespace bodyloom {
namespace {

constexpr double kMinBody_m = 0.3, kMaxBody_m = 10, kMaxDistance_m = 1000;
constexpr double kMinSize = 0.4, kMaxSize = 1.6;  // of the mean body
constexpr float kMinDenseSigma_px = 0.01F;

/// Farthest coordinate that a detection may have, pixels.
float Reach(int width, int height) {
  return width > 0 && height > 0 ? 10.0F * static_cast<float>(std::max(width, height)) : 1e6F;
}

bool IsWithin(float x, float reach) { return std::abs(x) <= reach; }  // false for NaN

template <typename Observations>
void CheckTimes(const Observations* observations, const char* what) {
  if (observations == nullptr) return;
  const std::vector<double>& times = observations->timestamps;
  BODYLOOM_CHECK(static_cast<int>(times.size()) == observations->num_frames(), "track: ", observations->num_frames(),
                 " frames of ", what, " but ", times.size(), " timestamps");
  for (size_t t = 0; t < times.size(); ++t) {
    BODYLOOM_CHECK(std::isfinite(times[t]), "track: timestamp ", t, " of the ", what, " is ", times[t],
                   ", expected seconds");
    BODYLOOM_CHECK(t == 0 || times[t] > times[t - 1], "track: timestamp ", t, " of the ", what, " is ", times[t],
                   " s after ", t == 0 ? 0 : times[t - 1], " s, expected strictly increasing ones");
  }
}

void CheckCamera(const Camera& camera) {
  for (const double f : {camera.fx, camera.fy}) {
    BODYLOOM_CHECK(f > 0 && std::isfinite(f), "track: the camera's focal length is ", f,
                   ", expected a positive number of pixels");
  }
  for (const double c : {camera.cx, camera.cy}) {
    BODYLOOM_CHECK(std::isfinite(c), "track: the camera's principal point is at ", c, ", expected pixels");
  }
  for (const double d : camera.distortion) {
    BODYLOOM_CHECK(std::isfinite(d), "track: a distortion coefficient of the camera is ", d);
  }
}

void CheckFocalPrior(const FocalPrior& prior) {
  BODYLOOM_CHECK(std::isfinite(prior.log_mean) && prior.log_sigma > 0 && std::isfinite(prior.log_sigma),
                 "track: the focal length's prior is ", std::exp(prior.log_mean), " px within ", prior.log_sigma,
                 " (standard deviation of its logarithm), expected positive numbers");
}

void CheckBody(const BodyModel& body) {
  const MatrixX3d& v = body.data().v_template;
  const double extent = (v.colwise().maxCoeff() - v.colwise().minCoeff()).maxCoeff();
  BODYLOOM_CHECK(extent >= kMinBody_m && extent <= kMaxBody_m, "track: the body '", body.name(), "' measures ", extent,
                 " from end to end, expected ", kMinBody_m, " to ", kMaxBody_m, " metres; convert it");
}

void CheckStature(const TrackSequenceInput& input) {
  TrackSequenceInput mean = input;
  mean.stature_m = 0;
  const double minimum = kMinSize * AssumedStature(mean), maximum = kMaxSize * AssumedStature(mean);
  BODYLOOM_CHECK(input.stature_m >= minimum && input.stature_m <= maximum, "track: the person's stature is ",
                 input.stature_m, ", expected metres, for the body '", input.body->name(), "' ", minimum, " to ",
                 maximum);
}

void CheckInitialiser(const Motion& start) {
  BODYLOOM_CHECK(start.trans.rows() == start.poses.rows(), "track: the initialiser has ", start.poses.rows(),
                 " poses and ", start.trans.rows(), " places");
  double distance = 0;
  int known = 0;
  for (int t = 0; t < start.num_frames(); ++t) {
    const bool missing = start.poses.row(t).array().isNaN().all() && start.trans.row(t).array().isNaN().all();
    BODYLOOM_CHECK(missing || start.HasPose(t), "track: frame ", t,
                   " of the initialiser holds a number that is not finite");
    if (missing) continue;
    distance += start.trans.row(t).norm();
    ++known;
  }
  BODYLOOM_CHECK(known > 0 || start.num_frames() == 0, "track: the initialiser has no pose in any frame");
  BODYLOOM_CHECK(start.betas.allFinite(), "track: the initialiser's betas hold a number that is not finite");
  distance /= std::max(known, 1);
  BODYLOOM_CHECK(distance <= kMaxDistance_m, "track: the initialiser's person is ", distance,
                 " from the camera, expected metres, at most ", kMaxDistance_m);
}

void CheckGround(const KnownGround& ground) {
  BODYLOOM_CHECK(std::abs(ground.up.norm() - 1) < 1e-6, "track: the ground's vertical has length ", ground.up.norm(),
                 ", expected a unit vector");
  BODYLOOM_CHECK(std::isfinite(ground.camera_height_m), "track: the camera's height above the ground is ",
                 ground.camera_height_m, ", expected metres");
}

void CheckCameraPath(const TrackSequenceInput& input, const TrackSequenceOptions& options, int num_frames) {
  const std::vector<CameraPose>& path = *input.camera_from_scene;
  BODYLOOM_CHECK(static_cast<int>(path.size()) == num_frames, "track: the camera's path has ", path.size(),
                 " poses, the detections ", num_frames, " frames");
  for (size_t t = 0; t < path.size(); ++t) {
    BODYLOOM_CHECK(
        path[t].camera_from_world_translation.allFinite() && IsRotation(path[t].camera_from_world_rotation, 1e-6),
        "track: pose ", t, " of the camera's path is no rotation and translation");
  }
  BODYLOOM_CHECK(input.camera_scale_m >= 0 && std::isfinite(input.camera_scale_m),
                 "track: the scale of the camera's path is ", input.camera_scale_m, ", expected metres a unit, or 0");
  BODYLOOM_CHECK(options.camera_knowledge != CameraKnowledge::kWeak,
                 "track: weak perspective has no place in a scene; give a camera that moves a focal length");
}

void CheckViews(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  BODYLOOM_CHECK(options.camera_knowledge != CameraKnowledge::kWeak || input.views->empty(),
                 "track: weak perspective has no place in a scene; give each of several views a focal length");
  for (size_t v = 0; v < input.views->size(); ++v) {
    const ViewInput& view = (*input.views)[v];
    const std::string which = "view " + std::to_string(v + 2);
    BODYLOOM_CHECK(view.keypoints != nullptr && view.keypoints->num_frames() > 0, "track: ", which,
                   " has no 2D joints");
    CheckTimes(view.keypoints, ("2D joints of " + which).c_str());
    BODYLOOM_CHECK(view.knowledge != CameraKnowledge::kWeak, "track: ", which,
                   " has weak perspective, which has no place in a scene; give it a focal length");
    BODYLOOM_CHECK(view.camera.width > 0 || view.keypoints->image_width > 0, "track: the image size of ", which,
                   " is not known");
    if (view.knowledge == CameraKnowledge::kKnown) CheckCamera(view.camera);
    BODYLOOM_CHECK(view.camera_from_own == nullptr ||
                       static_cast<int>(view.camera_from_own->size()) == view.keypoints->num_frames(),
                   "track: the camera's path of ", which, " has another number of frames than its 2D joints");
    BODYLOOM_CHECK(view.focal_ratio_log_sigma >= 0 && std::isfinite(view.focal_ratio_log_sigma),
                   "track: the focal length of ", which, " is as the first one's within ", view.focal_ratio_log_sigma,
                   ", expected a share, or 0");
    BODYLOOM_CHECK(view.camera_from_scene.camera_from_world_translation.allFinite() &&
                       IsRotation(view.camera_from_scene.camera_from_world_rotation, 1e-6),
                   "track: the pose of ", which, " is no rotation and translation");
    BODYLOOM_CHECK(std::isfinite(view.offset_s) && std::isfinite(view.rate) && view.offset_sigma_s > 0,
                   "track: the clock of ", which, " is ", view.offset_s, " s off within ", view.offset_sigma_s,
                   ", expected seconds");
  }
}

void CheckStart(const TrackSequenceInput& input, int num_frames) {
  const std::vector<FrameState>& states = input.start->states;
  BODYLOOM_CHECK(static_cast<int>(states.size()) == num_frames, "track: the start has ", states.size(),
                 " poses, the detections ", num_frames, " frames");
  for (size_t t = 0; t < states.size(); ++t) {
    BODYLOOM_CHECK(static_cast<int>(states[t].rotations.size()) == input.body->num_joints() && IsFinite(states[t]),
                   "track: pose ", t, " of the start is no pose of the body");
  }
}

bool IsUsable(const DenseKeypoint& point, float reach) {
  return IsWithin(point.pixel.x(), reach) && IsWithin(point.pixel.y(), reach) && point.sigma_px > 0 &&
         std::isfinite(point.sigma_px) && (point.barycentric.array() >= -1).all() &&
         (point.barycentric.array() <= 2).all();
}

void CheckDense(const TrackSequenceInput& input) {
  for (const auto& frame : input.dense->frames) {
    for (const DenseKeypoint& point : frame) {
      BODYLOOM_CHECK(point.face >= 0 && point.face < input.body->num_faces(), "track: a dense keypoint names face ",
                     point.face, ", the body '", input.body->name(), "' has ", input.body->num_faces());
    }
  }
}

void CheckPartLabels(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  const PartLabelSequence& labels = *input.part_labels;
  BODYLOOM_CHECK(static_cast<int>(labels.timestamps.size()) == labels.num_frames(), "track: ", labels.num_frames(),
                 " frames of part labels but ", labels.timestamps.size(), " timestamps");
  BODYLOOM_CHECK(labels.image_width > 0 && labels.image_height > 0,
                 "track: the part labels do not say how large their images are");
  const bool alone = input.keypoints == nullptr && input.dense == nullptr;
  BODYLOOM_CHECK(!alone || input.initialiser != nullptr,
                 "track: part labels refine a start; give 2D joints, dense keypoints or an initialiser with them");
  BODYLOOM_CHECK(!alone || options.camera_knowledge != CameraKnowledge::kWeak,
                 "track: weak perspective needs 2D joints or dense keypoints besides part labels");
  std::array<bool, 256> has_chart{};
  if (!input.body->has_parts()) has_chart[labels.part_of_chart[0]] = true;
  for (const uint8_t chart : input.body->data().face_part) has_chart[labels.part_of_chart[chart]] = true;
  has_chart[PartLabelSequence::kBackground] = has_chart[PartLabelSequence::kUnknown] = true;
  for (int t = 0; t < labels.num_frames(); ++t) {
    const LabelImage image = labels.frames[t].Unpacked();
    const size_t expected = size_t(std::max(image.width, 0)) * size_t(std::max(image.height, 0));
    BODYLOOM_CHECK(image.labels.size() == expected, "track: frame ", t, " holds ", image.labels.size(),
                   " part labels for ", image.width, "x", image.height, " pixels");
    BODYLOOM_CHECK(expected == 0 ||
                       (image.x_begin >= 0 && image.y_begin >= 0 && image.x_begin <= labels.image_width - image.width &&
                        image.y_begin <= labels.image_height - image.height),
                   "track: the part labels of frame ", t, " cover ", image.width, "x", image.height, " pixels from (",
                   image.x_begin, ", ", image.y_begin, "), outside the image of ", labels.image_width, "x",
                   labels.image_height);
    for (const uint8_t label : image.labels) {
      BODYLOOM_CHECK(has_chart[labels.part_of_label[label]], "track: frame ", t, " has pixels of label ", int{label},
                     " (part ", int{labels.part_of_label[label]}, "), which no chart of the body '", input.body->name(),
                     "' belongs to");
    }
  }
}

}  // namespace

ClipExtent ExtentOf(const TrackSequenceInput& input) {
  ClipExtent extent;
  const char* first = nullptr;
  const auto add = [&](const auto* observations, const char* what) {
    if (observations == nullptr) return;
    if (first == nullptr) {
      first = what;
      extent.frames = observations->num_frames();
      extent.timestamps = &observations->timestamps;
    }
    BODYLOOM_CHECK(observations->num_frames() == extent.frames, "track: ", extent.frames, " frames of ", first, " but ",
                   observations->num_frames(), " of ", what);
    const int w = observations->image_width, h = observations->image_height;
    if (w == 0) return;
    BODYLOOM_CHECK(extent.width == 0 || (extent.width == w && extent.height == h), "track: the ", what,
                   " are for images of ", w, "x", h, ", other observations for ", extent.width, "x", extent.height);
    extent.width = w;
    extent.height = h;
  };
  add(input.keypoints, "2D joints");
  add(input.dense, "dense keypoints");
  add(input.part_labels, "part labels");
  return extent;
}

void CheckInput(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "track: ", why);
  BODYLOOM_CHECK(input.body != nullptr, "track: no body");
  BODYLOOM_CHECK(input.keypoints != nullptr || input.dense != nullptr || input.part_labels != nullptr,
                 "track: neither 2D joints nor dense keypoints nor part labels; give at least one");
  for (const UserTerm& term : options.user_terms) CheckUserTerm(term, *input.body);
  const ClipExtent extent = ExtentOf(input);
  BODYLOOM_CHECK(extent.frames > 0, "track: the detections hold no frames");
  if (input.hands_and_face != nullptr) {
    BODYLOOM_CHECK(input.hands_and_face->num_frames() == extent.frames, "track: the hands and faces have ",
                   input.hands_and_face->num_frames(), " frames, the detections ", extent.frames);
  }
  if (input.initialiser != nullptr) {
    BODYLOOM_CHECK(input.initialiser->num_frames() == extent.frames, "track: the initialiser has ",
                   input.initialiser->num_frames(), " frames, the detections ", extent.frames);
  }
  if (input.dense != nullptr) CheckDense(input);
  if (input.part_labels != nullptr) CheckPartLabels(input, options);
  if (input.views != nullptr) CheckViews(input, options);
  if (input.start != nullptr) CheckStart(input, extent.frames);
  if (input.camera_from_scene != nullptr) CheckCameraPath(input, options, extent.frames);
  if (options.camera_knowledge == CameraKnowledge::kKnown) {
    BODYLOOM_CHECK(extent.width == 0 || input.camera.width == 0 ||
                       (extent.width == input.camera.width && extent.height == input.camera.height),
                   "track: the detections are for images of ", extent.width, "x", extent.height,
                   " but the camera is for ", input.camera.width, "x", input.camera.height);
  } else {
    BODYLOOM_CHECK(extent.width > 0 || input.camera.width > 0,
                   "track: the image size is not known; it is needed when the focal length is not");
  }
  BODYLOOM_CHECK(input.stature_m == 0 || options.estimate_shape, "track: a stature of ", input.stature_m,
                 " m is given, but the mean shape is to be kept");
  CheckNumbers(input, options);
}

void CheckNumbers(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  if (input.keypoints != nullptr) {
    const size_t expected = input.keypoints->timestamps.size() * input.keypoints->names.size();
    BODYLOOM_CHECK(input.keypoints->points.size() == expected, "track: ", input.keypoints->points.size(),
                   " 2D joints for ", input.keypoints->timestamps.size(), " frames of ", input.keypoints->names.size(),
                   " landmarks");
  }
  CheckTimes(input.keypoints, "2D joints");
  CheckTimes(input.dense, "dense keypoints");
  CheckTimes(input.part_labels, "part labels");
  if (options.camera_knowledge == CameraKnowledge::kKnown) CheckCamera(input.camera);
  if (input.focal_prior) CheckFocalPrior(*input.focal_prior);
  if (input.ground != nullptr) CheckGround(*input.ground);
  CheckBody(*input.body);
  if (input.stature_m != 0) CheckStature(input);
  if (input.initialiser != nullptr) CheckInitialiser(*input.initialiser);
}

void DropUnusable(KeypointSequence* keypoints) {
  const float reach = Reach(keypoints->image_width, keypoints->image_height);
  for (Keypoint& point : keypoints->points) {
    if (point.confidence > 0 && IsWithin(point.x, reach) && IsWithin(point.y, reach)) {
      point.confidence = std::min(point.confidence, 1.0F);
    } else {
      point = Keypoint();
    }
  }
}

bool HasUnusable(const DenseSequence& dense) {
  const float reach = Reach(dense.image_width, dense.image_height);
  return std::any_of(dense.frames.begin(), dense.frames.end(), [&](const std::vector<DenseKeypoint>& frame) {
    return std::any_of(frame.begin(), frame.end(), [&](const DenseKeypoint& point) {
      return !IsUsable(point, reach) || point.sigma_px < kMinDenseSigma_px;
    });
  });
}

void DropUnusable(DenseSequence* dense) {
  const float reach = Reach(dense->image_width, dense->image_height);
  for (std::vector<DenseKeypoint>& frame : dense->frames) {
    std::erase_if(frame, [&](const DenseKeypoint& point) { return !IsUsable(point, reach); });
    for (DenseKeypoint& point : frame) point.sigma_px = std::max(point.sigma_px, kMinDenseSigma_px);
  }
}

}  // namespace bodyloom
