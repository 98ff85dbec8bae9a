// SPDX-License-Identifier: Apache-2.0
#include "data_tools/synthesis/clips/synth_clip.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/base/check.h"
#include "geometry/base/hash_random.h"
#include "geometry/base/parallel.h"
#include "geometry/body/posed_body.h"
#include "geometry/scene/camera_path.h"
#include "render/raster/visibility_buffer.h"
#include "render/raster/visible_points.h"
#include "render/texture/chart_lookup.h"

namespace bodyloom {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

enum ClipStream : uint64_t { kPixels = 201, kFaults, kDroppedFrames, kMissingParts, kDetection, kInitialiser };

const std::vector<std::string>& LandmarkNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = CocoNames();
    for (const char* side : {"left_", "right_"}) {
      for (const char* point : {"big_toe", "small_toe", "heel"}) all.push_back(std::string(side) + point);
    }
    return all;
  }();
  return names;
}

/// Depth of a landmark inside the body; a surface nearer by more than this hides it.
double DepthInsideBody(const std::string& name) {
  if (name.ends_with("shoulder")) return 0.12;
  if (name.ends_with("hip")) return 0.17;
  if (name.ends_with("elbow") || name.ends_with("wrist") || name.ends_with("ankle")) return 0.07;
  if (name.ends_with("knee")) return 0.10;
  return 0.035;  // nose, eyes, ears, toes, heels lie on the skin
}

/// Flags of dropped frames, in runs: a two-state Markov chain with the requested mean length and share of gaps.
std::vector<bool> InRuns(int count, double share, double mean_run, HashRandom random) {
  std::vector<bool> on(count, false);
  if (share <= 0) return on;
  const double leave = 1 / mean_run, enter = share >= 1 ? 1 : std::min(1.0, leave * share / (1 - share));
  bool state = random.Uniform() < share;
  for (int t = 0; t < count; ++t) {
    on[t] = state;
    state = random.Uniform() < (state ? 1 - leave : enter);
  }
  return on;
}

Vector2d TwoNormals(HashRandom* random) {
  const double y = random->Normal(), x = random->Normal();
  return {x, y};
}

/// A random point of the surface, uniform by the area of the template.
class SurfaceSampler {
 public:
  explicit SurfaceSampler(const BodyModel& body) {
    const BodyModelData& d = body.data();
    double sum = 0;
    for (int f = 0; f < body.num_faces(); ++f) {
      const Vector3d a = d.v_template.row(d.faces(f, 0)), b = d.v_template.row(d.faces(f, 1)),
                     c = d.v_template.row(d.faces(f, 2));
      sum += (b - a).cross(c - a).norm();
      area_up_to_.push_back(sum);
    }
  }
  SurfacePoint Draw(HashRandom* random) const {
    const double at = random->Uniform() * area_up_to_.back();
    const auto face = std::upper_bound(area_up_to_.begin(), area_up_to_.end(), at) - area_up_to_.begin();
    const double r = std::sqrt(random->Uniform()), s = random->Uniform();
    return {std::min(static_cast<int>(face), static_cast<int>(area_up_to_.size()) - 1),
            Vector3d(1 - r, r * (1 - s), r * s)};
  }

 private:
  std::vector<double> area_up_to_;
};

/// d(pixel)/d(u, v) at a surface point: displacement of a label in the image by its chart coordinates. Zero for faces
/// without chart area.
Matrix2d PixelByChart(const BodyModel& body, const MatrixX3d& vertices, const Camera& camera,
                      const SurfacePoint& point) {
  const auto corners = body.data().faces.row(point.face);
  const auto uv = body.data().face_iuv.row(point.face).cast<double>();
  Matrix2d edges_uv;
  edges_uv << uv[2] - uv[0], uv[4] - uv[0], uv[3] - uv[1], uv[5] - uv[1];
  if (std::abs(edges_uv.determinant()) < 1e-12) return Matrix2d::Zero();
  const Vector3d a = vertices.row(corners[0]), b = vertices.row(corners[1]), c = vertices.row(corners[2]);
  Vector2d pixel;
  Matrix2x3d J;
  if (!camera.Project(point.barycentric[0] * a + point.barycentric[1] * b + point.barycentric[2] * c, &pixel, &J)) {
    return Matrix2d::Zero();
  }
  Eigen::Matrix<double, 3, 2> edges;
  edges << b - a, c - a;
  return J * edges * edges_uv.inverse();
}

