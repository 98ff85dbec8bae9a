// SPDX-License-Identifier: Apache-2.0
#include "data_tools/evaluation/room_physics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <utility>
#include <vector>

#include "data_tools/evaluation/metrics.h"
#include "geometry/base/check.h"
#include "geometry/base/percentile.h"
#include "geometry/base/units.h"
#include "geometry/body/balance.h"
#include "geometry/body/centre_of_mass.h"
#include "geometry/body/posed_body.h"
#include "geometry/body/skinning.h"

namespace bodyloom {

using Eigen::RowVector3d;
using Eigen::Vector3d;

namespace {

constexpr double kContactM = 0.04, kTouchingM = 0.02, kPenetrationM = 0.02;
constexpr double kStandingKneeM = 0.25;  // who kneels has them below half a shank
constexpr double kStep_s = 1;            // from the time at which one foot is on another level until all of the body is
constexpr int kFramesAtOnce = 64;

/// Parts of the surface, by the joint with the largest skinning weight.
enum class SurfacePart : uint8_t { kLeftFoot, kRightFoot, kLeg, kAbove };

std::vector<SurfacePart> PartsOf(const BodyModel& body) {
  std::vector<SurfacePart> of_joint(static_cast<size_t>(body.num_joints()), SurfacePart::kAbove);
  const std::pair<const char*, SurfacePart> named[] = {
      {"l_hip", SurfacePart::kLeg},         {"r_hip", SurfacePart::kLeg},        {"l_knee", SurfacePart::kLeg},
      {"r_knee", SurfacePart::kLeg},        {"l_ankle", SurfacePart::kLeftFoot}, {"l_foot", SurfacePart::kLeftFoot},
      {"r_ankle", SurfacePart::kRightFoot}, {"r_foot", SurfacePart::kRightFoot}};
  for (const auto& [name, part] : named) {
    const int joint = body.FindJoint(name);
    if (joint >= 0) of_joint[static_cast<size_t>(joint)] = part;
  }
  std::vector<SurfacePart> parts(static_cast<size_t>(body.num_vertices()));
  for (int v = 0; v < body.num_vertices(); ++v) {
    const int begin = body.influence_begin()[v], end = body.influence_begin()[v + 1];
    int heaviest = begin;
    for (int k = begin; k < end; ++k) {
      if (body.influence_weight()[k] > body.influence_weight()[heaviest]) heaviest = k;
    }
    parts[static_cast<size_t>(v)] = of_joint[static_cast<size_t>(body.influence_joint()[heaviest])];
  }
  return parts;
}

/// Heights, slides and supports of the frames that have a result, frame by frame.
class Surface {
 public:
  Surface(const Track& track, const BodyModel& body, int num_threads)
      : track_(track),
        body_(body),
        skinner_(body, OptionsFor(num_threads)),
        parts_(PartsOf(body)),
        mass_(MassByJoint(body)),
        knees_{body.FindJoint("l_knee"), body.FindJoint("r_knee")},
        neck_(body.FindJoint("neck")) {
    for (int t = 0; t < track.num_frames(); ++t) {
      if (track.HasResult(t)) frames_.push_back(t);
    }
  }

  void Measure() {
    const ShapedBody shaped = skinner_.Shape(track_.motion.betas);
    const size_t size = 3 * static_cast<size_t>(skinner_.num_vertices());
    std::vector<double> vertices;
    std::vector<BodyPose> poses;
    for (size_t begin = 0; begin < frames_.size(); begin += kFramesAtOnce) {
      const size_t end = std::min(frames_.size(), begin + kFramesAtOnce);
      poses.clear();
      for (size_t i = begin; i < end; ++i) {
        const Motion& motion = track_.motion;
        poses.push_back(PoseFromAxisAngle(body_, motion.poses.row(frames_[i]).transpose(),
                                          motion.trans.row(frames_[i]).transpose()));
      }
      vertices.resize(size * poses.size());
      skinner_.Skin(shaped, poses, vertices);
      for (size_t i = 0; i < poses.size(); ++i) {
        Add(begin + i, Eigen::Map<const MatrixX3d>(&vertices[size * i], body_.num_vertices(), 3));
        if (mass_.size() > 0) AddSupport(begin + i, PoseSkeleton(body_, shaped.rest_joints, poses[i]).joints);
      }
    }
    if (track_.level_m.size() > 0) StepBetweenLevels();
  }

