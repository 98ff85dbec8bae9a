// SPDX-License-Identifier: Apache-2.0
// Fits a body of your own (SMPL, SMPL-H or SMPL-X, the official .pkl or .npz) instead of the built-in one.
//   05_own_body BODY DETECTIONS TRACK.npz
#include <iostream>

#include "bodyloom/data_tools/body/body_io.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/data_tools/observations/load_detections.h"
#include "bodyloom/tracking/track_sequence.h"

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: 05_own_body BODY DETECTIONS TRACK.npz\n";
    return 2;
  }
  const bodyloom::BodyModel body = bodyloom::LoadBody(argv[1]);
  std::cout << bodyloom::DescribeBody(body) << "\n";
  const bodyloom::KeypointSequence keypoints = bodyloom::LoadDetections(argv[2]);
  bodyloom::TrackSequenceInput input;
  input.body = &body;
  input.keypoints = &keypoints;
  input.camera.width = keypoints.image_width;
  input.camera.height = keypoints.image_height;
  bodyloom::TrackSequenceOptions options;
  options.camera_knowledge = bodyloom::CameraKnowledge::kUnknownFocal;
  const auto [track, summary] = bodyloom::TrackSequence(input, options);
  std::cout << summary.BriefReport() << "\n";
  if (!summary.IsUsable()) return 1;
  bodyloom::WriteTrack(argv[3], track);
}
