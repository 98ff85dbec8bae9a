// SPDX-License-Identifier: Apache-2.0
/// A trained pose-guided renderer at work: one photo in (or several), pictures in any pose out.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "neural/guided/coherent_maps.h"
#include "neural/guided/guided_config.h"
#include "neural/guided/guided_picture.h"
#include "neural/people/photo_frame.h"

namespace bodyloom {

struct GuidedRendererOptions {
  int reach = 0;         ///< pixels from the body beyond which is background; 0: none, the whole window is computed
  bool complete = true;  ///< the maps over virtual views; false: the source warped as it is (the paper's −A)
  int num_threads = 0;   ///< 0: all cores
  std::string device = "cpu";  ///< or "cuda"
};

class GuidedRenderer {
 public:
  /// Throws std::runtime_error naming the file when the checkpoint cannot be read or is of another configuration.
  GuidedRenderer(const std::string& checkpoint_path, const GuidedConfig& config,
                 const GuidedRendererOptions& options = {});
  ~GuidedRenderer();
  GuidedRenderer(const GuidedRenderer&) = delete;
  GuidedRenderer& operator=(const GuidedRenderer&) = delete;

  /// `photos`: one or more pictures of the person, the first one the source whose triplet the networks see; the others
  /// fill texels that earlier ones left empty. `virtual_views`: the six of complete_maps.h; may be empty when maps are
  /// not completed. `texel_parts`: of the atlas. Throws std::invalid_argument for frames of other sizes, without
  /// pictures or in which no body is seen.
  void SetSource(std::span<const PhotoFrame> photos, std::span<const uint8_t> texel_parts,
                 std::span<const PhotoFrame> virtual_views);

  /// The person in another pose; after SetSource.
  GuidedPicture Render(const PhotoFrame& frame);

  [[nodiscard]] const CoherentMaps& maps() const;
  /// The virtual views as the networks drew them; empty when maps were not completed.
  [[nodiscard]] const std::vector<GuidedPicture>& virtual_pictures() const;
  /// Frames that were those before: they were not computed again.
  [[nodiscard]] int64_t frames_kept() const;
  /// Share of the window's pixels that the networks computed, mean over frames.
  [[nodiscard]] double computed_share() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bodyloom
