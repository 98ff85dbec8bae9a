// SPDX-License-Identifier: Apache-2.0
/// Inference with a trained pose-guided renderer: from one or several photos to images in any pose.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "neural/guided/coherent_maps.h"
#include "neural/guided/guided_config.h"
#include "neural/guided/source_maps.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

struct GuidedRendererOptions {
  int reach = 0;  ///< pixels farther from the body are background; 0: no limit, the whole window is computed
  std::optional<MapCompletion> completion;  ///< default: the configuration's
  int num_threads = 0;                      ///< 0: all cores
  std::string device = "cpu";               ///< or "cuda"
};

class GuidedRenderer {
 public:
  /// Throws std::runtime_error naming the file when the checkpoint cannot be read or is of another configuration.
  GuidedRenderer(const std::string& checkpoint_path, const GuidedConfig& config,
                 const GuidedRendererOptions& options = {});
  ~GuidedRenderer();
  GuidedRenderer(const GuidedRenderer&) = delete;
  GuidedRenderer& operator=(const GuidedRenderer&) = delete;

  /// Sets the source. `photos`: one or more images of the person; the triplet of the first is the networks' source, the
  /// others fill texels that earlier ones left empty or see less frontally. Throws std::invalid_argument as
  /// MapsOfSource (source_maps.h), for frames of other sizes or without images, and for photos that show nothing of the
  /// body.
  void SetSource(std::span<const PhotoFrame> photos, const SourceBody& body);

  /// Renders the person in another pose; call SetSource first.
  RenderedPerson Render(const PhotoFrame& frame);

  [[nodiscard]] const CoherentMaps& maps() const;
  /// The way in which the maps are completed.
  [[nodiscard]] MapCompletion completion() const;
  /// The virtual views rendered by the networks; empty if none were.
  [[nodiscard]] const std::vector<RenderedPerson>& virtual_images() const;
  /// Number of frames identical to the previous one, which were not computed again.
  [[nodiscard]] int64_t frames_kept() const;
  /// Share of the window's pixels that the networks computed, mean over frames.
  [[nodiscard]] double computed_share() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bodyloom
