// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/pipelines/person/picture_refiner.h"

#include <algorithm>

#include "bodyloom/data_tools/detection/tflite_model.h"
#include "bodyloom/geometry/aligned_floats.h"
#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

/// The network for pictures of one size, as operators of a TensorFlow Lite model.
class RefinerModel {
 public:
  RefinerModel(const RefinerWeights& weights, int width, int height) : weights_(weights) {
    model_.name = "picture refiner";
    int full = Image(height / 2, width / 2, kRefinerShapes[0].in);
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

  /// The next convolution of kRefinerShapes.
  int Convolve(int from) {
    const RefinerShape& shape = kRefinerShapes[next_];
    const RefinerWeights::Convolution& numbers = weights_.convolutions[next_++];
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

  const RefinerWeights& weights_;
  TfliteModel model_;
  size_t next_ = 0;
};

/// 2×2 pixels together, channels last.
std::vector<float> Together(const PersonLayers& layers) {
  const int planes = PersonPlane::kCount;
  std::vector<float> in(layers.planes.size());
  for (int p = 0; p < planes; ++p) {
    const float* from = layers.planes.data() + p * layers.pixels();
    for (int y = 0; y < layers.height; ++y) {
      for (int x = 0; x < layers.width; ++x) {
        const size_t cell = static_cast<size_t>(y / 2) * (layers.width / 2) + x / 2;
        in[cell * 4 * planes + static_cast<size_t>((2 * (y % 2) + x % 2) * planes + p)] = *from++;
      }
    }
  }
  return in;
}

}  // namespace

PictureRefiner::PictureRefiner(RefinerWeights weights) : weights_(std::move(weights)) {
  std::string why;
  BODYLOOM_CHECK(weights_.IsValid(&why), "picture refiner: ", why);
}

TfliteNetwork& PictureRefiner::NetworkFor(int width, int height) {
  const auto size = std::make_pair(width, height);
  const auto found = networks_.find(size);
  if (found != networks_.end()) return found->second;
  const RefinerModel made(weights_, width, height);
  return networks_.emplace(size, TfliteNetwork(made.model())).first->second;
}

std::vector<float> PictureRefiner::Change(const PersonLayers& layers) {
  BODYLOOM_CHECK(layers.width > 0 && layers.height > 0 && layers.width % kRefinerMultiple == 0 &&
                     layers.height % kRefinerMultiple == 0 &&
                     layers.planes.size() == PersonPlane::kCount * layers.pixels(),
                 "picture refiner: layers of ", layers.width, "x", layers.height, " pixels, expected multiples of ",
                 kRefinerMultiple);
  const std::vector<TfliteValues> out = NetworkFor(layers.width, layers.height).Run(Together(layers));
  std::vector<float> change(4 * layers.pixels());
  for (size_t i = 0; i < layers.pixels(); ++i) {
    for (size_t c = 0; c < 4; ++c) change[c * layers.pixels() + i] = out[0].values[4 * i + c];
  }
  KeepNearOutline(layers, change);
  return change;
}

}  // namespace bodyloom
