// SPDX-License-Identifier: Apache-2.0
/// Similarity of motions: normalised cross-correlation of the descriptors of their frames.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "data_tools/descriptors/person_frames.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"
#include "geometry/uv_maps/descriptor_options.h"

namespace bodyloom {

/// One row per frame.
using DescriptorRows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The 3D motion descriptor, 3 + 3·past channels over the atlas; with past 0 only its normals. Throws
/// std::invalid_argument for more past than the frames have.
DescriptorRows MotionDescriptors(const PersonFrames& frames, int past);

/// Pearson's correlation of every row of `a` with every row of `b`, in [−1, 1]; 0 where a row is constant. Throws
/// std::invalid_argument when lengths differ.
Eigen::MatrixXf NormalisedCrossCorrelation(const DescriptorRows& a, const DescriptorRows& b);

/// Similarity of each frame's motion to those of other frames: the largest normalised cross-correlation, in [−1, 1], of
/// its motion descriptor (normals and the velocities of `past` frames over an atlas of 32², in the axes of `motion`)
/// with that of any frame of `others`, which may be the same track (then 1). `counts` has an entry per frame of
/// `others`, 0 for those that only serve the velocities of their neighbours; empty: all count. NaN for a frame without
/// a result, and if no frame of `others` counts. Yoon et al., CVPR 2022, Fig. 6.
/// Memory: 4 · 1024 · (3 + 3 past) bytes a frame of both. Throws as PersonFrames, and std::invalid_argument for another
/// number of `counts`.
std::vector<float> SimilarityToNearest(const BodyModel& body, const Track& track, const Track& others, int past,
                                       int num_threads, const SurfaceMotion& motion = {},
                                       std::span<const char> counts = {});

}  // namespace bodyloom
