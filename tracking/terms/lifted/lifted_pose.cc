// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/terms/lifted/lifted_pose.h"

#include <algorithm>
#include <cmath>

#include "bodyloom/tracking/frame_accumulator.h"
#include "bodyloom/tracking/initialise/lifter_input.h"
#include "bodyloom/tracking/robust.h"

namespace bodyloom {

using Eigen::Vector3d;

LiftedPose MakeLiftedPose(const LiftedFrame& frame, const LiftedLandmarks& landmarks, double metres,
                          double min_sigma_m) {
  LiftedPose pose;
  pose.landmarks = &landmarks;
  const Eigen::Matrix3d& R = frame.camera_from_virtual;
  for (int k = 0; k < kLifterPoints; ++k) {
    if (!landmarks.known[k]) continue;
    const double across = 1 / std::max(min_sigma_m, metres * frame.sigma(k, 0));
    const double along = 1 / std::max(min_sigma_m, metres * frame.sigma(k, 1));
    LiftedPose::Point& point = pose.points.emplace_back();
    point.landmark = k;
    point.offset = metres * frame.points.row(k).transpose();
    point.whitening = R * Eigen::Vector3d(across, across, along).asDiagonal() * R.transpose();
    const Eigen::Vector2d variance = 4 * metres * metres * frame.sigma.row(k).transpose().cwiseAbs2();
    point.covariance = R * Eigen::Vector3d(variance[0], variance[0], variance[1]).asDiagonal() * R.transpose();
  }
  return pose;
}

Eigen::Matrix3d LiftedPose::JointCovariance(int joint) const {
  const LiftedLandmarks::Nearest& nearest = landmarks->of_joint[joint];
  const auto point = std::lower_bound(points.begin(), points.end(), nearest.landmark,
                                      [](const Point& p, int landmark) { return p.landmark < landmark; });
  return nearest.share * nearest.share * point->covariance;
}

void LiftedOfFrame::Add(FrameAccumulator* sums) const {
  if (!runs()) return;
  const LiftedLandmarks& landmarks = *pose->landmarks;
  const Kinematics& kinematics = sums->kinematics();
  PointEvaluator& points = sums->points();
  RowMatrixXd& hip_rows = sums->hip_rows;
  const bool derivatives = sums->derivatives();
  // The translation moves landmark and mid-hip alike, so its columns stay zero.
  Vector3d hips = Vector3d::Zero();
  if (derivatives) hip_rows.setZero(3, sums->NextRows(3).cols());
  for (int k = kLifterLeftHip; k <= kLifterLeftHip + 1; ++k) {
    hips += 0.5 * points.Evaluate(kinematics, landmarks.points[k], derivatives);
    if (!derivatives) continue;
    sums->FillPointRows(sums->NextRows(3));  // scratch until the first landmark
    hip_rows += 0.5 * sums->NextRows(3);
  }
  for (const LiftedPose::Point& point : pose->points) {
    const Vector3d x = points.Evaluate(kinematics, landmarks.points[point.landmark], derivatives);
    const Vector3d residual = point.whitening * (x - hips - point.offset);
    const RobustValue robust = GemanMcClure(residual.squaredNorm(), kernel);
    sums->AddCost(0.5 * weight * robust.rho);
    if (!derivatives) continue;
    const double scale = std::sqrt(weight * robust.weight);
    sums->FillPointRows(sums->NextRows(3));
    const RowMatrixXd difference = sums->NextRows(3) - hip_rows;
    sums->NextRows(3).noalias() = scale * point.whitening * difference;
    sums->NextResiduals(3) = scale * residual;
    sums->TakeRows(3);
  }
}

}  // namespace bodyloom
