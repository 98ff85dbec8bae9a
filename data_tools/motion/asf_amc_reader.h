// SPDX-License-Identifier: Apache-2.0
/// Acclaim motion capture: a skeleton (.asf) and motions of it (.amc), plain or gzipped, as in the CMU database.
///
/// A bone b has a rest direction and length in world axes, a frame C_b given by the Euler angles `axis` (applied in the
/// order written: "XYZ" is Rz·Ry·Rx) and degrees of freedom M_b in that frame. With all rest frames parallel to the
/// world its joint rotation is C_b·M_b·C_b⁻¹. A bone's joint is at its near end: joint "ltibia" is the left knee. A
/// bone without degrees of freedom, or absent from the motion (fingers often are), stays at rest. Lengths stay in file
/// units (CMU: 0.45⁻¹ inches). AMC has no frame rate; CMU's is 120 Hz. Source: Schafer, Acclaim skeleton file
/// definition V1.10; mocap.cs.cmu.edu.
#pragma once

#include <string>

#include "data_tools/motion/skeleton_motion.h"

namespace bodyloom {

/// `asf_path` may be empty: then "<subject>.asf" or "<subject>.asf.gz" is searched in the motion's folder, the subject
/// being the motion's file name up to the first '_'.
SkeletonMotion ReadAsfAmc(const std::string& amc_path, const std::string& asf_path = "", double fps = 120);
/// Throws std::runtime_error naming the file and the line.
SkeletonMotion AsfAmcFromText(const std::string& asf, const std::string& asf_where, const std::string& amc,
                              const std::string& amc_where, double fps);

}  // namespace bodyloom
