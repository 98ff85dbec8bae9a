// SPDX-License-Identifier: Apache-2.0
#include "neural/training/checkpoint.h"

#include <ATen/CPUGeneratorImpl.h>
#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <sstream>
#include <stdexcept>
#include <type_traits>

#include "geometry/base/check.h"
#include "neural/training/run_files.h"

namespace bodyloom {
namespace {

static_assert(std::endian::native == std::endian::little, "checkpoints are little endian");

constexpr std::array<char, 8> kMagic = {'B', 'L', 'O', 'O', 'M', 'C', 'P', '1'};
constexpr uint64_t kFixedBytes = kMagic.size() + 2 * sizeof(uint64_t);
constexpr uint32_t kMaxName = 4096;
constexpr int kMaxDims = 8;

/// Element types by their number in the file.
constexpr std::array<torch::ScalarType, 10> kTypes = {torch::kFloat, torch::kDouble, torch::kHalf,  torch::kBFloat16,
                                                      torch::kLong,  torch::kInt,    torch::kShort, torch::kChar,
                                                      torch::kByte,  torch::kBool};

/// FNV-1a over words of eight bytes, with the high bits folded back so that every bit affects all others.
class Checksum {
 public:
  void Add(const void* bytes, size_t size) {
    const char* next = static_cast<const char*>(bytes);
    while (size > 0) {
      const size_t taken = std::min(size, sizeof(word_) - filled_);
      std::memcpy(reinterpret_cast<char*>(&word_) + filled_, next, taken);
      filled_ += taken;
      next += taken;
      size -= taken;
      if (filled_ == sizeof(word_)) Mix();
    }
  }
  [[nodiscard]] uint64_t Value() const {
    Checksum last = *this;
    last.Mix();
    return last.hash_;
  }

 private:
  void Mix() {
    hash_ = (hash_ ^ word_) * 0x100000001b3ULL;
    hash_ ^= hash_ >> 29;
    word_ = 0;
    filled_ = 0;
  }
  uint64_t hash_ = 0xcbf29ce484222325ULL, word_ = 0;
  size_t filled_ = 0;
};

uint8_t TypeNumber(torch::ScalarType type) {
  const auto found = std::find(kTypes.begin(), kTypes.end(), type);
  BODYLOOM_CHECK(found != kTypes.end(), "checkpoint: a tensor of type ", type);
  return static_cast<uint8_t>(found - kTypes.begin());
}

uint64_t RecordBytes(const std::string& name, const torch::Tensor& tensor) {
  return sizeof(uint32_t) + name.size() + 2 + sizeof(int64_t) * tensor.dim() + tensor.nbytes();
}

/// Reads within the file's bounds and updates the checksum; failures are reported in one line with the path.
class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path), file_(path, std::ios::binary) {
    if (std::filesystem::is_directory(path)) Fail("a folder, expected a checkpoint");
    if (!file_) Fail(std::string("cannot be opened: ") + std::strerror(errno));
    file_.seekg(0, std::ios::end);
    size_ = left_ = static_cast<uint64_t>(file_.tellg());
    file_.seekg(0);
  }
  [[noreturn]] void Fail(const std::string& what) const { throw std::runtime_error(path_ + ": " + what); }

  void Read(void* bytes, uint64_t size) {
    if (size > left_) Fail("damaged: a record reaches beyond the end of the file");
    file_.read(static_cast<char*>(bytes), static_cast<std::streamsize>(size));
    if (!file_) Fail("cannot be read");
    checksum_.Add(bytes, size);
    left_ -= size;
  }
  template <class T>
  T Read() {
    T value;
    Read(&value, sizeof value);
    return value;
  }
  [[nodiscard]] uint64_t size() const { return size_; }
  [[nodiscard]] uint64_t left() const { return left_; }
  [[nodiscard]] uint64_t checksum() const { return checksum_.Value(); }

