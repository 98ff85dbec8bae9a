// SPDX-License-Identifier: Apache-2.0
/// A user's own term of the tracker: a plain ceres::CostFunction (AutoDiff or analytic), with or without a
/// ceres::LossFunction. Add it to TrackSequenceOptions::user_terms; both engines run it and minimise the same cost:
///   ½ ρ(‖r(blocks)‖²)      ρ: the loss; without one ρ(s) = s
/// What the parameter blocks of the cost function hold is said by a list of inputs, of one frame or of several, any
/// distance apart:
///   landmark        3 numbers: its position, metres
///   surface point   3 numbers: the position of a face with barycentric coordinates, metres
///   rotation        9 numbers: the 3×3 matrix of a joint, row by row, that takes the joint's axes to its parent's, the
///                   root's to the camera's; the identity is the T-pose
///   translation     3 numbers: metres (weak perspective: log scale, tx, ty)
///   betas           as many numbers as shape components are estimated (10, or all of a body that has fewer)
///   focal length    1 number, pixels; a constant where it is known
/// A term of one frame is in the axes of that frame's camera. One of several frames is in those of the track: the
/// camera's, or where the camera moves the scene's (moving_camera.h). For weak perspective the body stands as far away
/// as a pinhole of the layout's focal length would have it (FrameLayout::BodyPlace).
///
/// A cost function gives its derivatives by these numbers, as Ceres requests them; the chain rule to increments on
/// SO(3), to translation, shape and the logarithm of the focal length is the tracker's. A rotation matrix is read
/// rather than an axis-angle because a person who faces the camera has a root near π, where axis-angles jump.
/// Evaluate() is called from several threads; false, or a number that is not finite, rejects the step.
///
/// Landmarks, surface points and joints that a term reads count as observed: their joints are estimated. Where a clip
/// is solved coarsely first, a term of several frames takes part in the stages that have all of them. Live tracking
/// runs terms of one frame.
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

/// What one parameter block of a user's cost function holds. `later`: of the frame that comes this many frames after
/// the one for which the term gives its cost function; 0 or more.
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
  /// The cost function of frame t, or null: none there. Asked for every frame t whose later frames are there and,
  /// unless across_cuts, continue it.
  using CostOfFrame = std::function<std::shared_ptr<const ceres::CostFunction>(int t)>;

  std::string name;                    ///< in plan, table of costs and errors
  std::vector<TermInput> inputs = {};  ///< one a parameter block, in its order
  CostOfFrame cost = nullptr;
  std::shared_ptr<ceres::LossFunction> loss = nullptr;  ///< null: none
  bool across_cuts = false;                             ///< also on frames with a cut between them

  [[nodiscard]] bool is_of_one_frame() const;
};

/// Throws std::invalid_argument, in one line that names the term, when it has no cost function, reads nothing, looks
/// back, or names a landmark, a face or a joint that the body does not have.
void CheckUserTerm(const UserTerm& term, const BodyModel& model);

}  // namespace bodyloom
