// SPDX-License-Identifier: Apache-2.0
#include "data_tools/estimates/sam3d_body_reader.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <regex>
#include <utility>

#include "data_tools/estimates/estimate_arrays.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/observations/frame_numbers.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;

/// COCO's 17, big toes and heels among MHR's 70.
constexpr std::array<int, 21> kMhrOfLandmark = {0, 1,  2,  3,  4,  5,  6,  7,  8,  62, 41,
                                                9, 10, 11, 12, 13, 14, 15, 18, 17, 20};
constexpr int kLeftHip = 11;
constexpr double kMaxResidual_px = 1;

/// x = f X/Z + cx, y = f Y/Z + cy by least squares.
Camera CameraOf(const RowMatrixXd& points, const RowMatrixXd& pixels, const std::string& where) {
  const Eigen::Index n = points.rows();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n, 3);
  Eigen::VectorXd b(2 * n);
  for (Eigen::Index k = 0; k < n; ++k) {
    if (!(points(k, 2) > Camera::kMinDepth)) ThrowFileError(where, "pred_cam_t", "a landmark behind the camera");
    for (int c = 0; c < 2; ++c) {
      A(2 * k + c, 0) = points(k, c) / points(k, 2);
      A(2 * k + c, 1 + c) = 1;
      b[2 * k + c] = pixels(k, c);
    }
  }
  const Eigen::VectorXd solution = A.colPivHouseholderQr().solve(b);
  const double worst = (A * solution - b).cwiseAbs().maxCoeff();
  if (!solution.allFinite() || !(solution[0] > 0) || !(worst < kMaxResidual_px)) {
    ThrowFileError(where, "pred_keypoints_2d",
                   Concatenate("is up to ", worst,
                               " px off a projection of pred_keypoints_3d + pred_cam_t, expected the same "
                               "person in one pinhole camera"));
  }
  Camera camera;
  camera.fx = camera.fy = solution[0];
  camera.cx = solution[1];
  camera.cy = solution[2];
  // The principal point is the middle of the image.
  camera.width = static_cast<int>(std::lround(std::clamp(2 * camera.cx, 0.0, 1e6)));
  camera.height = static_cast<int>(std::lround(std::clamp(2 * camera.cy, 0.0, 1e6)));
  return camera;
}

/// One image's person, appended as that frame.
void Append(const NpzArrays& arrays, const std::string& where, int frame, PersonEstimate* person) {
  const auto matrix = [&](const char* key, const std::vector<int64_t>& shape) {
    return RequireShape(RequireArray(arrays, key, where), shape, where, key);
  };
  RowMatrixXd points = matrix("pred_keypoints_3d", {70, 3});
  const RowMatrixXd pixels = matrix("pred_keypoints_2d", {70, 2}), place = matrix("pred_cam_t", {3});
  points.rowwise() += Eigen::RowVector3d(place(0), place(1), place(2));
  MatrixX3d landmarks(static_cast<Eigen::Index>(kMhrOfLandmark.size()), 3);
  for (Eigen::Index k = 0; k < landmarks.rows(); ++k) {
    landmarks.row(k) = points.row(kMhrOfLandmark[static_cast<size_t>(k)]);
  }
  const Eigen::RowVector3d hips = 0.5 * (landmarks.row(kLeftHip) + landmarks.row(kLeftHip + 1));
  person->cameras.push_back(CameraOf(points, pixels, where));
  person->frames.push_back(frame);
  person->landmarks.emplace_back(landmarks.rowwise() - hips);
  person->trans.conservativeResize(person->trans.rows() + 1, Eigen::NoChange);
  person->trans.bottomRows<1>() = hips;
  person->poses.resize(person->trans.rows(), 0);
}

BodyEstimate Empty() {
  BodyEstimate estimate;
  estimate.system = "SAM 3D Body";
  estimate.body = "mhr";
  estimate.has_landmarks = true;
  return estimate;
}

}  // namespace

bool IsSam3dBody(const NpzArrays& arrays) {
  return arrays.count("pred_keypoints_3d") > 0 && arrays.count("pred_cam_t") > 0;
}

BodyEstimate Sam3dBodyFromNpz(const NpzArrays& arrays, const std::string& where) {
  BodyEstimate estimate = Empty();
  estimate.people.emplace_back().name = "0";
  Append(arrays, where, 0, &estimate.people[0]);
  return estimate;
}

BodyEstimate ReadSam3dBodyFolder(const std::string& folder) {
  static const std::regex person_ending("_(?:subj|person|p)([0-9]{1,6})$");
  std::map<std::string, PersonEstimate> people;
  for (const std::string& path : FilesBelow(folder)) {
    if (!path.ends_with(".npz")) continue;
    const NpzArrays arrays = ReadNpz(path);
    if (!IsSam3dBody(arrays)) continue;
    std::string stem = fs::path(path).stem().string(), person = "0";
    if (std::smatch match; std::regex_search(stem, match, person_ending)) {
      person = match[1].str();
      stem = std::string(match.prefix());
    }
    const int64_t frame = FrameNumberFromName(stem);
    if (frame >= kMaxEstimateFrames) ThrowFileError(path, "the number of its frame is too large");
    people[person].name = person;
    Append(arrays, path, static_cast<int>(std::max<int64_t>(frame, 0)), &people[person]);
  }
  BodyEstimate estimate = Empty();
  for (auto& [name, person] : people) estimate.people.push_back(std::move(person));
  SortEstimate(folder, &estimate);
  return estimate;
}

}  // namespace bodyloom
