// SPDX-License-Identifier: Apache-2.0
#include "apps/track_options.h"

#include <CLI/CLI.hpp>
#include <cstdio>

#include "apps/detector_options.h"
#include "apps/usage_error.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

/// All but those of the videos and their views.
void AddOtherRunOptions(CLI::App& app, TrackPeopleClipRequest* request) {
  TrackSettings& track = request->track;
  app.add_option("--people", request->max_people, "at most so many: the largest and longest in view (0: everybody)")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  app.add_option("--person", request->person, "only this one: 0 is the largest and longest in view")
      ->check(CLI::NonNegativeNumber);
  app.add_option("--min-seconds", request->min_seconds, "whoever is seen for less is left out")
      ->capture_default_str()
      ->check(CLI::NonNegativeNumber);
  app.add_option("--fps", track.fps, "frame rate of a folder of images (default 30)")->check(CLI::PositiveNumber);
  app.add_option("--min-confidence", track.min_confidence, "landmarks below (0 to 1) count as missing")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app.add_flag("--masks", request->masks, "write each person's mask too: mask_0.npz, mask_1.npz ...");
  app.add_flag(
      "--coarse-masks", request->coarse_masks,
      "masks as the network gives them: do not cut them from what stands behind people when the camera is still");
  app.add_flag("--side-view", request->side_view, "the overlay also shows everybody from their side");
  AddDetectionOptions(app, &track, "auto, if --body has fingers or is not given", "Detection");
  AddCalibrationOptions(app, &track);
  AddCameraPathOptions(app, &track);
  AddLearnedOptions(app, &track);
  AddSolveOptions(app, &track);
}

constexpr const char *kSeen = "What was seen", *kCamera = "The camera", *kKnown = "What else is known",
                     *kWanted = "Results", *kSolve = "The solve";

constexpr const char* kDetectionsHelp =
    "2D joints of a detector: a folder of OpenPose or MMPose JSON files, a COCO, AlphaPose, MMPose or MediaPipe JSON, "
    "an AIST++ keypoints2d pickle, FreeMoCap's 2D .npy, or this project's .npz";

/// A validator whose range is described in the option's own words.
CLI::Validator Quiet(CLI::Validator validator) {
  validator.description("");
  return validator;
}

/// "1920x1080" into two numbers.
void AddImageSize(CLI::App& app, TrackRequest* request) {
  app.add_option_function<std::string>(
         "--image-size",
         [request](const std::string& text) {
           char cross = 0, rest = 0;
           const int n =
               std::sscanf(text.c_str(), "%d%c%d%c", &request->image_width, &cross, &request->image_height, &rest);
           if (n != 3 || cross != 'x' || request->image_width <= 0 || request->image_height <= 0) {
             throw CLI::ValidationError("--image-size", "'" + text + "', expected WIDTHxHEIGHT as in 1920x1080");
           }
         },
         "pixels, when neither --cameras nor --video says")
      ->type_name("WxH");
}

}  // namespace

void AddDetectionOptions(CLI::App& app, TrackSettings* request, const std::string& hands, const std::string& detect) {
  TrackSettings& c = *request;
  AddDetectorOptions(app, &c.detector, &c.detect_rate, detect);
  AddHandsOption(app, &c.detector.hands_and_faces, hands, detect);
  AddPlaybackOptions(app, &c.turn_deg, &c.captured_fps, detect);
  app.add_flag_callback(
         "--no-mask", [&c] { c.use_mask = false; }, "do not use the person's mask")
      ->group(detect);
  app.add_option("--from", c.from_s, "begin at this second of the video, or of the detections")
      ->group(detect)
      ->check(Quiet(CLI::NonNegativeNumber));
  app.add_option("--to", c.to_s, "end with this second (default: the end)")
      ->group(detect)
      ->check(Quiet(CLI::NonNegativeNumber));
}

void AddCalibrationOptions(CLI::App& app, TrackSettings* request) {
  TrackSettings& c = *request;
  app.add_option("--cameras", c.cameras,
                 "calibration: an AIST++ camera folder or setting, a Pose2Sim Calib.toml or calib_refined.json, a "
                 "rig.json, or this "
                 "project's JSON")
      ->group(kCamera)
      ->type_name("FILE");
  app.add_option(
         "--focal-35mm", c.focal_35mm_mm,
         "focal length of the lens for film of 36 mm x 24 mm, near which the camera's is looked for (default: what "
         "the video or photo notes)")
      ->group(kCamera)
      ->check(Quiet(CLI::PositiveNumber));
  app.add_option("--focal", c.focal_px, "focal length in pixels, for a centred camera without distortion")
      ->group(kCamera)
      ->check(Quiet(CLI::PositiveNumber));
}

