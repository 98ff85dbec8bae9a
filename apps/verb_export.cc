// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "apps/command_callbacks.h"
#include "apps/exit_code.h"
#include "apps/verbs.h"
#include "bodyloom/pipelines/export/export_track.h"

namespace bodyloom {
namespace {

constexpr const char* kExportFooter =
    "What is written (camera frame, metres, unless stated otherwise):\n"
    "  vertices   .npy, frames x vertices x 3, float32; lost frames are NaN\n"
    "  joints     .npy, frames x joints x 3, float64; lost frames are NaN\n"
    "  obj        a folder with frame_000000.obj ..., lost frames left out; with --frame one .obj file\n"
    "  amass      .npz as AMASS has it: SMPL-H's 156 pose columns, z up\n"
    "  bvh        for animation programs: centimetres, y up\n"
    "Examples:\n"
    "  bodyloom export --track track.npz --what bvh --out motion.bvh\n"
    "  bodyloom export --track track.npz --what obj --frame 120 --out frame.obj\n\n";

std::vector<std::string> SortedNames() {
  std::vector<std::string> names = TrackFormNames();
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

void AddExportVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("export", "Writes a track in another form: vertices, joints, OBJ, AMASS, BVH");
  verb->footer(std::string(kExportFooter) + kExitCodeHelp);
  auto request = std::make_shared<ExportTrackRequest>();
  auto form = std::make_shared<std::string>();
  ExportTrackRequest& c = *request;
  verb->add_option("--track", c.track, "the track, .npz")->required()->type_name("FILE");
  verb->add_option("--what", *form, "what to write (below)")
      ->required()
      ->check(CLI::IsMember(SortedNames()))
      ->type_name("KIND");
  verb->add_option("--out", c.out, "where to write it")->required()->type_name("PATH");
  verb->add_option("--body", c.body, "the track's body (default: the built-in body)")->type_name("FILE");
  verb->add_option("--frame", c.frame, "obj: only this frame, counted from 0")->check(CLI::NonNegativeNumber);
  verb->callback([request, form, action] {
    *action = [request, form] {
      request->form = TrackFormFromString(*form);
      const ExportTrackReport report = ExportTrack(*request, CommandCallbacks());
      std::cout << "wrote " << report.out << "\n";
    };
  });
}

}  // namespace bodyloom
