// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/runs/guided_run.h"

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bodyloom/data_tools/formats/json_reader.h"
#include "bodyloom/pipelines/runs/run_config.h"

namespace bodyloom {
namespace {

constexpr const char* kGuidedProgram = "bodyloom train guided";

std::vector<std::pair<const char*, int*>> Numbers(GuidedRun* run) {
  GuidedProfile& p = run->config.profile;
  return {{"image_size", &p.image_size},
          {"texture_size", &p.texture_size},
          {"full_width", &p.full_width},
          {"modulation_width", &p.modulation_width},
          {"latent", &p.latent},
          {"discriminator_width", &p.discriminator_width},
          {"perceptual_divisor", &p.perceptual_divisor},
          {"contextual_points", &p.contextual_points},
          {"reach", &run->reach}};
}

std::vector<std::pair<const char*, std::vector<int>*>> Widths(GuidedRun* run) {
  GuidedProfile& p = run->config.profile;
  return {
      {"shape_widths", &p.shape_widths}, {"encoder_widths", &p.encoder_widths}, {"decoder_widths", &p.decoder_widths}};
}

/// Switches, as 0 and 1.
std::vector<std::pair<const char*, bool*>> Switches(GuidedRun* run) {
  return {{"one_hot_labels", &run->config.profile.one_hot_labels},
          {"spectral_norm", &run->config.profile.spectral_norm},
          {"fill_colours", &run->config.profile.fill_colours},
          {"start_from_body", &run->config.profile.start_from_body},
          {"outline_hints", &run->config.profile.contour_hints},
          {"nearest_texels", &run->config.profile.nearest_texels}};
}

}  // namespace

std::string GuidedRunJson(const GuidedRun& run) {
  GuidedRun copy = run;
  nlohmann::ordered_json json = {
      {"program", kGuidedProgram}, {"version", BODYLOOM_VERSION}, {"profile", run.config.profile.name}};
  for (const auto& [key, value] : Numbers(&copy)) json[key] = *value;
  for (const auto& [key, value] : Widths(&copy)) json[key] = *value;
  for (const auto& [key, value] : Switches(&copy)) json[key] = *value ? 1 : 0;
  json["without"] = LeftOut(run.config);
  if (!run.notes.empty()) json["run"] = nlohmann::ordered_json::parse(run.notes);
  return json.dump(2) + "\n";
}

GuidedRun ReadGuidedRun(const std::string& run_dir) {
  const std::string path = RunConfigPath(run_dir);
  const nlohmann::json json = ReadRunConfig(run_dir, kGuidedProgram);
  const JsonNode root(json, path);
  GuidedRun run;
  run.config.profile.name = root.At("profile").Text();
  for (const auto& [key, value] : Numbers(&run)) *value = root.At(key).Int();
  for (const auto& [key, value] : Widths(&run)) {
    const JsonNode widths = root.At(key);
    for (size_t i = 0; i < widths.size(); ++i) value->push_back(widths.At(i).Int());
  }
  for (const auto& [key, value] : Switches(&run)) *value = root.At(key).Int() != 0;
  const JsonNode without = root.At("without");
  for (size_t i = 0; i < without.size(); ++i) {
    try {
      LeaveOut(without.At(i).Text(), &run.config);
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(path + ": without: " + error.what());
    }
  }
  std::string why;
  if (!run.config.IsValid(&why)) throw std::runtime_error(path + ": " + why);
  if (run.reach < 0 || run.reach > run.config.profile.image_size) {
    throw std::runtime_error(path + ": reach is " + std::to_string(run.reach) + ", expected 0 to " +
                             std::to_string(run.config.profile.image_size));
  }
  return run;
}

}  // namespace bodyloom
