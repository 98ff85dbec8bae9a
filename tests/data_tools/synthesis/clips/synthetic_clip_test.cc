// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/clips/synth_clip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "data_tools/synthesis/clips/demo_motion.h"
#include "data_tools/synthesis/clips/smooth_curve.h"
#include "geometry/body/posed_body.h"
#include "render/raster/visible_points.h"
#include "tests/support/toy_body.h"
#include "tests/support/toy_poses.h"

namespace bodyloom::synthetic_clip_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

SynthClipOptions Small(uint64_t seed = 1) {
  SynthClipOptions options;
  options.seed = seed;
  options.camera.width = options.camera.height = 256;
  options.dense_per_frame = 100;
  options.num_threads = 1;
  return options;
}

Motion ShortMotion(int frames = 24) { return DemoMotion(ToyBody(), frames, 10); }

/// Projection of a dense keypoint's surface point.
Vector2d Projected(const SynthClip& clip, int t, const DenseKeypoint& point) {
  const BodyPose pose = PoseFromAxisAngle(ToyBody(), clip.truth.motion.poses.row(t).transpose(),
                                          clip.truth.motion.trans.row(t).transpose());
  const auto corners = ToyBody().data().faces.row(point.face);
  const std::vector<int> vertices(corners.begin(), corners.end());
  const MatrixX3d x = PoseVertices(ToyBody(), clip.truth.motion.betas, pose, vertices);
  Vector2d pixel;
  EXPECT_TRUE(clip.truth.CameraAt(t).Project(x.transpose() * point.barycentric.cast<double>(), &pixel));
  return pixel;
}

/// Distances between where labels are seen and where they were detected, pixels, of `sequence`.
std::vector<Vector2d> Residuals(const SynthClip& clip, const DenseSequence& sequence) {
  std::vector<Vector2d> residuals;
  for (int t = 0; t < sequence.num_frames(); ++t) {
    for (const DenseKeypoint& p : sequence.frames[t])
      residuals.push_back(p.pixel.cast<double>() - Projected(clip, t, p));
  }
  return residuals;
}

double Rms(const std::vector<Vector2d>& values) {
  double sum = 0;
  for (const Vector2d& v : values) sum += 0.5 * v.squaredNorm();
  return std::sqrt(sum / static_cast<double>(values.size()));
}

void ExpectSame(const SynthClip& a, const SynthClip& b) {
  EXPECT_EQ(a.truth.motion.poses, b.truth.motion.poses);
  EXPECT_EQ(a.truth.joints, b.truth.joints);
  EXPECT_EQ(a.initialiser.poses, b.initialiser.poses);
  EXPECT_EQ(a.initialiser.trans, b.initialiser.trans);
  ASSERT_EQ(a.keypoints.points.size(), b.keypoints.points.size());
  for (size_t i = 0; i < a.keypoints.points.size(); ++i) {
    const Keypoint &p = a.keypoints.points[i], &q = b.keypoints.points[i];
    ASSERT_TRUE(p.x == q.x && p.y == q.y && p.confidence == q.confidence) << i;
  }
  ASSERT_EQ(a.dense.num_frames(), b.dense.num_frames());
  for (int t = 0; t < a.dense.num_frames(); ++t) {
    ASSERT_EQ(a.dense.frames[t].size(), b.dense.frames[t].size());
    for (size_t i = 0; i < a.dense.frames[t].size(); ++i) {
      const DenseKeypoint &p = a.dense.frames[t][i], &q = b.dense.frames[t][i];
      ASSERT_TRUE(p.face == q.face && p.barycentric == q.barycentric && p.pixel == q.pixel && p.sigma_px == q.sigma_px);
    }
  }
}

