// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/people/make_multi_person_dataset.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>

#include "data_tools/datasets/multi_person_dataset.h"
#include "data_tools/motion/motion_tools.h"
#include "data_tools/synthesis/clips/synth_camera.h"
#include "data_tools/synthesis/people/dressed_render.h"
#include "data_tools/synthesis/people/make_single_person_dataset.h"
#include "geometry/base/check.h"
#include "geometry/base/hash_random.h"
#include "geometry/base/parallel.h"
#include "geometry/base/stopwatch.h"
#include "geometry/body/posed_body.h"
#include "geometry/cloth/cloth_run.h"
#include "geometry/scene/track.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

constexpr uint64_t kPersonKey = 0x70657273, kClipKey = 0x636c6970;

/// One person in one action.
struct Job {
  int person = 0, action = 0;
};

std::string PersonName(int person) {
  std::array<char, 16> name{};
  std::snprintf(name.data(), name.size(), "p%03d", person);
  return name.data();
}

std::string ClipName(int person, int action, int view) {
  return PersonName(person) + "/a" + std::to_string(action) + "_v" + std::to_string(view);
}

/// Translations in the floor plane from the person's root to the origin, by frame.
std::vector<Vector3d> StepsToCentre(const Motion& motion, const Vector3d& rest_root) {
  std::vector<Vector3d> steps;
  for (int t = 0; t < motion.num_frames(); ++t) {
    const Vector3d root = rest_root + motion.trans.row(t).transpose();
    steps.emplace_back(-root.x(), 0, -root.z());
  }
  return steps;
}

class Maker {
 public:
  Maker(fs::path folder, const BodyModel& body, const std::vector<Motion>& motions,
        const MakeMultiPersonDatasetOptions& options)
      : folder_(std::move(folder)), body_(body), motions_(motions), options_(options) {
    for (int p = 0; p < options.people; ++p) {
      HashRandom random(options.seed, {kPersonKey, static_cast<uint64_t>(p)});
      seeds_.push_back(random.Next() >> 32);  // 32 bits: JSON readers keep them whole
      const auto kind = static_cast<GarmentKind>(random.Below(3));
      people_.push_back(std::make_unique<DressedPerson>(body, PersonBetas(body, options.shape_sigma, seeds_.back()),
                                                        kind, seeds_.back(), options.style));
    }
  }

  /// All views of an action.
  void Make(const Job& job) const {
    const DressedPerson& person = *people_[job.person];
    HashRandom random(options_.seed, {kClipKey, static_cast<uint64_t>(job.person), static_cast<uint64_t>(job.action)});
    const Motion& whole = motions_[random.Below(motions_.size())];
    const int length = (options_.frames - 1) * options_.every + 1;
    const int first =
        static_cast<int>(random.Below(static_cast<uint64_t>(whole.num_frames()) - static_cast<uint64_t>(length) + 1));
    Motion motion = TakeFrames(whole, first, length);
    motion.body = body_.name();
    motion.betas = PersonBetas(body_, options_.shape_sigma, seeds_[job.person]);

    ClothRunOptions cloth_options;
    ClothRun run(person, motion, cloth_options);
    std::vector<std::vector<Vector3d>> cloth;
    for (int t = 0; t < length; ++t) {
      const std::vector<Vector3d>& now = run.Next();
      if (t % options_.every == 0) cloth.push_back(now);
    }
    Motion taken = TakeFrames(motion, 0, options_.frames, options_.every);
    const std::vector<Vector3d> steps = StepsToCentre(taken, body_.RestJoints(motion.betas).row(0).transpose());
    for (int t = 0; t < taken.num_frames(); ++t) {
      taken.trans.row(t) += steps[t].transpose();
      for (Vector3d& x : cloth[t]) x += steps[t];
    }
    const double first_yaw_deg = random.Uniform(0, 360);
    for (int view = 0; view < options_.views; ++view) {
      SynthCameraOptions place;
      place.width = place.height = options_.size_px;
      place.yaw_deg = first_yaw_deg + 360.0 * view / options_.views;
      place.elevation_deg = random.Uniform(options_.elevation_low_deg, options_.elevation_high_deg);
      place.fill = 0.8;
      Write(person, seeds_[job.person], taken, cloth, place, ClipName(job.person, job.action, view));
    }
  }

  [[nodiscard]] MultiPersonDataset Set() const {
    MultiPersonDataset set;
    set.path = folder_.string();
    set.size = options_.size_px, set.seed = options_.seed, set.command = options_.command;
    const int test =
        options_.people < 2 ? 0 : std::max(1, static_cast<int>(std::lround(options_.test_share * options_.people)));
    for (int p = 0; p < options_.people; ++p) {
      DatasetPerson person{PersonName(p), p >= options_.people - test, {}};
      for (int a = 0; a < options_.actions; ++a) {
        for (int v = 0; v < options_.views; ++v) person.clips.push_back(ClipName(p, a, v));
      }
      set.people.push_back(person);
    }
    return set;
  }

