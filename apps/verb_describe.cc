// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "apps/progress.h"
#include "apps/shown_motion_options.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"
#include "pipelines/describe/describe_clip.h"

namespace bodyloom {
namespace {

constexpr const char* kDescribeFooter =
    "OUT.npy holds frames x channels x height x width: the normal (3) and the velocities of this and the past frames "
    "(3\n"
    "each, m/s), as maps over the body's UV atlas. numpy.load(OUT, mmap_mode='r') opens it; OUT.json beside it names "
    "the\n"
    "channels, units and frames. Frames without a fit are zero and listed there.\n"
    "--frame:  camera  as the camera sees the motion\n"
    "          world   with the camera's pose from --cameras; without it the track's world, y up, z towards the "
    "camera\n"
    "          body    turned with the pelvis, its own motion taken out\n"
    "Examples:\n"
    "  bodyloom describe --track track.npz --out motion.npy --preview motion.png\n"
    "  bodyloom describe --track track.npz --out motion.npy --velocity backward --dtype f16 --threads 2\n\n";

struct DescribeArguments {
  DescribeClipRequest request;
  std::string dtype = "f32", channels = "all", weighting = "area";
  int size = 128;
};

DescribeClipRequest RequestOf(const DescribeArguments& arguments) {
  DescribeClipRequest request = arguments.request;
  DescribeTrackOptions& options = request.options;
  options.texels.width = options.texels.height = arguments.size;
  options.weighting = arguments.weighting == "angle" ? NormalWeighting::kAngle : NormalWeighting::kArea;
  options.half = arguments.dtype == "f16";
  options.normals = arguments.channels != "velocity";
  if (arguments.channels == "normal") options.past = 0;
  return request;
}

}  // namespace

void AddDescribeVerb(CLI::App& app, Action* action) {
  CLI::App* verb =
      app.add_subcommand("describe", "Exports a track's surface motion as UV maps: normals and velocities");
  verb->footer(std::string(kDescribeFooter) + kExitCodeHelp);
  auto arguments = std::make_shared<DescribeArguments>();
  DescribeArguments& a = *arguments;
  DescribeClipRequest& c = a.request;
  verb->add_option("--track", c.track, "the track, .npz")->required()->type_name("FILE");
  verb->add_option("--out", c.out, "where to write the maps, .npy (and .json beside it)")
      ->required()
      ->type_name("FILE");
  verb->add_option("--body", c.body, BodyHelp("the track's body"))->type_name("FILE");
  verb->add_option("--size", a.size, "texels a side")->capture_default_str()->check(CLI::Range(1, 16384));
  verb->add_option("--past", c.options.past, "velocity maps a frame, its own included")
      ->capture_default_str()
      ->check(CLI::Range(0, 1000));
  AddSurfaceMotionOptions(verb, &c.options, &c.cameras, &c.view);
  verb->add_option("--channels", a.channels, "all, normal or velocity")
      ->capture_default_str()
      ->check(CLI::IsMember(std::vector<std::string>{"all", "normal", "velocity"}))
      ->type_name("KIND");
  verb->add_option("--normals", a.weighting, "faces weighted by area or angle")
      ->capture_default_str()
      ->check(CLI::IsMember(std::vector<std::string>{"area", "angle"}))
      ->type_name("KIND");
  verb->add_option("--dtype", a.dtype, "f32 or f16")
      ->capture_default_str()
      ->check(CLI::IsMember(std::vector<std::string>{"f32", "f16"}))
      ->type_name("TYPE");
  verb->add_option("--gutter", c.options.texels.gutter, "texels around every chart that continue the surface")
      ->capture_default_str()
      ->check(CLI::Range(0, 64));
  verb->add_option("--every", c.options.every, "describe every n-th frame")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  verb->add_flag("--seen-only", c.options.seen_only, "texels that the frame's camera does not see are zero");
  verb->add_option("--preview", c.preview, "a sheet of a few frames, .png")->type_name("FILE");
  verb->add_option("--threads", c.options.num_threads, "threads")->capture_default_str()->check(CLI::Range(1, 1024));
  verb->add_option("--json", c.json, "counts and times of the run")->type_name("FILE");
  verb->callback([arguments, action] {
    *action = [arguments] { std::cout << ToText(DescribeClip(RequestOf(*arguments), CommandCallbacks())); };
  });
}

}  // namespace bodyloom
