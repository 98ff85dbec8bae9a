// SPDX-License-Identifier: Apache-2.0
/// A trained renderer of people from photos, opened from the folder of its run: the same face whichever it is, for
/// animation and scores.
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
#include "neural/base/person_picture.h"
#include "neural/guided/coherent_maps.h"
#include "neural/guided/guided_config.h"
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
  std::string run;        ///< folder of the trained run
  bool anywhere = false;  ///< the whole window is computed: people may be farther from the body than clothes ever were
  /// Of what the photos do not show; absent: as the run says. Of the pose-guided renderer alone.
  std::optional<MapCompletion> completion;
  int threads = 0;             ///< 0: all cores
  std::string device = "cpu";  ///< where the networks run: "cpu" or "cuda"
};

/// What is known of a person, in windows and textures of the renderer's sizes.
struct SourcePerson {
  std::span<const PhotoFrame> photos;  ///< the source first; where somebody lends, the last is that person's
  std::span<const int> lent_parts;     ///< DensePose's parts of which the last photo says what is worn; empty: none
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

  /// Sides of windows and textures.
  [[nodiscard]] virtual int size() const = 0;
  [[nodiscard]] virtual int texture_size() const = 0;
  /// From now on this is the person. Returns the share of the atlas that the photos fill. Throws std::invalid_argument
  /// for photos that show nothing of the body.
  virtual double SetPerson(const SourcePerson& person) = 0;
  virtual PersonPicture Render(const PhotoFrame& pose) = 0;

  /// What the renderer knows of the surface, where it keeps that as maps; nullptr: it does not.
  [[nodiscard]] virtual const CoherentMaps* maps() const { return nullptr; }
  /// A picture of what became of the photos: the completed texture, or the coherent maps.
  [[nodiscard]] virtual Image SurfacePicture() const = 0;
  /// Pictures that a contact sheet begins with, and how many stand in a row.
  [[nodiscard]] virtual std::vector<Image> SheetBegin(const PhotoFrame& photo) const = 0;
  [[nodiscard]] virtual int sheet_columns() const = 0;
  /// Pictures of a frame; `frame` has a picture where the truth is known. `composed`: the video's.
  [[nodiscard]] virtual std::vector<Image> SheetRow(const PhotoFrame& photo, const PhotoFrame& frame,
                                                    const PersonPicture& picture, const Image& composed) const = 0;
  /// Names of the stages of an animation in its report: what is read, what becomes of the photos, all frames.
  struct Stages {
    const char *read, *source, *frames;
  };
  [[nodiscard]] virtual Stages stages() const = 0;
  /// What a report says of this renderer alone.
  [[nodiscard]] virtual nlohmann::ordered_json Report() const = 0;
  /// Frames that were those before and were not computed again.
  [[nodiscard]] virtual int64_t frames_kept() const { return 0; }
  /// Share of the window's pixels that the networks computed, mean over frames; absent: not known.
  [[nodiscard]] virtual std::optional<double> computed_share() const { return std::nullopt; }
};

/// Throws std::runtime_error naming the file of the run that cannot be used.
std::unique_ptr<PersonRenderer> OpenPersonRenderer(const PersonRendererRequest& request);

/// U × U: 1 where the texel is of one of the parts.
std::vector<uint8_t> TexelsOf(std::span<const int> parts, std::span<const uint8_t> texel_parts);

}  // namespace bodyloom
