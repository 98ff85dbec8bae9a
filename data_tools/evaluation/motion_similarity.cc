// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/evaluation/motion_similarity.h"

#include <limits>

#include "bodyloom/data_tools/descriptors/person_frames.h"
#include "bodyloom/data_tools/evaluation/motion_retrieval.h"

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
                                       int num_threads, const SurfaceMotion& motion) {
  const Eigen::MatrixXf similarity = NormalisedCrossCorrelation(Described(body, track, past, num_threads, motion),
                                                                Described(body, others, past, num_threads, motion));
  std::vector<float> nearest(track.num_frames(), std::numeric_limits<float>::quiet_NaN());
  for (int t = 0; t < track.num_frames(); ++t) {
    if (track.HasResult(t)) nearest[t] = similarity.row(t).maxCoeff();
  }
  return nearest;
}

}  // namespace bodyloom
