// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/learning/pose_refiner.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/body/posed_body.h"
#include "geometry/body/skeleton_gradient.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/observations.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kBlockPixels = 64;
constexpr double kMeanKept = 0.8, kSquareKept = 0.9;  ///< a frame is visited about twenty times

VectorXd CorrectionOf(int frame, const FloatColumns& table) {
  VectorXd row(table.columns());
  for (int c = 0; c < table.columns(); ++c) row[c] = table(frame, c);
  return row;
}

}  // namespace

bool PoseRefinerOptions::IsValid(std::string* why) const {
  const InRange in_range(why);
  return in_range("photo_sigma", photo_sigma, 1e-4, 1e4) && in_range("place_sigma_m", place_sigma_m, 1e-4, 10) &&
         in_range("across_share", across_share, 1e-3, 10) && in_range("joints_together", joints_together, 1, 1000) &&
         in_range("turn_sigma_deg", turn_sigma_deg, 0.01, 180) && in_range("drift", drift, 1e-3, 1e6) &&
         in_range("rate of poses", rate, 0, 100) && in_range("rate_end of poses", rate_end, 0, 100);
}

void PoseCorrections::Reset(int num_frames, int num_joints) {
  for (FloatColumns* table : {&values, &mean}) {
    table->Resize(3 * num_joints + 3, num_frames);
    table->Fill(0);
  }
  square.assign(num_frames, 0);
  steps.assign(num_frames, 0);
}

bool PoseCorrections::IsZero(int frame) const {
  for (int c = 0; c < values.columns(); ++c) {
    if (values(frame, c) != 0) return false;
  }
  return true;
}

PoseRefiner::PoseRefiner(const BodyModel& model, const VectorXd& betas, std::vector<TrackedPose> poses,
                         const PoseRefinerOptions& options)
    : model_(model),
      rest_joints_(model.RestJoints(betas)),
      frames_(model, betas),
      poses_(std::move(poses)),
      options_(options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "refining poses: ", why);
  const auto J = static_cast<size_t>(model.num_joints());
  for (const TrackedPose& tracked : poses_) {
    const size_t rotations = tracked.pose.rotations.size(), sigmas = tracked.joint_sigma.size();
    BODYLOOM_CHECK((rotations == 0 || rotations == J) && (sigmas == 0 || sigmas == J), "refining poses: a pose of ",
                   rotations, " joints with ", sigmas, " sigmas, the body has ", J);
  }
}

BodyPose PoseRefiner::PoseAt(int frame, const PoseCorrections& corrections) const {
  BodyPose pose = poses_[frame].pose;
  const VectorXd d = CorrectionOf(frame, corrections.values);
  for (int j = 0; j < num_joints(); ++j) {
    const Vector3d turn = d.segment<3>(3 * j);
    if (!turn.isZero(0)) pose.rotations[j] = pose.rotations[j] * RotationFromAxisAngle(turn);
  }
  pose.trans += d.tail<3>();
  return pose;
}

void PoseRefiner::MakeFrame(int frame, const PoseCorrections& corrections, int num_threads, AvatarFrame* to) const {
  frames_.Make(PoseAt(frame, corrections), {}, num_threads, to);
}

VectorXd PoseRefiner::ByCorrection(int frame, const std::vector<float>& by_bones,
                                   const PoseCorrections& corrections) const {
  const int J = num_joints();
  BODYLOOM_CHECK(by_bones.size() >= 12 * static_cast<size_t>(J) && corrections.values.rows() == num_frames() &&
                     corrections.values.columns() == 3 * J + 3,
                 "refining poses: ", by_bones.size(), " derivatives by bones and corrections of ",
                 corrections.values.rows(), "x", corrections.values.columns(), " for ", num_frames(), " frames and ", J,
                 " joints");
  std::vector<Matrix3d> by_rotations(J);
  MatrixX3d by_joints(J, 3);
  for (int j = 0; j < J; ++j) {
    for (int r = 0; r < 3; ++r) {
      const float* row = by_bones.data() + 12 * static_cast<size_t>(j) + 4 * r;
      for (int c = 0; c < 3; ++c) by_rotations[j](r, c) = row[c];
      by_joints(j, r) = row[3];
    }
  }
  const PosedSkeleton skeleton = PoseSkeleton(model_, rest_joints_, PoseAt(frame, corrections));
  const SkeletonGradient gradient = SkeletonBackward(model_.parents(), skeleton, by_rotations, by_joints);
  const VectorXd d = CorrectionOf(frame, corrections.values);
  VectorXd by_correction(3 * J + 3);
  for (int j = 0; j < J; ++j) {
    by_correction.segment<3>(3 * j) =
        RightJacobian(d.segment<3>(3 * j)).transpose() * gradient.by_turns.row(j).transpose();
  }
  by_correction.tail<3>() = gradient.by_trans;
  return by_correction;
}