 private:
  void Write(const DressedPerson& person, uint64_t seed, const Motion& motion,
             const std::vector<std::vector<Vector3d>>& cloth, const SynthCameraOptions& place,
             const std::string& clip) const {
    const SynthCamera camera = PlaceSynthCamera(body_, motion, place);
    const Track track = TrueTrack(body_, MotionInCamera(body_, motion, camera.pose), camera.camera);
    SinglePersonDatasetInfo info;
    info.num_frames = track.num_frames(), info.width = info.height = options_.size_px;
    info.fps = track.num_frames() > 1 ? 1 / (motion.timestamps[1] - motion.timestamps[0]) : 30;
    info.seed = seed, info.garment = ToString(person.outfit().kind());
    info.has.background = false;
    const SinglePersonDatasetWriter writer((folder_ / clip).string(), info, track);
    const DressedScene scene(person, camera.camera, seed, options_.samples,
                             LightOfSeed(camera.up_in_camera, options_.light_style, seed));
    DressedRenderer renderer(scene);
    std::vector<Vector3d> seen;
    for (int t = 0; t < track.num_frames(); ++t) {
      seen.clear();
      for (const Vector3d& x : cloth[t])
        seen.push_back(camera.pose.camera_from_world_rotation * x + camera.pose.camera_from_world_translation);
      const BodyPose pose =
          PoseFromAxisAngle(body_, track.motion.poses.row(t).transpose(), track.motion.trans.row(t).transpose());
      writer.Write(t, renderer.Render(pose, seen, track.motion.timestamps[t] - track.motion.timestamps[0]));
    }
    writer.Finish();
  }

  fs::path folder_;
  const BodyModel& body_;
  const std::vector<Motion>& motions_;
  const MakeMultiPersonDatasetOptions& options_;
  std::vector<uint64_t> seeds_;
  std::vector<std::unique_ptr<DressedPerson>> people_;
};

void CheckMotions(const std::vector<Motion>& motions, int length) {
  BODYLOOM_CHECK(!motions.empty(), "multi-person dataset: no motion");
  for (size_t m = 0; m < motions.size(); ++m) {
    CheckMotion(motions[m], "multi-person dataset");
    BODYLOOM_CHECK(motions[m].up == Motion::Up::kY, "multi-person dataset: motion ", m, " has not y up");
    BODYLOOM_CHECK(motions[m].num_frames() >= length, "multi-person dataset: motion ", m, " has ",
                   motions[m].num_frames(), " frames, a clip needs ", length);
  }
}

/// Invalidates an existing dataset from now on.
void Forget(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw std::runtime_error(folder.string() + ": cannot make the folder: " + error.message());
  fs::remove(folder / "people.json", error);
  if (error) throw std::runtime_error((folder / "people.json").string() + ": cannot remove: " + error.message());
}

}  // namespace

bool MakeMultiPersonDatasetOptions::IsValid(std::string* why) const {
  const auto no = [&](const char* text) {
    if (why != nullptr) *why = text;
    return false;
  };
  if (people < 1 || people > 999 || actions < 1 || actions > 999 || views < 1 || views > 64) {
    return no("multi-person dataset: people and actions must be 1 to 999, views 1 to 64");
  }
  if (frames < 1 || frames > 10'000 || every < 1 || every > 1000) {
    return no("multi-person dataset: frames must be 1 to 10000, every 1 to 1000");
  }
  if (!(test_share >= 0 && test_share < 1)) return no("multi-person dataset: test_share must be in [0, 1)");
  if (size_px < 32 || size_px > 4096) return no("multi-person dataset: size_px must be 32 to 4096");
  if (!(elevation_low_deg >= -60 && elevation_high_deg <= 60 && elevation_low_deg <= elevation_high_deg)) {
    return no("multi-person dataset: elevations must be in [-60, 60], the lower one first");
  }
  if (!(shape_sigma >= 0 && shape_sigma <= 2)) return no("multi-person dataset: shape_sigma must be in [0, 2]");
  if (samples < 1 || samples > 8) return no("multi-person dataset: samples must be 1 to 8");
  if (num_threads < 0 || num_threads > 1024) return no("multi-person dataset: num_threads must be 0 to 1024");
  return true;
}

MakeMultiPersonDatasetSummary MakeMultiPersonDataset(const std::string& folder, const BodyModel& body,
                                                     const std::vector<Motion>& motions,
                                                     const MakeMultiPersonDatasetOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), why);
  CheckMotions(motions, (options.frames - 1) * options.every + 1);
  const Stopwatch watch;
  Forget(folder);
  const Maker maker(folder, body, motions, options);
  std::vector<Job> jobs;
  for (int p = 0; p < options.people; ++p) {
    for (int a = 0; a < options.actions; ++a) jobs.push_back({p, a});
  }
  const int threads = ThreadsFor(options.num_threads);
  std::atomic<bool> stop{false};
  std::mutex mutex;
  int done = 0;
  ParallelFor(static_cast<int>(jobs.size()), threads, [&](int i) {
    if (stop) return;
    maker.Make(jobs[i]);
    const std::lock_guard lock(mutex);
    ++done;
    if (options.progress && !options.progress(double(done) / jobs.size())) stop = true;
  });
  MakeMultiPersonDatasetSummary summary;
  summary.seconds = watch.seconds();
  summary.images = done * options.views * options.frames;
  if (done < static_cast<int>(jobs.size())) return summary;
  WriteMultiPersonDataset(maker.Set());
  const int64_t each = int64_t{options.actions} * options.views * options.frames;
  summary.pairs = options.people * each * (each - 1);
  summary.finished = true;
  return summary;
}

}  // namespace bodyloom
