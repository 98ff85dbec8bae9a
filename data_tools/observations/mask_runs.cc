// SPDX-License-Identifier: Apache-2.0
#include "data_tools/observations/mask_runs.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

/// Runs describe more pixels than they take bytes, so their sizes are bounded before memory is allocated: boxes of at
/// most 67 megapixels (8K video has 33), and beyond 1 GiB together no more than 16384 pixels a run, where a person's
/// outline has some hundreds.
constexpr int64_t kMaxPixelsOfBox = int64_t{1} << 26, kMaxPixelsAnyway = int64_t{1} << 30, kMaxPixelsOfRun = 16384;

std::vector<int64_t> WholeNumbers(const NpzArrays& arrays, const std::string& name, const std::vector<int64_t>& shape,
                                  const std::string& where) {
  const NdArray& array = RequireArray(arrays, name, where);
  bool fits = array.is_number() && array.shape.size() == shape.size();
  std::string expected;
  for (size_t i = 0; i < shape.size(); ++i) {
    fits = fits && (shape[i] < 0 || array.shape[i] == shape[i]);
    expected += (i > 0 ? " x " : "") + (shape[i] < 0 ? std::string("any number") : std::to_string(shape[i]));
  }
  if (!fits) throw std::runtime_error(where + ": " + name + ": shape " + array.ShapeText() + ", expected " + expected);
  try {
    return array.ToInts();
  } catch (const std::invalid_argument&) {
    throw std::runtime_error(where + ": " + name + ": expected whole numbers");
  }
}

/// The labels of a box, or an error in words.
std::string Unpack(std::span<const int64_t> runs, LabelImage* image) {
  const int64_t pixels = int64_t{image->width} * image->height;
  int64_t sum = 0;
  for (const int64_t run : runs) {
    if (run < 0 || run > pixels - sum) return Concatenate("runs that are not the box's ", pixels, " pixels");
    sum += run;
  }
  if (sum != pixels) return Concatenate("runs of ", sum, " pixels for a box of ", pixels);
  image->labels.reserve(static_cast<size_t>(pixels));
  for (size_t i = 0; i < runs.size(); ++i) {
    image->labels.insert(image->labels.end(), static_cast<size_t>(runs[i]), static_cast<uint8_t>(i % 2));
  }
  return "";
}

}  // namespace

NpzArrays MaskRuns(const PartLabelSequence& mask) {
  const auto T = static_cast<int64_t>(mask.frames.size());
  std::vector<int32_t> runs, counts, boxes;
  for (int64_t t = 0; t < T; ++t) {
    const LabelImage frame = mask.frames[static_cast<size_t>(t)].Unpacked();
    const size_t before = runs.size();
    if (frame.labels.empty()) {
      boxes.insert(boxes.end(), 4, 0);
    } else {
      BODYLOOM_CHECK(frame.x_begin >= 0 && frame.y_begin >= 0 && frame.x_begin + frame.width <= mask.image_width &&
                         frame.y_begin + frame.height <= mask.image_height,
                     "masks: the rectangle of frame ", t, " leaves the image");
      BODYLOOM_CHECK(frame.labels.size() <= size_t{kMaxPixelsOfBox}, "masks: frame ", t, " has ", frame.labels.size(),
                     " pixels, expected at most ", kMaxPixelsOfBox);
      boxes.insert(boxes.end(), {frame.x_begin, frame.y_begin, frame.width, frame.height});
      bool inside = false;
      auto from = frame.labels.begin();
      while (from != frame.labels.end()) {
        const auto to = std::find_if(from, frame.labels.end(), [&](uint8_t label) { return (label != 0) != inside; });
        runs.push_back(static_cast<int32_t>(to - from));
        from = to;
        inside = !inside;
      }
    }
    counts.push_back(static_cast<int32_t>(runs.size() - before));
  }
  const int32_t size[] = {mask.image_width, mask.image_height};
  return {{"mask_runs", NdArray::FromInts32(runs.data(), {static_cast<int64_t>(runs.size())})},
          {"mask_count", NdArray::FromInts32(counts.data(), {T})},
          {"mask_box", NdArray::FromInts32(boxes.data(), {T, 4})},
          {"image_size", NdArray::FromInts32(size, {2})}};
}

bool HasMaskRuns(const NpzArrays& arrays) { return arrays.contains("mask_runs"); }

PartLabelSequence MaskFromRuns(const NpzArrays& arrays, const std::string& where) {
  const std::vector<int64_t> size = WholeNumbers(arrays, "image_size", {2}, where);
  const std::vector<int64_t> counts = WholeNumbers(arrays, "mask_count", {-1}, where);
  const auto T = static_cast<int64_t>(counts.size());
  const std::vector<int64_t> boxes = WholeNumbers(arrays, "mask_box", {T, 4}, where);
  const std::vector<int64_t> runs = WholeNumbers(arrays, "mask_runs", {-1}, where);
  if (T < 1 || std::min(size[0], size[1]) < 1 || std::max(size[0], size[1]) > kMaxLabelPixelsASide) {
    throw std::runtime_error(Concatenate(where, ": image_size ", size[0], " x ", size[1], " of ", T,
                                         " frames, expected at least one frame and 1 to ", kMaxLabelPixelsASide,
                                         " pixels a side"));
  }
  PartLabelSequence mask;
  mask.image_width = static_cast<int>(size[0]);
  mask.image_height = static_cast<int>(size[1]);
  size_t at = 0;
  int64_t pixels = 0;
  for (int64_t t = 0; t < T; ++t) {
    const auto fail = [&](const std::string& found) {
      throw std::runtime_error(Concatenate(where, ": mask of frame ", t, ": ", found));
    };
    const int64_t count = counts[static_cast<size_t>(t)];
    if (count < 0 || count > static_cast<int64_t>(runs.size() - at)) fail("more runs than mask_runs has");
    const int64_t* box = &boxes[static_cast<size_t>(4 * t)];
    LabelImage frame;
    if (box[2] == 0) {
      if (count != 0) fail("runs without a box");
      mask.frames.emplace_back();
      continue;
    }
    // Sides are within the image's before they are added.
    if (box[0] < 0 || box[1] < 0 || box[2] < 1 || box[3] < 1 || box[2] > size[0] || box[3] > size[1] ||
        box[0] > size[0] - box[2] || box[1] > size[1] - box[3]) {
      fail("mask_box leaves the image");
    }
    pixels += box[2] * box[3];
    if (box[2] * box[3] > kMaxPixelsOfBox ||
        pixels > std::max(kMaxPixelsAnyway, kMaxPixelsOfRun * static_cast<int64_t>(runs.size()))) {
      fail(Concatenate("boxes of ", pixels, " pixels by now, too many for ", runs.size(), " runs"));
    }
    frame.x_begin = static_cast<int>(box[0]), frame.y_begin = static_cast<int>(box[1]);
    frame.width = static_cast<int>(box[2]), frame.height = static_cast<int>(box[3]);
    const std::string wrong = Unpack(std::span(runs).subspan(at, static_cast<size_t>(count)), &frame);
    if (!wrong.empty()) fail(wrong);
    mask.frames.emplace_back(frame);
    at += static_cast<size_t>(count);
  }
  if (at != runs.size()) {
    throw std::runtime_error(Concatenate(where, ": mask_runs has ", runs.size(), " runs, mask_count says ", at));
  }
  return mask;
}

}  // namespace bodyloom
