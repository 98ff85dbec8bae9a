// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/detection/tflite_network.h"

#include <algorithm>
#include <opencv2/dnn.hpp>
#include <string>
#include <utility>

#include "bodyloom/data_tools/detection/tflite_shapes.h"
#include "bodyloom/geometry/base/check.h"

namespace bodyloom {
namespace {

using cv::dnn::DictValue;
using cv::dnn::LayerParams;

bool IsImage(const std::vector<int>& shape) { return shape.size() == 4; }

/// Whether N×H×W×C and N×C×H×W are the same order.
bool OrderIsShared(const std::vector<int>& shape) {
  return !IsImage(shape) || shape[3] == 1 || shape[1] * shape[2] == 1;
}

/// An image's shape in dnn's order; any other shape as it is.
std::vector<int> DnnShape(const std::vector<int>& shape) {
  if (!IsImage(shape)) return shape;
  return {shape[0], shape[3], shape[1], shape[2]};
}

/// dst[c][i] = src[i][c].
void Transpose(const float* src, size_t rows, size_t columns, float* dst) {
  for (size_t i = 0; i < rows; ++i) {
    for (size_t c = 0; c < columns; ++c) dst[c * rows + i] = src[i * columns + c];
  }
}

DictValue Ints(const std::vector<int>& values) {
  return DictValue::arrayInt(values.data(), static_cast<int>(values.size()));
}

/// Whether each operator is needed for these tensors.
std::vector<bool> NeededOperators(const TfliteModel& model, const std::vector<int>& wanted) {
  std::vector<bool> tensor_needed(model.tensors.size(), false), needed(model.operators.size(), false);
  for (const int tensor : wanted) tensor_needed[static_cast<size_t>(tensor)] = true;
  for (size_t i = model.operators.size(); i-- > 0;) {
    const TfliteOperator& op = model.operators[i];
    if (!tensor_needed[static_cast<size_t>(op.output)]) continue;
    needed[i] = true;
    for (const int input : op.inputs) tensor_needed[static_cast<size_t>(input)] = true;
  }
  return needed;
}

/// Zeros around the rows and columns of an image.
struct ImagePads {
  TflitePads rows, columns;
  [[nodiscard]] bool even() const { return rows.before == rows.after && columns.before == columns.after; }
};

class NetBuilder {
 public:
  NetBuilder(const TfliteModel& model, cv::dnn::Net* net)
      : model_(model), net_(net), layer_of_(model.tensors.size(), -1), padding_of_(model.tensors.size(), nullptr) {
    layer_of_[static_cast<size_t>(model.inputs[0])] = 0;  // dnn's own input layer
  }

  void Add(const TfliteOperator& op) {
    int layer = -1;
    switch (op.kind) {
      case TfliteKind::kAdd: {
        LayerParams params;
        params.set("operation", "sum");
        layer = AddLayer("Eltwise", params, LayersOf(op));
        break;
      }
      case TfliteKind::kConcatenation:
        layer = AddConcatenation(op);
        break;
      case TfliteKind::kConv2d:
      case TfliteKind::kDepthwiseConv2d:
        layer = AddConvolution(op);
        break;
      case TfliteKind::kDepthToSpace:
        layer = AddDepthToSpace(op);
        break;
      case TfliteKind::kLogistic:
        layer = AddLayer("Sigmoid", {}, LayersOf(op));
        break;
      case TfliteKind::kMaxPool2d: {
        LayerParams params;
        params.set("pool", "max");
        params.set("ceil_mode", false);
        SetWindow(op, &params);
        layer = AddLayer("Pooling", params, LayersOf(op));
        break;
      }
      case TfliteKind::kPad:
        padding_of_[static_cast<size_t>(op.output)] = &op;  // a layer only where something else than a convolution asks
        return;
      case TfliteKind::kReshape:
        layer = AddReshape(op);
        break;
      case TfliteKind::kResizeBilinear: {
        LayerParams params;
        params.set("interpolation", "bilinear");
        params.set("half_pixel_centers", true);
        params.set("align_corners", false);
        params.set("height", ShapeOf(op.output)[1]);
        params.set("width", ShapeOf(op.output)[2]);
        layer = AddLayer("Resize", params, LayersOf(op));
        break;
      }
    }
    if (op.relu6) {
      LayerParams params;
      params.set("min_value", 0);
      params.set("max_value", 6);
      layer = AddLayer("ReLU6", params, {layer});
    }
    layer_of_[static_cast<size_t>(op.output)] = layer;
  }

