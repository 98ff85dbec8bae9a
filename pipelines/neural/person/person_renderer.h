// SPDX-License-Identifier: Apache-2.0
/// Common interface of the trained renderers of people from photos, opened from a run's folder, for animation and
/// scores.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geometry/body/body_model.h"
#include "neural/base/rendered_person.h"
#include "neural/guided/coherent_maps.h"
#include "neural/guided/guided_config.h"
#include "neural/metrics/person_scores.h"
#include "render/image/image.h"
#include "render/texture/complete/texel_neighbours.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

enum class PersonRendererKind {
  kPhoto,  ///< the one-photo renderer (neural/photo)
  kGuided  ///< the pose-guided renderer (neural/guided)
};

struct PersonRendererRequest {
  PersonRendererKind kind = PersonRendererKind::kPhoto;
  std::string run;  ///< folder of the trained run
  bool whole_window =
      false;  ///< the whole window is computed: people may be farther from the body than clothes ever were
  /// Completion of what the photos do not show, for the pose-guided renderer only; absent: as in the run.
  std::optional<MapCompletion> completion;
  int threads = 0;             ///< 0: all cores
  std::string device = "cpu";  ///< device of the networks: "cpu" or "cuda"
};

/// Photos and body of a person, in windows and textures of the renderer's sizes.
struct SourcePerson {
  std::span<const PhotoFrame> photos;  ///< the source first, the lender's photo last if there is one
  std::span<const int> lent_parts;     ///< DensePose parts whose appearance the last photo gives; empty: none
  std::span<const uint8_t> texel_parts;
  const TexelNeighbours* neighbours = nullptr;
  const BodyModel* body = nullptr;
  Eigen::VectorXd betas;  ///< the person's shape
};

class PersonRenderer {
 public:
  PersonRenderer() = default;
  PersonRenderer(const PersonRenderer&) = delete;
  PersonRenderer& operator=(const PersonRenderer&) = delete;
  virtual ~PersonRenderer() = default;

  /// Side lengths of windows and textures.
  [[nodiscard]] virtual int size() const = 0;
  [[nodiscard]] virtual int texture_size() const = 0;
  /// Sets the person to render. Returns the share of the atlas that the photos cover. Throws std::invalid_argument for
  /// photos that show nothing of the body.
  virtual double SetPerson(const SourcePerson& person) = 0;
  virtual RenderedPerson Render(const PhotoFrame& pose) = 0;

  /// Coherent maps of the surface; nullptr if the renderer has none.
  [[nodiscard]] virtual const CoherentMaps* maps() const { return nullptr; }
  /// Image of the completed texture or of the coherent maps.
  [[nodiscard]] virtual Image SurfaceImage() const = 0;
  /// First pictures of a contact sheet, and the number of pictures per row.
  [[nodiscard]] virtual std::vector<Image> SheetBegin(const PhotoFrame& photo) const = 0;
  [[nodiscard]] virtual int sheet_columns() const = 0;
  /// Pictures of a frame for the contact sheet; `frame` has an image if the truth is known. `composed`: the video's
  /// image.
  [[nodiscard]] virtual std::vector<Image> SheetRow(const PhotoFrame& photo, const PhotoFrame& frame,
                                                    const RenderedPerson& rendered, const Image& composed) const = 0;
  /// Names of an animation's stages in its report: reading, processing the photos, rendering all frames.
  struct Stages {
    const char *read, *source, *frames;
  };
  [[nodiscard]] virtual Stages stages() const = 0;
  /// Report entries specific to this renderer.
  [[nodiscard]] virtual nlohmann::ordered_json Report() const = 0;
  /// Number of frames equal to the previous one, which were not recomputed.
  [[nodiscard]] virtual int64_t frames_kept() const { return 0; }
  /// Share of the window's pixels computed by the networks, mean over frames; absent: unknown.
  [[nodiscard]] virtual std::optional<double> computed_share() const { return std::nullopt; }
};

/// Opens a run's renderer. Throws std::runtime_error naming the file of the run that cannot be used.
std::unique_ptr<PersonRenderer> OpenPersonRenderer(const PersonRendererRequest& request);

/// Mask of U × U texels: 1 where the texel belongs to one of the parts.
std::vector<uint8_t> TexelsOf(std::span<const int> parts, std::span<const uint8_t> texel_parts);

/// JSON of the scores of people rendered from photos.
/// One object, without SSIM; feature-based scores are named after the network that computed them.
nlohmann::ordered_json ToJson(const PersonScores& scores);

}  // namespace bodyloom
