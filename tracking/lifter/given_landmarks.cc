// SPDX-License-Identifier: Apache-2.0
#include "tracking/lifter/given_landmarks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "geometry/base/check.h"
#include "tracking/lifter/lifter_input.h"

namespace bodyloom {
namespace {

double ReferenceLength(const MatrixX3d& points) {
  std::vector<float> values;
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    for (int c = 0; c < 3; ++c) values.push_back(static_cast<float>(points(k, c)));
  }
  return LifterReferenceLength(values);
}

}  // namespace

void TakeGivenLandmarks(const std::vector<MatrixX3d>& points, const GivenLandmarkSigma& sigma,
                        std::vector<LiftedFrame>* frames) {
  BODYLOOM_CHECK(points.size() == frames->size(), "given landmarks: ", points.size(), " frames, expected ",
                 frames->size());
  for (size_t t = 0; t < points.size(); ++t) {
    if (points[t].rows() == 0) continue;
    BODYLOOM_CHECK(points[t].rows() == kLifterPoints && points[t].allFinite(), "given landmarks: frame ", t, " has ",
                   points[t].rows(), " points, expected ", kLifterPoints, " finite ones");
    const double length = ReferenceLength(points[t]);
    BODYLOOM_CHECK(length > 0.1, "given landmarks: frame ", t, ": torso and leg measure ", length, " m");
    const Eigen::RowVector3d hips = 0.5 * (points[t].row(kLifterLeftHip) + points[t].row(kLifterLeftHip + 1));
    LiftedFrame& frame = (*frames)[t];
    frame.seen = true;
    frame.camera_from_virtual.setIdentity();
    frame.points = (points[t].rowwise() - hips) / length;
    frame.sigma.resize(kLifterPoints, 2);
    frame.sigma.col(0).setConstant(sigma.across_m / length);
    frame.sigma.col(1).setConstant(sigma.along_m / length);
    for (int limb = 0; limb < LifterOutput::kLimbs; ++limb) {
      LiftedLimb guess;
      guess.weight = 1;
      const std::span<const int> of_limb = LifterOutput::LimbPoints(limb);
      for (size_t i = 0; i < of_limb.size(); ++i) {
        guess.points[i] = frame.points.row(of_limb[i]).transpose();
        guess.sigma[i] = frame.sigma.row(of_limb[i]).transpose();
      }
      frame.limbs[limb] = {guess};
    }
  }
}

