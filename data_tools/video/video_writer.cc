// SPDX-License-Identifier: Apache-2.0
#include "data_tools/video/video_writer.h"

#include <filesystem>
#include <stdexcept>

#include "data_tools/formats/atomic_file.h"
#include "data_tools/video/image_header.h"
#include "data_tools/video/video_encoder.h"
#include "data_tools/video/video_reader.h"
#include "geometry/base/check.h"

namespace bodyloom {

class VideoWriter::Sink {
 public:
  Sink(const std::string& path, int width, int height, double fps)
      : path_(path), width_(width), height_(height), file_(path) {
    BODYLOOM_CHECK(width >= 2 && height >= 2 && width <= 16384 && height <= 16384, path, ": frames of ", width, "x",
                   height, " pixels, expected 2 to 16384 a side");
    BODYLOOM_CHECK((int64_t{width} + 1) * (int64_t{height} + 1) <= kMaxImagePixels, path, ": frames of ", width, "x",
                   height, " pixels, expected at most ", kMaxImagePixels);
    BODYLOOM_CHECK(fps > 0 && fps <= 1000, path, ": ", fps, " frames a second, expected more than 0 and at most 1000");
    if (std::filesystem::path(path).extension() != ".mp4") {
      throw std::runtime_error(path + ": extension of a video to write, expected .mp4");
    }
    encoder_ = std::make_unique<VideoEncoder>(file_.temporary(), path, width, height, fps);
  }

  void Write(const Image& frame) {
    BODYLOOM_CHECK(frame.width == width_ && frame.height == height_, path_, ": frame of ", frame.width, "x",
                   frame.height, " pixels, expected ", width_, "x", height_);
    BODYLOOM_CHECK(!finished_, path_, ": a frame after the end");
    encoder_->Write(frame);
    ++num_frames_;
  }

  void Finish() {
    BODYLOOM_CHECK(!finished_, path_, ": finished twice");
    const std::string reason = encoder_->Finish();
    finished_ = true;
    if (num_frames_ == 0) throw std::runtime_error(path_ + ": no frames to write");
    const int found = FramesInFile();
    if (!reason.empty() || found < num_frames_) {
      throw DiskFullError(Concatenate(path_, ": only ", found, " of ", num_frames_, " frames could be written (",
                                      reason.empty() ? "read back" : reason, "); is the disk full?"));
    }
    file_.Commit();
  }

  [[nodiscard]] int num_frames() const { return num_frames_; }
  [[nodiscard]] const std::string& codec() const { return encoder_->codec(); }

 private:
  /// 0 where it cannot be read.
  [[nodiscard]] int FramesInFile() const {
    try {
      return VideoReader(file_.temporary()).info().num_frames;
    } catch (const std::runtime_error&) {
      return 0;
    }
  }

  std::string path_;
  int width_, height_;
  AtomicPath file_;  ///< outlives the encoder, which has it open
  std::unique_ptr<VideoEncoder> encoder_;
  int num_frames_ = 0;
  bool finished_ = false;
};

VideoWriter::VideoWriter(const std::string& path, int width, int height, double fps)
    : sink_(std::make_unique<Sink>(path, width, height, fps)) {}
VideoWriter::~VideoWriter() = default;
void VideoWriter::Write(const Image& frame) { sink_->Write(frame); }
void VideoWriter::Finish() { sink_->Finish(); }
int VideoWriter::num_frames() const { return sink_->num_frames(); }
std::string VideoWriter::codec() const { return sink_->codec(); }

}  // namespace bodyloom
