// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/surface_contact/surface_contact.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "tracking/problem/frame_accumulator.h"

namespace bodyloom {

using Eigen::Vector3d;

void SurfaceContactTerm::Add(FrameAccumulator* sums) const {
  if (!(weight > 0)) return;
  const FrameLayout& layout = sums->layout();
  // Except for weak perspective the kinematics include the translation.
  const bool weak = layout.knowledge == CameraKnowledge::kWeak;
  const Vector3d offset = weak ? layout.BodyPlace(sums->state()) : Vector3d::Zero();
  const Eigen::RowVector3d by_place = up.transpose() * layout.BodyPlaceByTranslation(sums->state()) / sigma_m;
  Eigen::Matrix<double, 2, 3> across;
  across.row(0) = up.unitOrthogonal().transpose();
  across.row(1) = up.cross(Vector3d(across.row(0).transpose())).transpose();
  const Eigen::Matrix<double, 2, 3> across_by_place = across * layout.BodyPlaceByTranslation(sums->state());
  constexpr double kVertexAlone[3] = {1, 0, 0};
  for (const Contact& contact : contacts) {
    const int vertices[3] = {contact.vertex, contact.vertex, contact.vertex};
    const auto place = [&](bool jacobian) {
      return sums->points().Evaluate(sums->kinematics(), vertices, kVertexAlone, &sums->vertices(), jacobian);
    };
    // Derivatives only of points that cost something, which few do.
    const Vector3d x = place(false);
    const double height = (up.dot(x + offset) - level_m - contact.rest_m) / sigma_m;
    const bool free = !contact.touches && height >= 0;
    if (free && !sums->one_by_one()) continue;
    if (contact.held_m) {
      const Eigen::Vector2d off = across * (x + offset - *contact.held_m) / hold_sigma_m;
      const double scale = sums->AddGroup(2, off.squaredNorm(), kHoldKernel, hold_weight * weight);
      if (sums->derivatives()) {
        place(true);
        auto rows = sums->NextRows(3);
        sums->FillPointRows(rows);
        const Eigen::MatrixXd d_off = scale / hold_sigma_m * across * rows;
        rows.topRows(2) = d_off;
        rows.topRows(2).middleCols<3>(layout.translation_column) = scale / hold_sigma_m * across_by_place;
        sums->NextResiduals(2) = scale * off;
        sums->TakeRows(2);
        sums->DependsOnPoint();
        sums->DependsOn(layout.TranslationBlock());
      }
    }
    const double residual = free ? 0 : height;
    const double scale = sums->AddGroup(1, residual * residual, kSurfaceContactKernel, weight * contact.share);
    if (!sums->derivatives()) continue;
    place(true);
    auto rows = sums->NextRows(3);
    sums->FillPointRows(rows);
    const Eigen::RowVectorXd row = scale / sigma_m * up.transpose() * rows;
    rows.row(0) = row;
    rows.row(0).segment<3>(layout.translation_column) = scale * by_place;
    if (free) rows.row(0).setZero();
    sums->NextResiduals(1)[0] = scale * residual;
    sums->TakeRows(1);
    sums->DependsOnPoint();
    sums->DependsOn(layout.TranslationBlock());
  }
}

}  // namespace bodyloom
