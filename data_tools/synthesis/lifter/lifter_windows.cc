// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/lifter/lifter_windows.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "data_tools/synthesis/lifter/lifter_detections.h"
#include "geometry/base/check.h"

namespace bodyloom {

using Eigen::Matrix3f;
using Eigen::Vector3f;

namespace {

enum WindowStream : uint64_t {
  kClip = 301,
  kLimbs,
  kExercises,
  kFloor,
  kWhetherFloor,
  kPerturb,
  kPerson,
  kCamera,
  kDetections,
  kFocal,
  kAsRecorded,
  kTurns
};

std::vector<LifterClip> CompactClips(const std::vector<Motion>& motions, const std::vector<char>& has_floor,
                                     const LifterBody& body) {
  BODYLOOM_CHECK(!motions.empty(), "lifter windows: no motions");
  BODYLOOM_CHECK(has_floor.size() == motions.size(), "lifter windows: ", motions.size(), " motions, has_floor for ",
                 has_floor.size());
  std::vector<LifterClip> clips;
  for (size_t i = 0; i < motions.size(); ++i) {
    try {
      clips.push_back(CompactClip(motions[i], has_floor[i] != 0, body));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("motion " + std::to_string(i) + ": " + error.what());
    }
  }
  return clips;
}

const LifterWindowOptions& Checked(const LifterWindowOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), why);
  return options;
}

}  // namespace

bool LifterWindowOptions::IsValid(std::string* why) const {
  const auto no = [&](const std::string& text) {
    if (why != nullptr) *why = "lifter windows: " + text;
    return false;
  };
  const auto between = [](double x, double low, double high) { return x >= low && x <= high; };
  if (num_frames < 1 || num_frames > 100000) return no("num_frames must be in [1, 100000]");
  if (!between(rate, 1, 1000)) return no("rate must be in [1, 1000]");
  if (!between(min_elevation_deg, -89, 89) || !between(max_elevation_deg, min_elevation_deg, 89))
    return no("elevations must be in [-89, 89] and in order");
  if (!between(roll_sd_deg, 0, 180)) return no("roll_sd_deg must be in [0, 180]");
  if (!between(min_distance, 1, 1000) || !between(max_distance, min_distance, 1000))
    return no("distances must be in [1, 1000] and in order");
  if (!between(off_axis, 0, 1)) return no("off_axis must be in [0, 1]");
  if (!between(focal_guess_sd, 0, 2)) return no("focal_guess_sd must be in [0, 2]");
  if (!between(min_speed, 0.01, 100) || !between(max_speed, min_speed, 100))
    return no("speeds must be in [0.01, 100] and in order");
  if (!between(perturbation, 0, 5)) return no("perturbation must be in [0, 5]");
  if (!between(shape_sd, 0, 3)) return no("shape_sd must be in [0, 3]");
  if (!between(bone_noise, 0, 2)) return no("bone_noise must be in [0, 2]");
  if (!between(landmark_sd_m, 0, 0.1)) return no("landmark_sd_m must be in [0, 0.1]");
  if (!between(detector_bias_sd_m, 0, 0.1)) return no("detector_bias_sd_m must be in [0, 0.1]");
  if (!between(noise, 0, 100)) return no("noise must be in [0, 100]");
  if (!between(noise_spread, 0, 2)) return no("noise_spread must be in [0, 2]");
  if (!between(confidence_spread, 0, 2)) return no("confidence_spread must be in [0, 2]");
  for (const auto& [name, value] : {std::pair("moving_camera", moving_camera),
                                    {"any_elevation", any_elevation},
                                    {"focal_known", focal_known},
                                    {"mirror", mirror},
                                    {"as_recorded", as_recorded},
                                    {"arm_exchange", arm_exchange},
                                    {"leg_exchange", leg_exchange},
                                    {"spine_exchange", spine_exchange},
                                    {"squat", squat},
                                    {"lunge_share", lunge_share},
                                    {"leg_raise", leg_raise},
                                    {"kick", kick},
                                    {"arm_raise", arm_raise},
                                    {"reach", reach},
                                    {"bend", bend},
                                    {"lean", lean},
                                    {"spin", spin},
                                    {"tumble", tumble},
                                    {"floor_poses", floor_poses},
                                    {"biased_detector", biased_detector},
                                    {"dropout", dropout},
                                    {"pair_swap", pair_swap},
                                    {"body_swap", body_swap},
                                    {"no_feet", no_feet},
                                    {"no_face", no_face},
                                    {"missing_limb", missing_limb},
                                    {"missing_lower_half", missing_lower_half},
                                    {"nothing", nothing},
                                    {"image_border", image_border},
                                    {"cut_off", cut_off},
                                    {"constant_confidence", constant_confidence}}) {
    if (!between(value, 0, 1)) return no(std::string(name) + " must be in [0, 1]");
  }
  return true;
}

LifterWindowGenerator::LifterWindowGenerator(const std::vector<Motion>& motions, const std::vector<char>& has_floor,
                                             const BodyModel& body, const LifterWindowOptions& options)
    : options_(Checked(options)),
      body_(body),
      limits_(body),
      clips_(CompactClips(motions, has_floor, body_)),
      choice_(clips_) {}

