// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/dense/dense.h"

#include <algorithm>
#include <cmath>

#include "tracking/problem/clip_term.h"
#include "tracking/problem/frame_accumulator.h"
#include "tracking/problem/robust.h"
#include "tracking/problem/track_input.h"
#include "tracking/problem/track_summary.h"
#include "tracking/terms/dense/dense_points.h"

namespace bodyloom {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

struct DenseScratch {
  DensePoints points;
  std::vector<DensePoints::Row> rows;
  std::vector<char> has_row;
};

}  // namespace

void DenseTerm::Add(FrameAccumulator* sums) const {
  if (size() == 0) return;
  DenseScratch& scratch = sums->Scratch<DenseScratch>();
  const FrameLayout& layout = sums->layout();
  const Camera& camera = sums->camera();
  const bool derivatives = sums->derivatives();
  std::vector<DensePoints::Row>& rows = scratch.rows;
  std::vector<char>& has_row = scratch.has_row;
  const bool thin = sums->max_points > 0 && taken == nullptr;
  const size_t step = thin ? std::max<size_t>(1, points->size() / static_cast<size_t>(sums->max_points)) : 1;
  const auto weight = static_cast<double>(step);
  scratch.points.Pose(sums->kinematics(), *points, step, derivatives);
  if (derivatives) {
    rows.resize(points->size());
    has_row.assign(points->size(), 0);
  }
  for (size_t i = 0, n = 0; i < points->size(); i += step, ++n) {
    if (taken != nullptr && (*taken)[i] != 0) continue;
    FrameAccumulator::Projected at;
    if (!sums->Project(scratch.points.position(n), &at)) {
      sums->AddSaturated(kernel, weight);
      continue;
    }
    const DenseKeypoint& point = (*points)[i];
    const Matrix2d W = whitening.empty() ? Matrix2d(Matrix2d::Identity() / point.sigma_px) : whitening[i].whitening;
    const Vector2d residual = W * (at.pixel - point.pixel.cast<double>());
    const RobustValue robust = GemanMcClure(residual.squaredNorm(), kernel);
    sums->AddCost(0.5 * weight * robust.rho);
    if (!derivatives) continue;
    const double scale = std::sqrt(weight * robust.weight);
    const Matrix2d by_pixel = scale * W;
    DensePoints::Row& row = rows[n];
    has_row[n] = 1;
    row.A = by_pixel * at.d_pixel_d_x;
    row.residual = scale * residual;
    if (layout.knowledge == CameraKnowledge::kWeak) {
      const Matrix2d by_offset = camera.scale * by_pixel;
      row.translation.col(0) = by_offset * Vector2d(at.x.x() + camera.tx, at.x.y() + camera.ty);
      row.translation.rightCols<2>() = by_offset;
    } else {
      row.translation = row.A;
    }
    if (layout.focal_column >= 0) row.focal = by_pixel * (at.pixel - Vector2d(camera.cx, camera.cy));
  }
  if (!derivatives) return;
  const DensePoints::Columns columns{&layout.column_of_joint, layout.translation_column, layout.beta_column,
                                     layout.focal_column};
  scratch.points.Accumulate(columns, rows, has_row, sums->H().data(), sums->H().cols(), sums->gradient().data());
}

void AppendDenseErrors(const std::vector<DenseKeypoint>& keypoints, const Camera& camera, const Kinematics& kinematics,
                       PointEvaluator::VertexCache* vertices, std::vector<double>* errors_px) {
  PointEvaluator points;
  Vector2d pixel;
  for (const DenseKeypoint& point : keypoints) {
    const Vector3d barycentric = point.barycentric.cast<double>();
    const Vector3d x = points.Evaluate(kinematics, kinematics.model->data().faces.row(point.face).data(),
                                       barycentric.data(), vertices, false);
    if (camera.Project(x, &pixel)) errors_px->push_back((pixel - point.pixel.cast<double>()).norm());
  }
}

std::vector<PlanEntry> PlanDense(const TrackSequenceInput& input, const TrackSequenceOptions& /*options*/) {
  const bool runs = input.dense != nullptr;
  return {{"dense keypoints (L_f)", runs, runs ? "in the input" : "no dense keypoints in the input"}};
}

std::unique_ptr<ClipTerm> MakeDenseTerms(const ClipTermInput& clip) {
  if (clip.input.dense == nullptr) return nullptr;
  return EachFrame([dense = clip.input.dense](int t, const FrameState&, FrameData* frame) {
    frame->Get<DenseTerm>().points = &dense->frames[t];
  });
}

}  // namespace bodyloom
