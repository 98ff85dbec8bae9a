// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/synthesis/clips/write_synth_clip.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/motion/track_io.h"
#include "bodyloom/data_tools/observations/keypoint_conventions.h"
#include "bodyloom/data_tools/observations/load_camera_path.h"
#include "bodyloom/data_tools/observations/load_cameras.h"
#include "bodyloom/data_tools/observations/observations_npz.h"
#include "bodyloom/data_tools/video/video_writer.h"
#include "bodyloom/geometry/posed_body.h"
#include "bodyloom/render/overlay.h"

namespace bodyloom {
namespace {

using nlohmann::json;

double RoundedTo(double value, double step) { return std::round(value / step) * step; }

/// The landmark, or for BODY_25's neck and mid-hip the middle of the pair as OpenPose defines them.
Keypoint Body25Point(const KeypointSequence& keypoints, int t, const std::string& name) {
  const auto find = [&](const std::string& wanted) {
    const auto it = std::find(keypoints.names.begin(), keypoints.names.end(), wanted);
    return it == keypoints.names.end() ? Keypoint{} : keypoints.at(t, static_cast<int>(it - keypoints.names.begin()));
  };
  if (name != "neck" && name != "mid_hip") return find(name);
  const std::string pair = name == "neck" ? "shoulder" : "hip";
  const Keypoint left = find("left_" + pair), right = find("right_" + pair);
  if (!(left.confidence > 0 && right.confidence > 0)) return {};
  return {0.5F * (left.x + right.x), 0.5F * (left.y + right.y), std::min(left.confidence, right.confidence)};
}

json OpenPoseFrames(const KeypointSequence& keypoints) {
  json frames = json::array();
  for (int t = 0; t < keypoints.num_frames(); ++t) {
    json numbers = json::array();
    bool seen = false;
    for (const std::string& name : Body25().names) {
      const Keypoint p = Body25Point(keypoints, t, name);
      seen = seen || p.confidence > 0;
      for (const double value : {RoundedTo(p.x, 1e-3), RoundedTo(p.y, 1e-3), RoundedTo(p.confidence, 1e-4)}) {
        numbers.push_back(p.confidence > 0 ? value : 0.0);
      }
    }
    json people = json::array();
    if (seen) people.push_back({{"person_id", {-1}}, {"pose_keypoints_2d", std::move(numbers)}});
    frames.push_back({{"version", 1.3}, {"people", std::move(people)}});
  }
  return frames;
}

json Description(const BodyModel& body, const SynthClip& clip, const SynthClipOptions& o) {
  const Camera& camera = clip.truth.camera;
  return {{"body", body.name()},
          {"frames", clip.truth.num_frames()},
          {"seed", o.seed},
          {"camera", {{"model", ToString(camera.model)}, {"width", camera.width}, {"height", camera.height}}},
          {"dense",
           {{"per_frame", o.dense_per_frame},
            {"pixel_sigma_px", o.dense.pixel_sigma_px},
            {"uv_sigma", o.dense.uv_sigma},
            {"quantise_uv", o.dense.quantise_uv},
            {"outlier_probability", o.dense.outlier_probability},
            {"missing_part_share", o.dense.missing_part_share},
            {"points", clip.counts.dense},
            {"outliers", clip.counts.dense_outliers},
            {"points_on_missing_parts", clip.counts.dense_missing}}},
          {"keypoints",
           {{"noise", o.detection.noise},
            {"dropout_probability", o.detection.dropout_probability},
            {"swap_probability", o.detection.swap_probability},
            {"detected", clip.counts.keypoints},
            {"hidden_by_the_body", clip.counts.keypoints_hidden}}},
          {"frames_dropped", clip.counts.frames_dropped},
          {"initialiser_error_px_at_512", clip.initialiser_error_px}};
}

Track InitialiserTrack(const BodyModel& body, const SynthClip& clip) {
  Track track = clip.truth;
  track.motion = clip.initialiser;
  const int T = track.num_frames();
  track.joint_sigma.setConstant(std::numeric_limits<double>::quiet_NaN());
  const MatrixX3d rest = body.RestJoints(track.motion.betas);
  for (int t = 0; t < T; ++t) {
    const BodyPose pose =
        PoseFromAxisAngle(body, track.motion.poses.row(t).transpose(), track.motion.trans.row(t).transpose());
    track.joints[t] = PoseSkeleton(body, rest, pose).joints;
    if (!track.coco17.empty()) track.coco17[t] = PoseLandmarks(body, track.motion.betas, pose, CocoNames());
  }
  return track;
}

void WriteVideo(const std::string& path, const BodyModel& body, const SynthClip& clip,
                const WriteSynthClipOptions& write) {
  OverlayOptions options;
  options.colours = body.has_parts() ? BodyColours::kClothes : BodyColours::kPlain;
  options.up_in_camera = clip.up_in_camera;
  const OverlayRenderer renderer(body, clip.truth, options);
  const std::vector<double>& times = clip.truth.motion.timestamps;
  const int T = clip.truth.num_frames();
  const double fps = T > 1 ? (T - 1) / (times.back() - times.front()) : 30;
  VideoWriter writer(path, renderer.width(), renderer.height(), std::min(fps, 1000.0));
  for (int t = 0; t < T; ++t) {
    writer.Write(renderer.Render(t, {}));
    if (write.progress && !write.progress(double(t + 1) / T)) return;
  }
  writer.Finish();
}

}  // namespace

void WriteSynthClip(const std::string& folder, const BodyModel& body, const SynthClip& clip,
                    const SynthClipOptions& options, const WriteSynthClipOptions& write) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw std::runtime_error(folder + ": cannot make the folder: " + error.message());
  const auto file = [&](const char* name) { return (std::filesystem::path(folder) / name).string(); };
  WriteTrack(file("truth.npz"), clip.truth);
  WriteCameras(file("cameras.json"), {{"synthetic", clip.truth.camera, clip.camera_from_world}});
  const bool has_keypoints = !clip.keypoints.points.empty(), has_dense = options.dense_per_frame > 0;
  if (has_keypoints || has_dense) {
    WriteObservations(file("observations.npz"), has_keypoints ? &clip.keypoints : nullptr,
                      has_dense ? &clip.dense : nullptr);
  }
  if (clip.truth.HasMovingCamera()) {
    WriteCameraPath(file("camera_path.json"), {clip.truth.motion.timestamps, clip.truth.camera_from_scene});
  }
  if (has_keypoints) WriteFileAtomically(file("keypoints.json"), OpenPoseFrames(clip.keypoints).dump() + "\n");
  if (clip.initialiser.num_frames() > 0) WriteTrack(file("initialiser.npz"), InitialiserTrack(body, clip));
  if (write.video) WriteVideo(file("video.mp4"), body, clip, write);
  WriteFileAtomically(file("clip.json"), Description(body, clip, options).dump(2) + "\n");
}

}  // namespace bodyloom
