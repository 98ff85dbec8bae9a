// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/tflite_program.h"

#include <algorithm>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>

#include "geometry/base/check.h"
#include "tracking/detection/inference/tflite_shapes.h"

namespace bodyloom {
namespace {

using dnnl::memory;

constexpr auto kFloat = memory::data_type::f32;
constexpr auto kForward = dnnl::prop_kind::forward_inference;

/// An image N×H×W×C in TFLite's order of memory, as oneDNN names it; any other shape as one row of channels.
memory::desc DescOf(const std::vector<int>& shape) {
  if (IsTfliteImage(shape)) {
    return {{shape[0], shape[3], shape[1], shape[2]}, kFloat, memory::format_tag::nhwc};
  }
  memory::dim size = 1;
  for (const int n : shape) size *= n;
  return {{1, size, 1, 1}, kFloat, memory::format_tag::nhwc};
}
/// Whether each operator is needed for these tensors.
std::vector<bool> NeededOperators(const TfliteModel& model, const std::vector<int>& wanted) {
  std::vector<bool> tensor_needed(model.tensors.size(), false), needed(model.operators.size(), false);
  for (const int tensor : wanted) tensor_needed[size_t(tensor)] = true;
  for (size_t i = model.operators.size(); i-- > 0;) {
    const TfliteOperator& op = model.operators[i];
    if (!tensor_needed[size_t(op.output)]) continue;
    needed[i] = true;
    for (const int input : op.inputs) tensor_needed[size_t(input)] = true;
  }
  return needed;
}
/// Zeros around the rows and columns of an image.
struct ImagePads {
  TflitePads rows, columns;
};
class TfliteProgramBuilder {
 public:
  TfliteProgramBuilder(const TfliteModel& model, const std::vector<int>& wanted, TfliteProgram* program)
      : model_(model),
        program_(program),
        needed_(NeededOperators(model, wanted)),
        uses_(model.tensors.size(), 0),
        buffer_of_(model.tensors.size(), -1),
        padding_of_(model.tensors.size(), nullptr) {
    for (size_t i = 0; i < needed_.size(); ++i) {
      const TfliteOperator& op = model.operators[i];
      if (!needed_[i]) continue;
      ++program->num_operators;
      if (op.kind == TfliteKind::kPad) {
        padding_of_[size_t(op.output)] = &op;
        continue;  // its input is read where the padded image is
      }
      for (const int input : op.inputs) {
        if (!IsConstant(input)) ++uses_[size_t(Unpadded(input))];
      }
    }
    for (const int tensor : wanted) ++uses_[size_t(Unpadded(tensor))];  // that is: kept to the end
    program->input_shape = ShapeOf(model.inputs[0]);
    program->input = NewBuffer(program->input_shape);
    Place(model.inputs[0], program->input);
    for (size_t i = 0; i < needed_.size(); ++i) {
      if (needed_[i] && model.operators[i].kind != TfliteKind::kPad) i = Add(i);
    }
    for (const int tensor : wanted) program->outputs.push_back({ShapeOf(tensor), Source(tensor).buffer});
  }

 private:
  /// A tensor that a step reads. When it was padded for this step alone, its buffer is given back after it.
  struct Read {
    int tensor = -1;  ///< whose uses it counts
    int buffer = -1;
    bool temporary = false;
  };

  [[nodiscard]] const TfliteTensor& Tensor(int tensor) const { return model_.tensors[size_t(tensor)]; }
  [[nodiscard]] const std::vector<int>& ShapeOf(int tensor) const { return Tensor(tensor).shape; }
  [[nodiscard]] bool IsConstant(int tensor) const { return Tensor(tensor).floats || !Tensor(tensor).ints.empty(); }

  /// What is in the middle of a tensor that PAD writes, or the tensor itself.
  [[nodiscard]] int Unpadded(int tensor) const {
    while (const TfliteOperator* pad = padding_of_[size_t(tensor)]) tensor = pad->inputs[0];
    return tensor;
  }

  // --- buffers
  // ----------------------------------------------------------------------------------------------------------

