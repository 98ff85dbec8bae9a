// SPDX-License-Identifier: Apache-2.0
/// Helpers of the estimate readers: arrays of checked shape, people from rows, and their order.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "data_tools/estimates/body_estimate.h"
#include "data_tools/formats/ndarray.h"
#include "data_tools/formats/pickle.h"
#include "data_tools/formats/weights_file.h"

namespace bodyloom {

/// Largest number of frames of an estimate: nine hours at 30 frames per second.
inline constexpr int64_t kMaxEstimateFrames = 1'000'000;

/// The numbers of an array of this shape as a matrix (−1: any size). Throws std::runtime_error "where: key: …" for
/// another shape and for values that are not finite numbers.
RowMatrixXd RequireShape(const NdArray& array, const std::vector<int64_t>& shape, const std::string& where,
                         const std::string& key);

/// Frame numbers: whole, not negative, at most kMaxEstimateFrames. Throws std::runtime_error "where: key: …".
std::vector<int> RequireFrameNumbers(const NdArray& array, int64_t count, const std::string& where,
                                     const std::string& key);

/// The mean shape of a person's n frames, of an array n×B of at most 300 betas. Throws as RequireShape().
Eigen::VectorXd MeanBetas(const NdArray& array, int64_t n, const std::string& where);

/// A row of nine numbers, a rotation matrix row by row, as axis-angle. Throws std::runtime_error "where: key: …" when
/// it is far from a rotation.
Eigen::Vector3d AxisAngleFromRows(const Eigen::Ref<const Eigen::RowVectorXd>& nine, const std::string& where,
                                  const std::string& key);

/// A pinhole camera of square pixels in the middle (w/2, h/2) of an image, as these systems place it.
Camera CentredCamera(int width, int height, double focal_px);

/// A row of nine numbers, [fx 0 cx; 0 fy cy; 0 0 1], as the camera of an image whose middle is the principal point.
/// Throws std::runtime_error "where: key: …" for another matrix.
Camera CameraFromK(const Eigen::Ref<const Eigen::RowVectorXd>& k, const std::string& where, const std::string& key);

/// The tensor of this name; throws std::runtime_error naming `where` if there is none.
const NdArray& RequireTensor(const WeightsFile& file, const std::string& name, const std::string& where);

/// Takes what GVHMR and GEM write of their one person: `prefix`global_orient L×3 into the root's columns of poses
/// (L×72, others 0), `prefix`transl L×3, K_fullimg L×3×3, frames 0 to L−1, the name "0". Throws as RequireShape().
void SetInCameraMotion(const WeightsFile& file, const std::string& prefix, int64_t L, const std::string& where,
                       PersonEstimate* person);

/// The numbers of an array, a number, or lists of numbers inside each other: `count` finite ones. Throws
/// std::runtime_error "place: key: …" otherwise, also for a null pointer.
Eigen::RowVectorXd RequireCount(const PickleValue* value, size_t count, const std::string& place,
                                const std::string& key);

/// People of SMPL's body by name in one dictionary, each with `pose` (n×72 axis-angle), `betas` and `frame_ids`, as
/// VIBE and WHAM write them. `rest` sets the system's other values of a person (its values; "where: person NAME"; trans
/// is 0 and there are no cameras yet). Throws as RequireShape(), RequireFrameNumbers() and SortEstimate().
BodyEstimate SmplPeople(
    const PickleValue& file, const std::string& where, const std::string& system,
    const std::function<void(const PickleValue& values, const std::string& place, PersonEstimate* person)>& rest);

/// Sorts every person's entries by frame, and people by size times time in view; people without a frame are dropped.
/// Throws std::runtime_error "where: …" when a frame occurs twice or no person remains.
void SortEstimate(const std::string& where, BodyEstimate* estimate);

}  // namespace bodyloom
