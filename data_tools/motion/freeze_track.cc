// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/motion/freeze_track.h"

#include "bodyloom/geometry/base/check.h"

namespace bodyloom {

std::vector<int> FrozenAt(int num_frames, int frame, int count) {
  BODYLOOM_CHECK(frame >= 0 && frame < num_frames, "frame ", frame, " of a clip of ", num_frames);
  BODYLOOM_CHECK(count >= 0, count, " frames more, expected at least 0");
  std::vector<int> shown;
  for (int t = 0; t < num_frames; ++t) shown.insert(shown.end(), t == frame ? 1 + count : 1, t);
  return shown;
}

Track FramesInOrder(const Track& track, std::span<const int> frames) {
  const int T = static_cast<int>(frames.size()), last = track.num_frames() - 1;
  const std::vector<double>& times = track.motion.timestamps;
  const double frame_s = last > 0 ? (times.back() - times.front()) / last : 1.0 / 30;
  Track shown;
  shown.camera = track.camera;
  shown.world = track.world;
  shown.motion.body = track.motion.body;
  shown.motion.betas = track.motion.betas;
  shown.motion.up = track.motion.up;
  shown.motion.poses.resize(T, track.motion.poses.cols());
  shown.motion.trans.resize(T, 3);
  shown.weak_camera.resize(track.weak_camera.rows() > 0 ? T : 0, 3);
  shown.joint_sigma.resize(track.joint_sigma.rows() > 0 ? T : 0, track.joint_sigma.cols());
  shown.root_sigma.resize(track.root_sigma.size() > 0 ? T : 0);
  for (int t = 0; t < T; ++t) {
    const int s = frames[t];
    BODYLOOM_CHECK(s >= 0 && s <= last, "frame ", s, " of a track of ", last + 1);
    shown.motion.poses.row(t) = track.motion.poses.row(s);
    shown.motion.trans.row(t) = track.motion.trans.row(s);
    shown.motion.timestamps.push_back(times.front() + t * frame_s);
    shown.frame_status.push_back(track.frame_status.at(s));
    if (track.HasMovingCamera()) shown.camera_from_scene.push_back(track.camera_from_scene.at(s));
    if (shown.weak_camera.rows() > 0) shown.weak_camera.row(t) = track.weak_camera.row(s);
    if (shown.joint_sigma.rows() > 0) shown.joint_sigma.row(t) = track.joint_sigma.row(s);
    if (shown.root_sigma.size() > 0) shown.root_sigma[t] = track.root_sigma[s];
    if (!track.joints.empty()) shown.joints.push_back(track.joints.at(s));
    if (!track.coco17.empty()) shown.coco17.push_back(track.coco17.at(s));
  }
  return shown;
}

}  // namespace bodyloom
