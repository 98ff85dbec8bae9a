// SPDX-License-Identifier: Apache-2.0
#include "data_tools/estimates/estimate_readers.h"

#include <cmath>

#include "data_tools/body/body_landmarks.h"
#include "data_tools/estimates/estimate_arrays.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

/// Tolerance of sx·W = sy·H, beyond which the image size cannot be VIBE's.
constexpr double kMaxAspectError = 0.02;

Camera WeakCamera(const Eigen::Ref<const Eigen::RowVectorXd>& orig_cam, int width, int height, const std::string& place,
                  Eigen::Index row) {
  const double x_scale = 0.5 * width * orig_cam[0], y_scale = 0.5 * height * orig_cam[1];
  if (!(x_scale > 0) || !(y_scale > 0)) {
    ThrowFileError(
        place, "orig_cam",
        Concatenate("row ", row, " has scales ", orig_cam[0], " and ", orig_cam[1], ", expected positive ones"));
  }
  if (std::abs(x_scale / y_scale - 1) > kMaxAspectError) {
    ThrowFileError(place, "orig_cam",
                   Concatenate("made for images whose width is ", orig_cam[1] / orig_cam[0],
                               " times their height, expected ", width, "x", height));
  }
  Camera camera;
  camera.model = CameraModel::kWeakPerspective;
  camera.width = width;
  camera.height = height;
  camera.cx = 0.5 * width;
  camera.cy = 0.5 * height;
  camera.scale = std::sqrt(x_scale * y_scale);
  camera.tx = orig_cam[2];
  camera.ty = orig_cam[3];
  return camera;
}

}  // namespace

bool IsVibe(const PickleValue& file) {
  if (file.dict.empty()) return false;
  const PickleValue& person = *file.dict.front().second;
  return person.Find("pose") != nullptr && person.Find("orig_cam") != nullptr && person.Find("frame_ids") != nullptr;
}

BodyEstimate VibeFromPickle(const PickleValue& file, const std::string& where, int image_width, int image_height) {
  if (image_width <= 0 || image_height <= 0) {
    ThrowFileError(where,
                   "VIBE: its camera is in units of the image size, which is not known; give --video or --image-size");
  }
  return SmplPeople(
      file, where, "VIBE", [&](const PickleValue& values, const std::string& place, PersonEstimate* person) {
        const RowMatrixXd cameras =
            RequireShape(RequireNumbers(values, "orig_cam", place), {person->poses.rows(), 4}, place, "orig_cam");
        for (Eigen::Index i = 0; i < cameras.rows(); ++i) {
          person->cameras.push_back(WeakCamera(cameras.row(i), image_width, image_height, place, i));
        }
      });
}

bool IsWham(const PickleValue& file) {
  if (file.dict.empty()) return false;
  const PickleValue& person = *file.dict.front().second;
  return person.Find("pose") != nullptr && person.Find("trans") != nullptr && person.Find("frame_ids") != nullptr;
}

BodyEstimate WhamFromPickle(const PickleValue& file, const std::string& where, int image_width, int image_height) {
  if (image_width <= 0 || image_height <= 0) {
    ThrowFileError(where,
                   "WHAM: its camera follows from the image size, which is not known; give --video or --image-size");
  }
  const Camera camera = CentredCamera(image_width, image_height, std::hypot(image_width, image_height));
  return SmplPeople(
      file, where, "WHAM", [&](const PickleValue& values, const std::string& place, PersonEstimate* person) {
        person->trans = RequireShape(RequireNumbers(values, "trans", place), {person->poses.rows(), 3}, place, "trans");
        person->cameras.assign(person->frames.size(), camera);
      });
}

bool IsGvhmr(const WeightsFile& file) { return file.tensors.count("smpl_params_incam.body_pose") > 0; }

BodyEstimate GvhmrFromTensors(const WeightsFile& file, const std::string& where) {
  BodyEstimate estimate;
  estimate.system = "GVHMR";
  estimate.body = "smplx";
  estimate.rest_pelvis = MeanPelvis(estimate.body);
  PersonEstimate& person = estimate.people.emplace_back();
  const std::string prefix = "smpl_params_incam.";
  const RowMatrixXd body =
      RequireShape(RequireTensor(file, prefix + "body_pose", where), {-1, 63}, where, prefix + "body_pose");
  const int64_t n = body.rows();
  if (n >= kMaxEstimateFrames) ThrowFileError(where, prefix + "body_pose", "too many frames");
  SetInCameraMotion(file, prefix, n, where, &person);
  person.poses.middleCols<63>(3) = body;
  person.betas = MeanBetas(RequireTensor(file, prefix + "betas", where), n, where);
  estimate.num_frames = static_cast<int>(n);
  SortEstimate(where, &estimate);
  return estimate;
}

}  // namespace bodyloom
