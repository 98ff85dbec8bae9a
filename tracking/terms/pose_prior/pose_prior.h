// SPDX-License-Identifier: Apache-2.0
/// The learned prior on the distribution of poses.
///   ½ w E(x),   E(x) = min_k [ ‖L_k (x − μ_k)‖² + e_k ]      (MixturePrior)
/// x: axis-angle of the prior's joints that are estimated, radians. No robust kernel, since the minimum over the
/// components already admits rare poses. Derivatives are those of the nearest component. Runs when a prior was given.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/pose_prior.h"
#include "tracking/problem/frame_term.h"

namespace bodyloom {

// The learned mixture, restricted to the joints that are estimated.
//
// Energy of x (stacked axis-angle of the joints): min_k [ ‖L_k (x − μ_k)‖² + e_k ], e_k = −2 log(w_k |L_k|) shifted so
// that the smallest is zero. The minimum over components replaces the logarithm of the sum, as in SMPLify, so that the
// energy stays a sum of squares.

class MixturePrior {
 public:
  /// Marginalises the prior to those of its joints that are in `active_joints`. Empty when there are none.
  MixturePrior(const PosePrior& prior, const BodyModel& model, const std::vector<int>& active_joints);

  [[nodiscard]] bool empty() const { return joints_.empty(); }
  /// Body joint indices in the order of x.
  [[nodiscard]] const std::vector<int>& joints() const { return joints_; }
  /// Index of the component of minimum energy at x, and that energy.
  int Nearest(const Eigen::VectorXd& x, double* energy) const;
  [[nodiscard]] const Eigen::MatrixXd& sqrt_precision(int k) const { return components_[k].L; }
  /// Σ⁻¹
  [[nodiscard]] const Eigen::MatrixXd& precision(int k) const { return components_[k].precision; }
  [[nodiscard]] const Eigen::VectorXd& mean(int k) const { return components_[k].mean; }
  [[nodiscard]] double offset(int k) const { return components_[k].offset; }
  [[nodiscard]] int num_components() const { return static_cast<int>(components_.size()); }

 private:
  struct Component {
    Eigen::VectorXd mean;
    Eigen::MatrixXd L;  ///< upper triangular, LᵀL = Σ⁻¹
    Eigen::MatrixXd precision;
    double offset = 0;
  };
  std::vector<int> joints_;
  std::vector<Component> components_;
};

class ClipTerm;
struct ClipTermInput;
struct PlanEntry;
struct TrackSequenceInput;
struct TrackSequenceOptions;

class PosePriorTerm : public CopyableTerm<PosePriorTerm> {
 public:
  std::shared_ptr<const MixturePrior> mixture;  ///< null: none
  double weight = 0;                            ///< w

  [[nodiscard]] std::string name() const override { return "pose prior"; }
  /// Rows for residuals one by one; sums use none.
  [[nodiscard]] int num_rows() const override {
    return runs() ? static_cast<int>(3 * mixture->joints().size()) + 1 : 0;
  }
  void Add(FrameAccumulator* sums) const override;

 private:
  [[nodiscard]] bool runs() const { return mixture != nullptr && !mixture->empty() && weight > 0; }
  void AddOneByOne(const Eigen::VectorXd& x, int component, double energy, FrameAccumulator* sums) const;
};

std::vector<PlanEntry> PlanPosePrior(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::unique_ptr<ClipTerm> MakePosePriorTerms(const ClipTermInput& clip);

}  // namespace bodyloom
