// SPDX-License-Identifier: Apache-2.0
#include "render/gaussian_avatar/cloth_gaussians.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/base/check.h"
#include "geometry/body/posed_body.h"
#include "render/gaussian_avatar/gaussian_body.h"

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

}  // namespace

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
