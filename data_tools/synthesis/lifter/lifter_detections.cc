// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/lifter/lifter_detections.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "data_tools/synthesis/clips/detection_noise.h"
#include "data_tools/synthesis/lifter/fast_random.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;

constexpr float kContactHeight = 0.04F, kContactSpeed = 0.35F, kContactSpeedWithoutFloor = 0.25F;
constexpr double kLowestElevation = -35, kHighestElevation = 75;  // degrees, of LifterWindowOptions::any_elevation
constexpr float kMinDepth = 0.9F;                                 // of the nearest landmark, metres for the mean body

Vector3f MidHip(const Vector3f* points) { return 0.5F * (points[kLifterLeftHip] + points[kLifterLeftHip + 1]); }

using Eigen::Vector2f;

enum NoiseStream : uint64_t {
  kMood = 401,
  kSlow,
  kWhiteNoise,
  kOffsetNoise,
  kTailNoise,
  kDropoutNoise,
  kSwaps,
  kMissing,
  kDetector
};

constexpr float kPersonHeight = 1.3F;  // in Lref
constexpr float kBehind = 0.09F, kSoftness = 0.03F, kTurnedAway = 0.10F, kTurnedAwayFactor = 0.85F;

/// An occluder between two joints. Points in `own` (a bit each) belong to it.
struct LimbCapsule {
  int from, from_other, to, to_other;  ///< means of two points
  float radius;
  uint32_t own;
};
constexpr uint32_t Bit(int k) { return 1U << k; }
constexpr uint32_t kTrunkPoints = Bit(5) | Bit(6) | Bit(11) | Bit(12);
constexpr uint32_t kLegPoints[2] = {Bit(11) | Bit(13) | Bit(15) | Bit(17) | Bit(19),
                                    Bit(12) | Bit(14) | Bit(16) | Bit(18) | Bit(20)};
constexpr LimbCapsule kCapsules[] = {
    {5, 6, 11, 12, .13F, kTrunkPoints},    {5, 5, 11, 11, .09F, kTrunkPoints},    {6, 6, 12, 12, .09F, kTrunkPoints},
    {11, 11, 13, 13, .07F, kLegPoints[0]}, {13, 13, 15, 15, .06F, kLegPoints[0]}, {12, 12, 14, 14, .07F, kLegPoints[1]},
    {14, 14, 16, 16, .06F, kLegPoints[1]},
};

float Logistic(float x) { return 1 / (1 + std::exp(-x)); }
size_t At(int t, int k) { return static_cast<size_t>(t) * kLifterPoints + k; }

/// Factor of each point's confidence by occlusion: 1 visible, kHiddenFactor hidden.
void HideBehindBody(const Vector3f* p, float size, std::array<float, kLifterPoints>* factor) {
  const float inverse = 1 / (kSoftness * size);
  std::array<Vector3f, kLifterPoints> ray;
  std::array<float, kLifterPoints> distance{};
  for (int k = 5; k < kLifterPoints; ++k) {
    distance[k] = p[k].norm();
    ray[k] = p[k] / distance[k];
  }
  for (const LimbCapsule& c : kCapsules) {
    const Vector3f a = 0.5F * (p[c.from] + p[c.from_other]), d = 0.5F * (p[c.to] + p[c.to_other]) - a;
    const float aa = a.squaredNorm(), ad = a.dot(d), dd = d.squaredNorm(), reach = (c.radius + 3 * kSoftness) * size;
    for (int k = 5; k < kLifterPoints; ++k) {
      if ((c.own & Bit(k)) != 0) continue;
      // The point a + s·d of the segment nearest to the ray towards the landmark.
      const float ar = a.dot(ray[k]), dr = d.dot(ray[k]);
      const float across2 = std::max(dd - dr * dr, 1e-8F), from_across = ad - ar * dr;
      const float s = std::clamp(-from_across / across2, 0.0F, 1.0F);
      const float miss2 = aa - ar * ar + s * (2 * from_across + s * across2);
      const float depth = distance[k] - (ar + s * dr);
      if (miss2 > reach * reach || depth < 0) continue;
      const float miss = std::sqrt(std::max(0.0F, miss2));
      const float hidden =
          Logistic((c.radius * size - miss) * 2 * inverse) * Logistic((depth - kBehind * size) * 2 * inverse);
      (*factor)[k] = std::min((*factor)[k], 1 - (1 - static_cast<float>(kHiddenFactor)) * hidden);
    }
  }
  for (const int left : {kLifterLeftShoulder, kLifterLeftHip}) {
    const float apart = distance[left] - distance[left + 1];
    const float away = Logistic((std::abs(apart) - kTurnedAway * size) * inverse);
    (*factor)[apart > 0 ? left : left + 1] *= 1 - (1 - kTurnedAwayFactor) * away;
  }
}

