// SPDX-License-Identifier: Apache-2.0
/// TorchScript files with DensePose's interface and a known result: the person is the rectangle of pure red pixels,
/// with the planes given by the test.
#pragma once

#include <torch/script.h>

#include <string>

#include "render/image/image.h"

namespace bodyloom {

/// 1×C×h×w each.
struct ScriptedPlanes {
  torch::Tensor coarse, fine, u, v;
};

/// Logits with certain `part` (h×w, 0: background), with u and v (h×w) in the planes of that part and `nowhere` in all
/// others.
inline ScriptedPlanes PlanesOf(const torch::Tensor& part, const torch::Tensor& u, const torch::Tensor& v,
                               float nowhere = 0.5F) {
  const auto spread = [&](const torch::Tensor& values, float otherwise) {
    torch::Tensor planes = torch::full({25, part.size(0), part.size(1)}, otherwise);
    return planes.scatter_(0, part.unsqueeze(0), values.unsqueeze(0)).unsqueeze(0);
  };
  const torch::Tensor person = (part > 0).to(torch::kFloat);
  return {torch::stack({1 - person, person}).unsqueeze(0), spread(torch::ones_like(u), 0), spread(u, nowhere),
          spread(v, nowhere)};
}

constexpr const char* kScriptedFind = R"(
def find(self, red: Tensor, blue: Tensor) -> Tensor:
    where = ((red > 200) & (blue < 60)).nonzero()
    if where.size(0) == 0:
        return torch.zeros([0, 4])
    y = where[:, 0]
    x = where[:, 1]
    return torch.stack([x.min(), y.min(), x.max() + 1, y.max() + 1]).float().unsqueeze(0)
)";

/// Interface of comfyui_controlnet_aux: bytes, 3×H×W, RGB.
constexpr const char* kScriptedTuple = R"(
def forward(self, image: Tensor):
    assert image.size(0) == 3 and image.size(1) == image.size(2) and not image.is_floating_point()
    boxes = self.find(image[0], image[2])
    n = boxes.size(0)
    return boxes, self.coarse[:n], self.fine[:n], self.u[:n], self.v[:n]
)";

/// Interface of dajes/DensePose-TorchScript: H×W×3, BGR.
constexpr const char* kScriptedDict = R"(
def forward(self, image: Tensor, bgr: bool = True):
    assert image.size(2) == 3 and image.size(0) == image.size(1) and image.is_floating_point() and bgr
    boxes = self.find(image[:, :, 2], image[:, :, 0])
    n = boxes.size(0)
    return {"pred_boxes": boxes, "scores": 0.75 * torch.ones([n]), "pred_classes": torch.zeros([n]),
            "pred_densepose_coarse_segm": self.coarse[:n], "pred_densepose_fine_segm": self.fine[:n],
            "pred_densepose_u": self.u[:n], "pred_densepose_v": self.v[:n]}
)";

inline torch::jit::Module ScriptedDensePose(const ScriptedPlanes& planes, const char* forward) {
  torch::jit::Module module("DensePose");
  module.register_buffer("coarse", planes.coarse);
  module.register_buffer("fine", planes.fine);
  module.register_buffer("u", planes.u);
  module.register_buffer("v", planes.v);
  module.define(kScriptedFind);
  module.define(forward);
  return module;
}

/// Grey, with a red rectangle [x, x+w) × [y, y+h).
inline Image RedRectangle(int width, int height, int x, int y, int w, int h) {
  Image image(width, height, {90, 90, 90});
  Paste(Image(w, h, {255, 0, 0}), x, y, &image);
  return image;
}

}  // namespace bodyloom
