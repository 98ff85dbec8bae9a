// SPDX-License-Identifier: Apache-2.0
#include "pipelines/synthesis/synthesize_clip.h"

#include <filesystem>
#include <memory>
#include <sstream>

#include "data_tools/body/builtin_body.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/observations/load_camera_path.h"
#include "data_tools/observations/load_cameras.h"
#include "data_tools/observations/observations_npz.h"
#include "data_tools/video/video_writer.h"
#include "geometry/scene/camera_path.h"
#include "pipelines/files.h"
#include "pipelines/video/track_video.h"
#include "render/image/palette.h"
#include "render/view/overlay.h"
#include "render/view/shaded_mesh.h"

namespace bodyloom {
namespace {

/// A track file for the perturbed motion, which has no observations of its own.
Track InitialiserTrack(const SynthClip& clip) {
  Track track;
  track.motion = clip.initialiser;
  track.camera = clip.truth.camera;
  track.weak_camera = clip.truth.weak_camera;
  track.frame_status.assign(track.num_frames(), FrameStatus::kTracked);
  return track;
}

/// The true body before a plain backdrop: what a camera would have filmed.
void RenderClip(const std::string& path, const BodyModel& body, const Track& truth,
                const PipelineCallbacks& callbacks) {
  callbacks.Begin("rendering " + std::to_string(truth.num_frames()) + " frames");
  const Image backdrop = StudioBackdrop(truth.camera.width, truth.camera.height);
  MeshStyle style;
  style.colour = kReferenceColour;
  VideoWriter writer(path, backdrop.width, backdrop.height, VideoFrameRate(truth.motion.timestamps));
  for (int t = 0; t < truth.num_frames(); ++t) {
    callbacks.Update("clip", static_cast<double>(t) / truth.num_frames());
    Image image = backdrop;
    MatrixX3d vertices = TrackVertices(body, truth, t);
    if (truth.HasMovingCamera()) vertices = MovedPoints(truth.camera_from_scene[size_t(t)], vertices);
    DrawMesh(vertices, body.data().faces, truth.CameraAt(t), style, &image);
    writer.Write(image);
  }
  writer.Finish();
}

SynthClipFiles FilesOf(const SynthesizeClipRequest& request) {
  const std::filesystem::path folder = request.out;
  SynthClipFiles files;
  files.observations = (folder / "observations.npz").string();
  files.truth = (folder / "truth.npz").string();
  files.camera = (folder / "camera.json").string();
  if (request.clip.camera_path.motion != SynthCameraMotion::kStill) {
    files.camera_path = (folder / "camera_path.json").string();
  }
  if (request.clip.initialiser_error_px > 0) {
    files.initialiser = (folder / "initialiser.npz").string();
  }
  if (request.video) {
    files.video = (folder / "clip.mp4").string();
  }
  return files;
}

}  // namespace

void UseRealisticFaults(SynthClipOptions* options) {
  options->dense.uv_sigma = 0.02;
  options->dense.quantise_uv = true;
  options->dense.outlier_probability = 0.05;
  options->dense.missing_part_share = 0.05;
}

SynthesizeClipReport SynthesizeClip(const SynthesizeClipRequest& request, const PipelineCallbacks& callbacks) {
  if (request.motion.name != "demo") {
    RequireReadable(request.motion.name, "motion");
  }
  RequireReadableBody(request.body);
  RequireWritableFolder(request.out);
  const std::shared_ptr<const BodyModel> body = BodyOrBuiltin(request.body);
  const Motion motion = LoadMotionSource(request.motion, *body, callbacks);
  callbacks.Update("observe", 0);
  SynthClipOptions options = request.clip;
  if (request.realistic) {
    UseRealisticFaults(&options);
  }
  SynthesizeClipReport report;
  report.files = FilesOf(request);
  report.clip = MakeSynthClip(*body, motion, options);
  callbacks.Update("write", 0);
  const SynthClip& clip = report.clip;
  const SynthClipFiles& files = report.files;
  WriteObservations(files.observations, options.keypoints ? &clip.keypoints : nullptr,
                    options.dense_per_frame > 0 ? &clip.dense : nullptr);
  WriteTrack(files.truth, clip.truth);
  NamedCamera camera;
  camera.name = "synth";
  camera.camera = clip.truth.camera;
  camera.pose = clip.camera_from_world;
  WriteCameras(files.camera, {camera});
  if (!files.camera_path.empty()) {
    WriteCameraPath(files.camera_path, {clip.truth.motion.timestamps, clip.truth.camera_from_scene});
  }
  if (!files.initialiser.empty()) {
    WriteTrack(files.initialiser, InitialiserTrack(clip));
  }
  if (!files.video.empty()) {
    RenderClip(files.video, *body, clip.truth, callbacks);
  }
  return report;
}

std::string ToText(const SynthesizeClipReport& report) {
  const SynthClip& clip = report.clip;
  const SynthFaultCounts& counts = clip.counts;
  std::ostringstream text;
  text << clip.truth.num_frames() << " frames of " << clip.truth.camera.width << "x" << clip.truth.camera.height << ", "
       << counts.frames_dropped << " without observations\n"
       << "2D joints        " << counts.keypoints << ", " << counts.keypoints_hidden << " hidden by the body\n"
       << "dense keypoints  " << counts.dense << ", " << counts.dense_outliers << " outliers, " << counts.dense_missing
       << " lost with missing parts\n";
  if (clip.initialiser.num_frames() > 0) {
    text << "initialiser      wrong by " << clip.initialiser_error_px << " px at 512\n";
  }
  const SynthClipFiles& files = report.files;
  for (const std::string& path :
       {files.observations, files.truth, files.camera, files.camera_path, files.initialiser, files.video}) {
    if (!path.empty()) {
      text << "wrote            " << path << "\n";
    }
  }
  return text.str();
}

}  // namespace bodyloom
