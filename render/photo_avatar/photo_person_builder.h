// SPDX-License-Identifier: Apache-2.0
/// Builds a person, a clothed body and its complete texture, from fitted photos.
///
/// Offsets of clothes and hair and a skirt, dress or coat are fitted to the mask (render/garment/fit_clothes.h). Texels
/// of the clothed body sample the image after its light was removed (LightOfPhoto). Photos are merged by taking each
/// texel from the one that sees it best; the first gives shape and clothes. Unseen texels are guessed
/// (render/texture/complete/whole_texture.h).
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

/// A photo with the person's fit and mask.
struct FittedPhoto {
  std::string name;  ///< for messages and the report
  Image image;
  Track track;      ///< of one frame with a result, of the bare body
  LabelImage mask;  ///< of the image's size; 0 where the person is not
  /// PersonLabel, one per pixel of the image, to tell dark clothes from shade. Empty: not known, and the light is taken
  /// as even.
  std::vector<uint8_t> labels;
  int people = 1;  ///< detected in it
};

/// The photo's mask, one value per pixel of the image.
std::vector<uint8_t> PhotoMask(const FittedPhoto& photo);

class PhotoPersonBuilder {
 public:
  /// `bare` has UV coordinates. `clock` (may be null) times the stages "clothes", "texture" and "complete"; it must
  /// outlive this.
  PhotoPersonBuilder(std::shared_ptr<const BodyModel> bare, int texture_size, StageClock* clock = nullptr,
                     const FitClothesOptions& clothes = {});

  /// Throws NoPersonFound naming a photo that shows too little of the person, std::invalid_argument when sizes do not
  /// fit; after either, further photos may be added.
  void Add(const FittedPhoto& photo);
  /// Returns the person; needs at least one photo. The builder cannot be used afterwards.
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
  std::vector<PhotoLabels> labels_;  ///< of each photo; texels get labels only when all photos have them
};

// Excludes pixels in which an arm occludes the trunk or the thighs although the fitted arm lies beside them.

/// `mask` (one per pixel, 0 off the person) without the pixels in which the body shows trunk or thighs, an arm or a
/// hand of the body is within `reach_px`, and the photo shows skin: its label is skin or face (`labels`, PersonLabel),
/// or its colour is nearer to the face's median colour than to that of the trunk, or of the thighs, away from the arms.
/// `parts`: DensePose's, of the body in the image. Throws std::invalid_argument when sizes do not fit.
std::vector<uint8_t> WithoutLimbLeaks(const Image& image, std::span<const uint8_t> mask,
                                      std::span<const uint8_t> labels, std::span<const uint8_t> parts, int reach_px);

// Estimates the light on a person from the photo itself (render/lighting/fit_lighting.h).

/// One view shows half of all normals, on which 1, z and z² are nearly collinear: the prior is even light.
inline constexpr double kPhotoRidge = 0.1;
struct PhotoLight {
  /// Camera frame, one for all colours; mean shading 1 over the person's pixels. Even light if the fit failed.
  ShVector coefficients = EvenLight();
  FitLightingSummary fit;  ///< IsUsable(): the fit succeeded
};

/// The light on the person in `image`; `surface` holds the normals of the dressed body (LitSurface::Look). `labels`:
/// PersonLabel, one per pixel, 0 off the person; each label has its own albedo. Throws std::invalid_argument when sizes
/// differ.
PhotoLight LightOfPhoto(const Image& image, std::span<const uint8_t> labels, const LitSurface& surface);

}  // namespace bodyloom
