// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>

#include "apps/detector_options.h"
#include "apps/progress.h"
#include "apps/track_options.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"
#include "pipelines/live/run_live.h"

namespace bodyloom {
namespace {

constexpr const char* kLiveFooter =
    "The source is a camera (/dev/video0), a stream (rtsp://, http://, udp:// ...) or a video, played at its own "
    "pace.\n"
    "Frames that cannot be looked at in time are passed over, so the delay stays the same. Ctrl-C ends it.\n"
    "Examples:\n"
    "  the camera, in the browser at http://127.0.0.1:8080/\n"
    "    bodyloom live /dev/video0\n"
    "  a phone that streams, for VSeeFace, Blender or Unreal (VMC receiver at port 39539)\n"
    "    bodyloom live rtsp://phone.local:8554/live --osc 127.0.0.1:39539\n"
    "  a video for a program, frame by frame, and no page\n"
    "    bodyloom live clip.mp4 --pace 0 --jsonl - --no-page | ./my_program\n\n";

/// "1280x720" into two numbers.
void AddCameraSize(CLI::App& app, LiveVideoOptions* video, const std::string& group) {
  app.add_option_function<std::string>(
         "--camera-size",
         [video](const std::string& text) {
           char rest = 0;
           const int n = std::sscanf(text.c_str(), "%dx%d%c", &video->width, &video->height, &rest);
           if (n != 2 || video->width <= 0 || video->height <= 0) {
             throw CLI::ValidationError("--camera-size", "'" + text + "', expected WIDTHxHEIGHT as in 1280x720");
           }
         },
         "pixels that the camera is asked for (default: its own choice)")
      ->group(group)
      ->type_name("WxH");
}

void AddSourceOptions(CLI::App& app, RunLiveRequest* request) {
  constexpr const char* kSource = "The source";
  app.add_option("SOURCE,--video", request->track.video, "a camera, the address of a stream, or a video")
      ->required()
      ->type_name("SOURCE");
  app.add_option("--pace", request->video.pace,
                 "of a video: so many times as fast as it is played; 0: frame by frame, none is passed over")
      ->group(kSource)
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  AddCameraSize(app, &request->video, kSource);
  app.add_option("--camera-fps", request->video.fps, "frames a second that the camera is asked for")
      ->group(kSource)
      ->type_name("HZ")
      ->check(CLI::PositiveNumber);
  app.add_option("--timeout", request->video.timeout_s,
                 "a camera or stream that is silent for so many seconds is lost, and looked for")
      ->group(kSource)
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  app.add_option("--seconds", request->max_seconds, "end after so many seconds (default: with the source)")
      ->group(kSource)
      ->check(CLI::PositiveNumber);
  app.add_option("--rotate", request->track.turn_deg, "turn the frames clockwise by 90, 180 or 270 degrees")
      ->group(kSource)
      ->type_name("")
      ->check(CLI::IsMember({90, 180, 270}));
}

void AddOutputOptions(CLI::App& app, RunLiveRequest* request) {
  constexpr const char* kResults = "Results";
  app.add_option("--listen", request->listen, "where the page is served; another address than 127.0.0.1 is open to all")
      ->group(kResults)
      ->type_name("ADDRESS:PORT")
      ->capture_default_str();
  app.add_flag_callback(
         "--no-page", [request] { request->listen = ""; }, "serve no page")
      ->group(kResults);
  app.add_option("--osc", request->osc, "send the body by the VMC protocol (OSC over UDP)")
      ->group(kResults)
      ->type_name("HOST:PORT");
  app.add_option("--jsonl", request->jsonl, "write a line of JSON for every frame; -: to standard output")
      ->group(kResults)
      ->type_name("FILE");
  app.add_option("--lag", request->lag,
                 "a frame's pose is given when so many more have come: each is smoother, and later")
      ->group(kResults)
      ->capture_default_str()
      ->check(CLI::Range(0, 60));
}

}  // namespace

void AddLiveVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("live", "A camera, a stream or a video to the body in it, as the frames come");
  verb->footer(std::string(kLiveFooter) + kExitCodeHelp);
  auto request = std::make_shared<RunLiveRequest>();
  request->listen = "127.0.0.1:8080";
  request->track.detector.blazepose.network = PoseNetworkSize::kFull;
  auto quiet = std::make_shared<bool>(false);
  AddSourceOptions(*verb, request.get());
  AddOutputOptions(*verb, request.get());
  AddDetectorOptions(*verb, &request->track.detector, nullptr, "Detection");
  AddCalibrationOptions(*verb, &request->track);
  AddLearnedOptions(*verb, &request->track);
  verb->add_flag("--quiet", *quiet, "nothing on the screen but the lines");
  verb->callback([=] {
    *action = [=] {
      const RunLiveReport report = RunLive(*request, CommandCallbacks(*quiet, std::cerr));
      if (!*quiet) std::cerr << ToText(report);
    };
  });
}

}  // namespace bodyloom
