// SPDX-License-Identifier: Apache-2.0
#include "neural/guided/complete_maps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

constexpr int kEnoughPixels = 8;  ///< minimum of hair pixels for its colour

struct BodyPixels {
  int left = 0, top = 0, right = -1, bottom = -1;  ///< last pixels included
};

BodyPixels BodyBox(const PhotoFrame& frame) {
  BodyPixels box{frame.size, frame.size, -1, -1};
  for (int y = 0; y < frame.size; ++y) {
    for (int x = 0; x < frame.size; ++x) {
      if (frame.parts[size_t(y) * frame.size + x] == 0) continue;
      box = {std::min(box.left, x), std::min(box.top, y), std::max(box.right, x), std::max(box.bottom, y)};
    }
  }
  return box;
}

/// Mean colour of the pixels of a label; false if there are too few.
bool MeanColour(const RenderedPerson& rendered, uint8_t label, std::array<float, 3>* colour) {
  const size_t pixels = rendered.alpha.size();
  std::array<double, 3> sum{};
  double weight = 0;
  int count = 0;
  for (size_t i = 0; i < pixels; ++i) {
    if (rendered.labels[i] != label) continue;
    ++count;
    weight += rendered.alpha[i];
    for (size_t c = 0; c < 3; ++c) sum[c] += rendered.image[c * pixels + i];
  }
  if (count < kEnoughPixels || !(weight > 0)) return false;
  for (size_t c = 0; c < 3; ++c) (*colour)[c] = static_cast<float>(sum[c] / weight);
  return true;
}

/// Mean colour of the maps' hair; false if they have none.
bool MeanHair(const CoherentMaps& maps, std::array<float, 3>* colour) {
  const size_t texels = maps.labels.size();
  std::array<double, 3> sum{};
  int count = 0;
  for (size_t i = 0; i < texels; ++i) {
    if (maps.labels[i] != kHairLabel) continue;
    ++count;
    for (size_t c = 0; c < 3; ++c) sum[c] += maps.appearance[c * texels + i];
  }
  if (count == 0) return false;
  for (size_t c = 0; c < 3; ++c) (*colour)[c] = static_cast<float>(sum[c] / count);
  return true;
}

/// Maps v from [from_first, from_last] to [to_first, to_last] linearly.
int Onto(int v, int from_first, int from_last, int to_first, int to_last) {
  if (from_last <= from_first) return to_first;
  const double t = static_cast<double>(v - from_first) / (from_last - from_first);
  return static_cast<int>(std::lround(to_first + t * (to_last - to_first)));
}

/// Replaces pixels that a network rendered as face against its pseudo input by the pseudo input.
void TakeAwayFaces(const PseudoImage& pseudo, RenderedPerson* rendered) {
  const size_t pixels = rendered->alpha.size();
  for (size_t i = 0; i < pixels; ++i) {
    if (rendered->labels[i] != kFaceLabel || pseudo.known[i] == 0 || pseudo.labels[i] == kFaceLabel) continue;
    rendered->labels[i] = pseudo.labels[i];
    for (size_t c = 0; c < 3; ++c) rendered->image[c * pixels + i] = pseudo.image[c * pixels + i] * rendered->alpha[i];
  }
}

}  // namespace

std::vector<uint8_t> TexelsOfTheBack(const PhotoFrame& front, const PhotoFrame& back) {
  BODYLOOM_CHECK(front.texel_cosine.size() == back.texel_cosine.size(), "virtual views: ", front.texel_cosine.size(),
                 " and ", back.texel_cosine.size(), " texels");
  std::vector<uint8_t> texels(front.texel_cosine.size());
  for (size_t i = 0; i < texels.size(); ++i)
    texels[i] = back.texel_cosine[i] != 0 && front.texel_cosine[i] == 0 ? 1 : 0;
  return texels;
}

PseudoImage MirroredFront(const PhotoFrame& front, const RenderedPerson& rendered, const PhotoFrame& back,
                          const CoherentMaps& maps) {
  const BodyPixels from = BodyBox(back), to = BodyBox(front);
  const size_t pixels = size_t(back.size) * back.size;
  PseudoImage pseudo{
      back.size, std::vector<float>(3 * pixels), std::vector<uint8_t>(pixels), std::vector<uint8_t>(pixels), {}, {}};
  if (to.right < 0) return pseudo;
  std::array<float, 3> behind_face{};
  const bool hair = MeanColour(rendered, kHairLabel, &behind_face) || MeanHair(maps, &behind_face);
  if (!hair) MeanColour(rendered, kFaceLabel, &behind_face);
  const size_t source_pixels = rendered.alpha.size();
  for (int y = from.top; y <= from.bottom; ++y) {
    const int source_y = Onto(y, from.top, from.bottom, to.top, to.bottom);
    for (int x = from.left; x <= from.right; ++x) {
      const size_t i = size_t(y) * back.size + x;
      if (back.parts[i] == 0) continue;
      const size_t j = size_t(source_y) * front.size + Onto(x, from.left, from.right, to.right, to.left);
      if (rendered.labels[j] == 0 || !(rendered.alpha[j] > 0)) continue;
      const bool face = rendered.labels[j] == kFaceLabel;
      for (size_t c = 0; c < 3; ++c) {
        pseudo.image[c * pixels + i] =
            face ? behind_face[c] : std::min(1.0F, rendered.image[c * source_pixels + j] / rendered.alpha[j]);
      }
      pseudo.labels[i] = face ? (hair ? kHairLabel : kSkinLabel) : rendered.labels[j];
      pseudo.known[i] = 1;
    }
  }
  return pseudo;
}

std::vector<RenderedPerson> CompleteMaps(std::span<const PhotoFrame> views, const DrawPose& draw, int first_number,
                                         CoherentMaps* maps) {
  BODYLOOM_CHECK(views.size() == kNumVirtualViews, "virtual views: ", views.size(), ", expected ",
                 int(kNumVirtualViews));
  const std::vector<uint8_t> no_face = TexelsOfTheBack(views[kViewFront], views[kViewBack]);
  std::vector<RenderedPerson> images;
  for (int v = 0; v < kNumVirtualViews; ++v) {
    PseudoImage pseudo = LookUp(*maps, views[v]);
    if (v == kViewBack) {
      PseudoImage mirrored = MirroredFront(views[kViewFront], images[kViewFront], views[kViewBack], *maps);
      mirrored.clothes_offset = std::move(pseudo.clothes_offset);
      mirrored.clothed = std::move(pseudo.clothed);
      pseudo = std::move(mirrored);
    }
    images.push_back(draw(views[v], pseudo));
    if (v == kViewBack) TakeAwayFaces(pseudo, &images.back());
    FillEmptyTexels(views[v], images.back(), static_cast<uint8_t>(first_number + v), no_face, maps);
  }
  return images;
}

}  // namespace bodyloom
