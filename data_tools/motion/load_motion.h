// SPDX-License-Identifier: Apache-2.0
/// Loads recorded motion in any supported format, recognised by content, as a motion of SMPL's 24 joints.
///
/// Read: AMASS and track .npz, AIST++ motions .pkl, BVH, Acclaim .amc with its .asf, DeepMimic JSON, AMP .npy; the text
/// forms may be gzipped. Skeletons other than SMPL's are retargeted (retarget.h).
#pragma once

#include <string>
#include <vector>

#include "data_tools/motion/retarget.h"
#include "geometry/scene/track.h"

namespace bodyloom {

struct LoadMotionOptions {
  double fps = 0;             ///< frame rate of files without one; 0: 60 for AIST++, 120 for AMC
  std::string skeleton_path;  ///< .asf of an .amc; empty: beside it
  double resample_fps = 0;    ///< when positive, the motion is resampled to it
};

/// `summary`, when given, is filled for retargeted skeletons; `warnings`, when requested, gets a line for each fault
/// that was passed over (motion_readers.h, amass.h). Throws std::runtime_error in one line: what was found and what was
/// expected.
Motion LoadMotion(const std::string& path, const LoadMotionOptions& options = {}, RetargetSummary* summary = nullptr,
                  std::vector<std::string>* warnings = nullptr);

/// The same for the contents of a file; `where` is its path (an .amc finds its skeleton by it).
Motion MotionFromBytes(const std::string& bytes, const std::string& where, const LoadMotionOptions& options = {},
                       RetargetSummary* summary = nullptr, std::vector<std::string>* warnings = nullptr);

}  // namespace bodyloom
