// SPDX-License-Identifier: Apache-2.0
/// The built-in body before a camera in a skirt of finer, heavier and stiffer cloth than the fit's.
#pragma once

#include <Eigen/Geometry>

#include "geometry/cloth/body_with_garment.h"
#include "geometry/cloth/cloth_body.h"
#include "geometry/cloth/cloth_run.h"
#include "geometry/scene/track.h"
#include "render/garment/fit_clothes.h"
#include "render/view/overlay.h"
#include "tests/render/garment/person_scene.h"

namespace bodyloom {

/// A track of one frame, facing PersonCamera() except for the turn, arms down, legs apart.
inline Track StandingPhoto(double turn_rad) {
  Track photo;
  photo.camera = PersonCamera();
  photo.frame_status = {FrameStatus::kTracked};
  Motion& motion = photo.motion;
  motion.body = "bodyloom", motion.up = Motion::Up::kCamera;
  motion.timestamps = {0};
  motion.betas = Eigen::VectorXd::Zero(2);
  motion.trans = Eigen::RowVector3d(0, 0, 3);
  motion.poses = RowMatrixXd::Zero(1, 72);
  const Eigen::AngleAxisd root(RotationFromAxisAngle({0, turn_rad, 0}) * RotationFromAxisAngle({EIGEN_PI, 0, 0}));
  motion.poses.row(0).head<3>() = root.angle() * root.axis().transpose();
  motion.poses(0, 3 * 16 + 2) = -1, motion.poses(0, 3 * 17 + 2) = 1;
  motion.poses(0, 3 * 1 + 2) = 0.15, motion.poses(0, 3 * 2 + 2) = -0.15;
  return photo;
}

/// Dresses the wearer in a skirt of this cut from the waist.
inline void WearSkirt(double length_m, double fullness, ClothCollisionBody* wearer) {
  LooseGarmentOptions cut;
  cut.waist_y_m = wearer->rest_joints()(3, 1), cut.length_m = length_m, cut.fullness = fullness;
  cut.spacing_m = 0.025, cut.mass_kg_m2 = 0.4, cut.bend_compliance = 3;
  wearer->Wear(wearer->Cut(cut, 9));
}

/// The person's pixels in the photo, in such a skirt.
inline LabelImage MaskOfSkirt(const BodyModel& body, const Track& photo, double length_m, double fullness,
                              double swing_rad) {
  ClothCollisionBody wearer(body, photo.motion.betas, {});
  WearSkirt(length_m, fullness, &wearer);
  ClothRunOptions options;
  options.up = SwungUp(photo, swing_rad);
  const BodyModel both(BodyWithGarment(body, wearer.garment()));
  MatrixX3d vertices = TrackVertices(both, photo, 0);
  PlaceGarment(wearer.garment(), ClothRun(wearer, photo.motion, options).Next(), &vertices);
  return MaskOf(vertices, both.data().faces, photo.camera);
}

}  // namespace bodyloom
