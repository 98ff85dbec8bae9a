// SPDX-License-Identifier: Apache-2.0
#include "neural/motion/person_box.h"

#include <algorithm>
#include <utility>

#include "geometry/base/check.h"
#include "neural/networks/aligned_box.h"

namespace bodyloom {

using torch::Tensor;

namespace {

/// Bounding box of the body; empty without a body.
PixelBox BodyBox(const MotionFrame& frame) {
  BODYLOOM_CHECK(frame.body.size() == size_t(frame.width) * frame.height, "motion renderer: a frame of ", frame.width,
                 "x", frame.height, " with ", frame.body.size(), " values of body mask");
  PixelBox box = {frame.width, frame.height, 0, 0};
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      if (!(frame.body[size_t(y) * frame.width + x] > 0)) continue;
      box = {std::min(box.x_begin, x), std::min(box.y_begin, y), std::max(box.x_end, x + 1),
             std::max(box.y_end, y + 1)};
    }
  }
  return box;
}

/// Crops planes of the frame's size.
template <class T>
std::vector<T> PlanesWithin(const std::vector<T>& planes, int width, int height, const PixelBox& box) {
  std::vector<T> result;
  const size_t area = size_t(width) * height;
  BODYLOOM_CHECK(area > 0 && planes.size() % area == 0, "motion renderer: a frame of ", width, "x", height,
                 " with images of ", planes.size(), " values, expected a multiple of its pixels");
  result.reserve(planes.size() / area * box.area());
  for (size_t plane = 0; plane < planes.size(); plane += area) {
    for (int y = box.y_begin; y < box.y_end; ++y) {
      const auto row = planes.begin() + static_cast<std::ptrdiff_t>(plane + size_t(y) * width);
      result.insert(result.end(), row + box.x_begin, row + box.x_end);
    }
  }
  return result;
}

}  // namespace

std::vector<PixelBox> PersonBoxes(std::span<const MotionFrame> frames, int reach, int multiple) {
  std::vector<PixelBox> needed;
  const PixelBox window = {0, 0, frames[0].width, frames[0].height};
  for (const MotionFrame& frame : frames) {
    BODYLOOM_CHECK(frame.width == window.x_end && frame.height == window.y_end, "motion renderer: a frame of ",
                   frame.width, "x", frame.height, " beside one of ", window.x_end, "x", window.y_end);
  }
  if (reach <= 0) return std::vector<PixelBox>(frames.size(), window);
  for (const MotionFrame& frame : frames) {
    const PixelBox body = BodyBox(frame);
    needed.push_back(body.empty() ? body : body.GrownBy(reach));
  }
  return AlignedBoxes(std::move(needed), window, multiple);
}

MotionFrame Within(MotionFrame frame, const PixelBox& box) {
  const auto cut = [&](auto* planes) { *planes = PlanesWithin(*planes, frame.width, frame.height, box); };
  cut(&frame.dense), cut(&frame.uv), cut(&frame.body);
  cut(&frame.image), cut(&frame.labels), cut(&frame.normals);
  frame.width = box.width(), frame.height = box.height();
  return frame;
}

Tensor Within(const Tensor& map, const PixelBox& box) {
  return map.slice(2, box.y_begin, box.y_end).slice(3, box.x_begin, box.x_end);
}

MotionState Within(const MotionState& state, const PixelBox& box) {
  MotionState result = state;
  for (Tensor* part : result.Parts()) *part = Within(*part, box);
  return result;
}

Tensor OnWindow(const Tensor& inside, const PixelBox& box, int64_t height, int64_t width) {
  if (inside.size(2) == height && inside.size(3) == width) return inside;
  Tensor result = torch::zeros({inside.size(0), inside.size(1), height, width}, inside.options());
  Within(result, box).copy_(inside);
  return result;
}

MotionState OnWindow(const MotionState& inside, const PixelBox& box, int64_t height, int64_t width) {
  MotionState result = inside;
  for (Tensor* part : result.Parts()) *part = OnWindow(*part, box, height, width);
  if (result.labels.defined() && !result.labels.is_same(inside.labels)) {
    Tensor background = result.labels.slice(1, 0, 1);
    background.fill_(1);
    Within(background, box).copy_(inside.labels.slice(1, 0, 1));
  }
  return result;
}

}  // namespace bodyloom
