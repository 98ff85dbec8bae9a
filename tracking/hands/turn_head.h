// SPDX-License-Identifier: Apache-2.0
/// Turns the head of a track whose body was fitted without its face, by the face's 68 points.
///
/// A mean face is laid onto the body's head at rest: by nose and eyes, then by the nearest vertices of the head, with a
/// rotation A, a scale and a translation. In an image the same mean face is laid onto the points (x, y and depth),
/// which gives the rotation S of the face about the viewing ray V: the head's axes are then turned to the camera's by
/// M = V S A. Points without depth, as other programs write them, get that of the mean face as it lies on them, in
/// rounds; those of the jaw are left out then, as they follow the outline in the image and not the bone. Unknown is h
/// in every frame, with the head's rotation R exp(h), R the body's. Residuals:
///   face    log(Mᵀ G exp(h)) / σ, Geman–McClure, G the head's rotation to the camera by the body
///   prior   h near 0, a process over time (steady_prior.h)
/// Neck and trunk stay as they are, byte for byte.
#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/hands_and_face.h"
#include "geometry/scene/track.h"
#include "tracking/hands/steady_prior.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

/// 68×3: x to the person's left, y down, z to the back of the head; the root mean square distance from the middle is 1.
/// The mean of 404 faces that the network found of two people (benchmarks/accuracy/mean_face.py), made symmetric.
const MatrixX3d& MeanFace();

/// A: from the axes of the body's head at rest to those of MeanFace(); none for a body without a joint "head" and the
/// landmarks nose, left_eye and right_eye.
std::optional<Eigen::Matrix3d> FaceFromHead(const BodyModel& body, const Eigen::VectorXd& betas);

/// True if the face's points have depth.
bool HasDepth(const FaceObservation& face);

/// V S: from the axes of MeanFace() to the camera's; none if too few points are known, or if they lie on no face.
/// `ray`: the direction to the head in the camera, of any length; z for weak perspective.
std::optional<Eigen::Matrix3d> CameraFromFace(const FaceObservation& face, const Eigen::Vector3d& ray);

/// log(Mᵀ G exp(h)) / σ, of h.
class HeadTurnCost : public ceres::SizedCostFunction<3, 3> {
 public:
  HeadTurnCost(const Eigen::Matrix3d& measured, const Eigen::Matrix3d& body, double sigma)
      : off_(measured.transpose() * body), sigma_(sigma) {}
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

 private:
  Eigen::Matrix3d off_;
  double sigma_;
};

struct HeadTurnOptions {
  double face_sigma = 0.08;  ///< radians, one axis: of a face that differs from the mean one, and of the body's head
  double flat_face_sigma = 0.1;                        ///< the same of a face without depth
  double kernel = 4;                                   ///< in standard deviations
  double errors_last_s = 0.15;                         ///< as of hands (hand_problem.h)
  SteadyPrior head = {.sigma = 0.3, .length_s = 0.4};  ///< radians
};

/// The reason why the head of this body cannot be turned by these observations, which may be null; "": it can.
std::string WhyNoHead(const BodyModel& body, const HandsAndFaceSequence* seen);

/// Changes the head's rotation, the places of joints beyond it, and the landmarks of the head among coco17. Throws
/// std::invalid_argument for another number of frames.
PartFitSummary TurnHead(const BodyModel& body, const HandsAndFaceSequence& seen, const std::vector<char>& cut_before,
                        const HeadTurnOptions& options, Track* track);

}  // namespace bodyloom
