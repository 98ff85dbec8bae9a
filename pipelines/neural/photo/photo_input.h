// SPDX-License-Identifier: Apache-2.0
/// Input of the one-photo renderers from a user's files: one picture of a person, and the poses to show.
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

/// The window's part of a picture.
struct CutPhoto {
  Image image;
  std::vector<uint8_t> labels;
};

/// uv, parts, texels of a frame; image and labels are left empty.
void FillMaps(PhotoMap&& map, int size, int texture_size, PhotoFrame* frame);
/// image (0 on the background) and labels.
void FillPicture(const CutPhoto& cut, PhotoFrame* frame);

struct PhotoRequest {
  std::string image;   ///< a picture, a video, a folder of pictures, or a single-person dataset
  int frame = 0;       ///< of the above, and of the track (a track of one frame: its only one)
  std::string track;   ///< empty: the single-person dataset's own
  std::string labels;  ///< DensePose's parts of the clip, which stand in for a parsing of the clothes; or empty
  std::string body;    ///< empty: the built-in body
  std::string iuv;  ///< what its pixels show of the body: an IUV image, or a folder with one a frame; empty: what the
                    ///< tracked body says
};

struct Photo {
  PhotoFrame frame;
  Image picture;                ///< whole
  std::vector<uint8_t> person;  ///< of the whole picture: 1 where the person (by its labels) is
  PersonWindow window;          ///< of one frame
  std::shared_ptr<const BodyModel> body;
  Track track;        ///< of one frame
  std::string notes;  ///< lines for the user, each beginning with the image: what stands in for what, what is missing
};

/// In the order of the requests, of which there is at least one; all are of the first one's body. Files are read once.
/// A picture of another size than its track's but of the same shape is brought to that size. Throws std::runtime_error,
/// one line naming the file: it cannot be read, picture and track are of different shapes, there is no such frame, the
/// track puts nobody into the picture, nothing of the body is to be seen, or the tracks are of different bodies.
std::vector<Photo> LoadPhotos(std::span<const PhotoRequest> requests, int size, int texture_size);

/// Poses and shape mean something only on the body that they were made for. Throws std::runtime_error naming `path`
/// when the track is of another one than the photo's.
void RequireBodyOf(const Photo& photo, const Track& track, const std::string& path);

/// "IMAGE:TRACK" or "IMAGE:TRACK:FRAME", as --views and --garment-from take it; a single-person dataset needs no track
/// ("DIR" or "DIR::FRAME"). Throws RequestError naming the option.
PhotoRequest ParsePhotoRequest(const std::string& text, const std::string& option, const PhotoRequest& like);

}  // namespace bodyloom
