// SPDX-License-Identifier: Apache-2.0
#include "tracking/hands/hand_costs.h"

#include <cmath>

#include "geometry/math/rotation.h"

namespace bodyloom {

using Eigen::Map;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// Writes a derivative that Ceres asks for.
template <typename Derivative>
void PutDerivative(const Derivative& value, double* to) {
  constexpr int kRows = Derivative::RowsAtCompileTime, kColumns = Derivative::ColsAtCompileTime;
  if (to == nullptr) return;
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kColumns; ++c) to[r * kColumns + c] = value(r, c);
  }
}

}  // namespace

HandTurn::HandTurn(const HandFrame& frame, const double* wrist, double forearm) {
  const Map<const Vector3d> w(wrist);
  const Matrix3d in_forearm = frame.wrist * RotationFromAxisAngle(w);
  camera_from_wrist = frame.camera_from_elbow * RotationFromAxisAngle(forearm * frame.forearm_axis) * in_forearm;
  by_wrist = RightJacobian(w);
  by_forearm = in_forearm.transpose() * frame.forearm_axis;
}

bool HandPointCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const Map<const FingerCoordinates> fingers(parameters[0]);
  const HandTurn turn(*frame_, parameters[1], parameters[2][0]);
  const Map<const Eigen::Vector2d> place(parameters[3]);
  const double size = std::exp(parameters[4][0]);
  ByFingers by_fingers;
  const Vector3d q = hand_->Point(k_, fingers, jacobians != nullptr ? &by_fingers : nullptr);
  const Vector3d from_wrist = size * (turn.camera_from_wrist * q);
  Vector3d at = frame_->wrist_in_camera + from_wrist;
  at.head<2>() += place;
  Eigen::Vector2d pixel;
  Matrix2x3d by_place;
  const bool seen = frame_->camera.Project(at, &pixel, &by_place);
  Map<Eigen::Vector2d> r(residuals);
  r = seen ? Eigen::Vector2d((pixel - pixel_) / sigma_px_) : Eigen::Vector2d::Zero();
  if (jacobians == nullptr) return true;
  by_place *= seen ? 1 / sigma_px_ : 0;
  const Matrix2x3d by_q = by_place * size * turn.camera_from_wrist;
  const Matrix2x3d by_turn = -by_q * Skew(q);
  PutDerivative((by_q * by_fingers).eval(), jacobians[0]);
  PutDerivative((by_turn * turn.by_wrist).eval(), jacobians[1]);
  PutDerivative((by_turn * turn.by_forearm).eval(), jacobians[2]);
  PutDerivative(by_place.leftCols<2>().eval(), jacobians[3]);
  PutDerivative((by_place * from_wrist).eval(), jacobians[4]);
  return true;
}

bool HandBoneCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  const Map<const FingerCoordinates> fingers(parameters[0]);
  const HandTurn turn(*frame_, parameters[1], parameters[2][0]);
  ByFingers by_from, by_to;
  const bool derivatives = jacobians != nullptr;
  const Vector3d bone = hand_->Point(to_, fingers, derivatives ? &by_to : nullptr) -
                        hand_->Point(from_, fingers, derivatives ? &by_from : nullptr);
  const double length = bone.norm();
  const Vector3d along = turn.camera_from_wrist * bone / length;
  Map<Vector3d> r(residuals);
  r = (along - direction_) / sigma_;
  if (!derivatives) return true;
  const Matrix3d by_bone =
      (Matrix3d::Identity() - along * along.transpose()) * turn.camera_from_wrist / (length * sigma_);
  const Matrix3d by_turn = -by_bone * Skew(bone);
  PutDerivative((by_bone * (by_to - by_from)).eval(), jacobians[0]);
  PutDerivative((by_turn * turn.by_wrist).eval(), jacobians[1]);
  PutDerivative((by_turn * turn.by_forearm).eval(), jacobians[2]);
  return true;
}

bool HandLimitCost::Evaluate(double const* const* parameters, double* residuals, double** jacobians) const {
  HandAngleVector excess, slopes;
  HandLimitResiduals(hand_->Angles(Map<const FingerCoordinates>(parameters[0])), &excess, &slopes);
  Eigen::Matrix<double, kFingerCoordinates, kFingerCoordinates> by_fingers = hand_->by_coordinates();
  for (int i = 0; i < kFingerCoordinates; ++i) {
    const int angle = FreeHandAngles()[size_t(i)];
    residuals[i] = excess[angle];
    by_fingers.row(i) *= slopes[angle];
  }
  if (jacobians != nullptr) PutDerivative(by_fingers, jacobians[0]);
  return true;
}

}  // namespace bodyloom
