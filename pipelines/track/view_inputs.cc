// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/view_inputs.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include "data_tools/formats/printable.h"
#include "data_tools/observations/load_cameras.h"
#include "data_tools/observations/rig_io.h"
#include "geometry/base/check.h"
#include "geometry/base/percentile.h"
#include "pipelines/files.h"

namespace bodyloom {
namespace {

constexpr std::array<const char*, 3> kKnownOfRigNames = {"intrinsics", "poses", "clocks"};

/// Cameras of a file, with the clocks of a rig's.
struct CamerasOfViews {
  std::vector<NamedCamera> cameras;
  std::vector<RigCamera> rig;  ///< of the same cameras, or empty
};

size_t NumViews(const TrackViewsRequest& request) {
  return std::max(request.view_detections.size(), request.views.size());
}

const std::string& DetectionsOf(const TrackViewsRequest& request, size_t v) {
  return request.view_detections.size() == 1 ? request.view_detections[0] : request.view_detections[v];
}

/// "cam_01" of "data/cam_01.json" and "data/cam_01/".
std::string NameOfFile(const std::string& path) {
  const std::filesystem::path file = std::filesystem::path(path).lexically_normal();
  return file.has_filename() ? file.stem().string() : file.parent_path().filename().string();
}

/// The views' own names: those of the request, else of the files, else of their order.
std::vector<std::string> NamesOfViews(const TrackViewsRequest& request) {
  if (!request.views.empty()) return request.views;
  std::vector<std::string> names;
  for (const std::string& file : request.view_detections) names.push_back(NameOfFile(file));
  if (std::set<std::string>(names.begin(), names.end()).size() == names.size()) return names;
  for (size_t v = 0; v < names.size(); ++v) names[v] = "view" + std::to_string(v + 1);
  return names;
}

CamerasOfViews ReadCamerasOfViews(const TrackViewsRequest& request) {
  CamerasOfViews read;
  read.cameras = LoadCameras(request.cameras, request.view_detections[0]);
  if (IsRigFile(request.cameras)) read.rig = ReadRig(request.cameras);
  return read;
}

/// Index of each view's camera in the file: that of its name, where every view has one; else in their order.
std::vector<size_t> CamerasByView(const TrackViewsRequest& request, const std::vector<std::string>& names,
                                  const std::vector<NamedCamera>& cameras) {
  std::vector<size_t> index;
  try {
    for (const std::string& name : names) {
      index.push_back(static_cast<size_t>(&FindCamera(cameras, name, request.cameras) - cameras.data()));
    }
  } catch (const std::runtime_error& error) {
    if (!request.views.empty()) throw;
    if (cameras.size() != names.size()) {
      throw std::runtime_error(Concatenate(error.what(), "; expected cameras of these names or ", names.size(),
                                           " cameras in the order of --detections"));
    }
    index.clear();
    for (size_t v = 0; v < names.size(); ++v) index.push_back(v);
  }
  if (std::set<size_t>(index.begin(), index.end()).size() != index.size()) {
    throw std::runtime_error(request.cameras + ": two views have the same camera, expected one each");
  }
  return index;
}

double MedianRate(const std::vector<double>& timestamps) {
  std::vector<double> steps;
  for (size_t t = 1; t < timestamps.size(); ++t) steps.push_back(timestamps[t] - timestamps[t - 1]);
  return steps.empty() ? 0 : 1 / Percentile(steps, 50);
}

/// One view's request: without the first one's video, and without lines, which several views do not use.
TrackRequest RequestOfView(const TrackViewsRequest& request, size_t v) {
  TrackRequest one = request;
  one.detections = DetectionsOf(request, v);
  one.view = request.views.empty() ? "" : request.views[v];
  one.use_lines = false;
  if (v > 0) {
    one.video = one.reference = "";
  }
  return one;
}

/// The clock of camera `own` relative to that of `first`, both relative to a third; about `middle_s` of the first.
RigCamera ClockBetween(const RigCamera& first, const RigCamera& own, double middle_s) {
  RigCamera clock;
  clock.middle_s = middle_s;
  clock.rate = (1 + own.rate) / (1 + first.rate) - 1;
  clock.offset_s = own.TimeAt(first.FirstTimeAt(middle_s)) - middle_s;
  return clock;
}

void UseCameraOfView(const TrackViewsRequest& request, const NamedCamera& camera, GivenInMemory* given) {
  if (request.image_width > 0 &&
      (camera.camera.width != request.image_width || camera.camera.height != request.image_height)) {
    throw std::runtime_error(Concatenate(request.cameras, ": camera ", PrintableText(camera.name), " is for images of ",
                                         camera.camera.width, "x", camera.camera.height, ", --image-size says ",
                                         request.image_width, "x", request.image_height));
  }
  if (camera.camera.model != CameraModel::kPinhole) {
    throw std::runtime_error(request.cameras + ": camera " + PrintableText(camera.name) +
                             " is of weak perspective, several views need pinhole cameras");
  }
  given->camera = camera.camera;
}

void UsePosesOfRig(const TrackViewsRequest& request, const std::vector<NamedCamera>& cameras,
                   const std::vector<size_t>& index, std::vector<ViewInputs>* views) {
  const auto posed = std::count_if(index.begin(), index.end(), [&](size_t i) { return cameras[i].has_pose; });
  if (request.known == KnownOfRig::kIntrinsics || posed == 0) return;
  if (posed != static_cast<ptrdiff_t>(index.size())) {
    throw std::runtime_error(Concatenate(request.cameras, ": ", posed, " of the ", index.size(),
                                         " views' cameras have a pose, expected all of them, or --known intrinsics"));
  }
  for (size_t v = 0; v < index.size(); ++v) (*views)[v].camera_from_rig = cameras[index[v]].pose;
}

/// Clocks of a rig, applied to the timestamps of all views but the first.
void UseClocksOfRig(const TrackViewsRequest& request, const std::vector<RigCamera>& rig,
                    const std::vector<size_t>& index, std::vector<ViewInputs>* views) {
  if (request.known != KnownOfRig::kClocks || rig.empty() || !rig[index[0]].HasClock()) return;
  const std::vector<double>& first_times = (*views)[0].inputs.keypoints->timestamps;
  const double middle_s = 0.5 * (first_times.front() + first_times.back());
  for (size_t v = 1; v < index.size(); ++v) {
    if (!rig[index[v]].HasClock()) continue;
    ViewInputs& view = (*views)[v];
    view.clock = ClockBetween(rig[index[0]], rig[index[v]], middle_s);
    for (double& time : view.inputs.keypoints->timestamps) time = view.clock.FirstTimeAt(time);
  }
}

}  // namespace

std::string ToString(KnownOfRig known) { return kKnownOfRigNames[static_cast<size_t>(known)]; }

KnownOfRig KnownOfRigFromString(const std::string& word) {
  const auto found = std::find(kKnownOfRigNames.begin(), kKnownOfRigNames.end(), word);
  BODYLOOM_CHECK(found != kKnownOfRigNames.end(), "'", word, "', expected intrinsics, poses or clocks");
  return static_cast<KnownOfRig>(found - kKnownOfRigNames.begin());
}

bool HasSeveralViews(const TrackViewsRequest& request) { return NumViews(request) > 1; }

TrackRequest RequestOfOneView(const TrackViewsRequest& request) {
  if (!request.rig_out.empty()) {
    throw RequestError("--rig-out is of several views: give several --detections, or several names in --view");
  }
  if (request.known != KnownOfRig::kClocks) {
    throw RequestError("--known is of several views: give several --detections, or several names in --view");
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
  const std::vector<std::pair<bool, std::string>> refused = {{!request.camera_path.empty(), "--camera-path"},
                                                             {request.camera == "weak", "--camera weak"},
                                                             {!request.dense.empty(), "--dense"},
                                                             {!request.part_labels.empty(), "--part-labels"},
                                                             {!request.init.empty(), "--init"},
                                                             {request.live_lag.has_value(), "--live"},
                                                             {request.dense_uv_sigma.has_value(), "--dense-uv-sigma"}};
  for (const auto& [given, option] : refused) {
    if (given)
      throw RequestError("several views are tracked by 2D joints of cameras that stand still: leave out " + option);
  }
  if (request.known != KnownOfRig::kClocks && request.cameras.empty()) {
    throw RequestError("--known says how much of --cameras to use: give --cameras FILE");
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
  const std::vector<std::string> names = NamesOfViews(request);
  CamerasOfViews known;
  std::vector<size_t> index;
  if (!request.cameras.empty()) {
    known = ReadCamerasOfViews(request);
    index = CamerasByView(request, names, known.cameras);
  }
  std::vector<ViewInputs> views;
  for (size_t v = 0; v < names.size(); ++v) {
    GivenInMemory given;
    if (v > 0) given.body = views[0].inputs.body;
    if (!index.empty()) UseCameraOfView(request, known.cameras[index[v]], &given);
    ViewInputs& view = views.emplace_back();
    view.name = index.empty() || known.cameras[index[v]].name.empty() ? names[v] : known.cameras[index[v]].name;
    view.detections = DetectionsOf(request, v);
    view.inputs = LoadTrackInputs(RequestOfView(request, v), callbacks, given);
    if (!view.inputs.keypoints) {
      throw std::runtime_error(view.detections + ": dense keypoints alone, several views need 2D joints");
    }
    view.inputs.dense.reset();
    if (!index.empty()) view.inputs.camera.video_px_from_camera_px = known.cameras[index[v]].video_px_from_camera_px;
    view.fps = MedianRate(view.inputs.keypoints->timestamps);
    view.clock.offset_s = v == 0 ? 0 : std::numeric_limits<double>::quiet_NaN();
  }
  if (!index.empty()) {
    UsePosesOfRig(request, known.cameras, index, &views);
    UseClocksOfRig(request, known.rig, index, &views);
  }
  return views;
}

}  // namespace bodyloom
