// SPDX-License-Identifier: Apache-2.0
// The image terms of FrameEvaluator: 2D joints, dense keypoints in the image and in UV, outlines and part labels. All
// of them are functions of where a point of the body appears, so all share one chain of derivatives (AddImageRows).
#include <algorithm>
#include <cmath>

#include "bodyloom/tracking/frame_cost.h"
#include "bodyloom/tracking/residuals/dense_whitening.h"
#include "bodyloom/tracking/residuals/part_label_term.h"
#include "bodyloom/tracking/residuals/rendered_uv_term.h"
#include "bodyloom/tracking/robust.h"

namespace bodyloom {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

bool FrameEvaluator::Project(const Vector3d& x, bool derivatives, Projected* projected) {
  projected->x = x;
  return camera_.Project(x, &projected->pixel, derivatives ? &projected->d_pixel_d_x : nullptr);
}

void FrameEvaluator::AddSaturated(double kernel, double weight) {
  cost_ += 0.5 * weight * kernel * kernel;
  ++num_invalid_;
}

template <int N>
void FrameEvaluator::AddImageRows(const FrameLayout& layout, const Projected& at,
                                  const Eigen::Matrix<double, N, 1>& residual, const Eigen::Matrix<double, N, 2>& B,
                                  double kernel, double weight, bool derivatives) {
  const RobustValue robust = GemanMcClure(residual.squaredNorm(), kernel);
  cost_ += 0.5 * weight * robust.rho;
  if (!derivatives) return;
  const double scale = std::sqrt(weight * robust.weight);
  const Eigen::Matrix<double, N, 2> by_pixel = scale * B;
  const Eigen::Matrix<double, N, 3> A = by_pixel * at.d_pixel_d_x;
  auto rows = J_.middleRows<N>(row_);
  rows.setZero();
  for (int j : points_.joints()) {
    const int column = layout.column_of_joint[j];
    if (column >= 0) rows.template middleCols<3>(column).noalias() = A * points_.JointJacobian(kinematics_, j);
  }
  if (layout.knowledge == CameraKnowledge::kWeak) {
    const Eigen::Matrix<double, N, 2> by_offset = camera_.scale * by_pixel;
    rows.col(layout.translation_column) = by_offset * Vector2d(at.x.x() + camera_.tx, at.x.y() + camera_.ty);
    rows.col(layout.translation_column + 1) = by_offset.col(0);
    rows.col(layout.translation_column + 2) = by_offset.col(1);
  } else {
    rows.template middleCols<3>(layout.translation_column) = A;
  }
  if (layout.num_betas > 0) {
    rows.middleCols(layout.beta_column, layout.num_betas).noalias() = A * points_.ShapeJacobian();
  }
  if (layout.focal_column >= 0) {
    rows.col(layout.focal_column) = by_pixel * (at.pixel - Vector2d(camera_.cx, camera_.cy));
  }
  r_.segment<N>(row_) = scale * residual;
  row_ += N;
}

void FrameEvaluator::AddPixel(const FrameLayout& layout, const Vector3d& x, const Vector2d& pixel,
                              const Matrix2d& whitening, double kernel, double weight, bool derivatives) {
  Projected at;
  if (!Project(x, derivatives, &at)) {
    AddSaturated(kernel, weight);
    return;
  }
  AddImageRows<2>(layout, at, whitening * (at.pixel - pixel), whitening, kernel, weight, derivatives);
}

void FrameEvaluator::AddDense(const FrameLayout& layout, const FrameData& data, bool derivatives) {
  const std::vector<DenseKeypoint>& points = *data.dense;
  const bool thin = max_dense_ > 0 && data.rendered_uv == nullptr;
  const size_t step = thin ? std::max<size_t>(1, points.size() / static_cast<size_t>(max_dense_)) : 1;
  const auto weight = static_cast<double>(step);
  dense_points_.Pose(kinematics_, points, step, derivatives);
  if (derivatives) {
    dense_rows_.resize(points.size());
    has_dense_row_.assign(points.size(), 0);
  }
  for (size_t i = 0, n = 0; i < points.size(); i += step, ++n) {
    if (data.rendered_uv != nullptr && data.rendered_uv->Has(i)) continue;
    Projected at;
    if (!Project(dense_points_.position(n), derivatives, &at)) {
      AddSaturated(data.dense_kernel, weight);
      continue;
    }
    const Matrix2d whitening = data.dense_whitening.empty() ? Matrix2d(Matrix2d::Identity() / points[i].sigma_px)
                                                            : data.dense_whitening[i].whitening;
    const Vector2d residual = whitening * (at.pixel - points[i].pixel.cast<double>());
    const RobustValue robust = GemanMcClure(residual.squaredNorm(), data.dense_kernel);
    cost_ += 0.5 * weight * robust.rho;
    if (!derivatives) continue;
    const double scale = std::sqrt(weight * robust.weight);
    const Matrix2d by_pixel = scale * whitening;
    DensePoints::Row& row = dense_rows_[n];
    has_dense_row_[n] = 1;
    row.A = by_pixel * at.d_pixel_d_x;
    row.residual = scale * residual;
    if (layout.knowledge == CameraKnowledge::kWeak) {
      const Matrix2d by_offset = camera_.scale * by_pixel;
      row.translation.col(0) = by_offset * Vector2d(at.x.x() + camera_.tx, at.x.y() + camera_.ty);
      row.translation.rightCols<2>() = by_offset;
    } else {
      row.translation = row.A;
    }
    if (layout.focal_column >= 0) row.focal = by_pixel * (at.pixel - Vector2d(camera_.cx, camera_.cy));
  }
  if (!derivatives) return;
  const DensePoints::Columns columns{&layout.column_of_joint, layout.translation_column, layout.beta_column,
                                     layout.focal_column};
  dense_points_.Accumulate(columns, dense_rows_, has_dense_row_, H_.data(), H_.cols(), gradient_.data());
}

void FrameEvaluator::AddRenderedUv(const FrameLayout& layout, const FrameData& data, const FrameState& state,
                                   const VectorXd& betas, bool derivatives, FrameResiduals* residuals) {
  RenderedUvTerm& term = *data.rendered_uv;
  const BodyModel& model = *layout.model;
  const MatrixX3i& faces = model.data().faces;
  const std::vector<int>& seen =
      term.VisibleFaces(model, state, betas, layout.BodyTranslation(state), camera_, &surface_);
  for (size_t i = 0; i < seen.size(); ++i) {
    const RenderedUvTerm::Pixel& pixel = term.pixels()[i];
    SeenUv uv;
    Matrix3d corners;
    const bool same_chart = seen[i] >= 0 && model.data().face_part[seen[i]] == pixel.part;
    if (same_chart) {
      for (int c = 0; c < 3; ++c) {
        corners.row(c) = PointEvaluator::VertexPosition(kinematics_, faces(seen[i], c), &vertices_).transpose();
      }
    }
    if (same_chart && SeeUv(camera_, corners, CornerUv(model, seen[i]), pixel.pixel, term.min_cosine(), &uv)) {
      const Vector3d x =
          points_.Evaluate(kinematics_, faces.row(seen[i]).data(), uv.barycentric.data(), &vertices_, derivatives);
      Projected at;
      if (Project(x, derivatives, &at)) {
        const Vector2d off = uv.uv - pixel.uv;
        Matrix2d B = Matrix2d::Zero();
        if (derivatives) B = -pixel.residual_by_uv * UvByPixel(corners, at.d_pixel_d_x, CornerUv(model, seen[i]));
        if (residuals != nullptr) residuals->rendered_uv_px.push_back((pixel.pixel_by_uv * off).norm());
        AddImageRows<2>(layout, at, pixel.residual_by_uv * off, B, data.dense_kernel, term.weight(), derivatives);
        continue;
      }
    }
    if (residuals != nullptr) ++residuals->rendered_uv_unmatched;
    if (!term.unmatched_reproject()) {
      AddSaturated(data.dense_kernel, term.weight());
      continue;
    }
    const DenseKeypoint& point = (*data.dense)[pixel.keypoint];
    const Vector3d barycentric = point.barycentric.cast<double>();
    const Vector3d x =
        points_.Evaluate(kinematics_, faces.row(point.face).data(), barycentric.data(), &vertices_, derivatives);
    AddPixel(layout, x, pixel.pixel, pixel.whitening, data.dense_kernel, term.weight(), derivatives);
  }
}

void FrameEvaluator::AddPartLabels(const FrameLayout& layout, const FrameData& data, bool derivatives,
                                   FrameResiduals* residuals) {
  const PartLabelTerm& term = *data.part_labels;
  const MatrixX3i& faces = layout.model->data().faces;
  for (const PartLabelTerm::Target& target : term.targets()) {
    const Vector3d x = points_.Evaluate(kinematics_, faces.row(target.face).data(), target.barycentric.data(),
                                        &vertices_, derivatives);
    AddPixel(layout, x, target.pixel, target.whitening, term.kernel(), target.weight, derivatives);
  }
  for (const PartLabelTerm::OutlinePoint& point : term.outline()) {
    const Vector3d x =
        points_.Evaluate(kinematics_, faces.row(point.face).data(), point.barycentric.data(), &vertices_, derivatives);
    Projected at;
    if (!Project(x, derivatives, &at)) {
      AddSaturated(term.kernel(), point.weight);
      continue;
    }
    Eigen::RowVector2d gradient;
    const double distance = point.field->Evaluate(at.pixel, &gradient) - point.offset_px;
    if (residuals != nullptr) {
      (point.is_silhouette ? residuals->silhouette_px : residuals->part_px).push_back(std::abs(distance));
    }
    AddImageRows<1>(layout, at, Eigen::Matrix<double, 1, 1>(distance * point.inverse_sigma),
                    gradient * point.inverse_sigma, term.kernel(), point.weight, derivatives);
  }
  if (residuals != nullptr) {
    residuals->silhouette_unmatched += term.silhouette_unmatched();
    residuals->part_unmatched += term.part_unmatched();
  }
}

}  // namespace bodyloom
