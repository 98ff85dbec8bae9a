// SPDX-License-Identifier: Apache-2.0
/// "FIRST-LAST" of a command line.
#pragma once

#include <string>
#include <vector>

namespace bodyloom {

/// Frames first to last of a clip, both included.
struct ClipSpan {
  int first = 0, last = 0;
};

/// "12-40". Throws RequestError naming the option for anything else.
ClipSpan ReadClipSpan(const std::string& text, const char* option);

/// Throws RequestError naming the option when the clip does not have all of its frames.
void RequireInClip(const ClipSpan& span, const char* option, int num_frames);

// Frames that a clip is learned from and judged by, as `--train 0-149 --validate 150-183` gives them.

struct TrainingSplit {
  std::vector<int> train, validation;  ///< frames, rising
};

/// Each span is "FIRST-LAST", the last included. Without `train`: all that are not for validation; without either: the
/// last fifth is for validation. Throws RequestError naming the option for a span that is none, that the clip does not
/// have, or a frame that is in both.
TrainingSplit ReadTrainingSplit(const std::vector<std::string>& train, const std::vector<std::string>& validate,
                                int num_frames);

}  // namespace bodyloom
