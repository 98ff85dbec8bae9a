// SPDX-License-Identifier: Apache-2.0
/// Input checks of TrackSequence(): errors in its input, and removal of impossible observations.
#pragma once

#include <vector>

#include "geometry/scene/observations.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"

namespace bodyloom {

/// Length and image size of the clip, from whichever observations there are.
struct ClipExtent {
  int frames = 0, width = 0, height = 0;
  const std::vector<double>* timestamps = nullptr;
};

/// Throws std::invalid_argument when the observations differ in length or image size.
ClipExtent ExtentOf(const TrackSequenceInput& input);

/// Throws std::invalid_argument for everything that TrackSequence() does not accept: options out of range, no body, no
/// observations, sizes that differ, labels of no chart, and CheckNumbers().
void CheckInput(const TrackSequenceInput& input, const TrackSequenceOptions& options);

/// Throws std::invalid_argument, beginning with "track: ", when a number of the input is impossible:
/// - observations: another number of points than frames × landmarks, or of timestamps than frames; timestamps that are
///   not finite and strictly increasing;
/// - a known camera: an intrinsic that is not finite, a focal length that is not positive;
/// - the body: less than 0.3 m or more than 10 m from end to end (millimetres, centimetres, feet);
/// - a stature that is given: less than 0.4 or more than 1.6 times the mean body's;
/// - the initialiser: frames with some values that are not finite (a frame of NaN only counts as missing), no frame
/// with
///   a pose, or a person on average more than 1 km from the camera.
void CheckNumbers(const TrackSequenceInput& input, const TrackSequenceOptions& options);

/// Marks as missing (confidence 0) every 2D landmark whose confidence is not positive, whose coordinates are not
/// finite, or that lies more than ten image sizes outside the image (a million pixels if the image size is not known),
/// and limits confidences to 1.
void DropUnusable(KeypointSequence* keypoints);

/// True if DropUnusable would drop or change a dense keypoint.
bool HasUnusable(const DenseSequence& dense);

/// Drops dense keypoints whose pixel or barycentric coordinates are not finite, whose pixel lies as far outside as
/// above, whose barycentric coordinates are outside [−1, 2], or whose σ is not a positive number; raises σ to at least
/// 0.01 pixels.
void DropUnusable(DenseSequence* dense);

}  // namespace bodyloom
