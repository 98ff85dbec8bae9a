// SPDX-License-Identifier: Apache-2.0
#include "pipelines/animate/read_photos.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <numeric>
#include <stdexcept>

#include "data_tools/video/image_file.h"
#include "data_tools/video/video_reader.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

/// Reads a still or an image of a folder; returns false for what can only be a video.
bool ReadStill(const ImageRequest& request, PhotoFile* image) {
  if (std::filesystem::is_directory(request.path)) {
    const std::vector<std::string> files = ImageFilesOf(request.path);
    if (request.frame >= static_cast<int>(files.size())) {
      throw std::runtime_error(
          Concatenate(request.path, ": ", files.size(), " images, requested number ", request.frame));
    }
    *image = ReadPhoto(files[request.frame]);
    return true;
  }
  if (IsImageName(request.path)) {
    *image = ReadPhoto(request.path);
    return true;
  }
  try {
    *image = ReadPhoto(request.path);
    return true;
  } catch (const std::runtime_error&) {
    return false;  // a video, or nothing at all, which its reader will say
  }
}

}  // namespace

std::vector<PhotoFile> ReadImages(std::span<const ImageRequest> requests) {
  std::vector<PhotoFile> images(requests.size());
  std::map<std::string, std::vector<size_t>> videos;
  for (size_t i = 0; i < requests.size(); ++i) {
    if (videos.count(requests[i].path) > 0 || !ReadStill(requests[i], &images[i])) {
      videos[requests[i].path].push_back(i);
    }
  }
  for (auto& [path, wanted] : videos) {
    std::stable_sort(wanted.begin(), wanted.end(),
                     [&](size_t a, size_t b) { return requests[a].frame < requests[b].frame; });
    VideoReader video(path);
    Image image;
    for (const size_t i : wanted) {
      const int frame = requests[i].frame;
      video.Skip(std::max(0, frame - video.next_frame()));
      if (video.next_frame() == frame && !video.Read(&image)) {
        throw std::runtime_error(Concatenate(path, ": ", video.next_frame(), " frames, requested frame ", frame));
      }
      if (video.next_frame() < frame) {
        throw std::runtime_error(Concatenate(path, ": ", video.next_frame(), " frames, requested frame ", frame));
      }
      images[i].image = image;
    }
  }
  return images;
}

}  // namespace bodyloom
