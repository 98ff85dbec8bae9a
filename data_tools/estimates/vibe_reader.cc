// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/estimates/vibe_reader.h"

#include <cmath>

#include "bodyloom/data_tools/estimates/estimate_arrays.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/refuse.h"

namespace bodyloom {
namespace {

/// How far sx·W may be from sy·H before the image size cannot be VIBE's.
constexpr double kMostAspectError = 0.02;

Camera WeakCamera(const Eigen::Ref<const Eigen::RowVectorXd>& orig_cam, int width, int height, const std::string& place,
                  Eigen::Index row) {
  const double x_scale = 0.5 * width * orig_cam[0], y_scale = 0.5 * height * orig_cam[1];
  if (!(x_scale > 0) || !(y_scale > 0)) {
    Refuse(place, "orig_cam",
           Concatenate("row ", row, " has scales ", orig_cam[0], " and ", orig_cam[1], ", expected positive ones"));
  }
  if (std::abs(x_scale / y_scale - 1) > kMostAspectError) {
    Refuse(place, "orig_cam",
           Concatenate("made for images whose width is ", orig_cam[1] / orig_cam[0], " times their height, expected ",
                       width, "x", height));
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
    Refuse(where, "VIBE: its camera is in units of the image size, which is not known; give --video or --image-size");
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

}  // namespace bodyloom
