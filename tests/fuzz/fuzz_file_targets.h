// SPDX-License-Identifier: Apache-2.0
/// Fuzz targets for readers that need a path: the input is first written to a file of this process. Each returns true
/// if the input was accepted; accepted data must be consistent.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "data_tools/body/body_io.h"
#include "data_tools/datasets/single_person_dataset.h"
#include "data_tools/motion/motion_split.h"
#include "data_tools/observations/densepose_iuv.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/video_reader.h"
#include "tests/fuzz/fuzz_accepts.h"
#include "tests/support/toy_body.h"

namespace bodyloom::fuzz {

/// A folder of this process; removed at its end.
class FuzzFolder {
 public:
  FuzzFolder() : path_(std::filesystem::temp_directory_path() / ("fuzz_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~FuzzFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  FuzzFolder(const FuzzFolder&) = delete;
  FuzzFolder& operator=(const FuzzFolder&) = delete;
  [[nodiscard]] std::string path() const { return path_.string(); }
  /// Writes a file, creating its folder, and returns its path.
  std::string Write(const std::string& name, const std::string& bytes) const {
    const std::filesystem::path path = path_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << bytes;
    return path.string();
  }

 private:
  std::filesystem::path path_;
};

inline const FuzzFolder& Folder() {
  static const FuzzFolder folder;
  return folder;
}

inline bool AcceptsImage(const std::string& bytes) {
  const std::string path = Folder().Write("image.png", bytes);
  const bool image = Accepts([&] {
    const Image pixels = ReadImage(path);
    if (pixels.width < 1 || pixels.height < 1) throw std::logic_error("an image without pixels");
  });
  const bool iuv = Accepts([&] {
    const IuvImage found = ReadIuvImage(path);
    for (const uint8_t part : found.part) {
      if (part > 24) throw std::logic_error("a part above 24");
    }
  });
  return image || iuv;
}

/// Videos of any format: frames of one size, at ascending times.
inline bool AcceptsVideo(const std::string& bytes) {
  const std::string path = Folder().Write("video", bytes);
  const bool times = Accepts([&] { VideoFrameTimes(path); });
  const bool frames = Accepts([&] {
    constexpr int kEnough = 50;
    VideoReader reader(path);
    Image frame;
    double last = -1;
    for (int i = 0; i < kEnough && reader.Read(&frame); ++i) {
      if (frame.width != reader.info().width || frame.height != reader.info().height) {
        throw std::logic_error("a frame of another size");
      }
      if (!(reader.frame_time() > last)) throw std::logic_error("a clock that stands");
      last = reader.frame_time();
    }
    if (!IsOneLine(reader.warning())) throw std::logic_error("a warning of several lines");
  });
  return frames && times;
}

/// person.json of a dataset with one existing frame.
inline bool AcceptsSinglePersonDataset(const std::string& bytes) {
  static const bool once = [] {
    for (const char* name : {"images", "labels", "normals", "iuv", "backgrounds"}) {
      Folder().Write(std::string("set/") + name + "/000000.png", "");
    }
    Folder().Write("set/track.npz", "");
    return true;
  }();
  (void)once;
  Folder().Write("set/person.json", bytes);
  return Accepts([&] {
    const SinglePersonDataset set(Folder().path() + "/set");
    if (set.info().num_frames != 1 || !(set.info().fps > 0)) throw std::logic_error("frames that are not there");
  });
}

inline bool AcceptsSplit(const std::string& bytes) {
  return Accepts([&] { MotionSplitFromText(bytes, "fuzz.txt"); });
}

/// DensePose's MATLAB file, for the toy body.
inline bool AcceptsMat(const std::string& bytes) {
  const std::string path = Folder().Write("parts.mat", bytes);
  return Accepts([&] {
    BodyModelData body = ToyBody().data();
    PartsFromUvProcessedMat(path, &body);
  });
}

}  // namespace bodyloom::fuzz
