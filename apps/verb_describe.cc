// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/exit_code.h"
#include "apps/interrupt.h"
#include "apps/progress.h"
#include "apps/summary.h"
#include "apps/verbs.h"
#include "bodyloom/data_tools/body/body_or_builtin.h"
#include "bodyloom/data_tools/descriptors/describe_track.h"
#include "bodyloom/data_tools/descriptors/descriptor_header.h"
#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/data_tools/observations/load_cameras.h"
#include "bodyloom/data_tools/video/image_file.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/stopwatch.h"
#include "bodyloom/pipelines/files.h"

namespace bodyloom {
namespace {

constexpr const char* kFooter =
    "OUT.npy holds frames x channels x height x width: the normal (3) and the velocities of this and the past frames "
    "(3\n"
    "each, m/s), as maps over the body's UV atlas. numpy.load(OUT, mmap_mode='r') opens it; OUT.json beside it names "
    "the\n"
    "channels, units and frames. Frames without a fit are zero and listed there.\n"
    "--frame:  camera  as the camera sees the motion\n"
    "          world   with the camera's pose from --cameras; without it, a level camera: y up, z towards the camera\n"
    "          body    turned with the pelvis, its own motion taken out\n"
    "Examples:\n"
    "  bodyloom describe --track track.npz --out motion.npy --preview motion.png\n"
    "  bodyloom describe --track track.npz --out motion.npy --velocity backward --dtype f16 --threads 2\n\n";

struct DescribeCommand {
  std::string track, out, body, preview, json, cameras, view;
  std::string velocity = "savgol", frame = "camera", dtype = "f32", channels = "all", weighting = "area";
  int size = 128;
  DescribeTrackOptions options;
};

/// A level camera: the world's y is up and its z points at the camera.
CameraPose LevelCamera() {
  CameraPose pose;
  pose.camera_from_world_rotation = Eigen::Vector3d(1, -1, -1).asDiagonal();
  return pose;
}

DescribeTrackOptions OptionsOf(const DescribeCommand& command) {
  DescribeTrackOptions options = command.options;
  options.texels.width = options.texels.height = command.size;
  options.analytic = command.velocity == "analytic";
  options.velocity.scheme = command.velocity == "backward"  ? VelocityScheme::kBackward
                            : command.velocity == "central" ? VelocityScheme::kCentral
                                                            : VelocityScheme::kSavitzkyGolay;
  options.frame = command.frame == "world"  ? SurfaceFrame::kWorld
                  : command.frame == "body" ? SurfaceFrame::kBody
                                            : SurfaceFrame::kCamera;
  options.weighting = command.weighting == "angle" ? NormalWeighting::kAngle : NormalWeighting::kArea;
  options.half = command.dtype == "f16";
  options.normals = command.channels != "velocity";
  if (command.channels == "normal") options.past = 0;
  options.preview_frames = command.preview.empty() ? 0 : 6;
  if (options.frame == SurfaceFrame::kWorld) {
    options.camera_pose = command.cameras.empty()
                              ? LevelCamera()
                              : FindCamera(LoadCameras(command.cameras), command.view, command.cameras).pose;
  } else if (!command.cameras.empty()) {
    throw RequestError("--cameras is for --frame world");
  }
  std::string why;
  if (!options.IsValid(&why)) throw RequestError(why);
  return options;
}

std::string Text(const DescribeTrackSummary& s, const DescribeCommand& command, double seconds) {
  char line[256];
  std::snprintf(line, sizeof line, "%d frames x %d channels x %d x %d, %s, velocities %s in the %s frame\n", s.frames,
                s.channels, s.texels.height, s.texels.width, command.dtype == "f16" ? "float16" : "float32",
                command.velocity.c_str(), command.frame.c_str());
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
  if (command.options.seen_only) {
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
  std::snprintf(line, sizeof line, "memory   %.0f MiB at most\n", static_cast<double>(PeakMemoryBytes()) / (1 << 20));
  return text + line;
}

std::string Json(const DescribeTrackSummary& s, const DescribeCommand& command, double seconds) {
  nlohmann::ordered_json stages = nlohmann::ordered_json::object();
  for (const auto& [stage, stage_seconds] : s.seconds) stages[stage] = stage_seconds;
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
                                       {"peak_memory_bytes", PeakMemoryBytes()},
                                       {"outputs", {command.out, DescriptorHeaderPath(command.out)}}};
  return json.dump(1) + "\n";
}

void RunDescribe(const DescribeCommand& command) {
  const StageClock clock;
  if (!command.out.ends_with(".npy"))
    throw RequestError("--out " + command.out + ": expected a name that ends in .npy");
  const std::string header = DescriptorHeaderPath(command.out);
  const DescribeTrackOptions options = OptionsOf(command);
  RequireReadable(command.track, "track");
  RequireReadable(command.body, "body model");
  RequireDistinct({command.track, command.body, command.cameras}, {command.out, header, command.preview, command.json});
  for (const std::string& path : {command.out, header, command.preview, command.json}) RequireWritable(path);
  const Track track = ReadTrack(command.track);
  const std::shared_ptr<const BodyModel> body = BodyOrBuiltin(command.body);
  if (!body->has_uv()) {
    throw std::runtime_error(
        (command.body.empty() ? body->name() : command.body) +
        ": a body without UV coordinates, expected vt and ft (bodyloom body convert --uv adds them)");
  }
  if (track.motion.poses.cols() > 3 * body->num_joints()) {
    throw std::runtime_error(Concatenate(command.track, ": ", track.motion.poses.cols() / 3, " joints, the body '",
                                         body->name(), "' has ", body->num_joints(),
                                         "; give the track's own with --body"));
  }
  DescribeTrackSummary summary;
  {
    Progress progress("describe");
    try {
      summary = DescribeTrack(*body, track, command.out, options, [&](double fraction) {
        ThrowIfInterrupted();
        progress.Update("describing", fraction);
      });
    } catch (const std::invalid_argument& error) {  // what the files hold does not fit together
      throw std::runtime_error(command.track + ": " + error.what());
    }
  }
  if (!command.preview.empty()) WriteImage(command.preview, summary.preview);
  const double seconds = clock.total();
  if (!command.json.empty()) WriteFileAtomically(command.json, Json(summary, command, seconds));
  std::cout << Text(summary, command, seconds) << "wrote    " << command.out << "\n";
}

}  // namespace

void AddDescribeVerb(CLI::App& app, Action* action) {
  CLI::App* verb =
      app.add_subcommand("describe", "Exports a track's surface motion as UV maps: normals and velocities");
  verb->footer(std::string(kFooter) + kExitCodeHelp);
  auto command = std::make_shared<DescribeCommand>();
  DescribeCommand& c = *command;
  verb->add_option("--track", c.track, "the track, .npz")->required()->type_name("FILE");
  verb->add_option("--out", c.out, "where to write the maps, .npy (and .json beside it)")
      ->required()
      ->type_name("FILE");
  verb->add_option("--body", c.body, "the track's body (default: the built-in body)")->type_name("FILE");
  verb->add_option("--size", c.size, "texels a side")->capture_default_str()->check(CLI::Range(1, 16384));
  verb->add_option("--past", c.options.past, "velocity maps a frame, its own included")
      ->capture_default_str()
      ->check(CLI::Range(0, 1000));
  verb->add_option("--velocity", c.velocity, "backward, central, savgol or analytic")
      ->capture_default_str()
      ->check(CLI::IsMember(std::vector<std::string>{"backward", "central", "savgol", "analytic"}))
      ->type_name("SCHEME");
  verb->add_option("--window", c.options.velocity.window_s, "savgol and analytic: time the fit spans, s")
      ->capture_default_str();
  verb->add_option("--longest-step", c.options.velocity.longest_step_s,
                   "a longer step between frames is a gap, s (default: 1.5 times the median)");
  verb->add_option("--frame", c.frame, "axes of normals and velocities: camera, world or body")
      ->capture_default_str()
      ->check(CLI::IsMember(std::vector<std::string>{"camera", "world", "body"}))
      ->type_name("FRAME");
  verb->add_option("--cameras", c.cameras, "camera file with the pose for --frame world")->type_name("FILE");
  verb->add_option("--view", c.view, "the camera's name in it")->type_name("NAME");
  verb->add_option("--channels", c.channels, "all, normal or velocity")
      ->capture_default_str()
      ->check(CLI::IsMember(std::vector<std::string>{"all", "normal", "velocity"}))
      ->type_name("KIND");
  verb->add_option("--normals", c.weighting, "faces weighted by area or angle")
      ->capture_default_str()
      ->check(CLI::IsMember(std::vector<std::string>{"area", "angle"}))
      ->type_name("KIND");
  verb->add_option("--dtype", c.dtype, "f32 or f16")
      ->capture_default_str()
      ->check(CLI::IsMember(std::vector<std::string>{"f32", "f16"}))
      ->type_name("TYPE");
  verb->add_option("--gutter", c.options.texels.gutter, "texels around every chart that continue the surface")
      ->capture_default_str()
      ->check(CLI::Range(0, 64));
  verb->add_option("--every", c.options.every, "describe every n-th frame")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  verb->add_flag("--seen-only", c.options.seen_only, "texels that the frame's camera does not see are zero");
  verb->add_option("--preview", c.preview, "a sheet of a few frames, .png")->type_name("FILE");
  verb->add_option("--threads", c.options.num_threads, "threads")->capture_default_str()->check(CLI::Range(1, 1024));
  verb->add_option("--json", c.json, "counts and times of the run")->type_name("FILE");
  verb->callback([command, action] { *action = [command] { RunDescribe(*command); }; });
}

}  // namespace bodyloom
