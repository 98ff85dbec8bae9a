// SPDX-License-Identifier: Apache-2.0
/// Reads one person's multi-view clip from files: a calibration and the detections of each camera of a rig.
#pragma once

#include <string>
#include <vector>

#include "data_tools/evaluation/held_out_views.h"
#include "geometry/base/callbacks.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// Detections of one camera.
struct RigDetections {
  std::string view;        ///< name of the camera in the calibration
  int person = 0;          ///< in the order of LinkPeople()
  std::string detections;  ///< any file of 2D joints (load_detections.h), in the pixels of the camera's video
};

/// "VIEW=FILE" or "VIEW:PERSON=FILE". Throws RequestError saying what was expected.
RigDetections RigDetectionsFromText(const std::string& text);

/// Reads the clip from the track's first frame on. The cameras are synchronised: equal frame numbers are the same
/// moment, and the frame of the track's first timestamp is looked up in the detections of `view`, the camera that the
/// track was fitted to. Joints are triangulated (triangulated_clip.h). Throws RequestError for fewer than two cameras
/// or if `view` is none of them, std::runtime_error naming a file that cannot be used or whose frames do not reach the
/// track. Warnings of the readers are messages.
MultiViewClip ReadRigClip(const std::string& cameras, const std::vector<RigDetections>& seen, const std::string& view,
                          const Track& track, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
