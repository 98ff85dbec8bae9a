// SPDX-License-Identifier: Apache-2.0
/// The tracker's inputs from file names: everything that a request names, checked against each other.
#pragma once

#include <memory>
#include <optional>

#include "bodyloom/data_tools/observations/load_cameras.h"
#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/lifter_weights.h"
#include "bodyloom/geometry/observations.h"
#include "bodyloom/geometry/pose_prior.h"
#include "bodyloom/geometry/track.h"
#include "bodyloom/pipelines/callbacks.h"
#include "bodyloom/pipelines/track/track_request.h"

namespace bodyloom {

struct TrackInputs {
  std::shared_ptr<const BodyModel> body;
  std::optional<KeypointSequence> keypoints;
  std::optional<DenseSequence> dense;
  std::optional<PartLabelSequence> part_labels;
  bool joints_from_labels = false;  ///< `keypoints` were read off `part_labels`
  std::optional<Motion> initialiser;
  std::optional<PosePrior> prior;
  std::optional<LifterWeights> lifter;
  std::optional<Track> reference;
  NamedCamera camera;  ///< intrinsics, pose and the way to the video's pixels, as far as known
  double video_fps = 0;

  /// Keypoints are always there when only part labels were given: those read off the labels.
  [[nodiscard]] int num_frames() const { return keypoints ? keypoints->num_frames() : dense->num_frames(); }
  [[nodiscard]] const std::vector<double>& timestamps() const {
    return keypoints ? keypoints->timestamps : dense->timestamps;
  }
  /// Pointers into this object.
  [[nodiscard]] TrackSequenceInput ForTracker() const;
};

/// Reads what the request names, and detects people when there is nothing but a video. Throws Cancelled, std::runtime_error naming file and place, also when two files contradict each
/// other (image sizes, number of frames).
TrackInputs LoadTrackInputs(const TrackRequest& request, const PipelineCallbacks& callbacks = {});

}  // namespace bodyloom
