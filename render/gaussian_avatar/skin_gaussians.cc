// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/skin_gaussians.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "geometry/base/check.h"
#include "geometry/body/posed_body.h"

namespace bodyloom {
namespace {

using Eigen::Vector3d;
using Body = GaussianBody;

/// A point on cloth.
struct ClothPlace {
  Vector3d place, normal;
};

/// Area-weighted sampling of the garment's faces as sewn.
class SewnFaces {
 public:
  explicit SewnFaces(const LooseGarment& garment) : garment_(garment) {
    for (Eigen::Index f = 0; f < garment.cloth.faces.rows(); ++f) {
      area_ += 0.5 * Cross(f).norm();
      up_to_.push_back(area_);
    }
  }

  [[nodiscard]] double area() const { return area_; }

  /// `share` in [0, 1) of the area selects the face, a and b in [0, 1) the point on it.
  [[nodiscard]] ClothPlace At(double share, double a, double b) const {
    const auto found = std::upper_bound(up_to_.begin(), up_to_.end(), share * area_);
    const auto f = std::min<Eigen::Index>(found - up_to_.begin(), garment_.cloth.faces.rows() - 1);
    if (a + b > 1) a = 1 - a, b = 1 - b;
    const Vector3d& first = Corner(f, 0);
    return {first + a * (Corner(f, 1) - first) + b * (Corner(f, 2) - first), Cross(f).normalized()};
  }

 private:
  [[nodiscard]] const Vector3d& Corner(Eigen::Index f, int c) const {
    return garment_.sewn[garment_.cloth.faces(f, c)];
  }
  [[nodiscard]] Vector3d Cross(Eigen::Index f) const {
    return (Corner(f, 1) - Corner(f, 0)).cross(Corner(f, 2) - Corner(f, 0));
  }

  const LooseGarment& garment_;
  std::vector<double> up_to_;
  double area_ = 0;
};

/// Weights and joints of a point of the surface, in descending order of weight.
std::vector<std::pair<double, int>> WeightsAt(const BodyModel& model, int face, const Eigen::Vector3f& barycentric) {
  std::vector<std::pair<double, int>> weights;
  for (int c = 0; c < 3; ++c) {
    const int v = model.data().faces(face, c);
    for (int k = model.influence_begin()[v]; k < model.influence_begin()[v + 1]; ++k) {
      const int joint = model.influence_joint()[k];
      const double weight = barycentric[c] * model.influence_weight()[k];
      const auto known = std::find_if(weights.begin(), weights.end(), [&](const auto& w) { return w.second == joint; });
      if (known != weights.end()) {
        known->first += weight;
      } else {
        weights.emplace_back(weight, joint);
      }
    }
  }
  std::sort(weights.begin(), weights.end(),
            [](const auto& a, const auto& b) { return a.first != b.first ? a.first > b.first : a.second < b.second; });
  return weights;
}

void SetWeights(const BodyModel& model, int face, const Eigen::Vector3f& barycentric, int row, Body* body) {
  const auto weights = WeightsAt(model, face, barycentric);
  for (int k = 0; k < Body::kInfluences; ++k) {
    const bool has = k < static_cast<int>(weights.size());
    body->joints[static_cast<size_t>(row) * Body::kInfluences + k] = has ? weights[k].second : 0;
    body->parameters(row, Body::kWeightLogit + k) =
        static_cast<float>(std::log(std::max(1e-6, has ? weights[k].first : 0)));
  }
}

}  // namespace

bool SkinGaussiansOptions::IsValid(std::string* why) const {
  const InRange in_range(why);
  return in_range("texels_sigma", texels_sigma, 0.01, 100) && in_range("flatness", flatness, 0.001, 1) &&
         in_range("opacity_logit", opacity_logit, -20, 20) && in_range("albedo", albedo, 0, 1);
}

GaussianBody SkinGaussians(const BodyModel& model, const Eigen::VectorXd& betas, const UvTexelTable& texels,
                           const SkinGaussiansOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "skin Gaussians: ", why);
  BODYLOOM_CHECK(model.has_uv(), "skin Gaussians: the body has no UV");
  const MatrixX3d vertices = ShapeVertices(model, betas);
  const BodyModelData& data = model.data();
  Body body;
  body.Resize(texels.num_inside);
  int row = 0;
  for (size_t i = 0; i < texels.size(); ++i) {
    if (texels.in_gutter[i] != 0) continue;
    const int face = texels.face[i];
    BODYLOOM_CHECK(face >= 0 && face < model.num_faces() && row < body.size(), "skin Gaussians: texel ", i,
                   " shows face ", face, ", expected a table of this body, with ", model.num_faces(), " faces");
    Vector3d corner[3];
    Eigen::Vector2d uv[3];
    for (int c = 0; c < 3; ++c) {
      corner[c] = vertices.row(data.faces(face, c)).transpose();
      uv[c] = data.vt.row(data.ft(face, c)).transpose().cast<double>();
    }
    const Vector3d cross = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    const Eigen::Vector2d a = uv[1] - uv[0], b = uv[2] - uv[0];
    const double area_in_texels = std::abs(a.x() * b.y() - a.y() * b.x()) * texels.width * texels.height;
    const double width = std::sqrt(cross.norm() / area_in_texels);
    const Vector3d normal = cross.normalized();
    const Eigen::Vector3f& barycentric = texels.barycentric[i];
    const Vector3d place = barycentric[0] * corner[0] + barycentric[1] * corner[1] + barycentric[2] * corner[2];
    SetFlatGaussian(
        {place, normal, options.texels_sigma * width, options.flatness, options.opacity_logit, options.albedo}, row,
        &body);
    SetWeights(model, face, barycentric, row, &body);
    body.anchors[row] = {face, {barycentric[0], barycentric[1], barycentric[2]}, 1};
    ++row;
  }
  for (int c = 0; c < 3; ++c) body.light[9 * c] = static_cast<float>(2 * std::sqrt(M_PI));
  return body;
}

