// SPDX-License-Identifier: Apache-2.0
#include "geometry/scene/track_edits.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <vector>

#include "geometry/base/check.h"
#include "geometry/base/percentile.h"
#include "geometry/body/normals.h"
#include "geometry/body/posed_body.h"
#include "geometry/body/skinning.h"

namespace bodyloom {
namespace {

using Eigen::RowVector3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Of all components of the body.
VectorXd Padded(const BodyModel& body, const VectorXd& betas) {
  BODYLOOM_CHECK(betas.size() <= body.num_betas() && betas.allFinite(), "a shape of ", betas.size(),
                 " components or with numbers that are not finite, expected at most ", body.num_betas(),
                 " of the body '", body.name(), "'");
  VectorXd padded = VectorXd::Zero(body.num_betas());
  padded.head(betas.size()) = betas;
  return padded;
}

/// The pelvis at rest, its height above the lowest vertex, and the highest vertex' (y up, as all bodies at rest).
struct RestPelvis {
  RestPelvis(const Skinner& skinner, const VectorXd& betas) {
    const ShapedBody shape = skinner.Shape(betas);
    place = shape.rest_joints.row(0);
    double top = 0;
    for (size_t i = 1; i < shape.vertices.size(); i += 3) {
      height = std::max(height, -double{shape.vertices[i]});
      top = std::max(top, double{shape.vertices[i]});
    }
    stature = height + top;
  }
  RowVector3d place;
  double height = 0, stature = 0;
};

/// By column, over the rows that have a result.
RowVector3d MedianRow(const Track& track, const MatrixX3d& rows) {
  RowVector3d median = RowVector3d::Zero();
  for (int c = 0; c < 3; ++c) {
    std::vector<double> values;
    for (int t = 0; t < track.num_frames(); ++t) {
      if (track.HasResult(t)) values.push_back(rows(t, c));
    }
    if (!values.empty()) median[c] = Percentile(values, 50);
  }
  return median;
}

}  // namespace

Track WithShape(const BodyModel& body, const Track& track, const VectorXd& betas, PersonPlacing placed) {
  const VectorXd own = Padded(body, track.motion.betas), wanted = Padded(body, betas);
  if (own == wanted) return track;
  const Skinner skinner(body);
  const RestPelvis before(skinner, own), after(skinner, wanted);
  const double r = before.height > 0 ? after.height / before.height : 1;
  const double s = placed == PersonPlacing::kInImage && before.stature > 0 ? after.stature / before.stature : 1;
  Track other;
  other.camera = track.camera;
  other.camera_from_scene = track.camera_from_scene;
  for (CameraPose& camera : other.camera_from_scene) camera.camera_from_world_translation *= s;
  other.world = track.world;
  if (other.world) {
    other.world->translation *= s;
    other.world->height_sigma_m *= s;
  }
  other.level_m = s * track.level_m;
  other.motion = track.motion;
  other.motion.betas = betas;
  other.frame_status = track.frame_status;
  const MatrixX3d pelvis = track.motion.trans.rowwise() + before.place;
  const RowVector3d floor = MedianRow(track, pelvis) + before.height * RowVector3d::UnitY();
  other.motion.trans = ((r * (pelvis.rowwise() - floor)).rowwise() + s * floor).rowwise() - after.place;
  other.weak_camera = track.weak_camera;
  if (track.weak_camera.rows() > 0) {
    const RowVector3d middle = MedianRow(track, track.weak_camera);
    other.weak_camera.col(0) /= s;
    for (const int c : {1, 2}) {
      other.weak_camera.col(c) = s * middle[c] + r * (track.weak_camera.col(c).array() - middle[c]);
    }
  }
  return other;
}

namespace {

constexpr double kLargestWeight = 1.5;

/// The change of `weights` of these vertices (rows of `positions`) after which they give `point`, as nearly as no large
/// weights can.
Eigen::VectorXd ChangeOfWeights(const MatrixX3d& positions, const Eigen::VectorXd& weights,
                                const Eigen::Vector3d& point) {
  // Combinations of centred positions sum to zero.
  const Eigen::MatrixXd conditions = (positions.rowwise() - positions.colwise().mean()).transpose();
  const Eigen::Vector3d wanted = point - positions.transpose() * weights;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  for (const double flat : {1e-6, 1e-3, 1e-2, 0.1, 0.5}) {
    solver.setThreshold(flat);
    solver.compute(conditions);
    Eigen::VectorXd change = solver.solve(wanted);
    if ((weights + change).cwiseAbs().maxCoeff() <= kLargestWeight) return change;
  }
  return Eigen::VectorXd::Zero(weights.size());
}

}  // namespace

BodyModelData BakeShape(const BodyModel& body, const Eigen::VectorXd& betas, std::span<const double> offsets_m) {
  const int num_vertices = body.num_vertices();
  BODYLOOM_CHECK(offsets_m.empty() || static_cast<int>(offsets_m.size()) == num_vertices, offsets_m.size(),
                 " offsets, expected one for each of ", num_vertices, " vertices");
  const MatrixX3d bare = ShapeVertices(body, betas);
  BodyModelData data = body.data();
  data.v_template = bare;
  if (!offsets_m.empty()) {
    const MatrixX3f normals = VertexNormals(bare, data.faces);
    for (int v = 0; v < num_vertices; ++v) {
      BODYLOOM_CHECK(std::isfinite(offsets_m[v]), "offset of vertex ", v, " is not finite");
      data.v_template.row(v) += offsets_m[v] * normals.row(v).cast<double>();
    }
  }

  const MatrixX3d joints = body.RestJoints(betas);
  for (int j = 0; j < body.num_joints(); ++j) {
    std::vector<int> vertices;
    for (SparseRows::InnerIterator it(data.J_regressor, j); it; ++it) vertices.push_back(static_cast<int>(it.col()));
    const MatrixX3d positions = data.v_template(vertices, Eigen::all);
    Eigen::VectorXd weights(static_cast<int>(vertices.size()));
    int k = 0;
    for (SparseRows::InnerIterator it(data.J_regressor, j); it; ++it) weights[k++] = it.value();
    weights += ChangeOfWeights(positions, weights, joints.row(j).transpose());
    k = 0;
    for (SparseRows::InnerIterator it(data.J_regressor, j); it; ++it) it.valueRef() = weights[k++];
  }
  for (Landmark& landmark : data.landmarks) {
    const MatrixX3d positions = data.v_template(landmark.vertices, Eigen::all);
    Eigen::Map<Eigen::VectorXd> weights(landmark.weights.data(), static_cast<int>(landmark.weights.size()));
    const Eigen::Vector3d point = bare(landmark.vertices, Eigen::all).transpose() * weights;
    weights += ChangeOfWeights(positions, weights, point);
  }
  return data;
}

Track OfBakedBody(Track track) {
  track.motion.betas.setZero();
  track.joints.clear();
  return track;
}

std::vector<int> FrozenAt(int num_frames, int frame, int count) {
  BODYLOOM_CHECK(frame >= 0 && frame < num_frames, "frame ", frame, " of a clip of ", num_frames);
  BODYLOOM_CHECK(count >= 0, count, " frames more, expected at least 0");
  std::vector<int> shown;
  for (int t = 0; t < num_frames; ++t) shown.insert(shown.end(), t == frame ? 1 + count : 1, t);
  return shown;
}

std::pair<int, int> PosedSpan(const Motion& motion) {
  int begin = 0, end = motion.num_frames();
  while (begin < end && !motion.HasPose(begin)) ++begin;
  while (end > begin && !motion.HasPose(end - 1)) --end;
  return begin == end ? std::pair(0, 0) : std::pair(begin, end);
}

Motion FramesOfMotion(const Motion& motion, int begin, int end) {
  BODYLOOM_CHECK(begin >= 0 && begin <= end && end <= motion.num_frames(), "frames ", begin, " to ", end,
                 " of a motion of ", motion.num_frames());
  Motion part = motion;
  part.poses = motion.poses.middleRows(begin, end - begin);
  part.trans = motion.trans.middleRows(begin, end - begin);
  part.timestamps.assign(motion.timestamps.begin() + begin, motion.timestamps.begin() + end);
  return part;
}

Track SelectFrames(const Track& track, std::span<const int> frames) {
  const int T = static_cast<int>(frames.size()), last = track.num_frames() - 1;
  const bool has_status = static_cast<int>(track.frame_status.size()) == last + 1;
  Track selected;
  selected.camera = track.camera;
  selected.world = track.world;
  selected.playback = track.playback;
  selected.motion.body = track.motion.body;
  selected.motion.betas = track.motion.betas;
  selected.motion.up = track.motion.up;
  selected.motion.poses.resize(T, track.motion.poses.cols());
  selected.motion.trans.resize(T, 3);
  selected.weak_camera.resize(track.weak_camera.rows() > 0 ? T : 0, 3);
  selected.joint_sigma.resize(track.joint_sigma.rows() > 0 ? T : 0, track.joint_sigma.cols());
  selected.root_sigma.resize(track.root_sigma.size() > 0 ? T : 0);
  selected.level_m.resize(track.level_m.size() > 0 ? T : 0);
  for (int t = 0; t < T; ++t) {
    const int s = frames[t];
    BODYLOOM_CHECK(s >= 0 && s <= last, "frame ", s, " of a track of ", last + 1);
    selected.motion.poses.row(t) = track.motion.poses.row(s);
    selected.motion.trans.row(t) = track.motion.trans.row(s);
    selected.motion.timestamps.push_back(track.motion.timestamps.at(s));
    if (has_status) selected.frame_status.push_back(track.frame_status[s]);
    if (track.HasMovingCamera()) selected.camera_from_scene.push_back(track.camera_from_scene.at(s));
    if (selected.weak_camera.rows() > 0) selected.weak_camera.row(t) = track.weak_camera.row(s);
    if (selected.joint_sigma.rows() > 0) selected.joint_sigma.row(t) = track.joint_sigma.row(s);
    if (selected.root_sigma.size() > 0) selected.root_sigma[t] = track.root_sigma[s];
    if (selected.level_m.size() > 0) selected.level_m[t] = track.level_m[s];
    if (!track.joints.empty()) selected.joints.push_back(track.joints.at(s));
    if (!track.coco17.empty()) selected.coco17.push_back(track.coco17.at(s));
  }
  return selected;
}

Track FramesInOrder(const Track& track, std::span<const int> frames) {
  Track shown = SelectFrames(track, frames);
  const std::vector<double>& times = track.motion.timestamps;
  const int last = track.num_frames() - 1;
  const double frame_s = last > 0 ? (times.back() - times.front()) / last : 1.0 / 30;
  for (int t = 0; t < shown.num_frames(); ++t) shown.motion.timestamps[t] = times.front() + t * frame_s;
  shown.playback = {};
  return shown;
}

}  // namespace bodyloom
