// SPDX-License-Identifier: Apache-2.0
/// The inner loop of geometry/body/skinning.h: plain arrays in, plain arrays out. No Eigen in here, because this loop
/// is compiled once per instruction set (SSE4, AVX2, AVX-512, …) and the best one is chosen at run time.
///
/// Frames lie side by side: entry e of frame f is at [e · kFrameLanes + f], so one SIMD register holds the same entry
/// of neighbouring frames and no lane ever depends on another. A frame's result is therefore the same to the bit
/// whatever other frames, vertices or threads share the call.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace bodyloom::skinning_internal {

inline constexpr int kFrameLanes = 32;

/// A shaped body; arrays by vertex id as in BodyModel and PoseCorrectives, except `rest`.
struct Body {
  const int* vertices = nullptr;  ///< ids of the chosen vertices
  const float* rest = nullptr;    ///< chosen × 3: shaped, unposed, relative to the root joint at rest
  const int* influence_begin = nullptr;
  const int* influence_joint = nullptr;
  const float* influence_weight = nullptr;
  const int* corrective_begin = nullptr;  ///< null: no correctives
  const int* corrective_joint = nullptr;
  const float* corrective_block = nullptr;
};

/// Up to kFrameLanes frames. Arrays aligned to 64 bytes; lanes beyond num_frames hold anything.
struct Frames {
  int num_frames = 0;
  const float* features = nullptr;           ///< J × 9: vec_rowmajor(R_j − I)
  const uint8_t* feature_is_zero = nullptr;  ///< J: the joint rests in every frame, its correctives are skipped
  const float* bones = nullptr;   ///< J × 12: rows of [G_j | t_j], t_j = p_j − p_root − G_j (rest_j − rest_root)
  const double* roots = nullptr;  ///< num_frames × 3, added to double output
  float* float_output = nullptr;  ///< frame 0, chosen vertex 0; or
  double* double_output = nullptr;
  int64_t output_stride = 0;  ///< values from one frame to the next
};

/// Poses chosen vertices first..last−1 in all frames.
void SkinVertices(const Body& body, const Frames& frames, int first, int last);

/// Instruction sets of this build that the machine supports, best first.
std::vector<int64_t> SimdTargets();
std::string SimdTargetName(int64_t target);
/// Name of the instruction set in use.
std::string ChosenSimdTarget();
/// For tests: restricts the process to one instruction set; 0 lifts the restriction. Not to be called during skinning.
void ForceSimdTarget(int64_t target);

}  // namespace bodyloom::skinning_internal
