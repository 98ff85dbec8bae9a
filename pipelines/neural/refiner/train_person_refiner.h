// SPDX-License-Identifier: Apache-2.0
/// Trains the picture refiner of people made from photos: what `bodyloom train refiner` does.
#pragma once

#include <cstddef>
#include <string>

#include "bodyloom/neural/refiner/train_refiner.h"
#include "bodyloom/pipelines/callbacks.h"

namespace bodyloom {

struct TrainPersonRefinerRequest {
  std::string data;             ///< a multi-person dataset; its test people are those that training is measured on
  std::string body;             ///< the people's body; empty: the built-in body
  std::string out;              ///< folder of the run: config.json, metrics.csv, checkpoint.bin, refiner.npz
  std::string weights;          ///< folder with vgg16 (pipelines/neural/weights_folder.h); empty: none
  int size = 512;               ///< of the windows that people are drawn in
  int texture_size = 512;       ///< texels a side
  double body_error_px = 4;     ///< as RefinerPicturesRequest has it
  TrainRefinerOptions options;  ///< numbers; run_dir and vgg16 are filled in by the job
};

struct TrainPersonRefinerSummary : TrainRefinerSummary {
  std::string weights;                     ///< the file written, and others beside it
  size_t num_parameters = 0;               ///< numbers in it
  size_t pictures = 0, test_pictures = 0;  ///< that were drawn
};

/// A run that was stopped ends with its checkpoint and weights and says so (TrainingStatus::kStopped). Throws
/// RequestError for options that are not valid and for a run that is or is not there, std::runtime_error for files that
/// cannot be used and when a loss is not finite, Cancelled while people are drawn.
TrainPersonRefinerSummary TrainPersonRefiner(const TrainPersonRefinerRequest& request,
                                             const PipelineCallbacks& callbacks);

}  // namespace bodyloom
