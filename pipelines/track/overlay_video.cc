// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/overlay_video.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>

#include "data_tools/video/video_writer.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/base/prefetcher.h"
#include "geometry/scene/camera_path.h"
#include "pipelines/track/observation_pixels.h"
#include "pipelines/video/track_video.h"
#include "render/view/overlay.h"
#include "tracking/detection/people_between.h"

namespace bodyloom {
namespace {

/// The video's images at some times, null where it has none, and images drawn on them.
struct FrameGroup {
  std::vector<std::optional<Image>> backgrounds;
  std::vector<Image> images;
};

/// Writes one image for each of these times; `draw(renderer, index, frame of the video or null)` runs in several
/// threads at once, each with its own renderer. Images are read and drawn while previous ones are encoded.
template <typename Renderer>
OverlaySummary WriteFrames(VideoWriter* writer, const std::vector<double>& times, TrackVideo* video,
                           const Renderer& renderer,
                           const std::function<Image(const Renderer&, int, const Image*)>& draw,
                           const std::function<void(double)>& progress) {
  constexpr size_t kGroupsAhead = 2;  // of each stage: the time of a frame varies
  const int num_threads = ThreadsFor(0), num_times = int(times.size());
  const int num_groups = (num_times + num_threads - 1) / num_threads;
  const std::vector<Renderer> renderers(size_t(num_threads), renderer);
  const auto size_of = [&](int64_t group) { return std::min(num_threads, num_times - int(group) * num_threads); };
  Prefetcher<FrameGroup> read(
      num_groups,
      [&](int64_t group) {
        FrameGroup frames;
        frames.backgrounds.resize(size_t(size_of(group)));
        for (size_t i = 0; video != nullptr && i < frames.backgrounds.size(); ++i) {
          if (const Image* image = video->At(times[size_t(group) * size_t(num_threads) + i])) {
            frames.backgrounds[i] = *image;
          }
        }
        return frames;
      },
      kGroupsAhead);
  Prefetcher<FrameGroup> drawn(
      num_groups,
      [&](int64_t group) {
        FrameGroup frames = read.Take();
        frames.images.resize(frames.backgrounds.size());
        ParallelFor(size_of(group), num_threads, [&](int i) {
          const std::optional<Image>& background = frames.backgrounds[size_t(i)];
          frames.images[size_t(i)] =
              draw(renderers[size_t(i)], int(group) * num_threads + i, background ? &*background : nullptr);
        });
        return frames;
      },
      kGroupsAhead);
  OverlaySummary summary;
  for (int group = 0; group < num_groups; ++group) {
    const FrameGroup frames = drawn.Take();
    for (size_t i = 0; i < frames.images.size(); ++i) {
      summary.frames_without_video += video != nullptr && !frames.backgrounds[i] ? 1 : 0;
      writer->Write(frames.images[i]);
      progress(double(++summary.frames) / num_times);
    }
  }
  writer->Finish();
  if (video != nullptr) summary.video_warning = video->warning();
  return summary;
}

/// Adds to `filled` a part, get(frame), in frames between two that have it.
template <typename Get>
void FillPart(const HandsAndFaceSequence& seen, const Get& get, std::vector<HandsAndFace>* filled) {
  constexpr double kLongestGap_s = 0.1;
  int last = -1;
  for (int t = 0; t < seen.num_frames(); ++t) {
    if (!get((*filled)[size_t(t)])) continue;
    const std::vector<double>& times = seen.timestamps;
    const double gap = last < 0 ? 0 : times[size_t(t)] - times[size_t(last)];
    for (int k = last + 1; last >= 0 && gap <= kLongestGap_s && k < t; ++k) {
      const double share = (times[size_t(k)] - times[size_t(last)]) / gap;
      const auto &before = *get((*filled)[size_t(last)]), &after = *get((*filled)[size_t(t)]);
      auto& part = get((*filled)[size_t(k)]);
      part = before;
      for (size_t i = 0; i < part->points.size(); ++i) {
        part->points[i] = Between(before.points[i], after.points[i], share);
      }
    }
    last = t;
  }
}

/// Hands and faces are looked for in fifteen frames a second (DetectPeopleRequest::part_rate); to be drawn without
/// flicker, they get places in the frames between.
HandsAndFaceSequence WithFramesBetween(HandsAndFaceSequence seen) {
  std::vector<HandsAndFace> filled;
  for (const auto& frame : seen.frames) filled.push_back(frame ? *frame : HandsAndFace());
  for (const auto side : {HandsAndFace::kLeft, HandsAndFace::kRight}) {
    FillPart(
        seen, [side](HandsAndFace & frame) -> auto& { return frame.hands[side]; }, &filled);
  }
  FillPart(
      seen, [](HandsAndFace & frame) -> auto& { return frame.face; }, &filled);
  for (size_t t = 0; t < filled.size(); ++t) {
    if (!filled[t].empty()) seen.frames[t] = std::make_shared<const HandsAndFace>(std::move(filled[t]));
  }
  return seen;
}

}  // namespace

OverlaySummary WriteOverlayVideo(const std::string& path, const OverlayVideo& what) {
  Track track = *what.track;
  KeypointSequence detected = what.detected != nullptr ? *what.detected : KeypointSequence();
  const double fps = VideoFrameRate(track.motion.timestamps) / track.playback.slowdown;
  std::unique_ptr<TrackVideo> video;
  if (!what.video.empty()) {
    video = std::make_unique<TrackVideo>(what.video, track, what.video_px_from_camera_px, what.video_offset);
    detected = MovedKeypoints(std::move(detected), video->map(), video->info().width, video->info().height);
    track = video->Moved(std::move(track));
  }
  OverlayOptions options;
  options.side_view = what.side_view;
  if (track.world) options.up_in_camera = track.world->up_in_camera();
  options.num_threads = 1;  // a picture each: WriteFrames()
  const OverlayRenderer renderer(*what.body, track, options, what.reference);
  VideoWriter writer(path, renderer.width(), renderer.height(), fps);
  const auto draw = [&](const OverlayRenderer& own, int t, const Image* background) {
    OverlayFrame frame;
    frame.detected = what.detected != nullptr ? &detected : nullptr;
    frame.background = background;
    frame.caption = {{Concatenate("frame ", t, ", ", ToString(track.frame_status[t]))}};
    return own.Render(t, frame);
  };
  return WriteFrames<OverlayRenderer>(&writer, track.motion.timestamps, video.get(), renderer, draw, what.progress);
}

void SetScene(const SharedScene& scene, const CameraPose& camera_from_scene, PeopleOverlayVideo* overlay) {
  if (!scene.has_up) return;
  const KnownGround& ground = scene.ground;
  overlay->up_in_camera = camera_from_scene.camera_from_world_rotation * ground.up;
  if (!ground.has_plane) return;
  overlay->ground = Floor{MovedPoint(camera_from_scene, -ground.camera_height_m * ground.up), overlay->up_in_camera};
}

OverlaySummary WritePeopleOverlayVideo(const std::string& path, const PeopleOverlayVideo& what) {
  BODYLOOM_CHECK(!what.people.empty(), "overlay: nobody to draw");
  // Only now and here in the video's pixels.
  std::vector<Track> tracks;
  std::vector<KeypointSequence> detected;
  std::vector<HandsAndFaceSequence> hands_and_face;
  std::unique_ptr<TrackVideo> video;
  if (!what.video.empty()) {
    video = std::make_unique<TrackVideo>(what.video, *what.people[0].track, what.video_px_from_camera_px);
  }
  for (const PersonInOverlay& person : what.people) {
    tracks.push_back(video != nullptr ? video->Moved(*person.track) : *person.track);
    detected.push_back(person.detected != nullptr ? *person.detected : KeypointSequence());
    hands_and_face.push_back(person.hands_and_face != nullptr ? WithFramesBetween(*person.hands_and_face)
                                                              : HandsAndFaceSequence());
    if (video == nullptr) continue;
    detected.back() =
        MovedKeypoints(std::move(detected.back()), video->map(), video->info().width, video->info().height);
    hands_and_face.back() =
        MovedKeypoints(std::move(hands_and_face.back()), video->map(), video->info().width, video->info().height);
  }
  std::vector<PersonInOverlay> people = what.people;
  for (size_t i = 0; i < people.size(); ++i) {
    people[i].track = &tracks[i];
    if (people[i].detected != nullptr) people[i].detected = &detected[i];
    if (people[i].hands_and_face != nullptr) people[i].hands_and_face = &hands_and_face[i];
  }
  OverlayOptions options;
  options.side_view = what.side_view;
  options.up_in_camera = what.up_in_camera;
  options.num_threads = 1;  // a picture each: WriteFrames()
  const PeopleOverlay overlay(std::move(people), options, what.ground);
  const double fps = VideoFrameRate(overlay.timestamps()) / what.people[0].track->playback.slowdown;
  VideoWriter writer(path, overlay.width(), overlay.height(), fps);
  const auto draw = [](const PeopleOverlay& own, int moment, const Image* background) {
    return own.Render(moment, background);
  };
  return WriteFrames<PeopleOverlay>(&writer, overlay.timestamps(), video.get(), overlay, draw, what.progress);
}

}  // namespace bodyloom