  [[nodiscard]] const std::vector<double>& heights() const { return heights_; }
  [[nodiscard]] const std::vector<double>& slides() const { return slides_; }
  /// One for each frame; none where the body lacks a joint that its centre of mass needs.
  [[nodiscard]] const std::vector<SupportedFrame>& supports() const { return supports_; }
  /// Angles of the trunk to the vertical in frames in which the person stands on both feet, degrees.
  [[nodiscard]] const std::vector<double>& leans() const { return leans_; }
  [[nodiscard]] double SecondsAt(size_t i) const { return track_.motion.timestamps[frames_[i]]; }
  /// The level on which the body touches something in frame i, if it does.
  [[nodiscard]] double SupportingLevelAt(size_t i) const { return supporting_m_.empty() ? 0 : supporting_m_[i]; }
  [[nodiscard]] double LevelAt(size_t i) const { return track_.LevelAt(frames_[i]); }
  /// Frame i comes right after the one before it.
  [[nodiscard]] bool Continues(size_t i) const { return i > 0 && frames_[i] == frames_[i - 1] + 1; }

 private:
  static SkinnerOptions OptionsFor(int num_threads) {
    SkinnerOptions options;
    options.num_threads = num_threads;
    return options;
  }
  void Add(size_t i, const MatrixX3d& in_camera) {
    MatrixX3d now = track_.world->PointsFromCamera(in_camera);
    now.col(1).array() -= LevelAt(i);
    heights_.push_back(now.col(1).minCoeff());
    if (track_.level_m.size() > 0) AddFeet(now);
    if (Continues(i)) {
      std::vector<double> speeds;
      const double seconds = SecondsAt(i) - SecondsAt(i - 1);
      for (Eigen::Index v = 0; v < now.rows(); ++v) {
        if (std::max(std::abs(now(v, 1)), std::abs(last_(v, 1))) > kTouchingM) continue;
        speeds.push_back(std::hypot(now(v, 0) - last_(v, 0), now(v, 2) - last_(v, 2)) / seconds);
      }
      if (!speeds.empty()) slides_.push_back(Percentile(speeds, 50));
    }
    last_ = std::move(now);
  }
  /// After Add() of the same frame.
  void AddSupport(size_t i, const MatrixX3d& joints_in_camera) {
    MatrixX3d joints = track_.world->PointsFromCamera(joints_in_camera);
    joints.col(1).array() -= LevelAt(i);
    const bool same_level = i == 0 || LevelAt(i) == LevelAt(i - 1);
    SupportedFrame frame{SecondsAt(i), CentreOfMass(joints, mass_), {}, Continues(i) && same_level};
    std::array<bool, 4> touches{};
    for (Eigen::Index v = 0; v < last_.rows(); ++v) {
      if (last_(v, 1) > kContactM) continue;
      frame.contacts.emplace_back(last_(v, 0), last_(v, 2));
      touches[static_cast<size_t>(parts_[static_cast<size_t>(v)])] = true;
    }
    supports_.push_back(std::move(frame));
    const auto touching = [&](SurfacePart part) { return touches[static_cast<size_t>(part)]; };
    const bool stands = touching(SurfacePart::kLeftFoot) && touching(SurfacePart::kRightFoot) &&
                        !touching(SurfacePart::kAbove) &&
                        std::min(joints(knees_[0], 1), joints(knees_[1], 1)) > kStandingKneeM;
    if (!stands) return;
    const RowVector3d trunk = joints.row(neck_) - joints.row(0);
    leans_.push_back(std::atan2(std::hypot(trunk.x(), trunk.z()), trunk.y()) / kDegree);
  }

