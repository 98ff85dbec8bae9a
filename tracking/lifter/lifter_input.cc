// SPDX-License-Identifier: Apache-2.0
#include "tracking/lifter/lifter_input.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "geometry/base/check.h"
#include "geometry/scene/observations.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kMaxCoordinate = 4, kMaxMotion = 2;  // limits the influence of a wrong detection on the window
constexpr float kMinCosine = 0.1F;                   // 84° off the virtual camera's axis
constexpr float kMinScale = 1e-3F;                   // a person more than a kilometre away
constexpr float kDefaultScale = 0.27F;               // about five metres away: log S + 1.3 = 0
constexpr float kScalePercentile = 0.85F;

// Lengths in the mean body, in units of its torso + leg (the built-in body's landmarks; a test holds them to it).
constexpr float kTorsoShare = 0.383F, kLegShare = 1 - kTorsoShare;
constexpr float kThighShare = 0.292F, kShinShare = 0.325F;

struct Part {
  int from, to;
  float share;
};
// Parts that give the size when neither torso nor legs are seen. Parts of the head come last: they are short, so noise
// easily doubles them.
constexpr Part kSizeParts[] = {
    {kLifterLeftShoulder, kLifterLeftShoulder + 1, 0.269F},  {kLifterLeftShoulder, kLifterLeftElbow, 0.186F},
    {kLifterLeftShoulder + 1, kLifterLeftElbow + 1, 0.186F}, {kLifterLeftElbow, kLifterLeftWrist, 0.183F},
    {kLifterLeftElbow + 1, kLifterLeftWrist + 1, 0.183F},
};
constexpr Part kHeadParts[] = {
    {kLifterNose, kLifterLeftEar, 0.122F},
    {kLifterNose, kLifterLeftEar + 1, 0.122F},
    {kLifterLeftEar, kLifterLeftEar + 1, 0.105F},
};

struct Bone {
  int from, to;
  bool middles;  ///< from the middle of a pair to the middle of another
};
// Left bones are followed by their right ones; those of the middle come last.
constexpr Bone kBones[kLifterBones] = {
    {kLifterLeftShoulder, kLifterLeftElbow, false},
    {kLifterLeftShoulder + 1, kLifterLeftElbow + 1, false},
    {kLifterLeftElbow, kLifterLeftWrist, false},
    {kLifterLeftElbow + 1, kLifterLeftWrist + 1, false},
    {kLifterLeftHip, kLifterLeftKnee, false},
    {kLifterLeftHip + 1, kLifterLeftKnee + 1, false},
    {kLifterLeftKnee, kLifterLeftAnkle, false},
    {kLifterLeftKnee + 1, kLifterLeftAnkle + 1, false},
    {kLifterLeftShoulder, kLifterLeftShoulder + 1, false},
    {kLifterLeftHip, kLifterLeftHip + 1, false},
    {kLifterLeftShoulder, kLifterLeftHip, true},
};
constexpr int kPairedBones = 8;
constexpr float kBonePercentile = 0.9F;

/// One frame in its virtual camera.
struct Frame {
  std::array<Vector2f, kLifterPoints> point;
  std::array<bool, kLifterPoints> seen{};
  [[nodiscard]] float Distance(int a, int b) const { return (point[a] - point[b]).norm(); }
};

/// Mean of the seen ones of a left–right pair.
std::optional<Vector2f> Middle(const Frame& frame, int left) {
  if (frame.seen[left] && frame.seen[left + 1]) return Vector2f(0.5F * (frame.point[left] + frame.point[left + 1]));
  if (frame.seen[left]) return frame.point[left];
  if (frame.seen[left + 1]) return frame.point[left + 1];
  return std::nullopt;
}

std::optional<float> TorsoLength(const Frame& frame) {
  const auto shoulder = Middle(frame, kLifterLeftShoulder), hip = Middle(frame, kLifterLeftHip);
  if (!shoulder || !hip) return std::nullopt;
  return (*shoulder - *hip).norm();
}

/// Mean thigh + shin of the legs seen whole; else from the thighs or shins that are seen.
std::optional<float> LegLength(const Frame& frame) {
  float whole = 0, part = 0;
  int num_whole = 0, num_parts = 0;
  for (int side = 0; side < 2; ++side) {
    const int hip = kLifterLeftHip + side, knee = kLifterLeftKnee + side, ankle = kLifterLeftAnkle + side;
    if (!frame.seen[knee]) continue;
    const float thigh = frame.seen[hip] ? frame.Distance(hip, knee) : 0;
    const float shin = frame.seen[ankle] ? frame.Distance(knee, ankle) : 0;
    if (frame.seen[hip] && frame.seen[ankle]) {
      whole += thigh + shin;
      ++num_whole;
    } else if (frame.seen[hip] || frame.seen[ankle]) {
      part += (thigh + shin) * kLegShare / (frame.seen[hip] ? kThighShare : kShinShare);
      ++num_parts;
    }
  }
  if (num_whole > 0) return whole / static_cast<float>(num_whole);
  if (num_parts > 0) return part / static_cast<float>(num_parts);
  return std::nullopt;
}

