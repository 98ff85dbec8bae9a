// SPDX-License-Identifier: Apache-2.0
#include "pipelines/score/rig_clip.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "data_tools/evaluation/triangulated_clip.h"
#include "data_tools/observations/frame_numbers.h"
#include "data_tools/observations/load_cameras.h"
#include "data_tools/observations/load_detections.h"
#include "geometry/base/callbacks.h"
#include "geometry/base/check.h"
#include "pipelines/track/observation_pixels.h"
#include "pipelines/video/track_video.h"

namespace bodyloom {
namespace {

RigView ReadView(const RigDetections& seen, const std::vector<NamedCamera>& cameras, const std::string& calibration,
                 const PipelineCallbacks& callbacks) {
  const NamedCamera& named = FindCamera(cameras, seen.view, calibration);
  LoadDetectionsOptions options;
  options.person = seen.person;
  std::vector<std::string> warnings;
  KeypointSequence detections = LoadDetections(seen.detections, options, &warnings);
  for (const std::string& warning : warnings) callbacks.Message(warning);
  const Camera& camera = named.camera;
  if (detections.image_width > 0) {
    const Matrix2x3d map = VideoFromCameraPixels(named.video_px_from_camera_px, camera, detections.image_width,
                                                 detections.image_height, seen.detections);
    detections = MovedToCamera(std::move(detections), map, camera.width, camera.height);
  }
  return {named.name, camera, named.pose, AsCoco17(detections, seen.detections)};
}

/// The frame that is nearest to a time; −1 when none is within half a frame.
int FrameAt(const std::vector<double>& timestamps, double time_s) {
  const auto nearer = [&](double a, double b) { return std::abs(a - time_s) < std::abs(b - time_s); };
  const auto nearest = std::min_element(timestamps.begin(), timestamps.end(), nearer);
  if (nearest == timestamps.end() || std::abs(*nearest - time_s) > 0.5 / VideoFrameRate(timestamps)) return -1;
  return int(nearest - timestamps.begin());
}

}  // namespace

RigDetections RigDetectionsFromText(const std::string& text) {
  const size_t equals = text.find('=');
  const std::string head = text.substr(0, equals);
  const size_t colon = head.find(':');
  RigDetections seen;
  seen.view = head.substr(0, colon);
  const std::string person = colon == std::string::npos ? "0" : head.substr(colon + 1);
  const bool is_number = !person.empty() && person.size() < 6 &&
                         std::all_of(person.begin(), person.end(), [](unsigned char c) { return std::isdigit(c); });
  if (equals == std::string::npos || equals + 1 == text.size() || seen.view.empty() || !is_number) {
    throw RequestError("'" + text + "', expected VIEW=FILE or VIEW:PERSON=FILE as in cam_02:1=detections.npz");
  }
  seen.person = std::stoi(person);
  seen.detections = text.substr(equals + 1);
  return seen;
}

MultiViewClip ReadRigClip(const std::string& cameras, const std::vector<RigDetections>& seen, const std::string& view,
                          const Track& track, const PipelineCallbacks& callbacks) {
  if (seen.size() < 2) throw RequestError("one camera has nothing to triangulate with, expected detections of two");
  const std::vector<NamedCamera> calibrated = LoadCameras(cameras);
  const std::string fitted = FindCamera(calibrated, view, cameras).name;
  MultiViewClip clip;
  clip.name = std::filesystem::path(seen[0].detections).stem().string();
  int own = -1;
  for (const RigDetections& one : seen) {
    clip.views.push_back(ReadView(one, calibrated, cameras, callbacks));
    if (clip.views.back().name != fitted) continue;
    own = int(clip.views.size()) - 1;
    clip.views.back().name = view;  // as the caller spells it
  }
  if (own < 0) {
    throw RequestError("no detections of the camera " + fitted + ", to which the track was fitted, among those given");
  }
  const std::vector<double>& times = clip.views[size_t(own)].detections.timestamps;
  clip.fps = VideoFrameRate(times);
  const int first = track.motion.timestamps.empty() ? -1 : FrameAt(times, track.motion.timestamps[0]);
  if (first < 0) {
    throw std::runtime_error(seen[size_t(own)].detections + ": no frame at the time at which the track begins");
  }
  for (size_t v = 0; v < clip.views.size(); ++v) {
    KeypointSequence& detections = clip.views[v].detections;
    if (detections.num_frames() <= first) {
      throw std::runtime_error(
          Concatenate(seen[v].detections, ": ", detections.num_frames(), " frames, the track begins at frame ", first));
    }
    const int last = detections.num_frames() - 1;
    detections = CutFrames(std::move(detections), first, last);
  }
  clip.coco17_in_world = TriangulateViews(clip.views);
  return clip;
}

}  // namespace bodyloom