namespace {

using Eigen::Vector2d;

/// Regions of DensePose's charts; two charts a limb bone (front and back, or outside and inside).
enum Region : uint8_t {
  kNoPart = 0,
  kTorso,
  kHeadRight,
  kHeadLeft,
  kHand,           // + side
  kFoot = 6,       // + side
  kThigh = 8,      // + side
  kShin = 10,      // + side
  kUpperArm = 12,  // + side
  kForearm = 14,   // + side
  kNumRegions = 16
};
constexpr int kLeft = 0, kRight = 1;
constexpr uint8_t kTorsoBack = 1, kTorsoFront = 2;
// Chart 0 (background) to 24. Source: DensePose, challenge/*/data_format.md; 5 is the left foot.
constexpr std::array<uint8_t, 25> kRegionOfChart = {kNoPart,
                                                    kTorso,
                                                    kTorso,
                                                    kHand + kRight,
                                                    kHand + kLeft,
                                                    kFoot + kLeft,
                                                    kFoot + kRight,
                                                    kThigh + kRight,
                                                    kThigh + kLeft,
                                                    kThigh + kRight,
                                                    kThigh + kLeft,
                                                    kShin + kRight,
                                                    kShin + kLeft,
                                                    kShin + kRight,
                                                    kShin + kLeft,
                                                    kUpperArm + kLeft,
                                                    kUpperArm + kRight,
                                                    kUpperArm + kLeft,
                                                    kUpperArm + kRight,
                                                    kForearm + kLeft,
                                                    kForearm + kRight,
                                                    kForearm + kLeft,
                                                    kForearm + kRight,
                                                    kHeadRight,
                                                    kHeadLeft};

/// CocoNames() indices.
enum Coco {
  kNose = 0,
  kLeftEye,
  kRightEye,
  kLeftEar,
  kRightEar,
  kShoulder,
  kElbow = 7,
  kWrist = 9,
  kHip = 11,
  kKnee = 13,
  kAnkle = 15,
  kToe = 17,
  kNumPoints = 19
};

double MedianOf(std::vector<double>* values) {
  const auto middle = values->begin() + static_cast<std::ptrdiff_t>(values->size() / 2);
  std::nth_element(values->begin(), middle, values->end());
  return *middle;
}

Vector2d Median(const std::vector<Vector2d>& points) {
  std::vector<double> x, y;
  for (const Vector2d& p : points) {
    x.push_back(p.x());
    y.push_back(p.y());
  }
  return {MedianOf(&x), MedianOf(&y)};
}

/// One frame's labels as regions, with the measurements that give the joints.
class RegionImage {
 public:
  RegionImage(const PartLabelSequence& labels, int frame) {
    const LabelImage image = labels.PartsOf(frame);
    x_ = image.x_begin;
    y_ = image.y_begin;
    width_ = std::max(0, image.width);
    height_ = std::max(0, image.height);
    regions_.resize(image.labels.size());
    int top = height_, bottom = -1;
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        const uint8_t chart = image.labels[size_t(y) * width_ + x];
        const uint8_t region = chart <= 24 ? kRegionOfChart[chart] : uint8_t{kNoPart};
        regions_[size_t(y) * width_ + x] = region;
        if (region == kNoPart) continue;
        ++count_[region];
        sum_[region] += Vector2d(x + x_, y + y_);
        front_ += chart == kTorsoFront;
        back_ += chart == kTorsoBack;
        top = std::min(top, y);
        bottom = std::max(bottom, y);
      }
    }
    extent_ = std::max(0, bottom - top + 1);
  }

  /// Height of all labelled pixels.
  [[nodiscard]] double extent_px() const { return extent_; }
  [[nodiscard]] int count(int region) const { return count_[region]; }
  [[nodiscard]] Vector2d centre(int region) const { return sum_[region] / std::max(1, count_[region]); }
  /// Visible side of the torso, −1 (all back) to 1 (all front); 0 without a torso.
  [[nodiscard]] double facing() const { return front_ + back_ > 0 ? double(front_ - back_) / (front_ + back_) : 0; }

  /// Midpoints of neighbouring pixels of which one is in `a` and the other in `b`.
  [[nodiscard]] std::vector<Vector2d> Touching(int a, int b) const {
    std::vector<Vector2d> points;
    const auto visit = [&](int x, int y, int dx, int dy) {
      const int p = regions_[size_t(y) * width_ + x], q = regions_[size_t(y + dy) * width_ + x + dx];
      if ((p == a && q == b) || (p == b && q == a)) points.emplace_back(x_ + x + 0.5 * dx, y_ + y + 0.5 * dy);
    };
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        if (x + 1 < width_) visit(x, y, 1, 0);
        if (y + 1 < height_) visit(x, y, 0, 1);
      }
    }
    return points;
  }

  /// All pixels of a region.
  [[nodiscard]] std::vector<Vector2d> Pixels(int region) const {
    std::vector<Vector2d> points;
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        if (regions_[size_t(y) * width_ + x] == region) points.emplace_back(x_ + x, y_ + y);
      }
    }
    return points;
  }

 private:
  int x_ = 0, y_ = 0, width_ = 0, height_ = 0;
  std::vector<uint8_t> regions_;
  std::array<int, kNumRegions> count_{};
  std::array<Vector2d, kNumRegions> sum_ = [] {
    std::array<Vector2d, kNumRegions> zero;
    zero.fill(Vector2d::Zero());
    return zero;
  }();
  int front_ = 0, back_ = 0;
  double extent_ = 0;
};

class FrameReader {
 public:
  FrameReader(const PartLabelSequence& labels, int frame, const PartKeypointsOptions& options, Keypoint* row)
      : image_(labels, frame), options_(options), row_(row) {}

  void Read() {
    if (!(image_.extent_px() > 0)) return;
    for (const int side : {kLeft, kRight}) {
      Joint(kElbow + side, kUpperArm + side, kForearm + side, 0.05);
      Joint(kWrist + side, kForearm + side, kHand + side, 0.03);
      Joint(kHip + side, kTorso, kThigh + side, 0.08);
      Joint(kKnee + side, kThigh + side, kShin + side, 0.06);
      Joint(kAnkle + side, kShin + side, kFoot + side, 0.04);
      Shoulder(side);
      Toe(side);
    }
    Face();
  }