/// S_t; none when neither torso nor legs are seen.
std::optional<float> BodyScale(const Frame& frame) {
  const auto torso = TorsoLength(frame), leg = LegLength(frame);
  if (torso && leg) return *torso + *leg;
  if (torso) return *torso / kTorsoShare;
  if (leg) return *leg / kLegShare;
  return std::nullopt;
}

/// The largest size that a seen part implies: foreshortening only makes parts look shorter.
std::optional<float> RoughScale(const Frame& frame) {
  for (const std::span<const Part> parts : {std::span<const Part>(kSizeParts), std::span<const Part>(kHeadParts)}) {
    float scale = 0;
    for (const Part& part : parts) {
      if (frame.seen[part.from] && frame.seen[part.to])
        scale = std::max(scale, frame.Distance(part.from, part.to) / part.share);
    }
    if (scale > 0) return scale;
  }
  return std::nullopt;
}

/// For each frame the percentile of the known values within the window; unknown where there are none.
std::vector<std::optional<float>> WindowPercentile(const std::vector<std::optional<float>>& values, float percentile) {
  constexpr int kReach = (kLifterScaleFrames - 1) / 2;
  const int T = static_cast<int>(values.size());
  std::vector<std::optional<float>> result(T);
  std::vector<float> sorted;
  sorted.reserve(kLifterScaleFrames);
  int end = 0;  // frames before `end` have entered
  for (int t = 0; t < T; ++t) {
    for (; end < std::min(T, t + kReach + 1); ++end) {
      if (values[end]) sorted.insert(std::upper_bound(sorted.begin(), sorted.end(), *values[end]), *values[end]);
    }
    const int leaving = t - kReach - 1;
    if (leaving >= 0 && values[leaving]) {
      sorted.erase(std::lower_bound(sorted.begin(), sorted.end(), *values[leaving]));
    }
    if (sorted.empty()) continue;
    const float at = percentile * static_cast<float>(sorted.size() - 1);
    const size_t below = static_cast<size_t>(at), above = std::min(below + 1, sorted.size() - 1);
    const float part = at - static_cast<float>(below);
    result[t] = (1 - part) * sorted[below] + part * sorted[above];
  }
  return result;
}

/// Length of a bone in a frame, divided by S.
std::optional<float> BoneLength(const Frame& frame, const Bone& bone, float scale) {
  float length = 0;
  if (bone.middles) {
    const auto from = Middle(frame, bone.from), to = Middle(frame, bone.to);
    if (!from || !to) return std::nullopt;
    length = (*from - *to).norm();
  } else {
    if (!frame.seen[bone.from] || !frame.seen[bone.to]) return std::nullopt;
    length = frame.Distance(bone.from, bone.to);
  }
  return std::min(length / scale, kMaxCoordinate);
}

/// Writes extent in depth and full length of every frame and bone to features + stride·t + 2·bone.
void Foreshortening(const std::vector<Frame>& frames, const std::vector<float>& scale, size_t stride, float* features) {
  const size_t T = frames.size();
  std::array<std::vector<std::optional<float>>, kLifterBones> length, full;
  for (int b = 0; b < kLifterBones; ++b) {
    for (size_t t = 0; t < T; ++t) length[b].push_back(BoneLength(frames[t], kBones[b], scale[t]));
    full[b] = WindowPercentile(length[b], kBonePercentile);
  }
  for (int b = 0; b < kLifterBones; ++b) {
    for (size_t t = 0; t < T; ++t) {
      if (!length[b][t]) continue;
      float m = *full[b][t];
      if (b < kPairedBones && full[b ^ 1][t]) m = std::max(m, *full[b ^ 1][t]);
      const float l = *length[b][t];
      float* out = features + stride * t + 2 * static_cast<size_t>(b);
      out[0] = std::sqrt(std::max(0.0F, m * m - l * l));
      out[1] = m;
    }
  }
}

