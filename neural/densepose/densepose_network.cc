// SPDX-License-Identifier: Apache-2.0
#include "neural/densepose/densepose_network.h"

#include <torch/script.h>
#include <optional>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "geometry/base/check.h"
#include "neural/base/device.h"
#include "neural/densepose/paste_charts.h"
#include "neural/densepose/vision_operators.h"

namespace bodyloom {

/// Forms of DensePose's output, both of which are converted to one set of checked tensors.
enum class DensePoseForm { kTuple, kDict };

namespace {

/// Output for n people; floats in C order on the CPU.
struct DensePoseOutput {
  torch::Tensor boxes;       ///< n×4
  torch::Tensor scores;      ///< n; ones in the tuple form
  torch::Tensor coarse;      ///< n×C×h×w, C >= 2
  torch::Tensor fine, u, v;  ///< n×25×h×w
};

constexpr int64_t kFine = ChartPlanes::kFine;

torch::Tensor OnCpu(const torch::Tensor& tensor) { return tensor.to(torch::kCPU, torch::kFloat).contiguous(); }

torch::Tensor Entry(const c10::Dict<c10::IValue, c10::IValue>& dict, const std::string& key, const std::string& path) {
  const auto found = dict.find(key);
  if (found != dict.end()) return OnCpu(found->value().toTensor());
  std::string keys;
  for (const auto& entry : dict) keys += (keys.empty() ? "" : ", ") + entry.key().toStringRef();
  throw std::runtime_error(
      Concatenate(path, ": the network's answer has no ", key, "; it has ", keys.empty() ? "nothing" : keys));
}

/// `channels` 0: two or more.
void CheckPlanes(const torch::Tensor& planes, const char* name, const DensePoseOutput& output, int64_t channels,
                 const std::string& path) {
  const int64_t n = output.boxes.size(0);
  const bool fits = planes.dim() == 4 && planes.size(0) == n &&
                    (channels > 0 ? planes.size(1) == channels : planes.size(1) >= 2) && planes.size(2) > 0 &&
                    planes.size(3) > 0;
  const bool is_like_coarse = fits && planes.sizes().slice(2) == output.coarse.sizes().slice(2);
  if (!fits || !is_like_coarse) {
    throw std::runtime_error(Concatenate(path, ": the network's ", name, " has shape ", planes.sizes(), ", expected [",
                                         n, ", ", channels > 0 ? std::to_string(channels) : "2 or 15",
                                         ", h, w], all planes of one size"));
  }
}

/// Form of a `forward` by its declared return type: five tensors, or a dictionary of tensors by text; none otherwise.
std::optional<DensePoseForm> DensePoseFormOf(const c10::Type& returned) {
  if (const auto tuple = returned.cast<c10::TupleType>()) {
    const auto& elements = tuple->elements();
    for (const auto& element : elements) {
      if (element->kind() != c10::TypeKind::TensorType) return std::nullopt;
    }
    if (elements.size() == 5) return DensePoseForm::kTuple;
  }
  if (const auto dict = returned.cast<c10::DictType>()) {
    if (dict->getKeyType()->kind() == c10::TypeKind::StringType &&
        dict->getValueType()->kind() == c10::TypeKind::TensorType) {
      return DensePoseForm::kDict;
    }
  }
  return std::nullopt;
}

/// Checks and converts `value`, which must have the form's type. Throws std::runtime_error "path: …" for a number of
/// outputs, a key or a shape other than the above.
DensePoseOutput CheckedDensePoseOutput(const c10::IValue& value, DensePoseForm form, const std::string& path) {
  DensePoseOutput output;
  if (form == DensePoseForm::kTuple) {
    const std::vector<c10::IValue>& values = value.toTupleRef().elements().vec();
    output.boxes = OnCpu(values[0].toTensor());
    output.coarse = OnCpu(values[1].toTensor());
    output.fine = OnCpu(values[2].toTensor());
    output.u = OnCpu(values[3].toTensor());
    output.v = OnCpu(values[4].toTensor());
  } else {
    const auto dict = value.toGenericDict();
    output.boxes = Entry(dict, "pred_boxes", path);
    output.scores = Entry(dict, "scores", path);
    output.coarse = Entry(dict, "pred_densepose_coarse_segm", path);
    output.fine = Entry(dict, "pred_densepose_fine_segm", path);
    output.u = Entry(dict, "pred_densepose_u", path);
    output.v = Entry(dict, "pred_densepose_v", path);
  }
  if (output.boxes.dim() != 2 || output.boxes.size(1) != 4) {
    throw std::runtime_error(
        Concatenate(path, ": the network's boxes have shape ", output.boxes.sizes(), ", expected [n, 4]"));
  }
  const int64_t n = output.boxes.size(0);
  if (form == DensePoseForm::kTuple) output.scores = torch::ones({n});
  if (output.scores.dim() != 1 || output.scores.size(0) != n) {
    throw std::runtime_error(
        Concatenate(path, ": the network's scores have shape ", output.scores.sizes(), ", expected [", n, "]"));
  }
  if (n == 0) return output;  // without people the planes may have any shape
  CheckPlanes(output.coarse, "coarse segmentation", output, 0, path);
  CheckPlanes(output.fine, "fine segmentation", output, kFine, path);
  CheckPlanes(output.u, "u", output, kFine, path);
  CheckPlanes(output.v, "v", output, kFine, path);
  return output;
}

/// DensePose's mean colour, equivalent to the networks' own padding: 103.53, 116.28, 123.675.
constexpr Colour kMeanColour = {124, 116, 104};

/// Extracts the line with the cause from a message of LibTorch: after the heading, before the stack.
std::string OneLine(const std::exception& error) {
  const auto* from_torch = dynamic_cast<const c10::Error*>(&error);
  const std::string text = from_torch != nullptr ? from_torch->what_without_backtrace() : error.what();
  size_t begin = text.find_first_not_of(" \n");
  // "The following operation failed in the TorchScript interpreter": the reason is the last line.
  if (text.find("RuntimeError: ") != std::string::npos) begin = text.rfind("RuntimeError: ");
  if (begin == std::string::npos) return "no reason given";
  const std::string line = text.substr(begin, text.find('\n', begin) - begin);
  return line.substr(0, line.find_last_not_of(" .:") + 1);
}

torch::jit::Module Load(const std::string& path) {
  if (!std::ifstream(path, std::ios::binary).is_open()) {
    throw std::runtime_error(path + ": cannot be read, expected DensePose as a TorchScript file");
  }
  RegisterVisionOperators();
  try {
    return torch::jit::load(path, torch::kCPU);
  } catch (const std::exception& error) {
    throw std::runtime_error(path + ": cannot be loaded as TorchScript (" + OneLine(error) +
                             "); expected DensePose as torch.jit.save writes it");
  }
}

/// Converts half floats to floats and moves everything to the networks' device.
void Prepare(torch::jit::Module* module) {
  const auto convert = [](const torch::Tensor& tensor) {
    const bool is_half = tensor.scalar_type() == torch::kHalf || tensor.scalar_type() == torch::kBFloat16;
    tensor.set_data(OnDevice(is_half ? tensor.to(torch::kFloat) : tensor));
  };
  for (const torch::Tensor& parameter : module->parameters()) convert(parameter);
  for (const torch::Tensor& buffer : module->buffers()) convert(buffer);
  module->eval();
}

DensePoseForm FormOf(const torch::jit::Module& module, const std::string& path) {
  constexpr const char* kExpected =
      ", expected DensePose's: an image in; boxes, coarse and fine segmentation, u and v out, as five tensors or as a "
      "dictionary of tensors";
  const auto forward = module.find_method("forward");
  if (!forward) throw std::runtime_error(path + ": the program has no forward()" + kExpected);
  const c10::FunctionSchema& schema = forward->function().getSchema();
  const auto& arguments = schema.arguments();  // the first is the module itself
  bool takes_image = arguments.size() >= 2 && arguments[1].type()->kind() == c10::TypeKind::TensorType;
  for (size_t i = 2; i < arguments.size(); ++i) takes_image = takes_image && arguments[i].default_value();
  if (!takes_image) {
    throw std::runtime_error(
        Concatenate(path, ": forward() takes ", arguments.size() - 1, " arguments that are not one image", kExpected));
  }
  std::optional<DensePoseForm> form;
  if (schema.returns().size() == 1) form = DensePoseFormOf(*schema.returns()[0].type());
  if (!form) {
    const std::string returns = schema.returns().size() == 1 ? schema.returns()[0].type()->annotation_str() : "nothing";
    throw std::runtime_error(path + ": forward() returns " + returns + kExpected);
  }
  return *form;
}

Image PaddedToSquare(const Image& image) {
  const int side = std::max(image.width, image.height);
  Image square(side, side, kMeanColour);
  Paste(image, 0, 0, &square);
  return square;
}

bool IsInside(const ChartDetection& box, const Image& image) {
  const double x = (box.x0 + box.x1) / 2, y = (box.y0 + box.y1) / 2;
  return x >= 0 && y >= 0 && x <= image.width && y <= image.height;
}

}  // namespace

struct DensePoseNetwork::Impl {
  std::string path;
  mutable torch::jit::Module module;
  DensePoseForm form = DensePoseForm::kTuple;
  bool rgb = true;

