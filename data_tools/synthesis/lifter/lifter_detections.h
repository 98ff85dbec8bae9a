// SPDX-License-Identifier: Apache-2.0
/// Simulates detections of a lifter's training scene: confidences that depend on occlusion, noise that depends on them,
/// missing points and left–right swaps.
///
/// Confidence: the typical value of the landmark (face: by the direction of the head), × 0.16 where the trunk (three
/// capsules between shoulders and hips, radius 9–13 cm) or a leg (radius 7 cm) lies more than 9 cm in front of it,
/// softened over 3 cm; × 0.85 for a shoulder or hip that is turned away by more than 10 cm; plus its slow drift. Noise:
/// data_tools/synthesis/clips/detection_noise.h, in person heights (1.3 Lref) at the person's distance. Then swaps, the
/// detector's own scale of confidence, points that it does not have or report, and the image border.
#pragma once

#include "data_tools/synthesis/lifter/lifter_scene.h"
#include "data_tools/synthesis/lifter/lifter_window_options.h"
#include "geometry/base/hash_random.h"

namespace bodyloom {

/// Rays by the true focal length; focal_known is left false. The same seed draws the same confidences for every
/// options.noise.
LifterFrames DetectScene(const LifterScene& scene, const LifterWindowOptions& options, uint64_t seed);

}  // namespace bodyloom
