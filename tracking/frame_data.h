// SPDX-License-Identifier: Apache-2.0
/// Data of one frame, term by term. Borrowed pointers outlive the cost.
#pragma once

#include "bodyloom/geometry/camera.h"
#include "bodyloom/tracking/terms/dense/dense.h"
#include "bodyloom/tracking/terms/ground_contact/ground_contact.h"
#include "bodyloom/tracking/terms/initialiser.h"
#include "bodyloom/tracking/terms/joint_limits.h"
#include "bodyloom/tracking/terms/landmarks.h"
#include "bodyloom/tracking/terms/lifted/lifted_pose.h"
#include "bodyloom/tracking/terms/own/own_costs.h"
#include "bodyloom/tracking/terms/part_labels/part_label_term.h"
#include "bodyloom/tracking/terms/pose_prior/pose_prior.h"
#include "bodyloom/tracking/terms/rendered_uv/rendered_uv_term.h"
#include "bodyloom/tracking/terms/straight_knees.h"
#include "bodyloom/tracking/terms/upright.h"

namespace bodyloom {

/// A term's part has num_rows(), how many rows of the Jacobian it may fill, and Add(FrameAccumulator*).
struct FrameData {
  /// Of a camera that moves: a frame's state is in the scene, and its terms speak of this camera's frame
  /// (moving_camera.h). Null: the camera stands still.
  const CameraPose* camera_from_scene = nullptr;
  LandmarksOfFrame landmarks;
  DenseOfFrame dense;
  RenderedUvOfFrame rendered_uv;
  PartLabelsOfFrame part_labels;
  LiftedOfFrame lifted;
  GroundContactOfFrame ground_contact;
  PosePriorOfFrame prior;
  JointLimitsOfFrame limits;
  UprightOfFrame upright;
  StraightKneesOfFrame straight_knees;
  InitialiserOfFrame initialiser;
  OwnCostsOfFrame own;

  /// Visits the terms in the order in which they are summed.
  template <typename Visit>
  void ForEachTerm(const Visit& visit) const {
    visit(landmarks);
    visit(dense);
    visit(rendered_uv);
    visit(part_labels);
    visit(lifted);
    visit(ground_contact);
    visit(prior);
    visit(limits);
    visit(upright);
    visit(straight_knees);
    visit(initialiser);
    visit(own);
  }
};

}  // namespace bodyloom