/// Confidences of nose, eyes and ears by the direction of the head.
void FaceConfidences(const Vector3f* p, float* confidence) {
  const Vector3f between_ears = 0.5F * (p[3] + p[4]), to_camera = -between_ears.normalized();
  const float forward = (p[0] - between_ears).normalized().dot(to_camera);
  const float left = (p[3] - p[4]).normalized().dot(to_camera);
  confidence[0] = kNoseConfidence.At(forward);
  confidence[1] = confidence[2] = kEyeConfidence.At(forward);
  confidence[3] = kEarConfidence.At(left);
  confidence[4] = kEarConfidence.At(-left);
}

/// A stretch of frames of min … max seconds, [first, end).
struct Stretch {
  int first, end;
};
Stretch RandomStretch(int T, double rate, double min_s, double max_s, HashRandom* random) {
  const int length = std::max(1, static_cast<int>(rate * random->Uniform(min_s, max_s)));
  const int first = static_cast<int>(random->Uniform(-0.5 * length, T - 0.5 * length));
  return {std::max(0, first), std::min(T, first + length)};
}

void SwapPoints(int t, int a, int b, LifterFrames* frames) {
  std::swap(frames->x[At(t, a)], frames->x[At(t, b)]);
  std::swap(frames->y[At(t, a)], frames->y[At(t, b)]);
  std::swap(frames->confidence[At(t, a)], frames->confidence[At(t, b)]);
}

void Swap(const LifterWindowOptions& options, HashRandom random, LifterFrames* frames) {
  for (const int left : {kLifterLeftElbow, kLifterLeftWrist, kLifterLeftKnee, kLifterLeftAnkle}) {
    const Stretch run = RandomStretch(frames->num_frames, options.rate, 0.05, 0.3, &random);
    if (random.Uniform() >= options.pair_swap) continue;
    for (int t = run.first; t < run.end; ++t) {
      SwapPoints(t, left, left + 1, frames);
      if (left != kLifterLeftAnkle) continue;
      SwapPoints(t, kLifterLeftBigToe, kLifterLeftBigToe + 1, frames);
      SwapPoints(t, kLifterLeftHeel, kLifterLeftHeel + 1, frames);
    }
  }
  const Stretch run = RandomStretch(frames->num_frames, options.rate, 0.1, 1.0, &random);
  if (random.Uniform() >= options.body_swap) return;
  for (int t = run.first; t < run.end; ++t) {
    for (int left = kLifterLeftShoulder; left < kLifterPoints; left += 2) SwapPoints(t, left, left + 1, frames);
  }
}

