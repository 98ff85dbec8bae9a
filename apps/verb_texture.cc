// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "apps/progress.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"
#include "pipelines/texture/extract_texture.h"

namespace bodyloom {
namespace {

constexpr const char* kTextureFooter =
    "Each texel of the body's UV atlas looks for itself in the frames: where the camera sees it, its colour is taken, "
    "and\n"
    "the best nine views are merged. Texels that no frame shows stay black, or are filled with --fill. Frames without "
    "a\n"
    "fit, and those that were only interpolated, are left out.\n"
    "Examples:\n"
    "  bodyloom texture --track track.npz --video clip.mp4 --out texture.png --fill\n"
    "  bodyloom texture --track track.npz --video clip.mp4 --out texture.png --every 5 --confidence seen.png\n\n";

struct TextureArguments {
  ExtractTextureRequest request;
  std::string merge = "median", fill_with = "pyramid";
  bool fill = false;
};

ExtractTextureRequest RequestOf(const TextureArguments& arguments) {
  ExtractTextureRequest request = arguments.request;
  if (arguments.merge == "mean") request.texture.merge = TextureExtractOptions::Merge::kMean;
  if (arguments.fill)
    request.texture.fill = arguments.fill_with == "laplace" ? TextureFill::kLaplace : TextureFill::kPyramid;
  return request;
}

}  // namespace

void AddTextureVerb(CLI::App& app, Action* action) {
  CLI::App* verb = app.add_subcommand("texture", "Takes the tracked person's texture from the video");
  verb->footer(std::string(kTextureFooter) + kExitCodeHelp);
  auto arguments = std::make_shared<TextureArguments>();
  ExtractTextureRequest& c = arguments->request;
  verb->add_option("--track", c.track, "the track, .npz")->required()->type_name("FILE");
  verb->add_option("--video", c.video, "the video, or a folder of images")->required()->type_name("PATH");
  verb->add_option("--out", c.out, "the texture, .png or .jpg")->required()->type_name("FILE");
  verb->add_option("--body", c.body, BodyHelp("the track's body"))->type_name("FILE");
  verb->add_option("--size", c.texture.size, "texels a side")->capture_default_str()->check(CLI::Range(1, 8192));
  verb->add_option("--every", c.every, "look at every n-th frame")->capture_default_str()->check(CLI::PositiveNumber);
  verb->add_option("--merge", arguments->merge, "median or mean of the best views")
      ->capture_default_str()
      ->check(CLI::IsMember(std::vector<std::string>{"median", "mean"}))
      ->type_name("KIND");
  verb->add_flag("--fill", arguments->fill, "fill what no frame shows, smoothly and across seams");
  verb->add_option("--fill-with", arguments->fill_with, "pyramid (fast) or laplace (smoothest)")
      ->capture_default_str()
      ->check(CLI::IsMember(std::vector<std::string>{"pyramid", "laplace"}))
      ->type_name("KIND");
  verb->add_option("--trust", c.texture.trust, "with --fill: texels seen worse than this (0 to 1) are filled, too")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 1.0));
  verb->add_option("--margin", c.texture.margin_px,
                   "pixels around the body's contours that are not used (default: 1 % of the person's height)")
      ->check(CLI::Range(0, 64));
  verb->add_option("--confidence", c.confidence, "how well each texel was seen, as a grey image")->type_name("FILE");
  verb->add_option("--json", c.json, "counts and times of the run")->type_name("FILE");
  verb->callback([arguments, action] {
    *action = [arguments] { std::cout << ToText(ExtractTexture(RequestOf(*arguments), CommandCallbacks())); };
  });
}

}  // namespace bodyloom
