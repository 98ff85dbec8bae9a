// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/initialise/given_landmarks.h"

#include <span>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/tracking/initialise/lifter_input.h"

namespace bodyloom {
namespace {

double ReferenceLength(const MatrixX3d& points) {
  std::vector<float> values;
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    for (int c = 0; c < 3; ++c) values.push_back(static_cast<float>(points(k, c)));
  }
  return LifterReferenceLength(values);
}

}  // namespace

void TakeGivenLandmarks(const std::vector<MatrixX3d>& points, const GivenLandmarkSigma& sigma,
                        std::vector<LiftedFrame>* frames) {
  BODYLOOM_CHECK(points.size() == frames->size(), "given landmarks: ", points.size(), " frames, expected ",
                 frames->size());
  for (size_t t = 0; t < points.size(); ++t) {
    if (points[t].rows() == 0) continue;
    BODYLOOM_CHECK(points[t].rows() == kLifterPoints && points[t].allFinite(), "given landmarks: frame ", t, " has ",
                   points[t].rows(), " points, expected ", kLifterPoints, " finite ones");
    const double length = ReferenceLength(points[t]);
    BODYLOOM_CHECK(length > 0.1, "given landmarks: frame ", t, ": torso and leg measure ", length, " m");
    const Eigen::RowVector3d hips = 0.5 * (points[t].row(kLifterLeftHip) + points[t].row(kLifterLeftHip + 1));
    LiftedFrame& frame = (*frames)[t];
    frame.seen = true;
    frame.camera_from_virtual.setIdentity();
    frame.points = (points[t].rowwise() - hips) / length;
    frame.sigma.resize(kLifterPoints, 2);
    frame.sigma.col(0).setConstant(sigma.across_m / length);
    frame.sigma.col(1).setConstant(sigma.along_m / length);
    for (int limb = 0; limb < LifterOutput::kLimbs; ++limb) {
      LiftedLimb guess;
      guess.weight = 1;
      const std::span<const int> of_limb = LifterOutput::LimbPoints(limb);
      for (size_t i = 0; i < of_limb.size(); ++i) {
        guess.points[i] = frame.points.row(of_limb[i]).transpose();
        guess.sigma[i] = frame.sigma.row(of_limb[i]).transpose();
      }
      frame.limbs[limb] = {guess};
    }
  }
}

}  // namespace bodyloom
