// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/accuracy/dense_clips.h"

#include <filesystem>

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

DenseFaultOptions DenseFaults(const std::string& noise) {
  DenseFaultOptions faults;
  BODYLOOM_CHECK(noise == "pixel" || noise == "uv" || noise == "densepose", "--noise is '", noise,
                 "', expected pixel, uv or densepose");
  if (noise != "uv") faults.pixel_sigma_px = 1;
  if (noise != "pixel") faults.uv_sigma = 0.02;
  if (noise != "densepose") return faults;
  faults.quantise_uv = true;
  faults.outlier_probability = 0.05;
  faults.missing_part_share = 0.05;
  return faults;
}

Motion FirstFrames(Motion motion, int frames) {
  if (frames > 0 && frames < motion.num_frames()) {
    motion.poses.conservativeResize(frames, motion.poses.cols());
    motion.trans.conservativeResize(frames, 3);
    motion.timestamps.resize(frames);
  }
  return motion;
}

KeypointSequence FirstFrames(KeypointSequence keypoints, int frames) {
  if (frames > 0 && frames < keypoints.num_frames()) {
    keypoints.timestamps.resize(frames);
    keypoints.points.resize(static_cast<size_t>(frames) * keypoints.num_points());
  }
  return keypoints;
}

void LeaveOutFeet(KeypointSequence* keypoints) {
  for (int k = 0; k < keypoints->num_points(); ++k) {
    const std::string& name = keypoints->names[k];
    if (name.find("toe") == std::string::npos && name.find("heel") == std::string::npos) continue;
    for (int t = 0; t < keypoints->num_frames(); ++t) keypoints->at(t, k).confidence = 0;
  }
}

std::string MotionName(const std::string& path) { return std::filesystem::path(path).stem().string().substr(0, 16); }

}  // namespace bodyloom
