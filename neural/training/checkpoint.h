// SPDX-License-Identifier: Apache-2.0
/// Checkpoint of a training run in one file, from which the run resumes bit for bit. Internal: includes LibTorch.
///
/// Holds modules (parameters and buffers by name), Adam and AdamW optimizers (moments, steps, learning rates), named
/// tensors (such as the state of a recurrence), the step, the configuration as text and the state of LibTorch's CPU
/// random generator. Not included: random generators of other devices and of the caller.
///
/// File, little endian: "BLOOMCP1"; u64 size of the file; records (u32 name length, name, u8 element type, u8
/// dimensions, i64 sizes, values); u64 checksum of everything before it. Records are in the order added, so equal
/// states give equal bytes.
#pragma once

#include <torch/torch.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "neural/base/device.h"
#include "neural/base/runtime.h"

namespace bodyloom {

struct CheckpointInfo {
  std::string identity;     ///< the trained networks, such as "motion renderer, profile cpu, 256 px"
  std::string config_json;  ///< as the caller gave it
  int64_t step = 0;
};

/// Reads the declarations of a file, to build its networks before loading them. Checks the file as Load does.
CheckpointInfo ReadCheckpointInfo(const std::string& path);

enum class CheckpointPart { kAll, kModules };

class Checkpoint {
 public:
  /// `identity`: one line that identifies the networks; files with another one are refused.
  explicit Checkpoint(std::string identity);

  /// Adds an object, which must outlive this; names must be unique and not empty.
  void Add(const std::string& name, torch::nn::Module* module);
  /// Adds an Adam or AdamW optimizer; std::invalid_argument for others.
  void Add(const std::string& name, torch::optim::Optimizer* optimizer);
  /// Adds a tensor. Load replaces it with any shape; undefined tensors stay undefined.
  void Add(const std::string& name, torch::Tensor* tensor);

  int64_t step = 0;
  std::string config_json;

  /// Writes the file atomically. Throws std::runtime_error "path: why" (no folder, disk full).
  void Save(const std::string& path) const;

  /// Loads the file; on failure nothing of the run changes. kModules leaves optimizers, tensors and the random
  /// generator unchanged (for inference; those of the file may then differ). Throws std::runtime_error, one line that
  /// begins with the path, for a file that is missing, not a checkpoint, cut off, damaged, of another identity, or with
  /// other modules, tensors or optimizers (naming the tensor, its shape and the expected one).
  void Load(const std::string& path, CheckpointPart part = CheckpointPart::kAll);

 private:
  std::string identity_;
  std::vector<std::pair<std::string, torch::nn::Module*>> modules_;
  std::vector<std::pair<std::string, torch::optim::Optimizer*>> optimizers_;
  std::vector<std::pair<std::string, torch::Tensor*>> tensors_;
  void CheckName(const std::string& name) const;
};

/// Loads the networks of a run ("model" of its checkpoint) for inference on `device`. The checkpoint must be of this
/// configuration (ToText); throws as Checkpoint::Load otherwise.
template <class Model, class Config>
Model LoadModel(const std::string& path, const Config& config, int num_threads, const std::string& device) {
  StartNeuralRuntime(num_threads);
  UseNeuralDevice(device);
  Model model(config);
  model->to(NeuralDevice());
  Checkpoint checkpoint(ToText(config));
  checkpoint.Add("model", model.ptr().get());
  checkpoint.Load(path, CheckpointPart::kModules);
  model->eval();
  return model;
}

// Writes and reads named tensors in the file format of checkpoints.

using NamedTensors = std::vector<std::pair<std::string, torch::Tensor>>;

/// Tensors of any device; types float, double, half, bfloat16, int64, int32, int16, int8, uint8, bool.
void WriteTensorFile(const std::string& path, const NamedTensors& tensors);

/// Reads tensors in the file's order, on the CPU, after checking the file's size, all declared sizes and the checksum.
/// Throws std::runtime_error, one line that begins with the path.
NamedTensors ReadTensorFile(const std::string& path);

}  // namespace bodyloom