MatrixXd PoseRefiner::Metric(int frame) const {
  const TrackedPose& tracked = poses_[frame];
  const int J = num_joints();
  MatrixXd jacobian = JointJacobian(model_.parents(), PoseSkeleton(model_, rest_joints_, tracked.pose));
  for (int j = 0; j < J; ++j) {
    const double known = tracked.joint_sigma.empty() ? 0 : tracked.joint_sigma[j];
    const double sigma = known > 0 ? options_.across_share * known : options_.place_sigma_m;
    jacobian.middleRows<3>(3 * j) /= sigma * std::sqrt(options_.joints_together);
  }
  MatrixXd metric = jacobian.transpose() * jacobian;
  const double turn = 180 / (M_PI * options_.turn_sigma_deg);
  metric.diagonal().head(3 * J).array() += turn * turn;
  return metric;
}

void PoseRefiner::Step(int frame, const std::vector<float>& by_bones, double person_pixels, double progress,
                       PoseCorrections* corrections) const {
  const VectorXd by_image =
      person_pixels / kBlockPixels / options_.photo_sigma * ByCorrection(frame, by_bones, *corrections);
  if (!by_image.allFinite()) return;
  const MatrixXd metric = Metric(frame);
  const VectorXd d = CorrectionOf(frame, corrections->values);
  VectorXd direction = metric.llt().solve(by_image) + d;
  for (const int beside : {frame - 1, frame + 1}) {
    if (beside < 0 || beside >= num_frames() || corrections->steps[beside] == 0) continue;
    direction += (d - CorrectionOf(beside, corrections->values)) / (options_.drift * options_.drift);
  }
  const double square = direction.dot(metric * direction);
  const int n = std::min(++corrections->steps[frame], 10000);
  VectorXd mean = kMeanKept * CorrectionOf(frame, corrections->mean) + (1 - kMeanKept) * direction;
  float& kept = corrections->square[frame];
  kept = static_cast<float>(kSquareKept * kept + (1 - kSquareKept) * square);
  const double rate = options_.rate * std::pow(std::max(1e-6, options_.rate_end / std::max(1e-9, options_.rate)),
                                               std::clamp(progress, 0.0, 1.0));
  const double root = std::sqrt(kept / (1 - std::pow(kSquareKept, n)));
  for (int c = 0; c < d.size(); ++c) {
    corrections->mean(frame, c) = static_cast<float>(mean[c]);
    const double step = root > 1e-12 ? rate * mean[c] / (1 - std::pow(kMeanKept, n)) / root : 0;
    corrections->values(frame, c) = static_cast<float>(d[c] - step);
  }
}

namespace {

BodyPose PoseOfFrame(const BodyModel& body, const Motion& motion, int t) {
  return PoseFromAxisAngle(body, motion.poses.row(t).transpose(), motion.trans.row(t).transpose());
}

}  // namespace

std::vector<TrackedPose> TrackedPoses(const BodyModel& body, const Track& track) {
  std::vector<TrackedPose> poses(track.num_frames());
  for (int t = 0; t < track.num_frames(); ++t) {
    if (!track.HasResult(t)) continue;
    poses[t].pose = PoseOfFrame(body, track.motion, t);
    if (track.joint_sigma.rows() != track.num_frames()) continue;
    const auto sigma = track.joint_sigma.row(t);
    poses[t].joint_sigma.assign(sigma.begin(), sigma.end());
  }
  return poses;
}

Track RefinedTrack(const BodyModel& body, const Track& track, const PoseRefiner& refiner,
                   const PoseCorrections& corrections) {
  Track refined = track;
  const int num_joints = body.num_joints();
  const MatrixX3d rest_joints = body.RestJoints(track.motion.betas);
  for (int t = 0; t < track.num_frames(); ++t) {
    if (corrections.IsZero(t)) continue;
    const BodyPose pose = refiner.PoseAt(t, corrections);
    const Eigen::VectorXd turns = AxisAngleFromPose(body, pose);
    for (int j = 0; j < num_joints; ++j) {
      const auto turn = [&](int c) { return corrections.values(t, 3 * j + c); };
      if (turn(0) == 0 && turn(1) == 0 && turn(2) == 0) continue;
      refined.motion.poses.row(t).segment<3>(3 * j) = turns.segment<3>(3 * j).transpose();
    }
    refined.motion.trans.row(t) = pose.trans.transpose();
    const auto frame = static_cast<size_t>(t);
    if (frame < refined.joints.size()) refined.joints[frame] = PoseSkeleton(body, rest_joints, pose).joints;
    if (frame < refined.coco17.size() && refined.coco17[frame].rows() > 0) {
      refined.coco17[frame] = PoseLandmarks(body, track.motion.betas, pose, CocoNames());
    }
  }
  return refined;
}

}  // namespace bodyloom
