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

/// Writes one picture for each of these times; `draw` gets its index and the video's frame, null where there is none.
OverlaySummary WriteFrames(VideoWriter* writer, const std::vector<double>& times, TrackVideo* video,
                           const std::function<Image(int, const Image*)>& draw,
                           const std::function<void(double)>& progress) {
  OverlaySummary summary;
  for (size_t t = 0; t < times.size(); ++t) {
    const Image* background = video != nullptr ? video->At(times[t]) : nullptr;
    summary.frames_without_video += video != nullptr && background == nullptr;
    writer->Write(draw(int(t), background));
    ++summary.frames;
    progress(double(t + 1) / double(times.size()));
  }
  writer->Finish();
  if (video != nullptr) summary.video_warning = video->warning();
  return summary;
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
  const auto draw = [&](int t, const Image* background) {
    OverlayFrame frame;
    frame.detected = what.detected != nullptr ? &detected : nullptr;
    frame.background = background;
    frame.caption = {{Concatenate("frame ", t, ", ", ToString(track.frame_status[t]))}};
    return renderer.Render(t, frame);
  };
  return WriteFrames(&writer, track.motion.timestamps, video.get(), draw, what.progress);
}

OverlaySummary WritePeopleOverlayVideo(const std::string& path, const PeopleOverlayVideo& what) {
  BODYLOOM_CHECK(!what.people.empty(), "overlay: nobody to draw");
  // Only now and here in the video's pixels.
  std::vector<Track> tracks;
  std::vector<KeypointSequence> detected;
  std::unique_ptr<TrackVideo> video;
  if (!what.video.empty()) {
    video = std::make_unique<TrackVideo>(what.video, *what.people[0].track, what.video_px_from_camera_px);
  }
  for (const PersonInOverlay& person : what.people) {
    tracks.push_back(video != nullptr ? video->Moved(*person.track) : *person.track);
    detected.push_back(person.detected != nullptr ? *person.detected : KeypointSequence());
    if (video == nullptr) continue;
    detected.back() =
        MovedKeypoints(std::move(detected.back()), video->map(), video->info().width, video->info().height);
  }
  std::vector<PersonInOverlay> people = what.people;
  for (size_t i = 0; i < people.size(); ++i) {
    people[i].track = &tracks[i];
    if (people[i].detected != nullptr) people[i].detected = &detected[i];
  }
  OverlayOptions options;
  options.side_view = what.side_view;
  options.up_in_camera = what.up_in_camera;
  options.num_threads = ThreadsFor(0);
  const PeopleOverlay overlay(std::move(people), options, what.ground);
  VideoWriter writer(path, overlay.width(), overlay.height(), VideoFrameRate(overlay.timestamps()));
  const auto draw = [&](int moment, const Image* background) { return overlay.Render(moment, background); };
  return WriteFrames(&writer, overlay.timestamps(), video.get(), draw, what.progress);
}

}  // namespace bodyloom
