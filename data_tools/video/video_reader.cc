// SPDX-License-Identifier: Apache-2.0
#include "bodyloom/data_tools/video/video_reader.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <stdexcept>
#include <vector>

#include "bodyloom/data_tools/video/image_file.h"
#include "bodyloom/data_tools/video/quiet_codecs.h"
#include "bodyloom/render/image_mat.h"

namespace bodyloom {
namespace fs = std::filesystem;

class VideoReader::Source {
 public:
  explicit Source(const std::string& path) : path_(path) {
    std::error_code error;
    if (!fs::exists(path, error)) throw std::runtime_error(path + ": no such video or folder of images");
    is_folder_ = fs::is_directory(path, error);
    if (is_folder_) {
      files_ = ImageFilesOf(path);
      info_.num_frames = static_cast<int>(files_.size());
    } else {
      Open();
    }
    has_pending_ = Decode(&pending_);
    if (!has_pending_) throw std::runtime_error(path + ": the video holds no frame that can be decoded");
    info_.width = pending_.width;
    info_.height = pending_.height;
  }

  bool Read(Image* frame) {
    if (has_pending_) {
      has_pending_ = false;
      *frame = std::move(pending_);
      ++next_;
      return true;
    }
    if (!Decode(frame)) {
      // What a container promises may be off by a few frames; a tenth of the video is not a few.
      if (next_ < info_.num_frames - std::max(2, info_.num_frames / 10)) {
        throw std::runtime_error(path_ + ": frame " + std::to_string(next_) +
                                 ": cannot be decoded, the file promises " + std::to_string(info_.num_frames) +
                                 " frames; it is damaged or cut off");
      }
      return false;
    }
    if (frame->width != info_.width || frame->height != info_.height) {
      throw std::runtime_error((is_folder_ ? files_[next_] : path_ + ": frame " + std::to_string(next_)) +
                               ": image of " + SizeText(frame->width, frame->height) + " pixels, expected " +
                               SizeText(info_.width, info_.height) + " as the first frame");
    }
    ++next_;
    return true;
  }

  [[nodiscard]] const VideoInfo& info() const { return info_; }
  [[nodiscard]] int next_frame() const { return next_; }

 private:
  static std::string SizeText(int width, int height) { return std::to_string(width) + "x" + std::to_string(height); }

  void Open() {
    if (!fs::is_regular_file(path_)) throw std::runtime_error(path_ + ": neither a regular file nor a folder");
    if (fs::file_size(path_) == 0) throw std::runtime_error(path_ + ": the file is empty, expected a video");
    QuietCodecs();
    // An absolute path: ffmpeg would take "name:rest" for a protocol.
    bool opened = false;
    try {
      opened = capture_.open(fs::absolute(path_).string(), cv::CAP_FFMPEG);
    } catch (const cv::Exception&) {
      opened = false;
    }
    if (!opened) throw std::runtime_error(path_ + ": not a video that ffmpeg can decode");
    const double fps = capture_.get(cv::CAP_PROP_FPS), count = capture_.get(cv::CAP_PROP_FRAME_COUNT);
    if (std::isfinite(fps) && fps > 0 && fps < 10000) info_.fps = fps;
    if (std::isfinite(count) && count > 0 && count < 1e8) info_.num_frames = static_cast<int>(count);
  }

  bool Decode(Image* frame) {
    if (is_folder_) {
      const size_t index = static_cast<size_t>(next_);
      if (index >= files_.size()) return false;
      *frame = ReadImage(files_[index]);
      return true;
    }
    cv::Mat mat;
    try {
      if (!capture_.read(mat) || mat.empty()) return false;
    } catch (const cv::Exception& error) {
      throw std::runtime_error(path_ + ": frame " + std::to_string(next_) + ": cannot be decoded");
    }
    if (mat.channels() == 1) cv::cvtColor(mat, mat, cv::COLOR_GRAY2BGR);
    if (mat.type() != CV_8UC3) {
      throw std::runtime_error(path_ + ": frame " + std::to_string(next_) + ": decoded to OpenCV type " +
                               std::to_string(mat.type()) + ", expected 8-bit colour");
    }
    if (frame->width != mat.cols || frame->height != mat.rows) *frame = Image(mat.cols, mat.rows);
    cv::Mat target = MatOf(frame);
    mat.copyTo(target);
    return true;
  }

  std::string path_;
  bool is_folder_ = false;
  std::vector<std::string> files_;
  cv::VideoCapture capture_;
  VideoInfo info_;
  Image pending_;  ///< the first frame, decoded on opening to learn the true size
  bool has_pending_ = false;
  int next_ = 0;
};

VideoReader::VideoReader(const std::string& path) : source_(std::make_unique<Source>(path)) {}
VideoReader::~VideoReader() = default;
const VideoInfo& VideoReader::info() const { return source_->info(); }
bool VideoReader::Read(Image* frame) { return source_->Read(frame); }
int VideoReader::next_frame() const { return source_->next_frame(); }

int VideoReader::Skip(int count) {
  Image ignored;
  int skipped = 0;
  while (skipped < count && source_->Read(&ignored)) ++skipped;
  return skipped;
}

}  // namespace bodyloom