/// S of every frame: from the window, else the rough guess of the window, else that of the nearest frame that has one.
std::vector<float> WindowScale(const std::vector<std::optional<float>>& body,
                               const std::vector<std::optional<float>>& rough) {
  std::vector<std::optional<float>> scale = WindowPercentile(body, kScalePercentile);
  const int T = static_cast<int>(scale.size());
  if (std::any_of(scale.begin(), scale.end(), [](const auto& s) { return !s; })) {
    const std::vector<std::optional<float>> other = WindowPercentile(rough, kScalePercentile);
    for (int t = 0; t < T; ++t) {
      if (!scale[t]) scale[t] = other[t];
    }
  }
  std::vector<int> nearest(T, -1);
  for (int t = 0, last = -1; t < T; ++t) nearest[t] = last = scale[t] ? t : last;
  for (int t = T - 1, next = -1; t >= 0; --t) {
    if (scale[t]) next = t;
    if (next >= 0 && (nearest[t] < 0 || next - t < t - nearest[t])) nearest[t] = next;
  }
  std::vector<float> result(T, kDefaultScale);
  for (int t = 0; t < T; ++t) {
    if (nearest[t] >= 0) result[t] = std::max(kMinScale, *scale[nearest[t]]);
  }
  return result;
}

/// The smallest rotation that takes the optical axis to a unit direction in front of the camera.
Matrix3f TurnAxisTo(const Vector3f& direction) {
  const float x = direction.x(), y = direction.y(), z = direction.z(), k = 1 / (1 + z);
  Matrix3f R;
  R << 1 - k * x * x, -k * x * y, x,  //
      -k * x * y, 1 - k * y * y, y,   //
      -x, -y, z;
  return R;
}

/// Fills the gaps between seen frames with directions in between, and repeats the first and last ones outwards.
void FillDirections(const std::vector<char>& seen, std::vector<Vector3f>* directions) {
  const int T = static_cast<int>(seen.size());
  int last = -1;
  for (int t = 0; t <= T; ++t) {
    if (t < T && !seen[t]) continue;
    for (int gap = last + 1; gap < t; ++gap) {
      Vector3f& d = (*directions)[gap];
      if (last < 0 && t == T) {
        d = Vector3f::UnitZ();
      } else if (last < 0 || t == T) {
        d = (*directions)[last < 0 ? t : last];
      } else {
        const float part = static_cast<float>(gap - last) / static_cast<float>(t - last);
        d = ((1 - part) * (*directions)[last] + part * (*directions)[t]).normalized();
      }
    }
    last = t;
  }
}

/// Usable detections as unit directions, and the middle of the body in every frame.
struct LifterRays {
  std::vector<char> usable;      ///< T·21
  std::vector<Vector3f> ray;     ///< T·21
  std::vector<char> seen;        ///< T
  std::vector<Vector3f> centre;  ///< T
};

LifterRays MakeLifterRays(const LifterFrames& frames) {
  const int T = frames.num_frames;
  const size_t N = static_cast<size_t>(std::max(T, 0)) * kLifterPoints;
  BODYLOOM_CHECK(T >= 0 && frames.x.size() == N && frames.y.size() == N && frames.confidence.size() == N,
                 "lifter input: ", T, " frames need ", N, " values each of x, y and confidence, got ", frames.x.size(),
                 ", ", frames.y.size(), " and ", frames.confidence.size());
  LifterRays rays;
  rays.usable.resize(N);
  rays.ray.resize(N);
  rays.seen.assign(T, 0);
  rays.centre.assign(T, Vector3f::UnitZ());
  for (int t = 0; t < T; ++t) {
    Vector3f middle = Vector3f::Zero(), all = Vector3f::Zero();
    int num_middle = 0;
    for (int k = 0; k < kLifterPoints; ++k) {
      const size_t i = static_cast<size_t>(t) * kLifterPoints + k;
      rays.usable[i] = std::isfinite(frames.x[i]) && std::isfinite(frames.y[i]) && frames.confidence[i] > 0;
      if (!rays.usable[i]) continue;
      // In double: the square of a large finite float is not finite.
      const double x = frames.x[i], y = frames.y[i];
      rays.ray[i] = (Eigen::Vector3d(x, y, 1) / std::sqrt(x * x + y * y + 1)).cast<float>();
      rays.seen[t] = 1;
      all += rays.ray[i];
      if (k != kLifterLeftShoulder && k != kLifterLeftShoulder + 1 && k != kLifterLeftHip && k != kLifterLeftHip + 1)
        continue;
      middle += rays.ray[i];
      ++num_middle;
    }
    const Vector3f& sum = num_middle >= 2 ? middle : all;
    // LifterRays a quarter turn to both sides could cancel.
    if (rays.seen[t]) rays.centre[t] = sum.norm() > 1e-6F ? sum.normalized() : Vector3f::UnitZ();
  }
  FillDirections(rays.seen, &rays.centre);
  return rays;
}

}  // namespace

