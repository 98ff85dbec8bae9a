// SPDX-License-Identifier: Apache-2.0
/// Shared parts of the jobs that render a person from photos: appearance, motion and view.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "data_tools/descriptors/photo_maps.h"
#include "geometry/scene/track.h"
#include "pipelines/animate/background.h"
#include "pipelines/neural/animation.h"
#include "pipelines/neural/photo/photo_input.h"

namespace bodyloom {

/// Another person who provides a part of the appearance.
struct LentGarment {
  std::string from;                ///< IMAGE:TRACK[:FRAME] (ParsePhotoRequest); empty: nobody
  std::vector<std::string> parts;  ///< "top", "bottom", "shoes", "head", "arms" or a DensePose part, "1" to "24"
};

/// DensePose parts of "top", "bottom", "shoes", "head", "arms" (below the elbow, with hands) or a number. Throws
/// RequestError for other names.
std::vector<int> PartsNamed(const std::vector<std::string>& names);

/// Adds a line to `notes` with the share of the lent parts that the lender's photo shows. Throws std::runtime_error
/// when it shows none of them.
void NoteLent(const LentGarment& garment, const Photo& lender, std::span<const uint8_t> texel_parts,
              std::string* notes);

/// Request to animate the person of a photo. The body is the photo's; `body` is ignored.
struct PhotoAnimationRequest : AnimationRequest {
  PhotoRequest photo;              ///< the person's appearance
  std::vector<std::string> views;  ///< more images of the person, IMAGE:TRACK[:FRAME] (ParsePhotoRequest)
  LentGarment garment;             ///< both of its fields are given, or neither
  PhotoBackground background;
  std::string iuv;  ///< what the motion's pixels show of the body: a folder of IUV images, one a frame; empty: what the
                    ///< tracked body says. Not with `view_yaw`
  std::string view_yaw;          ///< rotation of the view, degrees: "30", or "0:360" over the clip
  bool shape_of_motion = false;  ///< use the body shape of the motion's track; false: the photo's
};

/// The photo, more views of the same person, and the lender's photo. Throws RequestError for malformed texts, unknown
/// part names, and a lender without parts or parts without a lender.
std::vector<PhotoRequest> PhotosWanted(const PhotoAnimationRequest& request);

/// Frames of the single-person dataset `data` that are used as photos: the dataset itself with a frame, or one of its
/// images. They are excluded from scores.
std::set<int> FramesAmong(const std::vector<PhotoRequest>& photos, const std::string& data);

/// Maps of the body of `photo` in the motion `track`, read from `path`, from the requested view, in windows of size ×
/// size pixels with texture_size × texture_size texels. The track gets the photo's shape unless the motion's is
/// requested; the maps refer to the track. Throws RequestError for a malformed view_yaw, std::runtime_error naming
/// `path` for a motion of another body or one that shows nobody.
std::unique_ptr<PhotoMaps> MapsOfMotion(const PhotoAnimationRequest& request, const Photo& photo,
                                        const std::string& path, int size, int texture_size, Track* track);

class PhotoBackdrop {
 public:
  /// Backgrounds of this size. Throws std::runtime_error naming the background that cannot be read.
  PhotoBackdrop(const PhotoBackground& background, const Photo& photo, ImageSize size);
  /// The next frame.
  const Image& Next() { return background_ ? background_->Next() : filled_; }

 private:
  std::optional<Background> background_;
  Image filled_;  ///< without `background_`: the photo's own, inpainted behind the person
};

}  // namespace bodyloom
