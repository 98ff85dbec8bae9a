// SPDX-License-Identifier: Apache-2.0
#include "pipelines/animate/person_segmentation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "data_tools/datasets/photo_segmentation.h"
#include "data_tools/evaluation/image_metrics.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

struct Box {
  int left = 0, top = 0, right = 0, bottom = 0;  ///< right and bottom: one past the last
  [[nodiscard]] int width() const { return right - left; }
  [[nodiscard]] int height() const { return bottom - top; }
};

/// Of the values other than 0; empty without any.
Box BoxOf(std::span<const uint8_t> values, int size) {
  Box box = {size, size, 0, 0};
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      if (values[size_t(y) * size + x] == 0) continue;
      box.left = std::min(box.left, x), box.right = std::max(box.right, x + 1);
      box.top = std::min(box.top, y), box.bottom = std::max(box.bottom, y + 1);
    }
  }
  return box.right == 0 ? Box() : box;
}

}  // namespace

double KeepPerson(std::span<const uint8_t> parts, int size, std::vector<uint8_t>* labels) {
  BODYLOOM_CHECK(parts.size() == size_t(size) * size && labels->size() == parts.size(),
                 "the person's labels: ", labels->size(), " labels and ", parts.size(), " parts, expected ", size, "x",
                 size);
  const Box body = BoxOf(parts, size);
  const int reach = std::max(1, std::max(body.width(), body.height()) / 12);
  std::vector<int> steps(parts.size(), -1);
  std::vector<std::pair<int, int>> frontier, next;
  size_t labelled = 0, kept = 0;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const size_t i = size_t(y) * size + x;
      if ((*labels)[i] == 0) continue;
      ++labelled;
      if (parts[i] == 0) continue;
      steps[i] = 0;
      frontier.emplace_back(x, y);
    }
  }
  for (int step = 1; step <= reach && !frontier.empty(); ++step) {
    next.clear();
    for (const auto& [x, y] : frontier) {
      for (int ny = std::max(0, y - 1); ny <= std::min(size - 1, y + 1); ++ny) {
        for (int nx = std::max(0, x - 1); nx <= std::min(size - 1, x + 1); ++nx) {
          const size_t i = size_t(ny) * size + nx;
          if ((*labels)[i] == 0 || steps[i] >= 0) continue;
          steps[i] = step;
          next.emplace_back(nx, ny);
        }
      }
    }
    frontier.swap(next);
  }
  for (size_t i = 0; i < labels->size(); ++i) {
    if (steps[i] < 0) (*labels)[i] = 0;
    kept += (*labels)[i] != 0;
  }
  return labelled == 0 ? 0 : 1 - static_cast<double>(kept) / static_cast<double>(labelled);
}

PersonSegmentation SegmentPerson(const Image& window, std::span<const uint8_t> inside_image,
                                 std::span<const uint8_t> alpha, std::span<const uint8_t> parts) {
  const int size = window.width;
  const Box box = BoxOf(inside_image, size);
  Image cut(box.width(), box.height());
  std::vector<uint8_t> cut_parts;
  for (int y = box.top; y < box.bottom; ++y) {
    for (int x = box.left; x < box.right; ++x) {
      const size_t i = size_t(y) * size + x;
      for (int c = 0; c < 3; ++c)
        cut.pixel(x - box.left, y - box.top)[c] = alpha.empty() ? window.bgr[3 * i + c] : alpha[i];
      cut_parts.push_back(parts[i]);
    }
  }
  const std::vector<uint8_t> found = LabelsFromBody(cut, cut_parts);
  PersonSegmentation segmentation;
  segmentation.labels.assign(parts.size(), 0);
  bool is_body = true;
  for (int y = box.top; y < box.bottom; ++y) {
    for (int x = box.left; x < box.right; ++x) {
      const size_t i = size_t(y - box.top) * box.width() + (x - box.left);
      segmentation.labels[size_t(y) * size + x] = found[i];
      is_body = is_body && (found[i] != 0) == (cut_parts[i] != 0);
    }
  }
  segmentation.note = is_body         ? "no labels: the outline is the bare body's"
                      : alpha.empty() ? "no labels: the outline is found by GrabCut from the tracked body"
                                      : "no labels: the outline is its transparency's";
  return segmentation;
}

void CompositeScore::Sum::Add(double value) {
  if (!std::isfinite(value)) return;
  total += value;
  ++count;
}

double CompositeScore::Sum::Mean() const {
  return count > 0 ? total / count : std::numeric_limits<double>::quiet_NaN();
}

void CompositeScore::Add(int t, const Image& composed) {
  RenderedPeople wanted;
  wanted.normals = wanted.iuv = wanted.background = false;
  PersonFrame frame = set_.Read(t, wanted);
  const Image truth = Resized(frame.rgb, width_, height_);
  whole_.Add(Psnr(truth, composed));
  if (frame.labels.empty()) return;
  for (uint8_t& label : frame.labels.bgr) label = label == 0 ? 0 : 255;
  const PixelMask rim = RimOf(MaskFrom(Resized(frame.labels, width_, height_)), kRimPixels);
  rim_.Add(Psnr(truth, composed, &rim));
}

}  // namespace bodyloom
