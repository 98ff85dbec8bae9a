// SPDX-License-Identifier: Apache-2.0
/// Makes a clip with known truth: simulated detections of a body's motion in a camera, with faults of given size.
///
/// Dense keypoints: pixels of the visible body, drawn uniformly without repetition among those that the visibility
/// buffer covers; each is labelled with the surface point under its centre. Faults, in this order:
///   1. missing parts: each chart vanishes for intervals (`missing_part_share` of the time on average);
///   2. UV noise: (u, v) += N(0, uv_sigma²) in chart units, on the surface point, the pixel stays;
///   3. quantisation: u → ⌊255 u⌋/255, v alike, as 8-bit IUV images hold it (bias −0.5/255);
///      after 2 and 3 the label is the surface point of the same chart nearest to the changed (u, v);
///   4. outliers: a label is replaced by a random point of the surface (uniform by area) with `outlier_probability`;
///   5. pixel noise: pixel += N(0, pixel_sigma_px²) on each coordinate.
///   sigma_px of a keypoint is the image error due to these faults: √(pixel_sigma² + ½ (uv_sigma² + q²/12)
///   ‖M‖²_F), q = 1/255 when quantised, M = d(pixel)/d(u, v) at the label, at least min_sigma_px; the sequence's
///   uv_sigma and pixel_sigma_px are its components; outliers are not marked.
/// 2D landmarks: detection_noise.h. Whole frames are dropped in runs (`dropped_frame_share`). Frames are independent:
/// the clip is the same for any number of threads, and the same bytes for the same seed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "data_tools/synthesis/clips/detection_noise.h"
#include "data_tools/synthesis/clips/perturbed_motion.h"
#include "data_tools/synthesis/clips/synth_camera.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct DenseFaultOptions {
  double pixel_sigma_px = 0;
  double uv_sigma = 0;       ///< chart units
  bool quantise_uv = false;  ///< 8 bits, rounded down
  double outlier_probability = 0;
  double missing_part_share = 0;      ///< share of the time for which each part is missing
  double missing_part_seconds = 0.5;  ///< mean length of an absence
  double min_sigma_px = 0.3;
};

struct SynthClipOptions {
  uint64_t seed = 1;
  SynthCameraOptions camera;
  SynthCameraPathOptions camera_path;  ///< its motion, by the clip's seed
  int dense_per_frame = 300;           ///< fewer when fewer pixels show the body; 0: no dense keypoints
  DenseFaultOptions dense;
  bool keypoints = true;  ///< COCO-17, toes and heels, if the body has them
  DetectionNoiseOptions detection;
  double dropped_frame_share = 0;   ///< frames without any observation
  double dropped_run_frames = 5;    ///< mean length of a gap
  double initialiser_error_px = 0;  ///< mean per-vertex projection error at 512 px of the initialiser; 0: none
  PerturbationOptions perturbation;
  int num_threads = 0;  ///< 0: all cores
  [[nodiscard]] bool IsValid(std::string* why) const;
};

/// Counts of the faults added to the observations.
struct SynthFaultCounts {
  int dense = 0, dense_outliers = 0, dense_missing = 0, frames_dropped = 0, keypoints = 0, keypoints_hidden = 0;
};

struct SynthClip {
  Track truth;                   ///< camera frame, or the scene with the path of a moving camera
  CameraPose camera_from_world;  ///< of the first frame
  Eigen::Vector3d up_in_camera;  ///< unit vector, of the first frame
  DenseSequence dense;
  DenseSequence dense_truth;  ///< the same pixels before faults 2–5 (same frames, same order)
  KeypointSequence keypoints;
  KeypointSequence keypoints_truth;  ///< exact; confidence 1 visible, 0.5 hidden by the body, 0 outside the image
  Motion initialiser;                ///< camera frame; no frames when not requested
  double initialiser_error_px = 0;   ///< as measured
  SynthFaultCounts counts;
};

/// Throws std::invalid_argument when an option is out of range, the motion has no frame, is not finite or has more
/// columns than the body has joints, or UV faults or missing parts are requested for a body without charts.
SynthClip MakeSynthClip(const BodyModel& body, const Motion& motion, const SynthClipOptions& options = {});

/// The same for a given camera; options.camera is ignored. For a motion that is already in the camera frame, the
/// camera's pose is the identity.
SynthClip MakeSynthClip(const BodyModel& body, const Motion& motion, const SynthCamera& camera,
                        const SynthClipOptions& options);

/// The same for a given camera path, moving or static.
SynthClip MakeSynthClip(const BodyModel& body, const Motion& motion, const SynthCameraPath& path,
                        const SynthClipOptions& options);

}  // namespace bodyloom
