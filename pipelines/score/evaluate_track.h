// SPDX-License-Identifier: Apache-2.0
/// Evaluates a track against reference data: named errors with units.
#pragma once

#include <string>
#include <vector>

#include "data_tools/evaluation/evaluation.h"
#include "data_tools/evaluation/held_out_views.h"
#include "geometry/base/callbacks.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/rig.h"
#include "geometry/scene/track.h"

namespace bodyloom {

// Reads one person's multi-view clip from files: a calibration and the detections of each camera of a rig.

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

struct EvaluateTrackRequest {
  std::string track;  ///< .npz
  /// Reference data, which determines the protocol: a track or part labels (.npz), a sequence of EMDB or 3DPW (.pkl),
  /// a sequence's folder of RICH, joints or SMPL fits of Human3.6M (.json, .npz), an AIST++ folder (keypoints2d/), or a
  /// Pose2Sim folder (calib_refined.json). Without this and `seen`: the track alone (evaluation.h).
  std::string truth;
  /// Instead of `truth`: detections of the person by two or more calibrated cameras of a rig; `cameras` is the
  /// calibration, `view` the camera that the track was fitted to (FindRigClip()).
  std::vector<RigDetections> seen;
  /// The cameras of a `truth` that was tracked in several views (data_tools/observations/rig_io.h): the track is of one
  /// of them, `view` (data_tools/evaluation/rig_track_evaluation.h).
  std::string rig;
  bool equal_clocks = false;  ///< cameras of `rig` whose clocks are not known have the first one's
  std::string body;           ///< body of track and truth; empty: the built-in one
  std::string true_body;      ///< body of a data set's true motion (SMPL or SMPL-X of its sex); empty: `body`
  int true_person = 0;        ///< person of a 3DPW file, subject of RICH
  /// J_regressor_h36m.npy (human36m_evaluation.h): joints of Human3.6M are regressed from the body's vertices; for
  /// motions of other data sets such joints are compared besides.
  std::string joint_regressor;
  std::string cameras;   ///< AIST++: camera folder, empty: truth/cameras; RICH: the scene's; Human3.6M: *_camera.json
  std::string sequence;  ///< AIST++: name of the clip; Human3.6M: "2/1", "S9/Directions 1" (video_truth.h)
  /// Camera that the track was fitted to; empty: c01 (AIST++), cam_01 (Pose2Sim), the first one (`rig`), the only one.
  std::string view;
  std::string json;  ///< EvaluationJson; empty: not written
};

/// Evaluates the track and writes the requested files. Throws RequestError when an AIST++ clip is not named or fields
/// do not go together (`truth` and `seen`, `rig` without a true track), std::runtime_error naming a file that cannot be
/// used, Cancelled before the evaluation starts.
Evaluation EvaluateTrack(const EvaluateTrackRequest& request, const PipelineCallbacks& callbacks = {});

/// Data for EvaluateTrack() that are in memory; null: not given.
struct EvaluationInMemory {
  const Track* truth = nullptr;                 ///< of the track's body
  const std::vector<RigCamera>* rig = nullptr;  ///< its cameras
};

/// The same for a track in memory and its body; files of the request that are given in memory are not read.
Evaluation EvaluateTrack(const EvaluateTrackRequest& request, const BodyModel& body, const Track& track,
                         const EvaluationInMemory& given, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
