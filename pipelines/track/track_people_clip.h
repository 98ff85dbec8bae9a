// SPDX-License-Identifier: Apache-2.0
/// A raw video to everybody in it: people are detected, linked over the clip, and tracked as one scene; in files or in
/// memory.
#pragma once

#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "pipelines/track/people_in_clip.h"
#include "pipelines/track/scene_inputs.h"
#include "pipelines/track/track_people_report.h"
#include "tracking/problem/track_summary.h"

namespace bodyloom {

struct TrackPeopleClipRequest : TrackPeopleRequest {
  std::string out;  ///< folder, made when it is not there
  bool overlay = true;
  bool side_view = false;  ///< the overlay also shows everybody from their side
  bool report = false;     ///< the clip's page
  bool masks = false;      ///< each person's mask is written too
  /// Masks are written as the network gives them, not cut anew from what stands behind the people (CutMasks()). Tracks
  /// are the same in any case: for them the network's masks do as well.
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
/// Files of these names are replaced; tracks of people whom this run does not find stay. Throws RequestError for a
/// request that contradicts itself, Cancelled, and std::runtime_error naming a file that cannot be used, or saying that
/// nobody was found or could be tracked. `given` takes the place of the request's body and camera.
TrackPeopleReport TrackPeopleClip(const TrackPeopleClipRequest& request, const PipelineCallbacks& callbacks = {},
                                  const GivenInMemory& given = {});

struct TrackedPeople {
  std::vector<TrackSequenceResult> people;  ///< in the order of report.people; some may have status kFailure
  TrackPeopleReport report;                 ///< names no files
};

/// The tracks that TrackPeopleClip() would write, to the byte, without any file. Throws as it does.
TrackedPeople TrackPeopleToMemory(const TrackPeopleRequest& request, const PipelineCallbacks& callbacks = {},
                                  const GivenInMemory& given = {});

}  // namespace bodyloom