bool ClothGaussiansOptions::IsValid(std::string* why) const {
  const InRange in_range(why);
  return in_range("spacing_m", spacing_m, 0.003, 0.2) && in_range("count", count, 1, 1e7) &&
         in_range("sigma", sigma, 0.01, 100) && in_range("flatness", flatness, 0.001, 1) &&
         in_range("opacity_logit", opacity_logit, -20, 20) && in_range("albedo", albedo, 0, 1);
}

GaussianBody ClothGaussians(const BodyModel& model, const Eigen::VectorXd& betas, const LooseGarment& garment,
                            const ClothNodes& nodes, const ClothGaussiansOptions& options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), "cloth's Gaussians: ", why);
  const SewnFaces faces(garment);
  const double wanted = faces.area() / (options.spacing_m * options.spacing_m);
  const int count = static_cast<int>(std::clamp(wanted, 1.0, static_cast<double>(options.count)));
  const double apart = std::sqrt(faces.area() / count);
  const MatrixX3d vertices = ShapeVertices(model, betas);
  const VertexAnchors anchors(model);
  Body body;
  body.Resize(count);
  for (int i = 0; i < count; ++i) {
    // Points on faces from the R2 low-discrepancy sequence (additive recurrence of the plastic number).
    const auto [place, normal] =
        faces.At((i + 0.5) / count, std::fmod(0.7548776662466927 * i, 1), std::fmod(0.5698402909980532 * i, 1));
    SetFlatGaussian({place, normal, options.sigma * apart, options.flatness, options.opacity_logit, options.albedo}, i,
                    &body);
    const NearestNodes near = nodes.Near(place);
    static_assert(NearestNodes::kCount == Body::kInfluences);
    for (int k = 0; k < Body::kInfluences; ++k) {
      body.joints[static_cast<size_t>(i) * Body::kInfluences + k] = model.num_joints() + near.node[k];
      body.parameters(i, Body::kWeightLogit + k) = static_cast<float>(std::log(std::max(1e-6, near.weight[k])));
    }
    Eigen::Index nearest;
    (vertices.rowwise() - place.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
    body.anchors[i] = anchors.At(static_cast<int>(nearest), 0);
    body.kinds[i] = GaussianKind::kCloth;
  }
  return body;
}

}  // namespace bodyloom
