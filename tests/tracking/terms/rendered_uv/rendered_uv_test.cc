// SPDX-License-Identifier: Apache-2.0
// L_r and the covariance of dense keypoints: derivatives against Jets with the visible face fixed, and the cost of
// unmatched pixels.
#include "tracking/terms/rendered_uv/rendered_uv_term.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <memory>
#include <random>

#include "geometry/math/rotation.h"
#include "render/raster/visible_points.h"
#include "tests/support/frame_scene.h"
#include "tests/tracking/jet_twin.h"
#include "tracking/problem/robust.h"
#include "tracking/terms/dense/dense.h"
#include "tracking/terms/dense/dense_whitening.h"

namespace bodyloom::rendered_uv_test {
namespace {

using Eigen::Matrix2d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using twin::Jet;

struct Scene : FrameScene {
  std::unique_ptr<RenderedUvPixels> term;
};

void Perturb(double radians, std::mt19937_64* random, FrameState* state) {
  for (Eigen::Matrix3d& R : state->rotations) R = R * RotationFromAxisAngle(RandomTurn(radians, random));
}

/// A toy body before the camera, its visible pixels detected without error, and a state off by `offset_rad` a joint.
std::unique_ptr<Scene> MakeScene(CameraKnowledge knowledge, double offset_rad, uint64_t seed,
                                 RenderedUvOptions options = {.weight = 0.7}, double uv_sigma = 0.02) {
  auto scene = std::make_unique<Scene>();
  std::mt19937_64 random(seed);
  PlaceCamera(knowledge, MakePinhole(320, 240, 300), 300, AllJoints(scene->body), &random, scene.get());
  scene->state.rotations.assign(scene->body.num_joints(), Eigen::Matrix3d::Identity());
  scene->state.rotations[0] = RotationFromAxisAngle(Vector3d(M_PI, 0, 0)) * RotationFromAxisAngle(Vector3d(0, 0.3, 0));
  scene->state.translation =
      knowledge == CameraKnowledge::kWeak ? Vector3d(std::log(100.0), 0.05, -0.1) : Vector3d(0.1, -0.1, 2.8);
  Perturb(0.2, &random, &scene->state);
  VisibleSurface surface;
  const auto skinner = std::make_shared<const Skinner>(scene->body);
  const Camera seen_by = scene->layout.CameraAt(scene->state, scene->log_focal);
  EXPECT_TRUE(surface.Render(skinner, scene->body, scene->betas, scene->state.rotations,
                             scene->layout.BodyTranslation(scene->state), seen_by));
  const VisiblePoints points = ResolveVisiblePoints(surface.buffer(), scene->body, surface.vertices(), seen_by);
  EXPECT_GT(points.size(), 2000U);
  for (size_t i = 0; i < points.size(); i += points.size() / 150) {
    DenseKeypoint point;
    point.face = points.face[i];
    point.barycentric = points.barycentric[i].cast<float>();
    point.pixel = Eigen::Vector2f(static_cast<float>(points.x[i]), static_cast<float>(points.y[i]));
    point.sigma_px = 2;
    scene->dense.push_back(point);
  }
  scene->data.Get<DenseTerm>().points = &scene->dense;
  scene->data.Get<DenseTerm>().kernel = 20;  // generic weights: neither all inliers nor all saturated
  scene->term = std::make_unique<RenderedUvPixels>(scene->body, skinner, scene->dense, options);
  Perturb(offset_rad, &random, &scene->state);
  scene->data.Get<DenseTerm>().whitening =
      WhitenDense(scene->layout, scene->state, scene->betas, scene->log_focal, scene->dense, uv_sigma, 1);
  scene->term->SetWhitening(scene->data.Get<DenseTerm>().whitening);
  scene->data.Get<RenderedUvTerm>().term = scene->term.get();
  scene->data.Get<RenderedUvTerm>().kernel = scene->data.Get<DenseTerm>().kernel;
  scene->data.Get<DenseTerm>().taken = &scene->term->taken();
  // Elsewhere than where the whitening was computed.
  Perturb(0.3 * offset_rad, &random, &scene->state);
  return scene;
}

/// u, v that `face` shows at the pixel, as a function of one parameter.
Eigen::Matrix<Jet, 2, 1> TwinUv(const Scene& scene, const twin::SeededFrame& frame, int face, const Vector2d& pixel) {
  const auto f = scene.body.data().faces.row(face);
  auto x = frame.body.Vertices({f[0], f[1], f[2]});
  Jet a, b;  // the ray, from its pixel
  twin::Vector3<Jet> ray(Jet(0.0), Jet(0.0), Jet(1.0));
  if (scene.layout.knowledge == CameraKnowledge::kWeak) {
    a = (Jet(pixel.x()) - Jet(frame.camera.cx)) / frame.scale - frame.tx;
    b = (Jet(pixel.y()) - Jet(frame.camera.cy)) / frame.scale - frame.ty;
    for (auto& corner : x) corner -= twin::Vector3<Jet>(a, b, Jet(0.0));
  } else if (frame.camera.HasDistortion()) {
    const Vector2d xy = frame.camera.Unproject(pixel);
    ray = {Jet(xy.x()), Jet(xy.y()), Jet(1.0)};
  } else {
    ray = {(Jet(pixel.x()) - Jet(frame.camera.cx)) / frame.fx, (Jet(pixel.y()) - Jet(frame.camera.cy)) / frame.fy,
           Jet(1.0)};
  }
  // x0 + s (x1 − x0) + t (x2 − x0) = k ray, solved by Cramer's rule.
  const twin::Vector3<Jet> e = x[1] - x[0], g = x[2] - x[0];
  const Jet det = e.dot(g.cross(ray));
  const Jet s = (-x[0]).dot(g.cross(ray)) / det, t = e.dot((-x[0]).cross(ray)) / det;
  const auto uv = scene.body.data().face_iuv.row(face);
  Eigen::Matrix<Jet, 2, 1> result;
  for (int c = 0; c < 2; ++c) {
    result[c] =
        Jet(double{uv[c]}) + s * Jet(double{uv[2 + c]} - double{uv[c]}) + t * Jet(double{uv[4 + c]} - double{uv[c]});
  }
  return result;
}

struct TwinSystem {
  double cost = 0;
  MatrixXd J;
  VectorXd r;
  int matched = 0, unmatched = 0;
};

TwinSystem MakeTwin(Scene* scene) {
  RenderedUvPixels& term = *scene->term;
  VisibleSurface surface;
  const Camera camera = scene->layout.CameraAt(scene->state, scene->log_focal);
  const std::vector<int> seen = term.VisibleFaces(scene->body, scene->state, scene->betas,
                                                  scene->layout.BodyTranslation(scene->state), camera, &surface);
  const int n = static_cast<int>(seen.size()), p = scene->layout.num_columns;
  TwinSystem twin;
  twin.J = MatrixXd::Zero(2 * n, p);
  twin.r = VectorXd::Zero(2 * n);
  for (int column = 0; column < p; ++column) {
    const twin::SeededFrame frame =
        twin::SeedFrame(scene->body, scene->layout, scene->state, scene->betas, scene->log_focal, column);
    twin.cost = 0;
    twin.matched = twin.unmatched = 0;
    for (int i = 0; i < n; ++i) {
      const RenderedUvPixels::Pixel& pixel = term.pixels()[i];
      Eigen::Matrix<Jet, 2, 1> raw;
      bool matched = seen[i] >= 0 && scene->body.data().face_part[seen[i]] == pixel.part;
      if (matched) {
        const auto f = scene->body.data().faces.row(seen[i]);
        const auto x = frame.body.Vertices({f[0], f[1], f[2]});
        Eigen::Matrix3d corners;
        for (int c = 0; c < 3; ++c) corners.col(c) << x[c][0].a, x[c][1].a, x[c][2].a;
        const Vector3d normal = (corners.col(1) - corners.col(0)).cross(corners.col(2) - corners.col(0));
        const Vector2d xy = camera.Unproject(pixel.pixel);
        const Vector3d ray =
            scene->layout.knowledge == CameraKnowledge::kWeak ? Vector3d::UnitZ() : Vector3d(xy.x(), xy.y(), 1);
        matched = std::abs(normal.dot(ray)) >= term.min_cosine() * normal.norm() * ray.norm();
      }
      if (matched) {
        const Eigen::Matrix<Jet, 2, 1> off = TwinUv(*scene, frame, seen[i], pixel.pixel) - pixel.uv.cast<Jet>();
        raw = pixel.residual_by_uv.cast<Jet>() * off;
        ++twin.matched;
      } else {
        ++twin.unmatched;
        if (!term.unmatched_reproject()) {
          twin.cost += 0.5 * term.weight() * scene->data.Get<DenseTerm>().kernel * scene->data.Get<DenseTerm>().kernel;
          continue;
        }
        const DenseKeypoint& point = scene->dense[pixel.keypoint];
        const auto f = scene->body.data().faces.row(point.face);
        const auto x = frame.body.Vertices({f[0], f[1], f[2]});
        twin::Vector3<Jet> sum = twin::Vector3<Jet>::Zero();
        for (int c = 0; c < 3; ++c) {
          sum += x[c] * Jet(point.barycentric[c] / point.barycentric.cast<double>().sum());
        }
        raw = pixel.whitening.cast<Jet>() * (frame.Project(sum) - pixel.pixel.cast<Jet>());
      }
      const RobustValue robust =
          GemanMcClure(raw[0].a * raw[0].a + raw[1].a * raw[1].a, scene->data.Get<DenseTerm>().kernel);
      twin.cost += 0.5 * term.weight() * robust.rho;
      for (int c = 0; c < 2; ++c) {
        const double scale = std::sqrt(term.weight() * robust.weight);
        twin.r[2 * i + c] = scale * raw[c].a;
        twin.J(2 * i + c, column) = scale * raw[c].v[0];
      }
    }
  }
  return twin;
}

/// Cost, gradient and Gauss–Newton matrix to 1e-9 relative. Returns matched pixels.
int CheckAgainstTwin(Scene* scene) {
  const TwinSystem twin = MakeTwin(scene);
  const FrameSystem system = Evaluate(*scene);
  ExpectMatchesTwin(system, twin.cost, twin.J, twin.r);
  EXPECT_NEAR(Evaluate(*scene, false).cost, system.cost, 1e-12 * std::max(1.0, system.cost));
  return twin.matched;
}

TEST(RenderedUv, MatchesAutomaticDerivativesInEveryCamera) {
  for (CameraKnowledge knowledge : {CameraKnowledge::kKnown, CameraKnowledge::kUnknownFocal, CameraKnowledge::kWeak}) {
    for (double offset : {0.02, 0.08, 0.25}) {
      const auto scene = MakeScene(knowledge, offset, 3);
      const int matched = CheckAgainstTwin(scene.get());
      EXPECT_GT(matched, offset > 0.2 ? 20 : 60) << static_cast<int>(knowledge) << " " << offset;
      EXPECT_LT(matched, static_cast<int>(scene->term->pixels().size())) << "no unmatched pixel was checked";
    }
  }
}

TEST(RenderedUv, DerivativesAreNotZeroWhereTheResidualIs) {
  const auto scene = MakeScene(CameraKnowledge::kUnknownFocal, 0, 4);
  const FrameSystem system = Evaluate(*scene);
  EXPECT_LT(system.cost, 1e-2);  // float barycentrics, and grazing pixels
  EXPECT_GT(system.H.norm(), 1.0);
  EXPECT_GT(CheckAgainstTwin(scene.get()), 100);
}

TEST(RenderedUv, MatchesDifferencesWhileVisibilityIsHeld) {
  const auto scene = MakeScene(CameraKnowledge::kKnown, 0.08, 5, {.weight = 1});
  const FrameSystem system = Evaluate(*scene);
  scene->term->HoldVisibility(true);
  const FrameState state = scene->state;
  constexpr double kStep = 1e-6;
  for (int j = 0; j < scene->body.num_joints(); ++j) {
    for (int c = 0; c < 3; ++c) {
      double cost[2];
      for (int side = 0; side < 2; ++side) {
        scene->state = state;
        scene->state.rotations[j] =
            state.rotations[j] * RotationFromAxisAngle((side == 0 ? kStep : -kStep) * Vector3d::Unit(c));
        cost[side] = Evaluate(*scene, false).cost;
      }
      EXPECT_NEAR(system.gradient[3 * j + c], (cost[0] - cost[1]) / (2 * kStep), 1e-6 * system.gradient.norm());
    }
  }
  EXPECT_GT(system.gradient.norm(), 1);
  EXPECT_EQ(scene->term->num_rasterised(), 1);
}

TEST(RenderedUv, RasterisesOnceForEachNewState) {
  const auto scene = MakeScene(CameraKnowledge::kKnown, 0.05, 6);
  (void)Evaluate(*scene, false);
  (void)Evaluate(*scene, true);
  (void)Evaluate(*scene, true);
  EXPECT_EQ(scene->term->num_rasterised(), 1);
  scene->state.translation.x() += 1e-9;
  (void)Evaluate(*scene, false);
  EXPECT_EQ(scene->term->num_rasterised(), 2);
  scene->betas[0] += 1e-9;
  (void)Evaluate(*scene, false);
  EXPECT_EQ(scene->term->num_rasterised(), 3);
}

TEST(RenderedUv, UnmatchedPixelsSaturateWithoutPullWhenAsked) {
  const auto scene = MakeScene(CameraKnowledge::kKnown, 0.05, 7, {.weight = 0.5, .unmatched_reproject = false});
  EXPECT_GT(CheckAgainstTwin(scene.get()), 50);
  scene->state.translation.x() += 50;  // out of the image
  const FrameSystem system = Evaluate(*scene);
  const double c = scene->data.Get<DenseTerm>().kernel;
  EXPECT_DOUBLE_EQ(system.cost, 0.5 * 0.5 * c * c * double(scene->term->pixels().size()));
  EXPECT_EQ(system.gradient.norm(), 0);
  scene->state.translation = {0, 0, -3};  // behind the camera
  EXPECT_DOUBLE_EQ(Evaluate(*scene).cost, system.cost);
}

TEST(RenderedUv, AllPixelsUnmatchedCostTheirReprojection) {
  const auto scene = MakeScene(CameraKnowledge::kKnown, 0.05, 8, {.weight = 1});
  scene->state.translation.x() += 1.5;
  const FrameSystem with = Evaluate(*scene);
  scene->data.Get<RenderedUvTerm>().term = nullptr;
  scene->data.Get<DenseTerm>().taken = nullptr;
  const FrameSystem without = Evaluate(*scene);
  EXPECT_NEAR(with.cost, without.cost, 1e-9 * without.cost);
  EXPECT_LE((with.gradient - without.gradient).norm(), 1e-9 * without.gradient.norm());
}

TEST(RenderedUv, NearTheSolutionUvAndReprojectionAgreeToFirstOrder) {
  // Same whitened observation written in two ways: gradients agree up to the second order of the offset.
  const auto scene = MakeScene(CameraKnowledge::kKnown, 1e-4, 9, {.weight = 1});
  const FrameSystem uv = Evaluate(*scene);
  scene->data.Get<RenderedUvTerm>().term = nullptr;
  scene->data.Get<DenseTerm>().taken = nullptr;
  const FrameSystem reprojection = Evaluate(*scene);
  EXPECT_LE((uv.gradient - reprojection.gradient).norm(), 0.05 * reprojection.gradient.norm());
}

TEST(RenderedUv, KeypointsAreSpreadOverTheParts) {
  const BodyModel body(ToyBodyData());
  std::vector<DenseKeypoint> keypoints;
  std::map<int, int> faces_of_part;
  for (int f = 0; f < body.num_faces(); ++f) {
    if (++faces_of_part[body.data().face_part[f]] > 40) continue;
    for (int i = 0; i < (body.data().face_part[f] == 2 ? 20 : 1); ++i) keypoints.push_back({.face = f});
  }
  const std::vector<int> chosen = StratifiedKeypoints(body, keypoints, 240);
  EXPECT_EQ(chosen.size(), 240U);
  EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
  std::map<int, int> count;
  for (int i : chosen) ++count[body.data().face_part[keypoints[i].face]];
  for (const auto& [part, all] : faces_of_part) EXPECT_GE(count[part], std::min(all, 10)) << part;
  EXPECT_LE(count[2], 40);
  EXPECT_EQ(StratifiedKeypoints(body, keypoints, 1 << 20).size(), keypoints.size());
  EXPECT_TRUE(StratifiedKeypoints(body, {}, 10).empty());
}

TEST(DenseWhitening, IsTheInverseRootOfTheCovariance) {
  const auto scene = MakeScene(CameraKnowledge::kKnown, 0, 10, {.weight = 1}, 0.03);
  const Camera camera = scene->layout.CameraAt(scene->state, 0);
  int checked = 0;
  for (size_t i = 0; i < scene->dense.size(); ++i) {
    const DenseWhitening& w = scene->data.Get<DenseTerm>().whitening[i];
    const Matrix2d S = Matrix2d::Identity() + 0.03 * 0.03 * w.pixel_by_uv * w.pixel_by_uv.transpose();
    EXPECT_LE((w.whitening * S * w.whitening - Matrix2d::Identity()).norm(), 1e-9);
    // M against the pixels at which two points of the face appear.
    const DenseKeypoint& point = scene->dense[i];
    const auto f = scene->body.data().faces.row(point.face);
    const auto uv = scene->body.data().face_iuv.row(point.face).cast<double>();
    Kinematics kinematics;
    kinematics.Set(scene->body, scene->betas, scene->state.rotations, scene->state.translation, false);
    PointEvaluator::VertexCache cache;
    cache.NewFrame(kinematics);
    const auto seen = [&](const Vector3d& b) {
      Vector3d x = Vector3d::Zero();
      for (int c = 0; c < 3; ++c) x += b[c] * PointEvaluator::VertexPosition(kinematics, f[c], &cache);
      Vector2d pixel;
      EXPECT_TRUE(camera.Project(x, &pixel));
      return pixel;
    };
    const Vector3d b = point.barycentric.cast<double>() / point.barycentric.cast<double>().sum();
    constexpr double kStep = 1e-5;
    for (int c = 1; c < 3; ++c) {
      const Vector3d step = kStep * (Vector3d::Unit(c) - Vector3d::Unit(0));
      const Vector2d d_uv(uv[2 * c] - uv[0], uv[2 * c + 1] - uv[1]);
      const Vector2d moved = (seen(b + step) - seen(b - step)) / (2 * kStep);
      EXPECT_LE((w.pixel_by_uv * d_uv - moved).norm(), 1e-5 * std::max(1.0, moved.norm()));
      ++checked;
    }
  }
  EXPECT_GT(checked, 200);
}

TEST(DenseWhitening, WithoutAKnownUvNoiseIsTheSameInEveryDirection) {
  const auto scene = MakeScene(CameraKnowledge::kKnown, 0, 11, {.weight = 1}, 0);
  for (const DenseWhitening& w : scene->data.Get<DenseTerm>().whitening) {
    EXPECT_LE((w.whitening - 0.5 * Matrix2d::Identity()).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace bodyloom::rendered_uv_test
