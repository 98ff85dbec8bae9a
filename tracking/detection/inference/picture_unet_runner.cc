// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/picture_unet_runner.h"

#include <algorithm>

#include "geometry/base/check.h"
#include "geometry/math/arrays.h"
#include "tracking/detection/inference/tflite_model.h"

namespace bodyloom {
namespace {

/// The network for pictures of one size, as operators of a TensorFlow Lite model.
class UnetModel {
 public:
  UnetModel(const PictureUnetWeights& weights, PictureUnetPlanes planes, int width, int height)
      : weights_(weights), layers_(PictureUnetLayers(planes)) {
    model_.name = "picture U-Net";
    int full = Image(height / 2, width / 2, layers_[0].in);
    model_.inputs = {full};
    full = Convolve(Convolve(full));
    const int half = Convolve(Convolve(full));
    const int quarter = Convolve(Convolve(half));
    int x = Convolve(Convolve(quarter));
    for (const int skip : {quarter, half, full}) x = Convolve(Convolve(Joined(Enlarged(x), skip)));
    x = Convolve(x);
    const std::vector<int> shape = model_.tensors[x].shape;
    const int picture = Image(2 * shape[1], 2 * shape[2], shape[3] / 4);
    TfliteOperator laid_out;
    laid_out.kind = TfliteKind::kDepthToSpace;
    laid_out.inputs = {x};
    laid_out.output = picture;
    laid_out.block_size = 2;
    model_.operators.push_back(laid_out);
    model_.outputs = {picture};
  }

  [[nodiscard]] const TfliteModel& model() const { return model_; }

 private:
  int Add(TfliteTensor tensor) {
    model_.tensors.push_back(std::move(tensor));
    return static_cast<int>(model_.tensors.size()) - 1;
  }
  int Image(int height, int width, int channels) {
    TfliteTensor image;
    image.shape = {1, height, width, channels};
    return Add(std::move(image));
  }
  int Constant(std::vector<int> shape, const float* values) {
    TfliteTensor constant;
    constant.shape = std::move(shape);
    AlignedFloats floats = ZeroFloats(constant.size());
    std::copy(values, values + constant.size(), floats.get());
    constant.floats = std::move(floats);
    return Add(std::move(constant));
  }

  /// The next convolution.
  int Convolve(int from) {
    const PictureUnetLayer& shape = layers_[next_];
    const PictureUnetWeights::Convolution& numbers = weights_.convolutions[next_++];
    const std::vector<int> in = model_.tensors[from].shape;
    TfliteOperator convolution;
    convolution.kind = TfliteKind::kConv2d;
    convolution.inputs = {from, Constant({shape.out, 3, 3, shape.in}, numbers.kernel.data()),
                          Constant({shape.out}, numbers.bias.data())};
    convolution.relu6 = shape.relu6;
    convolution.same_padding = true;
    convolution.filter_h = convolution.filter_w = 3;
    convolution.stride_h = convolution.stride_w = shape.stride;
    convolution.output = Image(in[1] / shape.stride, in[2] / shape.stride, shape.out);
    model_.operators.push_back(convolution);
    return convolution.output;
  }
  int Enlarged(int from) {
    const std::vector<int> in = model_.tensors[from].shape;
    TfliteOperator enlarged;
    enlarged.kind = TfliteKind::kResizeBilinear;
    enlarged.inputs = {from};
    enlarged.output = Image(2 * in[1], 2 * in[2], in[3]);
    model_.operators.push_back(enlarged);
    return enlarged.output;
  }
  int Joined(int a, int b) {
    const std::vector<int> in = model_.tensors[a].shape;
    TfliteOperator joined;
    joined.kind = TfliteKind::kConcatenation;
    joined.inputs = {a, b};
    joined.axis = 3;
    joined.output = Image(in[1], in[2], in[3] + model_.tensors[b].shape[3]);
    model_.operators.push_back(joined);
    return joined.output;
  }

  const PictureUnetWeights& weights_;
  decltype(PictureUnetLayers({})) layers_;
  TfliteModel model_;
  size_t next_ = 0;
};

/// 2×2 pixels together, channels last.
std::vector<float> Together(int width, int height, int planes, std::span<const float> from) {
  std::vector<float> in(from.size());
  auto next = from.begin();
  for (int p = 0; p < planes; ++p) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const size_t cell = static_cast<size_t>(y / 2) * (width / 2) + x / 2;
        in[cell * 4 * planes + static_cast<size_t>((2 * (y % 2) + x % 2) * planes + p)] = *next++;
      }
    }
  }
  return in;
}

}  // namespace

PictureUnetRunner::PictureUnetRunner(PictureUnetWeights weights, PictureUnetPlanes planes)
    : weights_(std::move(weights)), planes_(planes) {
  std::string why;
  BODYLOOM_CHECK(weights_.IsValid(planes, &why), "picture U-Net: ", why);
}

TfliteNetwork& PictureUnetRunner::NetworkFor(int width, int height) {
  const auto size = std::make_pair(width, height);
  const auto found = networks_.find(size);
  if (found != networks_.end()) return found->second;
  const UnetModel made(weights_, planes_, width, height);
  return networks_.emplace(size, TfliteNetwork(made.model())).first->second;
}

std::vector<float> PictureUnetRunner::Run(int width, int height, std::span<const float> planes) {
  BODYLOOM_CHECK(width > 0 && height > 0 && width % kPictureUnetMultiple == 0 && height % kPictureUnetMultiple == 0,
                 "picture U-Net: ", width, "x", height, " pixels, expected multiples of ", kPictureUnetMultiple);
  const size_t pixels = static_cast<size_t>(width) * height;
  BODYLOOM_CHECK(planes.size() == planes_.in * pixels, "picture U-Net: ", planes.size(), " numbers for ", width, "x",
                 height, " pixels, expected ", planes_.in, " each");
  const std::vector<TfliteValues> answer = NetworkFor(width, height).Run(Together(width, height, planes_.in, planes));
  const size_t outputs = planes_.out;
  std::vector<float> out(outputs * pixels);
  for (size_t i = 0; i < pixels; ++i) {
    for (size_t c = 0; c < outputs; ++c) out[c * pixels + i] = answer[0].values[outputs * i + c];
  }
  return out;
}

}  // namespace bodyloom
