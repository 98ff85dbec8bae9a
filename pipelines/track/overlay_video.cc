// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/track/overlay_video.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "bodyloom/data_tools/video/video_writer.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/parallel.h"
#include "bodyloom/pipelines/track/track_video.h"
#include "bodyloom/render/overlay.h"

namespace bodyloom {
namespace {

KeypointSequence MovedKeypoints(KeypointSequence keypoints, const Matrix2x3d& map, int width, int height) {
  for (Keypoint& point : keypoints.points) {
    const Eigen::Vector2d moved = map * Eigen::Vector3d(point.x, point.y, 1);
    point.x = static_cast<float>(moved.x());
    point.y = static_cast<float>(moved.y());
  }
  keypoints.image_width = width;
  keypoints.image_height = height;
  return keypoints;
}

}  // namespace

OverlaySummary WriteOverlayVideo(const std::string& path, const OverlayVideo& what) {
  Track track = *what.track;
  KeypointSequence detected = what.detected != nullptr ? *what.detected : KeypointSequence();
  const double fps = VideoFrameRate(track.motion.timestamps);
  std::unique_ptr<TrackVideo> video;
  if (!what.video.empty()) {
    video = std::make_unique<TrackVideo>(what.video, track, what.video_px_from_camera_px, what.video_offset);
    detected = MovedKeypoints(std::move(detected), video->map(), video->info().width, video->info().height);
    track = video->Moved(std::move(track));
  }
  OverlayOptions options;
  options.side_view = what.side_view;
  options.num_threads = ThreadsFor(0);
  const OverlayRenderer renderer(*what.body, track, options, what.reference);
  VideoWriter writer(path, renderer.width(), renderer.height(), fps);
  OverlaySummary summary;
  for (int t = 0; t < track.num_frames(); ++t) {
    OverlayFrame frame;
    frame.detected = what.detected != nullptr ? &detected : nullptr;
    if (video != nullptr) {
      frame.background = video->At(track.motion.timestamps[t]);
      summary.frames_without_video += frame.background == nullptr;
    }
    frame.caption = {{Concatenate("frame ", t, ", ", ToString(track.frame_status[t]))}};
    writer.Write(renderer.Render(t, frame));
    ++summary.frames;
    what.progress(static_cast<double>(t + 1) / track.num_frames());
  }
  writer.Finish();
  if (video != nullptr) summary.video_warning = video->warning();
  return summary;
}

}  // namespace bodyloom
