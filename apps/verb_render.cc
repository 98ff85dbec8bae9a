// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "apps/progress.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"
#include "pipelines/render/render_track.h"

namespace bodyloom {
namespace {

constexpr const char* kRenderFooter =
    "What is shown:\n"
    "  overlay  the body, shaded, over the video or in a studio with a floor\n"
    "  iuv      chart coordinates: red u, green v, blue the part   parts   DensePose's 24 charts in colours\n"
    "  normal   the surface's direction in the camera frame        depth   metres: warm near, cold far\n"
    "  texture  an image in the body's UV atlas (--texture), on the body\n"
    "  error    how far each vertex is from another track's (--truth): violet 0, yellow --error-max and more\n"
    "What is written, by the ending of --out:\n"
    "  .mp4     every frame                 .png    a contact sheet of up to 12 frames, to judge a run at a glance\n"
    "  .npz     numbers: frames, timestamps, frame_status, K, image_size and, T frames of H x W pixels:\n"
    "           part uint8 (0: nobody), uv float32 T*H*W*2, normal float32 T*H*W*3, depth float32 in metres (inf:\n"
    "           nobody), error float32 (NaN: nobody), rgb and mask uint8; with a new view also view_rotation,\n"
    "           view_translation: x_view = R x + t\n"
    "Frames that the track has lost are shown without a body and counted. A video frame is found by the track's\n"
    "timestamp: a longer video's rest is left out, where it is too short a plain background stands in and is counted.\n"
    "Examples:\n"
    "  bodyloom render --track track.npz --what overlay --video clip.mp4 --out overlay.mp4\n"
    "  bodyloom render --track track.npz --what parts --out parts.png\n"
    "  bodyloom render --track track.npz --what overlay --view-yaw 90 --out left.mp4      from the person's left\n"
    "  bodyloom render --track track.npz --what normal --frames 42 --turntable --out turn.mp4\n"
    "  bodyloom render --track track.npz --what iuv --frames 0:30 --out iuv.npz\n"
    "  bodyloom render --track track.npz --what error --truth clip/truth.npz --error-unit px --out errors.png\n\n";

struct RenderArguments {
  RenderTrackRequest request;
  std::string what, unit = "mm";
  bool quiet = false;
};

void Render(const RenderArguments& arguments) {
  RenderTrackRequest request = arguments.request;
  request.what = RenderKindFromString(arguments.what);
  request.error_unit = arguments.unit == "px" ? VertexErrorUnit::kPixels : VertexErrorUnit::kMillimetres;
  const RenderTrackReport report = RenderTrack(request, CommandCallbacks(arguments.quiet));
  if (!arguments.quiet) {
    std::cout << ToText(report);
  }
}

}  // namespace

void AddRenderVerb(CLI::App& app, Action* action) {
  CLI::App* verb =
      app.add_subcommand("render", "Shows a track: overlay, parts, IUV, normals, depth, texture, errors; any side");
  verb->footer(std::string(kRenderFooter) + kExitCodeHelp);
  auto arguments = std::make_shared<RenderArguments>();
  RenderTrackRequest& c = arguments->request;
  verb->add_option("--track", c.track, "the track, .npz")->required()->type_name("FILE");
  verb->add_option("--what", arguments->what, "what to show (below)")
      ->required()
      ->check(CLI::IsMember({"overlay", "iuv", "parts", "normal", "depth", "texture", "error"}))
      ->type_name("KIND");
  verb->add_option("--out", c.out, "where to write it: .mp4, .png or .npz")->required()->type_name("FILE");
  verb->add_option("--video", c.video, "what the person was filmed with, as background")->type_name("FILE");
  verb->add_option("--body", c.body, BodyHelp("the track's body"))->type_name("FILE");
  verb->add_option("--frames", c.frames, "only frames a to b-1; one number: that frame (default: all)")
      ->type_name("a:b");
  verb->add_option("--view-yaw", c.view_yaw_deg,
                   "see the person from the side: degrees about the vertical, 90 is from its left; the camera "
                   "follows the person")
      ->check(CLI::Range(-3600.0, 3600.0))
      ->type_name("DEG");
  verb->add_flag(
      "--turntable", c.turntable,
      "that camera makes one full turn over the frames (one frame: the pose is held, 120 images or 12 cells)");
  verb->add_option("--texture", c.texture, "for --what texture: the image, laid out in the body's atlas")
      ->type_name("FILE");
  verb->add_option("--truth", c.truth, "for --what error: the track to compare with, .npz")->type_name("FILE");
  verb->add_option("--error-unit", arguments->unit,
                   "mm: vertices, pelvis on pelvis; px: projections, longer side 512 px")
      ->check(CLI::IsMember({"mm", "px"}))
      ->capture_default_str();
  verb->add_option("--error-max", c.error_maximum, "error of the last colour (default: 50 mm, 20 px)")
      ->check(CLI::PositiveNumber)
      ->type_name("NUMBER");
  verb->add_option("--json", c.json, "what was done, for a program")->type_name("FILE");
  verb->add_option("--threads", c.num_threads, "0: all cores; images are the same for any number")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
  verb->add_flag("--quiet", arguments->quiet, "only errors");
  verb->callback([arguments, action] { *action = [arguments] { Render(*arguments); }; });
}

}  // namespace bodyloom