DenseKeypoint MakeDense(const SurfacePoint& point, const Vector2d& pixel, double sigma_px) {
  return {point.face, point.barycentric.cast<float>(), pixel.cast<float>(), static_cast<float>(sigma_px)};
}

/// Data shared by all frames.
class ClipMaker {
 public:
  ClipMaker(const BodyModel& body, const SynthClipOptions& options, SynthClip* clip)
      : body_(body), options_(options), clip_(*clip), surface_(body), names_(LandmarkNames()) {
    std::erase_if(names_, [&](const std::string& name) { return body_.FindLandmark(name) < 0; });
    const DenseFaultOptions& faults = options_.dense;
    uv_faults_ = options_.dense_per_frame > 0 && (faults.uv_sigma > 0 || faults.quantise_uv);
    BODYLOOM_CHECK(!uv_faults_ || (body.has_parts() && body.data().face_iuv.rows() > 0),
                   "synthetic clip: UV noise and quantisation need charts, the body '", body.name(), "' has none");
    BODYLOOM_CHECK(faults.missing_part_share == 0 || body.has_parts(),
                   "synthetic clip: missing parts need parts, the body '", body.name(), "' has none");
    if (uv_faults_) charts_.emplace(body);
    const int T = clip_.truth.num_frames();
    const uint64_t seed = options_.seed;
    dropped_ = InRuns(T, options_.dropped_frame_share, options_.dropped_run_frames, HashRandom(seed, {kDroppedFrames}));
    const double frame_s = T > 1 ? (times().back() - times().front()) / (T - 1) : 1.0;
    for (uint64_t part = 0; part <= 24; ++part) {
      missing_.push_back(InRuns(T, part == 0 ? 0 : faults.missing_part_share,
                                std::max(1.0, faults.missing_part_seconds / frame_s),
                                HashRandom(seed, {kMissingParts, part})));
    }
    clip_.dense.timestamps = clip_.dense_truth.timestamps = times();
    clip_.dense.frames.resize(T);
    clip_.dense_truth.frames.resize(T);
    for (auto* sequence : {&clip_.dense, &clip_.dense_truth}) {
      sequence->image_width = camera().width;
      sequence->image_height = camera().height;
    }
    KeypointSequence& exact = clip_.keypoints_truth;
    exact.convention = names_.size() == LandmarkNames().size() ? "coco_wholebody23" : "custom";
    exact.names = names_;
    exact.timestamps = times();
    exact.image_width = camera().width;
    exact.image_height = camera().height;
    exact.points.resize(times().size() * names_.size());
    detection_frames_.resize(T);
    counts_.resize(T);
  }

  void MakeFrame(int t) {
    const Motion& motion = clip_.truth.motion;
    const BodyPose pose = PoseFromAxisAngle(body_, motion.poses.row(t).transpose(), motion.trans.row(t).transpose());
    const MatrixX3d rest_joints = body_.RestJoints(motion.betas);
    clip_.truth.joints[t] = PoseSkeleton(body_, rest_joints, pose).joints;
    const bool moves = clip_.truth.HasMovingCamera();
    const BodyPose seen =
        moves ? MovedPose(clip_.truth.camera_from_scene[t], rest_joints.row(0).transpose(), pose) : pose;
    const MatrixX3d vertices = PoseVertices(body_, motion.betas, seen);
    VisibilityBuffer buffer;
    buffer.Render(vertices, body_.data().faces, camera());
    if (options_.dense_per_frame > 0 && !dropped_[t]) AddDense(t, vertices, buffer);
    AddLandmarks(t, seen, vertices, buffer);
    if (moves && clip_.truth.coco17[t].rows() > 0) {
      clip_.truth.coco17[t] = MovedPoints(Inverse(clip_.truth.camera_from_scene[t]), clip_.truth.coco17[t]);
    }
  }

