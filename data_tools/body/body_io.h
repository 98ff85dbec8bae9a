// SPDX-License-Identifier: Apache-2.0
/// Reads and writes body files. The format is recognised by content, not by name:
///   zip archive (.npz)  Bodyloom's compact body (body_compact.h), or named arrays: SMPL, SMPL-H (52 joints), SMPL-X
///                       (55 joints), and the dense form of the built-in body, which adds UV, parts and landmarks
///   anything else       a pickle: SMPL's official .pkl (Python 2, chumpy, scipy), read without Python
///                       (formats/pickle.h)
/// Keys and shapes in body_smpl.h.
#pragma once

#include <string>

#include "geometry/body/body_model.h"

namespace bodyloom {

struct LoadBodyOptions {
  int max_betas = 0;            ///< keep this many shape components (they are ordered by variance); 0: all
  bool flat_hand_mean = false;  ///< SMPL-H/X: true leaves pose_mean at zero, as AMASS motions expect; false adds the
                                ///< file's mean hand, so that zero hand angles are a relaxed hand
};

/// Loads and checks a body. Throws std::runtime_error naming file, array and expectation.
BodyModel LoadBody(const std::string& path, const LoadBodyOptions& options = {});

/// The same from a file's bytes; `where` names it in messages.
BodyModel LoadBodyBytes(const std::string& bytes, const std::string& where, const LoadBodyOptions& options = {});

/// The arrays of LoadBody: checked, weights and regressor rows normalised, joint names filled in.
BodyModelData LoadBodyData(const std::string& path, const LoadBodyOptions& options = {});

/// Writes one compact .npz (layout and error bounds in body_compact.h): vertices move by less than 1e-5 m, and saving
/// the loaded body again gives the same file. Throws std::invalid_argument for a body that BodyModel refuses,
/// std::runtime_error when the file cannot be written.
void SaveBodyCompact(const std::string& path, const BodyModelData& body);

/// Takes texture coordinates (vt, ft) from a Wavefront OBJ with the body's vertex order. Faces are matched by their
/// vertices, so their order and first corner may differ; quads match for either way of splitting them. Throws
/// std::runtime_error when vertex counts differ or a face of the body is not in the file.
void UvFromObj(const std::string& path, BodyModelData* body);

struct PartsSummary {
  int faces_with_part = 0;
  int faces_without_part = 0;  ///< part 0: SMPL has two faces more than DensePose's surface
};

/// Takes part ids and in-part coordinates (face_part, face_iuv) from DensePose's UV_Processed.mat (MATLAB v5; arrays
/// All_Faces, All_FaceIndices, All_vertices, All_U_norm, All_V_norm, indices 1-based) for a body with SMPL's vertices,
/// matched by vertex triple. Throws std::runtime_error when the file or its indices are broken, or nothing matches.
PartsSummary PartsFromUvProcessedMat(const std::string& path, BodyModelData* body);

/// A few lines of text: sizes, height, and the optional data present or missing.
std::string DescribeBody(const BodyModel& body);

}  // namespace bodyloom
