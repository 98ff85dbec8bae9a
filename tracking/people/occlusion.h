// SPDX-License-Identifier: Apache-2.0
/// Occlusion of people by others: what lies behind a nearer body's silhouette was not seen, whatever a detector says of
/// it (detectors put a hidden limb onto the limb in front of it).
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
  const Track* track = nullptr;  ///< null: not known where; hides nothing and nothing is hidden
  KeypointSequence* keypoints = nullptr;
  DenseSequence* dense = nullptr;
  PartLabelSequence* part_labels = nullptr;
};

/// What of one person was hidden by others.
struct HiddenCounts {
  int frames = 0;     ///< in which anything was
  int keypoints = 0;  ///< with a confidence
  int dense = 0, pixels = 0;
  [[nodiscard]] bool any() const { return frames > 0; }
};

/// Frames of two people are the same moment when their timestamps are equal. Tracks are in one camera frame, pinhole;
/// a person's observations have the frames of the track. The same for any number of threads.
std::vector<HiddenCounts> TakeWeightFromHidden(const std::vector<PersonInScene>& people, int num_threads);

}  // namespace bodyloom