  /// Steps that need the whole clip, after all frames.
  void Finish() {
    if (options_.keypoints) {
      clip_.keypoints = DetectKeypoints(clip_.keypoints_truth, detection_frames_, options_.detection,
                                        HashRandom(options_.seed, {kDetection}).Next());
      for (int t = 0; t < clip_.keypoints.num_frames(); ++t) {
        for (int k = 0; k < clip_.keypoints.num_points(); ++k) {
          if (dropped_[t]) clip_.keypoints.at(t, k) = {};
          clip_.counts.keypoints += clip_.keypoints.at(t, k).confidence > 0;
          clip_.counts.keypoints_hidden += clip_.keypoints_truth.at(t, k).confidence == 0.5F;
        }
      }
    }
    for (const SynthFaultCounts& c : counts_) {
      clip_.counts.dense += c.dense;
      clip_.counts.dense_outliers += c.dense_outliers;
      clip_.counts.dense_missing += c.dense_missing;
    }
    clip_.counts.frames_dropped = static_cast<int>(std::count(dropped_.begin(), dropped_.end(), true));
  }

 private:
  [[nodiscard]] const Camera& camera() const { return clip_.truth.camera; }
  [[nodiscard]] const std::vector<double>& times() const { return clip_.truth.motion.timestamps; }

  void AddDense(int t, const MatrixX3d& vertices, const VisibilityBuffer& buffer) {
    const PixelBox& box = buffer.box();
    std::vector<int> covered;
    for (size_t i = 0; i < buffer.faces().size(); ++i) {
      if (buffer.faces()[i] >= 0) covered.push_back(static_cast<int>(i));
    }
    // The first n of a shuffle: a sample without repetition.
    HashRandom random(options_.seed, {kPixels, static_cast<uint64_t>(t)});
    const size_t n = std::min(covered.size(), static_cast<size_t>(options_.dense_per_frame));
    for (size_t i = 0; i < n; ++i) std::swap(covered[i], covered[i + random.Below(covered.size() - i)]);
    covered.resize(n);
    std::sort(covered.begin(), covered.end());
    for (const int index : covered) {
      const int face = buffer.faces()[index];
      if (body_.has_parts() && missing_[std::min<int>(body_.data().face_part[face], 24)][t]) {
        ++counts_[t].dense_missing;
        continue;
      }
      const Vector2d pixel(box.x_begin + index % box.width(), box.y_begin + index / box.width());
      const SurfacePoint truth{face, BarycentricAtPixel(vertices, body_.data().faces, camera(), face, pixel)};
      AddDensePoint(t, truth, pixel, vertices);
    }
  }

  void AddDensePoint(int t, const SurfacePoint& truth, const Vector2d& pixel, const MatrixX3d& vertices) {
    const DenseFaultOptions& faults = options_.dense;
    // Keyed by the pixel: a fault at one pixel does not depend on which others were drawn.
    HashRandom random(options_.seed, {kFaults, static_cast<uint64_t>(t), static_cast<uint64_t>(pixel.x()),
                                      static_cast<uint64_t>(pixel.y())});
    SurfacePoint label = truth;
    double chart_variance = 0;
    if (uv_faults_) {
      const int part = body_.data().face_part[truth.face];
      Vector2d uv = ChartUvAt(body_, truth.face, truth.barycentric).cast<double>();
      uv += faults.uv_sigma * TwoNormals(&random);
      chart_variance = faults.uv_sigma * faults.uv_sigma;
      if (faults.quantise_uv) {
        uv = (uv.cwiseMax(0).cwiseMin(1) * 255).array().floor() / 255;
        chart_variance += 1.0 / (12 * 255.0 * 255.0);
      }
      const SurfacePoint moved = charts_->Find(part, uv);
      if (moved.face >= 0) label = moved;
    }
    double variance = faults.pixel_sigma_px * faults.pixel_sigma_px;
    if (chart_variance > 0)
      variance += 0.5 * chart_variance * PixelByChart(body_, vertices, camera(), label).squaredNorm();
    const double sigma_px = std::max(std::sqrt(variance), faults.min_sigma_px);
    if (random.Uniform() < faults.outlier_probability) {
      label = surface_.Draw(&random);
      ++counts_[t].dense_outliers;
    }
    const Vector2d seen = pixel + faults.pixel_sigma_px * TwoNormals(&random);
    clip_.dense.frames[t].push_back(MakeDense(label, seen, sigma_px));
    clip_.dense_truth.frames[t].push_back(MakeDense(truth, pixel, faults.min_sigma_px));
    ++counts_[t].dense;
  }

