// SPDX-License-Identifier: Apache-2.0
#include "tracking/clip/uncertainty.h"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/body/body_model.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "tracking/problem/body_points.h"
#include "tracking/solvers/chain/chain_inverse.h"
#include "tracking/solvers/solve_sequence.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kErringTogether = 4;  ///< n
constexpr double kModelSigmaM = 0.01;  ///< f

/// d joint / d (the frame's columns, shared values): 3J×P.
RowMatrixXd JointDerivatives(const FrameLayout& layout, const FrameState& state, const VectorXd& betas,
                             Eigen::Index num_values) {
  const BodyModel& model = *layout.model;
  const int J = model.num_joints(), n = layout.num_frame_columns();
  const bool shape_known = layout.num_betas == 0 || num_values < n + layout.num_betas;
  Kinematics kinematics;
  kinematics.Set(model, betas, state.rotations, layout.BodyTranslation(state), !shape_known);
  RowMatrixXd D = RowMatrixXd::Zero(3 * J, num_values);
  for (int j = 0; j < J; ++j) {
    for (int a : model.ancestors(j)) {
      const int column = layout.column_of_joint[a];
      if (column < 0 || a == j) continue;
      D.block<3, 3>(3 * j, column) = -Skew(kinematics.p[j] - kinematics.p[a]) * kinematics.G[a];
    }
    if (layout.knowledge == CameraKnowledge::kWeak) {
      D(3 * j, layout.translation_column + 1) = D(3 * j + 1, layout.translation_column + 2) = 1;
    } else {
      D.block<3, 3>(3 * j, layout.translation_column).setIdentity();
    }
    if (!shape_known) D.block(3 * j, n, 3, layout.num_betas) = kinematics.dp[j];
  }
  return D;
}

void LeaveOutLifter(SequenceProblem* problem) {
  for (FrameData& frame : problem->frames) {
    frame.Get<LiftedPoseTerm>().weight = 0;
    for (ViewTerms& view : frame.views) view.terms.Get<LiftedPoseTerm>().weight = 0;
  }
}

/// By the whole problem's normal equations, in the layout's columns from beta_column on; empty when they are singular.
MatrixXd SharedCovarianceOf(const SequenceProblem& problem, int num_threads) {
  MatrixXd covariance;
  ChainProblem chain(problem, false, false, num_threads);
  if (!std::isfinite(chain.Linearise(ChainPoint(problem.states, problem)))) return covariance;
  ChainFactor factor(chain.frame_size(), chain.arrow_size(), chain.cut_before(), chain.num_far_rows());
  // Of the frame in which the elimination ends, so that no other's is computed on the way.
  const int middle = static_cast<int>(problem.states.size()) / 2, s = chain.shared_size();
  VisitCovariance(&chain, &factor, middle, middle + 1, 1,
                  [&](int, const MatrixXd& P) { covariance = P.bottomRightCorner(s, s); });
  return covariance;
}

double FocalLogSigmaOf(const FrameLayout& layout, const MatrixXd& shared) {
  const int focal = layout.focal_column - layout.beta_column;
  return std::sqrt(shared(focal, focal));
}

}  // namespace

JointSpread JointSpreadOf(const FrameLayout& layout, const FrameState& state, const VectorXd& betas,
                          const MatrixXd& P) {
  RowMatrixXd D = JointDerivatives(layout, state, betas, P.cols());
  const std::array<int, 2> hip = HipJoints(*layout.model);
  const RowMatrixXd hips = 0.5 * (D.middleRows<3>(3 * hip[0]) + D.middleRows<3>(3 * hip[1]));
  JointSpread spread;
  spread.hips = hips * P * hips.transpose();
  const int J = layout.model->num_joints();
  for (int j = 0; j < J; ++j) D.middleRows<3>(3 * j) -= hips;
  const RowMatrixXd DP = D * P;
  for (int j = 0; j < J; ++j) {
    spread.about_hips.emplace_back(DP.middleRows<3>(3 * j) * D.middleRows<3>(3 * j).transpose());
  }
  return spread;
}

VectorXd JointSigmaOf(const JointSpread& spread) {
  const auto J = static_cast<Eigen::Index>(spread.about_hips.size());
  return VectorXd::NullaryExpr(J, [&](Eigen::Index j) { return std::sqrt(spread.about_hips[j].trace() / 3); });
}

VectorXd JointSigmaOf(const JointSpread& spread, const LiftedPose& lifted, const Matrix3d& camera_from_state) {
  const auto J = static_cast<Eigen::Index>(spread.about_hips.size());
  return VectorXd::NullaryExpr(J, [&](Eigen::Index j) {
    const Matrix3d E = kErringTogether * spread.about_hips[j];
    const Matrix3d L = camera_from_state.transpose() * lifted.JointCovariance(static_cast<int>(j)) * camera_from_state;
    // (E⁻¹ + L⁻¹)⁻¹ without either inverse, since E = 0 for a joint that is the middle of the hips.
    const Matrix3d both = L - L * (L + E).inverse() * L;
    return std::sqrt(both.trace() / 3 + kModelSigmaM * kModelSigmaM);
  });
}

