// SPDX-License-Identifier: Apache-2.0
/// Poses of a clip that are corrected by its pictures: the way from derivatives by the bones to a better track.
///
/// A correction d of a frame turns every joint and moves the body in the camera's frame, relative to the track:
///   R_j = R_j(track) exp([d_j]×),   trans = trans(track) + d_J
/// What it costs, in standard deviations squared: with the joints' Jacobian P at the track's pose, σ_j how well the
/// track knows a joint's place across the view, n joints that err together, and σ_a how far a turn may go by itself,
///   M = Pᵀ diag(1/(n σ_j²)) P + diag(1/σ_a²) over the turns,
///   cost = ½ dᵀ M d + ½ Σ over the frames s beside it (d − d_s)ᵀ M (d − d_s) / drift²
/// and the picture counts as its own error tells: blocks of 8×8 of the person's pixels that each err by photo_sigma,
///   energy = person pixels/64 · loss/photo_sigma + cost
/// So the track's priors stay: it was found with them, and here it is left only for what the picture shows. A track's
/// joint_sigma is about the mid-hip and of all three axes alike; across the view it is across_share of that. How far
/// the person is from the camera (root_sigma) is not asked: one camera does not see it, and it is the same in all
/// frames.
///
/// A step goes along M⁻¹ d energy/d d, in Adam's manner: the mean of the last ones, divided by the root of the mean of
/// their squared lengths in M, times `rate`; so nothing depends on how a joint's turns are counted. Where the pictures
/// pull nowhere a track stays as it is, byte for byte.
///
/// The pose correctives of the skin are taken as given in the derivative (render/gaussian_avatar/pose_gradient.h), and
/// follow the corrected pose when it is drawn.
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

/// A frame of the clip as the track has it, in the camera's frame.
struct TrackedPose {
  BodyPose pose;                    ///< without rotations: none
  std::vector<double> joint_sigma;  ///< J, metres, about the mid-hip, one axis; empty or NaN: not known
};

struct PoseRefinerOptions {
  double photo_sigma = 0.1;         ///< 1e-4 to 1e4: by how much a block of pixels is off, white is 1
  double place_sigma_m = 0.02;      ///< 1e-4 to 10: σ_j of a joint whose joint_sigma is not known
  double across_share = 0.6;        ///< 1e-3 to 10: of joint_sigma, of a track of one camera
  double joints_together = 8;       ///< 1 to 1000
  double turn_sigma_deg = 8;        ///< 0.01 to 180
  double drift = 0.5;               ///< 1e-3 to 1e6
  double rate = 2, rate_end = 0.1;  ///< 0 to 100: standard deviations a step, at the begin and at the end
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// What is learned, a row a frame of the clip, and what goes on with it.
struct PoseCorrections {
  FloatColumns values;         ///< T × (3J + 3): turns d_j, radians, then metres
  FloatColumns mean;           ///< of the steps' directions
  std::vector<float> square;   ///< T: mean of their squared lengths
  std::vector<int32_t> steps;  ///< T
  /// Zeros.
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

  /// One step of a frame that has a pose, by the same.
  /// `person_pixels`: of the truth; `progress` in [0, 1]: the rate goes exponentially to its end. Derivatives that are
  /// not finite move nothing.
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

// A track as poses that pictures correct (render/gaussian_avatar/learning/pose_refiner.h), and back.

/// One a frame; without rotations where the track has no result.
std::vector<TrackedPose> TrackedPoses(const BodyModel& body, const Track& track);

/// The track with its corrected frames' poses, places, joints and landmarks; all else, and every joint's axis-angle
/// that has no correction, stays byte for byte. joint_sigma stays the track's own. `refiner` was made of TrackedPoses()
/// of this track.
Track RefinedTrack(const BodyModel& body, const Track& track, const PoseRefiner& refiner,
                   const PoseCorrections& corrections);

}  // namespace bodyloom
