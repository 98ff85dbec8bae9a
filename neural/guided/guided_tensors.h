// SPDX-License-Identifier: Apache-2.0
/// Frames of the pose-guided renderer as tensors, and back. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <span>
#include <vector>

#include "neural/guided/coherent_maps.h"
#include "neural/guided/guided_model.h"
#include "neural/guided/guided_networks.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

/// Of frames of one size. Silhouette, classes and image are undefined when one of the frames has no picture. Throws
/// std::invalid_argument for arrays of other sizes than they should have and for labels above 6.
GuidedTensors TensorsOf(std::span<const PhotoFrame> frames);

/// Pseudo inputs: those of pictures of one size; or of the truth where `known` (B arrays of S × S) says so.
GuidedPseudo PseudoOf(std::span<const PseudoPicture> pictures);
GuidedPseudo PseudoOf(const GuidedTensors& truth, std::span<const std::vector<uint8_t>> known);

/// The cells (of `multiple` pixels) of the window where the person may be: around what the frame shows of the body,
/// grown by `reach` pixels, and of its labels; at least 32 pixels and two cells a side (or the whole window). Width 0
/// where there is neither.
CodeBox PersonBox(const PhotoFrame& frame, int multiple, int reach);
/// The same of each frame, all of one size: instance norms see what they will see at work, one person and little else.
/// Around nobody the window's middle.
std::vector<CodeBox> PersonBoxes(std::span<const PhotoFrame> frames, int multiple, int reach);

/// The box's pixels of a map of the window; undefined maps stay undefined.
torch::Tensor CroppedPixels(const torch::Tensor& map, const CodeBox& box, int multiple);
GuidedTensors CroppedPixels(const GuidedTensors& tensors, const CodeBox& box, int multiple);
GuidedPseudo CroppedPixels(const GuidedPseudo& pseudo, const CodeBox& box, int multiple);

/// Each of B pictures its own box, all of one size.
GuidedTensors CroppedEach(const GuidedTensors& tensors, std::span<const CodeBox> boxes, int multiple);
GuidedPseudo CroppedEach(const GuidedPseudo& pseudo, std::span<const CodeBox> boxes, int multiple);
/// The source's codes where the boxes are.
GuidedSource CroppedEach(const GuidedSource& source, std::span<const CodeBox> boxes);

/// The picture of frame b, laid into a window of `size` pixels. Labels are those of `result` where alpha is at least ½
/// (1 where GarNet predicts background or there is none), of `pseudo` where there is no GarNet and it knows them.
PersonPicture PictureOf(const GuidedResult& result, const GuidedPseudo& pseudo, int64_t b, const CodeBox& box,
                        int multiple, int size);

}  // namespace bodyloom
