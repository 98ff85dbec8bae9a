// SPDX-License-Identifier: Apache-2.0
/// Converts frames of the pose-guided renderer to tensors, and results back. Internal: includes LibTorch.
#pragma once

#include <torch/torch.h>

#include <span>
#include <vector>

#include "neural/guided/coherent_maps.h"
#include "neural/guided/guided_model.h"
#include "neural/guided/guided_networks.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

/// Converts frames of one size. Silhouette, classes and image are undefined when one of the frames has no image. Throws
/// std::invalid_argument for arrays of unexpected sizes and for labels above 6.
GuidedTensors TensorsOf(std::span<const PhotoFrame> frames);

/// Pseudo inputs from images of one size, or from the truth at the pixels where `known` (B arrays of S × S) is set.
GuidedPseudo PseudoOf(std::span<const PseudoImage> images);
GuidedPseudo PseudoOf(const GuidedTensors& truth, std::span<const std::vector<uint8_t>> known);

/// The cells (of `multiple` pixels) of the window where the person may be: the box of the frame's body, grown by
/// `reach` pixels, and of its labels; at least 32 pixels and two cells a side (or the whole window). Width 0 if there
/// is neither.
CodeBox PersonBox(const PhotoFrame& frame, int multiple, int reach);
/// The same for each frame, all of one size: instance norms see one person and little else, as in inference. Frames
/// without a person get the window's centre.
std::vector<CodeBox> PersonBoxes(std::span<const PhotoFrame> frames, int multiple, int reach);

/// Crops a map of the window to the box's pixels; undefined maps stay undefined.
torch::Tensor CroppedPixels(const torch::Tensor& map, const CodeBox& box, int multiple);
GuidedTensors CroppedPixels(const GuidedTensors& tensors, const CodeBox& box, int multiple);
GuidedPseudo CroppedPixels(const GuidedPseudo& pseudo, const CodeBox& box, int multiple);

/// Crops each of B images to its own box, all of one size.
GuidedTensors CroppedEach(const GuidedTensors& tensors, std::span<const CodeBox> boxes, int multiple);
GuidedPseudo CroppedEach(const GuidedPseudo& pseudo, std::span<const CodeBox> boxes, int multiple);
/// Crops the source's codes to the boxes.
GuidedSource CroppedEach(const GuidedSource& source, std::span<const CodeBox> boxes);

/// Pastes the image of frame b into a window of `size` pixels. Labels are those of `result` where alpha is at least ½;
/// without GarNet those of `pseudo` if known, else 1.
RenderedPerson RenderedPersonOf(const GuidedResult& result, const GuidedPseudo& pseudo, int64_t b, const CodeBox& box,
                                int multiple, int size);

/// Renders one pose through the three networks.
/// The networks see the box of cells around the body grown by `reach` pixels; pixels farther from the body are
/// background. reach 0: the whole window. The image is empty if the frame shows no body. `share` (may be null):
/// computed share of the window.
RenderedPerson DrawGuided(GuidedModel* model, const GuidedSource& source, const PhotoFrame& frame,
                          const PseudoImage& pseudo, int reach, double* share);

}  // namespace bodyloom
