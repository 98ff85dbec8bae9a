// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "benchmarks/speed/moving_body.h"
#include "benchmarks/speed/peer_normals.h"
#include "geometry/body/normals.h"
#include "geometry/uv_maps/surface_velocity.h"

namespace bodyloom {

using Eigen::Vector3d;

void BenchNormals(const BodyModel& body) {
  Title("Normals of a mesh, 7,874 vertices, 15,744 faces");
  const MatrixX3d vertices = PoseVertices(body, Eigen::VectorXd(), PoseAt(body, 0.3, 1));
  const Vector3d root = body.joint_template().row(0).transpose() + PoseAt(body, 0.3, 1).trans;
  const MatrixX3f from_root = (vertices.rowwise() - root.transpose()).cast<float>();
  const size_t size = static_cast<size_t>(from_root.size());
  MatrixX3d sums[2] = {MatrixX3d::Zero(vertices.rows(), 3), MatrixX3d::Zero(vertices.rows(), 3)};
  for (int f = 0; f < body.num_faces(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const int v = body.data().faces(f, k);
      const Vector3d p = vertices.row(v), a = vertices.row(body.data().faces(f, (k + 1) % 3)).transpose() - p,
                     b = vertices.row(body.data().faces(f, (k + 2) % 3)).transpose() - p, n = a.cross(b);
      sums[0].row(v) += n.transpose();
      sums[1].row(v) += std::atan2(n.norm(), a.dot(b)) * n.normalized().transpose();
    }
  }
  const auto largest = [&](const auto& normals, const MatrixX3d& truth) {
    double worst = 0;
    for (Eigen::Index v = 0; v < truth.rows(); ++v) {
      worst =
          std::max(worst, AngleBetweenDeg(Vector3d(normals.row(v).transpose().template cast<double>()), truth.row(v)));
    }
    return Format("max %.4f deg to the definition in double", worst);
  };
  for (const NormalWeighting weighting : {NormalWeighting::kArea, NormalWeighting::kAngle}) {
    const bool area = weighting == NormalWeighting::kArea;
    const MeshNormals normals_of(body.data().faces, body.num_vertices(), weighting);
    MatrixX3f normals(vertices.rows(), 3);
    NormalScratch scratch;
    const Milliseconds ms = Time(400, [&] {
      normals_of.Compute({from_root.data(), size}, {normals.data(), size}, &scratch);
    });
    Print(area ? "area-weighted" : "angle-weighted", ms, largest(normals, sums[area ? 0 : 1]));
    std::vector<float> many(64 * size), out(64 * size);
    for (int t = 0; t < 64; ++t) std::copy(from_root.data(), from_root.data() + size, many.begin() + t * size);
    for (const int threads : {1, 2}) {
      Milliseconds batch = Time(20, [&] { normals_of.ComputeFrames(many, out, threads); });
      Print(std::string(area ? "area" : "angle") + "-weighted, a frame of 64, " + std::to_string(threads) + " threads",
            {batch.median / 64, batch.minimum / 64}, "same bytes");
    }
  }
  MatrixX3d peer_normals(vertices.rows(), 3);
  const auto openmesh = OpenMeshNormals(body.data().faces, vertices);
  const Milliseconds openmesh_ms = Time(60, [&] { openmesh->Compute(vertices, &peer_normals); });
  Print("peer: OpenMesh, area-weighted", openmesh_ms, largest(peer_normals, sums[0]));
  if (const auto cgal = CgalNormals(body.data().faces, vertices)) {
    const Milliseconds cgal_ms = Time(15, [&] { cgal->Compute(vertices, &peer_normals); });
    Print("peer: CGAL compute_vertex_normals (a definition of its own)", cgal_ms, largest(peer_normals, sums[1]));
  }
}

void BenchVelocities(const BodyModel& body) {
  for (const auto& [hz, noise] : {std::pair{0.8, 0.0}, {0.8, 0.01}, {3.0, 0.0}}) {
    Title("Velocities of a frame at 30 fps, motion of " + Format("%.1f Hz, pose noise %.3f rad", hz, noise));
    constexpr int T = 41, kFirst = 8, kLast = 32;
    const Track track = TrackOf(body, T, 30, hz, noise);
    // The mean over frames 8 … 32, so that one frame's luck does not decide.
    std::vector<MatrixX3d> truth;
    const double h = 1e-4;
    for (int t = kFirst; t <= kLast; ++t) {
      truth.push_back((PoseVertices(body, Eigen::VectorXd(), PoseAt(body, t / 30.0 + h, hz)) -
                       PoseVertices(body, Eigen::VectorXd(), PoseAt(body, t / 30.0 - h, hz))) /
                      (2 * h));
    }
    std::vector<BodyPose> poses;
    for (const auto& pose : PosesInFrame(body, track, SurfaceFrame::kCamera)) poses.push_back(*pose);
    const Skinner skinner(body);
    const ShapedBody shape = skinner.Shape(Eigen::VectorXd());
    const size_t stride = 3 * size_t(body.num_vertices());
    std::vector<float> vertices(stride * T);
    MatrixX3d root_rows;
    skinner.SkinFromRoot(shape, poses, vertices, &root_rows);
    std::vector<Vector3d> roots;
    roots.reserve(T);
    for (int t = 0; t < T; ++t) roots.push_back(root_rows.row(t).transpose());
    std::vector<float> velocities(stride);
    double error = 0, square = 0;
    const auto add = [&](int t) {
      const Eigen::Map<const MatrixX3f> found(velocities.data(), body.num_vertices(), 3);
      error += (found.cast<double>() - truth[t - kFirst]).squaredNorm();
      square += truth[t - kFirst].squaredNorm();
    };
    const auto rmse = [&] {
      const double n = static_cast<double>(truth.size()) * body.num_vertices();
      std::string text = Format("rmse %.4f m/s of %.3f m/s rms", std::sqrt(error / n), std::sqrt(square / n));
      error = square = 0;
      return text;
    };
    const std::vector<char> usable(T, 1);
    for (const auto& [scheme, name] : {std::pair{VelocityScheme::kBackward, "backward"},
                                       {VelocityScheme::kCentral, "central"},
                                       {VelocityScheme::kSavitzkyGolay, "savgol"}}) {
      const auto stencils = VelocityStencils(track.motion.timestamps, usable, {.scheme = scheme});
      const auto difference = [&](const VelocityStencil& stencil) {
        std::vector<const float*> frames;
        for (size_t k = 0; k < stencil.weights.size(); ++k) {
          frames.push_back(&vertices[stride * (stencil.first_frame + k)]);
        }
        DifferenceVertices(stencil, frames, std::span(roots).subspan(stencil.first_frame, frames.size()), velocities);
      };
      const Milliseconds ms = Time(300, [&] { difference(stencils[kFirst]); });
      for (int t = kFirst; t <= kLast; ++t) {
        difference(stencils[t]);
        add(t);
      }
      Print(name, ms, rmse() + Format(", noise gain %.1f /s", stencils[kFirst].NoiseGain()));
    }
    const auto stencils = VelocityStencils(track.motion.timestamps, usable);
    std::vector<BodyPose> batch;
    std::vector<PoseRates> rates;
    for (int t = kFirst; t <= kLast; ++t) {
      std::vector<const BodyPose*> around;
      for (size_t k = 0; k < stencils[t].weights.size(); ++k) around.push_back(&poses[stencils[t].first_frame + k]);
      batch.push_back(poses[t]);
      rates.push_back(RatesOf(stencils[t], around, poses[t]));
    }
    const VelocitySkinner velocity_skinner(body);
    std::vector<float> all(batch.size() * stride);
    const Milliseconds ms = Time(10, [&] { velocity_skinner.Velocities(shape, batch, rates, all, 1); });
    for (int t = kFirst; t <= kLast; ++t) {
      const auto begin = all.begin() + static_cast<std::ptrdiff_t>(stride * (t - kFirst));
      velocities.assign(begin, begin + static_cast<std::ptrdiff_t>(stride));
      add(t);
    }
    const double n = static_cast<double>(batch.size());
    Print("analytic, a frame of 25", {ms.median / n, ms.minimum / n}, rmse());
  }
}

}  // namespace bodyloom