void AddCameraPathOptions(CLI::App& app, TrackSettings* request) {
  TrackSettings& c = *request;
  app.add_option(
         "--camera-path", c.camera_path,
         "where a camera that moves was: COLMAP's folder or images.txt/.bin (its intrinsics are used where none "
         "are given), or this project's JSON (default: it stands still); of several views a file each, with {view} in "
         "the name, as paths/{view}.json")
      ->group(kCamera)
      ->type_name("PATH");
  app.add_flag_callback(
         "--still", [&c] { c.find_camera_motion = false; },
         "the camera stands still: do not look for its motion in the video")
      ->group(kCamera);
  app.add_option("--camera-path-out", c.camera_path_out,
                 "the camera's path as it was found in the video: JSON, or COLMAP's images.txt with "
                 "cameras.txt and points3D.txt beside it")
      ->group(kCamera)
      ->type_name("FILE");
  app.add_option("--camera-scale", c.camera_scale_m,
                 "metres a unit of the path (default: 1 for JSON in metres, else found from standing feet)")
      ->group(kCamera)
      ->type_name("M")
      ->check(Quiet(CLI::PositiveNumber));
  app.add_option("--camera-path-first", c.camera_path_first,
                 "number that the clip's first frame has in the path (default: 0, or 1 when COLMAP's begin later)")
      ->group(kCamera)
      ->type_name("N")
      ->check(Quiet(CLI::NonNegativeNumber));
  app.add_option("--camera-path-fps", c.camera_path_fps,
                 "images a second that the path's frames number (default: they are the clip's frames)")
      ->group(kCamera)
      ->check(Quiet(CLI::PositiveNumber));
}

void AddLearnedOptions(CLI::App& app, TrackSettings* request) {
  TrackSettings& c = *request;
  app.add_option("--body", c.body, BodyHelp("body model: SMPL, SMPL-H or SMPL-X .pkl or .npz"))
      ->group(kKnown)
      ->type_name("FILE");
  app.add_option("--stature", c.stature_m,
                 "the person's height in metres, from which distances follow (default: average)")
      ->group(kKnown)
      ->check(Quiet(CLI::Range(0.5, 2.5)));
  app.add_option("--prior", c.prior, "pose prior file, or none (default: the built-in one)")
      ->group(kKnown)
      ->type_name("FILE");

  app.add_option("--lifter", c.lifter, "weights of the network that starts from 2D joints, or none (default: built in)")
      ->group(kKnown)
      ->type_name("FILE");
}

void AddSolveOptions(CLI::App& app, TrackSettings* request) {
  TrackSequenceOptions& s = request->solve;
  app.add_option_function<std::string>(
         "--solver", [&s](const std::string& word) { s.solver = SequenceSolverFromString(word); },
         "the engine: chain+ceres (chain to near the minimum, Ceres from there), chain alone, or ceres in all stages "
         "(about three times slower)")
      ->group(kSolve)
      ->default_str(ToString(s.solver))
      ->check(CLI::IsMember({"chain+ceres", "ceres", "chain"}));
  app.add_option("--threads", s.num_threads, "at most 256; 0: all cores; the same bytes for any number")
      ->group(kSolve)
      ->check(Quiet(CLI::Range(0, 256)))
      ->capture_default_str();
  app.add_option("--max-iterations", s.max_iterations, "of each stage")
      ->group(kSolve)
      ->check(Quiet(CLI::PositiveNumber))
      ->capture_default_str();
  app.add_flag_callback(
         "--no-ground", [&s] { s.ground = GroundOptions::Off(); },
         "look for neither the vertical nor the ground that feet stand on")
      ->group(kSolve);
  app.add_flag_callback(
         "--no-contacts", [&s] { s.ground.surface_weight = 0; },
         "let the surface be below the ground or hover above it")
      ->group(kSolve);
  app.add_flag_callback(
         "--no-held-contacts", [&s] { s.ground.hold_weight = 0; }, "let soles that rest on the ground slide on it")
      ->group(kSolve);
  app.add_flag_callback(
         "--no-balance", [&s] { s.ground.balance_weight = 0; },
         "let the centre of mass be anywhere above what touches the ground")
      ->group(kSolve);
  app.add_flag_callback(
         "--no-lines", [request] { request->use_lines = false; },
         "do not look for the vertical and the focal length in the video's straight lines")
      ->group(kSolve);
  app.add_option("--rendered-weight", s.rendered_uv.weight,
                 "of dense keypoints whose noise lies in UV, compared in UV with the rendered body (lambda_r of the "
                 "motion paper); 0: reprojection alone")
      ->group(kSolve)
      ->type_name("W")
      ->check(Quiet(CLI::Range(0.0, 1e6)))
      ->capture_default_str();
  app.add_option("--velocity-weight", s.velocity_weight,
                 "of velocities, (m/s)^-2, beside accelerations (lambda_t of the motion paper); it damps motion")
      ->group(kSolve)
      ->type_name("W")
      ->check(Quiet(CLI::Range(0.0, 1e6)))
      ->capture_default_str();
  app.add_option(
         "--straight-knees", request->straight_knees,
         Concatenate("how strongly knees are kept straight, 1/rad, 0: not at all (default: ", kBlazePoseStraightKnees,
                     " for BlazePose's joints, which every raw video has, else ", kStraightKnees, ")"))
      ->group(kSolve)
      ->type_name("W")
      ->check(Quiet(CLI::Range(0.0, 100.0)));
  app.add_flag_callback(
         "--no-shape", [&s] { s.estimate_shape = false; }, "keep the body's mean shape")
      ->group(kSolve);
  app.add_flag_callback(
         "--no-uncertainty", [&s] { s.estimate_uncertainty = false; }, "leave out joint_sigma")
      ->group(kSolve);
  app.add_flag_callback(
         "--no-skip", [&s] { s.skip_unneeded = false; },
         "solve also for joints that no landmark moves: nearly the same answer, slower")
      ->group(kSolve);
}

