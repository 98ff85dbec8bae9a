// SPDX-License-Identifier: Apache-2.0
/// A track as an estimate: of another camera model, of a fit that is to be continued, or written by another program.
#pragma once

#include <string>

#include "bodyloom/data_tools/estimates/body_estimate.h"
#include "bodyloom/geometry/track.h"

namespace bodyloom {

/// Frames without a result are missing. Of bodies with hands and a face SMPL's 21 body joints are taken. `where` names
/// the track in messages; throws std::runtime_error when no frame has a result or the poses have neither 72 nor 156, 162
/// or 165 columns.
BodyEstimate EstimateFromTrack(const Track& track, const std::string& where);

}  // namespace bodyloom
