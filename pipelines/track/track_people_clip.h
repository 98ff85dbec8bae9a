// SPDX-License-Identifier: Apache-2.0
/// A raw video to everybody in it: people are detected, linked over the clip, and tracked as one scene.
#pragma once

#include <optional>
#include <string>

#include "bodyloom/pipelines/callbacks.h"
#include "bodyloom/pipelines/track/track_people_report.h"
#include "bodyloom/pipelines/track/track_request.h"

namespace bodyloom {

struct TrackPeopleClipRequest {
  /// The video, its span, the detector, the camera, what else is known and how to solve; `side_view` is of the overlay.
  /// Its `person`, its other observations and its outputs are not used.
  TrackRequest track;
  std::string out;             ///< folder, made when it is not there
  int max_people = 0;          ///< at most so many: the largest and longest in view; 0: everybody
  std::optional<int> person;   ///< only this one, numbered as LinkPeople() does (0: the largest and longest in view)
  double least_seconds = 0.5;  ///< whoever is seen for less is left out; in short clips half of the clip
  bool overlay = true;
  bool report = false;  ///< the clip's page
  bool masks = false;   ///< each person's mask is written too
};

/// Writes into the folder:
///   detections.npz   everybody's landmarks (people_npz.h), before anything else is computed
///   person_I.npz     the track of person I (track_io.h) from the first frame that shows it to the last, with the
///                    video's times; all tracks are in one camera frame
///   mask_I.npz       with `masks`: the mask of person I in every frame of the clip (part_labels.h), in the video's pixels
///   overlay.mp4      all of them over the video (render/people_overlay.h)
///   report.html      with `report`: the page of the clip (pipelines/page/write_clip_page.h)
///   summary.json     ToJson(TrackPeopleReport)
/// Files of these names are replaced; tracks of people whom this run does not find stay. Throws RequestError for a
/// request that contradicts itself, Cancelled, and std::runtime_error naming a file that cannot be used, or saying that
/// nobody was found or could be tracked.
TrackPeopleReport TrackPeopleClip(const TrackPeopleClipRequest& request, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
