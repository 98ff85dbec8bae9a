// SPDX-License-Identifier: Apache-2.0
/// Dense keypoints, L_f of paper A: the reprojection error of surface points.
///   ½ Σ_k w ρ(‖W_k (π(x_k) − y_k)‖²)      ρ: Geman–McClure with c = `kernel`
/// x_k: face and barycentric coordinates of the detection, posed, camera frame, metres; W_k = I/σ_k, or the inverse
/// root of the keypoint's covariance (dense_whitening.h), 1/px. Keypoints that another term uses (`taken`) are
/// excluded. w = 1, or the number that each of the evenly chosen keypoints represents (FrameAccumulator::max_points;
/// frames with `taken` use all). Points that cannot be projected cost c²/2 and are counted. Many points share few
/// joints, so their normal equations are summed by set of joints (dense_points.h). Runs when the input has dense
/// keypoints.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/observations.h"
#include "tracking/problem/body_points.h"
#include "tracking/problem/frame_term.h"

namespace bodyloom {

class ClipTerm;
struct ClipTermInput;
struct PlanEntry;
struct TrackSequenceInput;
struct TrackSequenceOptions;

/// Whitening of a dense keypoint's error in the image (dense_whitening.h).
struct DenseWhitening {
  Eigen::Matrix2d whitening;    ///< W, 1/px
  Eigen::Matrix2d pixel_by_uv;  ///< M = ∂pixel/∂(u, v) at the label, pixels a chart; zero where there is none
};

class DenseTerm : public CopyableTerm<DenseTerm> {
 public:
  const std::vector<DenseKeypoint>* points = nullptr;  ///< borrowed; null: none
  std::vector<DenseWhitening> whitening;               ///< one a keypoint, or empty: I/sigma_px
  const std::vector<char>* taken = nullptr;            ///< by keypoint: evaluated by another term; null: none
  double kernel = 4;                                   ///< c, in σ

  [[nodiscard]] size_t size() const { return points != nullptr ? points->size() : 0; }
  [[nodiscard]] std::string name() const override { return "dense keypoints"; }
  [[nodiscard]] bool is_empty() const override { return size() == 0; }
  [[nodiscard]] bool is_compressed() const override { return true; }
  void Add(FrameAccumulator* sums) const override;
};

/// Appends |π(x) − y|, pixels, of each keypoint that projects. `vertices`: of this frame's kinematics.
void AppendDenseErrors(const std::vector<DenseKeypoint>& keypoints, const Camera& camera, const Kinematics& kinematics,
                       PointEvaluator::VertexCache* vertices, std::vector<double>* errors_px);

std::vector<PlanEntry> PlanDense(const TrackSequenceInput& input, const TrackSequenceOptions& options);
std::unique_ptr<ClipTerm> MakeDenseTerms(const ClipTermInput& clip);

}  // namespace bodyloom
