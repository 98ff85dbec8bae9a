// SPDX-License-Identifier: Apache-2.0
#include "neural/guided/guided_tensors.h"

#include <algorithm>

#include "geometry/base/check.h"
#include "neural/base/device.h"
#include "neural/networks/aligned_box.h"
#include "render/texture/complete/body_part_map.h"

namespace bodyloom {
namespace {

using torch::Tensor;

template <typename T>
Tensor Filled(const std::vector<T>& values, const char* name, int64_t channels, int size, torch::ScalarType type) {
  BODYLOOM_CHECK(static_cast<int64_t>(values.size()) == channels * size * size, "pose-guided renderer: a frame has ",
                 values.size(), " values of ", name, ", expected ", channels, "x", size, "x", size);
  Tensor tensor = torch::empty({1, channels, size, size}, type);
  std::copy(values.begin(), values.end(), tensor.data_ptr<T>());
  return OnDevice(tensor.to(torch::kFloat));
}

/// Box of the frame's body, grown by `reach` pixels, and of its labels; empty if there is neither.
PixelBox AroundPerson(const PhotoFrame& frame, int reach) {
  PixelBox around = {1 << 30, 1 << 30, 0, 0};
  for (int y = 0; y < frame.size; ++y) {
    for (int x = 0; x < frame.size; ++x) {
      const size_t i = size_t(y) * frame.size + x;
      const bool body = frame.parts[i] != 0;
      if (!body && (frame.labels.empty() || frame.labels[i] == 0)) continue;
      const int grow = body ? reach : 0;
      around = {std::min(around.x_begin, x - grow), std::min(around.y_begin, y - grow),
                std::max(around.x_end, x + 1 + grow), std::max(around.y_end, y + 1 + grow)};
    }
  }
  return around;
}

CodeBox CellsOf(const PixelBox& box, int multiple) {
  return {box.x_begin / multiple, box.y_begin / multiple, box.width() / multiple, box.height() / multiple};
}

/// Crops each of B maps to its own box with `scale` values per cell; undefined maps stay undefined.
Tensor CropEach(const Tensor& map, std::span<const CodeBox> boxes, int scale) {
  if (!map.defined()) return map;
  std::vector<Tensor> cropped;
  for (size_t b = 0; b < boxes.size(); ++b) {
    const auto at = static_cast<int64_t>(b);
    const CodeBox& box = boxes[b];
    cropped.push_back(
        Cropped(map.slice(0, at, at + 1), {box.x * scale, box.y * scale, box.width * scale, box.height * scale}));
  }
  return torch::cat(cropped, 0);
}

}  // namespace

GuidedTensors TensorsOf(std::span<const PhotoFrame> frames) {
  BODYLOOM_CHECK(!frames.empty(), "pose-guided renderer: no frames");
  std::vector<Tensor> poses, classes, images;
  for (const PhotoFrame& frame : frames) {
    BODYLOOM_CHECK(frame.size == frames[0].size && frame.size > 0, "pose-guided renderer: a frame of ", frame.size,
                   " px beside one of ", frames[0].size);
    BODYLOOM_CHECK(frame.parts.size() == size_t(frame.size) * frame.size, "pose-guided renderer: a frame has ",
                   frame.parts.size(), " parts, expected ", frame.size, "x", frame.size);
    poses.push_back(Filled(BodyPartMap(frame.parts), "the pose map", 3, frame.size, torch::kFloat));
    if (frame.image.empty() || frame.labels.empty()) continue;
    images.push_back(Filled(frame.image, "the image", 3, frame.size, torch::kFloat));
    classes.push_back(Filled(frame.labels, "the labels", 1, frame.size, torch::kByte));
    const float largest = classes.back().max().item<float>();
    BODYLOOM_CHECK(largest < kPhotoLabels, "pose-guided renderer: label ", largest, ", expected 0 to ",
                   kPhotoLabels - 1);
  }
  GuidedTensors tensors;
  tensors.pose = torch::cat(poses, 0);
  if (images.size() != frames.size()) return tensors;
  tensors.classes = torch::cat(classes, 0);
  tensors.silhouette = (tensors.classes > 0).to(torch::kFloat);
  tensors.image = torch::cat(images, 0) * tensors.silhouette;
  return tensors;
}

GuidedPseudo PseudoOf(std::span<const PseudoImage> pseudo) {
  std::vector<Tensor> classes, images, silhouettes, clothes_offsets;
  for (const PseudoImage& one : pseudo) {
    classes.push_back(Filled(one.labels, "pseudo labels", 1, one.size, torch::kByte));
    images.push_back(Filled(one.image, "the pseudo image", 3, one.size, torch::kFloat));
    silhouettes.push_back(Filled(one.known, "the pseudo silhouette", 1, one.size, torch::kByte));
    const auto field = [&](const std::vector<float>& values, const char* name) {
      return values.empty() ? torch::zeros_like(silhouettes.back()) : Filled(values, name, 1, one.size, torch::kFloat);
    };
    clothes_offsets.push_back(
        torch::cat({field(one.clothes_offset, "the offset of clothes"), field(one.clothed, "the clothed body")}, 1));
  }
  const Tensor labels = torch::cat(classes, 0);
  return {labels, torch::cat(images, 0), torch::cat(silhouettes, 0), labels, torch::cat(clothes_offsets, 0)};
}

GuidedPseudo PseudoOf(const GuidedTensors& truth, std::span<const std::vector<uint8_t>> known) {
  std::vector<Tensor> masks;
  for (const std::vector<uint8_t>& mask : known) {
    masks.push_back(Filled(mask, "known pixels", 1, static_cast<int>(truth.pose.size(2)), torch::kByte));
  }
  const Tensor silhouette = torch::cat(masks, 0) * truth.silhouette;
  return {truth.classes * silhouette, truth.image * silhouette, silhouette, {}, {}};
}

CodeBox PersonBox(const PhotoFrame& frame, int multiple, int reach) {
  const PixelBox around = AroundPerson(frame, reach);
  if (around.empty()) return {};
  const int minimum = MinBoxSide(multiple);
  return CellsOf(AlignedBox(around, {0, 0, frame.size, frame.size}, multiple, minimum, minimum), multiple);
}

std::vector<CodeBox> PersonBoxes(std::span<const PhotoFrame> frames, int multiple, int reach) {
  std::vector<PixelBox> around;
  for (const PhotoFrame& frame : frames) around.push_back(AroundPerson(frame, reach));
  std::vector<CodeBox> boxes;
  for (const PixelBox& box : AlignedBoxes(around, {0, 0, frames[0].size, frames[0].size}, multiple)) {
    boxes.push_back(CellsOf(box, multiple));
  }
  return boxes;
}

Tensor CroppedPixels(const Tensor& map, const CodeBox& box, int multiple) {
  if (!map.defined()) return map;
  return Cropped(map, {box.x * multiple, box.y * multiple, box.width * multiple, box.height * multiple}).contiguous();
}

GuidedTensors CroppedPixels(const GuidedTensors& tensors, const CodeBox& box, int multiple) {
  return {CroppedPixels(tensors.pose, box, multiple), CroppedPixels(tensors.silhouette, box, multiple),
          CroppedPixels(tensors.classes, box, multiple), CroppedPixels(tensors.image, box, multiple)};
}

GuidedPseudo CroppedPixels(const GuidedPseudo& pseudo, const CodeBox& box, int multiple) {
  return {CroppedPixels(pseudo.classes, box, multiple), CroppedPixels(pseudo.image, box, multiple),
          CroppedPixels(pseudo.silhouette, box, multiple), CroppedPixels(pseudo.contour_classes, box, multiple),
          CroppedPixels(pseudo.clothes_offset, box, multiple)};
}

GuidedTensors CroppedEach(const GuidedTensors& tensors, std::span<const CodeBox> boxes, int multiple) {
  return {CropEach(tensors.pose, boxes, multiple), CropEach(tensors.silhouette, boxes, multiple),
          CropEach(tensors.classes, boxes, multiple), CropEach(tensors.image, boxes, multiple)};
}

GuidedPseudo CroppedEach(const GuidedPseudo& pseudo, std::span<const CodeBox> boxes, int multiple) {
  return {CropEach(pseudo.classes, boxes, multiple), CropEach(pseudo.image, boxes, multiple),
          CropEach(pseudo.silhouette, boxes, multiple), CropEach(pseudo.contour_classes, boxes, multiple),
          CropEach(pseudo.clothes_offset, boxes, multiple)};
}

GuidedSource CroppedEach(const GuidedSource& source, std::span<const CodeBox> boxes) {
  return {CropEach(source.sil_code, boxes, 1),
          CropEach(source.gar_code, boxes, 1),
          {CropEach(source.render_code.mean, boxes, 1), CropEach(source.render_code.log_variance, boxes, 1)}};
}

RenderedPerson RenderedPersonOf(const GuidedResult& result, const GuidedPseudo& pseudo, int64_t b, const CodeBox& box,
                                int multiple, int size) {
  const size_t pixels = size_t(size) * size;
  RenderedPerson rendered{size, std::vector<float>(3 * pixels), std::vector<float>(pixels),
                          std::vector<uint8_t>(pixels)};
  const std::vector<float> image = HostValues<float>(result.image[b]), alpha = HostValues<float>(result.silhouette[b]);
  // Inside the silhouette GarNet's most likely garment is taken, ignoring its background class.
  const std::vector<float> labels = HostValues<float>(
      result.label_logits.defined() ? result.label_logits[b].slice(0, 1).argmax(0).to(torch::kFloat) + 1
                                    : pseudo.classes[b]);
  const int64_t width = box.width * multiple, height = box.height * multiple, area = width * height;
  for (int64_t y = 0; y < height; ++y) {
    for (int64_t x = 0; x < width; ++x) {
      const int64_t j = y * width + x;
      const size_t i = size_t(box.y * multiple + y) * size + (box.x * multiple + x);
      for (int64_t c = 0; c < 3; ++c) rendered.image[c * pixels + i] = image[c * area + j];
      rendered.alpha[i] = alpha[j];
      if (rendered.alpha[i] < 0.5F) continue;
      rendered.labels[i] = std::max<uint8_t>(1, static_cast<uint8_t>(labels[j]));
    }
  }
  return rendered;
}

RenderedPerson DrawGuided(GuidedModel* model, const GuidedSource& source, const PhotoFrame& frame,
                          const PseudoImage& pseudo, int reach, double* share) {
  GuidedModelImpl& networks = **model;
  const int size = networks.config.profile.image_size, multiple = networks.config.Multiple();
  BODYLOOM_CHECK(frame.size == size && pseudo.size == size, "pose-guided renderer: a frame of ", frame.size,
                 " px and pseudo inputs of ", pseudo.size, ", expected ", size);
  const torch::NoGradGuard no_grad;
  PhotoFrame pose;  // without the image, on which the box must not depend
  pose.size = size;
  pose.parts = frame.parts;
  const std::span<const PhotoFrame> one(&pose, 1);
  CodeBox box = PersonBox(pose, multiple, reach);
  const bool somebody = box.width > 0;
  if (reach <= 0) box = {0, 0, size / multiple, size / multiple};
  if (share != nullptr) {
    *share = somebody ? static_cast<double>(box.width * box.height * multiple * multiple) / (double(size) * size) : 0;
  }
  const size_t pixels = size_t(size) * size;
  if (!somebody)
    return {size, std::vector<float>(3 * pixels), std::vector<float>(pixels), std::vector<uint8_t>(pixels)};
  const Tensor pose_map = CroppedPixels(TensorsOf(one).pose, box, multiple);
  const GuidedPseudo known = CroppedPixels(PseudoOf(std::span(&pseudo, 1)), box, multiple);
  GuidedResult result = networks.forward(source, pose_map, known, box);
  if (reach > 0) {
    const Tensor body = (pose_map.amax(1, true) > 0).to(torch::kFloat);
    // Separable dilation by squares: maximum over columns, then over rows.
    const Tensor near = torch::max_pool2d(torch::max_pool2d(body, {1, 2 * reach + 1}, 1, {0, reach}),
                                          {2 * reach + 1, 1}, 1, {reach, 0});
    result.image = result.image * near;
    result.silhouette = result.silhouette * near;
  }
  return RenderedPersonOf(result, known, 0, box, multiple, size);
}

}  // namespace bodyloom
