// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/input_checks.h"

#include <algorithm>
#include <cmath>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr double kMinBody_m = 0.3, kMaxBody_m = 10, kMaxDistance_m = 1000;
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

void CheckBody(const BodyModel& body) {
  const MatrixX3d& v = body.data().v_template;
  const double extent = (v.colwise().maxCoeff() - v.colwise().minCoeff()).maxCoeff();
  BODYLOOM_CHECK(extent >= kMinBody_m && extent <= kMaxBody_m, "track: the body '", body.name(), "' measures ", extent,
                 " from end to end, expected ", kMinBody_m, " to ", kMaxBody_m, " metres; convert it");
}

void CheckInitialiser(const Motion& start) {
  for (int t = 0; t < start.num_frames(); ++t) {
    BODYLOOM_CHECK(start.HasPose(t), "track: frame ", t, " of the initialiser holds a number that is not finite");
  }
  BODYLOOM_CHECK(start.betas.allFinite(), "track: the initialiser's betas hold a number that is not finite");
  const double distance = start.num_frames() > 0 ? start.trans.rowwise().norm().mean() : 0;
  BODYLOOM_CHECK(distance <= kMaxDistance_m, "track: the initialiser's person is ", distance,
                 " from the camera, expected metres, at most ", kMaxDistance_m);
}

bool IsUsable(const DenseKeypoint& point, float reach) {
  return IsWithin(point.pixel.x(), reach) && IsWithin(point.pixel.y(), reach) && point.sigma_px > 0 &&
         std::isfinite(point.sigma_px) && (point.barycentric.array() >= -1).all() &&
         (point.barycentric.array() <= 2).all();
}

}  // namespace

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
  CheckBody(*input.body);
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
