// SPDX-License-Identifier: Apache-2.0
/// What fitted photos show of a person, as a clothed body and its whole texture.
///
/// Clothes and hair stand off as the mask says, and a skirt, dress or coat hangs as it says
/// (render/person/fit_clothes.h); the texels of the clothed body look
/// their colours up in the picture, from which the light was taken (pipelines/person/photo_light.h). Photos are merged texel by texel, the one that sees it best; the first gives shape
/// and clothes. What no photo shows is guessed (render/person/whole_texture.h).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bodyloom/geometry/observations.h"
#include "bodyloom/pipelines/person/photo_person.h"
#include "bodyloom/pipelines/person/texel_labels.h"
#include "bodyloom/render/person/fit_clothes.h"
#include "bodyloom/render/texture_extract.h"

namespace bodyloom {

/// A photo, and where the person is in it.
struct FittedPhoto {
  std::string name;  ///< of messages and the report
  Image picture;
  Track track;      ///< of one frame with a result, of the bare body
  LabelImage mask;  ///< of the picture's size; 0 where the person is not
  /// PersonLabel, one a pixel of the picture: dark clothes are not shade. Empty: nobody knows, and the light is taken as even.
  std::vector<uint8_t> labels;
  int people = 1;  ///< found in it
};

/// The photo's mask, one a pixel of the picture.
std::vector<uint8_t> MaskInPicture(const FittedPhoto& photo);

class PhotoPersonBuilder {
 public:
  /// `bare` has UV coordinates. `clock`, where there is one, times the stages "clothes", "texture" and "complete"; it must
  /// outlive this.
  PhotoPersonBuilder(std::shared_ptr<const BodyModel> bare, int texture_size, StageClock* clock = nullptr,
                     const FitClothesOptions& clothes = {});

  /// Throws NothingToTrack naming a photo that shows too little of the person, std::invalid_argument when sizes do not
  /// fit; others may be added after it.
  void Add(const FittedPhoto& photo);
  /// The person, of at least one photo; this is spent.
  PhotoPerson Finish();

 private:
  void Begin(const char* stage);
  ClothesOffsets Dress(const FittedPhoto& photo);
  [[nodiscard]] std::vector<uint8_t> UsablePixels(const FittedPhoto& photo, const MatrixX3d& vertices_in_camera) const;
  Image InEvenLight(const FittedPhoto& photo, const MatrixX3d& vertices_in_camera);

  int texture_size_;
  StageClock* clock_;
  FitClothesOptions clothes_;
  PhotoPerson person_;
  double swing_rad_ = 0;  ///< of the garment in the first photo
  std::optional<TextureExtractor> extractor_;
  std::vector<PhotoLabels> labels_;  ///< of each photo; without those of all of them nothing is said of texels
};

}  // namespace bodyloom
