// SPDX-License-Identifier: Apache-2.0
/// The pose-guided renderer on people it has not been trained on: what `bodyloom animate animate --score` does.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bodyloom/neural/guided/guided_config.h"
#include "bodyloom/neural/guided/guided_scores.h"
#include "bodyloom/pipelines/callbacks.h"

namespace bodyloom {

struct ScoreGuidedRequest {
  std::string run;                ///< folder of the trained run
  std::string data;               ///< a multi-person dataset: its test people
  std::string body;               ///< empty: the built-in body
  std::vector<int> photos = {1};  ///< numbers of photos to animate from, each scored: 1, 2, 4
  int frames = 8;                 ///< of each person, spread over those that none of the numbers takes for photos
  std::optional<MapCompletion> completion;  ///< of what the photos do not show; absent: as the run says
  bool anywhere = false;                    ///< people may be farther from the body than clothes ever were in training
  /// A contact sheet to write, a row a person: the photo, then pseudo image, result, truth for the first number of
  /// photos; empty: none.
  std::string sheet;
  std::string weights;         ///< folder with alexnet, lpips_alex and vgg19 (weights_folder.h); empty: none
  std::string json;            ///< a report to write; empty: none
  int threads = 0;             ///< 0: all cores
  std::string device = "cpu";  ///< where the networks run: "cpu" or "cuda"
};

struct ScoredPhotos {
  int photos = 0;
  GuidedScores scores;
  double texels_seen = 0;  ///< share of the atlas that the photos fill, mean over people
};

struct ScoreGuidedSummary {
  std::vector<ScoredPhotos> scored;  ///< in the order of the request's numbers of photos
  std::vector<std::string> written;  ///< the files, as the request names them
};

/// Throws std::runtime_error for files that cannot be used and datasets without a picture to compare with, Cancelled.
/// The stage of `callbacks` is "people".
ScoreGuidedSummary ScoreGuided(const ScoreGuidedRequest& request, const PipelineCallbacks& callbacks);

}  // namespace bodyloom
