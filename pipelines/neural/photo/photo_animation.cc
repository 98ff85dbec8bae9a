// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/neural/photo/photo_animation.h"

#include <filesystem>
#include <stdexcept>

#include "bodyloom/data_tools/observations/frame_numbers.h"
#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/pipelines/people/view_angles.h"

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
    throw RequestError("--iuv shows the motion as its pictures do: not with --view-yaw");
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

}  // namespace bodyloom
