// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/image_unet_runner.h"

#include <map>
#include <string>

#include "geometry/base/check.h"
#include "tracking/detection/inference/graph.h"

namespace bodyloom {
namespace {

/// The network as a graph with channels last, for images of one size.
class UnetGraph {
 public:
  UnetGraph(const ImageUnetWeights& weights, ImageUnetPlanes planes, int width, int height)
      : weights_(weights), layers_(ImageUnetLayers(planes)) {
    graph_.name = "picture U-Net";
    graph_.opset = 13;
    graph_.channels_last = true;
    graph_.tensors.push_back({"input", {1, height / 2, width / 2, layers_[0].in}, {}});
    graph_.inputs = {0};
    const int full = Convolve(Convolve(0)), half = Convolve(Convolve(full)), quarter = Convolve(Convolve(half));
    int x = Convolve(Convolve(quarter)), scale = 4;
    for (const int skip : {quarter, half, full}) {
      const std::vector<int64_t> size = {1, height / 2 / scale, width / 2 / scale, channels_};
      const int enlarged =
          Add("Resize", {x}, {{"mode", GraphAttribute::Text("linear")}, {"sizes", GraphAttribute::Ints(size)}});
      x = Convolve(Convolve(Add("Concat", {enlarged, skip}, {{"axis", GraphAttribute::Ints({3})}})));
      scale /= 2;
    }
    graph_.outputs = {Add("DepthToSpace", {Convolve(x)}, {{"blocksize", GraphAttribute::Ints({2})}})};
  }

  [[nodiscard]] const OperatorGraph& graph() const { return graph_; }

 private:
  int Add(const std::string& op, std::vector<int> inputs, std::map<std::string, GraphAttribute> attributes) {
    const int output = static_cast<int>(graph_.tensors.size());
    graph_.tensors.push_back({op, {}, {}});
    graph_.nodes.push_back({op, op, std::move(inputs), {output}, std::move(attributes)});
    return output;
  }
  int Constant(const std::vector<int64_t>& shape, const float* values) {
    const size_t size = GraphShapeSize(shape);
    graph_.tensors.push_back({"constant", shape, GraphTensor(shape, std::vector<float>(values, values + size))});
    return static_cast<int>(graph_.tensors.size()) - 1;
  }

  /// The next convolution. Its sides are even where its stride is 2: zeros before its first row would not be read.
  int Convolve(int from) {
    const ImageUnetLayer& shape = layers_[next_];
    const ImageUnetWeights::Convolution& numbers = weights_.convolutions[next_++];
    channels_ = shape.out;
    const int kernel = Constant({shape.out, 3, 3, shape.in}, numbers.kernel.data());
    const int bias = Constant({shape.out}, numbers.bias.data());
    const int64_t stride = shape.stride, before = stride == 1 ? 1 : 0;
    const int result = Add(
        "Conv", {from, kernel, bias},
        {{"strides", GraphAttribute::Ints({stride, stride})}, {"pads", GraphAttribute::Ints({before, before, 1, 1})}});
    if (!shape.relu6) return result;
    return Add("Clip", {result}, {{"min", GraphAttribute::Floats({0})}, {"max", GraphAttribute::Floats({6})}});
  }

  const ImageUnetWeights& weights_;
  decltype(ImageUnetLayers({})) layers_;
  OperatorGraph graph_;
  size_t next_ = 0;
  int64_t channels_ = 0;  ///< of the last convolution's result
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

ImageUnetRunner::ImageUnetRunner(ImageUnetWeights weights, ImageUnetPlanes planes)
    : weights_(std::move(weights)), planes_(planes) {
  std::string why;
  BODYLOOM_CHECK(weights_.IsValid(planes, &why), "picture U-Net: ", why);
}

const GraphExecutor& ImageUnetRunner::NetworkFor(int width, int height) {
  const auto size = std::make_pair(width, height);
  const auto found = networks_.find(size);
  if (found != networks_.end()) return found->second;
  const UnetGraph made(weights_, planes_, width, height);
  return networks_.emplace(size, GraphExecutor(made.graph())).first->second;
}

std::vector<float> ImageUnetRunner::Run(int width, int height, std::span<const float> planes) {
  BODYLOOM_CHECK(width > 0 && height > 0 && width % kImageUnetMultiple == 0 && height % kImageUnetMultiple == 0,
                 "picture U-Net: ", width, "x", height, " pixels, expected multiples of ", kImageUnetMultiple);
  const size_t pixels = static_cast<size_t>(width) * height;
  BODYLOOM_CHECK(planes.size() == planes_.in * pixels, "picture U-Net: ", planes.size(), " numbers for ", width, "x",
                 height, " pixels, expected ", planes_.in, " each");
  const std::vector<GraphTensor> answer = NetworkFor(width, height).Run(Together(width, height, planes_.in, planes));
  const size_t outputs = planes_.out;
  std::vector<float> out(outputs * pixels);
  for (size_t i = 0; i < pixels; ++i) {
    for (size_t c = 0; c < outputs; ++c) out[c * pixels + i] = answer[0].floats[outputs * i + c];
  }
  return out;
}

}  // namespace bodyloom
