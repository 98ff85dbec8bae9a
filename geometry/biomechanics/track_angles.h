// SPDX-License-Identifier: Apache-2.0
/// Joint angles of a track over time, with standard deviations where the track's own determine them.
#pragma once

#include <vector>

#include "geometry/biomechanics/joint_angles.h"
#include "geometry/body/body_model.h"
#include "geometry/math/arrays.h"
#include "geometry/scene/track.h"
#include "geometry/scene/world_frame.h"

namespace bodyloom {

/// T frames of the coordinates of geometry/biomechanics/joint_angles.h, CoordinateNames() in order.
struct TrackAngles {
  std::vector<double> timestamps;  ///< T: the track's, seconds
  RowMatrixXd values;              ///< T×kNumCoordinates: degrees, metres for pelvis_t*; NaN where the frame is lost
  /// T×kNumCoordinates, degrees: standard deviations; NaN where the track's joint_sigma determine none.
  RowMatrixXd sigma_deg;
};

/// Angles of the track's poses in `world`, continuous within each stretch without lost frames.
///
/// A track has standard deviations σ of the joints' positions about the middle of the hips (joint_sigma), not of their
/// rotations. They are carried to the angles that positions determine, to first order, as if the joints' errors were
/// independent and equal along all axes. With segments of length u and v that meet at the joint p, b and c at their
/// other ends, and û, v̂ the directions in their plane, perpendicular to each, in which the angle between them grows:
///   knee_angle, elbow_flex      σ² = σ_b²/u² + σ_c²/v² + σ_p² ‖û/u + v̂/v‖²
/// and for a thigh or upper arm of length u from p to b against the trunk, the axis of length w from the middle of the
/// hips to the chest (spine3), which stands in for the pelvis, whose own tilt positions do not determine:
///   hip_adduction, arm_add      σ² = (σ_p² + σ_b²)/u² + σ_chest²/w²
///   hip_flexion, arm_flex       the same / |cos of the adduction|: the angle is undetermined at 90°
/// Errors that joints share, as of a whole limb's depth, and the body's own deviation from the person are not in it.
///
/// Throws std::invalid_argument for a body without the joints (HasJointAngles()) or a track with more joints than it.
TrackAngles AnglesOfTrack(const BodyModel& body, const Track& track, const WorldFrame& world,
                          PelvisOrder order = PelvisOrder::kRotationFirst);

/// Posed skeleton of frame t in `world`; the frame has a pose.
PosedSkeleton SkeletonInWorld(const BodyModel& body, const MatrixX3d& rest_joints, const Motion& motion, int t,
                              const WorldFrame& world);

}  // namespace bodyloom