/// Applies the detector's own scale of confidence, and removes points that it does not report or have.
void DetectorHabits(const LifterWindowOptions& options, HashRandom random, LifterFrames* frames) {
  const float exponent = static_cast<float>(std::exp(options.confidence_spread * random.Normal()));
  const bool cuts = random.Uniform() < options.cut_off;
  const float threshold = static_cast<float>(random.Uniform(0.1, 0.4));
  const bool constant = random.Uniform() < options.constant_confidence;
  for (float& c : frames->confidence) {
    if (!(c > 0)) continue;
    if (cuts && c < threshold) {
      c = 0;
    } else if (constant || !options.model_confidence) {
      c = 1;
    } else if (options.confidence_spread > 0) {
      c = std::pow(c, exponent);
    }
  }
  const bool no_feet = random.Uniform() < options.no_feet;
  const bool no_face = random.Uniform() < options.no_face, nose_left = random.Uniform() < 0.3;
  for (int t = 0; t < frames->num_frames; ++t) {
    for (int k = kLifterLeftBigToe; no_feet && k < kLifterPoints; ++k) frames->confidence[At(t, k)] = 0;
    for (int k = nose_left ? 1 : 0; no_face && k < kLifterLeftShoulder; ++k) frames->confidence[At(t, k)] = 0;
  }
}

/// Limbs, the lower half or everything missing for a while.
void LoseStretches(const LifterWindowOptions& options, HashRandom random, LifterFrames* frames) {
  const auto lose = [&](double probability, double min_s, double max_s, const std::vector<int>& points) {
    const Stretch run = RandomStretch(frames->num_frames, options.rate, min_s, max_s, &random);
    if (random.Uniform() >= probability) return;
    for (int t = run.first; t < run.end; ++t) {
      for (const int k : points) frames->confidence[At(t, k)] = 0;
    }
  };
  const int side = static_cast<int>(random.Below(2)), joint = static_cast<int>(random.Below(6));
  std::vector<int> limb;
  switch (joint) {
    case 0:
      limb = {7 + side, 9 + side};
      break;
    case 1:
      limb = {9 + side};
      break;
    case 2:
      limb = {9, 10};
      break;
    case 3:
      limb = {13 + side, 15 + side, 17 + side, 19 + side};
      break;
    case 4:
      limb = {15, 16, 17, 18, 19, 20};
      break;
    default:
      limb = {5 + side, 7 + side, 9 + side};
      break;
  }
  lose(options.missing_limb, 0.3, 6, limb);
  std::vector<int> lower = {13, 14, 15, 16, 17, 18, 19, 20};
  if (random.Uniform() < 0.5) lower.insert(lower.end(), {11, 12});
  lose(options.missing_lower_half, 1, 8, lower);
  std::vector<int> all(kLifterPoints);
  for (int k = 0; k < kLifterPoints; ++k) all[k] = k;
  lose(options.nothing, 0.1, 1.2, all);
}

/// An image border through the person: points beyond it are missing, or guessed on the border with low confidence.
void CutAtBorder(const LifterWindowOptions& options, HashRandom random, LifterFrames* frames) {
  if (random.Uniform() >= options.image_border) return;
  const int edge = static_cast<int>(random.Below(5));  // bottom twice as often
  const bool guesses = random.Uniform() < 0.4;
  const bool vertical = edge >= 2;
  std::vector<float>& along = vertical ? frames->y : frames->x;
  const float sign = edge == 0 || edge == 2 ? -1.0F : 1.0F;
  float low = 1e9F, high = -1e9F;
  for (size_t i = 0; i < along.size(); ++i) {
    if (!(frames->confidence[i] > 0)) continue;
    low = std::min(low, sign * along[i]);
    high = std::max(high, sign * along[i]);
  }
  if (low > high) return;
  const float border = high - static_cast<float>(random.Uniform(0.02, 0.55)) * (high - low);
  const float guess = static_cast<float>(random.Uniform(0.05, 0.35));
  for (size_t i = 0; i < along.size(); ++i) {
    if (!(frames->confidence[i] > 0) || sign * along[i] <= border) continue;
    along[i] = sign * (border - (guesses ? 0.02F * (high - low) : 0));
    frames->confidence[i] = guesses ? std::min(frames->confidence[i], guess) : 0;
  }
}

}  // namespace

