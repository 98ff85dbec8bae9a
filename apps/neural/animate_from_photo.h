// SPDX-License-Identifier: Apache-2.0
/// What `bodyloom animate photo` and `bodyloom animate guided` have in common: one job, two renderers.
#pragma once

#include <string>

#include "pipelines/neural/person/animate_from_photo.h"
#include "pipelines/neural/score/score_people.h"

namespace CLI {
class App;
}

namespace bodyloom {

struct AnimateFromPhotoArguments {
  AnimateFromPhotoRequest request;
  ScorePeopleRequest score;          ///< where --score is given, instead
  std::string background = "photo";  ///< as --background has it
};

/// --run, --image and what belongs to it, --views, --garment-from, --parts, --shape, --view-yaw, --iuv, --track, --out,
/// --body, --background, --full-size, --json, those of --score, --threads, --device. `options` must live as long as the
/// verb.
void AddAnimateFromPhoto(CLI::App* verb, AnimateFromPhotoArguments* options);

/// Animates or scores, and prints what came of it.
void RunAnimateFromPhoto(AnimateFromPhotoArguments options);

}  // namespace bodyloom
