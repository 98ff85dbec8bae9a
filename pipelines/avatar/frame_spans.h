// SPDX-License-Identifier: Apache-2.0
/// Frames that a clip is learned from and judged by, as `--train 0-149 --validate 150-183` gives them.
#pragma once

#include <string>
#include <vector>

namespace bodyloom {

struct TrainingSplit {
  std::vector<int> train, validation;  ///< frames, rising
};

/// Each span is "FIRST-LAST", the last included. Without `train`: all that are not for validation; without either: the
/// last fifth is for validation. Throws RequestError naming the option for a span that is none, that the clip does not
/// have, or a frame that is in both.
TrainingSplit ReadTrainingSplit(const std::vector<std::string>& train, const std::vector<std::string>& validate,
                                int num_frames);

}  // namespace bodyloom
