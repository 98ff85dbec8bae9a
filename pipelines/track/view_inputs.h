// SPDX-License-Identifier: Apache-2.0
/// Request for one person's track from several cameras (tracking/rig/track_views.h), and its inputs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "geometry/scene/rig.h"
#include "pipelines/track/known_rig.h"
#include "pipelines/track/track_inputs.h"
#include "pipelines/track/track_request.h"

namespace bodyloom {

/// The base's settings are those of all views, its video is the first view's, and its `detections` and `view` are not
/// used. In its `camera_path` {view} stands for the view's name; a view without such a file stands still.
struct TrackViewsRequest : TrackRequest {
  /// Files of 2D joints: one that holds all views, or one a view, the first of which is the track's.
  std::vector<std::string> view_detections;
  /// Names in a file that holds several views, and of the cameras; may be empty with a file a view.
  std::vector<std::string> views;
  KnownOfRig known = KnownOfRig::kClocks;
  bool same_lens = false;  ///< all cameras are of one kind and not zoomed (kSameLensLogSigma)
  std::string rig_out;     ///< the estimated rig (rig_io.h); empty: rig.json beside `out`
};

/// True if the request names several files or several views.
bool HasSeveralViews(const TrackViewsRequest& request);
/// The same for one view.
TrackRequest RequestOfOneView(const TrackViewsRequest& request);

/// Throws RequestError for contradictory or missing fields, and options that several views do not use. Does not access
/// files.
void CheckTrackViewsRequest(const TrackViewsRequest& request);

/// One camera's inputs.
struct ViewInputs {
  std::string name;        ///< of the view or its camera; else the detections' file name
  std::string detections;  ///< file
  double fps = 0;          ///< median, of its own clock
  /// With keypoints. Where its clock is known, their timestamps are of the first view's clock.
  TrackInputs inputs;
  std::optional<CameraPose> camera_from_rig;  ///< of all views, or of none
  /// Clock relative to the first view's, where it is known; the others' offset is NaN. Without camera and pose.
  RigCamera clock;
};

/// Files named by the request. Throws std::runtime_error naming one that is missing or unreadable.
std::vector<std::string> RequireViewInputs(const TrackViewsRequest& request);

/// Reads the views in their order. Cameras are found by the views' names, or else belong to the views in their order.
/// Throws std::runtime_error naming file and place, also for files that contradict each other.
std::vector<ViewInputs> LoadViewInputs(const TrackViewsRequest& request, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