  /// The layer that holds a tensor.
  int LayerOf(int tensor) {
    int& layer = layer_of_[static_cast<size_t>(tensor)];
    if (layer < 0) {
      const TfliteOperator& pad = *padding_of_[static_cast<size_t>(tensor)];
      const std::vector<int32_t>& n = model_.tensors[static_cast<size_t>(pad.inputs[1])].ints;
      layer = AddPadding(LayerOf(pad.inputs[0]), {{n[2], n[3]}, {n[4], n[5]}}, {n[6], n[7]});
    }
    return layer;
  }

  static std::string LayerName(int layer) { return "layer " + std::to_string(layer); }

  std::vector<std::shared_ptr<const float[]>> TakeShared() { return std::move(shared_); }

 private:
  [[nodiscard]] const std::vector<int>& ShapeOf(int tensor) const {
    return model_.tensors[static_cast<size_t>(tensor)].shape;
  }

  /// The layers of all inputs that are computed.
  std::vector<int> LayersOf(const TfliteOperator& op) {
    std::vector<int> layers;
    for (const int input : op.inputs) {
      const TfliteTensor& tensor = model_.tensors[static_cast<size_t>(input)];
      if (!tensor.floats && tensor.ints.empty()) layers.push_back(LayerOf(input));
    }
    return layers;
  }

  int AddLayer(const char* type, LayerParams params, const std::vector<int>& inputs) {
    params.type = type;
    params.name = LayerName(++num_layers_);
    const int layer = net_->addLayer(params.name, params.type, params);
    BODYLOOM_CHECK(layer == num_layers_, "layer ", layer, ", expected ", num_layers_);
    for (size_t i = 0; i < inputs.size(); ++i) net_->connect(inputs[i], 0, layer, static_cast<int>(i));
    return layer;
  }

  int AddPadding(int input, const ImagePads& pads, TflitePads channels) {
    LayerParams params;
    params.set("paddings", Ints({0, 0, channels.before, channels.after, pads.rows.before, pads.rows.after,
                                 pads.columns.before, pads.columns.after}));
    return AddLayer("Padding", params, {input});
  }

  int AddPermutation(int input, const std::vector<int>& order) {
    LayerParams params;
    params.set("order", Ints(order));
    return AddLayer("Permute", params, {input});
  }

  int AddShape(int input, const std::vector<int>& shape) {
    LayerParams params;
    params.set("dim", Ints(shape));
    return AddLayer("Reshape", params, {input});
  }

  static void SetWindow(const TfliteOperator& op, LayerParams* params) {
    params->set("kernel_h", op.filter_h);
    params->set("kernel_w", op.filter_w);
    params->set("stride_h", op.stride_h);
    params->set("stride_w", op.stride_w);
  }

  /// [out][h][w][in], or [1][h][w][channels] when `depthwise`, as dnn's [out][in / groups][h][w].
  cv::Mat Kernel(const TfliteTensor& tensor, bool depthwise) {
    const std::vector<int>& s = tensor.shape;
    const std::vector<int> shape = depthwise ? std::vector<int>{s[3], 1, s[1], s[2]} : DnnShape(s);
    if (s[1] * s[2] == 1) {  // the same order; dnn reads a kernel and never writes it
      shared_.push_back(tensor.floats);
      return {shape, CV_32F, const_cast<float*>(tensor.floats.get())};
    }
    cv::Mat kernel(shape, CV_32F);
    const size_t places = static_cast<size_t>(s[1]) * static_cast<size_t>(s[2]), channels = static_cast<size_t>(s[3]);
    for (size_t out = 0; out < static_cast<size_t>(s[0]); ++out) {
      Transpose(tensor.floats.get() + out * places * channels, places, channels,
                kernel.ptr<float>() + out * places * channels);
    }
    return kernel;
  }