  void AddFeet(const MatrixX3d& vertices) {
    std::array<double, 2>& feet = feet_.emplace_back();
    feet.fill(std::numeric_limits<double>::infinity());
    for (Eigen::Index v = 0; v < vertices.rows(); ++v) {
      const auto part = static_cast<size_t>(parts_[static_cast<size_t>(v)]);
      if (part < feet.size()) feet[part] = std::min(feet[part], vertices(v, 1));
    }
  }
  /// Heights of frames near a change of level.
  void StepBetweenLevels() {
    for (size_t i = 0; i < frames_.size(); ++i) supporting_m_.push_back(LevelAt(i));
    for (size_t i = 0; i < frames_.size(); ++i) {
      double lowest_step = 0;  // of the other level over that of the frame
      for (const double step : {StepBefore(i), StepAfter(i)}) {
        lowest_step = std::min(lowest_step, step);
        if (step == 0 || heights_[i] <= kContactM) continue;
        for (const double foot : feet_[i]) {
          if (std::abs(foot - step) > kContactM) continue;
          heights_[i] = foot - step;
          supporting_m_[i] = LevelAt(i) + step;
        }
      }
      if (heights_[i] < 0) heights_[i] = std::min(0.0, heights_[i] - lowest_step);
    }
  }
  /// Height of the level before the last change of it over that of frame i; 0 without one within kStep_s.
  [[nodiscard]] double StepBefore(size_t i) const {
    for (size_t k = i; k > 0 && Continues(k) && SecondsAt(i) - SecondsAt(k - 1) <= kStep_s; --k) {
      if (LevelAt(k - 1) != LevelAt(i)) return LevelAt(k - 1) - LevelAt(i);
    }
    return 0;
  }
  [[nodiscard]] double StepAfter(size_t i) const {
    for (size_t k = i + 1; k < frames_.size() && Continues(k) && SecondsAt(k) - SecondsAt(i) <= kStep_s; ++k) {
      if (LevelAt(k) != LevelAt(i)) return LevelAt(k) - LevelAt(i);
    }
    return 0;
  }

