// SPDX-License-Identifier: Apache-2.0
/// Options and output of `--score`, shared by `bodyloom animate photo`, `guided` and `person`.
#pragma once

#include <string>

#include "pipelines/neural/person/photo_animation.h"
#include "pipelines/neural/score/score_people.h"

namespace CLI {
class App;
}

namespace bodyloom {

/// Adds --score, --score-photos, --score-frames, --score-labels, --score-tracks, --score-iuv, --weights. `request` must
/// outlive the verb.
void AddScoreOptions(CLI::App* verb, ScorePeopleRequest* request);

/// Returns true if people are scored instead of a person animated. Throws RequestError if the photo or the video is
/// missing, or if both are requested.
bool IsScored(const ScorePeopleRequest& score, const PhotoAnimationRequest& animation);

/// Copies the fields common to both requests.
void TakeFrom(const PhotoAnimationRequest& animation, ScorePeopleRequest* score);

/// Text of L1, PSNR and the other scores measured.
std::string ScoresText(const PersonScores& scores);

/// Prints one line per number of photos.
void Print(const ScorePeopleSummary& summary);

}  // namespace bodyloom
