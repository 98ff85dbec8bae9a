// SPDX-License-Identifier: Apache-2.0
/// The background of an animated person: a picture, a video that is played to and fro no further than its end, or a
/// plain backdrop.
#pragma once

#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/video/video_reader.h"
#include "geometry/scene/camera.h"
#include "neural/motion/motion_frame.h"
#include "render/image/image.h"
#include "render/view/person_window.h"

namespace bodyloom {

/// What stands behind a person who is rendered from a photo.
struct PhotoBackground {
  bool own = true;   ///< the photo's own, filled in where the person stood
  std::string path;  ///< else an image, a video or a folder; empty: a plain backdrop
};

/// The middle of an image at width × height, as much of it as fills that; nothing is stretched.
Image Covering(const Image& image, int width, int height);

class Background {
 public:
  /// `path`: an image, a video or a folder of images (Covering()); empty: a studio's backdrop. Throws
  /// std::runtime_error naming it.
  Background(const std::string& path, int width, int height);

  /// The next frame, width × height; a video that has ended keeps its last frame.
  const Image& Next();

 private:
  int width_, height_;
  std::unique_ptr<VideoReader> video_;
  Image image_;
};

// A rendered person laid into a picture.

struct PictureSize {
  int width = 0, height = 0;
};
/// Of the pictures that are written: the window's shrunk picture, or, with `full_size`, the camera's.
PictureSize SizeOfPictures(const PersonWindow& window, const Camera& camera, bool full_size);

/// Lays the picture of frame t's window into a picture of the window's shrunk size or a larger one of its shape: there
/// image + (1 − alpha) · picture, image and alpha interpolated between the four nearest pixels (0 outside the window),
/// so exact where nothing is enlarged. `image` is planar RGB in [0, 1] already multiplied by alpha, as the renderers
/// give it, of window.width × window.height pixels.
void Composite(std::span<const float> image, std::span<const float> alpha, const PersonWindow& window, int t,
               Image* picture);

// Samples of the window around a person at the pixels of a picture of the same shape, as large or larger.

class WindowSampler {
 public:
  /// Of frame t's window, for a picture of picture_width × picture_height pixels.
  WindowSampler(const PersonWindow& window, int t, int picture_width, int picture_height);

  /// Rows or columns that no pixel of the window reaches.
  [[nodiscard]] bool RowIsOutside(int y) const { return rows_[y].first < -1 || rows_[y].first >= height_; }
  [[nodiscard]] bool ColumnIsOutside(int x) const { return columns_[x].first < -1 || columns_[x].first >= width_; }

  /// A plane of the window's pixels, interpolated between the four nearest to the picture's pixel (x, y); 0 outside the
  /// window. Exact where nothing is enlarged.
  [[nodiscard]] float At(std::span<const float> plane, int x, int y) const;

  /// Index of the window's pixel nearest to the picture's pixel (x, y), −1 outside the window.
  [[nodiscard]] int Nearest(int x, int y) const;

 private:
  /// Where a row or column of the picture lies between two of the window's.
  struct Between {
    int first = 0;
    float to_second = 0;
  };
  static std::vector<Between> Places(int count, double scale, int corner);

  int width_, height_;
  std::vector<Between> columns_, rows_;
};

// A rendered clip as a single-person dataset, so that `bodyloom metrics` compares it with another, pixel by pixel.

/// The networks' prediction of frame t's window, as pictures as large as `composed` (which is taken as the frame's
/// image): the class of the window's nearest pixel, and normals between the four nearest, unit vectors where the class
/// is not background. `picture` without labels or normals: those are left empty.
PersonFrame SetFrameOf(const MotionPicture& picture, const PersonWindow& window, int t, const Image& composed);

/// Writes images, labels and normals (as far as the renderer makes them) and the track as a single-person dataset.
class RenderedDataset {
 public:
  /// Throws std::runtime_error when the folder cannot be written.
  RenderedDataset(const std::string& path, const Track& track, double fps, bool labels, bool normals,
                  const std::string& command);
  /// Labels and normals that `frame` lacks and the dataset has: all background.
  void Add(int t, PersonFrame frame);
  /// `picture` of no pixels: a frame without a fit.
  void Add(int t, const MotionPicture& picture, const PersonWindow& window, const Image& composed);
  /// Until then the folder is no set.
  void Finish() const;

 private:
  SinglePersonDatasetInfo info_;
  SinglePersonDatasetWriter writer_;
};

}  // namespace bodyloom
