// SPDX-License-Identifier: Apache-2.0
#include "pipelines/clip_span.h"

#include <algorithm>
#include <cstdio>

#include "geometry/base/callbacks.h"
#include "geometry/base/check.h"

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

namespace {

enum FrameUse : char { kUnused, kForTraining, kForValidation };

void MarkSpans(const std::vector<std::string>& spans, const char* option, FrameUse use, std::vector<char>* frames) {
  const auto count = static_cast<int>(frames->size());
  for (const std::string& span : spans) {
    const auto [first, last] = ReadClipSpan(span, option);
    RequireInClip({first, last}, option, count);
    for (int t = first; t <= last; ++t) {
      if ((*frames)[t] != kUnused && (*frames)[t] != use) {
        throw RequestError(Concatenate("frame ", t, " is in --train and in --validate"));
      }
      (*frames)[t] = use;
    }
  }
}

}  // namespace

TrainingSplit ReadTrainingSplit(const std::vector<std::string>& train, const std::vector<std::string>& validate,
                                int num_frames) {
  std::vector<char> use(num_frames, kUnused);
  MarkSpans(train, "--train", kForTraining, &use);
  MarkSpans(validate, "--validate", kForValidation, &use);
  if (train.empty()) {
    const int last = validate.empty() ? num_frames - std::max(1, num_frames / 5) : num_frames;
    for (int t = 0; t < num_frames; ++t) {
      if (use[t] == kUnused) use[t] = t < last ? kForTraining : kForValidation;
    }
  }
  TrainingSplit split;
  for (int t = 0; t < num_frames; ++t) {
    if (use[t] == kForTraining) split.train.push_back(t);
    if (use[t] == kForValidation) split.validation.push_back(t);
  }
  return split;
}

}  // namespace bodyloom
