// SPDX-License-Identifier: Apache-2.0
/// Standard deviations of a camera's path in frames in which no background was seen: blank walls, blur.
///
/// Between poses at t0 and t1, T = t1 − t0 > 0.25 s, the pose at t is interpolated, and its deviation is
///   σ² = ((1 − u) σ0 + u σ1)² + (a τ (T − τ) / 2)²       τ = t − t0, u = τ / T
/// with a the acceleration, rms along an axis, that would leave the errors which interpolation over stretches of T has
/// in the parts of the path that are seen:
///   a² = Σ ‖e‖²/3 / Σ (τ (T − τ) / 2)²
/// So it is that of the camera's own motion over such times; if no seen part lasts for T, over the longest of T/2, T/4,
/// … that it lasts for. Where nothing is told of it, a is that which goes the path's extent and back within T. A camera
/// that moves more where it is not seen is not foreseen. Poses nearer than 0.25 s are of a camera that rests (frames
/// are passed over) or of one that was seen all along: the second term is 0. Before the first pose and after the last
/// one σ is that pose's.
#pragma once

#include <span>
#include <vector>

#include "geometry/scene/camera_path.h"

namespace bodyloom {

struct PoseSigmas {
  std::vector<double> rad;    ///< of each rotation, standard deviation about an axis
  std::vector<double> place;  ///< of each centre along an axis; empty for a camera that turns in place
};

/// σ at these moments, seconds, rising, of a path whose poses have the deviations `of_poses`. Throws
/// std::invalid_argument for a path without poses or numbers that differ.
PoseSigmas SigmasAt(std::span<const double> timestamps, const CameraPath& path, const PoseSigmas& of_poses);

}  // namespace bodyloom
