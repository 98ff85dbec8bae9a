// SPDX-License-Identifier: Apache-2.0
/// Backgrounds of an animated person (an image, a video or a plain backdrop), compositing of the person over them, and
/// output of the result as a single-person dataset.
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

/// Background of a person who is rendered from a photo.
struct PhotoBackground {
  bool own = true;   ///< the photo's own, filled in where the person stood
  std::string path;  ///< else an image, a video or a folder; empty: a plain backdrop
};

/// The centre crop of an image that has the aspect ratio of width × height, scaled to that size without distortion.
Image Covering(const Image& image, int width, int height);

class Background {
 public:
  /// `path`: an image, a video or a folder of images (Covering()); empty: a plain studio backdrop. Throws
  /// std::runtime_error naming it.
  Background(const std::string& path, int width, int height);

  /// The next frame, width × height; a video that has ended keeps its last frame.
  const Image& Next();

 private:
  int width_, height_;
  std::unique_ptr<VideoReader> video_;
  Image image_;
};

// Compositing of a rendered person over a background.

struct ImageSize {
  int width = 0, height = 0;
};
/// Size of the images that are written: the window's shrunk canvas, or, with `full_size`, the camera's.
ImageSize SizeOfImages(const PersonWindow& window, const Camera& camera, bool full_size);

/// Composites frame t's window over a canvas of the window's shrunk size or a larger one of the same aspect ratio:
/// canvas ← image + (1 − alpha) · canvas. Image and alpha are interpolated bilinearly (0 outside the window), which is
/// exact where nothing is enlarged. `image` is planar RGB in [0, 1], premultiplied by alpha as the renderers give it,
/// of window.width × window.height pixels.
void Composite(std::span<const float> image, std::span<const float> alpha, const PersonWindow& window, int t,
               Image* canvas);

// Sampling of the window around a person at the pixels of an image of the same aspect ratio, as large or larger.

class WindowSampler {
 public:
  /// Samples frame t's window for an image of image_width × image_height pixels.
  WindowSampler(const PersonWindow& window, int t, int image_width, int image_height);

  /// True for rows or columns that no pixel of the window reaches.
  [[nodiscard]] bool RowIsOutside(int y) const { return rows_[y].first < -1 || rows_[y].first >= height_; }
  [[nodiscard]] bool ColumnIsOutside(int x) const { return columns_[x].first < -1 || columns_[x].first >= width_; }

  /// Value of a plane of the window at the image's pixel (x, y), interpolated bilinearly; 0 outside the window. Exact
  /// where nothing is enlarged.
  [[nodiscard]] float At(std::span<const float> plane, int x, int y) const;

  /// Index of the window's pixel nearest to the image's pixel (x, y), −1 outside the window.
  [[nodiscard]] int Nearest(int x, int y) const;

 private:
  /// Position of a row or column of the image between two of the window's.
  struct Between {
    int first = 0;
    float to_second = 0;
  };
  static std::vector<Between> Places(int count, double scale, int corner);

  int width_, height_;
  std::vector<Between> columns_, rows_;
};

// Output of a rendered clip as a single-person dataset, which `bodyloom metrics` compares pixel by pixel with another.

/// The networks' prediction of frame t's window at the size of `composed`, which becomes the frame's image. Labels: the
/// class of the window's nearest pixel. Normals: interpolated bilinearly, unit vectors where the class is not
/// background. An `image` without labels or normals leaves them empty.
PersonFrame SetFrameOf(const MotionImage& image, const PersonWindow& window, int t, const Image& composed);

/// Writes images, labels and normals (those that the renderer makes) and the track as a single-person dataset.
class RenderedDataset {
 public:
  /// Throws std::runtime_error when the folder cannot be written.
  RenderedDataset(const std::string& path, const Track& track, double fps, bool labels, bool normals,
                  const std::string& command);
  /// Adds a frame. Labels and normals that the dataset has and `frame` lacks are all background.
  void Add(int t, PersonFrame frame);
  /// Adds SetFrameOf() of the image; an `image` of no pixels is a frame without a fit.
  void Add(int t, const MotionImage& image, const PersonWindow& window, const Image& composed);
  /// Completes the dataset; before that, the folder is not readable as one.
  void Finish() const;

 private:
  SinglePersonDatasetInfo info_;
  SinglePersonDatasetWriter writer_;
};

}  // namespace bodyloom
