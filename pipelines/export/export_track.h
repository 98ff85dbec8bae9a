// SPDX-License-Identifier: Apache-2.0
/// Exports tracks to formats of animation programs, game engines, biomechanics and reconstruction, and to plain arrays.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data_tools/export/skinned_mesh.h"
#include "data_tools/motion/animation_rig.h"
#include "geometry/base/callbacks.h"
#include "geometry/biomechanics/gait.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"
#include "geometry/scene/world_frame.h"

namespace bodyloom {

/// Output format. Coordinates are in the clip's world (geometry/scene/world_frame.h: metres, y up, ground at y = 0)
/// unless stated otherwise.
enum class TrackForm {
  kVertices,  ///< .npy, frames x vertices x 3, float32; lost frames are NaN; the request's axes
  kJoints,    ///< .npy, frames x joints x 3, float64; lost frames are NaN; the request's axes
  kObj,       ///< a folder with frame_000000.obj ..., lost frames left out; or one frame's .obj; the request's axes
  kAmass,     ///< .npz as AMASS has it: SMPL-H's 156 pose columns, z up
  kBvh,       ///< for animation programs: centimetres
  kGlb,       ///< glTF 2.0 binary: skinned bodies, animation, camera, ground (glb_writer.h); several people
  kFbx,       ///< binary FBX: skinned bodies, animation, camera (fbx_writer.h); centimetres; several people
  kSmplx,     ///< .npz in AMASS' SMPL-X form, which GMR reads: z up
  kTrc,       ///< markers for OpenSim and Pose2Sim: metres
  kC3d,       ///< markers for biomechanics programs: millimetres
  kColmap,    ///< a folder: the camera as a COLMAP text model
  kPose2Sim,  ///< Calib.toml: the camera, z up
  kAngles,    ///< .csv, or .mot for OpenSim: joint angles (geometry/biomechanics/joint_angles.h), degrees
};
/// "vertices", "joints", ... in the order of TrackForm.
const std::vector<std::string>& TrackFormNames();
/// Throws std::invalid_argument for other names.
TrackForm TrackFormFromString(const std::string& name);

struct ExportTrackRequest {
  std::vector<std::string> tracks;  ///< .npz; more than one: people of one clip, for kGlb, kFbx and kColmap
  std::string body;                 ///< the tracks' body; empty: the built-in one
  TrackForm form = TrackForm::kVertices;
  bool world_axes = false;  ///< kVertices, kJoints, kObj: in the clip's world; false: in the camera frame
  int frame = -1;           ///< kObj: only this frame, counted from 0; -1: all
  AnimationRig rig = AnimationRig::kSmpl;  ///< kBvh, kFbx
  std::vector<std::string> textures;       ///< kGlb, kFbx: PNG files, by track
  int correctives = 8;                     ///< kGlb, kFbx: shapes for pose correctives, 0 to 64
  std::string events;                      ///< kAngles: also the events of gait, .json; empty: not
  std::string out;                         ///< file, or folder (kObj of all frames, kColmap)
};

struct ExportTrackReport {
  int num_frames = 0;    ///< of the first track
  int lost_before = 0;   ///< kAmass, kBvh, kSmplx: frames left out before the first that shows the person
  int lost_after = 0;    ///< and after the last
  int lost_between = 0;  ///< kAmass, kBvh, kSmplx: frames between the two that were interpolated
  std::string out;       ///< what was written
  bool uses_world = false;
  WorldFrame world;                ///< where uses_world
  SkinSummary skin;                ///< kGlb, kFbx
  std::optional<GaitReport> gait;  ///< kAngles
  size_t bytes = 0;                ///< of the file, or of the folder's files
  double seconds = 0;
};

/// Text of the files, their world and its accuracy; several lines ending in a newline.
std::string ToText(const ExportTrackReport& report);

/// Exports the tracks. Throws std::runtime_error naming a file that cannot be used, a frame that a track lacks or has
/// lost, or a body that is not the track's; RequestError for a file both read and written, and for options or tracks
/// not supported by the form; Cancelled.
ExportTrackReport ExportTrack(const ExportTrackRequest& request, const PipelineCallbacks& callbacks = {});

/// The same for tracks in memory and their body; request.tracks holds their names for messages.
ExportTrackReport ExportTrack(const ExportTrackRequest& request, const BodyModel& body,
                              const std::vector<const Track*>& tracks, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
