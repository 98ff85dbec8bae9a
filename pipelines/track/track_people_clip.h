// SPDX-License-Identifier: Apache-2.0
/// Tracks everybody in a raw video: people are detected, linked over the clip, and tracked as one scene; results in
/// files or in memory.
#pragma once

#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "pipelines/track/chosen_people.h"
#include "pipelines/track/scene_inputs.h"
#include "pipelines/track/track_people_report.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

struct TrackPeopleClipRequest : TrackPeopleRequest {
  std::string out;  ///< folder, created if missing
  bool overlay = true;
  bool side_view = false;  ///< the overlay also shows a side view
  bool report = false;     ///< write the clip's page
  bool masks = false;      ///< write each person's mask
  /// Write the network's masks without refinement against the background (CutMasks()). Tracks do not depend on it; they
  /// always use the network's masks.
  bool coarse_masks = false;
};

/// Writes into the folder:
///   detections.npz   everybody's landmarks (people_npz.h), before anything else is computed
///   person_I.npz     the track of person I (track_io.h) from the first frame that shows it to the last, with the
///                    video's times; all tracks are in one camera frame
///   mask_I.npz       with `masks`: the mask of person I in every frame of the clip (part_labels.h), in the
///                    video's pixels
///   overlay.mp4      all of them over the video (render/view/people_overlay.h)
///   report.html      with `report`: the page of the clip (pipelines/page/write_clip_page.h)
///   summary.json     ToJson(TrackPeopleReport)
/// Files of these names are replaced; tracks of people not found in this run are kept. Throws RequestError for a
/// contradictory request, Cancelled, and std::runtime_error naming a file that cannot be used, or when nobody was found
/// or could be tracked. `given` replaces the request's body and camera.
TrackPeopleReport TrackPeopleClip(const TrackPeopleClipRequest& request, const PipelineCallbacks& callbacks = {},
                                  const GivenInMemory& given = {});

struct TrackedPeople {
  std::vector<TrackSequenceResult> people;  ///< in the order of report.people; status may be kFailure
  TrackPeopleReport report;                 ///< without file names
};

/// The tracks that TrackPeopleClip() would write, byte for byte, without writing files. Throws as it does.
TrackedPeople TrackPeopleToMemory(const TrackPeopleRequest& request, const PipelineCallbacks& callbacks = {},
                                  const GivenInMemory& given = {});

}  // namespace bodyloom
