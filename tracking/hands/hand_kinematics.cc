// SPDX-License-Identifier: Apache-2.0
#include "tracking/hands/hand_kinematics.h"

#include <Eigen/Eigenvalues>

#include "geometry/biomechanics/hand_prior.h"
#include "geometry/body/posed_body.h"
#include "geometry/math/rotation.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr int kThumbFinger = 4;
/// The finger (FingerNames()) of points 1 to 4, 5 to 8, ….
constexpr std::array<int, 5> kFingerOfPoints = {kThumbFinger, 0, 1, 3, 2};

std::array<int, kFingerCoordinates> MakeFreeHandAngles() {
  std::array<int, kFingerCoordinates> free{};
  for (int f = 0; f < 5; ++f) {
    const int first = 9 * f;  // flexion and sideways of joint 1, flexion of joints 2 and 3
    const std::array<int, 4> of_finger = {first, first + 1, first + 3, first + 6};
    std::copy(of_finger.begin(), of_finger.end(), free.begin() + static_cast<ptrdiff_t>(4) * f);
  }
  return free;
}

Vector3d PlaceOfLandmark(const BodyModel& body, const Eigen::VectorXd& betas, int landmark) {
  const Landmark& of = body.data().landmarks[size_t(landmark)];
  Vector3d place = Vector3d::Zero();
  for (size_t i = 0; i < of.vertices.size(); ++i) place += of.weights[i] * ShapedVertex(body, betas, of.vertices[i]);
  return place;
}

}  // namespace

const std::array<int, kFingerCoordinates>& FreeHandAngles() {
  static const std::array<int, kFingerCoordinates> free = MakeFreeHandAngles();
  return free;
}

int HandJointAt(int point) {
  return point == 0 || point % 4 == 0 ? -1 : 3 * kFingerOfPoints[size_t(point - 1) / 4] + (point - 1) % 4;
}

HandKinematics::HandKinematics(const BodyModel& body, const HandSkeleton& hand, const Eigen::VectorXd& betas)
    : hand_(hand) {
  const MatrixX3d joints = body.RestJoints(betas);
  for (int f = 0; f < 5; ++f) {
    auto& bone = bone_[size_t(f)];
    Vector3d before = joints.row(hand.wrist);
    for (int k = 0; k < 3; ++k) {
      const Vector3d at = joints.row(hand.joint[size_t(3 * f + k)]);
      bone[size_t(k)] = at - before;
      before = at;
    }
    constexpr std::array<int, 5> kTip = {8, 12, 20, 16, 4};
    const int tip = body.FindLandmark(HandLandmarkNames(hand.side)[size_t(kTip[size_t(f)])]);
    bone[3] = tip < 0 ? Vector3d(0.8 * bone[2]) : PlaceOfLandmark(body, betas, tip) - before;
  }
  const HandPrior& prior = BuiltinHandPrior();
  Eigen::Matrix<double, kFingerCoordinates, kHandAngles> rows;
  for (int i = 0; i < kFingerCoordinates; ++i) {
    const int angle = FreeHandAngles()[size_t(i)];
    rows.row(i) = prior.components.row(angle) * prior.sigma.asDiagonal();
    mean_[i] = prior.mean[angle];
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(rows * rows.transpose());
  L_ = solver.eigenvectors().rowwise().reverse() * solver.eigenvalues().reverse().cwiseSqrt().asDiagonal();
  inverse_ = solver.eigenvalues().reverse().cwiseSqrt().cwiseInverse().asDiagonal() *
             solver.eigenvectors().rowwise().reverse().transpose();
}

HandAngleVector HandKinematics::Angles(const FingerCoordinates& y) const {
  const FingerCoordinates free = mean_ + L_ * y;
  HandAngleVector angles = HandAngleVector::Zero();
  for (int i = 0; i < kFingerCoordinates; ++i) angles[FreeHandAngles()[size_t(i)]] = free[i];
  return angles;
}

FingerCoordinates HandKinematics::CoordinatesOf(const HandAngleVector& angles) const {
  FingerCoordinates free;
  for (int i = 0; i < kFingerCoordinates; ++i) free[i] = angles[FreeHandAngles()[size_t(i)]];
  return inverse_ * (free - mean_);
}

Vector3d HandKinematics::Point(int k, const FingerCoordinates& y, ByFingers* by_fingers) const {
  if (by_fingers != nullptr) by_fingers->setZero();
  if (k == 0) return Vector3d::Zero();
  const int finger = kFingerOfPoints[size_t(k - 1) / 4], last = (k - 1) % 4;
  const auto& bone = bone_[size_t(finger)];
  std::array<Matrix3d, 3> turned;    // wrist axes from those of joints 1 to 3
  std::array<Vector3d, 3> place, w;  // of joints 1 to 3; their rotations, axis-angle
  Matrix3d turn = Matrix3d::Identity();
  Vector3d at = bone[0];
  for (int j = 0; j < last; ++j) {
    const int joint = 3 * finger + j, row = 4 * finger + (j == 0 ? 0 : j + 1);
    Vector3d angles(mean_[row] + L_.row(row).dot(y) - hand_.rest_flexion[size_t(joint)], 0, 0);
    if (j == 0) angles[1] = mean_[row + 1] + L_.row(row + 1).dot(y);
    w[size_t(j)] = hand_.axes[size_t(joint)] * angles;
    place[size_t(j)] = at;
    turn = turn * RotationFromAxisAngle(w[size_t(j)]);
    turned[size_t(j)] = turn;
    at += turn * bone[size_t(j + 1)];
  }
  if (by_fingers == nullptr) return at;
  for (int j = 0; j < last; ++j) {
    const auto joint = size_t(3 * finger + j);
    const int row = 4 * finger + (j == 0 ? 0 : j + 1);
    const Matrix3d by_angles =
        -Skew(at - place[size_t(j)]) * turned[size_t(j)] * RightJacobian(w[size_t(j)]) * hand_.axes[joint];
    by_fingers->noalias() += by_angles.col(0) * L_.row(row);
    if (j == 0) by_fingers->noalias() += by_angles.col(1) * L_.row(row + 1);
  }
  return at;
}

}  // namespace bodyloom
