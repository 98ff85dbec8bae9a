// SPDX-License-Identifier: Apache-2.0
/// Reduces the weight of observations of people who are occluded by others. Detectors place an occluded limb onto the
/// limb in front of it.
///
/// A pixel of person i is hidden when the body of another person covers it and is nearer there than person i: than
/// i's own surface where it covers the pixel too, else than i's pelvis, by more than 5 cm.
///   - a 2D joint there keeps a fifth of its confidence
///   - a dense keypoint there is dropped
///   - a label there, widened by a hundredth of the person's height, is unknown (PartLabelSequence::kUnknown)
#pragma once

#include <vector>

#include "geometry/body/body_model.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track.h"

namespace bodyloom {

/// One person of the scene. Pointers are borrowed; observations may be null, and are changed where they are hidden.
struct PersonInScene {
  const BodyModel* body = nullptr;
  const Track* track = nullptr;  ///< null: position not known; the person neither hides anybody nor is hidden
  KeypointSequence* keypoints = nullptr;
  DenseSequence* dense = nullptr;
  PartLabelSequence* part_labels = nullptr;
};

/// Number of observations of one person that others hide.
struct HiddenCounts {
  int frames = 0;     ///< with any hidden observation
  int keypoints = 0;  ///< with a confidence
  int dense = 0, pixels = 0;
  [[nodiscard]] bool any() const { return frames > 0; }
};

/// Down-weights or drops all hidden observations as above, and returns their counts by person. Frames of two people are
/// simultaneous when their timestamps are equal. Tracks are in one camera frame, pinhole; a person's observations have
/// the frames of the track. Same result for any number of threads.
std::vector<HiddenCounts> DownweightOccluded(const std::vector<PersonInScene>& people, int num_threads);

}  // namespace bodyloom
