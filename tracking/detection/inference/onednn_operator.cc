// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/onednn_operator.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>
#include <string>

#include "geometry/base/check.h"

namespace bodyloom {
namespace {

using dnnl::memory;

constexpr auto kFloat = memory::data_type::f32;
constexpr int kMaxTransposedAxes = 6;
constexpr auto kForward = dnnl::prop_kind::forward_inference;

const dnnl::engine& ProcessorEngine() {
  static const dnnl::engine engine(dnnl::engine::kind::cpu, 0);
  return engine;
}

memory::dims DimsOf(const std::vector<int64_t>& shape, bool channels_last) {
  const ImageAxes image(shape, channels_last);
  return {image.count, image.channels, image.rows, image.columns};
}

/// An image in the graph's order of memory.
memory::desc ImageDesc(const std::vector<int64_t>& shape, bool channels_last) {
  return {DimsOf(shape, channels_last), kFloat, channels_last ? memory::format_tag::nhwc : memory::format_tag::nchw};
}

/// Numbers in a row.
memory::desc RowDesc(size_t size) { return {{memory::dim(size)}, kFloat, memory::format_tag::x}; }

/// Scratch memory is the caller's: the library's own belongs to the thread that makes a primitive, not to the one that
/// runs it.
dnnl::primitive_attr AttributesWith(const dnnl::post_ops& ops) {
  dnnl::primitive_attr attributes;
  attributes.set_post_ops(ops);
  attributes.set_scratchpad_mode(dnnl::scratchpad_mode::user);
  return attributes;
}

dnnl::post_ops PostOps(const FusedOperators& fused) {
  dnnl::post_ops ops;
  if (fused.sum) ops.append_sum();
  if (fused.swish) ops.append_eltwise(1, dnnl::algorithm::eltwise_swish, 1, 0);
  if (fused.clip) ops.append_eltwise(1, dnnl::algorithm::eltwise_clip, fused.clip->first, fused.clip->second);
  return ops;
}

/// A copy of constants in the layout that a primitive expects.
memory Packed(const memory::desc& from, const SharedNumbers<float>& values, const memory::desc& to) {
  memory source(from, ProcessorEngine(), const_cast<float*>(values.data())), target(to, ProcessorEngine());
  dnnl::stream stream(ProcessorEngine());
  dnnl::reorder(source, target).execute(stream, source, target);
  stream.wait();
  return target;
}

/// A convolution's kernel as oneDNN names it: out × in × rows × columns, with groups before them where there are any.
struct KernelAxes {
  int64_t groups, out, in, rows, columns;  ///< in: of a group
  memory::dims dims, strides;

  KernelAxes(const std::vector<int64_t>& shape, int64_t num_groups, bool channels_last) : groups(num_groups) {
    if (!channels_last) {
      out = shape[0], in = shape[1], rows = shape[2], columns = shape[3];
      strides = {in * rows * columns, rows * columns, columns, 1};
    } else if (groups == 1) {
      out = shape[0], rows = shape[1], columns = shape[2], in = shape[3];
      strides = {rows * columns * in, 1, columns * in, in};
    } else {  // 1 × rows × columns × channels
      in = shape[0], rows = shape[1], columns = shape[2], out = shape[3];
      strides = {1, 1, columns * out, out};
    }
    dims = {out, in, rows, columns};
    if (groups > 1) {
      dims = {groups, out / groups, in, rows, columns};
      strides.insert(strides.begin(), strides[0] * (out / groups));
    }
  }
};

/// Axes of a convolution: of its image, kernel, window and result.
struct ConvolutionAxes {
  ImageAxes in;
  KernelAxes kernel;
  ImageWindow window;
  std::vector<int64_t> shape;  ///< of the result

  /// Throws std::runtime_error when image and kernel do not fit each other.
  explicit ConvolutionAxes(const OperatorArguments& arguments)
      : in(ImageInput(arguments).shape, arguments.channels_last()),
        kernel(KernelShape(arguments), arguments.node().Integer("group", 1), arguments.channels_last()),
        window(arguments, {kernel.rows, kernel.columns}, {in.rows, in.columns}) {
    const bool last = arguments.channels_last(), all = kernel.groups == in.channels;
    if (kernel.groups < 1 || kernel.out % kernel.groups != 0 || in.channels % kernel.groups != 0 ||
        kernel.in != in.channels / kernel.groups || (last && kernel.groups > 1 && !all)) {
      throw std::runtime_error(Concatenate("a kernel of ", GraphShapeText(arguments.Input(1).shape), " in ",
                                           kernel.groups, " groups on an image of ",
                                           GraphShapeText(arguments.Input(0).shape)));
    }
    if (window.kernel != std::array{kernel.rows, kernel.columns})
      throw std::runtime_error("a window of another shape than the kernel's");
    shape = ImageAxes::Shape(in.count, kernel.out, window.Count(0, in.rows), window.Count(1, in.columns), last);
    GraphShapeSize(shape);
  }

