// SPDX-License-Identifier: Apache-2.0
/// Refines the poses of a clip by its images: backpropagates from bones to poses and corrects the track.
///
/// A correction d of a frame rotates every joint and translates the body in the camera's frame, relative to the track:
///   R_j = R_j(track) exp([d_j]×),   trans = trans(track) + d_J
/// Its prior cost is, with the joints' Jacobian P at the track's pose, σ_j the track's uncertainty of a joint's
/// position perpendicular to the view, n the number of jointly erring joints, and σ_a the prior deviation of a
/// rotation,
///   M = Pᵀ diag(1/(n σ_j²)) P + diag(1/σ_a²) over the rotations,
///   cost = ½ dᵀ M d + ½ Σ over the neighbouring frames s (d − d_s)ᵀ M (d − d_s) / drift²
/// The image is weighted by its error: blocks of 8×8 of the person's pixels have independent errors photo_sigma,
///   energy = person pixels/64 · loss/photo_sigma + cost
/// The track's priors thus remain in effect through the prior cost. A track's joint_sigma is relative to the mid-hip
/// and isotropic; perpendicular to the view it is across_share of that. The distance from the camera (root_sigma) is
/// not used: a single camera does not observe it, and its error is common to all frames.
///
/// A step follows M⁻¹ d energy/d d as in Adam: the mean of past directions, divided by the root of the mean of their
/// squared lengths in M, times `rate`; this is independent of the parametrisation of rotations. Where the images give
/// no derivative a track stays as it is, byte for byte.
///
/// The pose correctives of the skin are constant in the derivative (render/gaussian_avatar/pose_gradient.h), and follow
/// the corrected pose in rendering.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/body/posed_body.h"
#include "geometry/scene/track.h"
#include "render/gaussian_avatar/avatar_frame.h"
#include "render/splat/float_columns.h"

namespace bodyloom {

/// The track's pose of a frame, in the camera's frame.
struct TrackedPose {
  BodyPose pose;                    ///< without rotations: none
  std::vector<double> joint_sigma;  ///< J, metres, about the mid-hip, one axis; empty or NaN: not known
};

struct PoseRefinerOptions {
  double photo_sigma = 0.1;         ///< 1e-4 to 1e4: standard deviation of a block of pixels, white is 1
  double place_sigma_m = 0.02;      ///< 1e-4 to 10: σ_j of a joint whose joint_sigma is not known
  double across_share = 0.6;        ///< 1e-3 to 10: factor of joint_sigma, for a track of one camera
  double joints_together = 8;       ///< 1 to 1000
  double turn_sigma_deg = 8;        ///< 0.01 to 180
  double drift = 0.5;               ///< 1e-3 to 1e6
  double rate = 2, rate_end = 0.1;  ///< 0 to 100: standard deviations per step, initial and final
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// Learned corrections, one row per frame of the clip, with the state of the optimiser.
struct PoseCorrections {
  FloatColumns values;         ///< T × (3J + 3): rotations d_j, radians, then translation, metres
  FloatColumns mean;           ///< of the steps' directions
  std::vector<float> square;   ///< T: mean of their squared lengths
  std::vector<int32_t> steps;  ///< T
  /// Sets zeros.
  void Reset(int num_frames, int num_joints);
  [[nodiscard]] bool IsZero(int frame) const;
};

/// May be shared by threads. The model must outlive it.
class PoseRefiner {
 public:
  /// Throws std::invalid_argument for options that are not valid, and poses or sigmas of another body.
  PoseRefiner(const BodyModel& model, const Eigen::VectorXd& betas, std::vector<TrackedPose> poses,
              const PoseRefinerOptions& options);

  [[nodiscard]] int num_frames() const { return static_cast<int>(poses_.size()); }
  [[nodiscard]] int num_joints() const { return model_.num_joints(); }
  [[nodiscard]] BodyPose PoseAt(int frame, const PoseCorrections& corrections) const;
  void MakeFrame(int frame, const PoseCorrections& corrections, int num_threads, AvatarFrame* to) const;

  /// d loss / d correction of a frame, 3J + 3, from the bones of AvatarGradient in the frame that MakeFrame() made.
  /// Bones of cloth, after the joints', are left out.
  [[nodiscard]] Eigen::VectorXd ByCorrection(int frame, const std::vector<float>& by_bones,
                                             const PoseCorrections& corrections) const;

  /// Performs one step for a frame with a pose. `by_bones`: as for ByCorrection(); `person_pixels`: of the truth;
  /// `progress` in [0, 1]: the rate decays exponentially to rate_end. Derivatives that are not finite change nothing.
  void Step(int frame, const std::vector<float>& by_bones, double person_pixels, double progress,
            PoseCorrections* corrections) const;

 private:
  [[nodiscard]] Eigen::MatrixXd Metric(int frame) const;

  const BodyModel& model_;
  MatrixX3d rest_joints_;
  AvatarFrames frames_;
  std::vector<TrackedPose> poses_;
  PoseRefinerOptions options_;
};

// Converts a track to poses for refinement, and back.

/// One per frame; without rotations where the track has no result.
std::vector<TrackedPose> TrackedPoses(const BodyModel& body, const Track& track);

/// The track with corrected poses, positions, joints and landmarks; all else, and the axis-angle of every joint without
/// correction, stays byte for byte. joint_sigma stays the track's own. `refiner` must be built from TrackedPoses() of
/// this track.
Track RefinedTrack(const BodyModel& body, const Track& track, const PoseRefiner& refiner,
                   const PoseCorrections& corrections);

}  // namespace bodyloom