  void AddLandmarks(int t, const BodyPose& pose, const MatrixX3d& vertices, const VisibilityBuffer& buffer) {
    if (names_.empty()) return;
    const MatrixX3d points = PoseLandmarks(body_, clip_.truth.motion.betas, pose, names_);
    const size_t num_coco = CocoNames().size();
    const bool has_coco =
        names_.size() >= num_coco && std::equal(CocoNames().begin(), CocoNames().end(), names_.begin());
    if (has_coco) clip_.truth.coco17[t] = points.topRows(static_cast<Eigen::Index>(num_coco));
    DetectionFrame& frame = detection_frames_[t];
    frame.person_height_px = UprightHeightPx(t, vertices);
    frame.hidden.assign(names_.size(), false);
    frame.head_cosine.assign(names_.size(), 1.0);
    for (size_t k = 0; k < names_.size(); ++k) {
      Keypoint& exact = clip_.keypoints_truth.at(t, static_cast<int>(k));
      const Vector3d X = points.row(static_cast<Eigen::Index>(k));
      Vector2d pixel;
      if (!camera().Project(X, &pixel)) continue;
      if (!(pixel.x() >= -0.5 && pixel.x() < camera().width - 0.5 && pixel.y() >= -0.5 &&
            pixel.y() < camera().height - 0.5))
        continue;
      frame.hidden[k] = !buffer.IsVisible(X, DepthInsideBody(names_[k]));
      exact = {static_cast<float>(pixel.x()), static_cast<float>(pixel.y()), frame.hidden[k] ? 0.5F : 1.0F};
    }
    if (has_coco) FaceDirections(points, &frame);
  }

  /// Cosines between the outward directions of nose and eyes (forward) and ears (sideways) and the direction to the
  /// camera.
  void FaceDirections(const MatrixX3d& points, DetectionFrame* frame) const {
    const Vector3d nose = points.row(0), between_ears = 0.5 * (points.row(3) + points.row(4));
    const Vector3d to_camera =
        camera().model == CameraModel::kPinhole ? Vector3d(-between_ears.normalized()) : Vector3d(0, 0, -1);
    const Vector3d forward = (nose - between_ears).normalized();
    const Vector3d left = (points.row(3) - points.row(4)).transpose().normalized();
    for (int k = 0; k < 3; ++k) frame->head_cosine[k] = forward.dot(to_camera);
    frame->head_cosine[3] = left.dot(to_camera);
    frame->head_cosine[4] = -left.dot(to_camera);
    // For these, the direction is a better criterion of visibility than a depth test.
    for (int k = 0; k < 5; ++k) frame->hidden[k] = false;
  }

  /// The body's stature at its distance from the camera, pixels.
  [[nodiscard]] double UprightHeightPx(int t, const MatrixX3d& vertices) const {
    const double stature_m = body_.data().v_template.col(1).maxCoeff() - body_.data().v_template.col(1).minCoeff();
    if (camera().model == CameraModel::kWeakPerspective) return clip_.truth.CameraAt(t).scale * stature_m;
    return camera().fy * stature_m / std::max(vertices.col(2).mean(), 0.1);
  }

  const BodyModel& body_;
  const SynthClipOptions& options_;
  SynthClip& clip_;
  SurfaceSampler surface_;
  std::vector<std::string> names_;
  std::optional<ChartLookup> charts_;
  bool uv_faults_ = false;
  std::vector<bool> dropped_;
  std::vector<std::vector<bool>> missing_;  ///< by part, by frame
  std::vector<DetectionFrame> detection_frames_;
  std::vector<SynthFaultCounts> counts_;
};

void CheckSynthMotion(const BodyModel& body, const Motion& motion) {
  const int T = motion.num_frames();
  BODYLOOM_CHECK(T > 0, "synthetic clip: the motion has no frames");
  BODYLOOM_CHECK(static_cast<int>(motion.timestamps.size()) == T && motion.trans.rows() == T, "synthetic clip: ", T,
                 " poses, ", motion.timestamps.size(), " timestamps, ", motion.trans.rows(), " translations");
  BODYLOOM_CHECK(
      motion.poses.cols() <= 3 * body.num_joints() && motion.poses.cols() >= 3 && motion.poses.cols() % 3 == 0,
      "synthetic clip: poses have ", motion.poses.cols(), " columns, the body '", body.name(), "' takes up to ",
      3 * body.num_joints());
  BODYLOOM_CHECK(motion.poses.allFinite() && motion.trans.allFinite(),
                 "synthetic clip: the motion holds NaN or infinite values");
}

}  // namespace