  /// The smallest free one that is large enough, or a new one.
  int NewBuffer(const std::vector<int>& shape) {
    const size_t size = NumTfliteValues(shape);
    auto best = free_.end();
    for (auto at = free_.begin(); at != free_.end(); ++at) {
      if (SizeOf(*at) >= size && (best == free_.end() || SizeOf(*at) < SizeOf(*best))) best = at;
    }
    if (best == free_.end()) {
      program_->buffers.push_back(size);
      users_.push_back(0);
      return int(program_->buffers.size()) - 1;
    }
    const int buffer = *best;
    free_.erase(best);
    return buffer;
  }

  [[nodiscard]] size_t SizeOf(int buffer) const { return program_->buffers[size_t(buffer)]; }

  /// The tensor's numbers are in this buffer from now on, beside others' that share it.
  void Place(int tensor, int buffer) {
    buffer_of_[size_t(tensor)] = buffer;
    users_[size_t(buffer)] += uses_[size_t(tensor)];
    if (users_[size_t(buffer)] == 0) free_.push_back(buffer);
  }

  void Release(int buffer) {
    if (--users_[size_t(buffer)] == 0) free_.push_back(buffer);
  }

  void Release(const Read& read) {
    if (read.temporary) free_.push_back(read.buffer);
    Release(buffer_of_[size_t(read.tensor)]);
  }

  /// The tensor's numbers, padded first where PAD wrote it.
  Read Source(int tensor) {
    const TfliteOperator* pad = padding_of_[size_t(tensor)];
    if (pad == nullptr) return {tensor, buffer_of_[size_t(tensor)], false};
    const Read inner = Source(pad->inputs[0]);
    const Read outer = {inner.tensor, NewBuffer(ShapeOf(tensor)), true};
    AddPadding(inner.buffer, ShapeOf(pad->inputs[0]), Tensor(pad->inputs[1]).ints, ShapeOf(tensor), outer.buffer);
    if (inner.temporary) free_.push_back(inner.buffer);
    return outer;
  }

  // --- steps
  // ------------------------------------------------------------------------------------------------------------

  /// Adds operator i, and the next one when both are one step; returns the last that was added.
  size_t Add(size_t i) {
    const TfliteOperator& op = model_.operators[i];
    switch (op.kind) {
      case TfliteKind::kConv2d:
      case TfliteKind::kDepthwiseConv2d:
        return AddConvolution(i);
      case TfliteKind::kAdd:
        AddSum(op);
        break;
      case TfliteKind::kConcatenation:
        AddConcatenation(op);
        break;
      case TfliteKind::kDepthToSpace:
        AddDepthToSpace(op);
        break;
      case TfliteKind::kLogistic:
        AddUnary<dnnl::eltwise_forward>(
            op, {kForward, dnnl::algorithm::eltwise_logistic, DescOf(ShapeOf(op.output)), 0, 0});
        break;
      case TfliteKind::kMaxPool2d:
        AddUnary<dnnl::pooling_forward>(
            op, {kForward, dnnl::algorithm::pooling_max, DescOf(ShapeOf(op.inputs[0])), DescOf(ShapeOf(op.output)),
                 memory::dims{op.stride_h, op.stride_w}, memory::dims{op.filter_h, op.filter_w}, memory::dims{0, 0},
                 memory::dims{0, 0}});
        break;
      case TfliteKind::kReshape:
        AddReshape(op);
        return i;
      case TfliteKind::kResizeBilinear:
        AddUnary<dnnl::resampling_forward>(op, {kForward, dnnl::algorithm::resampling_linear,
                                                DescOf(ShapeOf(op.inputs[0])), DescOf(ShapeOf(op.output))});
        break;
      case TfliteKind::kPad:
        break;  // where it is read
    }
    return i;
  }

  static void AppendClamp(dnnl::post_ops* ops) { ops->append_eltwise(1, dnnl::algorithm::eltwise_clip, 0, 6); }

  /// Scratch memory of the caller's: the library's own is one a thread that makes primitives, and not one that runs
  /// them.
  static dnnl::primitive_attr AttributesWith(const dnnl::post_ops& ops) {
    dnnl::primitive_attr attributes;
    attributes.set_post_ops(ops);
    attributes.set_scratchpad_mode(dnnl::scratchpad_mode::user);
    return attributes;
  }

