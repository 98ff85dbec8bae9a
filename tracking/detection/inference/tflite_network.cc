// SPDX-License-Identifier: Apache-2.0
#include "tracking/detection/inference/tflite_network.h"

#include <algorithm>
#include <memory>
#include <unordered_map>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/math/arrays.h"
#include "tracking/detection/inference/one_thread.h"
#include "tracking/detection/inference/tflite_program.h"
#include "tracking/detection/inference/tflite_shapes.h"

namespace bodyloom {

struct TfliteNetwork::Impl {
  explicit Impl(std::shared_ptr<const TfliteProgram> made)
      : program(std::move(made)),
        stream(program->engine),
        scratch(ZeroFloats(program->scratch_bytes / sizeof(float) + 1)) {
    for (const size_t size : program->buffers) buffers.push_back(ZeroFloats(size));
    for (const TfliteStep& step : program->steps) {
      std::unordered_map<int, dnnl::memory>& of_step = arguments.emplace_back();
      for (const TfliteStep::Argument& argument : step.arguments) {
        of_step.emplace(argument.role, argument.buffer == kTfliteConstant
                                           ? argument.constant
                                           : dnnl::memory(argument.desc, program->engine,
                                                          argument.buffer == kTfliteScratch ? scratch.get()
                                                                                            : Buffer(argument.buffer)));
      }
    }
  }

  [[nodiscard]] float* Buffer(int buffer) const { return buffers[size_t(buffer)].get(); }

  void Run() {
    const OneThread one_thread;
    std::vector<const float*> sources;
    for (size_t i = 0; i < program->steps.size(); ++i) {
      const TfliteStep& step = program->steps[i];
      if (!step.rearrange) {
        step.primitive.execute(stream, arguments[i]);
        continue;
      }
      sources.clear();
      for (const int source : step.sources) sources.push_back(Buffer(source));
      step.rearrange(sources, Buffer(step.target));
    }
    stream.wait();
  }

  std::shared_ptr<const TfliteProgram> program;
  dnnl::stream stream;
  AlignedFloats scratch;
  std::vector<AlignedFloats> buffers;
  std::vector<std::unordered_map<int, dnnl::memory>> arguments;  ///< of each step
};

TfliteNetwork::TfliteNetwork(const TfliteModel& model, const std::vector<int>& wanted_outputs) {
  BODYLOOM_CHECK(model.inputs.size() == 1, model.name, ": ", model.inputs.size(), " inputs, expected one image");
  const std::vector<int>& input_shape = model.tensors[size_t(model.inputs[0])].shape;
  BODYLOOM_CHECK(IsTfliteImage(input_shape) && input_shape[0] == 1, model.name, ": an input of shape ",
                 TfliteShapeText(input_shape), ", expected 1 x height x width x channels");
  std::vector<int> wanted;
  for (const int place : wanted_outputs) {
    BODYLOOM_CHECK(place >= 0 && place < int(model.outputs.size()), model.name, ": output ", place,
                   " wanted, expected 0 to ", model.outputs.size() - 1);
    wanted.push_back(model.outputs[size_t(place)]);
  }
  if (wanted.empty()) wanted = model.outputs;
  const OneThread one_thread;
  impl_ = std::make_unique<Impl>(std::make_shared<const TfliteProgram>(CompileTflite(model, wanted)));
}

TfliteNetwork::TfliteNetwork(const TfliteNetwork& other) : impl_(std::make_unique<Impl>(other.impl_->program)) {}
TfliteNetwork::~TfliteNetwork() = default;
TfliteNetwork::TfliteNetwork(TfliteNetwork&&) noexcept = default;
TfliteNetwork& TfliteNetwork::operator=(TfliteNetwork&&) noexcept = default;

const std::vector<int>& TfliteNetwork::input_shape() const { return impl_->program->input_shape; }

int TfliteNetwork::num_operators() const { return impl_->program->num_operators; }

std::vector<TfliteValues> TfliteNetwork::Run(std::span<const float> input) {
  const TfliteProgram& program = *impl_->program;
  BODYLOOM_CHECK(input.size() == NumTfliteValues(program.input_shape), "an input of ", input.size(),
                 " numbers, expected ", TfliteShapeText(program.input_shape));
  std::copy(input.begin(), input.end(), impl_->Buffer(program.input));
  impl_->Run();
  std::vector<TfliteValues> outputs;
  for (const TfliteProgram::Output& output : program.outputs) {
    const float* values = impl_->Buffer(output.buffer);
    outputs.push_back({output.shape, {values, values + NumTfliteValues(output.shape)}});
  }
  return outputs;
}

}  // namespace bodyloom
