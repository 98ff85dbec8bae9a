// SPDX-License-Identifier: Apache-2.0
/// A track in another form: vertices, joints, OBJ, AMASS, BVH.
#pragma once

#include <string>
#include <vector>

#include "bodyloom/pipelines/callbacks.h"

namespace bodyloom {

/// What is written; camera frame and metres, unless stated otherwise.
enum class TrackForm {
  kVertices,  ///< .npy, frames x vertices x 3, float32; lost frames are NaN
  kJoints,    ///< .npy, frames x joints x 3, float64; lost frames are NaN
  kObj,       ///< a folder with frame_000000.obj ..., lost frames left out; or one frame's .obj
  kAmass,     ///< .npz as AMASS has it: SMPL-H's 156 pose columns, z up
  kBvh,       ///< for animation programs: centimetres, y up
};
/// "vertices", "joints", ... in the order of TrackForm.
const std::vector<std::string>& TrackFormNames();
/// Throws std::invalid_argument for other names.
TrackForm TrackFormFromString(const std::string& name);

struct ExportTrackRequest {
  std::string track;  ///< .npz
  std::string body;   ///< the track's body; empty: the built-in one
  TrackForm form = TrackForm::kVertices;
  int frame = -1;   ///< kObj: only this frame, counted from 0; -1: all
  std::string out;  ///< file, or folder (kObj of all frames)
};

struct ExportTrackReport {
  int num_frames = 0;  ///< of the track
  std::string out;     ///< what was written
};

/// Throws std::runtime_error naming a file that cannot be used, a frame that the track lacks or has lost, or a body
/// that is not the track's; RequestError for a file both read and written; Cancelled.
ExportTrackReport ExportTrack(const ExportTrackRequest& request, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
