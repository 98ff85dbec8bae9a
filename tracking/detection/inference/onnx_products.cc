// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/onnx_products.h"

#include <algorithm>
#include <array>
#include <dnnl.hpp>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "geometry/base/check.h"
#include "tracking/detection/inference/onnx_arithmetic.h"
#include "tracking/detection/inference/onnx_image.h"

namespace bodyloom {
namespace {

using dnnl::memory;

constexpr auto kProductType = memory::data_type::f32;

memory::desc Plain(const std::vector<int64_t>& shape) {
  return {{shape[0], shape[1], shape[2], shape[3]}, kProductType, memory::format_tag::nchw};
}

const dnnl::engine& Engine() {
  static const dnnl::engine engine(dnnl::engine::kind::cpu, 0);
  return engine;
}

memory View(const memory::desc& desc, const float* values) { return {desc, Engine(), const_cast<float*>(values)}; }

/// C = alpha · A · B, row after row.
void Multiply(bool transpose_a, bool transpose_b, int64_t rows, int64_t columns, int64_t inner, float alpha,
              const float* a, const float* b, float* c) {
  if (rows == 0 || columns == 0) return;
  if (inner == 0) {
    std::fill_n(c, rows * columns, 0.0F);
    return;
  }
  const dnnl::status status =
      dnnl::sgemm(transpose_a ? 'T' : 'N', transpose_b ? 'T' : 'N', rows, columns, inner, alpha, a,
                  transpose_a ? rows : inner, b, transpose_b ? inner : columns, 0.0F, c, columns);
  if (status != dnnl::status::success) throw std::runtime_error("a product of matrices failed");
}

}  // namespace

struct OnnxConvolution::Impl {
  std::vector<int64_t> in, out;
  dnnl::convolution_forward primitive;
  memory::desc source, target, scratch;
  memory weights, bias;
  bool has_bias = false;
};

OnnxConvolution::OnnxConvolution(const OnnxArguments& arguments, bool swish) : impl_(std::make_unique<Impl>()) {
  const OnnxTensor &image = OnnxImage(arguments), &kernel = arguments.Input(1);
  const std::vector<float>& values = arguments.Floats(1);
  const int64_t groups = arguments.node().Integer("group", 1);
  if (kernel.rank() != 4 || kernel.size() == 0) throw std::runtime_error("a kernel of " + OnnxShapeText(kernel.shape));
  const int64_t out = kernel.shape[0], channels = image.shape[1];
  if (groups < 1 || out % groups != 0 || channels % groups != 0 || kernel.shape[1] != channels / groups) {
    throw std::runtime_error(Concatenate("a kernel of ", OnnxShapeText(kernel.shape), " in ", groups,
                                         " groups on an image of ", OnnxShapeText(image.shape)));
  }
  const OnnxWindow window(arguments, {kernel.shape[2], kernel.shape[3]}, {image.shape[2], image.shape[3]});
  if (window.kernel != std::array{kernel.shape[2], kernel.shape[3]})
    throw std::runtime_error("a window of another shape than the kernel's");
  Impl& made = *impl_;
  made.in = image.shape;
  made.out = {image.shape[0], out, window.Count(0, image.shape[2]), window.Count(1, image.shape[3])};
  OnnxShapeSize(made.out);
  made.has_bias = arguments.Has(2);
  if (made.has_bias && int64_t(arguments.Floats(2).size()) != out)
    throw std::runtime_error(Concatenate("a bias, expected ", out, " numbers"));

  const auto any = [](const std::vector<int64_t>& shape) {
    return memory::desc({shape[0], shape[1], shape[2], shape[3]}, kProductType, memory::format_tag::any);
  };
  const memory::dims kernel_dims =
      groups == 1 ? memory::dims(kernel.shape)
                  : memory::dims{groups, out / groups, kernel.shape[1], kernel.shape[2], kernel.shape[3]};
  const memory::desc plain_kernel(kernel_dims, kProductType,
                                  groups == 1 ? memory::format_tag::oihw : memory::format_tag::goihw),
      any_kernel(kernel_dims, kProductType, memory::format_tag::any),
      bias_desc({out}, kProductType, memory::format_tag::x);
  const auto dims = [](const std::array<int64_t, 2>& pair) { return memory::dims{pair[0], pair[1]}; };
  const memory::dims dilation = {window.dilation[0] - 1, window.dilation[1] - 1};
  using Convolution = dnnl::convolution_forward;
  constexpr auto kForward = dnnl::prop_kind::forward_inference;
  constexpr auto kDirect = dnnl::algorithm::convolution_direct;
  const Convolution::desc described =
      made.has_bias ? Convolution::desc(kForward, kDirect, any(made.in), any_kernel, bias_desc, any(made.out),
                                        dims(window.stride), dilation, dims(window.before), dims(window.after))
                    : Convolution::desc(kForward, kDirect, any(made.in), any_kernel, any(made.out), dims(window.stride),
                                        dilation, dims(window.before), dims(window.after));
  dnnl::post_ops after;
  if (swish) after.append_eltwise(1, dnnl::algorithm::eltwise_swish, 1, 0);
  dnnl::primitive_attr attributes;
  attributes.set_post_ops(after);
  attributes.set_scratchpad_mode(dnnl::scratchpad_mode::user);
  const Convolution::primitive_desc desc(described, attributes, Engine());
  made.primitive = Convolution(desc);
  made.source = desc.src_desc();
  made.target = desc.dst_desc();
  made.scratch = desc.scratchpad_desc();
  made.weights = memory(desc.weights_desc(), Engine());
  dnnl::stream stream(Engine());
  memory stored = View(plain_kernel, values.data());
  dnnl::reorder(stored, made.weights).execute(stream, stored, made.weights);
  if (made.has_bias) {
    made.bias = memory(bias_desc, Engine());
    std::copy(arguments.Floats(2).begin(), arguments.Floats(2).end(), static_cast<float*>(made.bias.get_data_handle()));
  }
  stream.wait();
}

OnnxConvolution::~OnnxConvolution() = default;
OnnxConvolution::OnnxConvolution(OnnxConvolution&&) noexcept = default;
OnnxConvolution& OnnxConvolution::operator=(OnnxConvolution&&) noexcept = default;

OnnxTensor OnnxConvolution::Run(const OnnxTensor& image) const {
  const Impl& made = *impl_;
  if (image.shape != made.in || !image.has_floats()) {
    throw std::runtime_error("an image of " + OnnxShapeText(image.shape) + ", expected " + OnnxShapeText(made.in));
  }
  std::vector<float> result(OnnxShapeSize(made.out));
  dnnl::stream stream(Engine());
  memory given = View(Plain(made.in), image.floats->data()), wanted = View(Plain(made.out), result.data());
  memory source = made.source == Plain(made.in) ? given : memory(made.source, Engine());
  memory target = made.target == Plain(made.out) ? wanted : memory(made.target, Engine());
  if (made.source != Plain(made.in)) dnnl::reorder(given, source).execute(stream, given, source);
  std::unordered_map<int, memory> all = {{DNNL_ARG_SRC, source},
                                         {DNNL_ARG_WEIGHTS, made.weights},
                                         {DNNL_ARG_DST, target},
                                         {DNNL_ARG_SCRATCHPAD, memory(made.scratch, Engine())}};
  if (made.has_bias) all.emplace(DNNL_ARG_BIAS, made.bias);
  made.primitive.execute(stream, all);
  if (made.target != Plain(made.out)) dnnl::reorder(target, wanted).execute(stream, target, wanted);
  stream.wait();
  return {made.out, std::move(result)};
}

OnnxTensor OnnxMatMul(const OnnxArguments& arguments) {
  OnnxTensor a = arguments.FloatInput(0), b = arguments.FloatInput(1);
  if (a.rank() == 0 || b.rank() == 0) throw std::runtime_error("a product with a single number");
  const bool row = a.rank() == 1, column = b.rank() == 1;
  if (row) a = a.Reshaped({1, a.shape[0]});
  if (column) b = b.Reshaped({b.shape[0], 1});
  const int64_t rows = a.shape[size_t(a.rank() - 2)], inner = a.shape.back(), columns = b.shape.back();
  if (b.shape[size_t(b.rank() - 2)] != inner) {
    throw std::runtime_error("a product of " + OnnxShapeText(a.shape) + " and " + OnnxShapeText(b.shape));
  }
  const std::vector<int64_t> a_batch(a.shape.begin(), a.shape.end() - 2), b_batch(b.shape.begin(), b.shape.end() - 2);
  std::vector<int64_t> shape = OnnxBroadcastShape(a_batch, b_batch);
  const size_t batch = OnnxShapeSize(shape);
  const auto spread = [&shape](const OnnxTensor& tensor, int64_t n, int64_t m) {
    std::vector<int64_t> to = shape;
    to.insert(to.end(), {n, m});
    return OnnxBroadcastTo(tensor, to);
  };
  const bool shared = b_batch.empty();  // one matrix for all: one product
  const OnnxTensor left = spread(a, rows, inner), right = shared ? b : spread(b, inner, columns);
  shape.insert(shape.end(), {rows, columns});
  std::vector<float> result(OnnxShapeSize(shape));
  const size_t products = shared ? 1 : batch;
  const int64_t together = shared ? int64_t(batch) * rows : rows;
  for (size_t i = 0; i < products; ++i) {
    Multiply(false, false, together, columns, inner, 1, left.floats->data() + i * size_t(rows * inner),
             right.floats->data() + i * size_t(inner * columns), result.data() + i * size_t(rows * columns));
  }
  if (row) shape.erase(shape.end() - 2);
  if (column) shape.pop_back();
  return {std::move(shape), std::move(result)};
}

OnnxTensor OnnxGemm(const OnnxArguments& arguments) {
  const OnnxTensor &a = arguments.FloatInput(0), &b = arguments.FloatInput(1);
  if (a.rank() != 2 || b.rank() != 2) throw std::runtime_error("other than two matrices");
  const bool turn_a = arguments.node().Integer("transA", 0) != 0, turn_b = arguments.node().Integer("transB", 0) != 0;
  const int64_t rows = a.shape[turn_a ? 1 : 0], inner = a.shape[turn_a ? 0 : 1];
  const int64_t columns = b.shape[turn_b ? 0 : 1];
  if (b.shape[turn_b ? 1 : 0] != inner) {
    throw std::runtime_error("a product of " + OnnxShapeText(a.shape) + " and " + OnnxShapeText(b.shape));
  }
  std::vector<float> result(OnnxShapeSize({rows, columns}));
  Multiply(turn_a, turn_b, rows, columns, inner, arguments.node().Float("alpha", 1), a.floats->data(), b.floats->data(),
           result.data());
  if (arguments.Has(2)) {
    const OnnxTensor bias = OnnxBroadcastTo(arguments.FloatInput(2), {rows, columns});
    const float beta = arguments.node().Float("beta", 1);
    for (size_t i = 0; i < result.size(); ++i) result[i] += beta * (*bias.floats)[i];
  }
  return {{rows, columns}, std::move(result)};
}

}  // namespace bodyloom
