// SPDX-License-Identifier: Apache-2.0
/// Perturbs a motion by a given projection error, to simulate the output of another system as initialisation.
#pragma once

#include <cstdint>

#include "geometry/body/body_model.h"
#include "geometry/scene/camera.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// Relative sizes; all are scaled together until the projection error matches.
struct PerturbationOptions {
  double root_rad = 0.12, spine_rad = 0.06, hip_rad = 0.16, knee_rad = 0.22, shoulder_rad = 0.25, elbow_rad = 0.28,
         end_rad = 0.15;
  double sideways_m = 0.02, depth_m = 0.15;  ///< translation across and along the view
  double shape = 0.3;                        ///< error of each beta
  double time_constant_s = 0.4;              ///< time constant of the errors' drift
  double constant_share = 0.5;               ///< share of each error's variance that is constant over the clip
};

/// Mean over frames and vertices of the distance between the projections of two motions in the camera frame, in pixels
/// of an image scaled so that its longer side has 512: e = mean ‖π(a) − π(b)‖ · 512 / max(width, height). Vertices that
/// do not project are left out.
double MeanProjectionError(const BodyModel& body, const Camera& camera, const Motion& a, const Motion& b,
                           int num_threads);

struct PerturbedMotion {
  Motion motion;
  double error_px = 0;  ///< as measured by MeanProjectionError
};

/// Returns `truth` (camera frame) with a smooth random error in every joint, the translation and the shape, of one
/// common size found by false position so that MeanProjectionError is target_px within 0.5 %. Same seed, same result.
/// Throws std::invalid_argument when target_px is not positive or so large that no error of joint angles reaches it.
PerturbedMotion PerturbMotion(const BodyModel& body, const Camera& camera, const Motion& truth, double target_px,
                              const PerturbationOptions& options, uint64_t seed, int num_threads);

}  // namespace bodyloom
