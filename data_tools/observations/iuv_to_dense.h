// SPDX-License-Identifier: Apache-2.0
/// From DensePose labels to dense keypoints: each labelled pixel names a point of the surface by its body's charts.
///
/// 8-bit U stands for [U/255, (U+1)/255) because it was rounded down, so u = min(1, (U + ½)/255), v alike. Pixels whose
/// (u, v) lies further than `max_gap` outside the chart are dropped (mixed pixels at part borders), nearer ones go to
/// the nearest point of the chart. Of a frame's pixels `per_frame` are kept: every part gets its share by area, and
/// within a part the pixels are taken at equal steps along a Morton curve, which spreads them evenly over the part.
#pragma once

#include <string>
#include <vector>

#include "data_tools/observations/densepose_iuv.h"
#include "geometry/body_model.h"
#include "geometry/observations.h"
#include "render/chart_lookup.h"

namespace bodyloom {

struct IuvToDenseOptions {
  int per_frame = 1000;   ///< at most; 0: every pixel
  double sigma_px = 3;    ///< standard deviation given to each keypoint
  double max_gap = 0.05;  ///< chart units
};

/// `mask` chooses pixels (empty: all); it has one entry a pixel.
std::vector<DenseKeypoint> IuvToDense(const IuvImage& iuv, const ChartLookup& charts, const IuvToDenseOptions& options,
                                      const std::vector<uint8_t>& mask = {});

struct LoadDenseOptions {
  IuvToDenseOptions sampling;
  IuvOrder order = IuvOrder::kDetect;
  double fps = 30;  ///< of image folders; .npz files have timestamps
  int person =
      0;  ///< with _INDS images: which person of the first frame, 0 the largest; then the one that overlaps most
};

/// Whether LoadDense would read this path (a folder with or a file "…_IUV.png", or a .npz with dense keypoints) rather
/// than LoadDetections. Looks at names and the first bytes; throws nothing.
bool HoldsDenseKeypoints(const std::string& path);

/// Dense keypoints of a clip: a folder of IUV images (one a frame; numbers in the names are frame numbers), a single
/// IUV image, or the project's .npz (observations_npz.h). Throws std::runtime_error naming the file: images that differ
/// in size or channel order, faces that the body does not have, no labelled pixel in any frame; std::invalid_argument
/// when the body has no charts.
DenseSequence LoadDense(const std::string& path, const BodyModel& body, const LoadDenseOptions& options = {});

}  // namespace bodyloom
