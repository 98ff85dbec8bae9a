// SPDX-License-Identifier: Apache-2.0
/// The built-in body: an adult mannequin in T-pose on SMPL's 24 joints, available without a download.
///
/// 7,874 vertices, 15,744 triangles, 10 shape components in standard deviations (stature, sex, weight, age,
/// proportions, …), pose correctives, 24 DensePose-style charts, an atlas, COCO-17 and foot landmarks. Body frame: x
/// left, y up, z front, metres, pelvis joint of the mean shape at the origin. Properties: docs/built_in_body.md.
#pragma once

#include <memory>
#include <string>

#include "geometry/body/body_model.h"

namespace bodyloom {

/// The body, built once from the copy inside the library; thread-safe.
const BodyModel& BuiltinBody();

/// The same body with SMPL-H's finger joints, 52 in all (geometry/body/hand_skeleton.h): same vertices, shapes and
/// charts, 40 more landmarks (20 of each hand). With resting fingers it equals BuiltinBody() with resting hand joints.
const BodyModel& BuiltinBodyWithHands();

/// The name by which BodyOrBuiltin() gives BuiltinBodyWithHands(); a file of that name is "./hands".
inline constexpr char kBodyWithHands[] = "hands";

/// The body in a file (data_tools/body/body_io.h), the built-in one for an empty path, or that with hands for their
/// name. Throws std::runtime_error naming the file and what is wrong with it.
std::shared_ptr<const BodyModel> BodyOrBuiltin(const std::string& path);

}  // namespace bodyloom