WorldMotion PoseInWorld(const LifterBody& body, const LifterPerson& person, const PoseSequence& poses, double rate) {
  const int T = poses.num_frames;
  WorldMotion motion;
  motion.points.resize(static_cast<size_t>(T) * kLifterPoints);
  motion.detected.resize(motion.points.size());
  motion.contact.assign(2 * static_cast<size_t>(T), 0);
  std::vector<float> floor(T);
  PosedPerson posed;
  for (int t = 0; t < T; ++t) {
    body.Pose(person, &poses.at(t, 0), person.size * poses.trans[t], &posed);
    const float lowest = body.Lowest(person, posed);
    const float lift = poses.has_floor ? person.size * poses.clearance[t] - lowest : 0;
    floor[t] = poses.has_floor ? 0 : lowest;
    for (int k = 0; k < kLifterPoints; ++k) {
      const size_t i = static_cast<size_t>(t) * kLifterPoints + k;
      motion.points[i] = posed.point[k] + Vector3f(0, lift, 0);
      motion.detected[i] = body.DetectedPoint(person, posed, k) + Vector3f(0, lift, 0);
    }
  }
  const auto radius = body.foot_radius();
  const float max_speed = poses.has_floor ? kContactSpeed : kContactSpeedWithoutFloor;
  for (int t = 0; t < T; ++t) {
    const int before = std::max(0, t - 1), after = std::min(T - 1, t + 1);
    const float seconds = static_cast<float>((after - before) / rate);
    for (int side = 0; side < 2; ++side) {
      for (int end = 0; end < 2; ++end) {
        const int k = (end == 0 ? kLifterLeftBigToe : kLifterLeftHeel) + side;
        const auto at = [&](int frame) { return motion.points[static_cast<size_t>(frame) * kLifterPoints + k]; };
        const float height = at(t).y() / person.size - floor[t] / person.size - radius[end];
        const float speed = seconds > 0 ? (at(after) - at(before)).norm() / seconds / person.size : 0;
        if (height < kContactHeight && speed < max_speed) motion.contact[2 * static_cast<size_t>(t) + side] = 1;
      }
    }
  }
  return motion;
}

