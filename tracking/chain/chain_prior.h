// SPDX-License-Identifier: Apache-2.0
/// The prior that frames which have left a chain leave on the two that are now first, and on shape and focal length:
///   ½ eᵀ M e + mᵀ e,   e = x ⊟ x̄ = (log(R̄ᵀR) of each active joint, t − t̄ of both frames; β − β̄; log f − log f̄)
/// M and m are what is left of the normal equations when the frames before are eliminated (a Schur complement). For
/// linear measurements nothing is lost by it; for others, what left stays linearised where it was.
#pragma once

#include <Eigen/Core>
#include <array>

#include "bodyloom/tracking/frame_layout.h"

namespace bodyloom {

struct ChainPrior {
  bool set = false;
  std::array<FrameState, 2> states;  ///< x̄ of the first two frames
  Eigen::VectorXd betas;             ///< β̄
  double log_focal = 0;
  Eigen::MatrixXd M;  ///< (2n + s)², symmetric: first frame, second frame, shared values that are unknown
  Eigen::VectorXd m;
};

}  // namespace bodyloom
