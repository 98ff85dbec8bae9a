// SPDX-License-Identifier: Apache-2.0
/// A trained pose-guided renderer at work: one photo in (or several), pictures in any pose out.
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
  int reach = 0;  ///< pixels from the body beyond which is background; 0: none, the whole window is computed
  std::optional<MapCompletion> completion;  ///< absent: the configuration's
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

  /// `photos`: one or more pictures of the person, the first one the source whose triplet the networks see; the others
  /// fill texels that earlier ones left empty or see less from the front. Throws std::invalid_argument as MapsOfSource
  /// (source_maps.h), for frames of other sizes or without pictures, and for photos that show nothing of the body.
  void SetSource(std::span<const PhotoFrame> photos, const SourceBody& body);

  /// The person in another pose; after SetSource.
  PersonPicture Render(const PhotoFrame& frame);

  [[nodiscard]] const CoherentMaps& maps() const;
  /// Which way the maps are completed.
  [[nodiscard]] MapCompletion completion() const;
  /// The virtual views as the networks drew them; empty where none were.
  [[nodiscard]] const std::vector<PersonPicture>& virtual_pictures() const;
  /// Frames that were those before: they were not computed again.
  [[nodiscard]] int64_t frames_kept() const;
  /// Share of the window's pixels that the networks computed, mean over frames.
  [[nodiscard]] double computed_share() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bodyloom
