// SPDX-License-Identifier: Apache-2.0
/// "FIRST-LAST" of a command line.
#pragma once

#include <string>

namespace bodyloom {

/// Frames first to last of a clip, both included.
struct ClipSpan {
  int first = 0, last = 0;
};

/// "12-40". Throws RequestError naming the option for anything else.
ClipSpan ReadClipSpan(const std::string& text, const char* option);

/// Throws RequestError naming the option when the clip does not have all of its frames.
void RequireInClip(const ClipSpan& span, const char* option, int num_frames);

}  // namespace bodyloom
