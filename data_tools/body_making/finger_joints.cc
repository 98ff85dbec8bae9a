// SPDX-License-Identifier: Apache-2.0
#include "data_tools/body_making/finger_joints.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "data_tools/body_making/left_half_arrays.h"
#include "data_tools/body_making/pose_correctives.h"
#include "geometry/base/check.h"
#include "geometry/body/hand_skeleton.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;

constexpr int kThumb = 4;  // in FingerNames()
constexpr int kFirstFingerJoint = 22, kLeftWrist = 20, kLeftHand = 22;
constexpr int kSteps = 8;  // rings of a tube after its first: four for each of its two cage segments

/// Lengths of the three bones of a digit and of the soft tissue at its tip, mm: means of adults' radiographs.
/// Source: Buryanov and Kotiuk, "Proportions of hand segments", Int. J. Morphol. 28(3), 2010.
constexpr std::array<std::array<double, 4>, 5> kBones_mm = {{{39.78, 22.38, 15.82, 3.84},
                                                             {44.63, 26.33, 17.40, 3.95},
                                                             {32.74, 18.11, 15.96, 3.73},
                                                             {41.37, 25.65, 17.30, 3.95},
                                                             {46.22, 31.57, 21.67, 5.67}}};
/// A knuckle lies at its tube's first ring, where MakeHuman's rig has it, this share of the way from the ring's mean to
/// its dorsal side: 8 mm below the skin.
constexpr double kKnuckleLift = 0.25;
/// The thumb's CMC, on the way from its tube's first ring to the wrist's.
constexpr double kThumbRootShare = 0.2;
/// From it the thumb's line goes straight to this ring, because a metacarpal is straight.
constexpr int kThumbLine = 3;

/// Half widths of the steps of weights across joints 1, 2, 3, metres.
constexpr std::array<double, 3> kFingerStep_m = {0.013, 0.011, 0.0085}, kThumbStep_m = {0.016, 0.011, 0.008};
/// Standard deviation of the share of neighbouring knuckles, by their distance to the side.
constexpr double kKnuckleSpread_m = 0.006;
/// The thumb's metacarpal moves palm vertices fully up to the first distance from it, not beyond the second.
constexpr double kThenarInner_m = 0.013, kThenarOuter_m = 0.032;
constexpr int kSmoothings = 4;
constexpr int kMaxInfluences = 4;

