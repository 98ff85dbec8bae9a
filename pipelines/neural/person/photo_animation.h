// SPDX-License-Identifier: Apache-2.0
/// Parts that the jobs which render a person from photos share: who is shown, in which motion, from where.
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

/// Somebody who lends a part of his or her appearance.
struct LentGarment {
  std::string from;                ///< IMAGE:TRACK[:FRAME] (ParsePhotoRequest); empty: nobody
  std::vector<std::string> parts;  ///< "top", "bottom", "shoes", "head", "arms" or a DensePose part, "1" to "24"
};

/// DensePose's parts of "top", "bottom", "shoes", "head", "arms" (below the elbow, with hands) or a number. Throws
/// RequestError for other names.
std::vector<int> PartsNamed(const std::vector<std::string>& names);

/// Adds to `notes` a line that says how much of what `garment` lends the lender's photo shows. Throws
/// std::runtime_error when it shows nothing of it.
void NoteLent(const LentGarment& garment, const Photo& lender, std::span<const uint8_t> texel_parts,
              std::string* notes);

/// The body is the photo's; `body` is not looked at.
struct PhotoAnimationRequest : AnimationRequest {
  PhotoRequest photo;              ///< what the person looks like
  std::vector<std::string> views;  ///< more pictures of the person, IMAGE:TRACK[:FRAME] (ParsePhotoRequest)
  LentGarment garment;             ///< both of its parts are given, or none
  PhotoBackground background;
  std::string iuv;  ///< what the motion's pixels show of the body: a folder of IUV images, one a frame; empty: what the
                    ///< tracked body says. Not with `view_yaw`
  std::string view_yaw;          ///< degrees that the view is turned by: "30", or "0:360" over the clip
  bool shape_of_motion = false;  ///< the body has the shape of the motion's track; false: the photo's
};

/// The photo, more views of the same person, the one who lends. Throws RequestError for texts that do not parse, for
/// names of parts that are none, and for a lender without parts or parts without a lender.
std::vector<PhotoRequest> PhotosWanted(const PhotoAnimationRequest& request);

/// Frames of the single-person dataset `data` that are among the photos: the dataset itself with a frame, or one of its
/// images. To compare a picture with the photo that it was made from says nothing of other poses.
std::set<int> FramesAmong(const std::vector<PhotoRequest>& photos, const std::string& data);

/// What the body of `photo` shows in the motion `track`, read from `path`, from the requested side, in windows of
/// size × size pixels with texture_size × texture_size texels. The track takes the photo's shape, unless the motion's
/// is requested; the maps refer to it. Throws RequestError for a view_yaw that does not parse, std::runtime_error
/// naming `path` for a motion of another body and one that shows nobody.
std::unique_ptr<PhotoMaps> MapsOfMotion(const PhotoAnimationRequest& request, const Photo& photo,
                                        const std::string& path, int size, int texture_size, Track* track);

// The background of a person rendered from a photo, frame by frame.

class PhotoBackdrop {
 public:
  /// Pictures of this size. Throws std::runtime_error naming the background that cannot be read.
  PhotoBackdrop(const PhotoBackground& background, const Photo& photo, PictureSize size);
  /// The next frame.
  const Image& Next() { return background_ ? background_->Next() : filled_; }

 private:
  std::optional<Background> background_;
  Image filled_;  ///< without `background_`: the photo's own, filled in where the person stood
};

}  // namespace bodyloom