  int AddConvolution(const TfliteOperator& op) {
    const TfliteTensor& kernel = model_.tensors[static_cast<size_t>(op.inputs[1])];
    const bool depthwise = op.kind == TfliteKind::kDepthwiseConv2d;
    int source = op.inputs[0];
    const std::vector<int>& in = ShapeOf(source);
    ImagePads pads;
    if (op.same_padding) {
      pads = {SamePads(in[1], op.filter_h, op.stride_h), SamePads(in[2], op.filter_w, op.stride_w)};
    }
    if (const TfliteOperator* pad = padding_of_[static_cast<size_t>(source)]) {
      const std::vector<int32_t>& n = model_.tensors[static_cast<size_t>(pad->inputs[1])].ints;
      const ImagePads both = {{pads.rows.before + n[2], pads.rows.after + n[3]},
                              {pads.columns.before + n[4], pads.columns.after + n[5]}};
      if (n[6] == 0 && n[7] == 0 && both.even()) {
        pads = both;
        source = pad->inputs[0];
      }
    }
    int input = LayerOf(source);
    if (!pads.even()) {
      input = AddPadding(input, pads, {});
      pads = {};
    }
    LayerParams params;
    SetWindow(op, &params);
    params.set("pad_t", pads.rows.before);
    params.set("pad_b", pads.rows.after);
    params.set("pad_l", pads.columns.before);
    params.set("pad_r", pads.columns.after);
    params.set("group", depthwise ? kernel.shape[3] : 1);
    params.set("num_output", depthwise ? kernel.shape[3] : kernel.shape[0]);
    params.set("bias_term", op.inputs.size() > 2);
    params.blobs.push_back(Kernel(kernel, depthwise));
    if (op.inputs.size() > 2) {
      const TfliteTensor& bias = model_.tensors[static_cast<size_t>(op.inputs[2])];
      const std::span<const float> values = bias.values();
      cv::Mat blob(1, static_cast<int>(values.size()), CV_32F);
      std::copy(values.begin(), values.end(), blob.ptr<float>());
      params.blobs.push_back(blob);
    }
    return AddLayer("Convolution", params, {input});
  }

  int AddConcatenation(const TfliteOperator& op) {
    static constexpr int kDnnAxis[] = {0, 2, 3, 1};  // of N, H, W, C
    LayerParams params;
    params.set("axis", IsImage(ShapeOf(op.output)) ? kDnnAxis[op.axis] : op.axis);
    return AddLayer("Concat", params, LayersOf(op));
  }

  int AddDepthToSpace(const TfliteOperator& op) {
    const std::vector<int>& in = ShapeOf(op.inputs[0]);
    const int block = op.block_size;
    int layer = AddShape(LayerOf(op.inputs[0]), {1, block, block, in[3] / (block * block), in[1], in[2]});
    layer = AddPermutation(layer, {0, 3, 4, 1, 5, 2});  // channel, row, row in the block, column, column in the block
    return AddShape(layer, DnnShape(ShapeOf(op.output)));
  }

  int AddReshape(const TfliteOperator& op) {
    const std::vector<int>&in = ShapeOf(op.inputs[0]), &out = ShapeOf(op.output);
    int layer = LayerOf(op.inputs[0]);
    if (!OrderIsShared(in)) layer = AddPermutation(layer, {0, 2, 3, 1});
    if (OrderIsShared(out)) return AddShape(layer, DnnShape(out));
    return AddPermutation(AddShape(layer, out), {0, 3, 1, 2});
  }

