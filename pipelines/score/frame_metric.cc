// SPDX-License-Identifier: Apache-2.0
#include "pipelines/score/frame_metric.h"

#include <cstdint>
#include <stdexcept>

#include "data_tools/datasets/single_person_dataset.h"
#include "geometry/base/check.h"

namespace bodyloom {
namespace {

const PixelMask* MaskOf(const FramePair& frame) { return frame.mask ? &*frame.mask : nullptr; }

/// Labels of a grey image.
std::vector<uint8_t> LabelsOf(const Image& image, const std::string& where) {
  std::vector<uint8_t> labels(image.bgr.size() / 3);
  for (size_t i = 0; i < labels.size(); ++i) {
    const uint8_t* bgr = &image.bgr[3 * i];
    const size_t x = i % image.width, y = i / image.width;
    if (bgr[0] != bgr[1] || bgr[1] != bgr[2]) {
      throw std::runtime_error(
          Concatenate(where, ": pixel (", x, ", ", y, ") is coloured, expected a grey image of labels"));
    }
    if (bgr[0] >= kNumPersonLabels) {
      throw std::runtime_error(Concatenate(where, ": pixel (", x, ", ", y, "): label ", int{bgr[0]}, ", expected 0 to ",
                                           kNumPersonLabels - 1));
    }
    labels[i] = bgr[0];
  }
  return labels;
}

}  // namespace

FrameMetric ImageMetric(SsimPreset preset, bool has_mask) {
  FrameMetric metric;
  metric.columns = {{"psnr_db", "10 log10(255^2 / MSE) of the whole image"}};
  if (has_mask) metric.columns.push_back({"psnr_mask_db", "the same of the pixels in the mask"});
  const bool boxed = has_mask && preset == SsimPreset::kNeuralBody;
  metric.columns.push_back({"ssim_" + ToText(preset), boxed ? "SSIM of the mask's box" : "SSIM of the whole image"});
  metric.compute = [preset, has_mask](const FramePair& frame, const FramePair*) {
    std::vector<double> values = {Psnr(frame.truth, frame.result)};
    if (has_mask) values.push_back(Psnr(frame.truth, frame.result, MaskOf(frame)));
    values.push_back(Ssim(frame.truth, frame.result, preset, MaskOf(frame)));
    return values;
  };
  return metric;
}

FrameMetric LabelMetric() {
  FrameMetric metric;
  metric.columns = {{"label_miou", "mean IoU of the labels that either side has"},
                    {"label_accuracy", "share of pixels with the right label"},
                    {"mask_iou", "IoU of everything but the background"}};
  for (const char* name : kPersonLabelNames)
    metric.columns.push_back({std::string("iou_") + name, "IoU of this label"});
  metric.compute = [](const FramePair& frame, const FramePair*) {
    const std::vector<uint8_t> truth = LabelsOf(frame.truth, "the truth of " + frame.where);
    const std::vector<uint8_t> result = LabelsOf(frame.result, frame.where);
    const LabelOverlap overlap = CompareLabels(truth, result, kNumPersonLabels);
    const int width = frame.truth.width, height = frame.truth.height;
    std::vector<double> values = {overlap.mean_iou, overlap.accuracy,
                                  MaskIoU({width, height, truth}, {width, height, result})};
    values.insert(values.end(), overlap.iou.begin(), overlap.iou.end());
    return values;
  };
  return metric;
}

FrameMetric NormalMetric() {
  FrameMetric metric;
  metric.columns = {{"normal_mean_deg", "mean angle where both sides have a normal"},
                    {"normal_median_deg", "median angle there"},
                    {"normal_coverage", "share of the truth's normals where the result has one"}};
  metric.compute = [](const FramePair& frame, const FramePair*) {
    const NormalError error = CompareNormals(frame.truth, frame.result, MaskOf(frame));
    return std::vector<double>{error.mean_deg, error.median_deg, error.coverage};
  };
  return metric;
}

}  // namespace bodyloom
