// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/detector_options.h"
#include "apps/exec_beside.h"
#include "apps/progress.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"
#include "pipelines/detect/detect_clip.h"

namespace bodyloom {
namespace {

constexpr const char* kDetectFooter =
    "Everybody in the video is found and followed by BlazePose (33 landmarks), on the processor. The networks come "
    "with\n"
    "./dev models, from --models, or from the folder that $BODYLOOM_MODELS names.\n"
    "With --out it finds their hands and faces too, where they are large enough (--hands).\n"
    "--pose-model is YOLO-pose or RTMPose in its place, as an ONNX file of yours (docs/detection.md).\n"
    "--dense-model is DensePose as TorchScript (docs/detection.md), which needs the neural half of the program.\n"
    "Examples:\n"
    "  bodyloom detect --video clip.mp4 --dense-model densepose_r50_fpn_dl.torchscript --dense-out dense.npz\n"
    "  bodyloom detect --video clip.mp4 --pose-model yolo11n-pose.onnx --out detections.npz\n"
    "  bodyloom detect --video clip.mp4 --out detections.npz --mask mask.npz\n"
    "then\n"
    "  bodyloom track --detections detections.npz --part-labels mask.npz --video clip.mp4 --out track.npz\n\n";

struct Parsed {
  DetectClipRequest request;
  std::optional<int> turn_deg = 0;  ///< --rotate; none: auto
  std::string dense_model, device = "cpu", colours;
  bool quiet = false;
};

void AddDenseOptions(CLI::App* verb, Parsed* parsed) {
  constexpr const char* kGroup = "Dense keypoints";
  const auto add = [&](const char* name, std::string* value, const std::string& help, const char* type) {
    return verb->add_option(name, *value, help)->group(kGroup)->type_name(type);
  };
  CLI::Option* model = add("--dense-model", &parsed->dense_model, "DensePose as a TorchScript file", "FILE");
  CLI::Option* out = add("--dense-out", &parsed->request.dense, "one person's dense keypoints, .npz", "FILE");
  model->needs(out), out->needs(model);
  add("--body", &parsed->request.body, BodyHelp("body on whose faces they lie"), "FILE")->needs(out);
  add("--device", &parsed->device, "where the network runs", "")
      ->check(CLI::IsMember({"cpu", "cuda"}))
      ->capture_default_str()
      ->needs(out);
  add("--dense-colours", &parsed->colours, "order in which the network is given colours (default: as its form is)", "")
      ->check(CLI::IsMember({"rgb", "bgr"}))
      ->needs(out);
}

}  // namespace

void AddDetectVerb(CLI::App& app, Action* action, std::vector<std::string> arguments, MakeChartDetector dense) {
  CLI::App* verb = app.add_subcommand("detect", "Finds the people in a video and their 2D landmarks");
  verb->footer(std::string(kDetectFooter) + kExitCodeHelp);
  auto parsed = std::make_shared<Parsed>();
  DetectClipRequest* request = &parsed->request;
  DetectPeopleRequest& detect = request->detect;
  verb->add_option("--video", detect.video, "the video, or a folder of images")->required()->type_name("PATH");
  verb->add_option("--out", request->out, "everybody's landmarks, .npz")->type_name("FILE");
  verb->add_option("--mask", request->mask, "the mask of one person, .npz")->type_name("FILE");
  verb->add_flag(
      "--coarse-masks", request->coarse_mask,
      "masks as the network gives them: do not cut them from what stands behind people when the camera is still");
  verb->add_option("--person", request->person, "whose mask and dense keypoints: 0 is the largest and longest in view")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--people", detect.detector.blazepose.max_people,
                   "follow at most so many people at a time (0: everybody)")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  AddDetectorOptions(*verb, &detect.detector, &detect.detect_rate, "Options");
  detect.detector.hands_and_faces = HandsAndFaceChoice::kAuto;
  AddHandsOption(*verb, &detect.detector.hands_and_faces, ToText(HandsAndFaceChoice::kAuto), "Options");
  AddPlaybackOptions(*verb, &parsed->turn_deg, &detect.span.captured_fps, "Options");
  verb->add_option("--from", detect.span.from_s, "begin at this second")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  verb->add_option("--to", detect.span.to_s, "end with this second (default: the end)")->check(CLI::NonNegativeNumber);
  verb->add_option("--fps", detect.span.fps, "frame rate of a folder of images (default 30)")
      ->check(CLI::PositiveNumber);
  verb->add_option("--json", request->json, "who was found, and times")->type_name("FILE");
  verb->add_flag("--quiet", parsed->quiet, "print nothing but errors");
  AddDenseOptions(verb, parsed.get());
  verb->callback([parsed, action, arguments = std::move(arguments), dense = std::move(dense)] {
    *action = [=] {
      if (!parsed->dense_model.empty()) {
        if (!dense) ExecNeural(arguments);
        parsed->request.dense_detector = dense(parsed->dense_model, parsed->device, parsed->colours);
      }
      parsed->request.find_turn = !parsed->turn_deg;
      parsed->request.detect.span.turn_deg = parsed->turn_deg.value_or(0);
      const DetectClipReport report = DetectClip(parsed->request, CommandCallbacks(parsed->quiet));
      if (!parsed->quiet) std::cout << ToText(report);
    };
  });
}

}  // namespace bodyloom
