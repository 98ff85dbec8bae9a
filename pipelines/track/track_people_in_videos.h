// SPDX-License-Identifier: Apache-2.0
/// Tracks everybody in raw videos of several cameras that stand still and filmed the same people: people are detected
/// in each, matched by their motions, and tracked in all of them at once (tracking/rig/track_people_in_views.h).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "geometry/body/body_model.h"
#include "pipelines/track/known_rig.h"
#include "pipelines/track/track_people_clip.h"
#include "pipelines/track/track_people_report.h"

namespace bodyloom {

/// The base's settings are those of all videos, but its span and its choice of people are the first one's; its `video`
/// is not used.
struct TrackPeopleInVideosRequest : TrackPeopleClipRequest {
  std::vector<std::string> videos;  ///< two or more; the tracks are in the first one's frame and time
  std::vector<std::string> views;   ///< names of the cameras; empty: those of the files
  KnownOfRig known = KnownOfRig::kClocks;
  bool same_lens = false;  ///< all cameras are of one kind and not zoomed (kSameLensLogSigma)
};

/// True if the request names several videos.
bool HasSeveralVideos(const TrackPeopleInVideosRequest& request);
/// The same for one video. Throws RequestError for several names and options of several videos.
TrackPeopleClipRequest RequestOfOneVideo(const TrackPeopleInVideosRequest& request);

/// Writes into the folder, with NAME that of a view:
///   detections_NAME.npz   everybody's landmarks (people_npz.h), before anything else is computed
///   person_I.npz          the track of person I of the first video, in its camera's frame and with its times
///   rig.json              cameras and clocks of the views that were used (rig_io.h)
///   overlay_NAME.mp4      everybody over that video, in step with the first
///   report.html           with `report`: one page with all videos in step
///   summary.json          ToJson(TrackPeopleReport)
/// Throws RequestError for a contradictory request, Cancelled, std::runtime_error naming a file that cannot be used,
/// and NoPersonFound when the first video shows nobody or no other one shows the motion of anybody in it. `body`, if
/// any, replaces the request's.
TrackPeopleReport TrackPeopleInVideos(const TrackPeopleInVideosRequest& request,
                                      const PipelineCallbacks& callbacks = {},
                                      const std::shared_ptr<const BodyModel>& body = nullptr);

}  // namespace bodyloom
