// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/view_inputs.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/percentile.h"
#include "pipelines/files.h"

namespace bodyloom {
namespace {

size_t NumViews(const TrackViewsRequest& request) {
  return std::max(request.view_detections.size(), request.views.size());
}

const std::string& DetectionsOf(const TrackViewsRequest& request, size_t v) {
  return request.view_detections.size() == 1 ? request.view_detections[0] : request.view_detections[v];
}

double MedianRate(const std::vector<double>& timestamps) {
  std::vector<double> steps;
  for (size_t t = 1; t < timestamps.size(); ++t) steps.push_back(timestamps[t] - timestamps[t - 1]);
  return steps.empty() ? 0 : 1 / Percentile(steps, 50);
}

constexpr const char* kViewInPath = "{view}";

/// The camera path of a view: the request's with the view's name in it, if there is such a file; else it stands still.
std::string PathOfView(const TrackViewsRequest& request, size_t v) {
  std::string path = request.camera_path;
  const size_t at = path.find(kViewInPath);
  if (at == std::string::npos) return path;
  path.replace(at, std::string(kViewInPath).size(), NamesOfViews(request.views, request.view_detections)[v]);
  std::error_code ignored;
  return std::filesystem::exists(path, ignored) ? path : "";
}

/// One view's request, without the first one's video.
TrackRequest RequestOfView(const TrackViewsRequest& request, size_t v) {
  TrackRequest one = request;
  one.detections = DetectionsOf(request, v);
  one.view = request.views.empty() ? "" : request.views[v];
  one.camera_path = PathOfView(request, v);
  one.find_camera_motion = false;
  if (v > 0) {
    one.video = one.reference = "";
    one.from_s = 0;
    one.to_s = -1;
  }
  return one;
}

}  // namespace

bool HasSeveralViews(const TrackViewsRequest& request) { return NumViews(request) > 1; }

TrackRequest RequestOfOneView(const TrackViewsRequest& request) {
  if (!request.rig_out.empty()) {
    throw RequestError("--rig-out is of several views: give several --detections, or several names in --view");
  }
  if (request.known != KnownOfRig::kClocks) {
    throw RequestError("--known is of several views: give several --detections, or several names in --view");
  }
  if (request.same_lens) {
    throw RequestError("--same-lens is of several views: give several --detections, or several names in --view");
  }
  TrackRequest one = request;
  if (!request.view_detections.empty()) one.detections = request.view_detections[0];
  if (!request.views.empty()) one.view = request.views[0];
  return one;
}

void CheckTrackViewsRequest(const TrackViewsRequest& request) {
  const std::vector<std::string>& files = request.view_detections;
  if (files.empty()) throw RequestError("several views need 2D joints of each: give --detections");
  if (files.size() > 1 && !request.views.empty() && files.size() != request.views.size()) {
    throw RequestError(Concatenate(files.size(), " files of --detections and ", request.views.size(),
                                   " names in --view, expected a name for each file"));
  }
  std::set<std::string> names, seen;
  for (const std::string& view : request.views) {
    if (view.empty()) throw RequestError("--view has an empty name");
    if (!names.insert(view).second) throw RequestError("--view lists " + view + " twice");
  }
  if (request.views.empty()) {
    for (const std::string& file : files) {
      if (!seen.insert(file).second) throw RequestError("--detections " + file + " is given twice");
    }
  }
  const std::vector<std::pair<bool, std::string>> refused = {
      {request.camera == "weak", "--camera weak"},     {!request.dense.empty(), "--dense"},
      {!request.part_labels.empty(), "--part-labels"}, {!request.init.empty(), "--init"},
      {request.live_lag.has_value(), "--live"},        {request.dense_uv_sigma.has_value(), "--dense-uv-sigma"}};
  for (const auto& [given, option] : refused) {
    if (given) throw RequestError("several views are tracked by their 2D joints: leave out " + option);
  }
  if (request.known != KnownOfRig::kClocks && request.cameras.empty()) {
    throw RequestError("--known says how much of --cameras to use: give --cameras FILE");
  }
  if (!request.camera_path.empty() && request.camera_path.find(kViewInPath) == std::string::npos) {
    throw RequestError("--camera-path " + request.camera_path +
                       ": several views need a path each, expected a name with {view} in it, as paths/{view}.json");
  }
  CheckTrackRequest(RequestOfView(request, 0));
}

std::vector<std::string> RequireViewInputs(const TrackViewsRequest& request) {
  std::vector<std::string> inputs = request.view_detections;
  for (size_t v = 0; v < NumViews(request); ++v) {
    for (const std::string& file : RequireTrackInputs(RequestOfView(request, v))) inputs.push_back(file);
  }
  return inputs;
}

std::vector<ViewInputs> LoadViewInputs(const TrackViewsRequest& request, const PipelineCallbacks& callbacks) {
  const std::vector<std::string> names = NamesOfViews(request.views, request.view_detections);
  const KnownRig rig({.cameras = request.cameras,
                      .detections = request.view_detections[0],
                      .names_given = !request.views.empty(),
                      .known = request.known,
                      .image_width = request.image_width,
                      .image_height = request.image_height},
                     names);
  std::vector<ViewInputs> views;
  for (size_t v = 0; v < names.size(); ++v) {
    const NamedCamera* camera = rig.CameraOf(v);
    GivenInMemory given;
    if (v > 0) given.body = views[0].inputs.body;
    if (camera != nullptr) given.camera = camera->camera;
    ViewInputs& view = views.emplace_back();
    view.name = camera == nullptr || camera->name.empty() ? names[v] : camera->name;
    view.detections = DetectionsOf(request, v);
    view.inputs = LoadTrackInputs(RequestOfView(request, v), callbacks, given);
    if (!view.inputs.keypoints) {
      throw std::runtime_error(view.detections + ": dense keypoints alone, several views need 2D joints");
    }
    view.inputs.dense.reset();
    if (camera != nullptr) view.inputs.camera.video_px_from_camera_px = camera->video_px_from_camera_px;
    view.camera_from_rig = rig.PoseOf(v);
    std::vector<double>& times = view.inputs.keypoints->timestamps;
    view.fps = MedianRate(times);
    if (v == 0) continue;
    const std::vector<double>& first_times = views[0].inputs.keypoints->timestamps;
    view.clock = rig.ClockOf(v, 0.5 * (first_times.front() + first_times.back()));
    if (!view.clock.HasClock()) continue;
    for (double& time : times) time = view.clock.FirstTimeAt(time);
  }
  return views;
}

}  // namespace bodyloom
