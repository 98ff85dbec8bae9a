// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/people/make_single_person_dataset.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "data_tools/motion/motion_tools.h"
#include "data_tools/synthesis/people/dressed_render.h"
#include "geometry/base/check.h"
#include "geometry/base/hash_random.h"
#include "geometry/base/parallel.h"
#include "geometry/base/stopwatch.h"
#include "geometry/body/posed_body.h"
#include "geometry/cloth/cloth_run.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;

/// Frames that are rendered while the cloth of the next ones is computed.
constexpr int kFramesAChunk = 16;

/// Pool of renderers, which are reused by threads because they keep memory.
class RendererPool {
 public:
  explicit RendererPool(const DressedScene& scene) : scene_(scene) {}
  std::unique_ptr<DressedRenderer> Take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (free_.empty()) return std::make_unique<DressedRenderer>(scene_);
    std::unique_ptr<DressedRenderer> renderer = std::move(free_.back());
    free_.pop_back();
    return renderer;
  }
  void Return(std::unique_ptr<DressedRenderer> renderer) {
    const std::lock_guard<std::mutex> lock(mutex_);
    free_.push_back(std::move(renderer));
  }

 private:
  const DressedScene& scene_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<DressedRenderer>> free_;
};

bool HasCoco(const BodyModel& body) {
  return std::all_of(CocoNames().begin(), CocoNames().end(),
                     [&](const std::string& name) { return body.FindLandmark(name) >= 0; });
}

}  // namespace

bool MakeSinglePersonDatasetOptions::IsValid(std::string* why) const {
  const auto no = [&](const char* text) {
    if (why != nullptr) *why = text;
    return false;
  };
  if (size_px < 32 || size_px > 4096) return no("single-person dataset: size_px must be 32 to 4096");
  if (!std::isfinite(yaw_deg) || !(std::abs(elevation_deg) <= 60)) {
    return no("single-person dataset: yaw_deg must be finite, elevation_deg in [-60, 60]");
  }
  if (!(shape_sigma >= 0 && shape_sigma <= 2)) return no("single-person dataset: shape_sigma must be in [0, 2]");
  if (samples < 1 || samples > 8) return no("single-person dataset: samples must be 1 to 8");
  if (num_threads < 0 || num_threads > 1024) return no("single-person dataset: num_threads must be 0 to 1024");
  return true;
}

Eigen::VectorXd PersonBetas(const BodyModel& body, double sigma, uint64_t seed) {
  HashRandom random(seed, {0x73686170});
  Eigen::VectorXd betas(body.num_betas());
  for (double& b : betas) b = sigma * std::clamp(random.Normal(), -2.0, 2.0);
  return betas;
}

Track TrueTrack(const BodyModel& body, const Motion& in_camera, const Camera& camera) {
  Track track;
  track.motion = in_camera;
  track.camera = camera;
  const int T = track.num_frames();
  track.frame_status.assign(T, FrameStatus::kTracked);
  track.joint_sigma = RowMatrixXd::Constant(T, body.num_joints(), std::numeric_limits<double>::quiet_NaN());
  const MatrixX3d rest = body.RestJoints(in_camera.betas);
  const bool has_coco = HasCoco(body);
  for (int t = 0; t < T; ++t) {
    const BodyPose pose =
        PoseFromAxisAngle(body, track.motion.poses.row(t).transpose(), track.motion.trans.row(t).transpose());
    track.joints.push_back(PoseSkeleton(body, rest, pose).joints);
    if (has_coco) track.coco17.push_back(PoseLandmarks(body, in_camera.betas, pose, CocoNames()));
  }
  return track;
}

Track TrackInView(const BodyModel& body, const Motion& motion, const MakeSinglePersonDatasetOptions& options,
                  SynthCamera* camera) {
  Motion world = motion;
  world.body = body.name();
  world.betas = PersonBetas(body, options.shape_sigma, options.seed);
  SynthCameraOptions place;
  place.width = place.height = options.size_px;
  place.yaw_deg = options.yaw_deg, place.elevation_deg = options.elevation_deg;
  place.fill = 0.8;  // room for cloth that flies
  *camera = PlaceSynthCamera(body, world, place);
  return TrueTrack(body, MotionInCamera(body, world, camera->pose), camera->camera);
}

