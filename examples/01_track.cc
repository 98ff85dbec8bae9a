// SPDX-License-Identifier: Apache-2.0
// Fits a body to the 2D detections of a clip: a pose in every frame, one shape, and the camera.
//   01_track DETECTIONS TRACK.npz
#include <iostream>

#include "bodyloom/bodyloom.h"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: 01_track DETECTIONS TRACK.npz\n";
    return 2;
  }
  // OpenPose, COCO, AlphaPose, MediaPipe, AIST++ or Bodyloom's own: recognised by content.
  const bodyloom::KeypointSequence keypoints = bodyloom::LoadDetections(argv[1]);
  bodyloom::TrackSequenceInput input;
  input.keypoints = &keypoints;
  input.camera.width = keypoints.image_width;
  input.camera.height = keypoints.image_height;

  bodyloom::TrackSequenceOptions options;
  options.camera_knowledge = bodyloom::CameraKnowledge::kUnknownFocal;
  // The built-in body, pose prior and lifter, where the input names none of its own.
  const auto [track, summary] = bodyloom::TrackSequence(input, options);
  std::cout << summary.BriefReport() << "\n";
  if (!summary.IsUsable()) return 1;
  bodyloom::WriteTrack(argv[2], track);
}
