// SPDX-License-Identifier: Apache-2.0
#include "neural/motion/motion_config.h"

#include <sstream>
#include <stdexcept>

#include "geometry/base/check.h"

namespace bodyloom {

const MotionProfile& MotionProfileNamed(const std::string& name) {
  static const std::vector<MotionProfile> profiles = {
      {"paper", 512, 128, 16, 512, 16, {64, 128, 256}, {64, 128, 256, 512, 512}, 64, 1},
      {"cpu", 256, 128, 16, 256, 8, {16, 32, 64}, {16, 32, 64, 128}, 16, 4},
      {"tiny", 128, 64, 8, 128, 8, {8, 16, 32}, {8, 16, 32, 64}, 8, 8},
  };
  for (const MotionProfile& profile : profiles) {
    if (profile.name == name) return profile;
  }
  throw std::invalid_argument("profile \"" + name + "\": expected paper, cpu or tiny");
}

const char* ToText(MotionDescriptor descriptor) {
  return descriptor == MotionDescriptor::kSurface ? "surface" : "dense2d";
}

const std::vector<std::string>& MotionDescriptorNames() {
  static const std::vector<std::string> names = {ToText(MotionDescriptor::kSurface),
                                                 ToText(MotionDescriptor::kDense2d)};
  return names;
}

MotionDescriptor MotionDescriptorNamed(const std::string& name) {
  for (const MotionDescriptor descriptor : {MotionDescriptor::kSurface, MotionDescriptor::kDense2d}) {
    if (name == ToText(descriptor)) return descriptor;
  }
  throw std::invalid_argument("descriptor \"" + name + "\": expected surface or dense2d");
}

bool MotionConfig::IsValid(std::string* why) const {
  const InRange in_range(why);
  bool valid = in_range("image_size", profile.image_size, 32, 8192) && in_range("uv_size", profile.uv_size, 8, 4096) &&
               in_range("features", profile.features, 1, 1024) &&
               in_range("texture_size", profile.texture_size, 2, 4096) &&
               in_range("texture_features", profile.texture_features, 1, 1024) &&
               in_range("levels of the encoder", static_cast<int>(profile.encoder_widths.size()), 1, 8) &&
               in_range("levels of the decoders", static_cast<int>(profile.decoder_widths.size()), 1, 8) &&
               in_range("discriminator_width", profile.discriminator_width, 1, 1024) &&
               in_range("perceptual_divisor", profile.perceptual_divisor, 1, 64) &&
               in_range("motion_channels", motion_channels, 1, 4096) && in_range("num_labels", num_labels, 2, 256);
  for (const std::vector<int>* widths : {&profile.encoder_widths, &profile.decoder_widths}) {
    for (const int width : *widths) valid = valid && in_range("a width", width, 1, 4096);
  }
  const int multiple = 1 << profile.encoder_widths.size();
  if (valid && profile.uv_size % multiple != 0) {
    if (why != nullptr)
      *why = "uv_size " + std::to_string(profile.uv_size) + " is not a multiple of " + std::to_string(multiple);
    return false;
  }
  if (valid && descriptor == MotionDescriptor::kDense2d &&
      profile.encoder_widths.size() > profile.decoder_widths.size()) {
    if (why != nullptr) *why = "dense2d: the encoder has more levels than the decoders, whose images it works on";
    return false;
  }
  return valid;
}

std::string ToText(const MotionConfig& config) {
  std::ostringstream text;
  const MotionProfile& p = config.profile;
  text << "motion renderer; image " << p.image_size << "; uv " << p.uv_size << "; features " << p.features
       << "; texture " << p.texture_size << ' ' << p.texture_features << "; encoder";
  for (const int width : p.encoder_widths) text << ' ' << width;
  text << "; decoders";
  for (const int width : p.decoder_widths) text << ' ' << width;
  text << "; discriminator " << p.discriminator_width << "; motion channels " << config.motion_channels << "; labels "
       << config.num_labels << "; shape " << config.shape << "; normals " << config.normals << "; motion "
       << config.motion << "; surface " << config.surface << "; learned texture " << config.texture;
  if (config.around_body) text << "; around the body";  // older checkpoints use whole windows only
  if (config.descriptor == MotionDescriptor::kDense2d) text << "; descriptor " << ToText(config.descriptor);
  return text.str();
}

}  // namespace bodyloom
