// SPDX-License-Identifier: Apache-2.0
/// User-defined terms of the tracker: a plain ceres::CostFunction (AutoDiff or analytic), with or without a
/// ceres::LossFunction. Add it to TrackSequenceOptions::user_terms; both engines run it and minimise the same cost:
///   ½ ρ(‖r(blocks)‖²)      ρ: the loss; without one ρ(s) = s
/// A list of inputs, of one frame or of several at any distance, defines the parameter blocks of the cost function:
///   landmark        3 numbers: its position, metres
///   surface point   3 numbers: the position of a face with barycentric coordinates, metres
///   rotation        9 numbers: the 3×3 matrix of a joint, row by row, that takes the joint's axes to its parent's, the
///                   root's to the camera's; the identity is the T-pose
///   translation     3 numbers: metres (weak perspective: log scale, tx, ty)
///   betas           as many numbers as shape components are estimated (10, or all of a body that has fewer)
///   focal length    1 number, pixels; a constant if it is known
/// A term of one frame is in the axes of that frame's camera. A term of several frames is in those of the track: the
/// camera's or, for a moving camera, the scene's (moving_camera.h). For weak perspective the body is at the distance
/// for a pinhole of the layout's focal length (FrameLayout::BodyPlace).
///
/// A cost function returns its derivatives by these numbers, as Ceres requests them; the tracker applies the chain rule
/// to increments on SO(3), to translation, shape and the logarithm of the focal length. Rotations are matrices rather
/// than axis-angles because a person who faces the camera has a root rotation near π, where axis-angles are
/// discontinuous. Evaluate() is called from several threads; false, or a number that is not finite, rejects the step.
///
/// Landmarks, surface points and joints that a term reads count as observed: their joints are estimated. In coarse
/// stages a term of several frames is used only if all of them are selected. Live tracking runs terms of one frame.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"

namespace ceres {
class CostFunction;
class LossFunction;
}  // namespace ceres

namespace bodyloom {

/// One parameter block of a user's cost function. `later`: number of frames, 0 or more, from the frame of the cost
/// function to the frame of the block.
struct TermInput {
  enum class Kind { kLandmark, kSurfacePoint, kRotation, kTranslation, kBetas, kFocalLength };
  Kind kind = Kind::kTranslation;
  std::string landmark;
  SurfacePoint point;
  int joint = -1;
  int later = 0;

  static TermInput Landmark(std::string name, int later = 0);  ///< as "left_wrist"
  static TermInput Surface(const SurfacePoint& point, int later = 0);
  static TermInput Rotation(int joint, int later = 0);
  static TermInput Translation(int later = 0);
  static TermInput Betas();
  static TermInput FocalLength();
};

struct UserTerm {
  /// The cost function of frame t, or null for none. Called for every frame t whose later frames exist and, unless
  /// across_cuts, continue it.
  using CostOfFrame = std::function<std::shared_ptr<const ceres::CostFunction>(int t)>;

  std::string name;                    ///< in plan, table of costs and errors
  std::vector<TermInput> inputs = {};  ///< one a parameter block, in its order
  CostOfFrame cost = nullptr;
  std::shared_ptr<ceres::LossFunction> loss = nullptr;  ///< null: none
  bool across_cuts = false;                             ///< also on frames with a cut between them

  [[nodiscard]] bool is_of_one_frame() const;
};

/// Throws std::invalid_argument, in one line that names the term, when it has no cost function or no inputs, a negative
/// `later`, or a landmark, a face or a joint that the body does not have.
void CheckUserTerm(const UserTerm& term, const BodyModel& model);

}  // namespace bodyloom
