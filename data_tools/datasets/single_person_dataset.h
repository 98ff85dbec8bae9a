// SPDX-License-Identifier: Apache-2.0
/// A single-person dataset: a folder with images of one person and per-pixel ground truth, the training data of the
/// appearance systems. Synthetic people are written in this form; recordings with labels of other programs can be, too.
///
///   DIR/person.json             {"format": "bodyloom person set", "version": 1, "frames": N, "width": W, "height": H,
///                                "fps": f, "labels": [the seven names below, in this order],
///                                "has": {"labels": b, "normals": b, "iuv": b, "background": b}}
///                               and, as information, "seed", "garment", "motion", "command"
///   DIR/images/000000.png       8-bit RGB
///   DIR/labels/000000.png       8-bit, one channel: index into "labels"
///   DIR/normals/000000.png      8-bit RGB: the unit normal of the visible (clothed) surface, camera frame (x right, y
///                               down, z forward; z < 0 faces the camera), n = 2c/255 − 1; background (0, 0, 0)
///   DIR/iuv/000000.png          the bare body's part (blue), u (green), v (red) in the form of
///                               observations/densepose_iuv.h: u and v in 1/255, rounded down
///   DIR/backgrounds/000000.png  8-bit RGB: the image without the person
///   DIR/track.npz               the track (data_tools/motion/track_io.h) of the N frames
/// person.json is written last: a folder without it is not a dataset, or an unfinished one.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "geometry/scene/person_label.h"
#include "geometry/scene/track.h"
#include "render/image/image.h"

namespace bodyloom {

/// Optional images that a dataset has, or a reader requests, in addition to `images`.
struct RenderedPeople {
  bool labels = true, normals = true, iuv = true, background = true;
};

struct SinglePersonDatasetInfo {
  int num_frames = 0, width = 0, height = 0;
  double fps = 30;
  RenderedPeople has;
  // Information only.
  uint64_t seed = 0;
  std::string garment, motion, command;
};

/// The images of a frame; empty if the dataset has none or none was requested. `labels` holds a label's index in all
/// three channels.
struct PersonFrame {
  Image rgb, labels, normals, iuv, background;
};

/// 8-bit code of a component of a unit normal, and back: n = 2c/255 − 1, with an error of at most 1/255.
uint8_t NormalCode(double component);
inline double NormalOfCode(uint8_t code) { return 2.0 * code / 255 - 1; }

/// Returns true if the folder `path` holds a finished single-person dataset: person.json exists.
bool IsSinglePersonDataset(const std::string& path);

/// Reader of a dataset. May be shared by threads.
class SinglePersonDataset {
 public:
  /// Reads person.json and checks that all files exist. Throws std::runtime_error naming the file, what was found and
  /// what was expected.
  explicit SinglePersonDataset(const std::string& path);

  [[nodiscard]] const SinglePersonDatasetInfo& info() const { return info_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  /// Throws std::runtime_error when the track has another number of frames or another image size than the dataset.
  [[nodiscard]] Track track() const;
  /// The image of frame t and the requested optional ones that the dataset has. Throws std::runtime_error naming the
  /// file when an image cannot be read, has another size, or a label is none of the seven; std::invalid_argument for a
  /// frame outside 0..num_frames−1.
  [[nodiscard]] PersonFrame Read(int t, const RenderedPeople& wanted = {}) const;

 private:
  std::string path_;
  SinglePersonDatasetInfo info_;
};

/// Writer of a dataset, frame by frame. Write() may be called by several threads at once.
class SinglePersonDatasetWriter {
 public:
  /// Creates the folders. The person.json and images of an existing dataset are removed first. Throws
  /// std::runtime_error naming the path, std::invalid_argument when sizes, rate or track are invalid.
  SinglePersonDatasetWriter(std::string path, const SinglePersonDatasetInfo& info, const Track& track);

  /// Writes the image of frame t and the optional ones that info.has names. Throws std::invalid_argument when one of
  /// them is missing or of the wrong size, std::runtime_error when it cannot be written.
  void Write(int t, const PersonFrame& frame) const;

  /// Writes person.json. Throws std::runtime_error when a frame was never written.
  void Finish() const;

 private:
  std::string path_;
  SinglePersonDatasetInfo info_;
};

// A contact sheet of a single-person dataset: evenly spread frames as columns; image, coloured labels, normals and IUV
// as rows.

/// The display colour of a label.
Colour PersonLabelColour(PersonLabel label);

/// Labels (indices in all channels) as colours.
Image PersonLabelImage(const Image& labels);

/// Receives the frames in order and keeps those that are shown.
class PersonSheet {
 public:
  explicit PersonSheet(int num_frames, int columns = 8);
  void Take(int t, const PersonFrame& frame);
  /// Throws std::invalid_argument when no frame was taken.
  [[nodiscard]] Image Draw(int cell_height_px = 200) const;

 private:
  std::vector<int> wanted_;
  std::vector<PersonFrame> frames_;
};

}  // namespace bodyloom
