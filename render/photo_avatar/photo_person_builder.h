// SPDX-License-Identifier: Apache-2.0
/// What fitted photos show of a person, as a clothed body and its whole texture.
///
/// Clothes and hair stand off as the mask says, and a skirt, dress or coat hangs as it says
/// (render/garment/fit_clothes.h); the texels of the clothed body look
/// their colours up in the picture, from which the light was taken (render/photo_avatar/photo_person_builder.h). Photos
/// are merged texel by texel, the one that sees it best; the first gives shape and clothes. What no photo shows is
/// guessed (render/texture/complete/whole_texture.h).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "geometry/scene/observations.h"
#include "render/garment/fit_clothes.h"
#include "render/image/image.h"
#include "render/lighting/fit_lighting.h"
#include "render/lighting/lit_surface.h"
#include "render/lighting/sh_lighting.h"
#include "render/photo_avatar/photo_person.h"
#include "render/photo_avatar/texel_labels.h"
#include "render/texture/texture_extract.h"

namespace bodyloom {

/// A photo, and where the person is in it.
struct FittedPhoto {
  std::string name;  ///< of messages and the report
  Image picture;
  Track track;      ///< of one frame with a result, of the bare body
  LabelImage mask;  ///< of the picture's size; 0 where the person is not
  /// PersonLabel, one a pixel of the picture: dark clothes are not shade. Empty: nobody knows, and the light is taken
  /// as even.
  std::vector<uint8_t> labels;
  int people = 1;  ///< found in it
};

/// The photo's mask, one a pixel of the picture.
std::vector<uint8_t> MaskInPicture(const FittedPhoto& photo);

class PhotoPersonBuilder {
 public:
  /// `bare` has UV coordinates. `clock`, where there is one, times the stages "clothes", "texture" and "complete"; it
  /// must outlive this.
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

// Pixels in which an arm lies before the trunk or the thighs, though the fitted body has it a little beside them.

/// `mask` (one a pixel, 0 where the person is not) without the pixels in which the body shows trunk or thighs, an arm
/// or a hand of the body is within `reach_px`, and the photo shows skin: its label is skin or face (`labels`,
/// PersonLabel), or its colour is nearer to the face's median colour than to that of the trunk, or of the thighs, away
/// from the arms. `parts`: DensePose's, of the body in the picture. Throws std::invalid_argument when sizes do not fit.
std::vector<uint8_t> WithoutLimbLeaks(const Image& picture, std::span<const uint8_t> mask,
                                      std::span<const uint8_t> labels, std::span<const uint8_t> parts, int reach_px);

// The light in a photo of a person, from the photo itself (render/lighting/fit_lighting.h).

/// One view shows half of all normals, among which 1, z and z² are much alike: what they leave open is even light.
inline constexpr double kPhotoRidge = 0.1;
struct PhotoLight {
  /// Camera frame, one for all colours; its shading has the mean 1 over the person's pixels. Even light where it was
  /// not found.
  ShVector coefficients = EvenLight();
  FitLightingSummary fit;  ///< IsUsable(): it was found
};

/// The light on the person of `picture`, whose dressed body `surface` looks at. `labels`: PersonLabel, one a pixel of
/// the picture, each of which has an albedo of its own; the person is where they are not 0. Throws
/// std::invalid_argument when sizes differ.
PhotoLight LightOfPhoto(const Image& picture, std::span<const uint8_t> labels, const LitSurface& surface);

}  // namespace bodyloom
