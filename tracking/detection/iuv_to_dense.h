// SPDX-License-Identifier: Apache-2.0
/// Dense keypoints from DensePose labels: each labelled pixel corresponds to a point of the surface by the body's
/// charts.
///
/// 8-bit U stands for [U/255, (U+1)/255) because it was rounded down, so u = min(1, (U + ½)/255), likewise v. Pixels
/// whose (u, v) lies further than `max_gap` outside the chart are dropped (mixed pixels at part boundaries), nearer
/// ones are moved to the nearest point of the chart. `per_frame` pixels of a frame are kept: each part has a share by
/// area, and within a part pixels are sampled at equal steps along a Morton curve, which spreads them evenly over the
/// part.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "data_tools/observations/densepose_iuv.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/label_image.h"
#include "geometry/scene/observations.h"
#include "render/texture/chart_lookup.h"

namespace bodyloom {

/// Standard deviation of DensePose's U and V, chart units, where none is given. No published figure is in these
/// units, so this is an estimate between two bounds. Below: 8 bits rounded down alone give 1/(255 √12) = 0.0011. Above:
/// annotators of rendered bodies err by 2 cm on small parts to 7 cm on the torso (Güler et al., DensePose, CVPR 2018,
/// section 2.1), a tenth of those charts and more, much of it shared by neighbouring pixels. 0.03 of a torso's chart
/// that is 100 px high in the image is 3 px, the sigma_px below. Effect of a wrong value: docs/lab/dense_keypoints.md.
constexpr double kDensePoseUvSigma = 0.03;

/// Standard deviation of an image position that is known to a pixel, in pixels: 1/√12.
constexpr double kPixelWidthSigma = 0.28867513459481287;

struct IuvToDenseOptions {
  int per_frame = 1000;   ///< at most; 0: every pixel
  double sigma_px = 3;    ///< standard deviation given to each keypoint
  double max_gap = 0.05;  ///< chart units
};

/// `mask` chooses pixels (empty: all); it has one entry a pixel.
std::vector<DenseKeypoint> IuvToDense(const IuvImage& iuv, const ChartLookup& charts, const IuvToDenseOptions& options,
                                      const std::vector<uint8_t>& mask = {});
/// The same for charts that were not rounded to bytes.
std::vector<DenseKeypoint> IuvToDense(const ChartImage& image, const ChartLookup& charts,
                                      const IuvToDenseOptions& options);

struct LoadDenseOptions {
  IuvToDenseOptions sampling;
  IuvOrder order = IuvOrder::kDetect;
  double fps = 30;  ///< of image folders; .npz files have timestamps
  /// DenseSequence::uv_sigma, 0: not known. Default: kDensePoseUvSigma for images, the file's value for an .npz.
  std::optional<double> uv_sigma;
  int person =
      0;  ///< with _INDS images: which person of the first frame, 0 the largest; then the one that overlaps most
};

/// True if this path is for LoadDense (a folder with or a file "…_IUV.png", or a .npz with dense keypoints) rather than
/// for LoadDetections. Checks names and the first bytes; throws nothing.
bool HoldsDenseKeypoints(const std::string& path);

/// Dense keypoints of a clip: a folder of IUV images (one a frame; numbers in the names are frame numbers), a single
/// IUV image, or the project's .npz (observations_npz.h). The labels of an image belong to pixels, not to points: their
/// pixel_sigma_px is kPixelWidthSigma. Throws std::runtime_error naming the file: images that differ in size or channel
/// order, faces that the body does not have, no labelled pixel in any frame; std::invalid_argument when the body has no
/// charts.
DenseSequence LoadDense(const std::string& path, const BodyModel& body, const LoadDenseOptions& options = {});

}  // namespace bodyloom