  const Track& track_;
  const BodyModel& body_;
  Skinner skinner_;
  std::vector<SurfacePart> parts_;
  Eigen::VectorXd mass_;  ///< by joint; empty: the body has other joints
  std::array<int, 2> knees_;
  int neck_;
  std::vector<int> frames_;
  std::vector<double> heights_, slides_, leans_;
  std::vector<double> supporting_m_;         ///< of tracks with several levels
  std::vector<std::array<double, 2>> feet_;  ///< lowest points over the level; of tracks with several levels
  std::vector<SupportedFrame> supports_;
  MatrixX3d last_;
};

/// Number of frames that are higher than a flight between the surrounding contacts allows.
int CountUnexplained(const Surface& surface) {
  const std::vector<double>& h = surface.heights();
  int count = 0;
  for (size_t begin = 0; begin < h.size();) {
    if (h[begin] <= kContactM) {
      ++begin;
      continue;
    }
    size_t end = begin + 1;
    while (end < h.size() && h[end] > kContactM && surface.Continues(end)) ++end;
    const size_t before = surface.Continues(begin) ? begin - 1 : begin,
                 after = end < h.size() && surface.Continues(end) ? end : end - 1;
    const double from = surface.SecondsAt(before), to = surface.SecondsAt(after);
    const double left = surface.SupportingLevelAt(before), rise = surface.SupportingLevelAt(after) - left;
    for (size_t i = begin; i < end; ++i) {
      const double t = surface.SecondsAt(i);
      const double chord = rise == 0 ? left : left + rise * (t - from) / (to - from);
      if (h[i] > kContactM + (chord - surface.SupportingLevelAt(i)) + RiseInFlight(t - from, to - t)) ++count;
    }
    begin = end;
  }
  return count;
}

}  // namespace

std::string RoomPhysics::BriefReport() const {
  if (frames == 0) return "";
  char text[160];
  std::snprintf(text, sizeof(text),
                "on the ground or in flight in %.0f %% of the frames, within %.0f mm below it in 95 %%",
                100 * (1 - unexplained_hover_share), kMmPerMetre * penetration_p95_m);
  std::string line = text;
  if (other_level_share > 0) {
    std::snprintf(text, sizeof(text), ", on other levels in %.0f %%", 100 * other_level_share);
    line += text;
  }
  if (!std::isnan(contact_slide_mps)) {
    std::snprintf(text, sizeof(text), ", contacts slide %.2f m/s", contact_slide_mps);
    line += text;
  }
  if (balance_measured_share >= 0.1) {
    std::snprintf(text, sizeof(text), ", off balance in %.0f %% of the slow frames", 100 * balance_outside_share);
    line += text;
  }
  if (!std::isnan(lean_median_deg)) {
    std::snprintf(text, sizeof(text), ", leans %.0f deg on both feet", lean_median_deg);
    line += text;
  }
  return line;
}

RoomPhysics MeasureRoomPhysics(const Track& track, const BodyModel& body, int num_threads) {
  BODYLOOM_CHECK(track.world.has_value(), "room physics: the track states no world");
  Surface surface(track, body, num_threads);
  surface.Measure();
  const std::vector<double>& heights = surface.heights();
  RoomPhysics physics;
  physics.frames = static_cast<int>(heights.size());
  physics.contact_slide_mps = Percentile(surface.slides(), 50);
  const Balance balance = MeasureBalance(surface.supports());
  physics.balance_measured_share = physics.frames > 0 ? static_cast<double>(balance.frames) / physics.frames : 0;
  physics.balance_outside_share = balance.outside_share;
  physics.balance_p95_m = balance.outside_p95_m;
  physics.lean_median_deg = Percentile(surface.leans(), 50);
  if (heights.empty()) {
    physics.hover_share = physics.unexplained_hover_share = physics.lowest_point_m = kNotMeasured;
    physics.penetration_p95_m = physics.penetration_share = kNotMeasured;
    return physics;
  }
  const auto count = static_cast<double>(heights.size());
  std::vector<double> depths;
  int hovers = 0, penetrates = 0, on_other_levels = 0;
  for (size_t i = 0; i < heights.size(); ++i) on_other_levels += surface.LevelAt(i) != 0;
  for (const double height : heights) {
    depths.push_back(std::max(0.0, -height));
    hovers += height > kContactM;
    penetrates += height < -kPenetrationM;
  }
  physics.hover_share = hovers / count;
  physics.unexplained_hover_share = CountUnexplained(surface) / count;
  physics.other_level_share = on_other_levels / count;
  physics.lowest_point_m = Percentile(heights, 50);
  physics.penetration_p95_m = Percentile(depths, 95);
  physics.penetration_share = penetrates / count;
  return physics;
}

RoomPhysics RoomPhysicsOnGround(const Track& track, const BodyModel& body, int num_threads) {
  const bool has_ground =
      track.world && track.world->source != WorldSource::kLevelCamera && track.world->source != WorldSource::kVertical;
  return has_ground ? MeasureRoomPhysics(track, body, num_threads) : RoomPhysics();
}

void AddRoomPhysics(const RoomPhysics& physics, Evaluation* evaluation) {
  const auto add = [&](const char* name, double value, const char* meaning) { evaluation->Add(name, value, meaning); };
  add("hover_percent", 100 * physics.hover_share, "frames whose lowest point is above 4 cm over the stated ground");
  add("hover_unexplained_percent", 100 * physics.unexplained_hover_share,
      "of all frames, those that no flight explains");
  if (physics.other_level_share > 0) {
    add("other_level_percent", 100 * physics.other_level_share, "frames on another level than the ground");
  }
  add("lowest_point_mm", kMmPerMetre * physics.lowest_point_m, "median height of the lowest point of the surface");
  add("ground_penetration_p95_mm", kMmPerMetre * physics.penetration_p95_m,
      "95th percentile of its depth below the ground");
  add("ground_penetration_percent", 100 * physics.penetration_share, "frames in which it is below 2 cm");
  add("contact_slide_mps", physics.contact_slide_mps, "median speed along the ground of what touches it, m/s");
  add("balance_measured_percent", 100 * physics.balance_measured_share,
      "slow frames on the ground, whose balance is measured");
  add("balance_outside_percent", 100 * physics.balance_outside_share,
      "of these, those whose zero-moment point is 5 cm outside what supports the body");
  add("balance_p95_mm", kMmPerMetre * physics.balance_p95_m, "95th percentile of how far it is outside");
  add("lean_median_deg", physics.lean_median_deg, "median angle of the trunk to the vertical while on both feet");
}

}  // namespace bodyloom