bool SynthClipOptions::IsValid(std::string* why) const {
  const auto no = [&](const std::string& text) {
    if (why != nullptr) *why = "synthetic clip: " + text;
    return false;
  };
  const auto is_share = [](double x) { return x >= 0 && x <= 1; };
  if (!camera.IsValid(why) || !camera_path.IsValid(why) || !detection.IsValid(why)) return false;
  const bool moves = camera_path.motion != SynthCameraMotion::kStill;
  if (moves && initialiser_error_px > 0) return no("an initialiser is of a camera that stands still");
  if (moves && camera.model != CameraModel::kPinhole) return no("a camera that moves is a pinhole's");
  if (dense_per_frame < 0) return no("dense_per_frame must not be negative");
  if (!(dense.pixel_sigma_px >= 0) || !(dense.uv_sigma >= 0)) return no("noise must not be negative");
  if (!is_share(dense.outlier_probability)) return no("outlier_probability must be in [0, 1]");
  if (!is_share(dense.missing_part_share)) return no("missing_part_share must be in [0, 1]");
  if (!(dense.missing_part_seconds > 0)) return no("missing_part_seconds must be positive");
  if (!(dense.min_sigma_px > 0)) return no("min_sigma_px must be positive");
  if (!is_share(dropped_frame_share)) return no("dropped_frame_share must be in [0, 1]");
  if (!(dropped_run_frames >= 1)) return no("dropped_run_frames must be at least 1");
  if (!(initialiser_error_px >= 0 && initialiser_error_px <= 200))
    return no("initialiser_error_px must be in [0, 200]");
  if (num_threads < 0 || num_threads > 1024) return no("num_threads must be in [0, 1024]");
  return true;
}

SynthClip MakeSynthClip(const BodyModel& body, const Motion& motion, const SynthClipOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), why);
  CheckSynthMotion(body, motion);
  return MakeSynthClip(body, motion,
                       MakeSynthCameraPath(body, motion, options.camera, options.camera_path, options.seed), options);
}

SynthClip MakeSynthClip(const BodyModel& body, const Motion& motion, const SynthCamera& placed,
                        const SynthClipOptions& options) {
  return MakeSynthClip(body, motion, SynthCameraPath{placed, {}}, options);
}

SynthClip MakeSynthClip(const BodyModel& body, const Motion& motion, const SynthCameraPath& path,
                        const SynthClipOptions& options) {
  const SynthCamera& placed = path.first;
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), why);
  CheckSynthMotion(body, motion);
  const int T = motion.num_frames();
  SynthClip clip;
  clip.camera_from_world = placed.pose;
  clip.up_in_camera = placed.up_in_camera;
  Track& truth = clip.truth;
  truth.motion = MotionInCamera(body, motion, placed.pose);
  truth.camera = placed.camera;
  truth.camera_from_scene = path.camera_from_scene;
  if (placed.camera.model == CameraModel::kWeakPerspective) {
    truth.weak_camera = Eigen::RowVector3d(placed.camera.scale, placed.camera.tx, placed.camera.ty).replicate(T, 1);
  }
  truth.frame_status.assign(T, FrameStatus::kTracked);
  truth.joints.resize(T);
  truth.coco17.resize(T);
  truth.joint_sigma = RowMatrixXd::Zero(T, body.num_joints());

  const int num_threads = ThreadsFor(options.num_threads);
  clip.dense.pixel_sigma_px = options.dense.pixel_sigma_px;
  clip.dense.uv_sigma =
      std::hypot(options.dense.uv_sigma, options.dense.quantise_uv ? 1 / (255 * std::sqrt(12.0)) : 0.0);
  ClipMaker maker(body, options, &clip);
  ParallelFor(T, num_threads, [&](int t) { maker.MakeFrame(t); });
  maker.Finish();
  if (truth.coco17.front().rows() == 0) truth.coco17.clear();  // the body lacks these landmarks
  if (options.initialiser_error_px > 0) {
    PerturbedMotion perturbed =
        PerturbMotion(body, truth.camera, truth.motion, options.initialiser_error_px, options.perturbation,
                      HashRandom(options.seed, {kInitialiser}).Next(), num_threads);
    clip.initialiser = std::move(perturbed.motion);
    clip.initialiser_error_px = perturbed.error_px;
  }
  return clip;
}

}  // namespace bodyloom