TEST(SynthClip, AGivenCameraSeesWhatThePlacedOneSees) {
  const SynthClip placed = MakeSynthClip(ToyBody(), ShortMotion(), Small());
  SynthCamera camera;
  camera.camera = placed.truth.camera;
  camera.pose = placed.camera_from_world;
  camera.up_in_camera = placed.up_in_camera;
  ExpectSame(MakeSynthClip(ToyBody(), ShortMotion(), camera, Small()), placed);
  // A motion that is in the camera frame already stays as it is.
  camera.pose = CameraPose();
  const SynthClip still = MakeSynthClip(ToyBody(), placed.truth.motion, camera, Small());
  EXPECT_LT((still.truth.motion.poses - placed.truth.motion.poses).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((still.truth.motion.trans - placed.truth.motion.trans).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(SynthClip, WithoutFaultsEveryLabelIsExact) {
  SynthClipOptions options = Small();
  options.detection.noise = 0;
  options.detection.dropout_probability = options.detection.swap_probability = 0;
  const SynthClip clip = MakeSynthClip(ToyBody(), ShortMotion(), options);
  EXPECT_EQ(clip.counts.dense, 24 * 100);
  for (const Vector2d& r : Residuals(clip, clip.dense)) ASSERT_LT(r.norm(), 0.02);  // the rounding that chose the face
  // Landmarks are the body's own.
  const std::vector<std::string>& names = clip.keypoints.names;
  ASSERT_EQ(names.size(), 23u);
  for (const int t : {0, 11, 23}) {
    const BodyPose pose = PoseFromAxisAngle(ToyBody(), clip.truth.motion.poses.row(t).transpose(),
                                            clip.truth.motion.trans.row(t).transpose());
    const MatrixX3d points = PoseLandmarks(ToyBody(), clip.truth.motion.betas, pose, names);
    EXPECT_LT((clip.truth.coco17[t] - points.topRows(17)).norm(), 1e-12);
    for (size_t k = 0; k < names.size(); ++k) {
      Vector2d pixel;
      ASSERT_TRUE(clip.truth.camera.Project(points.row(static_cast<int>(k)), &pixel));
      const Keypoint& p = clip.keypoints.at(t, static_cast<int>(k));
      EXPECT_NEAR(p.x, pixel.x(), 1e-4) << names[k];
      EXPECT_NEAR(p.y, pixel.y(), 1e-4) << names[k];
    }
  }
}

TEST(SynthClip, TruthIsATrackOfItsOwn) {
  const SynthClip clip = MakeSynthClip(ToyBody(), ShortMotion(), Small());
  const Track& truth = clip.truth;
  EXPECT_EQ(truth.motion.up, Motion::Up::kCamera);
  EXPECT_EQ(truth.frame_status.size(), 24u);
  EXPECT_EQ(truth.joint_sigma.rows(), 24);
  EXPECT_EQ(truth.joints[3].rows(), 24);
  EXPECT_EQ(truth.camera.width, 256);
  EXPECT_GT(truth.motion.trans.col(2).minCoeff(), 0.5) << "in front of the camera";
}

TEST(SynthClip, SameSeedSameBytesForAnyNumberOfThreads) {
  SynthClipOptions options = Small(7);
  options.dense = {.pixel_sigma_px = 1,
                   .uv_sigma = 0.02,
                   .quantise_uv = true,
                   .outlier_probability = 0.1,
                   .missing_part_share = 0.1};
  options.dropped_frame_share = 0.1;
  options.initialiser_error_px = 10;
  const SynthClip one = MakeSynthClip(ToyBody(), ShortMotion(), options);
  options.num_threads = 3;
  ExpectSame(one, MakeSynthClip(ToyBody(), ShortMotion(), options));
  options.seed = 8;
  const SynthClip other = MakeSynthClip(ToyBody(), ShortMotion(), options);
  EXPECT_NE(one.dense.frames[2][0].pixel, other.dense.frames[2][0].pixel);
}

TEST(SynthClip, PixelNoiseHasTheStatedSize) {
  SynthClipOptions options = Small();
  options.dense.pixel_sigma_px = 2;
  const SynthClip clip = MakeSynthClip(ToyBody(), ShortMotion(), options);
  const std::vector<Vector2d> residuals = Residuals(clip, clip.dense);
  EXPECT_NEAR(Rms(residuals), 2, 0.06);  // 2400 points: 1.5 %
  const Vector2d mean = std::accumulate(residuals.begin(), residuals.end(), Vector2d(0, 0)) / residuals.size();
  EXPECT_LT(mean.norm(), 0.15);
  EXPECT_FLOAT_EQ(clip.dense.frames[0][0].sigma_px, 2);
  EXPECT_LT(Rms(Residuals(clip, clip.dense_truth)), 0.01) << "the truth stays exact";
}

TEST(SynthClip, UvNoiseMovesLabelsInsideTheirChartByWhatSigmaSays) {
  SynthClipOptions options = Small();
  options.dense.uv_sigma = 0.02;
  const SynthClip clip = MakeSynthClip(ToyBody(), ShortMotion(), options);
  double ratio = 0, du2 = 0;
  int n = 0, inside = 0;
  for (int t = 0; t < clip.dense.num_frames(); ++t) {
    for (size_t i = 0; i < clip.dense.frames[t].size(); ++i) {
      const DenseKeypoint &p = clip.dense.frames[t][i], &q = clip.dense_truth.frames[t][i];
      EXPECT_EQ(ToyBody().data().face_part[p.face], ToyBody().data().face_part[q.face]);
      EXPECT_EQ(p.pixel, q.pixel) << "the pixel stays";
      const Eigen::Vector2f a = ChartUvAt(ToyBody(), p.face, p.barycentric.cast<double>()),
                            b = ChartUvAt(ToyBody(), q.face, q.barycentric.cast<double>());
      const bool far_from_border = b.minCoeff() > 0.2F && b.maxCoeff() < 0.8F && std::abs(b.x() - 0.5F) > 0.1F;
      ++n;
      if (!far_from_border) continue;
      ++inside;
      du2 += 0.5 * (a - b).squaredNorm();
      ratio += 0.5 * (p.pixel.cast<double>() - Projected(clip, t, p)).squaredNorm() / (p.sigma_px * p.sigma_px);
    }
  }
  ASSERT_GT(inside, 300);
  EXPECT_NEAR(std::sqrt(du2 / inside), 0.02, 0.001);
  EXPECT_NEAR(std::sqrt(ratio / inside), 1, 0.35) << "sigma_px must describe the error in the image";
}

TEST(SynthClip, QuantisationRoundsDown) {
  SynthClipOptions options = Small();
  options.dense.quantise_uv = true;
  const SynthClip clip = MakeSynthClip(ToyBody(), ShortMotion(), options);
  double sum = 0;
  int n = 0;
  for (int t = 0; t < clip.dense.num_frames(); ++t) {
    for (size_t i = 0; i < clip.dense.frames[t].size(); ++i) {
      const DenseKeypoint &p = clip.dense.frames[t][i], &q = clip.dense_truth.frames[t][i];
      const Eigen::Vector2f a = ChartUvAt(ToyBody(), p.face, p.barycentric.cast<double>()),
                            b = ChartUvAt(ToyBody(), q.face, q.barycentric.cast<double>());
      if (b.minCoeff() < 0.1F || b.maxCoeff() > 0.9F || std::abs(b.x() - 0.5F) < 0.05F) continue;
      const Vector2d steps = 255 * a.cast<double>();
      EXPECT_LT((steps - Vector2d(std::round(steps.x()), std::round(steps.y()))).norm(), 1e-2);
      sum += 255 * (b - a).cast<double>().sum() / 2;
      ++n;
    }
  }
  ASSERT_GT(n, 300);
  EXPECT_NEAR(sum / n, 0.5, 0.05) << "the bias of rounding down, in steps";
}

TEST(SynthClip, OutliersAreAsManyAsAskedFor) {
  SynthClipOptions options = Small();
  options.dense.outlier_probability = 0.2;
  const SynthClip clip = MakeSynthClip(ToyBody(), ShortMotion(), options);
  EXPECT_NEAR(clip.counts.dense_outliers, 0.2 * clip.counts.dense, 0.03 * clip.counts.dense);
  int far = 0;
  for (const Vector2d& r : Residuals(clip, clip.dense)) far += r.norm() > 3;
  EXPECT_NEAR(far, clip.counts.dense_outliers, 0.05 * clip.counts.dense_outliers + 3);
}

TEST(SynthClip, PartsGoMissingInIntervals) {
  SynthClipOptions options = Small();
  options.dense_per_frame = 200;
  options.dense.missing_part_share = 0.3;
  options.dense.missing_part_seconds = 0.4;
  const SynthClip clip = MakeSynthClip(ToyBody(), ShortMotion(120), options);
  const double share = double(clip.counts.dense_missing) / (clip.counts.dense_missing + clip.counts.dense);
  EXPECT_NEAR(share, 0.3, 0.12);
  // The front of the torso is seen in nearly all frames: count how often it comes and goes.
  int changes = 0, absent = 0;
  bool was = true;
  for (const auto& frame : clip.dense.frames) {
    const bool is = std::any_of(frame.begin(), frame.end(),
                                [](const DenseKeypoint& p) { return ToyBody().data().face_part[p.face] == 2; });
    changes += is != was;
    absent += !is;
    was = is;
  }
  EXPECT_GT(changes, 2);
  EXPECT_GT(absent, changes) << "absences last longer than a frame";
}

TEST(SynthClip, FramesDropOutWhole) {
  SynthClipOptions options = Small();
  options.dropped_frame_share = 0.3;
  const SynthClip clip = MakeSynthClip(ToyBody(), ShortMotion(200), options);
  EXPECT_NEAR(clip.counts.frames_dropped, 60, 30);
  int empty = 0;
  for (int t = 0; t < 200; ++t) {
    bool any_keypoint = false;
    for (int k = 0; k < clip.keypoints.num_points(); ++k)
      any_keypoint = any_keypoint || clip.keypoints.at(t, k).confidence > 0;
    EXPECT_EQ(any_keypoint, !clip.dense.frames[t].empty()) << "frame " << t;
    empty += !any_keypoint;
  }
  EXPECT_EQ(empty, clip.counts.frames_dropped);
}

TEST(SynthClip, HiddenLandmarksAreLessCertain) {
  SynthClipOptions options = Small();
  options.camera.yaw_deg = 70;  // from the side of the walk
  const SynthClip clip = MakeSynthClip(ToyBody(), ShortMotion(60), options);
  double visible = 0, hidden = 0;
  int num_visible = 0, num_hidden = 0;
  for (int t = 0; t < 60; ++t) {
    for (int k = 5; k < 17; ++k) {
      const float confidence = clip.keypoints.at(t, k).confidence;
      if (confidence <= 0) continue;
      (clip.keypoints_truth.at(t, k).confidence < 1 ? hidden : visible) += confidence;
      ++(clip.keypoints_truth.at(t, k).confidence < 1 ? num_hidden : num_visible);
    }
  }
  ASSERT_GT(num_hidden, 20);
  ASSERT_GT(num_visible, 200);
  EXPECT_LT(hidden / num_hidden, 0.3);
  EXPECT_GT(visible / num_visible, 0.5);
}

TEST(SynthClip, ASideViewHidesTheFarArm) {
  // The person stands and is seen from its left: the right wrist hangs behind the body.
  Motion motion;
  motion.poses = RowMatrixXd::Zero(1, 72);
  motion.poses(0, 3 * 16 + 2) = -1.35;
  motion.poses(0, 3 * 17 + 2) = 1.35;
  motion.trans = MatrixX3d::Zero(1, 3);
  motion.timestamps = {0};
  SynthClipOptions options = Small();
  options.camera.yaw_deg = 90;
  const SynthClip clip = MakeSynthClip(ToyBody(), motion, options);
  EXPECT_EQ(clip.keypoints_truth.at(0, 10).confidence, 0.5F) << "right wrist";
  EXPECT_EQ(clip.keypoints_truth.at(0, 9).confidence, 1.0F) << "left wrist";
  for (const DenseKeypoint& p : clip.dense.frames[0]) {
    const int part = ToyBody().data().face_part[p.face];
    EXPECT_NE(part, 3) << "the right hand is hidden";
  }
}

TEST(SynthClip, WorksInWeakPerspectiveAndThroughADistortingLens) {
  SynthClipOptions options = Small();
  options.camera.model = CameraModel::kWeakPerspective;
  const SynthClip weak = MakeSynthClip(ToyBody(), ShortMotion(), options);
  EXPECT_EQ(weak.truth.weak_camera.rows(), 24);
  EXPECT_LT(Rms(Residuals(weak, weak.dense)), 0.01);
  options.camera.model = CameraModel::kPinhole;
  options.camera.distortion = DistortedCamera(256, 256, 280).distortion;
  const SynthClip distorted = MakeSynthClip(ToyBody(), ShortMotion(), options);
  EXPECT_LT(Rms(Residuals(distorted, distorted.dense)), 0.05);
}

TEST(SynthClip, InitialiserIsAsWrongAsAskedFor) {
  for (const double target_px : {5.0, 14.8}) {
    SynthClipOptions options = Small();
    options.initialiser_error_px = target_px;
    const SynthClip clip = MakeSynthClip(ToyBody(), ShortMotion(), options);
    // Measured again from scratch, by its definition.
    double sum = 0;
    for (int t = 0; t < 24; ++t) {
      const auto vertices = [&](const Motion& m) {
        return PoseVertices(ToyBody(), m.betas,
                            PoseFromAxisAngle(ToyBody(), m.poses.row(t).transpose(), m.trans.row(t).transpose()));
      };
      const MatrixX3d a = vertices(clip.truth.motion), b = vertices(clip.initialiser);
      for (int v = 0; v < a.rows(); ++v) {
        Vector2d p, q;
        ASSERT_TRUE(clip.truth.camera.Project(a.row(v), &p) && clip.truth.camera.Project(b.row(v), &q));
        sum += (p - q).norm() * 512 / 256;
      }
    }
    EXPECT_NEAR(sum / (24 * ToyBody().num_vertices()), target_px, 0.005 * target_px);
    EXPECT_NEAR(clip.initialiser_error_px, target_px, 0.005 * target_px);
  }
}

TEST(SynthClip, RefusesWhatItCannotMake) {
  const Motion motion = ShortMotion(3);
  SynthClipOptions options = Small();
  options.dense.outlier_probability = 1.5;
  EXPECT_THROW(MakeSynthClip(ToyBody(), motion, options), std::invalid_argument);
  options = Small();
  options.camera.fill = 0;
  EXPECT_THROW(MakeSynthClip(ToyBody(), motion, options), std::invalid_argument);
  EXPECT_THROW(MakeSynthClip(ToyBody(), Motion(), Small()), std::invalid_argument);
  Motion broken = motion;
  broken.poses(1, 5) = std::nan("");
  EXPECT_THROW(MakeSynthClip(ToyBody(), broken, Small()), std::invalid_argument);
  broken = motion;
  broken.poses = RowMatrixXd::Zero(3, 156);
  EXPECT_THROW(MakeSynthClip(ToyBody(), broken, Small()), std::invalid_argument);
  BodyModelData data = ToyBodyData();
  data.face_part.clear();
  data.face_iuv.resize(0, 6);
  data.landmarks.clear();
  const BodyModel bare(std::move(data));
  options = Small();
  const SynthClip clip = MakeSynthClip(bare, motion, options);  // nothing that needs charts or landmarks
  EXPECT_TRUE(clip.truth.coco17.empty());
  EXPECT_EQ(clip.keypoints.num_points(), 0);
  options.dense.uv_sigma = 0.01;
  EXPECT_THROW(MakeSynthClip(bare, motion, options), std::invalid_argument);
  options = Small();
  options.dense.missing_part_share = 0.1;
  EXPECT_THROW(MakeSynthClip(bare, motion, options), std::invalid_argument);
}

/// Exact landmarks that stand still, 17 a frame, for statistics of the detector.
KeypointSequence Still(int frames, double fps) {
  KeypointSequence exact;
  exact.names = CocoNames();
  for (int t = 0; t < frames; ++t) {
    exact.timestamps.push_back(t / fps);
    for (size_t k = 0; k < exact.names.size(); ++k) exact.points.push_back({100.0F + 10 * k, 200.0F + 5 * k, 1});
  }
  return exact;
}

std::vector<DetectionFrame> AllOpen(int frames, bool hidden = false) {
  return std::vector<DetectionFrame>(frames, {400, std::vector<bool>(17, hidden), std::vector<double>(17, 1.0)});
}

TEST(DetectionNoise, NoiseGrowsAsConfidenceFalls) {
  const int frames = 4000;
  DetectionNoiseOptions options;
  options.dropout_probability = options.swap_probability = 0;
  const auto rms_of = [&](bool hidden) {
    const KeypointSequence seen = DetectKeypoints(Still(frames, 60), AllOpen(frames, hidden), options, 5);
    double sum = 0;
    for (int t = 0; t < frames; ++t) {
      for (int k = 5; k < 17; ++k)
        sum += std::pow(seen.at(t, k).x - (100 + 10 * k), 2) + std::pow(seen.at(t, k).y - (200 + 5 * k), 2);
    }
    return std::sqrt(sum / (2.0 * frames * 12));
  };
  const double open = rms_of(false), hidden = rms_of(true);
  EXPECT_GT(open, 0.006 * 400);
  EXPECT_LT(open, 0.02 * 400);
  EXPECT_GT(hidden, 3 * open);
}

TEST(DetectionNoise, ErrorsDrift) {
  const int frames = 6000;
  DetectionNoiseOptions options;
  options.dropout_probability = options.swap_probability = 0;
  const KeypointSequence seen = DetectKeypoints(Still(frames, 60), AllOpen(frames), options, 6);
  const auto correlation = [&](int lag) {
    double both = 0, one = 0;
    for (int k = 5; k < 17; ++k) {
      double mean = 0;
      for (int t = 0; t < frames; ++t) mean += seen.at(t, k).x / frames;
      for (int t = 0; t + lag < frames; ++t) {
        both += (seen.at(t, k).x - mean) * (seen.at(t + lag, k).x - mean);
        one += std::pow(seen.at(t, k).x - mean, 2);
      }
    }
    return both / one;
  };
  // Measured on real detections at 60 fps: 0.75 after one frame, 0.5 after 5, 0.17 after 15, 0 after 30.
  EXPECT_NEAR(correlation(1), 0.73, 0.08);
  EXPECT_NEAR(correlation(5), 0.55, 0.1);
  EXPECT_NEAR(correlation(15), 0.28, 0.13);
  EXPECT_NEAR(correlation(60), 0, 0.12);
}

TEST(DetectionNoise, DropOutsAndSwapsHaveTheStatedRates) {
  const int frames = 5000;
  DetectionNoiseOptions options;
  options.noise = 0;
  options.dropout_probability = 0.05;
  options.swap_probability = 0.02;
  const KeypointSequence seen = DetectKeypoints(Still(frames, 30), AllOpen(frames), options, 9);
  int missing = 0, swapped = 0, hips_swapped = 0, runs = 0;
  bool was = false;
  for (int t = 0; t < frames; ++t) {
    for (int k = 0; k < 17; ++k) missing += seen.at(t, k).confidence <= 0;
    const bool is =
        seen.at(t, 9).confidence > 0 && seen.at(t, 9).x == 100 + 10 * 10;  // the left wrist shows the right one
    swapped += is;
    runs += is && !was;
    was = is;
    hips_swapped += seen.at(t, 11).x == 100 + 10 * 12;
  }
  EXPECT_NEAR(missing, 0.05 * 17 * frames, 0.005 * 17 * frames);
  EXPECT_NEAR(swapped, 0.02 * frames, 0.012 * frames);
  EXPECT_GT(swapped, 1.4 * runs) << "swaps last a few frames";
  EXPECT_EQ(hips_swapped, 0);
}

TEST(DetectionNoise, ZeroNoiseIsExactAndMissingStaysMissing) {
  KeypointSequence exact = Still(10, 30);
  exact.at(3, 4).confidence = 0;
  DetectionNoiseOptions options;
  options.noise = options.dropout_probability = options.swap_probability = 0;
  options.model_confidence = false;
  const KeypointSequence seen = DetectKeypoints(exact, AllOpen(10), options, 1);
  EXPECT_EQ(seen.at(3, 4).confidence, 0);
  EXPECT_EQ(seen.at(5, 6).x, exact.at(5, 6).x);
  EXPECT_EQ(seen.at(5, 6).confidence, 1);
  EXPECT_THROW(DetectKeypoints(exact, AllOpen(9), options, 1), std::invalid_argument);
}

TEST(Drift, HasUnitVarianceAndTheStatedCorrelation) {
  std::vector<double> times(20000);
  for (size_t t = 0; t < times.size(); ++t) times[t] = 0.01 * static_cast<double>(t);
  for (const bool smooth : {false, true}) {
    double variance = 0, at_tau = 0;
    for (uint64_t seed = 0; seed < 20; ++seed) {
      const auto x =
          smooth ? SmoothDrift(times, 0.4, HashRandom(seed, {1})) : RoughDrift(times, 0.4, HashRandom(seed, {1}));
      for (size_t t = 0; t + 40 < x.size(); ++t) variance += x[t] * x[t], at_tau += x[t] * x[t + 40];
    }
    EXPECT_NEAR(variance / (20 * 19960), 1, 0.06);
    if (smooth) continue;
    EXPECT_NEAR(at_tau / variance, std::exp(-1), 0.05);
  }
}

TEST(HashRandom, IsUniformNormalAndIndependentOfOrder) {
  HashRandom random(1, {2, 3});
  double mean = 0, normal = 0, normal2 = 0, exponential = 0;
  const int n = 100000;
  for (int i = 0; i < n; ++i) {
    const double u = random.Uniform(), z = random.Normal();
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    mean += u / n, normal += z / n, normal2 += z * z / n, exponential += random.Exponential() / n;
  }
  EXPECT_NEAR(mean, 0.5, 0.005);
  EXPECT_NEAR(normal, 0, 0.015);
  EXPECT_NEAR(normal2, 1, 0.02);
  EXPECT_NEAR(exponential, 1, 0.015);
  EXPECT_EQ(HashRandom(5, {1, 2}).Next(), HashRandom(5, {1, 2}).Next());
  EXPECT_NE(HashRandom(5, {1, 2}).Next(), HashRandom(5, {2, 1}).Next());
  EXPECT_NE(HashRandom(5, {1}).Next(), HashRandom(6, {1}).Next());
  EXPECT_EQ(HashRandom(1, {}).Next(), 10762056130193897519ULL)
      << "the stream must never change: truth files depend on it";
}

}  // namespace
}  // namespace bodyloom::synthetic_clip_test