 private:
  std::string path_;
  std::ifstream file_;
  uint64_t size_ = 0, left_ = 0;
  Checksum checksum_;
};

std::pair<std::string, torch::Tensor> ReadRecord(Reader* reader) {
  const auto length = reader->Read<uint32_t>();
  if (length == 0 || length > kMaxName) reader->Fail(Concatenate("damaged: a name of ", length, " characters"));
  std::string name(length, ' ');
  reader->Read(name.data(), length);
  const auto type = reader->Read<uint8_t>(), dims = reader->Read<uint8_t>();
  if (type >= kTypes.size() || dims > kMaxDims) reader->Fail("damaged: a tensor of an unknown kind");
  std::vector<int64_t> shape;
  uint64_t bytes = c10::elementSize(kTypes[type]);
  for (int i = 0; i < dims; ++i) {
    shape.push_back(reader->Read<int64_t>());
    if (shape.back() < 0 || (shape.back() > 0 && bytes > reader->left() / static_cast<uint64_t>(shape.back()))) {
      reader->Fail("damaged: a tensor larger than the file");
    }
    bytes *= static_cast<uint64_t>(shape.back());
  }
  torch::Tensor tensor = torch::empty(shape, kTypes[type]);
  if (bytes > 0) reader->Read(tensor.data_ptr(), bytes);
  return {name, tensor};
}

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

void WriteTensorFile(const std::string& path, const NamedTensors& tensors) {
  uint64_t total = kFixedBytes;
  for (const auto& [name, tensor] : tensors) {
    BODYLOOM_CHECK(!name.empty() && name.size() <= kMaxName && tensor.defined() && tensor.dim() <= kMaxDims,
                   "checkpoint: the tensor \"", name, "\" has no name, no values or too many dimensions");
    TypeNumber(tensor.scalar_type());
    total += RecordBytes(name, tensor);
  }
  RunFile file(path);
  Checksum checksum;
  const auto write = [&](const void* bytes, size_t size) {
    file.Write(bytes, size);
    checksum.Add(bytes, size);
  };
  write(kMagic.data(), kMagic.size());
  write(&total, sizeof total);
  for (const auto& [name, tensor] : tensors) {
    const auto length = static_cast<uint32_t>(name.size());
    const std::array<uint8_t, 2> kind = {TypeNumber(tensor.scalar_type()), static_cast<uint8_t>(tensor.dim())};
    write(&length, sizeof length);
    write(name.data(), name.size());
    write(kind.data(), kind.size());
    write(tensor.sizes().data(), sizeof(int64_t) * tensor.dim());
    const torch::Tensor values = tensor.detach().to(torch::kCPU).contiguous();
    write(values.data_ptr(), values.nbytes());
  }
  const uint64_t sum = checksum.Value();
  file.Write(&sum, sizeof sum);
  file.Commit();
}

NamedTensors ReadTensorFile(const std::string& path) {
  Reader reader(path);
  std::array<char, 8> magic{};
  if (reader.size() >= kMagic.size()) reader.Read(magic.data(), magic.size());
  if (magic != kMagic) reader.Fail("not a checkpoint of this program");
  const uint64_t claimed = reader.size() >= kFixedBytes ? reader.Read<uint64_t>() : 0;
  if (claimed != reader.size()) {
    reader.Fail(Concatenate("cut off or damaged: ", reader.size(), " bytes",
                            claimed == 0 ? "" : Concatenate(", expected ", claimed)));
  }
  NamedTensors tensors;
  std::set<std::string> names;
  while (reader.left() > sizeof(uint64_t)) {
    tensors.push_back(ReadRecord(&reader));
    if (!names.insert(tensors.back().first).second) reader.Fail("damaged: a name appears twice");
  }
  const uint64_t expected = reader.checksum();
  if (reader.left() != sizeof(uint64_t) || reader.Read<uint64_t>() != expected) {
    reader.Fail("damaged: the checksum does not match");
  }
  return tensors;
}

}  // namespace bodyloom
