// SPDX-License-Identifier: Apache-2.0
/// A body whose mean shape is one person, clothes included.
///
///   v_template' = v_template + shapedirs β + o_i n_i        (o: metres along the vertex normals of the shaped body)
///
/// Joints and landmarks stay where the person's bare body has them: each row of weights w is changed by the least
/// (in squares, on the vertices that it names, its sum kept) that gives the bare body's point back,
///   w' = w + Aᵀ (A Aᵀ)⁺ (point − Σ w_i position'_i),    A = (positions' − their mean)ᵀ,
/// which is exact where the row names four vertices that are not in one plane, and as near as its vertices allow
/// elsewhere: a landmark on a single vertex moves with it. Directions in which the vertices are too flat to reach the
/// point with weights of at most 1.5 count as none. Zero betas are the person; other betas still change it.
#pragma once

#include <Eigen/Core>
#include <span>

#include "bodyloom/geometry/body_model.h"
#include "bodyloom/geometry/track.h"

namespace bodyloom {

/// `offsets_m`: one a vertex, or empty for a bare body. Throws std::invalid_argument for another number, values that are
/// not finite, or more betas than the body has.
BodyModelData BakeShape(const BodyModel& body, const Eigen::VectorXd& betas, std::span<const double> offsets_m);

/// A track of the person as the baked body follows it: β = 0, and without joints, which were the bare body's.
Track OfBakedBody(Track track);

}  // namespace bodyloom