/// 0 below −half_width, 1 above half_width, smooth between.
double Step(double x, double half_width) {
  const double t = std::clamp(0.5 + 0.5 * x / half_width, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// A weighted sum of vertices.
using Functional = std::map<int, double>;

Functional Mix(const Functional& a, const Functional& b, double share_of_b) {
  Functional mixed;
  for (const auto& [v, weight] : a) mixed[v] += (1 - share_of_b) * weight;
  for (const auto& [v, weight] : b) mixed[v] += share_of_b * weight;
  return mixed;
}

Functional MeanOf(const std::vector<int>& vertices) {
  Functional mean;
  for (const int v : vertices) mean[v] += 1.0 / static_cast<double>(vertices.size());
  return mean;
}

Vector3d At(const Functional& functional, const MatrixX3d& vertices) {
  Vector3d point = Vector3d::Zero();
  for (const auto& [v, weight] : functional) point += weight * vertices.row(v).transpose();
  return point;
}

/// One finger of the left hand.
struct Finger {
  std::map<int, double> along;              ///< vertices of the tube: 0 at its first ring, kSteps from its last on
  std::array<Functional, kSteps + 1> ring;  ///< means of its rings
  Functional dorsal;                        ///< mean of the back of the first ring
  int tip = -1;
  std::array<Functional, 3> joint;
  std::array<Vector3d, 3> at;    ///< joints of the mean shape
  std::array<Vector3d, 3> bone;  ///< unit directions to the next joint or the tip
};

class LeftHand {
 public:
  LeftHand(const Cage& cage, const RefinedCage& refined, const BodyModelData& body)
      : cage_(cage), refined_(refined), body_(body) {
    for (int v = 0; v < cage.num_left_vertices; ++v) index_of_[cage.vertex_names[v]] = v;
    for (int f = 0; f < 5; ++f) MakeFinger(f);
    MakeWeights();
  }

  [[nodiscard]] const std::array<Finger, 5>& fingers() const { return fingers_; }
  /// Of vertices that wrist or hand moves: the shares of the finger joints; the wrist has the rest.
  [[nodiscard]] const std::map<int, std::array<double, kHandJoints>>& shares() const { return shares_; }

 private:
  int Named(const std::string& name) const {
    const auto found = index_of_.find(name);
    BODYLOOM_CHECK(found != index_of_.end(), "finger joints: the cage has no vertex '", name, "'");
    return found->second;
  }

  [[nodiscard]] Vector3d Vertex(int v) const { return body_.v_template.row(v); }

  void MakeFinger(int f) {
    // The four columns of a tube: dorsal, dorsal, palm, palm.
    static constexpr std::array<int, 5> kTube = {0, 1, 3, 2, -1};
    Finger& finger = fingers_[f];
    std::array<std::string, 4> base = {"p0", "mt", "mb", "q0"};
    std::string tube = "Th";
    if (f != kThumb) {
      const std::string n = std::to_string(kTube[f]), next = std::to_string(kTube[f] + 1);
      base = {"h" + n, "h" + next, "u" + next, "u" + n};
      tube = "F" + n;
    }
    Eigen::VectorXd along = Eigen::VectorXd::Constant(refined_.bilinear_from_cage.cols(), -1);
    for (int k = 0; k < 4; ++k) {
      along[Named(base[k])] = 0;
      along[Named(tube + "M" + std::to_string(k))] = 0.5 * kSteps;
      along[Named(tube + "T" + std::to_string(k))] = kSteps;
    }
    const Eigen::VectorXd fine_along = refined_.bilinear_from_cage * along;
    std::array<std::set<int>, kSteps + 1> rings;
    for (int q = 0; q < cage_.num_left_quads; ++q) {
      const Quad& quad = cage_.quads[q];
      if (std::any_of(quad.begin(), quad.end(), [&](int v) { return along[v] < 0; })) continue;
      const bool cap = std::all_of(quad.begin(), quad.end(), [&](int v) { return along[v] == kSteps; });
      if (cap) finger.tip = static_cast<int>(cage_.vertex_names.size()) + q;  // the quad's face point
      for (int i = 0; i < kQuadsPerCageQuad; ++i) {
        for (const int v : refined_.quads[static_cast<size_t>(kQuadsPerCageQuad) * q + i]) {
          finger.along.emplace(v, fine_along[v]);
          if (!cap) rings[size_t(std::lround(fine_along[v]))].insert(v);
        }
      }
    }
    BODYLOOM_CHECK(finger.tip >= 0, "finger joints: the tube '", tube, "' of the cage has no cap");
    for (int k = 0; k <= kSteps; ++k) finger.ring[k] = MeanOf({rings[k].begin(), rings[k].end()});
    finger.dorsal = MeanOf({Named(base[0]), Named(base[1])});
    PlaceJoints(f, &finger);
  }

  void PlaceJoints(int f, Finger* finger) const {
    std::vector<Functional> line;  // from the first joint to the tip
    if (f == kThumb) {
      std::vector<int> wrist;
      for (int k = 0; k < 8; ++k) wrist.push_back(Named("Wr_" + std::to_string(k)));
      finger->joint[0] = Mix(finger->ring[0], MeanOf(wrist), kThumbRootShare);
      line.push_back(finger->joint[0]);
    } else {
      finger->joint[0] = Mix(finger->ring[0], finger->dorsal, kKnuckleLift);
    }
    line.insert(line.end(), finger->ring.begin() + (f == kThumb ? kThumbLine : 0), finger->ring.end());
    line.push_back({{finger->tip, 1}});
    std::vector<double> length = {0};
    for (size_t i = 1; i < line.size(); ++i) {
      length.push_back(length.back() + (At(line[i], body_.v_template) - At(line[i - 1], body_.v_template)).norm());
    }
    const std::array<double, 4>& bones = kBones_mm[f];
    const double whole = bones[0] + bones[1] + bones[2] + bones[3];
    for (int j = 1; j < 3; ++j) {
      const double s = length.back() * (bones[0] + (j == 2 ? bones[1] : 0)) / whole;
      size_t i = 1;
      while (i + 1 < length.size() && length[i] < s) ++i;
      finger->joint[j] = Mix(line[i - 1], line[i], (s - length[i - 1]) / (length[i] - length[i - 1]));
    }
    for (int j = 0; j < 3; ++j) finger->at[j] = At(finger->joint[j], body_.v_template);
    for (int j = 0; j < 3; ++j) {
      finger->bone[j] = ((j < 2 ? finger->at[j + 1] : Vertex(finger->tip)) - finger->at[j]).normalized();
    }
  }

  /// Share of joint j and its descendants at a vertex of the finger's tube or, for the first joint, of the palm.
  [[nodiscard]] double Beyond(int f, int j, const Vector3d& x) const {
    const Finger& finger = fingers_[f];
    const Vector3d before = j > 0 ? finger.bone[j - 1] : Vector3d((finger.at[0] - wrist_).normalized());
    const Vector3d normal = (before + finger.bone[j]).normalized();
    return Step(normal.dot(x - finger.at[j]), (f == kThumb ? kThumbStep_m : kFingerStep_m)[j]);
  }

  /// Share of the thumb's metacarpal at a vertex outside of the thumb's tube.
  [[nodiscard]] double Thenar(const Vector3d& x) const {
    const Finger& thumb = fingers_[kThumb];
    const Vector3d bone = thumb.at[1] - thumb.at[0];
    const double t = std::clamp((x - thumb.at[0]).dot(bone) / bone.squaredNorm(), 0.0, 1.0);
    const double distance = (x - thumb.at[0] - t * bone).norm();
    return Beyond(kThumb, 0, x) *
           Step(0.5 * (kThenarInner_m + kThenarOuter_m) - distance, 0.5 * (kThenarOuter_m - kThenarInner_m));
  }

  void MakeWeights() {
    wrist_.setZero();
    for (SparseRows::InnerIterator it(body_.J_regressor, kLeftWrist); it; ++it) {
      wrist_ += it.value() * Vertex(static_cast<int>(it.col()));
    }
    std::map<int, std::vector<int>> neighbours;
    std::vector<bool> moves(static_cast<size_t>(body_.v_template.rows()), false);
    for (const int v : refined_.left_vertices) {
      for (SparseRows::InnerIterator it(body_.weights, v); it; ++it) {
        if (it.col() == kLeftWrist || it.col() == kLeftHand) moves[v] = true;
      }
    }
    for (int q = 0; q < refined_.num_left_quads; ++q) {
      const Quad& quad = refined_.quads[q];
      for (int k = 0; k < 4; ++k) {
        const int a = quad[k], b = quad[(k + 1) % 4];
        if (moves[a] && moves[b]) neighbours[a].push_back(b);  // the quad beside it has the edge the other way round
      }
    }
    for (const int v : refined_.left_vertices) {
      if (moves[v]) shares_[v] = SharesAt(v);
    }
    Smooth(neighbours);
  }

  [[nodiscard]] std::array<double, kHandJoints> SharesAt(int v) const {
    std::array<double, kHandJoints> share{};
    const Vector3d x = Vertex(v);
    std::array<double, 5> side{};  // by finger
    double sum = 0;
    bool in_tube = false;
    for (int f = 0; f < 5; ++f) {
      const auto found = fingers_[f].along.find(v);
      if (found == fingers_[f].along.end() || found->second < 0.5) continue;
      in_tube = true;
      side[f] = sum = 1;
    }
    if (!in_tube) {
      for (int f = 0; f < kThumb; ++f) {
        const Finger& finger = fingers_[f];
        const Vector3d off = x - finger.at[0];
        const Vector3d across = (fingers_[0].at[0] - fingers_[2].at[0]).normalized();
        const Vector3d sideways = (across - across.dot(finger.bone[0]) * finger.bone[0]).normalized();
        side[f] = std::exp(-0.5 * std::pow(sideways.dot(off) / kKnuckleSpread_m, 2));
        sum += side[f];
      }
    }
    const double thenar = in_tube ? 0 : Thenar(x);
    for (int f = 0; f < 5; ++f) {
      double first = 0;
      if (f == kThumb) {
        first = in_tube ? side[f] * std::max(Thenar(x), Beyond(f, 0, x)) : thenar;
      } else if (sum > 1e-12) {
        first = (1 - thenar) * side[f] / sum * Beyond(f, 0, x);
      }
      const bool own = in_tube && side[f] > 0;
      const double second = own || f == kThumb ? Beyond(f, 1, x) : 0, third = own ? Beyond(f, 2, x) : 0;
      const bool bends = own || (f == kThumb && fingers_[f].along.contains(v));
      share[3 * f] = first * (bends ? 1 - second : 1);
      share[3 * f + 1] = bends ? first * second * (1 - third) : 0;
      share[3 * f + 2] = bends ? first * second * third : 0;
    }
    return share;
  }

  /// Half steps to the neighbours' mean in the palm and at the first rings; tubes keep their steps.
  void Smooth(const std::map<int, std::vector<int>>& neighbours) {
    for (int i = 0; i < kSmoothings; ++i) {
      auto smooth = shares_;
      for (auto& [v, share] : smooth) {
        const bool in_tube = std::any_of(fingers_.begin(), fingers_.end(), [v = v](const Finger& finger) {
          const auto found = finger.along.find(v);
          return found != finger.along.end() && found->second > 1.5;
        });
        const auto around = neighbours.find(v);
        if (in_tube || around == neighbours.end()) continue;
        for (int j = 0; j < kHandJoints; ++j) {
          double mean = 0;
          for (const int n : around->second) mean += shares_.at(n)[j] / static_cast<double>(around->second.size());
          share[j] = 0.5 * share[j] + 0.5 * mean;
        }
      }
      shares_ = std::move(smooth);
    }
  }

  const Cage& cage_;
  const RefinedCage& refined_;
  const BodyModelData& body_;
  std::map<std::string, int> index_of_;
  Vector3d wrist_ = Vector3d::Zero();
  std::array<Finger, 5> fingers_;
  std::map<int, std::array<double, kHandJoints>> shares_;
};

/// Weights of the left half, 52 joints; at most four a vertex, of which the smallest finger joints give way to the
/// wrist.
std::vector<WeightedIndices> DivideWeights(const BodyModelData& body, const LeftHand& hand,
                                           const std::vector<int>& left_vertices) {
  std::vector<WeightedIndices> rows;
  for (const int v : left_vertices) {
    WeightedIndices row;
    double whole = 0;
    for (SparseRows::InnerIterator it(body.weights, v); it; ++it) {
      const int joint = static_cast<int>(it.col());
      if (joint == kLeftWrist || joint == kLeftHand) {
        whole += it.value();
      } else if (joint < kFirstFingerJoint) {
        row.push_back({joint, it.value()});
      }
    }
    const auto shares = hand.shares().find(v);
    if (shares == hand.shares().end()) {
      rows.push_back(row);
      continue;
    }
    std::vector<std::pair<double, int>> largest;
    for (int j = 0; j < kHandJoints; ++j) {
      if (shares->second[j] > 1e-4) largest.emplace_back(whole * shares->second[j], kFirstFingerJoint + j);
    }
    std::sort(largest.rbegin(), largest.rend());
    double left = whole;
    double sum = 0;
    for (const auto& [weight, joint] : largest) sum += weight;
    const bool wrist = whole - sum > 1e-4;
    const size_t room = kMaxInfluences - std::min<size_t>(row.size() + (wrist ? 1 : 0), kMaxInfluences - 1);
    if (largest.size() > room) largest.resize(room);
    for (const auto& [weight, joint] : largest) {
      row.push_back({joint, weight});
      left -= weight;
    }
    if (left > 1e-9) {
      row.push_back({kLeftWrist, left});
    } else if (!largest.empty()) {
      row.back().weight += left;
    }
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

void AddFingerJoints(const Cage& cage, const RefinedCage& refined, BodyModelData* body) {
  const LeftHand hand(cage, refined, *body);
  constexpr int kJoints = kFirstFingerJoint + 2 * kHandJoints;
  body->joint_names.resize(kFirstFingerJoint);
  body->parents.resize(kFirstFingerJoint);
  std::vector<int> joint_mirror(kJoints);
  for (int j = 0; j < kFirstFingerJoint; ++j) {
    std::string name = body->joint_names[j];
    if (name[1] == '_') name[0] = name[0] == 'l' ? 'r' : 'l';
    joint_mirror[j] = static_cast<int>(std::find(body->joint_names.begin(), body->joint_names.end(), name) -
                                       body->joint_names.begin());
  }
  std::vector<Eigen::Triplet<double>> regressor;
  for (int j = 0; j < kFirstFingerJoint; ++j) {
    for (SparseRows::InnerIterator it(body->J_regressor, j); it; ++it) regressor.emplace_back(j, it.col(), it.value());
  }
  std::array<std::array<int, 5>, 2> tips{};
  for (int side = 0; side < 2; ++side) {
    for (int i = 0; i < kHandJoints; ++i) {
      const int joint = kFirstFingerJoint + side * kHandJoints + i;
      body->joint_names.push_back(HandJointNames(side == 0 ? HandSide::kLeft : HandSide::kRight)[i]);
      body->parents.push_back(i % 3 == 0 ? kLeftWrist + side : joint - 1);
      joint_mirror[joint] = kFirstFingerJoint + (1 - side) * kHandJoints + i;
      for (const auto& [v, weight] : hand.fingers()[i / 3].joint[i % 3]) {
        regressor.emplace_back(joint, side == 0 ? v : refined.mirror[v], weight);
      }
    }
    constexpr std::array<int, 5> kInLandmarks = {kThumb, 0, 1, 3, 2};
    for (int f = 0; f < 5; ++f) {
      const int tip = hand.fingers()[kInLandmarks[f]].tip;
      tips[side][f] = side == 0 ? tip : refined.mirror[tip];
    }
  }
  body->J_regressor.resize(kJoints, body->v_template.rows());
  body->J_regressor.setFromTriplets(regressor.begin(), regressor.end());
  const std::vector<WeightedIndices> weights = DivideWeights(*body, hand, refined.left_vertices);
  FillWeights(refined, joint_mirror, weights, body);
  for (const HandSide side : {HandSide::kLeft, HandSide::kRight}) {
    const std::vector<Landmark> landmarks = HandLandmarks(*body, side, tips[static_cast<size_t>(side)]);
    body->landmarks.insert(body->landmarks.end(), landmarks.begin(), landmarks.end());
  }
  const HandSkeleton axes = *FindHand(BodyModel(*body), HandSide::kLeft);
  std::array<Vector3d, kHandJoints> places;
  for (int i = 0; i < kHandJoints; ++i) places[size_t(i)] = hand.fingers()[i / 3].at[i % 3];
  AddCorrectives(refined, joint_mirror,
                 FitFingerCorrectives(*body, axes, kFirstFingerJoint, places, weights, refined.left_vertices),
                 kFirstFingerJoint, &body->posedirs);
}

}  // namespace bodyloom
