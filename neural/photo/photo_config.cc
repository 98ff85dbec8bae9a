// SPDX-License-Identifier: Apache-2.0
#include "neural/photo/photo_config.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

const std::vector<std::pair<PhotoVariant, const char*>> kVariants = {{PhotoVariant::kFull, "full"},
                                                                     {PhotoVariant::kNoInt, "no-int"},
                                                                     {PhotoVariant::kInpaint, "ip"},
                                                                     {PhotoVariant::kWarp, "warp"},
                                                                     {PhotoVariant::kWarpCond, "warpcond"}};

}  // namespace

const PhotoProfile& PhotoProfileNamed(const std::string& name) {
  static const std::vector<PhotoProfile> profiles = {
      {"paper", 256, 256, 16, {64, 128, 256, 512, 1024}, 64, 6, 64, 3, 3, 1},
      {"cpu", 256, 256, 16, {16, 32, 64, 128, 256}, 16, 6, 16, 3, 3, 4, true, true, 4},
      {"tiny", 128, 128, 16, {8, 16, 32, 64, 128}, 16, 6, 8, 3, 2, 8, true, true, 4},
  };
  for (const PhotoProfile& profile : profiles) {
    if (profile.name == name) return profile;
  }
  throw std::invalid_argument("profile \"" + name + "\": expected paper, cpu or tiny");
}

PhotoVariant PhotoVariantNamed(const std::string& name) {
  for (const auto& [variant, text] : kVariants) {
    if (name == text) return variant;
  }
  throw std::invalid_argument("variant \"" + name + "\": expected full, no-int, ip, warp or warpcond");
}

const char* ToText(PhotoVariant variant) {
  return std::find_if(kVariants.begin(), kVariants.end(), [&](const auto& v) { return v.first == variant; })->second;
}

int PhotoConfig::TextureChannels() const {
  if (!Completes()) return 0;
  return variant == PhotoVariant::kInpaint ? 3 : profile.features;
}

int PhotoConfig::RenderChannels() const {
  if (Completes()) return TextureChannels();
  return variant == PhotoVariant::kWarp ? 3 : 6;
}

int PhotoConfig::SmallestSide() const {
  // A discriminator of n layers needs 4·2ⁿ pixels, each scale halves them; RenderNet needs 16.
  return std::max(16, 4 << (profile.discriminator_layers + profile.discriminator_scales - 1));
}

bool PhotoConfig::IsValid(std::string* why) const {
  const auto says = [&](const std::string& text) {
    if (why != nullptr) *why = text;
    return false;
  };
  const InRange in_range(why);
  const PhotoProfile& p = profile;
  if (!(in_range("image_size", p.image_size, 16, 4096) && in_range("texture_size", p.texture_size, 8, 4096) &&
        in_range("features", p.features, 3, 1024) &&
        in_range("number of feature_widths", static_cast<int>(p.feature_widths.size()), 2, 8) &&
        in_range("render_width", p.render_width, 1, 1024) && in_range("render_blocks", p.render_blocks, 0, 64) &&
        in_range("render_up_kernel", p.render_up_kernel, 3, 4) &&
        in_range("discriminator_width", p.discriminator_width, 1, 1024) &&
        in_range("discriminator_layers", p.discriminator_layers, 1, 8) &&
        in_range("discriminator_scales", p.discriminator_scales, 1, 8) &&
        in_range("perceptual_divisor", p.perceptual_divisor, 1, 32))) {
    return false;
  }
  for (const int width : p.feature_widths) {
    if (!in_range("a width", width, 1, 4096)) return false;
  }
  const int multiple = 1 << (p.feature_widths.size() - 1);
  if (p.texture_size % multiple != 0 || p.texture_size < 2 * multiple) {
    return says(Concatenate("texture_size is ", p.texture_size, ", expected a multiple of ", multiple,
                            ", at least twice that"));
  }
  if (p.image_size % 8 != 0 || p.image_size < SmallestSide()) {
    return says(Concatenate("image_size is ", p.image_size, ", expected a multiple of 8, at least ", SmallestSide()));
  }
  return true;
}

std::string ToText(const PhotoConfig& config) {
  std::ostringstream text;
  const PhotoProfile& p = config.profile;
  text << "photo renderer; variant " << ToText(config.variant) << "; image " << p.image_size << "; texture "
       << p.texture_size << "; features " << p.features << "; feature widths";
  for (const int width : p.feature_widths) text << ' ' << width;
  text << "; render " << p.render_width << " x " << p.render_blocks << "; discriminator " << p.discriminator_width
       << " x " << p.discriminator_layers << " x " << p.discriminator_scales << "; passes input "
       << p.render_passes_input << "; guesses unseen " << p.guesses_unseen << "; up kernel " << p.render_up_kernel;
  return text.str();
}

}  // namespace bodyloom
