// SPDX-License-Identifier: Apache-2.0
#include "tracking/terms/dense/dense_points.h"

#include <algorithm>
#include <utility>

#include "geometry/base/check.h"
#include "tracking/problem/panel_simd.h"

namespace bodyloom {

using panel_internal::RowStride;

void DensePoints::SetBody(const Kinematics& kinematics) {
  const BodyModel& model = *kinematics.model;
  const BodyModelData& d = model.data();
  const auto V = static_cast<size_t>(model.num_vertices());
  if (model_ != &model || shaped_stamp_.size() != V) {
    BODYLOOM_CHECK(model.num_joints() <= dense_internal::kMaxGroupJoints, "dense keypoints: the body '", model.name(),
                   "' has ", model.num_joints(), " joints, expected at most ", dense_internal::kMaxGroupJoints);
    model_ = &model;
    betas_.resize(0);
    shaped_stamp_.assign(V, 0);
    posed_stamp_.assign(V, 0);
    posed_.resize(3 * V);
    shaped_.resize(3 * V);
    rest_.resize(3 * V);
    vertices_.shape = vertices_.frame = 0;
    joints_of_vertex_.clear();
    if (model.num_joints() <= 64) {
      std::vector<uint64_t> chain(model.num_joints());  // a joint and its ancestors
      for (int j = 0; j < model.num_joints(); ++j) {
        chain[j] = (uint64_t{1} << j) | (j > 0 ? chain[model.parents()[j]] : 0);
      }
      joints_of_vertex_.resize(V);
      for (size_t v = 0; v < V; ++v) {
        for (int e = model.influence_begin()[v]; e < model.influence_begin()[v + 1]; ++e) {
          joints_of_vertex_[v] |= chain[model.influence_joint()[e]];
        }
        if (d.posedirs.begin.empty()) continue;
        for (int e = d.posedirs.begin[v]; e < d.posedirs.begin[v + 1]; ++e) {
          joints_of_vertex_[v] |= uint64_t{1} << d.posedirs.joint[e];
        }
      }
    }
  }
  if (vertices_.shape == 0 || betas_.size() != kinematics.betas.size() || betas_ != kinematics.betas) {
    betas_ = kinematics.betas;
    ++vertices_.shape;
  }
  ++vertices_.frame;
  vertices_.shaped_stamp = shaped_stamp_.data();
  vertices_.posed_stamp = posed_stamp_.data();
  vertices_.shaped = shaped_.data();
  vertices_.rest = rest_.data();
  vertices_.posed = posed_.data();
  body_.influence_begin = model.influence_begin().data();
  body_.influence_joint = model.influence_joint().data();
  body_.influence_weight = model.influence_weight().data();
  body_.corrective_begin = d.posedirs.begin.empty() ? nullptr : d.posedirs.begin.data();
  body_.corrective_joint = d.posedirs.joint.data();
  body_.corrective_block = d.posedirs.block.data();
  body_.shapedirs = d.shapedirs.data();
  body_.shape_stride = static_cast<int>(d.shapedirs.cols());
  body_.v_template = d.v_template.data();
  body_.num_joints = model.num_joints();
  frame_.num_betas = static_cast<int>(betas_.size());
  frame_.betas = betas_.data();
  frame_.feature = kinematics.feature[0].data();
  transform_.resize(static_cast<size_t>(16) * body_.num_joints);
  for (int j = 0; j < body_.num_joints; ++j) {
    Eigen::Map<Eigen::Matrix4d> transform(transform_.data() + 16 * j);
    transform.topLeftCorner<3, 3>() = kinematics.G[j];
    transform.topRightCorner<3, 1>() = kinematics.t[j];
    transform.bottomRows<1>() << 0, 0, 0, 1;
  }
  frame_.transform = transform_.data();
}

void DensePoints::SetDerivatives(const Kinematics& kinematics) {
  using RowsOfFour = Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>>;
  const int B = frame_.num_betas, J = body_.num_joints;
  frame_.dt_stride = panel_internal::RoundUp(B);
  rotation_.assign(static_cast<size_t>(12) * J, 0.0);
  joint_.assign(static_cast<size_t>(4) * J, 1.0);
  feature_jacobian_.assign(static_cast<size_t>(36) * J, 0.0);
  dt_.assign(static_cast<size_t>(3) * J * frame_.dt_stride, 0.0);
  for (int j = 0; j < J; ++j) {
    RowsOfFour(rotation_.data() + 12 * j, 3, 4).leftCols<3>() = kinematics.G[j];
    RowsOfFour(joint_.data() + 4 * j, 1, 4).leftCols<3>() = kinematics.p[j].transpose();
    RowsOfFour(feature_jacobian_.data() + 36 * j, 9, 4).leftCols<3>() = kinematics.feature_jacobian[j];
    Eigen::Map<RowMatrixXd>(dt_.data() + static_cast<int64_t>(3) * j * frame_.dt_stride, 3, frame_.dt_stride)
        .leftCols(B) = kinematics.dt[j];
  }
  frame_.rotation = rotation_.data();
  frame_.joint = joint_.data();
  frame_.feature_jacobian = feature_jacobian_.data();
  frame_.dt = dt_.data();
}

void DensePoints::Pose(const Kinematics& kinematics, const std::vector<DenseKeypoint>& keypoints, size_t step,
                       bool derivatives) {
  SetBody(kinematics);
  if (derivatives) SetDerivatives(kinematics);
  const MatrixX3i& faces = kinematics.model->data().faces;
  points_.resize((keypoints.size() + step - 1) / step);
  positions_.resize(3 * points_.size());
  for (size_t i = 0; i < points_.size(); ++i) {
    const DenseKeypoint& keypoint = keypoints[i * step];
    const Eigen::Vector3d barycentric = keypoint.barycentric.cast<double>();
    // Detectors' floats sum to 1 within rounding only; the weights have to do so exactly for d x / d trans = I.
    const double sum = barycentric[0] + barycentric[1] + barycentric[2];
    for (int k = 0; k < 3; ++k) {
      points_[i].vertex[k] = faces(keypoint.face, k);
      points_[i].weight[k] = barycentric[k] / sum;
    }
  }
  dense_internal::PosePoints(body_, frame_, vertices_, points_.data(), static_cast<int>(points_.size()),
                             positions_.data());
}

void DensePoints::Accumulate(const Columns& columns, const std::vector<Row>& rows, const std::vector<char>& has_row,
                             double* H, int64_t stride, double* gradient) {
  for (Group& group : groups_) group.points.clear();
  A_.resize(6 * points_.size());
  Group* last = nullptr;
  for (size_t i = 0; i < points_.size(); ++i) {
    if (!has_row[i]) continue;
    std::copy(rows[i].A.data(), rows[i].A.data() + 6, &A_[6 * i]);
    uint64_t joints = ~uint64_t{0};
    if (!joints_of_vertex_.empty()) {
      joints = 0;
      for (int k = 0; k < 3; ++k) {
        if (points_[i].weight[k] != 0) joints |= joints_of_vertex_[points_[i].vertex[k]];
      }
    }
    if (last == nullptr || last->joints != joints) {
      const auto found =
          std::find_if(groups_.begin(), groups_.end(), [&](const Group& group) { return group.joints == joints; });
      if (found != groups_.end()) {
        last = &*found;
      } else {
        last = &groups_.emplace_back();
        last->joints = joints;
      }
    }
    last->points.push_back(static_cast<int>(i));
  }
  // In the order of the sets, not of their first appearance, which would depend on the frames seen before.
  std::sort(groups_.begin(), groups_.end(), [](const Group& a, const Group& b) { return a.joints < b.joints; });
  for (const Group& group : groups_) {
    if (!group.points.empty()) FlushGroup(columns, group, rows, H, stride, gradient);
  }
}

void DensePoints::FlushGroup(const Columns& columns, const Group& group, const std::vector<Row>& rows, double* H,
                             int64_t stride, double* gradient) {
  const int J = body_.num_joints, B = frame_.num_betas;
  std::vector<int> joints, parent, local_column, of_joint(J, -1), global;  // global: column in H of each local one
  for (int j = 0; j < J; ++j) {
    if (J <= 64 && (group.joints >> j & 1) == 0) continue;
    of_joint[j] = static_cast<int>(joints.size());
    parent.push_back(j > 0 ? of_joint[model_->parents()[j]] : -1);
    joints.push_back(j);
    const int column = (*columns.of_joint)[j];
    local_column.push_back(column < 0 ? -1 : static_cast<int>(global.size()));
    for (int c = 0; c < 3 && column >= 0; ++c) global.push_back(column + c);
  }
  const int translation = static_cast<int>(global.size());
  for (int c = 0; c < 3; ++c) global.push_back(columns.translation + c);
  const int beta = static_cast<int>(global.size());
  for (int b = 0; b < B; ++b) global.push_back(columns.beta + b);
  const int focal = columns.focal >= 0 ? static_cast<int>(global.size()) : -1;
  if (focal >= 0) global.push_back(columns.focal);
  const int residual = static_cast<int>(global.size()), width = residual + 1;

  dense_internal::Group plan;
  plan.num_joints = static_cast<int>(joints.size());
  plan.joints = joints.data();
  plan.parent = parent.data();
  plan.column = local_column.data();
  plan.of_joint = of_joint.data();
  plan.beta_column = beta;
  constexpr int kAtOnce = 64;  // points; their rows fit into the first two levels of cache
  const int64_t row_stride = RowStride(width);
  buffer_.assign(2 * std::min<size_t>(kAtOnce, group.points.size()) * row_stride, 0.0);
  products_.assign(static_cast<size_t>(width) * row_stride, 0.0);
  for (size_t first = 0; first < group.points.size(); first += kAtOnce) {
    const int n = static_cast<int>(std::min<size_t>(kAtOnce, group.points.size() - first));
    const int* chosen = &group.points[first];
    dense_internal::FillRows(body_, frame_, vertices_, plan, points_.data(), chosen, n, A_.data(), buffer_.data(),
                             row_stride);
    for (int i = 0; i < n; ++i) {
      const Row& row = rows[chosen[i]];
      for (int r = 0; r < 2; ++r) {
        double* out = &buffer_[(2 * i + r) * row_stride];
        for (int c = 0; c < 3; ++c) out[translation + c] = row.translation(r, c);
        if (focal >= 0) out[focal] = row.focal[r];
        out[residual] = row.residual[r];
      }
    }
    panel_internal::Products products;
    products.a = products.b = buffer_.data();
    products.c = products_.data();
    products.lda = products.ldb = products.ldc = row_stride;
    products.rows = products.columns = width;
    products.last = 2 * n;
    products.upper = true;
    panel_internal::AddProducts(products);
  }
  for (int i = 0; i < residual; ++i) {
    const double* row = &products_[i * row_stride];
    for (int j = i; j < residual; ++j) {
      // Unknowns need not stand in the order of the joints.
      const auto [low, high] = std::minmax(global[i], global[j]);
      H[low * stride + high] += row[j];
    }
    gradient[global[i]] += row[residual];
  }
}

}  // namespace bodyloom
