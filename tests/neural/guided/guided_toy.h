// SPDX-License-Identifier: Apache-2.0
/// Toy people for the pose-guided renderer: two rectangles in a square window, whose texels lie on a plane.
///
/// The body is a head (chart 23) on a torso (chart 2 in front, 1 behind); its clothes are one pixel wider on either
/// side. The atlas has the front's torso at the lower left, the back's at the lower right and the head above, front in
/// the left half, back in the right. A frame shows the body moved by (dx, dy), from the front or from behind; colours
/// and labels depend on texel and person.
#pragma once

#include <cmath>
#include <vector>

#include "neural/guided/guided_config.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

inline constexpr int kToySide = 32, kToyTexels = 16;

inline GuidedConfig ToyGuided() {
  GuidedConfig config;
  config.profile = {"toy", kToySide, kToyTexels, {4, 8}, {4, 8}, {8, 8}, 8, 8, 4, true, false, 4, 16, 64};
  return config;
}

/// Configuration with all additions of the small profiles to the paper's networks.
inline GuidedConfig ToyGuidedWithGuesses() {
  GuidedConfig config = ToyGuided();
  GuidedProfile& p = config.profile;
  p.fill_colours = p.start_from_body = p.contour_hints = p.nearest_texels = true;
  return config;
}

inline std::vector<uint8_t> ToyTexelParts() {
  std::vector<uint8_t> parts(kToyTexels * kToyTexels);
  for (int r = 0; r < kToyTexels; ++r) {
    for (int c = 0; c < kToyTexels; ++c) {
      parts[r * kToyTexels + c] = r < 8 ? (c < 8 ? 23 : 24) : (c < 8 ? 2 : 1);
    }
  }
  return parts;
}

/// Positions of texels of a head on a torso, both flat: the back is behind the front, mirrored.
inline std::vector<float> ToyTexelPlaces() {
  constexpr int kTexels = kToyTexels * kToyTexels;
  std::vector<float> places(3 * kTexels);
  for (int r = 0; r < kToyTexels; ++r) {
    for (int c = 0; c < kToyTexels; ++c) {
      const int t = r * kToyTexels + c;
      places[t] = static_cast<float>(c < 8 ? c : 15 - c) / 8;
      places[kTexels + t] = 2 - static_cast<float>(r) / 8;
      places[2 * kTexels + t] = c < 8 ? 0.1F : -0.1F;
    }
  }
  return places;
}

/// Label and colour of a texel's person: face in front of the head, hair behind and on top of it, a shirt with a
/// gradient, skin below.
inline uint8_t ToyLabel(int row, int column) {
  if (row >= 8) return row >= 14 ? 5 : 1;
  return column < 8 && row >= 3 ? 3 : 4;
}

inline float ToyColour(int person, int row, int column, int channel) {
  const float hue = 0.5F + 0.35F * std::sin(1.3F * static_cast<float>(person) + 2.1F * static_cast<float>(channel) +
                                            0.9F * static_cast<float>(ToyLabel(row, column)));
  return hue * (0.8F + 0.02F * static_cast<float>(row % 8));
}

struct ToyPose {
  int dx = 0, dy = 0;
  bool behind = false;
};

/// The head covers 8 × 8 pixels, the torso 12 × 12 below it.
inline PhotoFrame ToyPhotoFrame(int person, const ToyPose& pose, bool image) {
  constexpr int kArea = kToySide * kToySide, kTexels = kToyTexels * kToyTexels;
  PhotoFrame frame;
  frame.size = kToySide;
  frame.uv.assign(2 * kArea, 0);
  frame.parts.assign(kArea, 0);
  frame.texture_size = kToyTexels;
  frame.texel_pixels.assign(2 * kTexels, 0);
  frame.texel_cosine.assign(kTexels, 0);
  if (image) {
    frame.image.assign(3 * kArea, 0);
    frame.labels.assign(kArea, 0);
  }
  struct Patch {
    int left, top, side, row, chart;
  };
  const Patch patches[2] = {{12 + pose.dx, 6 + pose.dy, 8, 0, pose.behind ? 24 : 23},
                            {10 + pose.dx, 14 + pose.dy, 12, 8, pose.behind ? 1 : 2}};
  for (const Patch& patch : patches) {
    const int column = pose.behind ? 8 : 0;
    const float scale = 8.0F / static_cast<float>(patch.side);
    // Clothes: a pixel more on either side.
    for (int y = 0; y < patch.side; ++y) {
      for (int x = -1; x <= patch.side; ++x) {
        const int px = patch.left + x, py = patch.top + y;
        if (px < 0 || px >= kToySide || py < 0 || py >= kToySide) continue;
        const int i = py * kToySide + px;
        const float tx = (static_cast<float>(x) + 0.5F) * scale, ty = (static_cast<float>(y) + 0.5F) * scale;
        if (x >= 0 && x < patch.side) {
          // From behind, left and right are exchanged.
          const float u = pose.behind ? 8 - tx : tx;
          frame.parts[i] = static_cast<uint8_t>(patch.chart);
          frame.uv[i] = (static_cast<float>(column) + u) / kToyTexels;
          frame.uv[kArea + i] = 1 - (static_cast<float>(patch.row) + ty) / kToyTexels;
        }
        if (!image) continue;
        const int c = std::min(7, std::max(0, static_cast<int>(pose.behind ? 8 - tx : tx))) + column;
        const int r = std::min(7, static_cast<int>(ty)) + patch.row;
        frame.labels[i] = ToyLabel(r, c);
        for (int k = 0; k < 3; ++k) frame.image[k * kArea + i] = ToyColour(person, r, c, k);
      }
    }
    for (int r = 0; r < 8; ++r) {
      for (int c = 0; c < 8; ++c) {
        const int texel = (patch.row + r) * kToyTexels + column + c;
        const float across = static_cast<float>(pose.behind ? 7 - c : c) + 0.5F;
        const float x = static_cast<float>(patch.left) + across / scale - 0.5F;
        const float y = static_cast<float>(patch.top) + (static_cast<float>(r) + 0.5F) / scale - 0.5F;
        if (x < 0 || y < 0 || x > kToySide - 1 || y > kToySide - 1) continue;
        frame.texel_pixels[texel] = x;
        frame.texel_pixels[kTexels + texel] = y;
        frame.texel_cosine[texel] = 1;
      }
    }
  }
  return frame;
}

/// Pose of frame k of a toy person: moved, every third from behind.
inline ToyPose ToyPoseOf(int frame) { return {frame * 3 % 7 - 3, frame * 2 % 5 - 2, frame % 3 == 2}; }

inline PhotoSource ToyPeople(int people, int frames) {
  PhotoSource source;
  source.num_frames.assign(people, frames);
  source.size = kToySide;
  source.texture_size = kToyTexels;
  source.texel_parts = ToyTexelParts();
  source.texel_places = ToyTexelPlaces();
  source.fill = [](int person, int frame, PhotoFrame* out) { *out = ToyPhotoFrame(person, ToyPoseOf(frame), true); };
  return source;
}

/// Front and back views; side views show only the front, moved.
inline std::vector<PhotoFrame> ToyViews() {
  std::vector<PhotoFrame> views;
  views.reserve(6);
  for (int v = 0; v < 6; ++v) views.push_back(ToyPhotoFrame(0, {v > 1 ? v - 3 : 0, 0, v == 1}, false));
  return views;
}

}  // namespace bodyloom