 private:
  static const std::vector<int64_t>& KernelShape(const OperatorArguments& arguments) {
    const GraphTensor& kernel = arguments.FloatInput(1);
    if (kernel.rank() != 4 || kernel.size() == 0)
      throw std::runtime_error("a kernel of " + GraphShapeText(kernel.shape));
    return kernel.shape;
  }
};

memory::dims Pair(const std::array<int64_t, 2>& numbers) { return {numbers[0], numbers[1]}; }

}  // namespace

void OnednnOperator::Add(dnnl::primitive primitive, const memory::desc& scratch, std::vector<Argument> arguments) {
  arguments.push_back({DNNL_ARG_SCRATCHPAD, scratch, kScratch, {}});
  scratch_bytes_ = std::max(scratch_bytes_, scratch.get_size());
  primitives_.push_back({std::move(primitive), std::move(arguments)});
}

void OnednnOperator::AddReorder(const memory::desc& from, int source, const memory::desc& to, int target) {
  const dnnl::reorder::primitive_desc desc(ProcessorEngine(), from, ProcessorEngine(), to, AttributesWith({}));
  Add(dnnl::reorder(desc), desc.scratchpad_desc(), {{DNNL_ARG_SRC, from, source, {}}, {DNNL_ARG_DST, to, target, {}}});
}

void OnednnOperator::MakeConvolution(const OperatorArguments& arguments, const FusedOperators& fused) {
  const ConvolutionAxes axes(arguments);
  const KernelAxes& k = axes.kernel;
  const ImageWindow& window = axes.window;
  const bool last = arguments.channels_last();
  shape_ = axes.shape;
  const bool has_bias = arguments.Has(2);
  if (has_bias && int64_t(arguments.Floats(2).size()) != k.out)
    throw std::runtime_error(Concatenate("a bias, expected ", k.out, " numbers"));

  // Images whose channels are last stay so; others are laid out anew for each convolution, which is faster.
  const memory::desc plain_source = ImageDesc(arguments.Input(0).shape, last), plain_target = ImageDesc(shape_, last),
                     any_kernel(k.dims, kFloat, memory::format_tag::any), bias_desc = RowDesc(size_t(k.out)),
                     any_source(plain_source.dims(), kFloat, memory::format_tag::any),
                     any_target(plain_target.dims(), kFloat, memory::format_tag::any);
  const memory::desc &source = last ? plain_source : any_source, &target = last ? plain_target : any_target;
  const memory::dims strides = Pair(window.stride), before = Pair(window.before), after = Pair(window.after),
                     dilation = {window.dilation[0] - 1, window.dilation[1] - 1};
  using Convolution = dnnl::convolution_forward;
  constexpr auto kDirect = dnnl::algorithm::convolution_direct;
  const Convolution::primitive_desc made(
      has_bias ? Convolution::desc(kForward, kDirect, source, any_kernel, bias_desc, target, strides, dilation, before,
                                   after)
               : Convolution::desc(kForward, kDirect, source, any_kernel, target, strides, dilation, before, after),
      AttributesWith(PostOps(fused)), ProcessorEngine());
  const bool moves_source = made.src_desc() != plain_source, moves_target = made.dst_desc() != plain_target;
  if (moves_source) {
    source_bytes_ = made.src_desc().get_size();
    AddReorder(plain_source, 0, made.src_desc(), kSource);
  }
  if (moves_target) {
    target_bytes_ = made.dst_desc().get_size();
    if (fused.sum) AddReorder(plain_target, kResult, made.dst_desc(), kTarget);
  }
  std::vector<Argument> all = {
      {DNNL_ARG_SRC, made.src_desc(), moves_source ? kSource : 0, {}},
      {DNNL_ARG_WEIGHTS, {}, kConstant, Packed({k.dims, kFloat, k.strides}, arguments.Floats(1), made.weights_desc())},
      {DNNL_ARG_DST, made.dst_desc(), moves_target ? kTarget : kResult, {}}};
  if (has_bias) all.push_back({DNNL_ARG_BIAS, {}, kConstant, Packed(bias_desc, arguments.Floats(2), bias_desc)});
  Add(Convolution(made), made.scratchpad_desc(), std::move(all));
  if (moves_target) AddReorder(made.dst_desc(), kTarget, plain_target, kResult);
}

void OnednnOperator::MakePool(const OperatorArguments& arguments) {
  const GraphTensor& image = ImageInput(arguments);
  const bool last = arguments.channels_last(), ceil = arguments.node().Integer("ceil_mode", 0) != 0;
  const ImageAxes in(image.shape, last);
  const std::array<int64_t, 2> lengths = {in.rows, in.columns};
  const ImageWindow window(arguments, {0, 0}, lengths);
  std::array<int64_t, 2> counts = {}, after = {};
  for (size_t axis = 0; axis < 2; ++axis) {
    counts[axis] = window.Count(axis, lengths[axis], ceil);
    const int64_t extent = window.dilation[axis] * (window.kernel[axis] - 1) + 1;  // the last window may begin later
    const int64_t reached = (counts[axis] - 1) * window.stride[axis] + extent;
    after[axis] = std::max(window.after[axis], reached - lengths[axis] - window.before[axis]);
  }
  shape_ = ImageAxes::Shape(in.count, in.channels, counts[0], counts[1], last);
  const memory::desc source = ImageDesc(image.shape, last), target = ImageDesc(shape_, last);
  const dnnl::pooling_v2_forward::primitive_desc made(
      {kForward, dnnl::algorithm::pooling_max, source, target, Pair(window.stride), Pair(window.kernel),
       memory::dims{window.dilation[0] - 1, window.dilation[1] - 1}, Pair(window.before), Pair(after)},
      AttributesWith({}), ProcessorEngine());
  Add(dnnl::pooling_v2_forward(made), made.scratchpad_desc(),
      {{DNNL_ARG_SRC, source, 0, {}}, {DNNL_ARG_DST, target, kResult, {}}});
}

void OnednnOperator::MakeResize(const OperatorArguments& arguments) {
  shape_ = ResizedShape(arguments);
  GraphShapeSize(shape_);
  const memory::desc source = ImageDesc(arguments.Input(0).shape, arguments.channels_last()),
                     target = ImageDesc(shape_, arguments.channels_last());
  const bool linear = arguments.node().Text("mode", "nearest") == "linear";
  const dnnl::resampling_forward::primitive_desc made(
      {kForward, linear ? dnnl::algorithm::resampling_linear : dnnl::algorithm::resampling_nearest, source, target},
      AttributesWith({}), ProcessorEngine());
  Add(dnnl::resampling_forward(made), made.scratchpad_desc(),
      {{DNNL_ARG_SRC, source, 0, {}}, {DNNL_ARG_DST, target, kResult, {}}});
}

void OnednnOperator::MakeTranspose(const OperatorArguments& arguments) {
  const std::vector<int64_t>& from = arguments.Input(0).shape;
  memory::dims strides(from.size(), 1), from_strides = strides, to_strides = strides;
  for (size_t i = from.size(); i-- > 1;) from_strides[i - 1] = from_strides[i] * from[i];
  shape_.clear();
  const std::vector<int64_t> order = TransposedAxes(arguments);
  for (size_t i = 0; i < order.size(); ++i) {
    shape_.push_back(from[size_t(order[i])]);
    strides[i] = from_strides[size_t(order[i])];
  }
  for (size_t i = shape_.size(); i-- > 1;) to_strides[i - 1] = to_strides[i] * shape_[i];
  AddReorder({shape_, kFloat, strides}, 0, {shape_, kFloat, to_strides}, kResult);
}

void OnednnOperator::MakeSigmoid(const OperatorArguments& arguments) {
  shape_ = arguments.FloatInput(0).shape;
  const memory::desc row = RowDesc(GraphShapeSize(shape_));
  const dnnl::eltwise_forward::primitive_desc made({kForward, dnnl::algorithm::eltwise_logistic, row, 0, 0},
                                                   AttributesWith({}), ProcessorEngine());
  Add(dnnl::eltwise_forward(made), made.scratchpad_desc(),
      {{DNNL_ARG_SRC, row, 0, {}}, {DNNL_ARG_DST, row, kResult, {}}});
}

void OnednnOperator::MakeSum(const OperatorArguments& arguments, const FusedOperators& fused) {
  shape_ = arguments.Input(0).shape;
  num_inputs_ = 2;
  const memory::desc row = RowDesc(GraphShapeSize(shape_));
  const dnnl::binary::primitive_desc made({dnnl::algorithm::binary_add, row, row, row}, AttributesWith(PostOps(fused)),
                                          ProcessorEngine());
  Add(dnnl::binary(made), made.scratchpad_desc(),
      {{DNNL_ARG_SRC_0, row, 0, {}}, {DNNL_ARG_SRC_1, row, 1, {}}, {DNNL_ARG_DST, row, kResult, {}}});
}

std::vector<int64_t> OnednnOperator::ConvolvedShape(const OperatorArguments& arguments) {
  return ConvolutionAxes(arguments).shape;
}

std::optional<OnednnOperator> OnednnOperator::Make(const OperatorArguments& arguments,
                                                   const std::vector<bool>& is_constant, const FusedOperators& fused) {
  OnednnOperator made;
  const std::string& op = arguments.node().op;
  if (op == "Conv") {
    for (size_t i = 1; i < is_constant.size(); ++i) {
      if (arguments.Has(i) && !is_constant[i])
        throw std::runtime_error("weights that are computed, expected constants");
    }
    made.MakeConvolution(arguments, fused);
  } else if (op == "MaxPool") {
    made.MakePool(arguments);
  } else if (op == "Resize" || op == "Upsample") {
    made.MakeResize(arguments);
  } else if (op == "Transpose" && arguments.Input(0).has_floats() && arguments.Input(0).size() > 0 &&
             arguments.Input(0).rank() >= 2 && arguments.Input(0).rank() <= kMaxTransposedAxes) {
    made.MakeTranspose(arguments);
  } else if (op == "Sigmoid") {
    made.MakeSigmoid(arguments);
  } else if (op == "Add" && arguments.Input(0).has_floats() && arguments.Input(1).has_floats() &&
             arguments.Input(0).shape == arguments.Input(1).shape && arguments.Input(0).size() > 0) {
    made.MakeSum(arguments, fused);
  } else {
    return std::nullopt;
  }
  for (size_t i = 0; i < made.num_inputs_; ++i) made.input_shapes_.push_back(arguments.Input(i).shape);
  return made;
}

GraphTensor OnednnOperator::Run(std::span<const GraphTensor* const> inputs, const NewNumbers<float>& target,
                                Memory* memory, FloatPool* pool) const {
  for (size_t i = 0; i < num_inputs_; ++i) {
    if (inputs[i]->shape != input_shapes_[i] || !inputs[i]->has_floats()) {
      throw std::runtime_error("an input of " + GraphShapeText(inputs[i]->shape) + ", expected floats of " +
                               GraphShapeText(input_shapes_[i]));
    }
  }
  const auto taken = [pool](size_t bytes) { return bytes == 0 ? nullptr : pool->Take(bytes / sizeof(float) + 1); };
  const std::shared_ptr<float[]> scratch = taken(scratch_bytes_), source = taken(source_bytes_),
                                 moved = taken(target_bytes_);
  const auto at = [&](int place) -> float* {
    switch (place) {
      case kScratch:
        return scratch.get();
      case kResult:
        return target.data();
      case kSource:
        return source.get();
      case kTarget:
        return moved.get();
      default:
        return const_cast<float*>(inputs[size_t(place)]->floats.data());
    }
  };
  if (memory->primitives.empty()) {
    for (const Primitive& step : primitives_) {
      Memory::Bound& bound = memory->primitives.emplace_back();
      for (const Argument& argument : step.arguments) {
        bound.views.push_back(argument.place == kConstant
                                  ? argument.constant
                                  : dnnl::memory(argument.desc, ProcessorEngine(), at(argument.place)));
        bound.arguments.push_back({argument.role, bound.views.back().get()});
      }
    }
  }
  dnnl::stream stream(ProcessorEngine());
  for (size_t i = 0; i < primitives_.size(); ++i) {
    Memory::Bound& bound = memory->primitives[i];
    for (size_t k = 0; k < bound.views.size(); ++k) {
      const int place = primitives_[i].arguments[k].place;
      if (place != kConstant && bound.views[k].get_data_handle() != at(place)) {
        bound.views[k].set_data_handle(at(place));
      }
    }
    dnnl::error::wrap_c_api(dnnl_primitive_execute(primitives_[i].primitive.get(), stream.get(),
                                                   int(bound.arguments.size()), bound.arguments.data()),
                            "could not execute a primitive");
  }
  stream.wait();
  return {shape_, target};
}

}  // namespace bodyloom
