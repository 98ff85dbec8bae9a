// SPDX-License-Identifier: Apache-2.0
#include "neural/guided/guided_config.h"

#include <sstream>
#include <stdexcept>
#include <utility>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using Flag = bool GuidedConfig::*;
const std::vector<std::pair<const char*, Flag>>& Flags() {
  static const std::vector<std::pair<const char*, Flag>> flags = {
      {"sil", &GuidedConfig::silhouettes},
      {"gar", &GuidedConfig::garments},
      {"source-silhouette", &GuidedConfig::source_silhouette},
      {"source-labels", &GuidedConfig::source_labels},
      {"latent", &GuidedConfig::latent},
      {"kl", &GuidedConfig::kl},
      {"pseudo-image", &GuidedConfig::pseudo_image},
      {"uv-appearance", &GuidedConfig::uv_appearance}};
  return flags;
}

}  // namespace

const GuidedProfile& GuidedProfileNamed(const std::string& name) {
  static const std::vector<GuidedProfile> profiles = {
      {"paper",
       256,
       512,
       {64, 128, 256, 512, 512},
       {64, 128, 256, 512, 512},
       {64, 128, 256, 512, 512},
       32,
       128,
       256,
       false,
       true,
       64,
       1,
       65 * 65},
      {"cpu",
       256,
       256,
       {8, 16, 32, 64, 64},
       {8, 16, 32, 64, 64},
       {16, 32, 64, 96, 96},
       8,
       16,
       32,
       true,
       false,
       16,
       4,
       1024,
       true,
       true,
       true,
       true},
      {"tiny",
       128,
       128,
       {8, 16, 32, 32},
       {8, 16, 32, 32},
       {8, 16, 32, 32},
       8,
       8,
       16,
       true,
       false,
       8,
       8,
       256,
       true,
       true,
       true,
       true},
  };
  for (const GuidedProfile& profile : profiles) {
    if (profile.name == name) return profile;
  }
  throw std::invalid_argument("profile \"" + name + "\": expected paper, cpu or tiny");
}

const std::vector<std::string>& GuidedParts() {
  static const std::vector<std::string> parts = [] {
    std::vector<std::string> names;
    for (const auto& [name, flag] : Flags()) names.emplace_back(name);
    return names;
  }();
  return parts;
}

void LeaveOut(const std::string& part, GuidedConfig* config) {
  for (const auto& [name, flag] : Flags()) {
    if (part != name) continue;
    config->*flag = false;
    return;
  }
  std::string names;
  for (const std::string& name : GuidedParts()) names += (names.empty() ? "" : ", ") + name;
  throw std::invalid_argument("part \"" + part + "\": expected " + names);
}

std::vector<std::string> LeftOut(const GuidedConfig& config) {
  std::vector<std::string> parts;
  for (const auto& [name, flag] : Flags()) {
    if (!(config.*flag)) parts.emplace_back(name);
  }
  return parts;
}

const char* ToText(MapCompletion completion) {
  switch (completion) {
    case MapCompletion::kNone:
      return "none";
    case MapCompletion::kVirtualViews:
      return "virtual views";
    case MapCompletion::kNearest:
      return "nearest texels";
  }
  return "";
}

bool GuidedConfig::IsValid(std::string* why) const {
  const auto fail = [&](const std::string& text) {
    if (why != nullptr) *why = text;
    return false;
  };
  const InRange in_range(why);
  const GuidedProfile& p = profile;
  const auto positive = [&](const char* what, const std::vector<int>& widths) {
    for (const int width : widths) {
      if (!in_range(what, width, 1, 4096)) return false;
    }
    return true;
  };
  if (!(in_range("image_size", p.image_size, 32, 8192) && in_range("texture_size", p.texture_size, 8, 8192) &&
        in_range("levels", Levels(), 1, 8) && positive("shape_widths", p.shape_widths) &&
        positive("encoder_widths", p.encoder_widths) && positive("decoder_widths", p.decoder_widths) &&
        in_range("full_width", p.full_width, 1, 4096) && in_range("modulation_width", p.modulation_width, 1, 4096) &&
        in_range("latent", p.latent, 1, 4096) && in_range("discriminator_width", p.discriminator_width, 1, 1024) &&
        in_range("perceptual_divisor", p.perceptual_divisor, 1, 64) &&
        in_range("contextual_points", p.contextual_points, 2, 1 << 20))) {
    return false;
  }
  if (p.encoder_widths.size() != p.shape_widths.size() || p.decoder_widths.size() != p.shape_widths.size()) {
    return fail("shape_widths, encoder_widths and decoder_widths have " + std::to_string(p.shape_widths.size()) + ", " +
                std::to_string(p.encoder_widths.size()) + " and " + std::to_string(p.decoder_widths.size()) +
                " levels, expected the same");
  }
  if (p.image_size % Multiple() != 0) {
    return fail("image_size " + std::to_string(p.image_size) + " is not a multiple of " + std::to_string(Multiple()));
  }
  return true;
}

std::string ToText(const GuidedConfig& config) {
  std::ostringstream text;
  const GuidedProfile& p = config.profile;
  const auto widths = [&](const char* name, const std::vector<int>& values) {
    text << "; " << name;
    for (const int width : values) text << ' ' << width;
  };
  text << "pose-guided renderer; image " << p.image_size;
  widths("shape", p.shape_widths);
  widths("encoders", p.encoder_widths);
  widths("decoder", p.decoder_widths);
  text << "; full " << p.full_width << "; modulation " << p.modulation_width << "; latent " << p.latent << "; one-hot "
       << p.one_hot_labels << "; spectral norm " << p.spectral_norm << "; discriminator " << p.discriminator_width
       << "; fill colours " << p.fill_colours << "; from body " << p.start_from_body << "; outline hints "
       << p.contour_hints;
  for (const auto& [name, flag] : Flags()) {
    // Completion of the maps concerns inference only; the networks are the same.
    if (flag != &GuidedConfig::uv_appearance) text << "; " << name << ' ' << config.*flag;
  }
  // Networks of older checkpoints saw in the target what was left out of the source.
  if (!config.source_silhouette || !config.source_labels) text << "; the same in the target";
  return text.str();
}

}  // namespace bodyloom
