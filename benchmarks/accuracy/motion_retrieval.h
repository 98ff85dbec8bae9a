// SPDX-License-Identifier: Apache-2.0
/// Retrieves moments of a motion by a descriptor: nearest neighbours by normalised cross-correlation (Yoon et al., CVPR
/// 2022, Fig. 4). A descriptor that does not distinguish other moments has several peaks per cycle. Descriptor (C) is
/// MotionDescriptors() of data_tools/evaluation/motion_similarity.h.
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

/// Concatenates each frame's row with those of the past − 1 frames before it (the first frame repeated). Throws
/// std::invalid_argument for a past below 1.
DescriptorRows WithPast(const DescriptorRows& rows, int past);

/// Descriptor (A): COCO-17 in pixels relative to their mean, of each frame and the past − 1 before it (the first frame
/// repeated), with noise N(0, noise_px²) on each coordinate.
DescriptorRows KeypointTrajectories(const BodyModel& body, const Track& track, int past, double noise_px,
                                    uint64_t seed);
/// Descriptor (B): atlas coordinates (u, v) of each pixel of the frames' window, background 0, of each frame and the
/// past − 1 before it.
DescriptorRows DenseCoordinates(const PersonFrames& frames, int past);

/// Indices of a curve's local maxima within ±`reach` samples (the first of equal ones) that are at least `share` of the
/// global maximum. The first and last samples are not peaks.
std::vector<int> Peaks(std::span<const float> curve, double share, int reach);

struct RetrievalScores {
  double peaks_a_cycle = 0;    ///< mean over the frames of the first cycle
  double one_peak_share = 0;   ///< share of these frames with exactly as many peaks as cycles
  double direction_share = 0;  ///< share of later frames whose nearest neighbour in the first cycle turns the same way
  double yaw_error_deg = 0;    ///< mean difference from the nearest neighbour's yaw
  int queries = 0;             ///< number of the later cycles' frames in the last two
  double answered_share = 1;   ///< share of these frames with a defined descriptor; direction and yaw use only these
};

/// Scores a descriptor, with peaks above 0.9 of the maximum within ±4 frames. Frames that turn slower than a third of
/// the fastest have no direction and are left out, also from the counts of peaks, as cycles meet there. `defined`:
/// frames with a meaningful descriptor; others are neither queries nor answers (empty: all are defined).
RetrievalScores ScoreRetrieval(const TurningPerson& person, const DescriptorRows& descriptors,
                               const std::vector<bool>& defined = {});

/// Frames that ScoreRetrieval counts, of cycle 0 (`first`) or of all later ones.
std::vector<int> TurningFrames(const TurningPerson& person, bool first);

}  // namespace bodyloom
