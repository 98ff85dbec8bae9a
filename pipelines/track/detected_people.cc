// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/track/detected_people.h"

#include <vector>

#include "bodyloom/data_tools/observations/load_detections.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/pipelines/track/move_observations.h"
#include "bodyloom/pipelines/track/track_video.h"

namespace bodyloom {
namespace {

/// Keeps elements [first, last] of what has `each` of them a frame.
template <typename T>
void Cut(ClipFrames frames, size_t each, std::vector<T>* all) {
  const auto begin = all->begin() + std::ptrdiff_t(each) * frames.first;
  *all = std::vector<T>(begin, begin + std::ptrdiff_t(each) * (frames.second - frames.first + 1));
}

}  // namespace

ClipFrames WholeClip(const DetectedClip& clip) { return {0, int(clip.people.frames.size()) - 1}; }

ClipFrames SpanOf(const PersonTrack& person) {
  return {person.detections.front().first, person.detections.back().first};
}

DetectedClip DetectForTracking(const TrackRequest& request, const PipelineCallbacks& callbacks, int max_people) {
  DetectPeopleRequest detect;
  detect.video = request.video;
  detect.models = request.models;
  detect.fps = request.fps;
  detect.from_s = request.from_s;
  detect.to_s = request.to_s;
  detect.detector.network = request.detector;
  detect.detector.masks = request.use_mask;
  detect.detector.max_people = max_people;
  callbacks.Begin("detecting people");
  return DetectPeople(detect, callbacks);
}

DetectedObservations ObservationsOf(const DetectedClip& clip, const PersonTrack& person, ClipFrames frames,
                                    const TrackRequest& request, const SceneInputs& scene) {
  BODYLOOM_CHECK(0 <= frames.first && frames.first <= frames.second && frames.second <= WholeClip(clip).second,
                 "frames ", frames.first, " to ", frames.second, " of a clip of ", clip.people.frames.size());
  // The camera has a size by now: that of its calibration, or the video's.
  const Camera& camera = scene.camera.camera;
  const Matrix2x3d map = VideoFromCameraPixels(scene.camera.video_px_from_camera_px, camera, clip.people.image_width,
                                               clip.people.image_height, request.video);
  const bool same_pixels = map.isApprox(NamedCamera().video_px_from_camera_px);
  DetectedObservations seen;
  seen.keypoints = KeypointsOf(clip.people, person);
  Cut(frames, size_t(seen.keypoints.num_points()), &seen.keypoints.points);
  Cut(frames, 1, &seen.keypoints.timestamps);
  DropUnsure(request.min_confidence, &seen.keypoints);
  if (request.use_mask) {
    seen.mask = MaskOfPerson(clip, person);
    Cut(frames, 1, &seen.mask->frames);
    Cut(frames, 1, &seen.mask->timestamps);
  }
  if (same_pixels) return seen;
  seen.keypoints = MovedToCamera(std::move(seen.keypoints), map, camera.width, camera.height);
  if (seen.mask) seen.mask = MovedToCamera(*seen.mask, map, camera.width, camera.height);
  return seen;
}

}  // namespace bodyloom
