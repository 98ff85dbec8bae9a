// SPDX-License-Identifier: Apache-2.0
#include "neural/training/checkpoint.h"

#include <ATen/CPUGeneratorImpl.h>

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <stdexcept>
#include <type_traits>

#include "geometry/base/check.h"
#include "neural/training/checkpoint_file.h"

namespace bodyloom {
namespace {

using torch::Tensor;

constexpr const char *kIdentity = "identity", *kConfig = "config", *kStep = "step", *kRandom = "random/cpu";
constexpr const char *kModules = "modules/", *kOptimizers = "optimizers/", *kTensors = "tensors/";

Tensor TextTensor(const std::string& text) {
  return torch::from_blob(const_cast<char*>(text.data()), {static_cast<int64_t>(text.size())}, torch::kByte).clone();
}

std::string TextOf(const Tensor& tensor) {
  const Tensor bytes = tensor.to(torch::kByte).contiguous();
  return {reinterpret_cast<const char*>(bytes.data_ptr<uint8_t>()), static_cast<size_t>(bytes.numel())};
}

/// Parameters and buffers by "name/of.parameter".
NamedTensors TensorsOf(const std::string& name, const torch::nn::Module& module) {
  NamedTensors tensors;
  for (const auto& item : module.named_parameters()) tensors.emplace_back(name + "/" + item.key(), item.value());
  for (const auto& item : module.named_buffers()) tensors.emplace_back(name + "/" + item.key(), item.value());
  return tensors;
}

/// The key of a parameter in an optimizer's state: text in LibTorch 1, a pointer in LibTorch 2.
template <class State>
auto KeyOf(const State&, const Tensor& parameter) {
  if constexpr (std::is_same_v<typename State::key_type, std::string>) {
    std::ostringstream text;
    text << parameter.unsafeGetTensorImpl();
    return text.str();
  } else {
    return static_cast<typename State::key_type>(parameter.unsafeGetTensorImpl());
  }
}

/// An optimizer's state as tensors: the learning rate of each group, and step and moments of each updated parameter.
template <class ParamState>
NamedTensors StateOf(const std::string& name, torch::optim::Optimizer& optimizer) {
  NamedTensors tensors;
  int64_t index = 0;
  for (size_t g = 0; g < optimizer.param_groups().size(); ++g) {
    auto& group = optimizer.param_groups()[g];
    tensors.emplace_back(name + "/group" + std::to_string(g) + "/learning_rate",
                         torch::tensor({group.options().get_lr()}, torch::kDouble));
    for (const Tensor& parameter : group.params()) {
      const std::string place = name + "/parameter" + std::to_string(index++) + "/";
      const auto found = optimizer.state().find(KeyOf(optimizer.state(), parameter));
      if (found == optimizer.state().end()) continue;
      const auto& state = static_cast<const ParamState&>(*found->second);
      tensors.emplace_back(place + "step", torch::tensor({static_cast<int64_t>(state.step())}, torch::kLong));
      tensors.emplace_back(place + "exp_avg", state.exp_avg());
      tensors.emplace_back(place + "exp_avg_sq", state.exp_avg_sq());
      if (state.max_exp_avg_sq().defined()) tensors.emplace_back(place + "max_exp_avg_sq", state.max_exp_avg_sq());
    }
  }
  return tensors;
}

bool IsAdamW(torch::optim::Optimizer& optimizer) { return dynamic_cast<torch::optim::AdamW*>(&optimizer) != nullptr; }

NamedTensors OptimizerState(const std::string& name, torch::optim::Optimizer& optimizer) {
  return IsAdamW(optimizer) ? StateOf<torch::optim::AdamWParamState>(name, optimizer)
                            : StateOf<torch::optim::AdamParamState>(name, optimizer);
}

/// Tensors of a file, each of which must be requested exactly once.
class Contents {
 public:
  Contents(std::string path, const NamedTensors& tensors) : path_(std::move(path)) {
    for (const auto& item : tensors) tensors_.insert(item);
  }
  [[noreturn]] void Fail(const std::string& what) const { throw std::runtime_error(path_ + ": " + what); }

