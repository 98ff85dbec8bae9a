// SPDX-License-Identifier: Apache-2.0
/// Frame ranges of a command line ("FIRST-LAST") and training/validation splits made of them.
#pragma once

#include <string>
#include <vector>

namespace bodyloom {

/// Frames first to last of a clip, both included.
struct ClipSpan {
  int first = 0, last = 0;
};

/// Parses "12-40". Throws RequestError naming the option for anything else.
ClipSpan ReadClipSpan(const std::string& text, const char* option);

/// Throws RequestError naming the option when the clip does not have all of its frames.
void RequireInClip(const ClipSpan& span, const char* option, int num_frames);

// Training and validation frames of a clip, as given by `--train 0-149 --validate 150-183`.

struct TrainingSplit {
  std::vector<int> train, validation;  ///< frames, ascending
};

/// Each span is "FIRST-LAST", both included. Without `train`: all frames not used for validation; without both: the
/// last fifth is for validation. Throws RequestError naming the option for a span that is malformed or outside the
/// clip, or for a frame in both.
TrainingSplit ReadTrainingSplit(const std::vector<std::string>& train, const std::vector<std::string>& validate,
                                int num_frames);

}  // namespace bodyloom
