// SPDX-License-Identifier: Apache-2.0
#include "apps/detector_options.h"

#include <CLI/CLI.hpp>
#include <map>

namespace bodyloom {
namespace {

std::map<std::string, PoseNetworkSize> NetworksByName() {
  std::map<std::string, PoseNetworkSize> networks;
  for (const PoseNetworkSize size : {PoseNetworkSize::kLite, PoseNetworkSize::kFull, PoseNetworkSize::kHeavy}) {
    networks[ToText(size)] = size;
  }
  return networks;
}

}  // namespace

void AddPlaybackOptions(CLI::App& app, std::optional<int>* turn_deg, double* captured_fps, const std::string& group) {
  app.add_option_function<std::string>(
         "--rotate",
         [turn_deg](const std::string& word) {
           *turn_deg = word == "auto" ? std::nullopt : std::optional<int>(std::stoi(word));
         },
         "turn the video clockwise by so many degrees: of a camera that lay or hung; auto: so that people are upright")
      ->group(group)
      ->type_name("")
      ->check(CLI::IsMember({"90", "180", "270", "auto"}));
  app.add_option("--captured-fps", *captured_fps,
                 "slow motion: frames a second at which it was filmed (default: as it is played)")
      ->group(group)
      ->type_name("HZ")
      ->check(CLI::PositiveNumber);
}

void AddDetectorOptions(CLI::App& app, FrameDetectorOptions* detector, double* detect_rate, const std::string& group) {
  app.add_option("--detector", detector->blazepose.network,
                 "size of BlazePose's network: lite, full or heavy, each slower and surer (default: " +
                     ToText(detector->blazepose.network) + ")")
      ->transform(CLI::CheckedTransformer(NetworksByName(), CLI::ignore_case).description(""))
      ->group(group)
      ->type_name("SIZE");
  if (detect_rate != nullptr) {
    app.add_option(
           "--detect-rate", *detect_rate,
           "while everybody moves slowly, detect only so many frames a second and interpolate between them, without "
           "masks (default: every frame)")
        ->check(CLI::PositiveNumber)
        ->group(group)
        ->type_name("HZ");
  }
  app.add_option("--search-interval", detector->blazepose.search_interval,
                 "frames between BlazePose's searches for new people")
      ->group(group)
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--tiles", detector->blazepose.tile_levels,
                 "BlazePose searches squares of down to 1/N of the longer side: finds people from about 0.28/N of it "
                 "(8 by itself when nobody is found)")
      ->group(group)
      ->type_name("N")
      ->capture_default_str()
      ->check(CLI::Range(1, 8));
  app.add_option("--models", detector->models,
                 "folder of BlazePose's networks (default: $BODYLOOM_MODELS, or where they are installed)")
      ->group(group)
      ->type_name("DIR");
  CLI::Option* pose_model =
      app.add_option(
             "--pose-model", detector->pose_model,
             "a network of your own in place of BlazePose, without masks: YOLOv8-pose, YOLO11-pose or RTMPose, .onnx")
          ->group(group)
          ->type_name("FILE");
  app.add_option("--box-model", detector->box_model,
                 "with RTMPose: the network that finds people for it, YOLOv8 or YOLO11, .onnx (default: BlazePose)")
      ->group(group)
      ->type_name("FILE")
      ->needs(pose_model);
}

void AddHandsOption(CLI::App& app, std::optional<HandsAndFaceChoice>* choice, const std::string& unless_given,
                    const std::string& group) {
  std::map<std::string, HandsAndFaceChoice> choices;
  for (const auto each : {HandsAndFaceChoice::kOff, HandsAndFaceChoice::kAuto, HandsAndFaceChoice::kOn}) {
    choices[ToText(each)] = each;
  }
  app.add_option("--hands", *choice,
                 "the 21 points of each hand and 68 of the face: auto where they are large enough, on however small, "
                 "off (default: " +
                     unless_given + ")")
      ->transform(CLI::CheckedTransformer(choices, CLI::ignore_case).description(""))
      ->group(group)
      ->type_name("");
}

}  // namespace bodyloom
