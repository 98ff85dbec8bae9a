// SPDX-License-Identifier: Apache-2.0
/// How tall the person is taken to be, and a body made larger or smaller as a whole, in terms of its shape components.
#pragma once

#include <Eigen/Core>

#include "geometry/body/body_model.h"
#include "tracking/problem/track_input.h"

namespace bodyloom {

/// TrackSequenceInput::stature_m, or the mean body's (StatureOfMeanShape()) when it is 0.
double AssumedStature(const TrackSequenceInput& input);

/// B: what one per cent of size is in the first B shape components, times 100: u = argmin_u ‖S u − (v_template −
/// their mean)‖² + 1e-6 B⁻¹ tr(SᵀS) ‖u‖², S the shape directions without each one's mean move. A person scaled by 1 + x
/// about a point has betas x u, as far as the body's components can say it.
Eigen::VectorXd SizeDirection(const BodyModel& model, int num_betas);

/// `betas` with the shape's size changed, along SizeDirection(), so that its stature (StatureOfMeanShape()) is
/// `stature_m`: proportions stay. Unchanged where no component changes the stature, and with none.
Eigen::VectorXd WithStature(const BodyModel& model, const Eigen::VectorXd& betas, double stature_m);

}  // namespace bodyloom
