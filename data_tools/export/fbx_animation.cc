// SPDX-License-Identifier: Apache-2.0
#include "data_tools/export/fbx_animation.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <utility>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::RowVector3d;
using Eigen::Vector3d;

/// Below this cosine of y, x and z turn about the same axis.
constexpr double kGimbalCosine = 1e-7;
constexpr double kDegreesPerRadian = 180 / M_PI;
/// Linear interpolation (4), with the tangents' bits that Autodesk's programs write beside it.
constexpr int32_t kLinearKeys = 24836;

RowVector3d EulerXyzAfter(const Matrix3d& R, const RowVector3d& before_deg) {
  const double cos_y = std::hypot(R(2, 1), R(2, 2));
  RowVector3d angles(std::atan2(R(2, 1), R(2, 2)), std::atan2(-R(2, 0), cos_y), std::atan2(R(1, 0), R(0, 0)));
  if (cos_y < kGimbalCosine) {
    angles[0] = before_deg[0] / kDegreesPerRadian;
    const Matrix3d zy = R * Eigen::AngleAxisd(-angles[0], Vector3d::UnitX()).toRotationMatrix();
    angles[2] = std::atan2(-zy(0, 1), zy(1, 1));
  }
  angles *= kDegreesPerRadian;
  const auto near = [&](RowVector3d a) {
    for (int k = 0; k < 3; ++k) a[k] += 360 * std::round((before_deg[k] - a[k]) / 360);
    return a;
  };
  const RowVector3d one = near(angles), other = near({angles[0] + 180, 180 - angles[1], angles[2] + 180});
  return (one - before_deg).squaredNorm() <= (other - before_deg).squaredNorm() ? one : other;
}

}  // namespace

MatrixX3d ContinuousEulerXyz_deg(std::span<const Matrix3d> rotations) {
  MatrixX3d angles(static_cast<Eigen::Index>(rotations.size()), 3);
  RowVector3d before = RowVector3d::Zero();
  for (size_t i = 0; i < rotations.size(); ++i) {
    before = EulerXyzAfter(rotations[i], before);
    angles.row(Eigen::Index(i)) = before;
  }
  return angles;
}

FbxKeys::FbxKeys(std::span<const double> seconds) : node_("KeyTime"), count_(static_cast<int>(seconds.size())) {
  std::vector<int64_t> times;
  for (const double s : seconds) {
    times.push_back(FbxTime(s));
    BODYLOOM_CHECK(times.size() < 2 || times.back() > times[times.size() - 2], "FBX: key ", times.size() - 1,
                   " is not after the one before it");
  }
  node_.Longs(times);
}

FbxAnimation::FbxAnimation(FbxDocument* document, const std::string& name, double duration_s) : document_(*document) {
  const int64_t end = FbxTime(duration_s);
  const auto time = [](const char* property, int64_t ticks) {
    return FbxProperty(property, "KTime", "Time", "").Long(ticks);
  };
  const int64_t stack = document_.Add("AnimationStack", name, "AnimStack", "",
                                      {FbxProperties({time("LocalStart", 0), time("LocalStop", end),
                                                      time("ReferenceStart", 0), time("ReferenceStop", end)})});
  layer_ = document_.Add("AnimationLayer", name, "AnimLayer", "", {});
  document_.Connect(layer_, stack);
}

void FbxAnimation::AddVector(int64_t object, const std::string& property, const FbxKeys& keys, const MatrixX3d& values,
                             const Vector3d& resting) {
  if ((values.rowwise() - resting.transpose()).isZero(0)) return;
  const std::string name = property.substr(property.find(' ') + 1, 1);  // T, R or S
  constexpr std::array kChannels = {"d|X", "d|Y", "d|Z"};
  FbxNode channels = FbxProperties({});
  for (int k = 0; k < 3; ++k) {
    channels.Add(FbxProperty(kChannels[size_t(k)], "Number", "", "A").Double(resting[k]));
  }
  const int64_t node = document_.Add("AnimationCurveNode", name, "AnimCurveNode", "", {channels});
  document_.Connect(node, layer_);
  document_.Connect(node, object, property);
  for (int k = 0; k < 3; ++k) {
    const Eigen::VectorXf column = values.col(k).cast<float>();
    AddCurve(node, kChannels[size_t(k)], keys, {column.data(), size_t(column.size())});
  }
}

void FbxAnimation::AddNumber(int64_t object, const std::string& property, const FbxKeys& keys,
                             std::span<const float> values) {
  const std::string channel = "d|" + property;
  const int64_t node =
      document_.Add("AnimationCurveNode", property, "AnimCurveNode", "",
                    {FbxProperties({FbxProperty(channel, "Number", "", "A").Double(values.empty() ? 0 : values[0])})});
  document_.Connect(node, layer_);
  document_.Connect(node, object, property);
  AddCurve(node, channel, keys, values);
}

void FbxAnimation::AddCurve(int64_t curve_node, const std::string& channel, const FbxKeys& keys,
                            std::span<const float> values) {
  BODYLOOM_CHECK(values.size() == size_t(keys.count()), "FBX: ", values.size(), " values for ", keys.count(), " keys");
  const std::array<int32_t, 1> flags = {kLinearKeys}, all = {keys.count()};
  const std::array<float, 4> tangents = {};
  const int64_t curve =
      document_.Add("AnimationCurve", "", "AnimCurve", "",
                    {FbxNode("Default").Double(values.empty() ? 0 : values[0]), FbxNode("KeyVer").Int(4008),
                     keys.node(), FbxNode("KeyValueFloat").Floats(values), FbxNode("KeyAttrFlags").Ints(flags),
                     FbxNode("KeyAttrDataFloat").Floats(tangents), FbxNode("KeyAttrRefCount").Ints(all)});
  document_.Connect(curve, curve_node, channel);
}

}  // namespace bodyloom
