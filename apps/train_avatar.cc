// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "apps/progress.h"
#include "apps/usage_error.h"
#include "apps/verbs.h"
#include "pipelines/gaussian_avatar/train_avatar.h"

namespace bodyloom {
namespace {

void RunTrainAvatar(const TrainAvatarRequest& request) {
  const TrainAvatarSummary summary = RunWithBar("learning the person", TrainAvatar, request);
  std::printf("%lld steps in %.0f s, %.1f ms each; %d Gaussians, %d of them off the skin; loss %.4f\n",
              static_cast<long long>(summary.steps), summary.training_seconds,
              1e3 * summary.training_seconds / static_cast<double>(summary.steps > 0 ? summary.steps : 1),
              summary.gaussians, summary.loose, summary.loss);
  if (summary.best_step > 0 && summary.best_step < summary.steps) {
    std::printf("the person is that of step %lld, the best on the frames held out\n",
                static_cast<long long>(summary.best_step));
  }
  if (summary.cloth > 0) {
    std::printf("a garment %.0f cm long was found and is simulated; %d Gaussians lie on it\n",
                100 * summary.garment_length_m, summary.cloth);
  }
  if (summary.cooldown_step > 0) {
    std::cout << "ended early: more steps no longer helped the frames held out; --all-steps goes on\n";
  }
  if (summary.training) std::cout << "frames learned from, " << ScoresText(*summary.training) << "\n";
  if (summary.validation) std::cout << "frames held out, " << ScoresText(*summary.validation) << "\n";
  if (summary.validation_refined) {
    std::cout << "the same after their poses were refined on these very images, "
              << ScoresText(*summary.validation_refined) << "\n";
  }
  if (summary.stopped) std::cout << "stopped; go on by --resume\n";
  for (const std::string& path : summary.written) std::cout << "wrote " << path << "\n";
}

}  // namespace

void AddTrainAvatar(CLI::App& train, Action* action) {
  CLI::App* verb = train.add_subcommand("avatar", "Learns one person's appearance as Gaussians on the body");
  auto request = std::make_shared<TrainAvatarRequest>();
  request->clip.threads = 0;
  verb->add_option("--data", request->clip.data,
                   "A video or folder of images, or a single-person dataset (bodyloom synth-person)")
      ->required();
  verb->add_option("--track", request->clip.track, "The clip's track (default: the single-person dataset's own)");
  verb->add_option(
      "--mask", request->clip.mask,
      "For a video: the person's mask (bodyloom detect --mask, bodyloom run --masks) or DensePose's parts");
  verb->add_option("--out", request->out, "Folder of the run")->required();
  verb->add_option("--body", request->clip.body, BodyHelp("The track's body"));
  verb->add_option("--train", request->train, "Frames to learn from, FIRST-LAST (default: the first four fifths)");
  verb->add_option("--validate", request->validate, "Frames to judge by (default: the last fifth)");
  CLI::Option* steps = verb->add_option("--steps", request->steps, "Steps, of one frame each")
                           ->check(CLI::Range(1.0, 1e8))
                           ->capture_default_str();
  verb->add_option("--minutes", request->minutes,
                   "Learn for so long instead; the result then depends on the machine's speed")
      ->check(CLI::Range(0.01, 1e5))
      ->excludes(steps);
  verb->add_option("--skin", request->skin_side, "Texels of a side of the atlas that the skin's Gaussians lie on")
      ->check(CLI::Range(16, 2048))
      ->capture_default_str();
  verb->add_option("--loose", request->loose, "Gaussians off the skin, at most")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  verb->add_option("--seed", request->seed, "Of places, order of frames and backgrounds")->capture_default_str();
  verb->add_option("--threads", request->clip.threads, "0: all cores; the result is the same for any number")
      ->check(CLI::Range(0, 1024));
  verb->add_option_function<std::string>(
          "--without", [request](const std::string&) { request->garment = false; },
          "garment: do not look for a skirt, dress or coat to simulate; cloth then follows the pose alone")
      ->check(CLI::IsMember({"garment"}));
  verb->add_flag("--all-steps", request->all_steps,
                 "Do not end earlier where more steps no longer help the frames held out");
  verb->add_flag("--refine", request->refine,
                 "Correct the poses of the frames learned from while the person is learned");
  verb->add_option(
      "--refined-track", request->refined_track,
      "In the end correct the poses of all frames, held-out ones too, by their images and write the track");
  verb->add_option("--refine-rounds", request->refine_rounds, "How often each frame comes for --refined-track")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  verb->add_flag("--resume", request->resume, "Go on with the run in --out, exactly as if it had not been left");
  verb->footer(
      "Needs no LibTorch. The camera stands still; the light is learned with the person.\n"
      "Writes avatar.npz, checkpoint.npz, config.json, metrics.csv, report.json and preview.png (truth and result of\n"
      "held-out frames) into the folder, with --refined-track also preview_refined.png.\n"
      "Example:\n"
      "  bodyloom run clip.mp4 --out people --people 1 --masks\n"
      "  bodyloom train avatar --data clip.mp4 --track people/person_0.npz --mask people/mask_0.npz --out run\n"
      "  bodyloom animate avatar --run run --track dance.npz --view-yaw 0:360 --out dance.mp4");
  verb->callback([request, action] { *action = [request] { RunTrainAvatar(*request); }; });
}

}  // namespace bodyloom
