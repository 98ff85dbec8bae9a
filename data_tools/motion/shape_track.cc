// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/motion/shape_track.h"

#include <algorithm>
#include <vector>

#include "bodyloom/geometry/base/check.h"
#include "bodyloom/geometry/base/percentile.h"
#include "bodyloom/geometry/skinning.h"

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
  const double s = placed == PersonPlacing::kInPicture && before.stature > 0 ? after.stature / before.stature : 1;
  Track other;
  other.camera = track.camera;
  other.camera_from_scene = track.camera_from_scene;
  for (CameraPose& camera : other.camera_from_scene) camera.camera_from_world_translation *= s;
  other.world = track.world;
  if (other.world) {
    other.world->translation *= s;
    other.world->height_sigma_m *= s;
  }
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

}  // namespace bodyloom
