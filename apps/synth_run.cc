// SPDX-License-Identifier: Apache-2.0
#include "apps/synth_run.h"

#include <CLI/CLI.hpp>
#include <filesystem>

#include "apps/interrupt.h"
#include "apps/motion_input.h"
#include "apps/progress.h"
#include "apps/track_video.h"
#include "bodyloom/data_tools/body/body_or_builtin.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/data_tools/observations/load_cameras.h"
#include "bodyloom/data_tools/observations/observations_npz.h"
#include "bodyloom/data_tools/video/video_writer.h"
#include "bodyloom/pipelines/files.h"
#include "bodyloom/render/overlay.h"
#include "bodyloom/render/palette.h"
#include "bodyloom/render/shaded_mesh.h"

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
void RenderClip(const std::string& path, const BodyModel& body, const Track& truth, bool quiet) {
  Progress progress("rendering " + std::to_string(truth.num_frames()) + " frames",
                    quiet ? Progress::Style::kSilent : Progress::DefaultStyle());
  const Image backdrop = StudioBackdrop(truth.camera.width, truth.camera.height);
  MeshStyle style;
  style.colour = kReferenceColour;
  VideoWriter writer(path, backdrop.width, backdrop.height, VideoFrameRate(truth.motion.timestamps));
  for (int t = 0; t < truth.num_frames(); ++t) {
    ThrowIfInterrupted();
    progress.Update("clip", static_cast<double>(t) / truth.num_frames());
    Image picture = backdrop;
    DrawMesh(TrackVertices(body, truth, t), body.data().faces, truth.CameraAt(t), style, &picture);
    writer.Write(picture);
  }
  writer.Finish();
}

}  // namespace

void UseRealisticFaults(SynthClipOptions* options) {
  options->dense.uv_sigma = 0.02;
  options->dense.quantise_uv = true;
  options->dense.outlier_probability = 0.05;
  options->dense.missing_part_share = 0.05;
}

void AddSynthOptions(CLI::App& app, SynthCommand* command) {
  SynthCommand& c = *command;
  SynthClipOptions& clip = c.clip;
  const std::string what = "What", camera = "The camera", dense = "Dense keypoints", joints = "2D joints",
                    other = "Other faults";
  app.add_option("--motion", c.motion, kMotionInputHelp)->required()->group(what);
  app.add_option("--body", c.body, "body model (default: the built-in body)")->group(what)->type_name("FILE");
  app.add_option("--out", c.out, "folder for observations.npz, truth.npz, camera.json")
      ->required()
      ->group(what)
      ->type_name("DIR");
  app.add_option("--fps", c.fps, "resample the motion to this rate")->group(what);
  app.add_option("--first", c.first_frame, "first frame that is used")->group(what)->capture_default_str();
  app.add_option("--frames", c.num_frames, "how many frames (0: all)")->group(what)->capture_default_str();
  app.add_option("--seed", clip.seed, "same seed, same files")->group(what)->capture_default_str();
  app.add_option("--threads", clip.num_threads, "0: all cores")->group(what)->capture_default_str();
  app.add_flag("--video", c.video, "also render the clip: clip.mp4")->group(what);
  app.add_flag("--quiet", c.quiet, "no words on the screen")->group(what);

  app.add_option_function<std::string>(
         "--camera", [&clip](const std::string& name) { clip.camera.model = CameraModelFromString(name); },
         "pinhole or weak")
      ->group(camera)
      ->check(CLI::IsMember({"pinhole", "weak"}))
      ->default_str("pinhole");
  app.add_option("--width", clip.camera.width, "pixels")->group(camera)->capture_default_str();
  app.add_option("--height", clip.camera.height, "pixels")->group(camera)->capture_default_str();
  app.add_option("--focal", clip.camera.focal_px, "pixels (0: 1.1 times the longer side)")
      ->group(camera)
      ->capture_default_str();
  app.add_option("--yaw", clip.camera.yaw_deg, "degrees about the vertical; 0 sees the front")
      ->group(camera)
      ->capture_default_str();
  app.add_option("--elevation", clip.camera.elevation_deg, "degrees from above")->group(camera)->capture_default_str();

  app.add_option("--dense", clip.dense_per_frame, "dense keypoints a frame (0: none)")
      ->group(dense)
      ->capture_default_str();
  app.add_flag("--realistic", c.realistic,
               "faults as real dense detectors have them: --uv-noise 0.02 --quantise --outliers 0.05 "
               "--missing-parts 0.05")
      ->group(dense);
  app.add_option("--pixel-noise", clip.dense.pixel_sigma_px, "standard deviation, pixels")
      ->group(dense)
      ->capture_default_str();
  app.add_option("--uv-noise", clip.dense.uv_sigma, "standard deviation, chart units")
      ->group(dense)
      ->capture_default_str();
  app.add_flag("--quantise", clip.dense.quantise_uv, "UV in 8 bits, rounded down")->group(dense);
  app.add_option("--outliers", clip.dense.outlier_probability, "share that lie anywhere")
      ->group(dense)
      ->capture_default_str();
  app.add_option("--missing-parts", clip.dense.missing_part_share, "share of the time that each part is missing")
      ->group(dense)
      ->capture_default_str();

  app.add_flag_callback(
         "--no-joints", [&clip] { clip.keypoints = false; }, "leave them out")
      ->group(joints);
  app.add_option("--joint-noise", clip.detection.noise, "1: like a detector's; 0: exact")
      ->group(joints)
      ->capture_default_str();
  app.add_option("--dropouts", clip.detection.dropout_probability, "share of landmarks that are missing")
      ->group(joints)
      ->capture_default_str();
  app.add_option("--swaps", clip.detection.swap_probability, "share of frames with left and right exchanged, a pair")
      ->group(joints)
      ->capture_default_str();
  app.add_option("--dropped-frames", clip.dropped_frame_share, "share of frames in which nothing is seen")
      ->group(other)
      ->capture_default_str();
  app.add_option("--init-error", clip.initialiser_error_px,
                 "also write initialiser.npz, wrong by this mean projection error, pixels at 512 (0: none)")
      ->group(other)
      ->capture_default_str();
}