VectorXd JointSigmaOf(const LiftedPose& lifted, int num_joints) {
  return VectorXd::NullaryExpr(num_joints, [&](Eigen::Index j) {
    return std::sqrt(lifted.JointCovariance(static_cast<int>(j)).trace() / 3 + kModelSigmaM * kModelSigmaM);
  });
}

double JointSpread::HipsSigma() const { return std::sqrt(hips.trace() / 3); }

PositionSigma PositionSigma::Unknown(Eigen::Index num_frames, int num_joints) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  return {RowMatrixXd::Constant(num_frames, num_joints, kNaN), VectorXd::Constant(num_frames, kNaN), MatrixXd()};
}

PositionSigma PositionSigmaOf(SequenceProblem problem, int num_threads, double* focal_log_sigma,
                              const MatrixXd* shared) {
  const auto T = static_cast<Eigen::Index>(problem.states.size());
  PositionSigma sigma = PositionSigma::Unknown(T, problem.layout.model->num_joints());
  LeaveOutLifter(&problem);
  // More than chain supports: the covariance is computed without them, which overestimates it.
  if (NumFarRows(problem) > ChainProblem::kMaxFarRows) problem.couplings.clear();
  ChainProblem chain(problem, false, false, num_threads);
  if (!std::isfinite(chain.Linearise(ChainPoint(problem.states, problem)))) return sigma;
  ChainFactor factor(chain.frame_size(), chain.arrow_size(), chain.cut_before(), chain.num_far_rows());
  const auto visit = [&](int t, const MatrixXd& P) {
    const JointSpread spread = JointSpreadOf(problem.layout, problem.states[t], problem.betas, P);
    const FrameData& frame = problem.frames[t];
    const LiftedPose* lifted = frame.Get<LiftedPoseTerm>().pose;
    const Matrix3d turn =
        frame.camera_from_scene == nullptr ? Matrix3d::Identity() : frame.camera_from_scene->camera_from_world_rotation;
    sigma.joints.row(t) = (lifted == nullptr ? JointSigmaOf(spread) : JointSigmaOf(spread, *lifted, turn)).transpose();
    sigma.hips[t] = spread.HipsSigma();
    // The same in every frame's covariance.
    const int s = problem.layout.num_columns - problem.layout.beta_column;
    if (t == 0) sigma.shared = P.bottomRightCorner(s, s);
    if (t == 0 && focal_log_sigma != nullptr && problem.layout.focal_column >= 0) {
      *focal_log_sigma = FocalLogSigmaOf(problem.layout, sigma.shared);
    }
  };
  VisitCovariance(&chain, &factor, 0, static_cast<int>(T), num_threads, visit, shared);
  return sigma;
}

PositionSigma PositionSigmaInWindows(const SequenceProblem& problem, int window, int num_threads,
                                     double* focal_log_sigma) {
  const int T = static_cast<int>(problem.states.size());
  PositionSigma sigma = PositionSigma::Unknown(T, problem.layout.model->num_joints());
  {
    SequenceSample sample(problem, window);
    LeaveOutLifter(&sample.part);
    sigma.shared = sample.share * SharedCovarianceOf(sample.part, num_threads);
  }
  if (sigma.shared.size() == 0) return sigma;
  if (focal_log_sigma != nullptr && problem.layout.focal_column >= 0) {
    *focal_log_sigma = FocalLogSigmaOf(problem.layout, sigma.shared);
  }
  int done = 0;
  for (const auto& [begin, end] : WindowsOf(T, window)) {
    SequenceWindow part(problem, begin, end);
    const PositionSigma found = PositionSigmaOf(std::move(part.part), num_threads, nullptr, &sigma.shared);
    const int to = end == T ? T : end - kWindowOverlap / 2, first = part.frames.front();
    sigma.joints.middleRows(done, to - done) = found.joints.middleRows(done - first, to - done);
    sigma.hips.segment(done, to - done) = found.hips.segment(done - first, to - done);
    done = to;
  }
  return sigma;
}

double FocalLogSigmaOf(const SequenceProblem& problem, int num_threads) {
  const MatrixXd shared = problem.layout.focal_column < 0 ? MatrixXd() : SharedCovarianceOf(problem, num_threads);
  return shared.size() == 0 ? std::numeric_limits<double>::quiet_NaN() : FocalLogSigmaOf(problem.layout, shared);
}

void AddFocalSpread(double log_sigma, Track* track) {
  for (Eigen::Index t = 0; t < track->root_sigma.size(); ++t) {
    const Vector3d pelvis = track->joints[t].row(0);
    const double z = track->HasMovingCamera() ? MovedPoint(track->camera_from_scene[t], pelvis).z() : pelvis.z();
    track->root_sigma[t] = std::hypot(track->root_sigma[t], log_sigma * z / std::sqrt(3));
  }
}

}  // namespace bodyloom
