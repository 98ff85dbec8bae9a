// SPDX-License-Identifier: Apache-2.0
#include "neural/densepose/vision_operators.h"

#include <ATen/Parallel.h>
#include <ATen/core/dispatch/Dispatcher.h>
#include <torch/library.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

namespace bodyloom {
namespace {

struct Box {
  float x0, y0, x1, y1;
  [[nodiscard]] float area() const { return (x1 - x0) * (y1 - y0); }
};

float IntersectionOverUnion(const Box& a, const Box& b) {
  const float width = std::min(a.x1, b.x1) - std::max(a.x0, b.x0);
  const float height = std::min(a.y1, b.y1) - std::max(a.y0, b.y0);
  const float both = std::max(0.0F, width) * std::max(0.0F, height);
  return both / (a.area() + b.area() - both);
}

/// A bilinear sample as four cells and their weights; all weights 0 outside the features.
struct Sample {
  int64_t cell[4] = {0, 0, 0, 0};
  float weight[4] = {0, 0, 0, 0};
};

/// The cell before `at`, and the one after it with its weight; beyond the last cell both are the last.
struct Between {
  Between(float at, int64_t cells) {
    at = std::max(at, 0.0F);
    low = std::min(int64_t(at), cells - 1);
    high = std::min(low + 1, cells - 1);
    weight = low + 1 < cells ? at - float(low) : 0;
  }
  int64_t low, high;
  float weight;
};

Sample SampleAt(float y, float x, int64_t height, int64_t width) {
  Sample sample;
  if (!(y >= -1 && y <= float(height) && x >= -1 && x <= float(width))) return sample;
  const Between row(y, height), column(x, width);
  int k = 0;
  for (const bool below : {false, true}) {
    for (const bool right : {false, true}) {
      sample.cell[k] = (below ? row.high : row.low) * width + (right ? column.high : column.low);
      sample.weight[k] = (below ? row.weight : 1 - row.weight) * (right ? column.weight : 1 - column.weight);
      ++k;
    }
  }
  return sample;
}

/// Positions of a region's samples along one axis: `count` in each of `bins`.
struct Axis {
  Axis(float begin, float end, double scale, int64_t bins, int64_t sampling_ratio, bool aligned) {
    const float offset = aligned ? 0.5F : 0;
    first = begin * float(scale) - offset;
    float side = end * float(scale) - offset - first;
    if (!aligned) side = std::max(side, 1.0F);
    bin = side / float(bins);
    count = sampling_ratio > 0 ? sampling_ratio : std::max(int64_t{0}, int64_t(std::ceil(bin)));
  }
  [[nodiscard]] float At(int64_t b, int64_t i) const {
    return first + float(b) * bin + (float(i) + 0.5F) * bin / float(count);
  }
  float first, bin;
  int64_t count;
};

}  // namespace

torch::Tensor NonMaximumSuppression(const torch::Tensor& boxes, const torch::Tensor& scores, double iou_threshold) {
  TORCH_CHECK(boxes.dim() == 2 && boxes.size(1) == 4 && scores.dim() == 1 && scores.size(0) == boxes.size(0),
              "nms: boxes ", boxes.sizes(), " and scores ", scores.sizes(), ", expected n x 4 and n");
  const torch::Tensor order = std::get<1>(scores.to(torch::kCPU).sort(/*stable=*/true, /*dim=*/0, /*descending=*/true));
  const torch::Tensor values = boxes.to(torch::kCPU, torch::kFloat).contiguous();
  const float* v = values.data_ptr<float>();
  std::vector<Box> kept_boxes;
  std::vector<int64_t> kept;
  for (int64_t k = 0; k < order.numel(); ++k) {
    const int64_t i = order.data_ptr<int64_t>()[k];
    const Box box = {v[4 * i], v[4 * i + 1], v[4 * i + 2], v[4 * i + 3]};
    const auto hides = [&](const Box& other) { return double{IntersectionOverUnion(other, box)} > iou_threshold; };
    if (std::any_of(kept_boxes.begin(), kept_boxes.end(), hides)) continue;
    kept_boxes.push_back(box);
    kept.push_back(i);
  }
  return torch::tensor(kept, torch::kLong).to(boxes.device());
}

torch::Tensor RegionAlign(const torch::Tensor& features, const torch::Tensor& regions, double spatial_scale,
                          int64_t pooled_height, int64_t pooled_width, int64_t sampling_ratio, bool aligned) {
  TORCH_CHECK(
      features.dim() == 4 && regions.dim() == 2 && regions.size(1) == 5 && pooled_height > 0 && pooled_width > 0,
      "roi_align: features ", features.sizes(), " and regions ", regions.sizes(), ", expected N x C x H x W and k x 5");
  const torch::Tensor input = features.to(torch::kCPU, torch::kFloat).contiguous();
  const torch::Tensor places = regions.to(torch::kCPU, torch::kFloat).contiguous();
  const int64_t channels = input.size(1), height = input.size(2), width = input.size(3),
                bins = pooled_height * pooled_width;
  torch::Tensor output = torch::zeros({regions.size(0), channels, pooled_height, pooled_width}, torch::kFloat);
  const float* in = input.data_ptr<float>();
  const float* place = places.data_ptr<float>();
  float* out = output.data_ptr<float>();
  for (int64_t k = 0; k < regions.size(0); ++k) {
    const auto image = int64_t(place[5 * k]);
    TORCH_CHECK(image >= 0 && image < input.size(0), "roi_align: a region of image ", image, " of ", input.size(0));
  }
  at::parallel_for(0, regions.size(0), 1, [&](int64_t begin, int64_t end) {
    std::vector<Sample> samples;
    for (int64_t k = begin; k < end; ++k) {
      const float* region = place + 5 * k;
      const Axis x(region[1], region[3], spatial_scale, pooled_width, sampling_ratio, aligned);
      const Axis y(region[2], region[4], spatial_scale, pooled_height, sampling_ratio, aligned);
      const int64_t count = y.count * x.count;
      samples.clear();
      for (int64_t bin = 0; bin < bins; ++bin) {
        for (int64_t s = 0; s < count; ++s) {
          samples.push_back(
              SampleAt(y.At(bin / pooled_width, s / x.count), x.At(bin % pooled_width, s % x.count), height, width));
        }
      }
      for (int64_t c = 0; c < channels; ++c) {
        const float* plane = in + (int64_t(region[0]) * channels + c) * height * width;
        float* pooled = out + (k * channels + c) * bins;
        for (int64_t i = 0; i < bins * count; ++i) {
          const Sample& sample = samples[size_t(i)];
          for (int tap = 0; tap < 4; ++tap) pooled[i / count] += sample.weight[tap] * plane[sample.cell[tap]];
        }
        for (int64_t bin = 0; bin < bins; ++bin) pooled[bin] /= float(std::max(int64_t{1}, count));
      }
    }
  });
  return output.to(features.options());
}

void RegisterVisionOperators() {
  static const auto registered = [] {
    auto library =
        std::make_unique<torch::Library>(torch::Library::FRAGMENT, "torchvision", c10::nullopt, __FILE__, __LINE__);
    const auto is_missing = [](const char* name) {
      return !c10::Dispatcher::singleton().findSchema({name, ""}).has_value();
    };
    if (is_missing("torchvision::nms")) {
      library->def("nms(Tensor dets, Tensor scores, float iou_threshold) -> Tensor", NonMaximumSuppression);
    }
    if (is_missing("torchvision::roi_align")) {
      library->def(
          "roi_align(Tensor input, Tensor rois, float spatial_scale, int pooled_height, int pooled_width, "
          "int sampling_ratio, bool aligned) -> Tensor",
          RegionAlign);
    }
    return library;
  }();
}

}  // namespace bodyloom
