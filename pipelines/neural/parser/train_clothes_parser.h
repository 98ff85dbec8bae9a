// SPDX-License-Identifier: Apache-2.0
/// Trains the clothes parser: what `bodyloom train parser` does.
#pragma once

#include <cstddef>
#include <string>

#include "geometry/base/callbacks.h"
#include "neural/parser/train_parser.h"

namespace bodyloom {

struct TrainClothesParserRequest {
  std::string data;            ///< a multi-person dataset; its test people are those that training is measured on
  std::string body;            ///< the people's body; empty: the built-in body
  std::string out;             ///< folder of the run: config.json, metrics.csv, checkpoint.bin, parser.npz
  int size = 512;              ///< of the windows that people are shown in
  double body_error_px = 4;    ///< as PicturesOfPeopleRequest has it
  TrainParserOptions options;  ///< numbers; run_dir is filled in by the job
};

struct TrainClothesParserSummary : TrainParserSummary {
  std::string weights;                     ///< the file written, and others beside it
  size_t num_parameters = 0;               ///< numbers in it
  size_t pictures = 0, test_pictures = 0;  ///< that were made
};

/// A run that was stopped ends with its checkpoint and weights and says so (TrainingStatus::kStopped). Throws
/// RequestError for options that are not valid and for a run that is or is not there, std::runtime_error for files that
/// cannot be used and when a loss is not finite, Cancelled while pictures are made.
TrainClothesParserSummary TrainClothesParser(const TrainClothesParserRequest& request,
                                             const PipelineCallbacks& callbacks);

}  // namespace bodyloom
