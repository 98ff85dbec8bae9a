// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/estimates/gvhmr_reader.h"

#include <cmath>
#include <numeric>

#include "bodyloom/data_tools/body/mean_pelvis.h"
#include "bodyloom/data_tools/estimates/estimate_arrays.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/refuse.h"

namespace bodyloom {
namespace {

const NdArray& RequireTensor(const WeightsFile& file, const std::string& key, const std::string& where) {
  const auto found = file.tensors.find(key);
  if (found == file.tensors.end()) Refuse(where, "GVHMR: no tensor '" + key + "'");
  return found->second;
}

Camera CameraFromK(const Eigen::Ref<const Eigen::RowVectorXd>& k, const std::string& where, Eigen::Index row) {
  if (!(k[0] > 0) || !(k[4] > 0) || k[8] != 1 || k[1] != 0 || k[3] != 0) {
    Refuse(where, "K_fullimg", Concatenate("frame ", row, ": expected [fx 0 cx; 0 fy cy; 0 0 1]"));
  }
  Camera camera;
  camera.fx = k[0];
  camera.fy = k[4];
  camera.cx = k[2];
  camera.cy = k[5];
  // GVHMR's principal point is the middle of the image.
  camera.width = static_cast<int>(std::lround(std::min(2 * std::abs(k[2]), 1e6)));
  camera.height = static_cast<int>(std::lround(std::min(2 * std::abs(k[5]), 1e6)));
  return camera;
}

}  // namespace

bool IsGvhmr(const WeightsFile& file) { return file.tensors.count("smpl_params_incam.body_pose") > 0; }

BodyEstimate GvhmrFromTensors(const WeightsFile& file, const std::string& where) {
  BodyEstimate estimate;
  estimate.system = "GVHMR";
  estimate.body = "smplx";
  estimate.rest_pelvis = MeanPelvis(estimate.body);
  PersonEstimate& person = estimate.people.emplace_back();
  person.name = "0";
  const auto matrix = [&](const std::string& key, const std::vector<int64_t>& shape) {
    return RequireShape(RequireTensor(file, key, where), shape, where, key);
  };
  const RowMatrixXd body = matrix("smpl_params_incam.body_pose", {-1, 63});
  const int64_t n = body.rows();
  if (n >= kMostEstimateFrames) Refuse(where, "smpl_params_incam.body_pose", "too many frames");
  person.poses.setZero(n, 72);
  person.poses.leftCols<3>() = matrix("smpl_params_incam.global_orient", {n, 3});
  person.poses.middleCols<63>(3) = body;
  person.trans = matrix("smpl_params_incam.transl", {n, 3});
  person.betas = MeanBetas(RequireTensor(file, "smpl_params_incam.betas", where), n, where);
  const RowMatrixXd k = matrix("K_fullimg", {n, 3, 3});
  for (Eigen::Index i = 0; i < k.rows(); ++i) person.cameras.push_back(CameraFromK(k.row(i), where, i));
  person.frames.resize(static_cast<size_t>(n));
  std::iota(person.frames.begin(), person.frames.end(), 0);
  estimate.num_frames = static_cast<int>(n);
  SortEstimate(where, &estimate);
  return estimate;
}

}  // namespace bodyloom
