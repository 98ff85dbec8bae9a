// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/detected_people.h"

#include <utility>

#include "data_tools/observations/frame_numbers.h"
#include "data_tools/observations/load_detections.h"
#include "pipelines/track/found_camera_motion.h"
#include "pipelines/track/observation_pixels.h"
#include "pipelines/video/track_video.h"

namespace bodyloom {

ClipFrames WholeClip(const DetectedClip& clip) { return {0, int(clip.people.frames.size()) - 1}; }

ClipFrames SpanOf(const PersonTrack& person) {
  return {person.detections.front().first, person.detections.back().first};
}

DetectPeopleRequest DetectionOf(const TrackSettings& request, int max_people) {
  DetectPeopleRequest detect;
  detect.video = request.video;
  detect.span = {request.fps, request.from_s, request.to_s, request.turn_deg.value_or(0), request.captured_fps};
  detect.detector = request.detector;
  detect.detector.blazepose.masks = DetectsMasks(request);
  detect.detector.blazepose.max_people = max_people;
  detect.part_rate = request.solve.coarse_rate;  // the frames whose masks the tracker uses
  detect.all_masks = request.all_masks;
  detect.detect_rate = request.detect_rate;
  detect.keep_samples = request.use_lines;
  detect.follow_background = WhyNoCameraMotion(request).empty();
  return detect;
}

DetectedClip DetectForTracking(const TrackSettings& request, const PipelineCallbacks& callbacks, int max_people) {
  callbacks.Begin("detecting people");
  return DetectPeople(DetectionOf(request, max_people), callbacks);
}

DetectedObservations ObservationsOf(const DetectedClip& clip, const PersonTrack& person, ClipFrames frames,
                                    const TrackSettings& request, const SceneInputs& scene) {
  // The camera has a size by now: that of its calibration, or the video's.
  const Camera& camera = scene.camera.camera;
  const Matrix2x3d map = VideoFromCameraPixels(scene.camera.video_px_from_camera_px, camera, clip.video, request.video);
  const bool same_pixels = map.isApprox(NamedCamera().video_px_from_camera_px);
  DetectedObservations seen;
  seen.keypoints = CutFrames(KeypointsOf(clip.people, person), frames.first, frames.second);
  DropUnsure(request.min_confidence, &seen.keypoints);
  seen.hands_and_face = CutFrames(HandsAndFaceOf(clip.people, person), frames.first, frames.second);
  DropUnsure(request.min_confidence, &seen.hands_and_face);
  if (DetectsMasks(request)) {
    PartLabelSequence mask = MaskOfPerson(clip, person);
    for (size_t t = 0; t < mask.frames.size(); ++t) {
      if (clip.parts_are_due[t] == 0) mask.frames[t] = {};
    }
    seen.mask = CutFrames(std::move(mask), frames.first, frames.second);
  }
  if (same_pixels) return seen;
  seen.keypoints = MovedToCamera(std::move(seen.keypoints), map, camera.width, camera.height);
  seen.hands_and_face = MovedToCamera(std::move(seen.hands_and_face), map, camera.width, camera.height);
  if (seen.mask) seen.mask = MovedToCamera(*seen.mask, map, camera.width, camera.height);
  return seen;
}

}  // namespace bodyloom
