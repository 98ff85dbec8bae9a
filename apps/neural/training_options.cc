// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/training_options.h"

#include <CLI/CLI.hpp>

#include "bodyloom/pipelines/clip_span.h"

namespace bodyloom {

void AddProfileOption(CLI::App* verb, std::string* profile) {
  verb->add_option("--profile", *profile, "Sizes of the networks")
      ->check(CLI::IsMember({"paper", "cpu", "tiny"}))
      ->capture_default_str();
}

void AddTrainingOptions(CLI::App* verb, TrainingRun* run, const char* seed_help) {
  verb->add_option("--validate-every", run->validate_every, "Steps")->capture_default_str();
  verb->add_option("--seed", run->seed, seed_help)->capture_default_str();
  verb->add_option("--threads", run->num_threads, "0: all cores")->capture_default_str();
  verb->add_option("--device", run->device, "Where the networks run")
      ->check(CLI::IsMember({"cpu", "cuda"}))
      ->capture_default_str();
  verb->add_flag("--resume", run->resume, "Go on with the run in --out");
}

std::vector<FrameRange> ParseFrameRanges(const std::vector<std::string>& texts, const char* option) {
  std::vector<FrameRange> ranges;
  for (const std::string& text : texts) {
    const auto [first, last] = ReadClipSpan(text, option);
    ranges.push_back({first, last + 1});
  }
  return ranges;
}

}  // namespace bodyloom
