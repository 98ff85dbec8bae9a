// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/accuracy/lifter_oracle.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <array>

#include "data_tools/learned/lifter_weights_io.h"
#include "geometry/base/check.h"
#include "geometry/math/rotation.h"
#include "tracking/initialise/swap_repair.h"
#include "tracking/lifter/lifter_input.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::array<int, 4> kTorso = {kLifterLeftShoulder, kLifterLeftShoulder + 1, kLifterLeftHip,
                                       kLifterLeftHip + 1};

Eigen::RowVector3d MidHip(const MatrixX3d& points) {
  return 0.5 * (points.row(kLifterLeftHip) + points.row(kLifterLeftHip + 1));
}

/// argmin over rotations of Σ ‖to − R from‖² over shoulders and hips.
Matrix3d TurnTorso(const MatrixX3d& from, const MatrixX3d& to) {
  Matrix3d C = Matrix3d::Zero();
  for (const int k : kTorso) C += to.row(k).transpose() * (from.row(k) - MidHip(from));
  const Eigen::JacobiSVD<Matrix3d> svd(C, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3d D = Matrix3d::Identity();
  D(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return svd.matrixU() * D * svd.matrixV().transpose();
}

/// Mean torso + leg length of a clip.
double UnitOf(const std::vector<MatrixX3d>& truth) {
  double sum = 0;
  int count = 0;
  for (const MatrixX3d& joints : truth) {
    if (!joints.allFinite()) continue;
    std::vector<float> points(3 * kLifterPoints, 0);
    for (int k = 0; k < 17; ++k) {
      for (int c = 0; c < 3; ++c) points[3 * k + c] = static_cast<float>(joints(k, c));
    }
    sum += LifterReferenceLength(points);
    ++count;
  }
  return sum / std::max(1, count);
}

void Correct(const MatrixX3d& truth, const std::string& oracle, LiftedFrame* frame) {
  if (oracle == "truth") frame->points.topRows(17) = truth;
  if (oracle == "torso" || oracle == "lean") {
    Matrix3d R = TurnTorso(frame->points, truth);
    if (oracle == "lean") R = RotationFromAxisAngle(Vector3d(AxisAngleFromRotation(R).x(), 0, 0));
    frame->points = frame->points * R.transpose();
  }
  for (int limb = 0; limb < LifterOutput::kLimbs; ++limb) {
    const auto points = LifterOutput::LimbPoints(limb);
    if (oracle == "best") {
      const auto off = [&](const LiftedLimb& guess) {
        return (guess.points[0].transpose() - truth.row(points[0])).norm() +
               (guess.points[1].transpose() - truth.row(points[1])).norm();
      };
      SetLimb(limb,
              *std::min_element(frame->limbs[limb].begin(), frame->limbs[limb].end(),
                                [&](const LiftedLimb& a, const LiftedLimb& b) { return off(a) < off(b); }),
              frame);
    } else if (oracle == (limb < 2 ? "arms" : "legs")) {
      for (int i = 0; i < 2; ++i) frame->points.row(points[i]) = truth.row(points[i]);
    }
  }
}

}  // namespace

std::vector<LiftedFrame> LiftWithOracle(const KeypointSequence& keypoints, CameraKnowledge knowledge,
                                        const Camera& camera, const LifterWeights& weights,
                                        const std::vector<MatrixX3d>& truth, const std::string& oracle) {
  const std::array<std::string, 6> known = {"truth", "torso", "lean", "best", "arms", "legs"};
  BODYLOOM_CHECK(std::find(known.begin(), known.end(), oracle) != known.end(), "--oracle is '", oracle,
                 "', expected none, truth, torso, lean, best, arms or legs");
  KeypointSequence repaired = keypoints;
  RepairSwaps(&repaired);
  const bool focal_known = knowledge == CameraKnowledge::kKnown;
  const Camera seen_by =
      focal_known ? camera : MakePinhole(camera.width, camera.height, 0.9 * std::max(camera.width, camera.height));
  std::vector<LiftedFrame> frames =
      LiftKeypoints(repaired, seen_by, focal_known, FindCuts(repaired), weights, LiftOptions());
  const double unit = UnitOf(truth);
  for (size_t t = 0; t < std::min(frames.size(), truth.size()); ++t) {
    const MatrixX3d relative = (truth[t].rowwise() - MidHip(truth[t])) / unit;
    if (relative.allFinite()) Correct(relative, oracle, &frames[t]);
  }
  return frames;
}

const LifterWeights* LifterOf(const std::string& name) {
  if (name == "none") return nullptr;
  if (name == "built-in") return &BuiltinLifter();
  static const LifterWeights weights = ReadLifterWeights(name);
  return &weights;
}

}  // namespace bodyloom
