// SPDX-License-Identifier: Apache-2.0
/// Options and lines of `--score`, which `bodyloom animate photo`, `guided` and `person` have in common.
#pragma once

#include <string>

#include "pipelines/neural/person/photo_animation.h"
#include "pipelines/neural/score/score_people.h"

namespace CLI {
class App;
}

namespace bodyloom {

/// --score, --score-photos, --score-frames, --score-labels, --score-tracks, --score-iuv, --weights. `request` must live
/// as long as the verb.
void AddScoreOptions(CLI::App* verb, ScorePeopleRequest* request);

/// Whether people are to be scored, not a person animated. Throws RequestError where the photo or the video is missing,
/// or both are requested.
bool IsScored(const ScorePeopleRequest& score, const PhotoAnimationRequest& animation);

/// What both requests share.
void TakeFrom(const PhotoAnimationRequest& animation, ScorePeopleRequest* score);

/// L1, PSNR and all that was measured.
std::string ScoresText(const PersonScores& scores);

/// A line a number of photos.
void Print(const ScorePeopleSummary& summary);

}  // namespace bodyloom