namespace {

/// All but those of the detections' files and their views.
void AddOtherTrackOptions(CLI::App& app, TrackRequest* request, bool* quiet) {
  TrackRequest& c = *request;
  app.add_option("--dense", c.dense,
                 "dense surface keypoints: a folder of DensePose *_IUV.png (one a frame), or this project's .npz")
      ->group(kSeen)
      ->type_name("FILE");
  app.add_option("--dense-uv-sigma", c.dense_uv_sigma,
                 "noise of the dense keypoints' U and V, standard deviation in chart units, 0: not known, which leaves "
                 "out whitening and rendered UV (default: what the .npz says; 0.03 for DensePose images)")
      ->group(kSeen)
      ->check(Quiet(CLI::Range(0.0, 1.0)));
  app.add_option(
         "--part-labels", c.part_labels,
         "DensePose part of every pixel: .npz with uint8 `labels`, frames x height x width; alone or beside the "
         "others")
      ->group(kSeen)
      ->type_name("FILE");
  app.add_option("--person", c.person, "which person when there are several: 0 is the largest and longest in view")
      ->group(kSeen)
      ->check(Quiet(CLI::NonNegativeNumber))
      ->capture_default_str();
  app.add_option("--fps", c.fps, "frame rate of detections that do not say (default: the video's, else 30)")
      ->group(kSeen)
      ->check(Quiet(CLI::PositiveNumber));
  app.add_option("--min-confidence", c.min_confidence, "detections below (0 to 1) count as missing")
      ->group(kSeen)
      ->check(Quiet(CLI::Range(0.0, 1.0)))
      ->capture_default_str();
  app.add_option("--convention", c.convention,
                 "landmark order of OpenPose files, arrays and VideoPose3D when it is not recognised")
      ->group(kSeen)
      ->check(CLI::IsMember({"body25", "body25b", "openpose_coco18", "coco17", "coco_wholebody23", "halpe26",
                             "mediapipe33", "human36m17"}));

  AddDetectionOptions(app, request, "auto with a body that has fingers, else off",
                      "Detection (without the above, people are detected in --video)");
  AddCalibrationOptions(app, request);
  AddCameraPathOptions(app, request);
  app.add_option("--camera", c.camera,
                 "pinhole: intrinsics from --cameras or --focal; unknown-focal: the focal length is estimated; weak: "
                 "weak perspective (default: pinhole when intrinsics are given, else unknown-focal)")
      ->group(kCamera)
      ->check(CLI::IsMember({"pinhole", "unknown-focal", "weak"}));
  AddImageSize(app, request);
  app.get_option("--image-size")->group(kCamera);

  app.add_option("--video", c.video,
                 "the video (or a folder of images), for image size, frame rate and the overlay; alone, people are "
                 "detected in it")
      ->group(kKnown)
      ->type_name("FILE");
  app.add_option("--video-offset", c.video_offset, "video frame that belongs to the detections' frame number 0")
      ->group(kKnown)
      ->capture_default_str();
  app.add_option("--init", c.init,
                 "poses of another system to start from and stay near: wham_output.pkl, vibe_output.pkl, PHALP's, "
                 "4D-Humans' or PromptHMR's .pkl, GVHMR's, GEM's or GEM-X's .pt, SAM 3D Body's .npz or .json (or a "
                 "folder of them), "
                 "SAM3DBody-cpp's .csv, or a track .npz")
      ->group(kKnown)
      ->type_name("FILE");
  AddLearnedOptions(app, request);
  app.add_option("--out", c.out, "the track, .npz (required unless --plan)")->group(kWanted)->type_name("FILE");
  app.add_option("--overlay", c.overlay, "video with the projected body, .mp4")->group(kWanted)->type_name("FILE");
  app.add_flag("--side-view", c.side_view, "the overlay also shows the body from its side, where depth errors show")
      ->group(kWanted);
  app.add_option("--reference", c.reference, "a known true track, drawn beside the estimate in the side view")
      ->group(kWanted)
      ->type_name("FILE");
  app.add_option("--json", c.json, "the closing summary as JSON")->group(kWanted)->type_name("FILE");
  app.add_option("--report", c.report, "one page: video, body in 3D and a timeline (.html)")
      ->group(kWanted)
      ->type_name("FILE");
  app.add_flag("--plan", c.plan, "print what would run, what is skipped and why; compute and write nothing")
      ->group(kWanted);
  app.add_flag("--quiet", *quiet, "no progress and no summary on the screen")->group(kWanted);

  AddSolveOptions(app, request);
  app.add_option("--init-weight", c.solve.initialiser_weight, "how strongly the track stays near --init")
      ->group(kSolve)
      ->check(Quiet(CLI::NonNegativeNumber))
      ->capture_default_str();
  app.add_option("--live", c.live_lag,
                 "track frame by frame as if the clip came from a camera: each pose is final when this many frames "
                 "after it have been seen (4 is a good number), and nothing later changes it")
      ->group(kSolve)
      ->type_name("LAG")
      ->check(Quiet(CLI::Range(0, 60)));
}

}  // namespace

