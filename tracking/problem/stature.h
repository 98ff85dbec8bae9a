// SPDX-License-Identifier: Apache-2.0
/// The stature assumed for the person, and uniform scaling of a body by its shape components.
#pragma once

#include <Eigen/Core>

#include "geometry/body/body_model.h"
#include "tracking/problem/track_input.h"

namespace bodyloom {

/// TrackSequenceInput::stature_m, or the mean body's (StatureOfMeanShape()) when it is 0.
double AssumedStature(const TrackSequenceInput& input);

/// Derivative u of the first B shape components by relative size: u = argmin_u ‖S u − (v_template − their mean)‖² +
/// 1e-6 B⁻¹ tr(SᵀS) ‖u‖², S the shape directions without their mean displacements. A mean body scaled by 1 + x about a
/// point has betas x u, as far as the body's components can represent it.
Eigen::VectorXd SizeDirection(const BodyModel& model, int num_betas);

/// `betas` with the size changed along SizeDirection() such that the stature (StatureOfMeanShape()) is `stature_m`;
/// proportions are kept. Unchanged without components, or when none changes the stature.
Eigen::VectorXd WithStature(const BodyModel& model, const Eigen::VectorXd& betas, double stature_m);

}  // namespace bodyloom
