// SPDX-License-Identifier: Apache-2.0
/// A synthetic clip's 2D joints as a fit gets them, whose camera is known or whose focal length nobody says.
#pragma once

#include "data_tools/body/builtin_body.h"
#include "data_tools/learned/lifter_weights_io.h"
#include "data_tools/learned/pose_prior_io.h"
#include "data_tools/synthesis/clips/synth_clip.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_options.h"

namespace bodyloom {

/// With built-in body, prior and lifter, and the clip's camera. The clip's joints are borrowed.
inline TrackSequenceInput KnownCameraInput(const SynthClip& clip) {
  TrackSequenceInput input;
  input.body = &BuiltinBody();
  input.keypoints = &clip.keypoints;
  input.prior = &BuiltinPosePrior();
  input.lifter = &BuiltinLifter();
  input.camera = clip.truth.camera;
  return input;
}

/// The same with the size of the camera's images alone.
inline TrackSequenceInput UnknownFocalInput(const SynthClip& clip) {
  TrackSequenceInput input = KnownCameraInput(clip);
  input.camera = TrackSequenceInput().camera;
  input.camera.width = clip.truth.camera.width;
  input.camera.height = clip.truth.camera.height;
  return input;
}

inline TrackSequenceOptions UnknownFocalOptions() {
  TrackSequenceOptions options;
  options.camera_knowledge = CameraKnowledge::kUnknownFocal;
  options.num_threads = 2;
  return options;
}

}  // namespace bodyloom
