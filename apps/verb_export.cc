// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "apps/progress.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"
#include "geometry/base/callbacks.h"
#include "pipelines/export/export_rig.h"
#include "pipelines/export/export_track.h"

namespace bodyloom {
namespace {

constexpr const char* kExportFooter =
    "What is written (in the clip's world: metres, y up, ground at y = 0; unless stated otherwise):\n"
    "  vertices   .npy, frames x vertices x 3, float32; lost frames are NaN; --axes\n"
    "  joints     .npy, frames x joints x 3, float64; lost frames are NaN; --axes\n"
    "  obj        a folder with frame_000000.obj ..., lost frames left out; with --frame one .obj file; --axes\n"
    "  amass      .npz as AMASS has it: SMPL-H's 156 pose columns, z up\n"
    "  smplx      .npz in AMASS' SMPL-X form, which GMR and other retargeters read: z up\n"
    "  bvh        for animation programs: centimetres; --rig\n"
    "  fbx        for Unreal, Unity, MotionBuilder, Blender: as glb without ground, centimetres; --rig, --texture\n"
    "  glb        glTF 2.0: skinned, textured, animated bodies, camera and ground; several --track, --texture\n"
    "  trc, c3d   22 markers of HALPE_26 for OpenSim, Pose2Sim and others: metres, millimetres\n"
    "  colmap     a folder with the camera as a COLMAP text model; several --track\n"
    "  pose2sim   the camera as Calib.toml, z up\n"
    "  angles     joint angles by OpenSim's names, degrees, and whether and how the person walks: .csv, or .mot\n"
    "What is written of --cameras, in the frame of its poses (of rig.json the first camera's), metres:\n"
    "  rig-toml    Pose2Sim's Calib.toml\n"
    "  rig-opencv  YAML of OpenCV's FileStorage: a list of cameras\n"
    "  rig-colmap  a folder with a COLMAP text model: a camera and an image each, no points\n"
    "Examples:\n"
    "  bodyloom export --track track.npz --what bvh --rig mixamo --out motion.bvh\n"
    "  bodyloom export --track results/person_0.npz --track results/person_1.npz --what glb --out people.glb\n"
    "  bodyloom export --track track.npz --what obj --frame 120 --out frame.obj\n"
    "  bodyloom export --cameras rig.json --what rig-toml --out Calib.toml\n\n";

std::vector<std::string> SortedNames() {
  std::vector<std::string> names = TrackFormNames();
  names.insert(names.end(), RigFormNames().begin(), RigFormNames().end());
  std::sort(names.begin(), names.end());
  return names;
}

bool IsRigForm(const std::string& form) {
  return std::find(RigFormNames().begin(), RigFormNames().end(), form) != RigFormNames().end();
}

/// Options of the verb that are of tracks, or of their forms.
void RefuseOptionsOfTracks(const CLI::App& verb, const std::string& form) {
  for (const char* option :
       {"--track", "--body", "--frame", "--axes", "--rig", "--texture", "--correctives", "--events"}) {
    if (verb.count(option) > 0) throw RequestError("--what " + form + " writes cameras: leave out " + option);
  }
}

}  // namespace

void AddExportVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand(
      "export", "Writes tracks or cameras in another form: glTF, FBX, BVH, AMASS, TRC, C3D, angles, COLMAP, arrays");
  verb->footer(std::string(kExportFooter) + kExitCodeHelp);
  auto request = std::make_shared<ExportTrackRequest>();
  auto form = std::make_shared<std::string>();
  auto axes = std::make_shared<std::string>("camera"), rig = std::make_shared<std::string>("smpl");
  ExportTrackRequest& c = *request;
  auto rig_request = std::make_shared<ExportRigRequest>();
  verb->add_option("--track", c.tracks, "the track, .npz; several times for people of one clip")->type_name("FILE");
  verb->add_option("--cameras", rig_request->cameras,
                   "rig-...: the cameras: rig.json of track, or any file that track --cameras takes")
      ->type_name("FILE");
  verb->add_option("--what", *form, "what to write (below)")
      ->required()
      ->check(CLI::IsMember(SortedNames()))
      ->type_name("KIND");
  verb->add_option("--out", c.out, "where to write it")->required()->type_name("PATH");
  verb->add_option("--body", c.body, BodyHelp("the track's body"))->type_name("FILE");
  verb->add_option("--frame", c.frame, "obj: only this frame, counted from 0")->check(CLI::NonNegativeNumber);
  verb->add_option("--axes", *axes, "vertices, joints, obj: camera or world")
      ->check(CLI::IsMember({"camera", "world"}))
      ->capture_default_str();
  verb->add_option("--rig", *rig, "bvh, fbx: names and rest pose: smpl, mixamo, vrm (T-pose) or unreal (A-pose)")
      ->check(CLI::IsMember(AnimationRigNames()))
      ->capture_default_str();
  verb->add_option("--texture", c.textures, "glb, fbx: the person's texture, .png; by track")->type_name("FILE");
  verb->add_option("--correctives", c.correctives, "glb, fbx: shapes that hold the pose correctives")
      ->check(CLI::Range(0, 64))
      ->capture_default_str();
  verb->add_option("--events", c.events, "angles: also the steps, as .json")->type_name("FILE");
  verb->callback([=] {
    *action = [=] {
      if (IsRigForm(*form)) {
        RefuseOptionsOfTracks(*verb, *form);
        rig_request->form = RigFormFromString(*form);
        rig_request->out = request->out;
        std::cout << ToText(ExportRig(*rig_request));
        return;
      }
      if (!rig_request->cameras.empty()) {
        throw RequestError("--cameras is of rig-toml, rig-opencv and rig-colmap, not of " + *form);
      }
      request->form = TrackFormFromString(*form);
      request->rig = AnimationRigFromString(*rig);
      request->world_axes = *axes == "world";
      const ExportTrackReport report = ExportTrack(*request, CommandCallbacks());
      std::cout << ToText(report);
    };
  });
}

}  // namespace bodyloom