  void AddStep(dnnl::primitive primitive, const memory::desc& scratch, std::vector<TfliteStep::Argument> arguments) {
    arguments.push_back({DNNL_ARG_SCRATCHPAD, scratch, kTfliteScratch, {}});
    program_->scratch_bytes = std::max(program_->scratch_bytes, scratch.get_size());
    TfliteStep step;
    step.primitive = std::move(primitive);
    step.arguments = std::move(arguments);
    program_->steps.push_back(std::move(step));
  }

  /// One image in, one out, which may be the same. relu6, which not all primitives take along, as a step behind it.
  template <typename Primitive>
  void AddUnary(const typename Primitive::desc& desc, const std::vector<int>& in, int source,
                const std::vector<int>& out, int target) {
    const typename Primitive::primitive_desc made(desc, AttributesWith({}), program_->engine);
    AddStep(Primitive(made), made.scratchpad_desc(),
            {{DNNL_ARG_SRC, DescOf(in), source, {}}, {DNNL_ARG_DST, DescOf(out), target, {}}});
  }

  template <typename Primitive>
  void AddUnary(const TfliteOperator& op, const typename Primitive::desc& desc) {
    const Read source = Source(op.inputs[0]);
    const int target = NewBuffer(ShapeOf(op.output));
    AddUnary<Primitive>(desc, ShapeOf(op.inputs[0]), source.buffer, ShapeOf(op.output), target);
    Release(source);
    Finish(op, target);
  }

  /// The operator's result is in this buffer but for its activation.
  void Finish(const TfliteOperator& op, int buffer) {
    const std::vector<int>& shape = ShapeOf(op.output);
    if (op.relu6) {
      AddUnary<dnnl::eltwise_forward>({kForward, dnnl::algorithm::eltwise_clip, DescOf(shape), 0, 6}, shape, buffer,
                                      shape, buffer);
    }
    Place(op.output, buffer);
  }

  void AddSum(const TfliteOperator& op) {
    const memory::desc desc = DescOf(ShapeOf(op.output));
    dnnl::post_ops ops;
    if (op.relu6) AppendClamp(&ops);
    const Read a = Source(op.inputs[0]), b = Source(op.inputs[1]);
    const int target = NewBuffer(ShapeOf(op.output));
    const dnnl::binary::primitive_desc made({dnnl::algorithm::binary_add, desc, desc, desc}, AttributesWith(ops),
                                            program_->engine);
    AddStep(
        dnnl::binary(made), made.scratchpad_desc(),
        {{DNNL_ARG_SRC_0, desc, a.buffer, {}}, {DNNL_ARG_SRC_1, desc, b.buffer, {}}, {DNNL_ARG_DST, desc, target, {}}});
    Release(a);
    Release(b);
    Place(op.output, target);
  }

  /// The sum behind operator i that takes its result and nothing else does, and whose other summand is not read any
  /// more: the convolution adds its result to that one, where it is.
  std::optional<size_t> SumBehind(size_t i) const {
    const TfliteOperator& conv = model_.operators[i];
    size_t next = i + 1;
    while (next < needed_.size() && (!needed_[next] || model_.operators[next].kind == TfliteKind::kPad)) ++next;
    if (next >= needed_.size() || model_.operators[next].kind != TfliteKind::kAdd || conv.relu6) return std::nullopt;
    const TfliteOperator& sum = model_.operators[next];
    if (uses_[size_t(conv.output)] != 1) return std::nullopt;
    if ((sum.inputs[0] == conv.output) == (sum.inputs[1] == conv.output)) return std::nullopt;
    const int other = Other(sum, conv.output);
    const int buffer = padding_of_[size_t(other)] ? -1 : buffer_of_[size_t(other)];
    if (buffer < 0 || users_[size_t(buffer)] != 1) return std::nullopt;
    return next;
  }

  static int Other(const TfliteOperator& sum, int tensor) {
    return sum.inputs[0] == tensor ? sum.inputs[1] : sum.inputs[0];
  }