SynthFiles SynthFilesIn(const SynthCommand& command) {
  const std::filesystem::path folder = command.out;
  SynthFiles files;
  files.observations = (folder / "observations.npz").string();
  files.truth = (folder / "truth.npz").string();
  files.camera = (folder / "camera.json").string();
  if (command.clip.initialiser_error_px > 0) {
    files.initialiser = (folder / "initialiser.npz").string();
  }
  if (command.video) {
    files.video = (folder / "clip.mp4").string();
  }
  return files;
}

SynthClip RunSynth(const SynthCommand& command) {
  if (command.motion != "demo") {
    RequireReadable(command.motion, "motion");
  }
  RequireReadable(command.body, "body model");
  RequireWritableFolder(command.out);
  const std::shared_ptr<const BodyModel> body = BodyOrBuiltin(command.body);
  const Motion motion = LoadMotionInput({command.motion, command.fps, command.first_frame, command.num_frames}, *body);
  ThrowIfInterrupted();
  SynthClipOptions options = command.clip;
  if (command.realistic) {
    UseRealisticFaults(&options);
  }
  SynthClip clip = MakeSynthClip(*body, motion, options);
  ThrowIfInterrupted();
  const SynthFiles files = SynthFilesIn(command);
  WriteObservations(files.observations, options.keypoints ? &clip.keypoints : nullptr,
                    options.dense_per_frame > 0 ? &clip.dense : nullptr);
  WriteTrack(files.truth, clip.truth);
  NamedCamera camera;
  camera.name = "synth";
  camera.camera = clip.truth.camera;
  camera.pose = clip.camera_from_world;
  WriteCameras(files.camera, {camera});
  if (!files.initialiser.empty()) {
    WriteTrack(files.initialiser, InitialiserTrack(clip));
  }
  if (!files.video.empty()) {
    RenderClip(files.video, *body, clip.truth, command.quiet);
  }
  return clip;
}

}  // namespace bodyloom
