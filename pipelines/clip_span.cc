// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/clip_span.h"

#include <cstdio>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/pipelines/callbacks.h"

namespace bodyloom {

ClipSpan ReadClipSpan(const std::string& text, const char* option) {
  ClipSpan span;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%d-%d%c", &span.first, &span.last, &rest) != 2 || span.first < 0 ||
      span.last < span.first) {
    throw RequestError(Concatenate(option, " ", text, ": expected FIRST-LAST, such as 0-149"));
  }
  return span;
}

void RequireInClip(const ClipSpan& span, const char* option, int num_frames) {
  if (span.last < num_frames) return;
  throw RequestError(
      Concatenate(option, " ", span.first, "-", span.last, ": the clip has frames 0 to ", num_frames - 1));
}

}  // namespace bodyloom
