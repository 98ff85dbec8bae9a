// SPDX-License-Identifier: Apache-2.0
/// Toy people for the one-photo renderer: flat cards. The front of a card is the left half of its atlas, the back the
/// right half; even frames show fronts, odd ones backs, each a little farther to the right. A fringe of two pixels
/// around the card is clothing beyond the body.
#pragma once

#include <cmath>

#include "neural/photo/photo_config.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

inline constexpr int kToySize = 64, kToyTexture = 16;
inline constexpr int kCardLeft = 16, kCardTop = 12, kCardWidth = 24, kCardHeight = 40;

inline PhotoConfig ToyPhotoConfig(PhotoVariant variant = PhotoVariant::kFull) {
  return {{"toy", kToySize, kToyTexture, 4, {4, 8}, 4, 1, 4, 1, 2, 16, true}, variant};
}

/// Configuration with completion of unseen texels, and the alternative kernel of the upsampling path.
inline PhotoConfig ToyGuessConfig(PhotoVariant variant = PhotoVariant::kFull) {
  PhotoConfig config = ToyPhotoConfig(variant);
  config.profile.guesses_unseen = true;
  config.profile.render_up_kernel = 4;
  return config;
}

/// Colour c of the card at (u, v).
inline float ToyColour(int person, float u, float v, int c) {
  return 0.5F + 0.35F * std::sin(static_cast<float>(person + 1) * 1.7F + 2.0F * static_cast<float>(c) + 3 * u + 2 * v);
}

inline uint8_t ToyPart(float v) { return v > 0.8F ? 23 : v > 0.4F ? 2 : 9; }

inline void FillToyPhoto(int person, int frame, PhotoFrame* photo) {
  constexpr int S = kToySize, A = S * S, U = kToyTexture, T = U * U;
  const int left = kCardLeft + 2 * (frame / 2);
  const float u0 = frame % 2 == 0 ? 0.0F : 0.5F;
  *photo = {};
  photo->size = S;
  photo->uv.assign(2 * A, 0);
  photo->parts.assign(A, 0);
  photo->image.assign(3 * A, 0);
  photo->labels.assign(A, 0);
  for (int y = kCardTop - 2; y < kCardTop + kCardHeight + 2; ++y) {
    for (int x = left - 2; x < left + kCardWidth + 2; ++x) {
      const int i = y * S + x;
      const float u = u0 + 0.5F * (static_cast<float>(x - left) + 0.5F) / kCardWidth;
      const float v = 1 - (static_cast<float>(y - kCardTop) + 0.5F) / kCardHeight;
      photo->labels[i] = 1;
      for (int c = 0; c < 3; ++c) photo->image[c * A + i] = ToyColour(person, u, v, c);
      if (x < left || x >= left + kCardWidth || y < kCardTop || y >= kCardTop + kCardHeight) continue;
      photo->uv[i] = u;
      photo->uv[A + i] = v;
      photo->parts[i] = ToyPart(v);
    }
  }
  photo->texture_size = U;
  photo->texel_pixels.assign(2 * T, 0);
  photo->texel_cosine.assign(T, 0);
  for (int r = 0; r < U; ++r) {
    for (int c = 0; c < U; ++c) {
      const float u = (static_cast<float>(c) + 0.5F) / U, v = 1 - (static_cast<float>(r) + 0.5F) / U;
      const float x = static_cast<float>(left) - 0.5F + (u - u0) / 0.5F * kCardWidth;
      photo->texel_pixels[r * U + c] = x;
      photo->texel_pixels[T + r * U + c] = kCardTop - 0.5F + (1 - v) * kCardHeight;
      photo->texel_cosine[r * U + c] = u >= u0 && u < u0 + 0.5F ? 1.0F : 0.0F;
    }
  }
}

inline PhotoSource ToyPhotos(int persons, int frames) {
  PhotoSource source;
  source.num_frames.assign(persons, frames);
  source.size = kToySize;
  source.texture_size = kToyTexture;
  for (int r = 0; r < kToyTexture; ++r) {
    const float v = 1 - (static_cast<float>(r) + 0.5F) / kToyTexture;
    source.texel_parts.insert(source.texel_parts.end(), kToyTexture, ToyPart(v));
  }
  source.texel_places.assign(3 * kToyTexture * kToyTexture, 0);
  for (int r = 0; r < kToyTexture; ++r) {
    for (int c = 0; c < kToyTexture; ++c) {
      const int texels = kToyTexture * kToyTexture, k = r * kToyTexture + c;
      const float u = (static_cast<float>(c) + 0.5F) / kToyTexture;
      source.texel_places[k] = u < 0.5F ? 2 * u : 2 * (1 - u);
      source.texel_places[texels + k] = 2 - 2 * (static_cast<float>(r) + 0.5F) / kToyTexture;
      source.texel_places[2 * texels + k] = u < 0.5F ? 0.1F : 0;
    }
  }
  source.fill = FillToyPhoto;
  return source;
}

}  // namespace bodyloom
