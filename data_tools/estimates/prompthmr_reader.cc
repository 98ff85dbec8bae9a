// SPDX-License-Identifier: Apache-2.0
#include "data_tools/estimates/estimate_readers.h"

#include <cmath>

#include "data_tools/body/body_landmarks.h"
#include "data_tools/estimates/estimate_arrays.h"
#include "data_tools/formats/printable.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr int kSmplxBodyColumns = 66;

bool IsDict(const PickleValue* value) { return value != nullptr && value->kind == PickleValue::Kind::kDict; }

Camera LoadedFramesCamera(const PickleValue& camera, const std::string& where, int width, int height) {
  constexpr double kMaxOtherProportions = 0.01;
  const double focal = RequireCount(camera.Find("img_focal"), 1, where, "img_focal")[0];
  const Eigen::RowVectorXd centre = RequireCount(camera.Find("img_center"), 2, where, "img_center");
  if (!(focal > 0 && centre.minCoeff() > 0 && centre.maxCoeff() < 1e5)) {
    ThrowFileError(where, "camera", "expected a focal length above 0 px and a middle inside of an image");
  }
  const int loaded_width = int(std::lround(2 * centre[0])), loaded_height = int(std::lround(2 * centre[1]));
  const double scale = width > 0 && height > 0 ? height / (2 * centre[1]) : 1;
  const bool is_this_image = std::abs(scale * 2 * centre[0] / width - 1) < kMaxOtherProportions;
  return scale != 1 && is_this_image ? CentredCamera(width, height, scale * focal)
                                     : CentredCamera(loaded_width, loaded_height, focal);
}

/// n×72, the columns after SMPL-X's body 0.
RowMatrixXd PosesOf(const PickleValue& smplx, const std::string& place) {
  const PickleValue* pose = smplx.Find("pose");
  if (pose != nullptr && pose->kind == PickleValue::Kind::kArray) {
    const RowMatrixXd all = RequireShape(pose->array, {-1, -1}, place, "pose");
    if (all.cols() < kSmplxBodyColumns) {
      ThrowFileError(place, "pose", Concatenate(all.cols(), " columns, expected ", kSmplxBodyColumns, " or more"));
    }
    RowMatrixXd poses = RowMatrixXd::Zero(all.rows(), 72);
    poses.leftCols<kSmplxBodyColumns>() = all.leftCols<kSmplxBodyColumns>();
    return poses;
  }
  const RowMatrixXd matrices = RequireShape(RequireNumbers(smplx, "rotmat", place), {-1, 55, 3, 3}, place, "rotmat");
  RowMatrixXd poses = RowMatrixXd::Zero(matrices.rows(), 72);
  for (Eigen::Index t = 0; t < matrices.rows(); ++t) {
    for (Eigen::Index j = 0; j < kSmplxBodyColumns / 3; ++j) {
      poses.row(t).segment<3>(3 * j) =
          AxisAngleFromRows(matrices.row(t).segment<9>(9 * j), place, "rotmat").transpose();
    }
  }
  return poses;
}

}  // namespace

bool IsPromptHmr(const PickleValue& file) {
  const PickleValue* people = file.Find("people");
  const PickleValue* camera = file.Find("camera");
  return IsDict(people) && IsDict(camera) && camera->Find("img_focal") != nullptr;
}

BodyEstimate PromptHmrFromPickle(const PickleValue& file, const std::string& where, int image_width, int image_height) {
  BodyEstimate estimate;
  estimate.system = "PromptHMR";
  estimate.body = "smplx";
  estimate.rest_pelvis = MeanPelvis(estimate.body);
  const Camera camera = LoadedFramesCamera(*file.Find("camera"), where, image_width, image_height);
  for (const auto& [name, values] : file.Find("people")->dict) {
    const std::string place = where + ": person " + PrintableText(name);
    const PickleValue* smplx = values->Find("smplx_cam");
    if (!IsDict(smplx)) ThrowFileError(place, "smplx_cam", "expected a dictionary; was the pipeline interrupted?");
    PersonEstimate& person = estimate.people.emplace_back();
    person.name = name;
    person.poses = PosesOf(*smplx, place);
    const int64_t n = person.poses.rows();
    person.trans = RequireShape(RequireNumbers(*smplx, "trans", place), {n, 3}, place, "trans");
    person.betas = MeanBetas(RequireNumbers(*smplx, "shape", place), n, place);
    person.frames = RequireFrameNumbers(RequireNumbers(*values, "frames", place), n, place, "frames");
    person.cameras.assign(person.frames.size(), camera);
  }
  SortEstimate(where, &estimate);
  return estimate;
}

}  // namespace bodyloom