 private:
  void Set(int k, const Vector2d& point, double confidence) {
    row_[k] = {static_cast<float>(point.x()), static_cast<float>(point.y()),
               static_cast<float>(options_.confidence * std::clamp(confidence, 0.0, 1.0))};
  }
  [[nodiscard]] bool Has(int k) const { return row_[k].confidence > 0; }
  [[nodiscard]] Vector2d At(int k) const { return {row_[k].x, row_[k].y}; }

  /// `usual`: length of the boundary when all of it is seen, as a share of the person's height.
  void Joint(int k, int a, int b, double usual) {
    const std::vector<Vector2d> touching = image_.Touching(a, b);
    SetFrom(k, touching, usual);
  }

  void SetFrom(int k, const std::vector<Vector2d>& touching, double usual) {
    const double length = static_cast<double>(touching.size()) / image_.extent_px();
    if (length < options_.min_contact) return;
    Set(k, Median(touching), length / usual);
  }

  void Shoulder(int side) {
    std::vector<Vector2d> touching = image_.Touching(kTorso, kUpperArm + side);
    if (touching.empty()) return;
    const Vector2d elbow = Has(kElbow + side) ? At(kElbow + side) : image_.centre(kUpperArm + side);
    double farthest = 0;
    for (const Vector2d& p : touching) farthest = std::max(farthest, (p - elbow).norm());
    std::erase_if(touching, [&](const Vector2d& p) { return (p - elbow).norm() < 0.85 * farthest; });
    SetFrom(kShoulder + side, touching, 0.04);
  }

  /// The pixel of the foot farthest from the ankle, among those around the foot's middle: labels have strays.
  void Toe(int side) {
    if (!Has(kAnkle + side) || image_.count(kFoot + side) < 8) return;
    const std::vector<Vector2d> foot = image_.Pixels(kFoot + side);
    const Vector2d ankle = At(kAnkle + side), middle = Median(foot);
    const double reach = 0.1 * image_.extent_px();
    if ((middle - ankle).norm() > reach) return;
    Vector2d toe = ankle;
    for (const Vector2d& p : foot) {
      if ((p - middle).norm() < reach && (p - ankle).norm() > (toe - ankle).norm()) toe = p;
    }
    Set(kToe + side, ankle + 0.9 * (toe - ankle), 0.7);
  }

  /// Takes the head's direction from the torso, since the labels of the head's halves do not tell front from back.
  void Face() {
    const int right = image_.count(kHeadRight), left = image_.count(kHeadLeft), head = left + right;
    if (head < 8) return;
    const Vector2d centre = (image_.centre(kHeadRight) * right + image_.centre(kHeadLeft) * left) / head;
    const double share = double(left) / head, front = std::clamp(0.5 + image_.facing(), 0.0, 1.0);
    const std::vector<Vector2d> middle = image_.Touching(kHeadRight, kHeadLeft);
    const Vector2d nose = middle.empty() ? centre : Median(middle);
    Set(kNose, nose, front);
    Set(kLeftEye, nose, front * std::min(1.0, 3 * share));
    Set(kRightEye, nose, front * std::min(1.0, 3 * (1 - share)));
    if (left > 8) Set(kLeftEar, image_.centre(kHeadLeft), std::min(1.0, 2 * share));
    if (right > 8) Set(kRightEar, image_.centre(kHeadRight), std::min(1.0, 2 * (1 - share)));
  }

  RegionImage image_;
  const PartKeypointsOptions& options_;
  Keypoint* row_;
};

}  // namespace

KeypointSequence KeypointsFromPartLabels(const PartLabelSequence& labels, const PartKeypointsOptions& options) {
  BODYLOOM_CHECK(labels.num_frames() > 0, "keypoints from part labels: no frames");
  KeypointSequence keypoints;
  keypoints.names = CocoNames();
  keypoints.names.insert(keypoints.names.end(), {"left_big_toe", "right_big_toe"});
  keypoints.timestamps = labels.timestamps;
  keypoints.image_width = labels.image_width;
  keypoints.image_height = labels.image_height;
  keypoints.points.resize(size_t(labels.num_frames()) * kNumPoints);
  for (int t = 0; t < labels.num_frames(); ++t) {
    FrameReader(labels, t, options, &keypoints.points[size_t(t) * kNumPoints]).Read();
  }
  return keypoints;
}

}  // namespace bodyloom
