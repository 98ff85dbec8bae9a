// SPDX-License-Identifier: Apache-2.0
/// Retrieval of moments of a motion by a descriptor: nearest neighbours by normalised cross-correlation (Yoon et al.,
/// CVPR 2022, Fig. 4). A descriptor for which other moments look the same has several peaks a cycle. Descriptor
/// (C) is MotionDescriptors() of data_tools/evaluation/motion_similarity.h.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "benchmarks/accuracy/turning_person.h"
#include "data_tools/descriptors/person_frames.h"
#include "data_tools/evaluation/motion_similarity.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// Rows of one frame each, to rows of each frame and the past − 1 before it (the first frame repeated). Throws
/// std::invalid_argument for a past below 1.
DescriptorRows WithPast(const DescriptorRows& rows, int past);

/// (A): COCO-17 in pixels relative to their mean, of each frame and the past − 1 before it (the first frame repeated),
/// each coordinate off by N(0, noise_px²).
DescriptorRows KeypointTrajectories(const BodyModel& body, const Track& track, int past, double noise_px,
                                    uint64_t seed);
/// (B): atlas coordinates (u, v) of each pixel of the frames' window, background 0, of each frame and the past − 1
/// before it.
DescriptorRows DenseCoordinates(const PersonFrames& frames, int past);

/// Where a curve has its largest value within `reach` samples either side (of equal ones the first), and at least
/// `share` of its largest value of all. The first and last sample are no peaks: the curve may rise beyond them.
std::vector<int> Peaks(std::span<const float> curve, double share, int reach);

struct RetrievalScores {
  double peaks_a_cycle = 0;    ///< mean over the frames of the first cycle
  double one_peak_share = 0;   ///< of those frames: exactly as many peaks as cycles
  double direction_share = 0;  ///< frames of the later cycles whose nearest neighbour in the first turns the same way
  double yaw_error_deg = 0;    ///< mean difference to the nearest neighbour's yaw
  int queries = 0;             ///< frames of the later cycles in the last two
  double answered_share = 1;   ///< of those frames: their descriptor was defined; direction and yaw are of these alone
};

/// Peaks above 0.9 of the largest value, 4 frames either side. Frames that turn slower than a third of the fastest have
/// no direction and do not count; nor do they, for they lie where cycles meet, in the counts of peaks. `defined`:
/// frames whose descriptor says something; others are neither looked for nor found (empty: all are).
RetrievalScores ScoreRetrieval(const TurningPerson& person, const DescriptorRows& descriptors,
                               const std::vector<bool>& defined = {});

/// The frames that ScoreRetrieval counts, of cycle 0 (`first`) or of all later ones.
std::vector<int> TurningFrames(const TurningPerson& person, bool first);

}  // namespace bodyloom