  size_t AddConvolution(size_t i) {
    const TfliteOperator& op = model_.operators[i];
    const bool depthwise = op.kind == TfliteKind::kDepthwiseConv2d;
    int tensor = op.inputs[0];
    ImagePads pads;
    if (op.same_padding) {
      pads = {SamePads(ShapeOf(tensor)[1], op.filter_h, op.stride_h),
              SamePads(ShapeOf(tensor)[2], op.filter_w, op.stride_w)};
    }
    if (const TfliteOperator* pad = padding_of_[size_t(tensor)]) {
      const std::vector<int32_t>& n = Tensor(pad->inputs[1]).ints;
      if (n[6] == 0 && n[7] == 0) {  // zeros around a convolution's input cost nothing
        pads = {{pads.rows.before + n[2], pads.rows.after + n[3]},
                {pads.columns.before + n[4], pads.columns.after + n[5]}};
        tensor = pad->inputs[0];
      }
    }
    const std::optional<size_t> sum = SumBehind(i);
    const TfliteOperator& last = sum ? model_.operators[*sum] : op;
    dnnl::post_ops ops;
    if (sum) ops.append_sum();
    if (last.relu6) AppendClamp(&ops);

    const TfliteTensor& kernel = Tensor(op.inputs[1]);
    const std::vector<int>& k = kernel.shape;  // [out][h][w][in], or [1][h][w][channels]
    const memory::dim height = k[1], width = k[2], channels = k[3], out = k[0];
    const memory::dims kernel_dims =
        depthwise ? memory::dims{channels, 1, 1, height, width} : memory::dims{out, channels, height, width};
    const memory::dims kernel_strides = depthwise
                                            ? memory::dims{1, 1, 1, width * channels, channels}
                                            : memory::dims{height * width * channels, 1, width * channels, channels};
    const memory::desc source_desc = DescOf(ShapeOf(tensor)), target_desc = DescOf(ShapeOf(op.output));
    const memory::desc bias_desc({depthwise ? channels : out}, kFloat, memory::format_tag::x);
    const memory::desc any(kernel_dims, kFloat, memory::format_tag::any);
    const memory::dims strides = {op.stride_h, op.stride_w}, before = {pads.rows.before, pads.columns.before},
                       after = {pads.rows.after, pads.columns.after};
    const bool has_bias = op.inputs.size() > 2;
    using Convolution = dnnl::convolution_forward;
    const auto direct = dnnl::algorithm::convolution_direct;
    const Convolution::primitive_desc desc(
        has_bias ? Convolution::desc(kForward, direct, source_desc, any, bias_desc, target_desc, strides, before, after)
                 : Convolution::desc(kForward, direct, source_desc, any, target_desc, strides, before, after),
        AttributesWith(ops), program_->engine);

    const Read source = Source(tensor);
    const int target = sum ? buffer_of_[size_t(Other(last, op.output))] : NewBuffer(ShapeOf(op.output));
    std::vector<TfliteStep::Argument> arguments = {
        {DNNL_ARG_SRC, source_desc, source.buffer, {}},
        {DNNL_ARG_WEIGHTS,
         {},
         kTfliteConstant,
         Packed(memory::desc(kernel_dims, kFloat, kernel_strides), kernel.values(), desc.weights_desc())},
        {DNNL_ARG_DST, target_desc, target, {}}};
    if (has_bias) {
      arguments.push_back(
          {DNNL_ARG_BIAS, {}, kTfliteConstant, Packed(bias_desc, Tensor(op.inputs[2]).values(), bias_desc)});
    }
    AddStep(Convolution(desc), desc.scratchpad_desc(), std::move(arguments));
    Release(source);
    if (sum) users_[size_t(target)] = 0;  // its last user was the sum; Place() counts the result's
    Place(last.output, target);
    return sum ? *sum : i;
  }

  /// A copy of constants in the order that a primitive wants.
  memory Packed(const memory::desc& from, std::span<const float> values, const memory::desc& to) {
    memory source(from, program_->engine, const_cast<float*>(values.data())), target(to, program_->engine);
    dnnl::stream stream(program_->engine);
    dnnl::reorder(source, target).execute(stream, source, target);
    stream.wait();
    return target;
  }

  // --- rearrangements
  // ---------------------------------------------------------------------------------------------------

