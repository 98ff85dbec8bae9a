// SPDX-License-Identifier: Apache-2.0
/// Trains the clothes parser; implements `bodyloom train parser`.
#pragma once

#include <cstddef>
#include <string>

#include "geometry/base/callbacks.h"
#include "neural/parser/train_parser.h"

namespace bodyloom {

struct TrainClothesParserRequest {
  std::string data;            ///< a multi-person dataset; training is evaluated on its test people
  std::string body;            ///< the people's body; empty: the built-in body
  std::string out;             ///< folder of the run: config.json, metrics.csv, checkpoint.bin, parser.npz
  int size = 512;              ///< of the windows around people, pixels
  double body_error_px = 4;    ///< as in ImagesOfPeopleRequest
  TrainParserOptions options;  ///< hyperparameters; run_dir is set by the job
};

struct TrainClothesParserSummary : TrainParserSummary {
  std::string weights;                 ///< the weights file; others are written beside it
  size_t num_parameters = 0;           ///< of the weights file
  size_t images = 0, test_images = 0;  ///< number of images made
};

/// Trains or resumes a run. A stopped run ends with its checkpoint and weights and status TrainingStatus::kStopped.
/// Throws RequestError for invalid options and when a run unexpectedly exists or is missing, std::runtime_error for
/// files that cannot be used and when a loss is not finite, Cancelled while images are made.
TrainClothesParserSummary TrainClothesParser(const TrainClothesParserRequest& request,
                                             const PipelineCallbacks& callbacks);

}  // namespace bodyloom
