// SPDX-License-Identifier: Apache-2.0
#include "pipelines/runs/run_config.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "data_tools/formats/json_reader.h"

namespace bodyloom {

std::string RunConfigPath(const std::string& run_dir) {
  return (std::filesystem::path(run_dir) / "config.json").string();
}

nlohmann::json ReadRunConfig(const std::string& run_dir, const std::string& program) {
  const std::string path = RunConfigPath(run_dir);
  if (!std::filesystem::exists(path)) {
    throw std::runtime_error(path + ": not there, expected the folder of a run of `" + program + "`");
  }
  nlohmann::json json = ReadJsonFile(path);
  const std::string found = JsonNode(json, path).At("program").Text();
  if (found != program) throw std::runtime_error(path + ": a run of \"" + found + "\", expected \"" + program + "\"");
  return json;
}

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

namespace {

constexpr const char* kPhotoProgram = "bodyloom train photo";

}  // namespace

std::string PhotoRunJson(const PhotoRun& run) {
  const PhotoProfile& p = run.config.profile;
  nlohmann::ordered_json json = {{"program", kPhotoProgram},
                                 {"version", BODYLOOM_VERSION},
                                 {"profile", p.name},
                                 {"variant", ToText(run.config.variant)},
                                 {"image_size", p.image_size},
                                 {"texture_size", p.texture_size},
                                 {"features", p.features},
                                 {"feature_widths", p.feature_widths},
                                 {"render_width", p.render_width},
                                 {"render_blocks", p.render_blocks},
                                 {"discriminator_width", p.discriminator_width},
                                 {"discriminator_layers", p.discriminator_layers},
                                 {"discriminator_scales", p.discriminator_scales},
                                 {"perceptual_divisor", p.perceptual_divisor},
                                 {"render_passes_input", p.render_passes_input ? 1 : 0},
                                 {"guesses_unseen", p.guesses_unseen ? 1 : 0},
                                 {"render_up_kernel", p.render_up_kernel},
                                 {"reach", run.reach}};
  if (!run.notes.empty()) json["run"] = nlohmann::ordered_json::parse(run.notes);
  return json.dump(2) + "\n";
}

PhotoRun ReadPhotoRun(const std::string& run_dir) {
  const std::string path = RunConfigPath(run_dir);
  const nlohmann::json json = ReadRunConfig(run_dir, kPhotoProgram);
  const JsonNode root(json, path);
  PhotoRun run;
  PhotoProfile& p = run.config.profile;
  p.name = root.At("profile").Text();
  try {
    run.config.variant = PhotoVariantNamed(root.At("variant").Text());
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
  const JsonNode widths = root.At("feature_widths");
  for (size_t i = 0; i < widths.size(); ++i) p.feature_widths.push_back(widths.At(i).Int());
  int passes_input = 0, guesses_unseen = 0;
  const std::pair<const char*, int*> numbers[] = {{"image_size", &p.image_size},
                                                  {"texture_size", &p.texture_size},
                                                  {"features", &p.features},
                                                  {"render_width", &p.render_width},
                                                  {"render_blocks", &p.render_blocks},
                                                  {"discriminator_width", &p.discriminator_width},
                                                  {"discriminator_layers", &p.discriminator_layers},
                                                  {"discriminator_scales", &p.discriminator_scales},
                                                  {"perceptual_divisor", &p.perceptual_divisor},
                                                  {"render_passes_input", &passes_input},
                                                  {"guesses_unseen", &guesses_unseen},
                                                  {"render_up_kernel", &p.render_up_kernel},
                                                  {"reach", &run.reach}};
  for (const auto& [key, value] : numbers) *value = root.At(key).Int();
  p.render_passes_input = passes_input != 0;
  p.guesses_unseen = guesses_unseen != 0;
  std::string why;
  if (!run.config.IsValid(&why)) throw std::runtime_error(path + ": " + why);
  if (run.reach < 0 || run.reach > p.image_size) {
    throw std::runtime_error(path + ": reach is " + std::to_string(run.reach) + ", expected 0 to " +
                             std::to_string(p.image_size));
  }
  return run;
}

}  // namespace bodyloom
