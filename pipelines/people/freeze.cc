// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/people/freeze.h"

#include <cstdio>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/pipelines/callbacks.h"

namespace bodyloom {

Freeze ReadFreeze(const std::string& text, int num_frames) {
  constexpr int kMost = 100000;
  Freeze freeze;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%d:%d%c", &freeze.frame, &freeze.count, &rest) != 2 || freeze.frame < 0 ||
      freeze.frame >= num_frames || freeze.count < 1 || freeze.count > kMost) {
    throw RequestError(Concatenate("--freeze ", text,
                                   ": expected FRAME:COUNT, such as 40:60; the clip has frames 0 to ", num_frames - 1,
                                   ", and COUNT is 1 to ", kMost));
  }
  return freeze;
}

}  // namespace bodyloom