const std::vector<std::string>& LifterPointNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = CocoNames();
    for (const char* name : {"left_big_toe", "right_big_toe", "left_heel", "right_heel"}) all.emplace_back(name);
    return all;
  }();
  return names;
}

LifterInput MakeLifterInput(const LifterFrames& frames) {
  const LifterRays rays = MakeLifterRays(frames);
  const int T = frames.num_frames;
  LifterInput input;
  input.seen = rays.seen;
  input.camera_from_virtual.resize(T);
  std::vector<Frame> seen_frames(T);
  std::vector<std::optional<float>> body_scale(T), rough_scale(T);
  for (int t = 0; t < T; ++t) {
    const Matrix3f& R = input.camera_from_virtual[t] = TurnAxisTo(rays.centre[t]);
    Frame& frame = seen_frames[t];
    for (int k = 0; k < kLifterPoints; ++k) {
      const size_t i = static_cast<size_t>(t) * kLifterPoints + k;
      if (!rays.usable[i]) continue;
      const Vector3f v = R.transpose() * rays.ray[i];
      if (v.z() < kMinCosine) continue;
      frame.point[k] = v.head<2>() / v.z();
      frame.seen[k] = true;
    }
    body_scale[t] = BodyScale(frame);
    rough_scale[t] = RoughScale(frame);
  }
  input.scale = WindowScale(body_scale, rough_scale);

  input.features.assign(static_cast<size_t>(T) * kLifterInputs, 0);
  for (int t = 0; t < T; ++t) {
    float* out = &input.features[static_cast<size_t>(t) * kLifterInputs];
    const float S = input.scale[t];
    for (int k = 0; k < kLifterPoints; ++k) {
      if (!seen_frames[t].seen[k]) continue;
      const Vector2f& p = seen_frames[t].point[k];
      out[3 * k] = std::clamp(p.x() / S, -kMaxCoordinate, kMaxCoordinate);
      out[3 * k + 1] = std::clamp(p.y() / S, -kMaxCoordinate, kMaxCoordinate);
      out[3 * k + 2] = std::min(frames.confidence[static_cast<size_t>(t) * kLifterPoints + k], 1.0F);
    }
    float* more = out + 3 * kLifterPoints;
    more[0] = frames.focal_known ? std::log(S) + 1.3F : 0;
    more[1] = frames.focal_known ? 1 : 0;
    more[2] = body_scale[t] ? std::min(*body_scale[t] / S - 0.9F, kMaxCoordinate) : 0;
    if (t == 0 || !input.seen[t] || !input.seen[t - 1]) continue;
    const Vector3f before = input.camera_from_virtual[t].transpose() * rays.centre[t - 1];
    const float depth = std::max(before.z(), kMinCosine);
    for (int c = 0; c < 2; ++c) more[3 + c] = std::clamp(-before[c] / depth / S, -kMaxMotion, kMaxMotion);
  }
  if (T > 0) Foreshortening(seen_frames, input.scale, kLifterInputs, &input.features[3 * kLifterPoints + 5]);
  return input;
}

int MirroredLifterBone(int bone) { return bone < kPairedBones ? bone ^ 1 : bone; }

std::vector<Matrix3f> LifterVirtualCameras(const LifterFrames& frames) {
  const LifterRays rays = MakeLifterRays(frames);
  std::vector<Matrix3f> cameras(frames.num_frames);
  std::transform(rays.centre.begin(), rays.centre.end(), cameras.begin(), TurnAxisTo);
  return cameras;
}

float LifterReferenceLength(std::span<const float> points) {
  BODYLOOM_CHECK(points.size() == 3 * static_cast<size_t>(kLifterPoints), "lifter: a body has ", 3 * kLifterPoints,
                 " coordinates, got ", points.size());
  const auto at = [&](int k) { return Vector3f(points[3 * k], points[3 * k + 1], points[3 * k + 2]); };
  const auto middle = [&](int left) { return Vector3f(0.5F * (at(left) + at(left + 1))); };
  float length = (middle(kLifterLeftShoulder) - middle(kLifterLeftHip)).norm();
  for (int side = 0; side < 2; ++side) {
    const Vector3f knee = at(kLifterLeftKnee + side);
    length += 0.5F * ((at(kLifterLeftHip + side) - knee).norm() + (knee - at(kLifterLeftAnkle + side)).norm());
  }
  return length;
}

}  // namespace bodyloom
