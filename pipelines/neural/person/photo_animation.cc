// SPDX-License-Identifier: Apache-2.0
#include "pipelines/neural/person/photo_animation.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "data_tools/datasets/photo_segmentation.h"
#include "data_tools/observations/frame_numbers.h"
#include "geometry/base/callbacks.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "pipelines/animate/animation_limits.h"
#include "pipelines/neural/person/person_renderer.h"
#include "render/texture/complete/partial_texture.h"

namespace bodyloom {

std::vector<PhotoRequest> PhotosWanted(const PhotoAnimationRequest& request) {
  const LentGarment& garment = request.garment;
  if (garment.parts.empty() != garment.from.empty()) {
    throw RequestError("--garment-from and --parts belong together");
  }
  PartsNamed(garment.parts);
  std::vector<PhotoRequest> photos = {request.photo};
  for (const std::string& view : request.views) photos.push_back(ParsePhotoRequest(view, "--views", request.photo));
  if (!garment.from.empty()) photos.push_back(ParsePhotoRequest(garment.from, "--garment-from", request.photo));
  return photos;
}

std::set<int> FramesAmong(const std::vector<PhotoRequest>& photos, const std::string& data) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  std::set<int> frames;
  for (const PhotoRequest& photo : photos) {
    const fs::path image(photo.image), set(data);
    if (fs::equivalent(image, set, ignored) || fs::equivalent(image, set / "images", ignored)) {
      frames.insert(photo.frame);
    } else if (fs::equivalent(image.parent_path(), set / "images", ignored)) {
      frames.insert(static_cast<int>(FrameNumberFromName(image.filename().string())));
    }
  }
  return frames;
}

std::unique_ptr<PhotoMaps> MapsOfMotion(const PhotoAnimationRequest& request, const Photo& photo,
                                        const std::string& path, int size, int texture_size, Track* track) {
  RequireBodyOf(photo, *track, path);
  if (!request.shape_of_motion) track->motion.betas = photo.track.motion.betas;
  if (!request.iuv.empty() && !request.view_yaw.empty()) {
    throw RequestError("--iuv shows the motion as its images do: not with --view-yaw");
  }
  PhotoMapsOptions options;
  options.size = size;
  options.texture_size = texture_size;
  options.num_threads = ThreadsFor(request.threads);
  options.yaw_deg = ViewAngles(request.view_yaw, track->num_frames(), 0, track->num_frames() - 1);
  try {
    if (!request.iuv.empty()) {
      options.estimated = std::make_shared<const EstimatedPixels>(*photo.body, request.iuv, track->num_frames());
      options.yaw_deg.clear();
    }
    return std::make_unique<PhotoMaps>(*photo.body, *track, options);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
}

PhotoBackdrop::PhotoBackdrop(const PhotoBackground& background, const Photo& photo, ImageSize size) {
  if (background.own) {
    filled_ = Covering(FilledBackground(photo.image, photo.person), size.width, size.height);
  } else {
    background_.emplace(background.path, size.width, size.height);
  }
}

std::vector<int> PartsNamed(const std::vector<std::string>& names) {
  const std::pair<const char*, PersonLabel> groups[] = {{"top", PersonLabel::kTop},
                                                        {"bottom", PersonLabel::kBottom},
                                                        {"shoes", PersonLabel::kShoes},
                                                        {"head", PersonLabel::kFace},
                                                        {"arms", PersonLabel::kSkin}};
  std::vector<int> parts;
  for (const std::string& name : names) {
    const size_t before = parts.size();
    for (const auto& [group, label] : groups) {
      for (int part = 1; name == group && part < kPhotoParts; ++part) {
        if (LabelOfPart(part) == label) parts.push_back(part);
      }
    }
    int number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error == std::errc() && end == name.data() + name.size() && number >= 1 && number < kPhotoParts) {
      parts.push_back(number);
    }
    if (parts.size() == before) {
      throw RequestError("--parts " + name + ": expected top, bottom, shoes, head, arms or a DensePose part, 1 to 24");
    }
  }
  return parts;
}

void NoteLent(const LentGarment& garment, const Photo& lender, std::span<const uint8_t> texel_parts,
              std::string* notes) {
  const double share = VisibleShare(PartialTextureOf(lender.frame), TexelsOf(PartsNamed(garment.parts), texel_parts));
  if (!(share > 0)) {
    throw std::runtime_error("--garment-from " + garment.from + ": nothing of --parts is to be seen there");
  }
  *notes += Concatenate(garment.from, ": shows ", std::lround(100 * share), " % of --parts\n");
}

}  // namespace bodyloom
