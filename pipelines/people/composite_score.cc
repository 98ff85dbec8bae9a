// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/people/composite_score.h"

#include <cmath>
#include <limits>

#include "bodyloom/data_tools/evaluation/image_metrics.h"

namespace bodyloom {

void CompositeScore::Sum::Add(double value) {
  if (!std::isfinite(value)) return;
  total += value;
  ++count;
}

double CompositeScore::Sum::Mean() const {
  return count > 0 ? total / count : std::numeric_limits<double>::quiet_NaN();
}

void CompositeScore::Add(int t, const Image& composed) {
  PersonPictures wanted;
  wanted.normals = wanted.iuv = wanted.background = false;
  PersonFrame frame = set_.Read(t, wanted);
  const Image truth = Resized(frame.rgb, width_, height_);
  whole_.Add(Psnr(truth, composed));
  if (frame.labels.empty()) return;
  for (uint8_t& label : frame.labels.bgr) label = label == 0 ? 0 : 255;
  const PixelMask rim = RimOf(MaskFrom(Resized(frame.labels, width_, height_)), kRimPixels);
  rim_.Add(Psnr(truth, composed, &rim));
}

}  // namespace bodyloom
