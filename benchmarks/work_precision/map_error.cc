// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/work_precision/map_error.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

#include "bodyloom/data_tools/formats/npz.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/normals.h"
#include "bodyloom/geometry/skinning.h"
#include "bodyloom/geometry/surface_velocity.h"

namespace bodyloom {
namespace {

constexpr int kFaceStep = 10;

Eigen::Vector3d At(const std::vector<float>& values, int v) {
  return {values[3 * static_cast<size_t>(v)], values[3 * static_cast<size_t>(v) + 1],
          values[3 * static_cast<size_t>(v) + 2]};
}

/// Three planes from `plane` on at a point of the map.
Eigen::Vector3d Lookup(const float* plane, int size, const Eigen::Vector2d& uv) {
  const double x = uv[0] * size - 0.5, y = (1 - uv[1]) * size - 0.5;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int dy = 0; dy < 2; ++dy) {
    for (int dx = 0; dx < 2; ++dx) {
      const int column = std::clamp(x0 + dx, 0, size - 1), row = std::clamp(y0 + dy, 0, size - 1);
      const double weight = (dx == 0 ? 1 - (x - x0) : x - x0) * (dy == 0 ? 1 - (y - y0) : y - y0);
      for (int c = 0; c < 3; ++c) {
        sum[c] += weight * double{plane[(static_cast<size_t>(c) * size + row) * size + column]};
      }
    }
  }
  return sum;
}

}  // namespace

MapTruth::MapTruth(const BodyModel& body, const Track& truth) {
  const BodyModelData& d = body.data();
  std::vector<int> faces;
  for (int f = 0; f < body.num_faces(); f += kFaceStep) {
    faces.push_back(f);
    Eigen::Vector2d uv = Eigen::Vector2d::Zero();
    for (int k = 0; k < 3; ++k) uv += d.vt.row(d.ft(f, k)).cast<double>().transpose() / 3;
    uv_.push_back(uv);
  }
  std::vector<BodyPose> poses;
  for (const auto& pose : PosesInFrame(body, truth, SurfaceFrame::kCamera)) {
    BODYLOOM_CHECK(pose.has_value(), "the truth has a frame without a pose");
    poses.push_back(*pose);
  }
  const size_t T = poses.size(), V = static_cast<size_t>(body.num_vertices());
  VelocityStencilOptions options;
  options.scheme = VelocityScheme::kCentral;
  const std::vector<char> usable(T, 1);
  const auto stencils = VelocityStencils(truth.motion.timestamps, usable, options);
  std::vector<PoseRates> rates;
  for (size_t t = 0; t < T; ++t) {
    std::vector<const BodyPose*> neighbours;
    for (size_t k = 0; k < stencils[t].weights.size(); ++k) neighbours.push_back(&poses[stencils[t].first_frame + k]);
    rates.push_back(RatesOf(stencils[t], neighbours, poses[t]));
  }
  const Skinner skinner(body);
  const ShapedBody shape = skinner.Shape(truth.motion.betas);
  std::vector<float> vertices(3 * V * T), velocities(3 * V * T), normals(3 * V * T);
  MatrixX3d roots(static_cast<Eigen::Index>(T), 3);
  skinner.SkinFromRoot(shape, poses, vertices, &roots);
  VelocitySkinner(body).Velocities(shape, poses, rates, velocities, 1);
  MeshNormals(d.faces, body.num_vertices()).ComputeFrames(vertices, normals, 1);
  for (size_t t = 0; t < T; ++t) {
    const int first = static_cast<int>(t * V);
    std::vector<Eigen::Vector3d> n, v;
    for (int f : faces) {
      Eigen::Vector3d normal = Eigen::Vector3d::Zero(), velocity = Eigen::Vector3d::Zero();
      for (int k = 0; k < 3; ++k) {
        normal += At(normals, first + d.faces(f, k));
        velocity += At(velocities, first + d.faces(f, k)) / 3;
      }
      n.push_back(normal.normalized());
      v.push_back(velocity);
    }
    normals_.push_back(n);
    velocities_.push_back(v);
  }
}

MapError MapTruth::ErrorOf(const std::string& npy_path, int size) const {
  const NdArray array = ReadNpy(npy_path);
  const auto T = static_cast<int64_t>(normals_.size());
  BODYLOOM_CHECK(array.shape == std::vector<int64_t>({T, 6, size, size}), npy_path, ": maps of another shape");
  const std::vector<float> maps = array.ToFloats();
  MapError error;
  double squares = 0;
  size_t count = 0;
  for (size_t t = 0; t < normals_.size(); ++t) {
    const float* record = &maps[t * 6 * static_cast<size_t>(size) * size];
    for (size_t i = 0; i < uv_.size(); ++i, ++count) {
      const Eigen::Vector3d normal = Lookup(record, size, uv_[i]);
      const Eigen::Vector3d velocity = Lookup(record + 3 * static_cast<size_t>(size) * size, size, uv_[i]);
      error.normal_deg += std::atan2(normal.cross(normals_[t][i]).norm(), normal.dot(normals_[t][i])) * 180 / M_PI;
      squares += (velocity - velocities_[t][i]).squaredNorm();
    }
  }
  error.normal_deg /= static_cast<double>(count);
  error.velocity_mm_s = 1e3 * std::sqrt(squares / static_cast<double>(count));
  return error;
}

}  // namespace bodyloom
