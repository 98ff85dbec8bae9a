// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/guided_report.h"

#include <algorithm>
#include <cstdio>

#include "apps/neural/animate_options.h"
#include "apps/neural/score_options.h"

namespace bodyloom {
void Print(const AnimateGuidedSummary& summary, const AnimateGuidedRequest& request) {
  std::printf(
      "%d frames, source encoded in %.1f s, networks %.0f ms a frame (%.0f %% of the window), %.1f frames/s in all\n",
      summary.frames, summary.source_seconds, summary.network_ms, 100 * summary.computed_share,
      summary.frames / std::max(1e-9, summary.frame_seconds));
  PrintFramesWithoutFit(summary);
  if (summary.frames_kept > 0) {
    std::printf("%lld frames were those before and were not computed again\n",
                static_cast<long long>(summary.frames_kept));
  }
  if (summary.scores) std::printf("against %s: %s\n", request.data.c_str(), ScoresText(*summary.scores).c_str());
  std::printf("wrote %s\n", request.out.c_str());
}

}  // namespace bodyloom
