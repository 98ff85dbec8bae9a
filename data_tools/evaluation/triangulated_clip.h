// SPDX-License-Identifier: Apache-2.0
/// A clip seen by calibrated cameras and nothing else: joints triangulated from the cameras' own detections stand in
/// for a 3D truth.
///
/// They place the mid-hip and give the clip's one scale, because a single camera knows neither. What is scored is
/// therefore pose and orientation, as on AIST++.
#pragma once

#include <string>
#include <vector>

#include "bodyloom/data_tools/evaluation/evaluation.h"
#include "bodyloom/data_tools/evaluation/held_out_views.h"
#include "bodyloom/geometry/arrays.h"
#include "bodyloom/geometry/observations.h"
#include "bodyloom/geometry/track.h"

namespace bodyloom {

struct TriangulatedClipOptions {
  double min_confidence = 0.3;       ///< of detections, for triangulation and scoring
  double max_triangulation_px = 20;  ///< joints whose sightings disagree by more (root mean square) are unknown
};

/// The landmarks of COCO's list, in its order, from detections in another. Throws std::runtime_error beginning with
/// `where` when one is missing.
KeypointSequence AsCoco17(const KeypointSequence& detections, const std::string& where);

/// The joints of every frame that all views have, T of 17×3 metres in the world (triangulation.h); NaN where fewer than
/// two views saw a joint, or saw it in places that do not agree.
std::vector<MatrixX3d> TriangulateViews(const std::vector<RigView>& views, const TriangulatedClipOptions& options = {});

/// Protocol "rig-held-out": EvaluateHeldOutViews on a clip whose joints came from TriangulateViews(), and how far these
/// lie from the detections (triangulation_median_px, triangulation_p95_px, triangulated_percent): a lower bound of
/// their noise, because two cameras see only its part across the epipolar lines. `view` is the camera the track was
/// fitted to.
Evaluation EvaluateTriangulatedClip(const Track& track, const MultiViewClip& clip, const std::string& view,
                                    const TriangulatedClipOptions& options = {});

}  // namespace bodyloom