  /// Null if the file does not have it.
  const Tensor* Find(const std::string& name) {
    const auto found = tensors_.find(name);
    if (found == tensors_.end()) return nullptr;
    asked_.insert(name);
    return &found->second;
  }
  const Tensor& Get(const std::string& name) {
    const Tensor* tensor = Find(name);
    if (tensor == nullptr) Fail("no tensor " + name + ": the checkpoint of another network");
    return *tensor;
  }
  const Tensor& Get(const std::string& name, const Tensor& like) {
    const Tensor& tensor = Get(name);
    if (tensor.sizes() != like.sizes() || tensor.scalar_type() != like.scalar_type()) {
      Fail(Concatenate(name, ": ", tensor.scalar_type(), " of shape ", tensor.sizes(), ", expected ",
                       like.scalar_type(), " of shape ", like.sizes()));
    }
    return tensor;
  }
  /// Throws if tensors that begin with `prefix` were not requested.
  void ExpectNoMore(const std::string& prefix) const {
    for (const auto& item : tensors_) {
      if (item.first.rfind(prefix, 0) == 0 && asked_.count(item.first) == 0) {
        Fail("a tensor " + item.first + " that the network does not have: the checkpoint of another one");
      }
    }
  }

 private:
  std::string path_;
  std::map<std::string, Tensor> tensors_;
  std::set<std::string> asked_;
};

using Steps = std::vector<std::function<void()>>;

/// Checks an optimizer's state against its parameters and defers the changes until everything is checked.
template <class ParamState>
void PlanState(const std::string& name, torch::optim::Optimizer* optimizer, Contents* contents, Steps* steps) {
  int64_t index = 0;
  for (size_t g = 0; g < optimizer->param_groups().size(); ++g) {
    auto& group = optimizer->param_groups()[g];
    const Tensor one = torch::empty({1}, torch::kDouble);
    const double rate = contents->Get(name + "/group" + std::to_string(g) + "/learning_rate", one).item<double>();
    steps->push_back([&group, rate] { group.options().set_lr(rate); });
    for (const Tensor& parameter : group.params()) {
      const std::string place = name + "/parameter" + std::to_string(index++) + "/";
      const auto key = KeyOf(optimizer->state(), parameter);
      if (contents->Find(place + "step") == nullptr) {
        steps->push_back([optimizer, key] { optimizer->state().erase(key); });
        continue;
      }
      auto state = std::make_shared<ParamState>();
      state->step(contents->Get(place + "step", torch::empty({1}, torch::kLong)).template item<int64_t>());
      state->exp_avg(contents->Get(place + "exp_avg", parameter).to(parameter.device()));
      state->exp_avg_sq(contents->Get(place + "exp_avg_sq", parameter).to(parameter.device()));
      if (contents->Find(place + "max_exp_avg_sq") != nullptr) {
        state->max_exp_avg_sq(contents->Get(place + "max_exp_avg_sq", parameter).to(parameter.device()));
      }
      steps->push_back(
          [optimizer, key, state] { optimizer->state()[key] = std::make_unique<ParamState>(std::move(*state)); });
    }
  }
}

CheckpointInfo InfoOf(Contents* contents) {
  CheckpointInfo info;
  info.identity = TextOf(contents->Get(kIdentity));
  info.config_json = TextOf(contents->Get(kConfig));
  info.step = contents->Get(kStep, torch::empty({1}, torch::kLong)).item<int64_t>();
  return info;
}

}  // namespace

CheckpointInfo ReadCheckpointInfo(const std::string& path) {
  Contents contents(path, ReadTensorFile(path));
  return InfoOf(&contents);
}

Checkpoint::Checkpoint(std::string identity) : identity_(std::move(identity)) {}

void Checkpoint::CheckName(const std::string& name) const {
  const auto taken = [&](const auto& list) {
    for (const auto& item : list) {
      if (item.first == name) return true;
    }
    return false;
  };
  BODYLOOM_CHECK(!name.empty() && name.find('/') == std::string::npos && !taken(modules_) && !taken(optimizers_) &&
                     !taken(tensors_),
                 "checkpoint: the name \"", name, "\" is taken, empty or has a slash");
}

void Checkpoint::Add(const std::string& name, torch::nn::Module* module) {
  CheckName(name);
  modules_.emplace_back(name, module);
}

void Checkpoint::Add(const std::string& name, torch::optim::Optimizer* optimizer) {
  CheckName(name);
  BODYLOOM_CHECK(IsAdamW(*optimizer) || dynamic_cast<torch::optim::Adam*>(optimizer) != nullptr,
                 "checkpoint: the optimizer \"", name, "\" is neither Adam nor AdamW");
  optimizers_.emplace_back(name, optimizer);
}

void Checkpoint::Add(const std::string& name, Tensor* tensor) {
  CheckName(name);
  tensors_.emplace_back(name, tensor);
}

void Checkpoint::Save(const std::string& path) const {
  NamedTensors all = {{kIdentity, TextTensor(identity_)},
                      {kConfig, TextTensor(config_json)},
                      {kStep, torch::tensor({step}, torch::kLong)},
                      {kRandom, at::detail::getDefaultCPUGenerator().get_state()}};
  const auto append = [&](NamedTensors tensors) {
    for (auto& item : tensors) all.push_back(std::move(item));
  };
  for (const auto& [name, module] : modules_) append(TensorsOf(kModules + name, *module));
  for (const auto& [name, optimizer] : optimizers_) append(OptimizerState(kOptimizers + name, *optimizer));
  for (const auto& [name, tensor] : tensors_) {
    if (tensor->defined()) all.emplace_back(kTensors + name, *tensor);
  }
  WriteTensorFile(path, all);
}

void Checkpoint::Load(const std::string& path, CheckpointPart part) {
  Contents contents(path, ReadTensorFile(path));
  const CheckpointInfo info = InfoOf(&contents);
  if (info.identity != identity_) {
    contents.Fail("a checkpoint of \"" + info.identity + "\", expected one of \"" + identity_ + "\"");
  }
  Steps steps;
  for (const auto& [name, module] : modules_) {
    for (const auto& [place, tensor] : TensorsOf(kModules + name, *module)) {
      steps.push_back([to = tensor, from = contents.Get(place, tensor)]() mutable { to.copy_(from); });
    }
    contents.ExpectNoMore(kModules + name + "/");
  }
  if (part == CheckpointPart::kAll) {
    contents.ExpectNoMore(kModules);
    for (const auto& [name, optimizer] : optimizers_) {
      if (IsAdamW(*optimizer)) {
        PlanState<torch::optim::AdamWParamState>(kOptimizers + name, optimizer, &contents, &steps);
      } else {
        PlanState<torch::optim::AdamParamState>(kOptimizers + name, optimizer, &contents, &steps);
      }
    }
    contents.ExpectNoMore(kOptimizers);
    for (const auto& [name, tensor] : tensors_) {
      const Tensor* found = contents.Find(kTensors + name);
      const auto device = tensor->defined() ? tensor->device() : torch::Device(torch::kCPU);
      steps.push_back([to = tensor, from = found == nullptr ? Tensor() : found->to(device)] { *to = from; });
    }
    contents.ExpectNoMore(kTensors);
    at::Generator generator = at::detail::getDefaultCPUGenerator();
    const Tensor random = contents.Get(kRandom, generator.get_state());
    steps.push_back([generator, random]() mutable { generator.set_state(random); });
  }
  const torch::NoGradGuard no_grad;
  for (const auto& take : steps) take();
  step = info.step;
  config_json = info.config_json;
}

}  // namespace bodyloom
