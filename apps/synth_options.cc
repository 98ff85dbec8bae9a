// SPDX-License-Identifier: Apache-2.0
#include "apps/synth_options.h"
#include "apps/usage_error.h"

#include <CLI/CLI.hpp>
#include <string>

namespace bodyloom {

void AddSynthOptions(CLI::App& app, SynthesizeClipRequest* request, bool* quiet) {
  SynthesizeClipRequest& c = *request;
  SynthClipOptions& clip = c.clip;
  const std::string what = "What", camera = "The camera", dense = "Dense keypoints", joints = "2D joints",
                    other = "Other faults";
  app.add_option("--motion", c.motion.name, kMotionHelp)->required()->group(what);
  app.add_option("--body", c.body, BodyHelp("body model"))->group(what)->type_name("FILE");
  app.add_option("--out", c.out, "folder for observations.npz, truth.npz, camera.json")
      ->required()
      ->group(what)
      ->type_name("DIR");
  app.add_option("--fps", c.motion.fps, "resample the motion to this rate")->group(what);
  app.add_option("--first", c.motion.first_frame, "first frame that is used")->group(what)->capture_default_str();
  app.add_option("--frames", c.motion.num_frames, "how many frames (0: all)")->group(what)->capture_default_str();
  app.add_option("--seed", clip.seed, "same seed, same files")->group(what)->capture_default_str();
  app.add_option("--threads", clip.num_threads, "0: all cores")->group(what)->capture_default_str();
  app.add_flag("--video", c.video, "also render the clip: clip.mp4")->group(what);
  app.add_flag("--quiet", *quiet, "no words on the screen")->group(what);

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

  app.add_option_function<std::string>(
         "--camera-motion",
         [&clip](const std::string& name) { clip.camera_path.motion = SynthCameraMotionFromString(name); },
         "still, hand-held, walking (along with the person) or orbit; also writes camera_path.json")
      ->group(camera)
      ->check(CLI::IsMember({"still", "hand-held", "walking", "orbit"}))
      ->default_str("still");
  app.add_option("--shake", clip.camera_path.shake_deg, "of a camera that moves, degrees")
      ->group(camera)
      ->capture_default_str();
  app.add_option("--shake-m", clip.camera_path.shake_m, "of its place, metres")->group(camera)->capture_default_str();
  app.add_option("--orbit", clip.camera_path.orbit_deg, "degrees that --camera-motion orbit goes round")
      ->group(camera)
      ->capture_default_str();

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

}  // namespace bodyloom
