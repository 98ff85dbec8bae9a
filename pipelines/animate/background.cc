// SPDX-License-Identifier: Apache-2.0
#include "pipelines/animate/background.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>

#include "data_tools/video/image_file.h"

namespace bodyloom {

Image Covering(const Image& image, int width, int height) {
  const double scale = std::max(static_cast<double>(width) / image.width, static_cast<double>(height) / image.height);
  const int w = std::max(width, static_cast<int>(std::lround(image.width * scale)));
  const int h = std::max(height, static_cast<int>(std::lround(image.height * scale)));
  Image covering(width, height);
  Paste(Resized(image, w, h), (width - w) / 2, (height - h) / 2, &covering);
  return covering;
}

Background::Background(const std::string& path, int width, int height) : width_(width), height_(height) {
  if (path.empty()) {
    image_ = StudioBackdrop(width, height);
  } else if (IsImageName(path)) {
    image_ = Covering(ReadImage(path), width, height);
  } else {
    video_ = std::make_unique<VideoReader>(path);
  }
}

const Image& Background::Next() {
  Image frame;
  if (video_ && video_->Read(&frame)) image_ = Covering(frame, width_, height_);
  return image_;
}

ImageSize SizeOfImages(const PersonWindow& window, const Camera& camera, bool full_size) {
  if (full_size) return {camera.width, camera.height};
  return {window.image_width, window.image_height};
}

void Composite(std::span<const float> image, std::span<const float> alpha, const PersonWindow& window, int t,
               Image* canvas) {
  const auto area = static_cast<size_t>(window.width) * window.height;
  const WindowSampler window_at(window, t, canvas->width, canvas->height);
  for (int y = 0; y < canvas->height; ++y) {
    if (window_at.RowIsOutside(y)) continue;
    for (int x = 0; x < canvas->width; ++x) {
      if (window_at.ColumnIsOutside(x)) continue;
      const float behind = 1 - window_at.At(alpha, x, y);
      uint8_t* to = canvas->pixel(x, y);
      for (int c = 0; c < 3; ++c) {
        const float value =
            255 * window_at.At(image.subspan(area * (2 - c), area), x, y) + behind * static_cast<float>(to[c]);
        to[c] = static_cast<uint8_t>(std::lround(std::clamp(value, 0.0F, 255.0F)));
      }
    }
  }
}

WindowSampler::WindowSampler(const PersonWindow& window, int t, int image_width, int image_height)
    : width_(window.width),
      height_(window.height),
      columns_(Places(image_width, static_cast<double>(window.image_width) / image_width, window.corner[t].x())),
      rows_(Places(image_height, static_cast<double>(window.image_height) / image_height, window.corner[t].y())) {}

std::vector<WindowSampler::Between> WindowSampler::Places(int count, double scale, int corner) {
  std::vector<Between> places(count);
  for (int i = 0; i < count; ++i) {
    const double at = (i + 0.5) * scale - 0.5 - corner, below = std::floor(at);
    places[i] = {static_cast<int>(below), static_cast<float>(at - below)};
  }
  return places;
}

float WindowSampler::At(std::span<const float> plane, int x, int y) const {
  const Between row = rows_[y], column = columns_[x];
  float sum = 0;
  for (int v = 0; v < 2; ++v) {
    for (int u = 0; u < 2; ++u) {
      const int i = row.first + v, j = column.first + u;
      const float weight =
          (v == 0 ? 1 - row.to_second : row.to_second) * (u == 0 ? 1 - column.to_second : column.to_second);
      if (weight > 0 && i >= 0 && i < height_ && j >= 0 && j < width_) sum += weight * plane[i * width_ + j];
    }
  }
  return sum;
}

int WindowSampler::Nearest(int x, int y) const {
  const int i = rows_[y].first + (rows_[y].to_second >= 0.5F ? 1 : 0);
  const int j = columns_[x].first + (columns_[x].to_second >= 0.5F ? 1 : 0);
  return i >= 0 && i < height_ && j >= 0 && j < width_ ? i * width_ + j : -1;
}

namespace {

SinglePersonDatasetInfo InfoOf(const Track& track, double fps, bool labels, bool normals, const std::string& command) {
  SinglePersonDatasetInfo info;
  info.num_frames = track.num_frames();
  info.width = track.camera.width, info.height = track.camera.height;
  info.fps = fps;
  info.has = {labels, normals, false, false};
  info.command = command;
  return info;
}

}  // namespace

PersonFrame SetFrameOf(const MotionImage& image, const PersonWindow& window, int t, const Image& composed) {
  PersonFrame frame;
  frame.rgb = composed;
  if (!image.labels.empty()) frame.labels = Image(composed.width, composed.height);
  if (!image.normals.empty()) frame.normals = Image(composed.width, composed.height);
  const WindowSampler window_at(window, t, composed.width, composed.height);
  const auto area = static_cast<size_t>(window.width) * window.height;
  for (int y = 0; y < composed.height; ++y) {
    for (int x = 0; x < composed.width; ++x) {
      const int nearest = window_at.Nearest(x, y);
      if (nearest < 0) continue;
      if (!image.labels.empty()) std::fill_n(frame.labels.pixel(x, y), 3, image.labels[nearest]);
      if (image.normals.empty() || (!image.labels.empty() && image.labels[nearest] == 0)) continue;
      std::array<float, 3> n{};
      for (size_t k = 0; k < 3; ++k) n[k] = window_at.At(std::span(image.normals).subspan(area * k, area), x, y);
      const float length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
      if (!(length > 0)) continue;
      for (size_t k = 0; k < 3; ++k) frame.normals.pixel(x, y)[2 - k] = NormalCode(n[k] / length);
    }
  }
  return frame;
}

RenderedDataset::RenderedDataset(const std::string& path, const Track& track, double fps, bool labels, bool normals,
                                 const std::string& command)
    : info_(InfoOf(track, fps, labels, normals, command)), writer_(path, info_, track) {}

void RenderedDataset::Add(int t, PersonFrame frame) {
  for (const auto& [has, plane] : {std::pair{info_.has.labels, &frame.labels}, {info_.has.normals, &frame.normals}}) {
    if (has && plane->empty()) *plane = Image(frame.rgb.width, frame.rgb.height);
  }
  writer_.Write(t, frame);
}

void RenderedDataset::Add(int t, const MotionImage& image, const PersonWindow& window, const Image& composed) {
  Add(t, SetFrameOf(image, window, t, composed));
}

void RenderedDataset::Finish() const { writer_.Finish(); }

}  // namespace bodyloom
