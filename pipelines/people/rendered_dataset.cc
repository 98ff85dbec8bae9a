// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/people/rendered_dataset.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "bodyloom/pipelines/people/window_sampler.h"

namespace bodyloom {
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

PersonFrame SetFrameOf(const MotionPicture& picture, const PersonWindow& window, int t, const Image& composed) {
  PersonFrame frame;
  frame.rgb = composed;
  if (!picture.labels.empty()) frame.labels = Image(composed.width, composed.height);
  if (!picture.normals.empty()) frame.normals = Image(composed.width, composed.height);
  const WindowSampler window_at(window, t, composed.width, composed.height);
  const auto area = static_cast<size_t>(window.width) * window.height;
  for (int y = 0; y < composed.height; ++y) {
    for (int x = 0; x < composed.width; ++x) {
      const int nearest = window_at.Nearest(x, y);
      if (nearest < 0) continue;
      if (!picture.labels.empty()) std::fill_n(frame.labels.pixel(x, y), 3, picture.labels[nearest]);
      if (picture.normals.empty() || (!picture.labels.empty() && picture.labels[nearest] == 0)) continue;
      std::array<float, 3> n{};
      for (size_t k = 0; k < 3; ++k) n[k] = window_at.At(std::span(picture.normals).subspan(area * k, area), x, y);
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

void RenderedDataset::Add(int t, const MotionPicture& picture, const PersonWindow& window, const Image& composed) {
  Add(t, SetFrameOf(picture, window, t, composed));
}

void RenderedDataset::Finish() const { writer_.Finish(); }

}  // namespace bodyloom
