// SPDX-License-Identifier: Apache-2.0
/// Finds how the camera of a job's video moved, and takes the path of one that turned or went somewhere for the tracks.
#pragma once

#include <string>
#include <vector>

#include "geometry/base/callbacks.h"
#include "geometry/scene/background_tracks.h"
#include "geometry/scene/observations.h"
#include "pipelines/track/clip_camera_path.h"
#include "pipelines/track/scene_inputs.h"
#include "pipelines/track/track_request.h"

namespace bodyloom {

/// The reason why the camera's motion is not looked for; empty: it is.
std::string WhyNoCameraMotion(const SceneRequest& request);

/// Background points of the request's video, from the second before its span; `keypoints`, in the camera's pixels, are
/// of the person, whose rectangle is left out in the frames of their times; null: nobody is.
BackgroundTracks BackgroundOfVideo(const TrackRequest& request, const KeypointSequence* keypoints,
                                   const SceneInputs& scene);

/// Finds the motion. A camera that turns without zoom, or whose places are found, gives `scene` a camera path, of
/// places in a unit that is not known, and, where its focal length is not known, a prior from it; the path is written
/// to request.camera_path_out, if given: as COLMAP's images.txt with cameras.txt and points3D.txt beside it if its name
/// ends in .txt, otherwise as JSON. `report`: what was found. Says a warning when the camera moves in another way.
void UseCameraMotion(const TrackSettings& request, const BackgroundTracks& background,
                     const PipelineCallbacks& callbacks, SceneInputs* scene, CameraPathReport* report);

}  // namespace bodyloom