LifterScene FilmPerson(const WorldMotion& motion, const LifterPerson& person, const LifterWindowOptions& options,
                       HashRandom random) {
  const int T = static_cast<int>(motion.points.size()) / kLifterPoints;
  const auto radian = [](double degrees) { return static_cast<float>(degrees * M_PI / 180); };
  const float yaw = static_cast<float>(random.Uniform(0, 2 * M_PI));
  // Draws no random numbers when it is off, so that windows as recorded do not change.
  const bool anywhere = options.any_elevation > 0 && random.Uniform() < options.any_elevation;
  const float elevation = radian(anywhere ? random.Uniform(kLowestElevation, kHighestElevation)
                                          : random.Uniform(options.min_elevation_deg, options.max_elevation_deg));
  const float roll = radian(options.roll_sd_deg * random.Normal());
  const float distance =
      person.size *
      static_cast<float>(std::exp(random.Uniform(std::log(options.min_distance), std::log(options.max_distance))));
  const float aside = static_cast<float>(options.off_axis * random.Uniform(-1, 1));
  const float above = static_cast<float>(0.5 * options.off_axis * random.Uniform(-1, 1));
  const bool moves = random.Uniform() < options.moving_camera;

  // Rows: right, down and forward of a camera that looks at the person; it is turned off the person below.
  const Vector3f forward(-std::cos(elevation) * std::sin(yaw), -std::sin(elevation),
                         -std::cos(elevation) * std::cos(yaw));
  const Vector3f right = forward.cross(Vector3f::UnitY()).normalized(), down = forward.cross(right);
  Matrix3f camera_from_world;
  camera_from_world << right.transpose(), down.transpose(), forward.transpose();
  camera_from_world = Eigen::AngleAxisf(roll, Vector3f::UnitZ()).toRotationMatrix() * camera_from_world;

  Vector3f middle = Vector3f::Zero();
  for (int t = 0; t < T; ++t) middle += MidHip(&motion.points[static_cast<size_t>(t) * kLifterPoints]);
  middle /= static_cast<float>(T);
  Vector3f place = distance * Vector3f(aside, above, 1);  // of the middle, in the camera
  // Moves back until no point is too near and the hips are within 45° of the axis, as in a composed shot.
  float missing = 0;
  for (const Vector3f& p : motion.points) {
    missing = std::max(missing, kMinDepth * person.size - place.z() - camera_from_world.row(2).dot(p - middle));
  }
  for (int t = 0; t < T; ++t) {
    const Vector3f hip =
        camera_from_world * (MidHip(&motion.points[static_cast<size_t>(t) * kLifterPoints]) - middle) + place;
    missing = std::max(missing, hip.head<2>().cwiseAbs().maxCoeff() - hip.z());
  }
  place.z() += missing;

  LifterScene scene;
  scene.num_frames = T;
  scene.points.resize(motion.points.size());
  scene.detected.resize(motion.points.size());
  scene.up.resize(T);
  scene.contact = motion.contact;
  scene.reference_length = person.reference_length;
  scene.size = person.size;
  FastNormal normal(random);
  std::vector<float> shake[3];
  if (moves) {
    for (auto& s : shake) SmoothNoise(T, static_cast<float>(0.4 * options.rate), &normal, &s);
  }
  Vector3f followed = Vector3f::Zero();
  for (int t = 0; t < T; ++t) {
    Matrix3f turned = Matrix3f::Identity();
    if (moves) {
      // Follows the person with a delay of half a second, with a shake of half a degree.
      const Vector3f hip =
          camera_from_world * (MidHip(&motion.points[static_cast<size_t>(t) * kLifterPoints]) - middle) + place;
      followed =
          t == 0 ? hip : Vector3f(followed + (hip - followed) * std::min(1.0F, static_cast<float>(2 / options.rate)));
      turned = Eigen::Quaternionf::FromTwoVectors(followed, place).toRotationMatrix() *
               TurnBy(0.009F * Vector3f(shake[0][t], shake[1][t], shake[2][t])).toRotationMatrix();
    }
    const Matrix3f R = turned * camera_from_world;
    const Vector3f offset = turned * place;
    scene.up[t] = R.col(1);
    for (int k = 0; k < kLifterPoints; ++k) {
      const size_t i = static_cast<size_t>(t) * kLifterPoints + k;
      scene.points[i] = R * (motion.points[i] - middle) + offset;
      scene.detected[i] = R * (motion.detected[i] - middle) + offset;
    }
  }
  return scene;
}

