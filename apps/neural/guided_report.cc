// SPDX-License-Identifier: Apache-2.0
#include "apps/neural/guided_report.h"

#include <algorithm>
#include <cstdio>
#include <string>

#include "apps/neural/animate_options.h"
#include "bodyloom/pipelines/neural/photo/people_data.h"

namespace bodyloom {
namespace {

std::string ScoresText(const GuidedScores& s) {
  char line[320];
  std::snprintf(line, sizeof line,
                "L1 %.4f, PSNR %.2f dB, silhouette IoU %.3f, labels IoU %.3f, LPIPS%s %.4f (deviation %.4f), CS%s %.3f",
                s.image_l1, s.psnr_db, s.silhouette_iou, s.label_iou,
                s.lpips_random_features ? " (random features)" : "", s.lpips, s.lpips_deviation,
                s.contextual_random_features ? " (random features, a quarter of the channels)" : "", s.contextual);
  return line;
}

}  // namespace

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

void Print(const ScoreGuidedSummary& summary) {
  for (const ScoredPhotos& s : summary.scored) {
    std::printf("%d photo%s (%.0f %% of the texels; %s given): %s\n", s.photos, s.photos == 1 ? "" : "s",
                100 * s.texels_seen, kGivenOfPeople, ScoresText(s.scores).c_str());
  }
}

}  // namespace bodyloom