LifterPerson LifterWindowGenerator::MakePerson(uint64_t seed) const {
  const LifterPersonSpread spread{options_.shape_sd, options_.bone_noise, options_.landmark_sd_m,
                                  options_.biased_detector, options_.detector_bias_sd_m};
  return body_.RandomPerson(spread, HashRandom(seed, {kPerson}));
}

PoseSequence LifterWindowGenerator::MakePoses(uint64_t seed, const LifterPerson& person) const {
  HashRandom random(seed, {kClip});
  const LifterClip& clip = clips_[choice_(&random)];
  const double start_s = random.Uniform(0, clip.duration_s);
  const double speed = std::exp(random.Uniform(std::log(options_.min_speed), std::log(options_.max_speed)));
  const bool mirror = random.Uniform() < options_.mirror;
  const double step = speed / options_.rate;
  PoseSequence poses;
  SampleClip(clip, start_s, step, options_.num_frames, &poses);
  if (mirror) MirrorPoses(&poses);
  if (HashRandom(seed, {kAsRecorded}).Uniform() < options_.as_recorded) {
    PerturbPoses(options_, 0.25F, 0.25F, HashRandom(seed, {kPerturb}), &poses);
    limits_.Apply(&poses);
    return poses;
  }
  ExchangeLimbs(clips_, choice_, options_, step, HashRandom(seed, {kLimbs}), &poses);
  const bool floor = HashRandom(seed, {kWhetherFloor}).Uniform() < options_.floor_poses;
  if (floor) {
    AddFloorPoses(body_, person, options_, HashRandom(seed, {kFloor}), &poses);
  } else {
    AddExercises(options_, HashRandom(seed, {kExercises}), &poses);
    AddTurns(options_, HashRandom(seed, {kTurns}), &poses);
  }
  // Less perturbation on the floor, so that bodies are not rotated off it or pushed up by their limbs.
  PerturbPoses(options_, floor ? 0.6F : 1.0F, floor ? 0.2F : 1.0F, HashRandom(seed, {kPerturb}), &poses);
  limits_.Apply(&poses);
  return poses;
}

LifterScene LifterWindowGenerator::MakeScene(uint64_t seed, const LifterPerson& person,
                                             const PoseSequence& poses) const {
  return FilmPerson(PoseInWorld(body_, person, poses, options_.rate), person, options_, HashRandom(seed, {kCamera}));
}

LifterFrames LifterWindowGenerator::Detect(uint64_t seed, const LifterScene& scene) const {
  return DetectScene(scene, options_, HashRandom(seed, {kDetections}).Next());
}

void LifterWindowGenerator::MakeWindow(uint64_t seed, const LifterScene& scene, const LifterFrames& frames,
                                       LifterWindow* window) const {
  const int T = scene.num_frames;
  HashRandom focal(seed, {kFocal});
  LifterInput input;
  std::vector<Matrix3f> camera_from_virtual;
  LifterFrames seen = frames;
  seen.focal_known = focal.Uniform() < options_.focal_known;
  const auto guess = static_cast<float>(std::exp(options_.focal_guess_sd * focal.Normal()));
  if (seen.focal_known) {
    input = MakeLifterInput(seen);
    camera_from_virtual = std::move(input.camera_from_virtual);
  } else {
    camera_from_virtual = LifterVirtualCameras(frames);
    for (float& x : seen.x) x *= guess;
    for (float& y : seen.y) y *= guess;
    input = MakeLifterInput(seen);
  }
  window->features = std::move(input.features);
  window->confidence = std::move(seen.confidence);
  window->contact = scene.contact;
  window->points.resize(3 * scene.points.size());
  window->up.resize(3 * static_cast<size_t>(T));
  const float inverse_length = 1 / scene.reference_length;
  for (int t = 0; t < T; ++t) {
    const Matrix3f virtual_from_camera = camera_from_virtual[t].transpose();
    const Vector3f* p = &scene.points[static_cast<size_t>(t) * kLifterPoints];
    const Vector3f hip = 0.5F * (p[kLifterLeftHip] + p[kLifterLeftHip + 1]);
    const Vector3f up = virtual_from_camera * scene.up[t];
    std::copy(up.data(), up.data() + 3, &window->up[3 * static_cast<size_t>(t)]);
    for (int k = 0; k < kLifterPoints; ++k) {
      const Vector3f x = virtual_from_camera * (p[k] - hip) * inverse_length;
      std::copy(x.data(), x.data() + 3, &window->points[3 * (static_cast<size_t>(t) * kLifterPoints + k)]);
    }
  }
}

void LifterWindowGenerator::Generate(uint64_t seed, LifterWindow* window) const {
  const LifterPerson person = MakePerson(seed);
  const LifterScene scene = MakeScene(seed, person, MakePoses(seed, person));
  MakeWindow(seed, scene, Detect(seed, scene), window);
}

}  // namespace bodyloom
