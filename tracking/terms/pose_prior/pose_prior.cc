// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/pose_prior/pose_prior.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "geometry/base/check.h"
#include "geometry/math/rotation.h"
#include "tracking/problem/clip_term.h"
#include "tracking/problem/frame_accumulator.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::VectorXd;

void PosePriorTerm::Add(FrameAccumulator* sums) const {
  if (!runs()) return;
  const FrameLayout& layout = sums->layout();
  const std::vector<int>& joints = mixture->joints();
  VectorXd x(3 * joints.size());
  for (size_t i = 0; i < joints.size(); ++i)
    x.segment<3>(3 * i) = AxisAngleFromRotation(sums->state().rotations[joints[i]]);
  double energy;
  const int k = mixture->Nearest(x, &energy);
  if (sums->one_by_one()) {
    AddOneByOne(x, k, energy, sums);
    return;
  }
  sums->AddCost(0.5 * weight * energy);
  if (!sums->derivatives()) return;
  const Eigen::MatrixXd& precision = mixture->precision(k);
  std::vector<Matrix3d> d_x(joints.size());
  for (size_t i = 0; i < joints.size(); ++i) d_x[i] = RightJacobianInverse(x.segment<3>(3 * i));
  const VectorXd force = weight * (precision * (x - mixture->mean(k)));
  for (size_t i = 0; i < joints.size(); ++i) {
    const int row = layout.column_of_joint[joints[i]];
    sums->gradient().segment<3>(row) += d_x[i].transpose() * force.segment<3>(3 * i);
    for (size_t j = 0; j < joints.size(); ++j) {
      const int column = layout.column_of_joint[joints[j]];
      if (column < row) continue;
      const Matrix3d half = weight * d_x[i].transpose() * precision.block<3, 3>(3 * i, 3 * j);
      sums->H().block<3, 3>(row, column) += half * d_x[j];
    }
  }
}

void PosePriorTerm::AddOneByOne(const VectorXd& x, int component, double energy, FrameAccumulator* sums) const {
  const std::vector<int>& joints = mixture->joints();
  const auto n = static_cast<Eigen::Index>(x.size());
  const int num_rows = static_cast<int>(n) + 1;
  sums->AddGroup(num_rows, energy, 0, weight);
  if (!sums->derivatives()) return;
  const Eigen::MatrixXd& L = mixture->sqrt_precision(component);
  auto rows = sums->NextRows(num_rows);
  auto residual = sums->NextResiduals(num_rows);
  rows.setZero();
  residual.head(n) = L.triangularView<Eigen::Upper>() * (x - mixture->mean(component));
  residual[n] = std::sqrt(mixture->offset(component));
  for (size_t i = 0; i < joints.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(3 * i);
    const int column = sums->layout().column_of_joint[joints[i]];
    rows.block(0, column, at + 3, 3) = L.block(0, at, at + 3, 3) * RightJacobianInverse(x.segment<3>(at));
    sums->DependsOn(FrameLayout::BlockOfColumn(column));
  }
  sums->TakeRows(num_rows);
}

std::vector<PlanEntry> PlanPosePrior(const TrackSequenceInput& input, const TrackSequenceOptions& /*options*/) {
  return {{"pose prior", input.prior != nullptr, input.prior != nullptr ? "learned mixture" : "none was given"}};
}

std::unique_ptr<ClipTerm> MakePosePriorTerms(const ClipTermInput& clip) {
  if (clip.input.prior == nullptr || clip.input.prior->num_components() == 0) return nullptr;
  const auto mixture =
      std::make_shared<const MixturePrior>(*clip.input.prior, *clip.layout.model, clip.layout.active_joints);
  return EachFrame([mixture, weight = clip.options.prior_weight](int, const FrameState&, FrameData* frame) {
    frame->Get<PosePriorTerm>().mixture = mixture;
    frame->Get<PosePriorTerm>().weight = weight;
  });
}

MixturePrior::MixturePrior(const PosePrior& prior, const BodyModel& model, const std::vector<int>& active_joints) {
  std::vector<int> rows;  // of the prior's x that are kept
  for (size_t i = 0; i < prior.joints.size(); ++i) {
    const int joint = model.FindJoint(prior.joints[i]);
    if (joint < 0 || std::find(active_joints.begin(), active_joints.end(), joint) == active_joints.end()) continue;
    joints_.push_back(joint);
    for (int c = 0; c < 3; ++c) rows.push_back(static_cast<int>(3 * i) + c);
  }
  if (joints_.empty()) return;
  double smallest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < prior.num_components(); ++k) {
    const Eigen::MatrixXd& covariance = prior.covariances[k];
    Eigen::MatrixXd marginal(rows.size(), rows.size());
    Component component;
    component.mean.resize(rows.size());
    for (size_t a = 0; a < rows.size(); ++a) {
      component.mean[a] = prior.means(k, rows[a]);
      for (size_t b = 0; b < rows.size(); ++b) marginal(a, b) = covariance(rows[a], rows[b]);
    }
    const Eigen::LLT<Eigen::MatrixXd> factor(marginal);
    BODYLOOM_CHECK(factor.info() == Eigen::Success, "pose prior: covariance of component ", k,
                   " is not positive definite");
    // Σ = C Cᵀ, so Σ⁻¹ = C⁻ᵀ C⁻¹ and ‖C⁻¹ x‖² is the Mahalanobis distance; a QR makes the factor upper triangular.
    const Eigen::MatrixXd inverse = factor.matrixL().solve(Eigen::MatrixXd::Identity(rows.size(), rows.size()));
    component.L = Eigen::LLT<Eigen::MatrixXd>(inverse.transpose() * inverse).matrixU();
    component.precision = component.L.transpose() * component.L;
    component.offset = -2 * (prior.log_weights[k] + component.L.diagonal().array().log().sum());
    smallest = std::min(smallest, component.offset);
    components_.push_back(std::move(component));
  }
  for (Component& component : components_) component.offset -= smallest;
}

int MixturePrior::Nearest(const Eigen::VectorXd& x, double* energy) const {
  int best = 0;
  *energy = std::numeric_limits<double>::infinity();
  for (size_t k = 0; k < components_.size(); ++k) {
    if (components_[k].offset >= *energy) continue;
    const double e = (components_[k].L.triangularView<Eigen::Upper>() * (x - components_[k].mean)).squaredNorm() +
                     components_[k].offset;
    if (e < *energy) {
      *energy = e;
      best = static_cast<int>(k);
    }
  }
  return best;
}

}  // namespace bodyloom
