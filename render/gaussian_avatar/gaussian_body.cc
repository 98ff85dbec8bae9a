// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/gaussian_body.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/base/check.h"

namespace bodyloom {

void GaussianBody::Resize(int count) {
  parameters.Resize(kNumParameters, count);
  parameters.Fill(0);
  joints.assign(static_cast<size_t>(count) * kInfluences, 0);
  anchors.assign(count, {});
  kinds.assign(count, GaussianKind::kSkin);
}

bool GaussianBody::IsValid(int num_joints, int num_faces, std::string* why) const {
  const auto refuse = [&](const auto&... parts) {
    if (why != nullptr) *why = Concatenate(parts...);
    return false;
  };
  const size_t count = parameters.rows();
  if (parameters.columns() != kNumParameters || joints.size() != count * kInfluences || anchors.size() != count ||
      kinds.size() != count) {
    return refuse("the body of ", count, " Gaussians has ", parameters.columns(), " columns, ", joints.size(),
                  " joints, ", anchors.size(), " anchors, ", kinds.size(), " kinds, expected ",
                  static_cast<int>(kNumParameters), ", ", count * kInfluences, ", ", count, ", ", count);
  }
  // Reductions over whole arrays, which vectorise; this runs every frame.
  uint32_t largest_joint = 0, largest_face = 0;
  for (const int32_t joint : joints) largest_joint = std::max(largest_joint, static_cast<uint32_t>(joint));
  for (const SkinAnchor& anchor : anchors) largest_face = std::max(largest_face, static_cast<uint32_t>(anchor.face));
  if (count > 0 && largest_joint >= static_cast<uint32_t>(num_joints)) {
    return refuse("joint ", static_cast<int32_t>(largest_joint), ", expected 0 to ", num_joints - 1);
  }
  if (count > 0 && largest_face >= static_cast<uint32_t>(num_faces)) {
    return refuse("anchor on face ", static_cast<int32_t>(largest_face), ", expected 0 to ", num_faces - 1);
  }
  return true;
}

bool ScaleLimits::IsValid(std::string* why) const {
  const InRange in_range(why);
  return in_range("min_log", min_log, -30, 30) && in_range("max_log", max_log, min_log, 30) &&
         in_range("max_axis_ratio", max_axis_ratio, 1, 1e6);
}

int LimitScales(const ScaleLimits& limits, GaussianBody* body) {
  std::string why;
  BODYLOOM_CHECK(limits.IsValid(&why), "scale limits: ", why);
  const float longest_over_second = std::log(limits.max_axis_ratio);
  int changed = 0;
  for (int i = 0; i < body->size(); ++i) {
    std::array<float, 3> scale;
    for (int k = 0; k < 3; ++k) {
      scale[k] = std::clamp(body->parameters(i, GaussianBody::kLogScale + k), limits.min_log, limits.max_log);
    }
    const int longest = static_cast<int>(std::max_element(scale.begin(), scale.end()) - scale.begin());
    const float second = std::max(scale[(longest + 1) % 3], scale[(longest + 2) % 3]);
    scale[longest] = std::min(scale[longest], second + longest_over_second);
    bool is_changed = false;
    for (int k = 0; k < 3; ++k) {
      float& old = body->parameters(i, GaussianBody::kLogScale + k);
      is_changed = is_changed || old != scale[k];
      old = scale[k];
    }
    changed += static_cast<int>(is_changed);
  }
  return changed;
}

void SetFlatGaussian(const FlatGaussian& gaussian, int row, GaussianBody* body) {
  constexpr double kMinSigma_m = 1e-5;
  using Body = GaussianBody;
  const Eigen::Quaterniond turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), gaussian.normal);
  const float quaternion[4] = {float(turn.w()), float(turn.x()), float(turn.y()), float(turn.z())};
  FloatColumns& p = body->parameters;
  for (int k = 0; k < 4; ++k) p(row, Body::kQuaternion + k) = quaternion[k];
  for (int k = 0; k < 3; ++k) {
    p(row, Body::kPosition + k) = static_cast<float>(gaussian.place[k]);
    p(row, Body::kNormal + k) = static_cast<float>(gaussian.normal[k]);
    p(row, Body::kLogScale + k) =
        static_cast<float>(std::log(std::max(kMinSigma_m, gaussian.sigma_m * (k == 2 ? gaussian.flatness : 1))));
    p(row, Body::kAlbedo + k) = gaussian.albedo;
  }
  p(row, Body::kOpacityLogit) = gaussian.opacity_logit;
}

VertexAnchors::VertexAnchors(const BodyModel& model) : model_(model), face_of_(model.num_vertices(), 0) {
  for (int f = model.num_faces() - 1; f >= 0; --f) {
    for (int c = 0; c < 3; ++c) face_of_[model.data().faces(f, c)] = f;
  }
}

SkinAnchor VertexAnchors::At(int vertex, float corrective_factor) const {
  SkinAnchor anchor;
  anchor.face = face_of_[vertex];
  anchor.barycentric = {0, 0, 0};
  for (int c = 0; c < 3; ++c) {
    if (model_.data().faces(anchor.face, c) == vertex) anchor.barycentric[c] = 1;
  }
  anchor.corrective_factor = corrective_factor;
  return anchor;
}

}  // namespace bodyloom
