// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>

#include "apps/exec_beside.h"
#include "apps/progress.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"
#include "pipelines/score/compare_results.h"

namespace bodyloom {
namespace {

constexpr const char* kMetricsFooter =
    "What is compared:\n"
    "  two folders of images     matched by name without extension\n"
    "  two videos                  frame by frame\n"
    "  two single-person datasets  images/, labels/ (grey, 0 to 6) and normals/ (n = 2c/255 - 1), each by its own\n"
    "                              metrics, as far as both have them\n"
    "SSIM is never one number; docs/image_metrics.md says what each preset is and who uses it. --mask adds PSNR "
    "inside\n"
    "the mask, bounds the normals, and gives --preset neuralbody its box; other presets look at the whole picture.\n"
    "Means and standard deviations are over frames; frames of equal images (PSNR inf) are counted apart.\n"
    "Do clothes react to motion? --other-truth and --other-result are single-person datasets of the same poses at\n"
    "another speed (synth-person --speed; --set of animate motion, animate avatar); how the garment changes from\n"
    "speed to speed is compared with how it should.\n"
    "Examples:\n"
    "  bodyloom metrics --truth clip/images --result run/frames --json errors.json --csv frames.csv\n"
    "  bodyloom metrics --truth clip.mp4 --result rendered.mp4 --preset 3dgs\n\n";

}  // namespace

void AddMetricsVerb(CLI::App& app, Action* action, std::vector<std::string> arguments, MoreMetrics more) {
  CLI::App* verb = app.add_subcommand("metrics", "Compares images with the truth: PSNR, SSIM, labels, normals");
  verb->footer(std::string(kMetricsFooter) + kExitCodeHelp);
  auto request = std::make_shared<CompareResultsRequest>();
  auto quiet = std::make_shared<bool>(false);
  auto preset = std::make_shared<std::string>(ToText(request->preset));
  CompareResultsRequest& c = *request;
  verb->add_option("--truth", c.truth, "folder or video with the truth")->required()->type_name("PATH");
  verb->add_option("--result", c.result, "folder or video to judge")->required()->type_name("PATH");
  verb->add_option("--mask", c.mask, "folder or video of masks: pixels of 128 or more count")->type_name("PATH");
  verb->add_option("--preset", *preset, "which SSIM")->check(CLI::IsMember(SsimPresetNames()))->capture_default_str();
  CLI::Option* other_truth =
      verb->add_option("--other-truth", c.other_truth, "dataset of the same poses as --truth at another speed")
          ->type_name("DIR");
  CLI::Option* other_result =
      verb->add_option("--other-result", c.other_result, "dataset to judge against it")->type_name("DIR");
  other_truth->needs(other_result), other_result->needs(other_truth);
  auto reacting = std::make_shared<std::string>(kPersonLabelNames[static_cast<int>(c.reacting)]);
  verb->add_option("--reacting", *reacting, "the garment whose reaction is measured")
      ->check(CLI::IsMember({"top", "bottom"}))
      ->needs(other_truth)
      ->capture_default_str();
  verb->add_flag("--common", c.common_only, "compare the frames that both folders have, instead of asking for all");
  verb->add_option("--json", c.json, "also write the means as JSON")->type_name("FILE");
  verb->add_option("--csv", c.csv, "also write a line a frame")->type_name("FILE");
  CLI::Option* images = verb->add_option(
      "--pictures", c.pictures, "folder: of every pair of images truth, result and error in colours, side by side");
  images->type_name("DIR");
  verb->add_option("--error-max", c.error_maximum, "of the images: error of the last colour, grey levels")
      ->check(CLI::PositiveNumber)
      ->type_name("NUMBER")
      ->needs(images)
      ->capture_default_str();
  verb->add_option("--threads", c.num_threads, "0: all cores; numbers are the same for any number")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
  auto lpips = std::make_shared<bool>(false);
  auto weights = std::make_shared<std::string>();
  CLI::Option* with_lpips = verb->add_flag(
      "--lpips", *lpips,
      "also LPIPS and tLPIPS; without --weights by a random-feature substitute that compares with nothing else");
  verb->add_option("--weights", *weights, "folder with alexnet and lpips_alex, .pth or .safetensors")
      ->type_name("DIR")
      ->needs(with_lpips);
  verb->add_flag("--quiet", *quiet, "no progress");
  verb->callback([request, quiet, preset, reacting, lpips, weights, action, arguments = std::move(arguments),
                  more = std::move(more)] {
    request->preset = SsimPresetFrom(*preset).value();
    request->reacting = *reacting == "top" ? PersonLabel::kTop : PersonLabel::kBottom;
    *action = [=] {
      if (*lpips && !more) ExecNeural(arguments);
      if (*lpips) request->more = more(*weights);
      std::cout << ToText(CompareResults(*request, CommandCallbacks(*quiet)));
    };
  });
}

}  // namespace bodyloom
