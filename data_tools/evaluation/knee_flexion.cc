// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/evaluation/knee_flexion.h"

#include <cmath>
#include <vector>

#include "bodyloom/geometry/base/percentile.h"

namespace bodyloom {

double MedianKneeFlexionDeg(const Motion& motion) {
  constexpr int kLeftKnee = 4, kRightKnee = 5;
  std::vector<double> flexion_deg;
  for (int t = 0; t < motion.num_frames(); ++t) {
    if (motion.poses.cols() < 3 * (kRightKnee + 1) || !motion.poses.row(t).allFinite()) continue;
    for (const int knee : {kLeftKnee, kRightKnee}) flexion_deg.push_back(motion.poses(t, 3 * knee) * 180 / M_PI);
  }
  return Percentile(flexion_deg, 50);
}

void AddKneeFlexion(const Motion& estimate, const Motion* truth, Evaluation* evaluation) {
  evaluation->Add("knee_flexion_deg", MedianKneeFlexionDeg(estimate),
                  "how bent the knees are, median over frames and both (0: straight)");
  if (truth != nullptr) evaluation->Add("gt_knee_flexion_deg", MedianKneeFlexionDeg(*truth), "of the truth");
}

Evaluation EvaluateAlone(const Track& track) {
  Evaluation result;
  result.protocol = "track-alone";
  result.description = "Nothing to compare with: what the track says of itself. Frames without a result are left out.";
  result.frames = track.num_frames();
  for (int t = 0; t < track.num_frames(); ++t) result.frames_without_result += track.HasResult(t) ? 0 : 1;
  AddKneeFlexion(track.motion, nullptr, &result);
  return result;
}

}  // namespace bodyloom
