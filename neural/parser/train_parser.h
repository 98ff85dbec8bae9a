// SPDX-License-Identifier: Apache-2.0
/// Trains the clothes parser (render/image/parser_weights.h) on people whose labels are known.
///
///   loss = − mean log softmax(answers)_c,   c: the true class, over the pixels of the mask that truly show the person
/// Half of the crops contain a pixel where classes meet, the others are anywhere; each has a random light
/// (neural/parser/image_crops.h).
///
/// Writes into run_dir: checkpoint.bin and metrics.csv. A run resumed from a checkpoint ends with the same bytes as an
/// uninterrupted one (same binary, machine and threads).
#pragma once

#include <string>
#include <vector>

#include "neural/parser/packed_image.h"
#include "neural/training/training_run.h"
#include "render/image/parser_weights.h"

namespace bodyloom {

/// Planes of an image's truth, bytes: the true label, 0 off the person; the label of the nearest pixel of the fitted
/// body, the baseline for the parser. Labels are those of data_tools/datasets/single_person_dataset.h.
struct ParserTruth {
  static constexpr int kLabel = 0, kBodyLabel = 1, kCount = 2;
};

using TrainParserOptions = ImageTraining;

struct TrainParserSummary : TrainingOutcome {
  /// Mean intersection over union over the classes that occur, pooled over the mask's pixels that truly show the person
  /// in all validation images; 0 without images. `body`: labels of the nearest pixel of the body.
  double mean_iou = 0, body_mean_iou = 0;
  std::vector<double> iou, body_iou;  ///< by class, kParserClasses; NaN: class does not occur
};

struct TrainParserResult {
  TrainParserSummary summary;
  ParserWeights weights;  ///< without recipe and pixels_per_metre
};

/// Images have the planes of kParserPlanes and the truth of ParserTruth. Throws std::invalid_argument for options that
/// are not valid, no training image, or one whose sizes do not fit, std::runtime_error for files that cannot be used.
TrainParserResult TrainParser(const std::vector<PackedImage>& train, const std::vector<PackedImage>& validation,
                              const TrainParserOptions& options);

}  // namespace bodyloom
