// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/tracking/terms/pose_prior/mixture_prior.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

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
