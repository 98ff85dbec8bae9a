// SPDX-License-Identifier: Apache-2.0
/// A user's own term of the tracker: a plain ceres::CostFunction (AutoDiff or analytic), with or without a
/// ceres::LossFunction. Add it to TrackSequenceOptions::own_terms; both engines run it and minimise the same cost:
///   ½ ρ(‖r(blocks)‖²)      ρ: the loss; without one ρ(s) = s
/// The parameter blocks of the cost function are, by what the term reads,
///   landmarks    of one frame: for each landmark its position in the camera frame, metres (3 numbers). For weak
///                perspective the body stands as far away as a pinhole of the layout's focal length would have it
///                (FrameLayout::BodyPlace)
///   pose         of one frame: the translation (3 numbers: metres, camera frame; weak perspective: log scale, tx, ty)
///                when it is wanted, then for each joint its rotation (9 numbers: the 3×3 matrix row by row, that takes
///                the joint's axes to its parent's, the root's to the camera's; the identity is the T-pose)
///   neighbours   the landmarks of frame t, then the same landmarks of frame t + 1, 3 numbers each; never across a cut
/// A cost function gives its derivatives by these numbers, as Ceres requests them; the chain rule to increments on
/// SO(3), to translation and to the shape is the tracker's. A rotation matrix is read rather than an axis-angle because
/// a person who faces the camera has a root near π, where axis-angles jump. Evaluate() is called from several threads;
/// false, or a number that is not finite, rejects the step.
///
/// Landmarks and joints that a term reads count as observed: their joints are estimated. Where a clip is solved
/// coarsely first, terms on neighbours take part in the stages that have both frames. Live tracking has no own terms.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bodyloom/geometry/body_model.h"

namespace ceres {
class CostFunction;
class LossFunction;
}  // namespace ceres

namespace bodyloom {

struct OwnTerm {
  enum class Reads { kLandmarks, kPose, kNeighbours };
  /// Frame t's cost function, or null: none there. For kNeighbours that of frames t and t + 1.
  using CostOfFrame = std::function<std::shared_ptr<const ceres::CostFunction>(int t)>;

  std::string name;  ///< in plan, summary and errors
  Reads reads = Reads::kLandmarks;
  std::vector<std::string> landmarks;  ///< kLandmarks, kNeighbours: names of the body's landmarks, as "left_wrist"
  bool translation = false;            ///< kPose: the translation is the first block
  std::vector<int> joints;             ///< kPose: indices of the body's joints
  CostOfFrame cost;
  std::shared_ptr<ceres::LossFunction> loss;  ///< null: none

  static OwnTerm OnLandmarks(std::string name, std::vector<std::string> landmarks, CostOfFrame cost,
                             std::shared_ptr<ceres::LossFunction> loss = nullptr);
  static OwnTerm OnPose(std::string name, bool translation, std::vector<int> joints, CostOfFrame cost,
                        std::shared_ptr<ceres::LossFunction> loss = nullptr);
  static OwnTerm OnNeighbours(std::string name, std::vector<std::string> landmarks, CostOfFrame cost,
                              std::shared_ptr<ceres::LossFunction> loss = nullptr);
};

/// Throws std::invalid_argument, in one line that names the term, when it has no cost function, reads nothing, or names
/// a landmark or a joint that the body does not have.
void CheckOwnTerm(const OwnTerm& term, const BodyModel& model);

}  // namespace bodyloom