  [[nodiscard]] torch::Tensor Input(const Image& image) const {
    const Image square = PaddedToSquare(image);
    torch::Tensor pixels =
        torch::from_blob(const_cast<uint8_t*>(square.bgr.data()), {square.height, square.width, 3}, torch::kByte);
    if (rgb) pixels = pixels.flip(2);
    pixels = form == DensePoseForm::kTuple ? pixels.permute({2, 0, 1}) : pixels.to(torch::kFloat);
    return OnDevice(pixels.contiguous().clone());
  }

  [[nodiscard]] c10::IValue Forward(const Image& image) const {
    try {
      return module.forward({Input(image)});
    } catch (const std::exception& error) {
      throw std::runtime_error(Concatenate(path, ": the network failed on an image of ", image.width, "x", image.height,
                                           " pixels (", OneLine(error), ")"));
    }
  }
};

DensePoseNetwork::DensePoseNetwork(const std::string& path, DensePoseColours colours)
    : impl_(std::make_unique<Impl>(Impl{path, Load(path)})) {
  impl_->form = FormOf(impl_->module, path);
  impl_->rgb =
      colours == DensePoseColours::kOfForm ? impl_->form == DensePoseForm::kTuple : colours == DensePoseColours::kRgb;
  Prepare(&impl_->module);
}
DensePoseNetwork::~DensePoseNetwork() = default;
DensePoseNetwork::DensePoseNetwork(DensePoseNetwork&&) noexcept = default;
DensePoseNetwork& DensePoseNetwork::operator=(DensePoseNetwork&&) noexcept = default;

std::vector<ChartDetection> DensePoseNetwork::Detect(const Image& image) const {
  BODYLOOM_CHECK(!image.empty(), "DensePose: an empty image");
  const torch::NoGradGuard no_grad;
  // Otherwise time of the first images is spent on specialising for their exact numbers of people.
  const torch::jit::GraphOptimizerEnabledGuard no_specialising(false);
  const DensePoseOutput output = CheckedDensePoseOutput(impl_->Forward(image), impl_->form, impl_->path);
  std::vector<ChartDetection> people;
  for (int64_t i = 0; i < output.boxes.size(0); ++i) {
    const float* box = output.boxes.data_ptr<float>() + 4 * i;
    ChartDetection person = {box[0], box[1], box[2], box[3], output.scores.data_ptr<float>()[i], {}};
    if (!IsInside(person, image)) continue;
    const auto planes_of = [i](const torch::Tensor& planes) { return planes[i].data_ptr<float>(); };
    const ChartPlanes planes = {int(output.coarse.size(1)), int(output.coarse.size(2)), int(output.coarse.size(3)),
                                planes_of(output.coarse),   planes_of(output.fine),     planes_of(output.u),
                                planes_of(output.v)};
    person.charts = PasteCharts(planes, person, image.width, image.height);
    const std::vector<uint8_t>& part = person.charts.part;
    if (std::any_of(part.begin(), part.end(), [](uint8_t p) { return p > 0; })) people.push_back(std::move(person));
  }
  return people;
}

}  // namespace bodyloom