MakeSinglePersonDatasetSummary MakeSinglePersonDataset(const std::string& folder, const BodyModel& body,
                                                       const Motion& motion,
                                                       const MakeSinglePersonDatasetOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), why);
  CheckMotion(motion, "MakeSinglePersonDataset");
  BODYLOOM_CHECK(motion.num_frames() > 0, "MakeSinglePersonDataset: a motion without frames");
  const Stopwatch watch;
  SynthCamera camera;
  const Track track = TrackInView(body, motion, options, &camera);
  const int T = track.num_frames();
  SinglePersonDatasetInfo info;
  info.num_frames = T, info.width = info.height = options.size_px;
  info.fps =
      T > 1 && motion.timestamps[1] > motion.timestamps[0] ? 1 / (motion.timestamps[1] - motion.timestamps[0]) : 30;
  info.seed = options.seed, info.garment = ToString(options.garment);
  info.motion = options.motion, info.command = options.command;
  const DressedPerson person(body, track.motion.betas, options.garment, options.seed, options.style, options.material);
  info.has.iuv = body.has_parts() && body.data().face_iuv.rows() > 0;
  const SinglePersonDatasetWriter writer(folder, info, track);
  const DressedScene scene(
      person, track.camera, options.seed, options.samples,
      LightOfSeed(camera.up_in_camera, options.light_style, options.light_seed.value_or(options.seed)));
  ClothRunOptions run_options;
  run_options.up = camera.up_in_camera;
  run_options.cloth = ClothOptionsFor(options.material, run_options.cloth);
  ClothRun run(person, track.motion, run_options);

  MakeSinglePersonDatasetSummary summary;
  summary.cloth_vertices = person.garment().cloth.num_vertices();
  summary.largest_stretch = 0;
  summary.light = scene.light();
  const int threads = ThreadsFor(options.num_threads);
  using Chunk = std::vector<std::vector<Vector3d>>;  // cloth, by frame
  const auto simulate = [&](int first) {
    const Stopwatch cloth_watch;
    Chunk chunk;
    for (int t = first; t < std::min(T, first + kFramesAChunk); ++t) {
      chunk.push_back(run.Next());
      if (run.simulation() == nullptr) continue;
      summary.largest_stretch =
          std::max(summary.largest_stretch, LargestStretch(run.simulation()->mesh(), chunk.back()));
      summary.frames_through += run.legs_through() > 0;
    }
    summary.cloth_seconds += cloth_watch.seconds();
    return chunk;
  };
  RendererPool pool(scene);
  Chunk chunk = simulate(0), next;
  for (int first = 0; first < T; first += kFramesAChunk) {
    const int count = static_cast<int>(chunk.size());
    std::vector<PersonFrame> seen(options.look ? count : 0);
    ParallelFor(count + 1, threads, [&](int i) {
      if (i == 0) {
        next = simulate(first + count);
        return;
      }
      const int t = first + i - 1;
      const BodyPose pose =
          PoseFromAxisAngle(body, track.motion.poses.row(t).transpose(), track.motion.trans.row(t).transpose());
      std::unique_ptr<DressedRenderer> renderer = pool.Take();
      PersonFrame frame = renderer->Render(pose, chunk[i - 1], track.motion.timestamps[t] - motion.timestamps[0]);
      pool.Return(std::move(renderer));
      writer.Write(t, frame);
      if (options.look) seen[i - 1] = std::move(frame);
    });
    for (int i = 0; i < static_cast<int>(seen.size()); ++i) options.look(first + i, seen[i]);
    chunk = std::exchange(next, {});
    summary.frames = first + count, summary.cuts = run.num_cuts(), summary.seconds = watch.seconds();
    if (options.progress && !options.progress(double(summary.frames) / T) && summary.frames < T) return summary;
  }
  writer.Finish();
  summary.finished = true;
  summary.seconds = watch.seconds();
  return summary;
}

}  // namespace bodyloom
