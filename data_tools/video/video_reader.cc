// SPDX-License-Identifier: Apache-2.0
#include "data_tools/video/video_reader.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "data_tools/video/frame_decoder.h"
#include "data_tools/video/frame_image.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/jpeg_header.h"
#include "geometry/base/check.h"

namespace bodyloom {

class VideoReader::Source {
 public:
  virtual ~Source() = default;
  virtual bool Read(Image* frame) = 0;
  virtual int Skip(int count) = 0;
  virtual int SkipTo(double seconds) = 0;
  [[nodiscard]] virtual double frame_time() const = 0;
  [[nodiscard]] virtual std::string warning() const = 0;
  [[nodiscard]] const VideoInfo& info() const { return info_; }
  [[nodiscard]] int next_frame() const { return next_; }

 protected:
  void RequireSize(const std::string& where, int width, int height) const {
    if (width == info_.width && height == info_.height) return;
    throw std::runtime_error(Concatenate(where, ": image of ", width, "x", height, " pixels, expected ", info_.width,
                                         "x", info_.height, " as the first frame"));
  }

  VideoInfo info_;
  int next_ = 0;
};

class VideoReader::ImagesSource : public Source {
 public:
  ImagesSource(const std::string& path, std::vector<std::string> files) : path_(path), files_(std::move(files)) {
    const std::string bytes = ReadImageBytes(files_[0]);
    first_ = DecodeImage(bytes, files_[0]);
    if (const std::optional<JpegHeader> jpeg = ReadJpegHeader(bytes)) info_.focal_35mm_mm = jpeg->focal_35mm_mm;
    info_.width = first_.width;
    info_.height = first_.height;
    info_.num_frames = static_cast<int>(files_.size());
  }

  bool Read(Image* frame) override {
    if (next_ >= info_.num_frames) return false;
    if (next_ == 0 && !first_.empty()) {
      *frame = std::move(first_);
      first_ = Image();
    } else {
      *frame = ReadImage(files_[next_]);
      RequireSize(files_[next_], frame->width, frame->height);
    }
    ++next_;
    return true;
  }

  int Skip(int count) override {
    const int skipped = std::clamp(count, 0, info_.num_frames - next_);
    next_ += skipped;
    return skipped;
  }

  int SkipTo(double seconds) override {
    throw std::runtime_error(
        Concatenate(path_, ": images have no clock to find ", seconds, " s on, expected the number of a frame"));
  }

  [[nodiscard]] double frame_time() const override { return std::numeric_limits<double>::quiet_NaN(); }
  [[nodiscard]] std::string warning() const override { return ""; }

 private:
  std::string path_;
  std::vector<std::string> files_;
  Image first_;  ///< read on opening to learn the size
};

class VideoReader::FileSource : public Source {
 public:
  explicit FileSource(const std::string& path)
      : path_(path), decoder_(path), converter_(path, decoder_.packets().stream()) {
    if (!Peek()) throw std::runtime_error(path + ": the video holds no frame that can be decoded");
    converter_.Convert(decoder_.frame(), &first_);
    info_.width = first_.width;
    info_.height = first_.height;
    info_.fps = decoder_.packets().fps();
    info_.focal_35mm_mm = decoder_.packets().focal_35mm_mm();
    info_.num_frames = decoder_.packets().num_frames();
  }

  bool Read(Image* frame) override {
    if (!Peek()) return false;
    const AVFrame& decoded = decoder_.frame();
    RequireSize(Concatenate(path_, ": frame ", next_), converter_.WidthOf(decoded), converter_.HeightOf(decoded));
    if (!first_.empty()) {
      *frame = std::move(first_);
    } else {
      converter_.Convert(decoded, frame);
    }
    Pass();
    return true;
  }

  int Skip(int count) override {
    int skipped = 0;
    for (; skipped < count && Peek(); ++skipped) Pass();
    return skipped;
  }

  int SkipTo(double seconds) override {
    constexpr double kMicrosecond = 1e-6;
    int skipped = 0;
    for (; Peek() && decoder_.time() < seconds - kMicrosecond; ++skipped) Pass();
    return skipped;
  }

  [[nodiscard]] double frame_time() const override { return time_s_; }

  [[nodiscard]] std::string warning() const override {
    std::string what;
    const auto add = [&what](const std::string& part) { what += (what.empty() ? "" : "; ") + part; };
    if (decoder_.num_lost() > 0) add(Concatenate(decoder_.num_lost(), " frames cannot be decoded and are left out"));
    if (decoder_.num_damaged() > 0) add(Concatenate(decoder_.num_damaged(), " frames are damaged"));
    const std::string cut_off = ended_ ? decoder_.packets().CutOff() : "";
    if (!cut_off.empty()) add(Concatenate("cut off or damaged after ", next_, " frames (", cut_off, ")"));
    return what.empty() ? "" : path_ + ": " + what;
  }

 private:
  /// Decodes the next frame; returns false if there is none.
  bool Peek() {
    if (!has_frame_ && !ended_) {
      has_frame_ = decoder_.Next();
      ended_ = !has_frame_;
    }
    return has_frame_;
  }

  void Pass() {
    first_ = Image();
    has_frame_ = false;
    time_s_ = decoder_.time();
    ++next_;
  }

  std::string path_;
  FrameDecoder decoder_;
  FrameImage converter_;
  Image first_;  ///< converted on opening, so that unsupported formats are refused there
  bool has_frame_ = false, ended_ = false;
  double time_s_ = 0;
};

VideoReader::VideoReader(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    source_ = std::make_unique<ImagesSource>(path, ImageFilesOf(path));
  } else if (IsImageName(path) && std::filesystem::is_regular_file(path, error)) {
    // ReadImage orients photos by their EXIF.
    source_ = std::make_unique<ImagesSource>(path, std::vector<std::string>{path});
  } else {
    source_ = std::make_unique<FileSource>(path);
  }
}
VideoReader::~VideoReader() = default;
const VideoInfo& VideoReader::info() const { return source_->info(); }
bool VideoReader::Read(Image* frame) { return source_->Read(frame); }
int VideoReader::Skip(int count) { return source_->Skip(count); }
int VideoReader::SkipTo(double seconds) { return source_->SkipTo(seconds); }
int VideoReader::next_frame() const { return source_->next_frame(); }
double VideoReader::frame_time() const { return source_->frame_time(); }
std::string VideoReader::warning() const { return source_->warning(); }

}  // namespace bodyloom