  const TfliteModel& model_;
  cv::dnn::Net* net_;
  std::vector<int> layer_of_;                      ///< a tensor; −1 while it has none
  std::vector<const TfliteOperator*> padding_of_;  ///< a tensor that PAD writes
  std::vector<std::shared_ptr<const float[]>> shared_;
  int num_layers_ = 0;
};

}  // namespace

struct TfliteNetwork::Impl {
  std::vector<std::shared_ptr<const float[]>> shared;  // first: the net reads these until its end
  cv::dnn::Net net;
  std::vector<int> input_shape;
  cv::Mat input;
  std::vector<std::vector<int>> output_shapes;
  std::vector<std::string> layers;  // distinct ones that hold wanted outputs
  std::vector<size_t> layer_of;     // among them, a wanted output
  int num_operators = 0;
};

TfliteNetwork::TfliteNetwork(const TfliteModel& model, const std::vector<int>& wanted_outputs)
    : impl_(std::make_unique<Impl>()) {
  BODYLOOM_CHECK(model.inputs.size() == 1, model.name, ": ", model.inputs.size(), " inputs, expected one image");
  impl_->input_shape = model.tensors[static_cast<size_t>(model.inputs[0])].shape;
  BODYLOOM_CHECK(IsImage(impl_->input_shape) && impl_->input_shape[0] == 1, model.name, ": an input of shape ",
                 TfliteShapeText(impl_->input_shape), ", expected 1 x height x width x channels");
  impl_->input = cv::Mat(DnnShape(impl_->input_shape), CV_32F, cv::Scalar(0));

  std::vector<int> wanted;
  for (const int place : wanted_outputs) {
    BODYLOOM_CHECK(place >= 0 && place < static_cast<int>(model.outputs.size()), model.name, ": output ", place,
                   " wanted, expected 0 to ", model.outputs.size() - 1);
    wanted.push_back(model.outputs[static_cast<size_t>(place)]);
  }
  if (wanted.empty()) wanted = model.outputs;

  // Not what an environment variable of OpenCV's might say: the layers above are checked with this one.
  impl_->net.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
  impl_->net.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
  NetBuilder builder(model, &impl_->net);
  const std::vector<bool> needed = NeededOperators(model, wanted);
  for (size_t i = 0; i < needed.size(); ++i) {
    if (!needed[i]) continue;
    builder.Add(model.operators[i]);
    ++impl_->num_operators;
  }
  for (const int tensor : wanted) {
    impl_->output_shapes.push_back(model.tensors[static_cast<size_t>(tensor)].shape);
    const std::string layer = NetBuilder::LayerName(builder.LayerOf(tensor));
    auto at = std::find(impl_->layers.begin(), impl_->layers.end(), layer);
    impl_->layer_of.push_back(static_cast<size_t>(at - impl_->layers.begin()));
    if (at == impl_->layers.end()) impl_->layers.push_back(layer);
  }
  impl_->shared = builder.TakeShared();
}

TfliteNetwork::~TfliteNetwork() = default;
TfliteNetwork::TfliteNetwork(TfliteNetwork&&) noexcept = default;
TfliteNetwork& TfliteNetwork::operator=(TfliteNetwork&&) noexcept = default;

const std::vector<int>& TfliteNetwork::input_shape() const { return impl_->input_shape; }

int TfliteNetwork::num_operators() const { return impl_->num_operators; }

std::vector<TfliteValues> TfliteNetwork::Run(std::span<const float> input) {
  const std::vector<int>& shape = impl_->input_shape;
  const auto channels = static_cast<size_t>(shape[3]), pixels = impl_->input.total() / channels;
  BODYLOOM_CHECK(input.size() == pixels * channels, "an input of ", input.size(), " numbers, expected ",
                 TfliteShapeText(shape));
  Transpose(input.data(), pixels, channels, impl_->input.ptr<float>());
  impl_->net.setInput(impl_->input);
  std::vector<cv::Mat> blobs;
  impl_->net.forward(blobs, impl_->layers);

  std::vector<TfliteValues> outputs(impl_->output_shapes.size());
  for (size_t i = 0; i < outputs.size(); ++i) {
    const cv::Mat& blob = blobs[impl_->layer_of[i]];
    const std::vector<int>& out = outputs[i].shape = impl_->output_shapes[i];
    BODYLOOM_CHECK(blob.isContinuous(), "a blob with gaps");
    outputs[i].values.resize(blob.total());
    const auto last = static_cast<size_t>(out.back());
    // An image of one channel, a row of numbers: both orders are the same, and the transposition copies.
    const bool image = IsImage(out);
    Transpose(blob.ptr<float>(), image ? last : 1, image ? blob.total() / last : blob.total(),
              outputs[i].values.data());
  }
  return outputs;
}

}  // namespace bodyloom
