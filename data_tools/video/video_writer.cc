// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/video/video_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <stdexcept>

#include "bodyloom/data_tools/formats/atomic_file.h"
#include "bodyloom/data_tools/video/quiet_codecs.h"
#include "bodyloom/geometry/base/check.h"
#include "bodyloom/render/image_mat.h"

namespace bodyloom {

class VideoWriter::Sink {
 public:
  Sink(const std::string& path, int width, int height, double fps)
      : path_(path), width_(width), height_(height), file_(path) {
    BODYLOOM_CHECK(width >= 2 && height >= 2 && width <= 16384 && height <= 16384, path, ": frames of ", width, "x",
                   height, " pixels, expected 2 to 16384 a side");
    BODYLOOM_CHECK(fps > 0 && fps <= 1000, path, ": ", fps, " frames a second, expected more than 0 and at most 1000");
    if (std::filesystem::path(path).extension() != ".mp4") {
      throw std::runtime_error(path + ": extension of a video to write, expected .mp4");
    }
    // OpenCV only says that it failed: find out here whether the place can be written.
    const std::string temporary = std::filesystem::absolute(file_.temporary()).string();
    const int fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (fd < 0) throw std::runtime_error(path + ": cannot open for writing: " + std::strerror(errno));
    ::close(fd);
    QuietCodecs();
    const cv::Size even((width + 1) / 2 * 2, (height + 1) / 2 * 2);
    struct Codec {
      const char* name;
      int fourcc;
    };
    for (const Codec& codec : {Codec{"H.264", cv::VideoWriter::fourcc('a', 'v', 'c', '1')},
                               Codec{"MPEG-4", cv::VideoWriter::fourcc('m', 'p', '4', 'v')}}) {
      if (writer_.open(temporary, cv::CAP_FFMPEG, codec.fourcc, fps, even)) {
        codec_ = codec.name;
        return;
      }
    }
    throw std::runtime_error(path + ": no encoder for .mp4 (tried H.264 and MPEG-4); install ffmpeg's codec libraries");
  }

  void Write(const Image& frame) {
    BODYLOOM_CHECK(frame.width == width_ && frame.height == height_, path_, ": frame of ", frame.width, "x",
                   frame.height, " pixels, expected ", width_, "x", height_);
    BODYLOOM_CHECK(!finished_, path_, ": a frame after the end");
    if (width_ % 2 == 0 && height_ % 2 == 0) {
      writer_.write(MatOf(frame));
    } else {
      cv::copyMakeBorder(MatOf(frame), padded_, 0, height_ % 2, 0, width_ % 2, cv::BORDER_REPLICATE);
      writer_.write(padded_);
    }
    ++num_frames_;
  }

  void Finish() {
    BODYLOOM_CHECK(!finished_, path_, ": finished twice");
    writer_.release();
    finished_ = true;
    if (num_frames_ == 0) throw std::runtime_error(path_ + ": no frames to write");
    cv::VideoCapture check;
    cv::Mat first;
    const bool readable =
        check.open(std::filesystem::absolute(file_.temporary()).string(), cv::CAP_FFMPEG) && check.read(first);
    const int found = readable ? static_cast<int>(std::lround(check.get(cv::CAP_PROP_FRAME_COUNT))) : 0;
    if (found < num_frames_) {
      throw std::runtime_error(path_ + ": only " + std::to_string(found) + " of " + std::to_string(num_frames_) +
                               " frames could be written; is the disk full?");
    }
    file_.Commit();
  }

  [[nodiscard]] int num_frames() const { return num_frames_; }
  [[nodiscard]] const std::string& codec() const { return codec_; }

 private:
  std::string path_;
  int width_, height_;
  AtomicPath file_;
  cv::VideoWriter writer_;
  cv::Mat padded_;
  std::string codec_;
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
