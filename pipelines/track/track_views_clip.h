// SPDX-License-Identifier: Apache-2.0
/// Tracks a person through several cameras, from files to files: detections of each in; the track in the first camera's
/// frame, the rig and a summary out.
#pragma once

#include "geometry/base/callbacks.h"
#include "pipelines/track/track_report.h"
#include "pipelines/track/view_inputs.h"

namespace bodyloom {

/// As TrackClip(), for a request of several views. The report has an entry for each view, the rig's file those that
/// were used. A view that shows another motion than the first is left out; if none is left, throws NoPersonFound with
/// the reason.
TrackReport TrackViewsClip(const TrackViewsRequest& request, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
