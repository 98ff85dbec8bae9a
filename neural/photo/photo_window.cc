// SPDX-License-Identifier: Apache-2.0
#include "neural/photo/photo_window.h"

#include <algorithm>

#include "geometry/base/check.h"
#include "neural/motion/motion_frame.h"

namespace bodyloom {
namespace {

constexpr uint8_t kFirstOfHead = 23;        ///< first of DensePose's parts of the head
constexpr double kLooksAtCamera = 2.0 / 3;  ///< minimum share of the head's pixels on its front

/// Box of the pixels whose part is at least `first`.
PhotoWindow BoxOfParts(const PhotoFrame& frame, uint8_t first) {
  const int S = frame.size;
  BODYLOOM_CHECK(S > 0 && frame.parts.size() == static_cast<size_t>(S) * S, "photo window: ", frame.parts.size(),
                 " parts, expected ", S, " x ", S);
  int left = S, right = -1, top = S, bottom = -1;
  for (int y = 0; y < S; ++y) {
    for (int x = 0; x < S; ++x) {
      if (frame.parts[static_cast<size_t>(y) * S + x] < first) continue;
      left = std::min(left, x);
      right = std::max(right, x);
      top = std::min(top, y);
      bottom = std::max(bottom, y);
    }
  }
  return right < 0 ? PhotoWindow{} : PhotoWindow{left, top, right - left + 1, bottom - top + 1};
}

/// Changes the interval to `length` with the same centre, inside [0, size).
void Widen(int length, int size, int* begin, int* extent) {
  *begin = std::clamp(*begin + (*extent - length) / 2, 0, size - length);
  *extent = length;
}

}  // namespace

PhotoWindow WindowAround(const PhotoFrame& frame, int reach, int smallest_side) {
  const int S = frame.size;
  PhotoWindow window = BoxOfParts(frame, 1);
  if (window.width == 0) window = {S / 2, S / 2, 0, 0};
  const auto side = [&](int extent) {
    const int needed = extent == 0 ? smallest_side : std::max(smallest_side, extent + 2 * reach);
    return std::min(S, (needed + kPhotoWindowMultiple - 1) / kPhotoWindowMultiple * kPhotoWindowMultiple);
  };
  const int width = side(window.width), height = side(window.height);
  Widen(width, S, &window.x, &window.width);
  Widen(height, S, &window.y, &window.height);
  return window;
}

std::vector<PhotoWindow> EqualWindows(std::span<const PhotoWindow> windows, int size) {
  int width = 0, height = 0;
  for (const PhotoWindow& window : windows) {
    width = std::max(width, window.width);
    height = std::max(height, window.height);
  }
  std::vector<PhotoWindow> equal(windows.begin(), windows.end());
  for (PhotoWindow& window : equal) {
    Widen(width, size, &window.x, &window.width);
    Widen(height, size, &window.y, &window.height);
  }
  return equal;
}

int PhotoReach(const PhotoSource& source, std::span<const int> persons, int num_frames) {
  std::vector<MotionFrame> frames;
  for (int i = 0; i < num_frames && !persons.empty(); ++i) {
    const int person = persons[static_cast<size_t>(i) % persons.size()];
    const int count = source.num_frames[person];
    const int frame = static_cast<int>(static_cast<int64_t>(i) * count / num_frames);
    PhotoFrame photo;
    source.fill(person, frame, &photo);
    if (photo.labels.empty()) return 0;
    MotionFrame as_motion;
    as_motion.width = as_motion.height = photo.size;
    as_motion.body.assign(photo.parts.begin(), photo.parts.end());
    as_motion.labels = std::move(photo.labels);
    frames.push_back(std::move(as_motion));
  }
  return ClothesReach(frames);
}

PhotoWindow FaceBox(const PhotoFrame& frame, std::span<const uint8_t> back_of_head) {
  const PhotoWindow box = BoxOfParts(frame, kFirstOfHead);
  const int S = frame.size, U = frame.texture_size;
  const size_t area = static_cast<size_t>(S) * S;
  BODYLOOM_CHECK(frame.uv.size() == 2 * area && back_of_head.size() == static_cast<size_t>(U) * U,
                 "face: ", frame.uv.size(), " coordinates of ", S, "x", S, " pixels and ", back_of_head.size(),
                 " texels, expected ", U, "x", U);
  int pixels = 0, front = 0;
  for (size_t i = 0; i < area; ++i) {
    if (frame.parts[i] < kFirstOfHead) continue;
    const auto side = static_cast<float>(U);
    const int column = std::clamp(static_cast<int>(frame.uv[i] * side), 0, U - 1);
    const int row = std::clamp(static_cast<int>((1 - frame.uv[area + i]) * side), 0, U - 1);
    ++pixels;
    front += back_of_head[static_cast<size_t>(row) * U + column] == 0 ? 1 : 0;
  }
  return front >= kLooksAtCamera * pixels ? box : PhotoWindow{};
}

}  // namespace bodyloom
