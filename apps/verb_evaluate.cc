// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include "apps/exit_code.h"
#include "apps/verbs.h"
#include "bodyloom/data_tools/body/body_or_builtin.h"
#include "bodyloom/data_tools/evaluation/aist_evaluation.h"
#include "bodyloom/data_tools/evaluation/part_label_evaluation.h"
#include "bodyloom/data_tools/evaluation/pose2sim_evaluation.h"
#include "bodyloom/data_tools/evaluation/truth_evaluation.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/formats/npz.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/data_tools/observations/part_labels.h"
#include "bodyloom/pipelines/files.h"

namespace bodyloom {
namespace {

constexpr const char* kFooter =
    "What --truth may be, and the protocol it selects:\n"
    "  a track .npz (bodyloom synth writes truth.npz)   known-truth: vertices, joints, angles, camera\n"
    "  part labels .npz (uint8 labels)                  part-labels: overlap of the rendered body with each part\n"
    "  an AIST++ folder (keypoints2d/, keypoints3d/)    aist-held-out: 3D joints, and the cameras that were not "
    "fitted\n"
    "  a Pose2Sim folder (calib_refined.json)           pose2sim-held-out: the other camera\n"
    "Examples:\n"
    "  bodyloom evaluate --track track.npz --truth clip/truth.npz --json errors.json\n"
    "  bodyloom evaluate --track track.npz --truth aistpp --cameras aistpp/cameras --sequence SEQ --view c01\n\n";

struct EvaluateCommand {
  std::string track, truth, body, json;
  std::string cameras, sequence, view;
};

/// Against a file: what kind of truth it is shows in what it holds.
Evaluation EvaluateAgainstFile(const EvaluateCommand& command, const Track& track) {
  const NpzArrays arrays = ReadNpz(command.truth);
  const std::shared_ptr<const BodyModel> body = BodyOrBuiltin(command.body);
  if (!HasPartLabels(arrays)) {
    return EvaluateAgainstTruth(track, TrackFromArrays(arrays, command.truth), *body);
  }
  ReadPartLabelsOptions as_they_are;
  as_they_are.mend_strays = false;
  return EvaluatePartLabels(track, PartLabelsFromNpz(arrays, command.truth, as_they_are), *body);
}

Evaluation Evaluate(const EvaluateCommand& command) {
  namespace fs = std::filesystem;
  const fs::path truth = command.truth;
  const Track track = ReadTrack(command.track);
  if (!fs::is_directory(truth)) {
    return EvaluateAgainstFile(command, track);
  }
  if (fs::exists(truth / "keypoints2d")) {
    if (command.sequence.empty()) {
      throw RequestError("an AIST++ folder holds many clips: name one with --sequence");
    }
    const std::string cameras = command.cameras.empty() ? (truth / "cameras").string() : command.cameras;
    return EvaluateAist(track, command.truth, cameras, command.sequence, command.view.empty() ? "c01" : command.view);
  }
  if (fs::exists(truth / "calib_refined.json")) {
    return EvaluatePose2Sim(track, command.truth, command.view.empty() ? "cam_01" : command.view);
  }
  throw std::runtime_error(command.truth +
                           ": neither keypoints2d/ (AIST++) nor calib_refined.json (Pose2Sim) in this folder, expected "
                           "one of them, or a track file");
}

void RunEvaluate(const EvaluateCommand& command) {
  RequireReadable(command.track, "track");
  RequireReadable(command.truth, "truth");
  RequireReadable(command.body, "body model");
  RequireDistinct({command.track, command.truth, command.body}, {command.json});
  RequireWritable(command.json);
  const Evaluation evaluation = Evaluate(command);
  if (!command.json.empty()) {
    WriteFileAtomically(command.json, EvaluationJson(evaluation));
  }
  std::cout << EvaluationTable(evaluation);
}

}  // namespace

void AddEvaluateVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("evaluate", "Compares a track with what is known: errors by name, with units");
  verb->footer(std::string(kFooter) + kExitCodeHelp);
  auto command = std::make_shared<EvaluateCommand>();
  EvaluateCommand& c = *command;
  verb->add_option("--track", c.track, "the track, .npz")->required()->type_name("FILE");
  verb->add_option("--truth", c.truth, "what is known (below)")->required()->type_name("PATH");
  verb->add_option("--body", c.body, "body that both were made with (default: the built-in body)")->type_name("FILE");
  verb->add_option("--json", c.json, "also write the numbers as JSON")->type_name("FILE");
  verb->add_option("--cameras", c.cameras, "AIST++: camera folder (default: TRUTH/cameras)")->type_name("DIR");
  verb->add_option("--sequence", c.sequence, "AIST++: name of the clip")->type_name("NAME");
  verb->add_option("--view", c.view, "camera that the track was fitted to (default: c01, cam_01)")->type_name("NAME");
  verb->callback([command, action] { *action = [command] { RunEvaluate(*command); }; });
}

}  // namespace bodyloom
