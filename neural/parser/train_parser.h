// SPDX-License-Identifier: Apache-2.0
/// Trains the clothes parser (render/image/parser_weights.h) on people whose labels are known.
///
///   loss = − mean log softmax(answers)_c,   c: the true class, over the pixels of the mask that truly show the person
/// Half of the crops lie around a pixel where classes meet, the others anywhere; each is in a random light
/// (neural/parser/picture_crops.h). Steps as neural/parser/picture_trainer.h has them.
///
/// Writes into run_dir: checkpoint.bin and metrics.csv. A run that goes on from a checkpoint ends with the same bytes
/// as one that was never interrupted (same binary, machine and threads).
#pragma once

#include <string>
#include <vector>

#include "neural/parser/packed_picture.h"
#include "neural/training/training_run.h"
#include "render/image/parser_weights.h"

namespace bodyloom {

/// Planes of a picture's truth, bytes: the true label, 0 where the person is not; the label of the nearest pixel of the
/// fitted body, which the parser is measured beside. Labels are those of data_tools/datasets/single_person_dataset.h.
struct ParserTruth {
  static constexpr int kLabel = 0, kBodyLabel = 1, kCount = 2;
};

using TrainParserOptions = PictureTraining;

struct TrainParserSummary : TrainingOutcome {
  /// Intersection over union, mean over the classes that occur, of the mask's pixels that truly show the person, all
  /// validation pictures together; 0 without any. `body`: labels of the nearest pixel of the body.
  double mean_iou = 0, body_mean_iou = 0;
  std::vector<double> iou, body_iou;  ///< by class, kParserClasses; NaN: does not occur
};

struct TrainParserResult {
  TrainParserSummary summary;
  ParserWeights weights;  ///< without a recipe and people's size
};

/// Pictures have the planes of kParserPlanes and the truth of ParserTruth. Throws std::invalid_argument for options
/// that are not valid, no picture to train on, or one whose sizes do not fit, std::runtime_error for files that cannot
/// be used.
TrainParserResult TrainParser(const std::vector<PackedPicture>& train, const std::vector<PackedPicture>& validation,
                              const TrainParserOptions& options);

}  // namespace bodyloom
