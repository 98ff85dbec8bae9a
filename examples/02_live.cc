// SPDX-License-Identifier: Apache-2.0
// Tracks frames one by one, as from a camera with a detector; each is returned `lag` frames later.
//   02_live DETECTIONS
#include <iostream>

#include "bodyloom/data_tools/observations/load_detections.h"
#include "bodyloom/tracking/builtin_models.h"
#include "bodyloom/tracking/live/live_tracker.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: 02_live DETECTIONS\n";
    return 2;
  }
  const bodyloom::KeypointSequence clip = bodyloom::LoadDetections(argv[1]);
  bodyloom::LiveTrackerInput input;
  input.camera.width = clip.image_width;
  input.camera.height = clip.image_height;
  input.landmarks = clip.names;
  bodyloom::LiveTrackerOptions options;
  options.lag = 4;
  options.solve.camera_knowledge = bodyloom::CameraKnowledge::kUnknownFocal;
  bodyloom::LiveTracker tracker(bodyloom::WithBuiltins(input), options);

  const auto show = [](const bodyloom::LiveFrame& frame) {
    std::cout << frame.timestamp << " s  " << ToString(frame.status) << "  translation "
              << frame.state.translation.transpose() << " m\n";
  };
  for (int t = 0; t < clip.num_frames(); ++t) {
    bodyloom::LiveObservations seen;
    seen.timestamp = clip.timestamps[t];
    for (int k = 0; k < clip.num_points(); ++k) seen.keypoints.push_back(clip.at(t, k));
    if (const auto frame = tracker.Push(seen)) show(*frame);
  }
  for (const bodyloom::LiveFrame& frame : tracker.Finish()) show(frame);
}
