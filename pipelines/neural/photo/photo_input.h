// SPDX-License-Identifier: Apache-2.0
/// Loads the input of the one-photo renderers from a user's files: images of a person, and the poses to render.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "data_tools/descriptors/photo_maps.h"
#include "geometry/body/body_model.h"
#include "geometry/scene/track.h"
#include "render/image/image.h"
#include "render/texture/photo_frame.h"

namespace bodyloom {

/// Image and labels of a window.
struct CutPhoto {
  Image image;
  std::vector<uint8_t> labels;
};

/// Sets uv, parts and texels of a frame; image and labels are left empty.
void FillMaps(PhotoMap&& map, int size, int texture_size, PhotoFrame* frame);
/// Sets image (0 on the background) and labels.
void FillImage(const CutPhoto& cut, PhotoFrame* frame);

struct PhotoRequest {
  std::string image;   ///< an image, a video, a folder of images, or a single-person dataset
  int frame = 0;       ///< of `image` and of `track` (a track of one frame: always that frame)
  std::string track;   ///< empty: the single-person dataset's own
  std::string labels;  ///< DensePose parts of the clip, used in place of clothing labels; or empty
  std::string body;    ///< empty: the built-in body
  std::string iuv;  ///< what its pixels show of the body: an IUV image, or a folder with one a frame; empty: what the
                    ///< tracked body says
};

struct Photo {
  PhotoFrame frame;
  Image image;                  ///< the whole image
  std::vector<uint8_t> person;  ///< 1 on the person (by its labels), in the whole image
  PersonWindow window;          ///< of one frame
  std::shared_ptr<const BodyModel> body;
  Track track;        ///< of one frame
  std::string notes;  ///< lines for the user, starting with the image: substitutes and missing data
};

/// Loads the photos in the order of the requests, at least one; all have the first one's body. Files are read once. An
/// image of the same aspect ratio as its track but of another size is resized. Throws std::runtime_error, one line
/// naming the file, if it cannot be read, image and track differ in aspect ratio, the frame does not exist, the track
/// puts nobody into the image, nothing of the body is visible, or the tracks are of different bodies.
std::vector<Photo> LoadPhotos(std::span<const PhotoRequest> requests, int size, int texture_size);

/// Requires the track to be of the photo's body, as poses and shape are meaningless on another. Throws
/// std::runtime_error naming `path` otherwise.
void RequireBodyOf(const Photo& photo, const Track& track, const std::string& path);

/// Parses "IMAGE:TRACK" or "IMAGE:TRACK:FRAME" of --views and --garment-from; a single-person dataset needs no track
/// ("DIR" or "DIR::FRAME"). Throws RequestError naming the option.
PhotoRequest ParsePhotoRequest(const std::string& text, const std::string& option, const PhotoRequest& like);

}  // namespace bodyloom
