// SPDX-License-Identifier: Apache-2.0
#include "neural/motion/frame_tensors.h"

#include <algorithm>
#include <functional>

#include "geometry/base/check.h"
#include "neural/base/device.h"

namespace bodyloom {
namespace {

using torch::Tensor;

/// B×channels×height×width from a field of each frame.
template <typename T>
Tensor Stack(std::span<const MotionFrame> frames, std::vector<T> MotionFrame::*field, const char* name,
             int64_t channels, int64_t height, int64_t width, torch::ScalarType type) {
  const auto B = static_cast<int64_t>(frames.size());
  Tensor result = torch::empty({B, channels, height, width}, type);
  const int64_t count = channels * height * width;
  for (int64_t b = 0; b < B; ++b) {
    const std::vector<T>& values = frames[b].*field;
    BODYLOOM_CHECK(static_cast<int64_t>(values.size()) == count, "motion renderer: a frame has ", values.size(),
                   " values of ", name, ", expected ", channels, "x", height, "x", width);
    std::copy(values.begin(), values.end(), result.data_ptr<T>() + b * count);
  }
  return OnDevice(result);
}

void CheckSizes(std::span<const MotionFrame> frames) {
  BODYLOOM_CHECK(!frames.empty(), "motion renderer: no frames");
  for (const MotionFrame& frame : frames) {
    BODYLOOM_CHECK(frame.width == frames[0].width && frame.height == frames[0].height, "motion renderer: a frame of ",
                   frame.width, "x", frame.height, " beside one of ", frames[0].width, "x", frames[0].height);
  }
}

template <typename T>
bool AllHave(std::span<const MotionFrame> frames, std::vector<T> MotionFrame::*field) {
  return std::none_of(frames.begin(), frames.end(), [&](const MotionFrame& frame) { return (frame.*field).empty(); });
}

}  // namespace

MotionInput InputOf(std::span<const MotionFrame> frames, const MotionConfig& config) {
  CheckSizes(frames);
  const int64_t h = frames[0].height, w = frames[0].width, U = config.profile.uv_size;
  MotionInput input;
  if (config.motion && config.descriptor == MotionDescriptor::kDense2d) {
    input.motion = Stack(frames, &MotionFrame::dense, "dense coordinates", config.motion_channels, h, w, torch::kFloat);
  } else if (config.motion) {
    input.motion = Stack(frames, &MotionFrame::motion, "motion maps", config.motion_channels, U, U, torch::kFloat);
  }
  input.uv = Stack(frames, &MotionFrame::uv, "UV", 2, h, w, torch::kFloat);
  input.body = Stack(frames, &MotionFrame::body, "body mask", 1, h, w, torch::kFloat);
  return input;
}

MotionTruth TruthOf(std::span<const MotionFrame> frames, const MotionConfig& config) {
  CheckSizes(frames);
  const int64_t h = frames[0].height, w = frames[0].width;
  MotionTruth truth;
  truth.image = Stack(frames, &MotionFrame::image, "the image", 3, h, w, torch::kFloat);
  if (AllHave(frames, &MotionFrame::normals)) {
    truth.normals = Stack(frames, &MotionFrame::normals, "normals", 3, h, w, torch::kFloat);
  }
  if (AllHave(frames, &MotionFrame::labels)) {
    const Tensor classes = Stack(frames, &MotionFrame::labels, "labels", 1, h, w, torch::kByte).to(torch::kLong);
    const int64_t largest = classes.max().item<int64_t>();
    BODYLOOM_CHECK(largest < config.num_labels, "motion renderer: label ", largest, ", expected 0 to ",
                   config.num_labels - 1);
    truth.labels = torch::zeros({static_cast<int64_t>(frames.size()), config.num_labels, h, w}, truth.image.options());
    truth.labels.scatter_(1, classes, 1);
    truth.foreground = (classes > 0).to(torch::kFloat);
  } else {
    truth.foreground = (truth.image.amax(1, true) > 0).to(torch::kFloat);
  }
  return truth;
}

MotionState MotionTruth::State(const MotionConfig& config) const {
  MotionState state;
  state.image = image;
  if (config.shape) {
    state.labels = labels.defined() ? labels
                                    : torch::zeros({image.size(0), config.num_labels, image.size(2), image.size(3)},
                                                   image.options());
  }
  if (config.normals) state.normals = normals.defined() ? normals : torch::zeros_like(image);
  return state;
}

}  // namespace bodyloom
