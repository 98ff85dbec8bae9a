// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/rendered_uv/rendered_uv_term.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "geometry/base/check.h"
#include "tracking/problem/frame_accumulator.h"
#include "tracking/terms/dense/dense_whitening.h"

namespace bodyloom {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Matrix32d = Eigen::Matrix<double, 3, 2>;

std::vector<int> StratifiedKeypoints(const BodyModel& model, const std::vector<DenseKeypoint>& keypoints,
                                     int max_points) {
  std::array<std::vector<int>, 256> by_part;
  for (size_t i = 0; i < keypoints.size(); ++i) {
    by_part[model.data().face_part[keypoints[i].face]].push_back(static_cast<int>(i));
  }
  std::vector<int> order;  // parts by increasing size: the unused share of a small part goes to the others
  for (int p = 0; p < 256; ++p) {
    if (!by_part[p].empty()) order.push_back(p);
  }
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return by_part[a].size() < by_part[b].size(); });
  std::vector<int> chosen;
  size_t left = static_cast<size_t>(std::max(0, max_points)), parts_left = order.size();
  for (int p : order) {
    const std::vector<int>& all = by_part[p];
    const size_t n = std::min(all.size(), left / parts_left);
    for (size_t k = 0; k < n; ++k) chosen.push_back(all[k * all.size() / n]);
    left -= n;
    --parts_left;
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

Eigen::Matrix2d UvByPixel(const Eigen::Matrix3d& corners, const Matrix2x3d& d_pixel_d_x, const Matrix32d& corner_uv) {
  Matrix32d E;
  E << (corners.row(1) - corners.row(0)).transpose(), (corners.row(2) - corners.row(0)).transpose();
  Eigen::Matrix2d U;
  U << (corner_uv.row(1) - corner_uv.row(0)).transpose(), (corner_uv.row(2) - corner_uv.row(0)).transpose();
  return U * (d_pixel_d_x * E).inverse();
}

RenderedUvPixels::RenderedUvPixels(const BodyModel& model, std::shared_ptr<const Skinner> skinner,
                                   const std::vector<DenseKeypoint>& keypoints, const RenderedUvOptions& options)
    : keypoints_(keypoints), skinner_(std::move(skinner)), options_(options), taken_(keypoints.size(), 0) {
  BODYLOOM_CHECK(model.has_parts() && model.data().face_iuv.rows() == model.num_faces(), "rendered UV: the body '",
                 model.name(), "' has no charts with coordinates");
  for (int i : StratifiedKeypoints(model, keypoints, options.max_points)) {
    const DenseKeypoint& point = keypoints[i];
    Pixel pixel;
    pixel.keypoint = i;
    pixel.part = model.data().face_part[point.face];
    if (pixel.part == 0) continue;
    pixel.pixel = point.pixel.cast<double>();
    const Eigen::Vector3d b = point.barycentric.cast<double>();
    pixel.uv = CornerUv(model, point.face).transpose() * b / b.sum();
    chosen_.push_back(pixel);
  }
}

void RenderedUvPixels::SetWhitening(const std::vector<DenseWhitening>& whitening) {
  BODYLOOM_CHECK(whitening.size() == taken_.size(), "rendered UV: ", whitening.size(), " covariances for ",
                 taken_.size(), " keypoints");
  pixels_.clear();
  std::fill(taken_.begin(), taken_.end(), 0);
  valid_ = false;
  for (Pixel pixel : chosen_) {
    const DenseWhitening& w = whitening[pixel.keypoint];
    pixel.pixel_by_uv = w.pixel_by_uv;
    pixel.whitening = w.whitening;
    pixel.residual_by_uv = w.whitening * w.pixel_by_uv;
    if (!pixel.residual_by_uv.allFinite() || pixel.residual_by_uv.isZero(0)) continue;
    taken_[pixel.keypoint] = 1;
    pixels_.push_back(pixel);
  }
}

const std::vector<int>& RenderedUvPixels::VisibleFaces(const BodyModel& model, const FrameState& state,
                                                       const Eigen::VectorXd& betas, const Eigen::Vector3d& translation,
                                                       const Camera& camera, VisibleSurface* surface) {
  if (valid_ && hold_) return faces_;
  if (valid_ && state_.translation == state.translation && fx_ == camera.fx && betas_.size() == betas.size() &&
      betas_ == betas && state_.rotations == state.rotations) {
    return faces_;
  }
  state_ = state;
  betas_ = betas;
  fx_ = camera.fx;
  valid_ = true;
  faces_.assign(pixels_.size(), -1);
  ++num_rasterised_;
  if (pixels_.empty() || !surface->Render(skinner_, model, betas, state.rotations, translation, camera)) return faces_;
  for (size_t i = 0; i < pixels_.size(); ++i) {
    const double x = std::floor(pixels_[i].pixel.x() + 0.5), y = std::floor(pixels_[i].pixel.y() + 0.5);
    if (!(std::abs(x) < 1e6 && std::abs(y) < 1e6)) continue;
    faces_[i] = surface->buffer().FaceAt(static_cast<int>(x), static_cast<int>(y));
  }
  return faces_;
}

void RenderedUvTerm::Add(FrameAccumulator* sums) const {
  if (term == nullptr) return;
  const FrameLayout& layout = sums->layout();
  const BodyModel& model = *layout.model;
  const Kinematics& kinematics = sums->kinematics();
  const Camera& camera = sums->camera();
  const bool derivatives = sums->derivatives();
  PixelResiduals* residuals = sums->residuals("rendered UV");
  const MatrixX3i& faces = model.data().faces;
  const std::vector<int>& seen = term->VisibleFaces(model, sums->state(), sums->betas(),
                                                    layout.BodyTranslation(sums->state()), camera, &sums->surface());
  for (size_t i = 0; i < seen.size(); ++i) {
    const RenderedUvPixels::Pixel& pixel = term->pixels()[i];
    SeenUv uv;
    Matrix3d corners;
    const bool same_chart = seen[i] >= 0 && model.data().face_part[seen[i]] == pixel.part;
    if (same_chart) {
      for (int c = 0; c < 3; ++c) {
        corners.row(c) = PointEvaluator::VertexPosition(kinematics, faces(seen[i], c), &sums->vertices()).transpose();
      }
    }
    if (same_chart && SeeUv(camera, corners, CornerUv(model, seen[i]), pixel.pixel, term->min_cosine(), &uv)) {
      const Vector3d x = sums->points().Evaluate(kinematics, faces.row(seen[i]).data(), uv.barycentric.data(),
                                                 &sums->vertices(), derivatives);
      FrameAccumulator::Projected at;
      if (sums->Project(x, &at)) {
        const Vector2d off = uv.uv - pixel.uv;
        Matrix2d B = Matrix2d::Zero();
        if (derivatives) B = -pixel.residual_by_uv * UvByPixel(corners, at.d_pixel_d_x, CornerUv(model, seen[i]));
        if (residuals != nullptr) residuals->px.push_back((pixel.pixel_by_uv * off).norm());
        sums->AddImageRows<2>(at, pixel.residual_by_uv * off, B, kernel, term->weight());
        continue;
      }
    }
    if (residuals != nullptr) ++residuals->unmatched;
    if (!term->unmatched_reproject()) {
      sums->AddSaturated(kernel, term->weight());
      continue;
    }
    const DenseKeypoint& point = term->keypoints()[pixel.keypoint];
    const Vector3d barycentric = point.barycentric.cast<double>();
    const Vector3d x = sums->points().Evaluate(kinematics, faces.row(point.face).data(), barycentric.data(),
                                               &sums->vertices(), derivatives);
    sums->AddPixel(x, pixel.pixel, pixel.whitening, kernel, term->weight());
  }
}

}  // namespace bodyloom
