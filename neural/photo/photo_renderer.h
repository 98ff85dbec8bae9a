// SPDX-License-Identifier: Apache-2.0
/// Inference with a trained one-photo renderer: from a texture to images of its person in any pose.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "neural/base/rendered_person.h"
#include "neural/photo/photo_config.h"
#include "render/texture/complete/partial_texture.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

struct PhotoRendererOptions {
  int reach = -1;              ///< pixels farther from the body are background; negative: the whole frame is computed
  int num_threads = 0;         ///< 0: all cores
  std::string device = "cpu";  ///< or "cuda"
};

class PhotoRenderer {
 public:
  /// Throws std::runtime_error naming the file when the checkpoint cannot be read or is of another configuration.
  PhotoRenderer(const std::string& checkpoint_path, const PhotoConfig& config,
                const PhotoRendererOptions& options = {});
  ~PhotoRenderer();
  PhotoRenderer(const PhotoRenderer&) = delete;
  PhotoRenderer& operator=(const PhotoRenderer&) = delete;

  /// Sets the person. Throws std::invalid_argument for a texture of another size, and unless unseen texels are guessed
  /// exactly if PhotoProfile::guesses_unseen is set.
  void Encode(const PartialTexture& texture);

  /// Renders the person in the pose of a frame (its image, labels and texels are ignored). Throws std::invalid_argument
  /// before Encode and when the frame's size is not the configuration's.
  [[nodiscard]] RenderedPerson Render(const PhotoFrame& pose) const;

  /// The completed texture as colours: the first three features, planar 3 × U × U in [0, 1], everywhere in the atlas.
  /// Variants without FeatureNet return the partial texture's, unseen texels grey. Throws std::invalid_argument before
  /// Encode.
  [[nodiscard]] std::vector<float> CompletedTexture() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bodyloom
