// SPDX-License-Identifier: Apache-2.0
#include "pipelines/describe/describe_clip.h"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/observations/load_cameras.h"
#include "data_tools/video/image_file.h"
#include "geometry/base/callbacks.h"
#include "geometry/base/check.h"
#include "geometry/base/stopwatch.h"
#include "geometry/scene/track.h"
#include "pipelines/body_of_track.h"
#include "pipelines/files.h"
#include "pipelines/report_json.h"

namespace bodyloom {
namespace {

constexpr int kPreviewFrames = 6;

DescribeTrackOptions OptionsOf(const DescribeClipRequest& request) {
  DescribeTrackOptions options = request.options;
  options.preview_frames = request.preview.empty() ? 0 : kPreviewFrames;
  SetAxesPose(request.cameras, request.view, request.track, &options);
  std::string why;
  if (!options.IsValid(&why)) throw RequestError(why);
  return options;
}

}  // namespace

DescribeClipReport DescribeClip(const DescribeClipRequest& request, const PipelineCallbacks& callbacks) {
  const Stopwatch watch;
  if (!request.out.ends_with(".npy"))
    throw RequestError("--out " + request.out + ": expected a name that ends in .npy");
  const std::string header = DescriptorHeaderPath(request.out);
  DescribeClipReport report;
  report.out = request.out;
  RequireReadable(request.track, "track");
  report.options = OptionsOf(request);
  RequireReadableBody(request.body);
  RequireDistinct({request.track, request.body, request.cameras}, {request.out, header, request.preview, request.json});
  for (const std::string& path : {request.out, header, request.preview, request.json}) RequireWritable(path);
  const Track track = ReadTrack(request.track, MovingCamera::kTake);
  const std::shared_ptr<const BodyModel> body = BodyOfTrack(request.body, track);
  if (!body->has_uv()) {
    throw std::runtime_error(
        (request.body.empty() ? body->name() : request.body) +
        ": a body without UV coordinates, expected vt and ft (bodyloom body convert --uv adds them)");
  }
  RequireTrackFitsBody(track, *body, request.track);
  callbacks.Begin("describe");
  try {
    report.summary = DescribeTrack(*body, track, request.out, report.options,
                                   [&](double fraction) { callbacks.Update("describing", fraction); });
  } catch (const std::invalid_argument& error) {  // what the files hold does not fit together
    throw std::runtime_error(request.track + ": " + error.what());
  }
  if (!request.preview.empty()) WriteImage(request.preview, report.summary.preview);
  report.total_seconds = watch.seconds();
  report.peak_memory_bytes = PeakMemoryBytes();
  if (!request.json.empty()) WriteFileAtomically(request.json, ToJson(report));
  return report;
}

std::string ToText(const DescribeClipReport& report) {
  const DescribeTrackSummary& s = report.summary;
  const double seconds = report.total_seconds;
  char line[256];
  std::snprintf(line, sizeof line, "%d frames x %d channels x %d x %d, %s, velocities %s in the %s frame\n", s.frames,
                s.channels, s.texels.height, s.texels.width, report.options.half ? "float16" : "float32",
                VelocityName(report.options).c_str(), ToString(report.options.frame).c_str());
  std::string text = line;
  std::snprintf(line, sizeof line, "atlas    %.0f %% of the texels show the body, %d charts, %d gutter texels\n",
                100 * s.texels.Coverage(), s.texels.num_charts, s.texels.num_gutter);
  text += line;
  if (s.texels.overlapping + s.texels.contested + s.texels.faces_outside > 0) {
    std::snprintf(line, sizeof line, "atlas    %d texels inside two faces, %d wanted by two charts, %d faces outside\n",
                  s.texels.overlapping, s.texels.contested, s.texels.faces_outside);
    text += line;
  }
  if (!s.frames_without_fit.empty()) {
    text += "lost     " + std::to_string(s.frames_without_fit.size()) + " frames have no fit and are zero\n";
  }
  if (s.runs > 1) text += "gaps     " + std::to_string(s.runs) + " runs of frames; no velocity reaches across a gap\n";
  if (report.options.seen_only) {
    std::snprintf(line, sizeof line, "seen     %.0f %% of the body's texels in the mean frame, the others are zero\n",
                  100 * s.mean_seen);
    text += line;
  }
  const NormalSummary& n = s.normals;
  if (n.degenerate_faces + n.from_neighbours + n.from_template + n.undefined > 0) {
    text += "normals  " + std::to_string(n.degenerate_faces) + " faces without area; vertices from neighbours " +
            std::to_string(n.from_neighbours) + ", from the template " + std::to_string(n.from_template) +
            ", undefined " + std::to_string(n.undefined) + "\n";
  }
  text += "time     ";
  for (const auto& [stage, stage_seconds] : s.seconds) {
    std::snprintf(line, sizeof line, "%s %.2f, ", stage.c_str(), stage_seconds);
    text += line;
  }
  std::snprintf(line, sizeof line, "in all %.2f s, %.0f frames/s\n", seconds, s.frames / std::max(seconds, 1e-9));
  text += line;
  std::snprintf(line, sizeof line, "memory   %.0f MiB at most\n",
                static_cast<double>(report.peak_memory_bytes) / (1 << 20));
  return text + line + "wrote    " + report.out + "\n";
}

std::string ToJson(const DescribeClipReport& report) {
  const DescribeTrackSummary& s = report.summary;
  const double seconds = report.total_seconds;
  nlohmann::ordered_json stages = ToJson(s.seconds);
  stages["total"] = seconds;
  const nlohmann::ordered_json json = {{"frames", s.frames},
                                       {"channels", s.channels},
                                       {"bytes", s.bytes},
                                       {"frames_without_fit", s.frames_without_fit},
                                       {"runs_without_gap", s.runs},
                                       {"frames_skinned", s.frames_skinned},
                                       {"normal_maps_baked", s.normal_maps},
                                       {"velocity_maps_baked", s.velocity_maps},
                                       {"seconds", stages},
                                       {"frames_per_second", s.frames / std::max(seconds, 1e-9)},
                                       {"peak_memory_bytes", report.peak_memory_bytes},
                                       {"outputs", {report.out, DescriptorHeaderPath(report.out)}}};
  return json.dump(1) + "\n";
}

namespace {

CameraPose WorldPoseOf(const std::string& track) {
  if (track.empty()) return LevelCamera();
  const std::optional<WorldFrame> world = ReadTrack(track, MovingCamera::kTake).world;
  return world ? world->camera_pose() : LevelCamera();
}

}  // namespace

void SetAxesPose(const std::string& cameras, const std::string& view, const std::string& track, SurfaceMotion* motion) {
  if (motion->frame == SurfaceFrame::kWorld) {
    motion->camera_pose = cameras.empty() ? WorldPoseOf(track) : FindCamera(LoadCameras(cameras), view, cameras).pose;
  } else if (!cameras.empty()) {
    throw RequestError("--cameras is for --frame world");
  }
}

}  // namespace bodyloom