void AddTrackOptions(CLI::App& app, TrackRequest* request, bool* quiet) {
  app.add_option("--detections", request->detections, kDetectionsHelp)->group(kSeen)->type_name("FILE");
  app.add_option("--view", request->view, "camera of a file that holds several, as c01")
      ->group(kSeen)
      ->type_name("NAME");
  AddOtherTrackOptions(app, request, quiet);
}

void AddKnownOfRigOptions(CLI::App& app, KnownOfRig* known, bool* same_lens, const std::string& group) {
  app.add_option_function<std::string>(
         "--known", [known](const std::string& word) { *known = KnownOfRigFromString(word); },
         "several views: how much of --cameras to use: intrinsics, also poses, also the clocks of a rig.json; the rest "
         "is estimated")
      ->group(group)
      ->default_str(ToString(*known))
      ->check(CLI::IsMember({"intrinsics", "poses", "clocks"}));
  app.add_flag("--same-lens", *same_lens,
               "several views: the cameras are of one kind and not zoomed, so that their focal lengths are alike")
      ->group(group);
}

void AddTrackViewsOptions(CLI::App& app, TrackViewsRequest* request, bool* quiet) {
  app.add_option("--detections", request->view_detections,
                 std::string(kDetectionsHelp) + "; several times for several cameras, the track's first")
      ->group(kSeen)
      ->type_name("FILE")
      ->allow_extra_args(false);
  app.add_option("--view", request->views,
                 "camera of a file that holds several, as c01; several, as c01,c03, are tracked together")
      ->group(kSeen)
      ->type_name("NAME,...")
      ->allow_extra_args(false)
      ->delimiter(',');
  AddOtherTrackOptions(app, request, quiet);
  AddKnownOfRigOptions(app, &request->known, &request->same_lens, kCamera);
  app.add_option("--rig-out", request->rig_out,
                 "several views: their cameras and clocks (default: rig.json beside --out)")
      ->group(kWanted)
      ->type_name("FILE");
}

void AddRunOptions(CLI::App& app, TrackPeopleClipRequest* request) {
  TrackSettings& track = request->track;
  app.add_option("VIDEO,--video", track.video, "the video, or a folder of images")->required()->type_name("PATH");
  app.add_option("--view", track.view, "camera of a calibration that holds several")->type_name("NAME");
  AddOtherRunOptions(app, request);
}

void AddRunVideosOptions(CLI::App& app, TrackPeopleInVideosRequest* request) {
  app.add_option("VIDEO,--video", request->videos,
                 "the video, or a folder of images; several of cameras that filmed the same people and stood still: "
                 "the tracks are in the first one's frame and time")
      ->required()
      ->type_name("PATH ...");
  app.add_option("--view", request->views,
                 "camera of a calibration that holds several; with several videos a name for each, as left,right")
      ->type_name("NAME,...")
      ->allow_extra_args(false)
      ->delimiter(',');
  AddKnownOfRigOptions(app, &request->known, &request->same_lens, "Options");
  AddOtherRunOptions(app, request);
}

}  // namespace bodyloom
