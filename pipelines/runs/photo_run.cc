// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/runs/photo_run.h"

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bodyloom/data_tools/formats/json_reader.h"
#include "bodyloom/pipelines/runs/run_config.h"

namespace bodyloom {
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
