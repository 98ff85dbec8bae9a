// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/evaluation/motion_similarity.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bodyloom/data_tools/descriptors/person_frames.h"
#include "bodyloom/data_tools/evaluation/motion_retrieval.h"
#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

DescriptorRows Described(const BodyModel& body, const Track& track, int past, int num_threads,
                         const SurfaceMotion& motion) {
  PersonFramesOptions options;
  options.motion = motion;
  options.uv_size = 32;
  options.past = past;
  options.num_threads = num_threads;
  return MotionDescriptors(PersonFrames(body, track, options), past);
}

}  // namespace

std::vector<float> SimilarityToNearest(const BodyModel& body, const Track& track, const Track& others, int past,
                                       int num_threads, const SurfaceMotion& motion, std::span<const char> counts) {
  BODYLOOM_CHECK(counts.empty() || static_cast<int>(counts.size()) == others.num_frames(),
                 "motion similarity: ", counts.size(), " flags of ", others.num_frames(), " frames");
  const Eigen::MatrixXf similarity = NormalisedCrossCorrelation(Described(body, track, past, num_threads, motion),
                                                                Described(body, others, past, num_threads, motion));
  std::vector<float> nearest(track.num_frames(), std::numeric_limits<float>::quiet_NaN());
  for (int t = 0; t < track.num_frames(); ++t) {
    if (!track.HasResult(t)) continue;
    for (int s = 0; s < others.num_frames(); ++s) {
      if (!others.HasResult(s) || (!counts.empty() && counts[s] == 0)) continue;
      nearest[t] = std::isnan(nearest[t]) ? similarity(t, s) : std::max(nearest[t], similarity(t, s));
    }
  }
  return nearest;
}

}  // namespace bodyloom
