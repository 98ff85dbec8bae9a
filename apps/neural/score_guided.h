// SPDX-License-Identifier: Apache-2.0
/// The pose-guided renderer on people it has not been trained on.
#pragma once

#include <string>
#include <vector>

#include "bodyloom/neural/guided/guided_renderer.h"
#include "bodyloom/neural/guided/guided_scores.h"
#include "bodyloom/render/image.h"

namespace bodyloom {

struct ScoreGuidedRequest {
  std::string data;         ///< a people set: its test people
  std::string body;         ///< empty: the built-in body
  std::vector<int> photos;  ///< numbers of photos to animate from, each scored: 1, 2, 4
  int frames = 8;           ///< of each person, spread over those that none of the numbers takes for photos
};

struct ScoredPhotos {
  int photos = 0;
  GuidedScores scores;
  double texels_seen = 0;  ///< share of the atlas that the photos fill, mean over people
};

/// `sheet` (may be null): a row a person: the photo, then pseudo image, result, truth for the first number of photos.
std::vector<ScoredPhotos> ScoreGuided(const ScoreGuidedRequest& request, const GuidedConfig& config,
                                      GuidedRenderer* renderer, Image* sheet);

}  // namespace bodyloom
