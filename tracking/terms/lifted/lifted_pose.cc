// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/lifted/lifted_pose.h"

#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"
#include "tracking/initialise/initial_states.h"
#include "tracking/initialise/lifted_start.h"
#include "tracking/lifter/lifter_input.h"
#include "tracking/problem/clip_term.h"
#include "tracking/problem/frame_accumulator.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

using Eigen::Vector3d;

LiftedPose MakeLiftedPose(const LiftedFrame& frame, const LiftedLandmarks& landmarks, double metres,
                          double min_sigma_m) {
  LiftedPose pose;
  pose.landmarks = &landmarks;
  pose.axes = frame.camera_from_virtual;
  for (int k = 0; k < kLifterPoints; ++k) {
    if (!landmarks.known[k]) continue;
    LiftedPose::Point& point = pose.points.emplace_back();
    point.landmark = k;
    point.offset = metres * frame.points.row(k).transpose();
    for (int i = 0; i < 2; ++i) point.inverse_sigma[i] = 1 / std::max(min_sigma_m, metres * frame.sigma(k, i));
    point.variance = 4 * metres * metres * frame.sigma.row(k).transpose().cwiseAbs2();
  }
  return pose;
}

Eigen::Matrix3d LiftedPose::Turned(const Eigen::Vector2d& across_and_along) const {
  const double x = across_and_along[0], z = across_and_along[1];
  Eigen::Matrix3d turned;  // not constructed from the product, which adds in another order
  turned = axes * Vector3d(x, x, z).asDiagonal() * axes.transpose();
  return turned;
}

Eigen::Matrix3d LiftedPose::JointCovariance(int joint) const {
  const LiftedLandmarks::Nearest& nearest = landmarks->of_joint[joint];
  const auto point = std::lower_bound(points.begin(), points.end(), nearest.landmark,
                                      [](const Point& p, int landmark) { return p.landmark < landmark; });
  return nearest.share * nearest.share * Turned(point->variance);
}

namespace {

struct LiftedScratch {
  RowMatrixXd hip_rows;
  std::vector<int> hip_blocks;
};

}  // namespace

void LiftedPoseTerm::Add(FrameAccumulator* sums) const {
  if (!runs()) return;
  const LiftedLandmarks& landmarks = *pose->landmarks;
  const Kinematics& kinematics = sums->kinematics();
  PointEvaluator& points = sums->points();
  RowMatrixXd& hip_rows = sums->Scratch<LiftedScratch>().hip_rows;
  const bool derivatives = sums->derivatives();
  // The translation moves landmark and mid-hip alike, so its columns stay zero.
  Vector3d hips = Vector3d::Zero();
  std::vector<int>& hip_blocks = sums->Scratch<LiftedScratch>().hip_blocks;
  hip_blocks.clear();
  if (derivatives) hip_rows.setZero(3, sums->NextRows(3).cols());
  for (int k = kLifterLeftHip; k <= kLifterLeftHip + 1; ++k) {
    hips += 0.5 * points.Evaluate(kinematics, landmarks.points[k], derivatives);
    if (!derivatives) continue;
    sums->FillPointRows(sums->NextRows(3));  // scratch until the first landmark
    hip_rows += 0.5 * sums->NextRows(3);
    for (const int j : points.joints()) {
      const int column = sums->layout().column_of_joint[j];
      if (column >= 0) hip_blocks.push_back(FrameLayout::BlockOfColumn(column));
    }
  }
  for (const LiftedPose::Point& point : pose->points) {
    const Vector3d x = points.Evaluate(kinematics, landmarks.points[point.landmark], derivatives);
    const Eigen::Matrix3d whitening = pose->Whitening(point);
    const Vector3d residual = whitening * (x - hips - point.offset);
    const double scale = sums->AddGroup(3, residual.squaredNorm(), kernel, weight);
    if (!derivatives) continue;
    sums->FillPointRows(sums->NextRows(3));
    sums->DependsOnPoint();
    for (const int block : hip_blocks) sums->DependsOn(block);
    const RowMatrixXd difference = sums->NextRows(3) - hip_rows;
    sums->NextRows(3).noalias() = scale * whitening * difference;
    sums->NextResiduals(3) = scale * residual;
    sums->TakeRows(3);
  }
}

std::vector<PlanEntry> PlanLifted(const TrackSequenceInput& input, const TrackSequenceOptions& options) {
  if (input.initialiser != nullptr) return {};
  const std::string why_not = WhyNoLifter(input, options);
  return {{"initialiser term (L_d)", why_not.empty(),
           why_not.empty() ? Concatenate("weight ", options.lifter_weight, ", of the lifter")
                           : "no initialiser and no lifter"}};
}

namespace {

class LiftedPoseTerms : public ClipTerm {
 public:
  explicit LiftedPoseTerms(const ClipTermInput& clip) : weight_(clip.options.lifter_weight) {
    for (const LiftedFrame& frame : clip.lifted.frames) {
      poses_.push_back(
          MakeLiftedPose(frame, clip.lifted_landmarks, clip.lifted.metres, clip.options.lifter_min_sigma_m));
    }
  }
  void Observe(SequenceProblem* problem) override {
    for (size_t t = 0; t < problem->frames.size(); ++t) {
      LiftedPoseTerm& term = problem->frames[t].Get<LiftedPoseTerm>();
      term.pose = &poses_[t];
      term.weight = weight_;
    }
  }

 private:
  double weight_;
  std::vector<LiftedPose> poses_;  ///< T
};

}  // namespace

std::unique_ptr<ClipTerm> MakeLiftedPoseTerms(const ClipTermInput& clip) {
  // With a user's initialiser the lifter is used only for the vertical and standing feet.
  if (clip.input.initialiser != nullptr || clip.lifted.frames.empty()) return nullptr;
  return std::make_unique<LiftedPoseTerms>(clip);
}

}  // namespace bodyloom
