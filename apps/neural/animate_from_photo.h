// SPDX-License-Identifier: Apache-2.0
/// Command line shared by `bodyloom animate photo` and `bodyloom animate guided`.
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
  ScorePeopleRequest score;          ///< used instead with --score
  std::string background = "photo";  ///< value of --background
};

/// Adds --run, --image and its related options, --views, --garment-from, --parts, --shape, --view-yaw, --iuv, --track,
/// --out, --body, --background, --full-size, --json, those of --score, --threads, --device. `options` must outlive the
/// verb.
void AddAnimateFromPhoto(CLI::App* verb, AnimateFromPhotoArguments* options);

/// Animates or scores, and prints the result.
void RunAnimateFromPhoto(AnimateFromPhotoArguments options);

}  // namespace bodyloom
