// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "apps/progress.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"
#include "pipelines/score/evaluate_track.h"

namespace bodyloom {
namespace {

constexpr const char* kEvaluateFooter =
    "What --truth may be, and the protocol it selects:\n"
    "  a track .npz (bodyloom synth writes truth.npz)   known-truth: vertices, joints, angles, camera\n"
    "  a sequence of EMDB or 3DPW, .pkl                 emdb, 3dpw: the same, and errors in the world\n"
    "  a sequence's folder of RICH (00017/004.pkl)      rich: the same\n"
    "  Human3.6M's *_joint_3d.json, data_3d_h36m.npz    h36m: LSP's 14 joints (*_smpl_param.json: h36m-smpl)\n"
    "  part labels .npz (uint8 labels)                  part-labels: overlap of the rendered body with each part\n"
    "  an AIST++ folder (keypoints2d/, keypoints3d/)    aist-held-out: 3D joints, and the cameras that were not "
    "fitted\n"
    "  a Pose2Sim folder (calib_refined.json)           pose2sim-held-out: the other camera\n"
    "With --rig the truth is the track of several cameras (bodyloom track --view c01,c03), whose rig.json this is, "
    "and\n"
    "the track was fitted to one of them (rig-track).\n"
    "Without a truth, two calibrated cameras that ran together are enough: joints triangulated from their detections\n"
    "(--seen) stand in for it, and the camera that was not fitted judges (rig-held-out). With neither the track is\n"
    "measured alone: how bent the knees are (track-alone).\n"
    "Examples:\n"
    "  bodyloom evaluate --track track.npz --truth clip/truth.npz --json errors.json\n"
    "  bodyloom evaluate --track track.npz --truth aistpp --cameras aistpp/cameras --sequence SEQ --view c01\n"
    "  bodyloom evaluate --track alone.npz --truth track.npz --rig rig.json --view c03\n"
    "  bodyloom evaluate --track one/person_1.npz --cameras rig.json --view cam1 --seen cam1:1=one/detections.npz\n"
    "    --seen cam2:0=two/detections.npz\n\n";

}  // namespace

void AddEvaluateVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("evaluate", "Compares a track with what is known: errors by name, with units");
  verb->footer(std::string(kEvaluateFooter) + kExitCodeHelp);
  auto request = std::make_shared<EvaluateTrackRequest>();
  EvaluateTrackRequest& c = *request;
  verb->add_option("--track", c.track, "the track, .npz")->required()->type_name("FILE");
  verb->add_option("--truth", c.truth, "what is known (below)")->type_name("PATH");
  verb->add_option_function<std::vector<std::string>>(
          "--seen",
          [request](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) request->seen.push_back(RigDetectionsFromText(text));
          },
          "instead of --truth: what a calibrated camera saw of the person, VIEW[:PERSON]=FILE, once a camera")
      ->type_name("TEXT");
  verb->add_option("--body", c.body, BodyHelp("body that both were made with"))->type_name("FILE");
  verb->add_option("--true-body", c.true_body, "EMDB, 3DPW, RICH: the true motion's body, of its sex (default: --body)")
      ->type_name("FILE");
  verb->add_option("--true-person", c.true_person, "3DPW, RICH: which of the people")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--joint-regressor", c.joint_regressor, "J_regressor_h36m.npy: Human3.6M's joints of the vertices")
      ->type_name("FILE");
  verb->add_option("--json", c.json, "also write the numbers as JSON")->type_name("FILE");
  verb->add_option("--cameras", c.cameras,
                   "AIST++: camera folder (default: TRUTH/cameras); RICH, Human3.6M, --seen: the calibration")
      ->type_name("PATH");
  verb->add_option("--sequence", c.sequence, "AIST++: name of the clip; Human3.6M: 2/1, 'S9/Directions 1'")
      ->type_name("NAME");
  verb->add_option("--rig", c.rig, "cameras of a true track of several views (rig.json)")->type_name("FILE");
  verb->add_flag("--equal-clocks", c.equal_clocks, "cameras of --rig without a known clock ran on the first one's");
  verb->add_option("--view", c.view, "camera that the track was fitted to (default: c01, cam_01; of a rig its first)")
      ->type_name("NAME");
  verb->callback([request, action] {
    *action = [request] { std::cout << EvaluationTable(EvaluateTrack(*request, CommandCallbacks())); };
  });
}

}  // namespace bodyloom
