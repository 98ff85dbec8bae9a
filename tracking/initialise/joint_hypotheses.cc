// SPDX-License-Identifier: Apache-2.0
#include "tracking/initialise/joint_hypotheses.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/base/check.h"
#include "tracking/initialise/joint_rays.h"
#include "tracking/initialise/limb_costs.h"
#include "tracking/initialise/swap_repair.h"

namespace bodyloom {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using namespace hypotheses_internal;  // NOLINT(google-build-using-namespace)

namespace {

/// The frames used, and the two searches over them.
class ClipHypotheses {
 public:
  ClipHypotheses(std::vector<Rays> rays, std::vector<double> times, const Lengths& lengths, const PosePrior* prior,
                 const JointHypothesesOptions& options)
      : rays_(std::move(rays)),
        times_(std::move(times)),
        lengths_(lengths),
        options_(options),
        depth_(RootDepths(rays_, times_, lengths)),
        limb_costs_(prior, lengths, options) {}

  /// Camera-from-torso of every frame; adds their cost.
  std::vector<Matrix3d> ChooseTorsos(double* cost) const {
    const size_t T = rays_.size();
    std::vector<std::vector<TorsoState>> states(T);
    std::vector<std::vector<double>> unary(T);
    for (size_t t = 0; t < T; ++t) {
      states[t] = TorsoStates(rays_[t], depth_[t], lengths_, options_);
      for (TorsoState& state : states[t]) {
        AddBestLimbs(t, &state);
        unary[t].push_back(state.cost);
      }
    }
    const std::vector<int> path = Viterbi(unary, [&](size_t t, int a, int b) {
      const double dt = times_[t] - times_[t - 1];
      const double cosine = ((states[t - 1][a].rotation.cwiseProduct(states[t][b].rotation)).sum() - 1) / 2;
      const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
      const double z = angle / (options_.angular_speed * dt);
      return Saturated(z * z, 25) * 0.5;
    });
    std::vector<Matrix3d> torso(T);
    for (size_t t = 0; t < T; ++t) {
      torso[t] = states[t][path[t]].rotation;
      *cost += unary[t][path[t]];
    }
    return torso;
  }

  /// Torso and head of every frame; limbs are not known yet.
  [[nodiscard]] std::vector<JointHypothesis> Torsos(const std::vector<Matrix3d>& torso) const {
    std::vector<JointHypothesis> hypotheses(rays_.size());
    for (size_t t = 0; t < rays_.size(); ++t) {
      JointHypothesis& hypothesis = hypotheses[t];
      hypothesis.points.setConstant(17, 3, std::numeric_limits<double>::quiet_NaN());
      hypothesis.torso_rotation = torso[t];
      hypothesis.depth = depth_[t];
      for (int l = 0; l < 4; ++l) hypothesis.points.row(kLimbs[l][0]) = StartOfLimb(t, torso[t], l).transpose();
      const double head_depth = (hypothesis.points(kLeftShoulder, 2) + hypothesis.points(kRightShoulder, 2)) / 2;
      for (int k = 0; k < 5; ++k) {
        if (rays_[t].seen[k])
          hypothesis.points.row(k) << rays_[t].ray[k].x() * head_depth, rays_[t].ray[k].y() * head_depth, head_depth;
      }
    }
    return hypotheses;
  }

  /// One limb over the clip, given the torsos.
  void ChooseLimb(int limb, const std::vector<Matrix3d>& torso, std::vector<JointHypothesis>* hypotheses) const {
    std::vector<size_t> steps;
    for (size_t t = 0; t < rays_.size(); ++t) {
      if (limb_costs_.Usable(rays_[t], limb)) steps.push_back(t);
    }
    if (steps.empty()) return;
    std::vector<std::array<Vector3d, 4>> middles(steps.size()), ends(steps.size());
    std::vector<std::vector<double>> unary(steps.size());
    for (size_t i = 0; i < steps.size(); ++i) {
      const size_t t = steps[i];
      const Vector3d start = StartOfLimb(t, torso[t], limb), centre = CentreOf(t, torso[t]);
      limb_costs_.Hypotheses(rays_[t], limb, start, middles[i].data(), ends[i].data());
      for (int h = 0; h < 4; ++h) {
        unary[i].push_back(limb_costs_.Cost(rays_[t], limb, torso[t], centre, start, middles[i][h], ends[i][h]));
        // Transitions compare positions relative to the limb's start, so that the root's motion does not count.
        middles[i][h] -= start;
        ends[i][h] -= start;
      }
    }
    const std::vector<int> path = Viterbi(unary, [&](size_t i, int a, int b) {
      const double sigma = options_.limb_speed * (times_[steps[i]] - times_[steps[i - 1]]);
      const double z2 =
          ((middles[i][b] - middles[i - 1][a]).squaredNorm() + (ends[i][b] - ends[i - 1][a]).squaredNorm()) /
          (sigma * sigma);
      return 0.5 * Saturated(z2, 25);
    });
    for (size_t i = 0; i < steps.size(); ++i) {
      JointHypothesis& hypothesis = (*hypotheses)[steps[i]];
      const Vector3d start = hypothesis.points.row(kLimbs[limb][0]).transpose();
      hypothesis.points.row(kLimbs[limb][1]) = (start + middles[i][path[i]]).transpose();
      hypothesis.points.row(kLimbs[limb][2]) = (start + ends[i][path[i]]).transpose();
    }
  }