  void AddRearrangement(std::vector<int> sources, int target,
                        std::function<void(const std::vector<const float*>&, float*)> rearrange) {
    TfliteStep step;
    step.sources = std::move(sources);
    step.target = target;
    step.rearrange = std::move(rearrange);
    program_->steps.push_back(std::move(step));
  }

  void AddPadding(int source, const std::vector<int>& in, const std::vector<int32_t>& n, const std::vector<int>& out,
                  int target) {
    AddRearrangement({source}, target, [in, n, out](const std::vector<const float*>& from, float* to) {
      std::fill_n(to, NumTfliteValues(out), 0.0F);
      const auto in_channels = size_t(in[3]), out_channels = size_t(out[3]);
      for (int y = 0; y < in[1]; ++y) {
        for (int x = 0; x < in[2]; ++x) {
          const size_t place = size_t(y + n[2]) * size_t(out[2]) + size_t(x + n[4]);
          std::copy_n(from[0] + (size_t(y) * size_t(in[2]) + size_t(x)) * in_channels, in_channels,
                      to + place * out_channels + size_t(n[6]));
        }
      }
    });
  }

  void AddConcatenation(const TfliteOperator& op) {
    std::vector<Read> reads;
    std::vector<int> sources;
    std::vector<size_t> rows;  // floats of each input that lie together
    for (const int input : op.inputs) {
      reads.push_back(Source(input));
      sources.push_back(reads.back().buffer);
      const std::vector<int>& shape = ShapeOf(input);
      rows.push_back(NumTfliteValues({shape.begin() + op.axis, shape.end()}));
    }
    const std::vector<int>& out = ShapeOf(op.output);
    const size_t count = NumTfliteValues({out.begin(), out.begin() + op.axis});
    const int target = NewBuffer(out);
    AddRearrangement(sources, target, [rows, count](const std::vector<const float*>& from, float* to) {
      for (size_t r = 0; r < count; ++r) {
        for (size_t i = 0; i < rows.size(); ++i) to = std::copy_n(from[i] + r * rows[i], rows[i], to);
      }
    });
    for (const Read& read : reads) Release(read);
    Finish(op, target);
  }

  void AddDepthToSpace(const TfliteOperator& op) {
    const std::vector<int> in = ShapeOf(op.inputs[0]);
    const auto block = size_t(op.block_size), height = size_t(in[1]), width = size_t(in[2]),
               channels = size_t(in[3]) / (block * block);
    const Read source = Source(op.inputs[0]);
    const int target = NewBuffer(ShapeOf(op.output));
    AddRearrangement({source.buffer}, target, [=](const std::vector<const float*>& from, float* to) {
      for (size_t y = 0; y < height; ++y) {
        for (size_t r = 0; r < block; ++r) {
          for (size_t x = 0; x < width; ++x) {  // a row of the block is block·channels numbers together, in both
            to = std::copy_n(from[0] + ((y * width + x) * block + r) * block * channels, block * channels, to);
          }
        }
      }
    });
    Release(source);
    Finish(op, target);
  }

  /// The same numbers in the same order.
  void AddReshape(const TfliteOperator& op) {
    const Read source = Source(op.inputs[0]);
    const int buffer = source.buffer;
    if (source.temporary) {
      Release(buffer_of_[size_t(source.tensor)]);
      Place(op.output, buffer);
      return;
    }
    Place(op.output, buffer);
    Release(buffer);
  }

  const TfliteModel& model_;
  TfliteProgram* program_;
  std::vector<bool> needed_;
  std::vector<int> uses_;                          ///< of a tensor, by steps and as a wanted output
  std::vector<int> buffer_of_;                     ///< of a tensor; −1 while it has none
  std::vector<const TfliteOperator*> padding_of_;  ///< a tensor that PAD writes
  std::vector<int> users_;                         ///< of a buffer: uses that are to come
  std::vector<int> free_;
};

}  // namespace

TfliteProgram CompileTflite(const TfliteModel& model, const std::vector<int>& wanted_tensors) {
  TfliteProgram program;
  const TfliteProgramBuilder builder(model, wanted_tensors, &program);
  return program;
}

}  // namespace bodyloom