LifterFrames DetectScene(const LifterScene& scene, const LifterWindowOptions& options, uint64_t seed) {
  const int T = scene.num_frames;
  LifterFrames frames;
  frames.num_frames = T;
  const size_t N = static_cast<size_t>(T) * kLifterPoints;
  frames.x.resize(N);
  frames.y.resize(N);
  frames.confidence.resize(N);

  HashRandom detector(seed, {kDetector});
  const float noise = static_cast<float>(options.noise * std::exp(options.noise_spread * detector.Normal()));
  std::array<float, kLifterPoints> typical{}, joint_factor{}, offset_x{}, offset_y{}, mood{}, slow_x{}, slow_y{},
      tail{};
  HashRandom offset(seed, {kOffsetNoise});
  FastNormal mood_normal(HashRandom(seed, {kMood})), slow(HashRandom(seed, {kSlow})),
      white(HashRandom(seed, {kWhiteNoise}));
  for (int k = 0; k < kLifterPoints; ++k) {
    typical[k] = static_cast<float>(OpenConfidence(LandmarkKind(LifterPointNames()[k])));
    offset_x[k] = static_cast<float>(kConstantNoise * offset.Normal());
    offset_y[k] = static_cast<float>(kConstantNoise * offset.Normal());
    joint_factor[k] = static_cast<float>(offset.Uniform(0.6, 1.4));
    mood[k] = mood_normal();
    slow_x[k] = slow();
    slow_y[k] = slow();
  }
  const float dt = static_cast<float>(1 / options.rate);
  const float keep_mood = std::exp(-dt / static_cast<float>(kConfidenceDriftSeconds));
  const float keep_slow = std::exp(-dt / static_cast<float>(kSlowNoiseSeconds));
  const float new_mood = std::sqrt(1 - keep_mood * keep_mood), new_slow = std::sqrt(1 - keep_slow * keep_slow);
  HashRandom tail_random(seed, {kTailNoise}), dropout(seed, {kDropoutNoise});
  const int tail_frames = std::max(1, static_cast<int>(std::lround(kHeavyTailSeconds * options.rate)));
  std::array<float, kLifterPoints> hiding{};
  std::array<float, kLifterPoints> face{};
  for (int t = 0; t < T; ++t) {
    const Vector3f* truth = &scene.points[At(t, 0)];
    hiding.fill(1);
    if (options.model_confidence) {
      HideBehindBody(truth, scene.size, &hiding);
      FaceConfidences(truth, face.data());
    }
    const float depth = 0.5F * (truth[kLifterLeftHip].z() + truth[kLifterLeftHip + 1].z());
    const float height = kPersonHeight * scene.reference_length / std::max(depth, 0.3F * scene.size);
    for (int k = 0; k < kLifterPoints; ++k) {
      if (t > 0) {
        mood[k] = keep_mood * mood[k] + new_mood * mood_normal();
        slow_x[k] = keep_slow * slow_x[k] + new_slow * slow();
        slow_y[k] = keep_slow * slow_y[k] + new_slow * slow();
      }
      if (t % tail_frames == 0) tail[k] = static_cast<float>(tail_random.Exponential());
      const float hidden = hiding[k];
      float confidence = 1;
      if (options.model_confidence) {
        const float drift =
            static_cast<float>(kHiddenConfidenceDrift) + static_cast<float>(kConfidenceDrift - kHiddenConfidenceDrift) *
                                                             std::min(1.0F, 2 * std::max(0.0F, hidden - 0.5F));
        confidence = (k < kLifterLeftShoulder ? face[k] : typical[k]) * hidden + drift * mood[k];
        confidence = std::clamp(confidence, static_cast<float>(kMinDetectedConfidence), 1.0F);
      }
      const float sigma = joint_factor[k] * DetectionSigma(confidence);
      const float scale = noise * height * (confidence < static_cast<float>(kHeavyTailConfidence) ? 1 + tail[k] : 1.0F);
      const auto slow_share = static_cast<float>(kSlowNoiseShare), white_share = static_cast<float>(kWhiteNoiseShare);
      const float dx = sigma * (slow_share * slow_x[k] + white_share * white()) + offset_x[k];
      const float dy = sigma * (slow_share * slow_y[k] + white_share * white()) + offset_y[k];
      const Vector3f& p = scene.detected[At(t, k)];
      const size_t i = At(t, k);
      const bool lost = dropout.Uniform() < options.dropout || p.z() < 0.1F * scene.size;
      frames.x[i] = lost ? 0 : p.x() / p.z() + scale * dx;
      frames.y[i] = lost ? 0 : p.y() / p.z() + scale * dy;
      frames.confidence[i] = lost ? 0 : confidence;
    }
  }
  Swap(options, HashRandom(seed, {kSwaps, 0}), &frames);
  DetectorHabits(options, HashRandom(seed, {kDetector, 1}), &frames);
  LoseStretches(options, HashRandom(seed, {kMissing, 0}), &frames);
  CutAtBorder(options, HashRandom(seed, {kMissing, 1}), &frames);
  return frames;
}

}  // namespace bodyloom