 private:
  [[nodiscard]] Vector3d StartOfLimb(size_t t, const Matrix3d& torso, int limb) const {
    // The torso is a rigid plate whose centre lies on the mean ray at the root's depth.
    Vector2d centre_ray = Vector2d::Zero();
    for (int k : kTorso) centre_ray += rays_[t].ray[k] / 4;
    const Vector3d centre(centre_ray.x() * depth_[t], centre_ray.y() * depth_[t], depth_[t]);
    const Vector3d offset = torso * (lengths_.rest.row(kLimbs[limb][0]).transpose() - Centroid(lengths_.rest, kTorso));
    // Across the view the observed ray is used, for the depth the rigid torso.
    const double z = centre.z() + offset.z();
    const Vector2d& ray = rays_[t].ray[kLimbs[limb][0]];
    return {ray.x() * z, ray.y() * z, z};
  }

  [[nodiscard]] Vector3d CentreOf(size_t t, const Matrix3d& torso) const {
    Vector3d sum = Vector3d::Zero();
    for (int l = 0; l < 4; ++l) sum += StartOfLimb(t, torso, l) / 4;
    return sum;
  }

  /// Cost of the best limb hypotheses, given the torso.
  void AddBestLimbs(size_t t, TorsoState* state) const {
    const Vector3d centre = CentreOf(t, state->rotation);
    for (int limb = 0; limb < 4; ++limb) {
      if (!limb_costs_.Usable(rays_[t], limb)) continue;
      Vector3d middle[4], end[4];
      const Vector3d start = StartOfLimb(t, state->rotation, limb);
      limb_costs_.Hypotheses(rays_[t], limb, start, middle, end);
      double best = std::numeric_limits<double>::infinity();
      for (int h = 0; h < 4; ++h) {
        best = std::min(best, limb_costs_.Cost(rays_[t], limb, state->rotation, centre, start, middle[h], end[h]));
      }
      state->cost += best;
    }
  }

  std::vector<Rays> rays_;
  std::vector<double> times_;
  const Lengths& lengths_;
  const JointHypothesesOptions& options_;
  std::vector<double> depth_;
  LimbCosts limb_costs_;
};

}  // namespace

bool TorsoFrame(const MatrixX3d& p, Matrix3d* rotation) {
  const Vector3d up = (p.row(kLeftShoulder) + p.row(kRightShoulder) - p.row(kLeftHip) - p.row(kRightHip)).transpose();
  const Vector3d left = (p.row(kLeftShoulder) - p.row(kRightShoulder) + p.row(kLeftHip) - p.row(kRightHip)).transpose();
  const Vector3d y = up.normalized();
  const Vector3d x = left - y * y.dot(left);
  if (!(up.norm() > 1e-6) || !(x.norm() > 1e-6)) return false;
  rotation->col(0) = x.normalized();
  rotation->col(1) = y;
  rotation->col(2) = rotation->col(0).cross(y);
  return true;
}

JointHypothesesResult FindJointHypotheses(const KeypointSequence& keypoints, const Camera& camera,
                                          const MatrixX3d& rest_points, const PosePrior* prior,
                                          const JointHypothesesOptions& options) {
  BODYLOOM_CHECK(rest_points.rows() == 17, "joint hypotheses: ", rest_points.rows(), " rest points, expected 17");
  const Lengths lengths(rest_points);
  JointHypothesesResult result;
  // Frames for the trellis: about frame_rate a second, and only those that show a torso.
  std::vector<double> times;
  double next = -std::numeric_limits<double>::infinity();
  std::vector<int> candidates;
  for (int t = 0; t < keypoints.num_frames(); ++t) {
    if (keypoints.timestamps[t] < next - 1e-9) continue;
    const Rays rays = RaysOfFrames(keypoints, camera, {t}, options)[0];
    if (!rays.has_torso()) continue;
    candidates.push_back(t);
    times.push_back(keypoints.timestamps[t]);
    next = keypoints.timestamps[t] + 1 / options.frame_rate;
  }
  if (candidates.empty()) return result;
  result.frames = candidates;
  const ClipHypotheses clip(RaysOfFrames(keypoints, camera, candidates, options), times, lengths, prior, options);
  const std::vector<Matrix3d> torso = clip.ChooseTorsos(&result.cost);
  result.hypotheses = clip.Torsos(torso);
  for (int limb = 0; limb < 4; ++limb) clip.ChooseLimb(limb, torso, &result.hypotheses);
  return result;
}

}  // namespace bodyloom
