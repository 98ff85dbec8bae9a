// SPDX-License-Identifier: Apache-2.0
#include "data_tools/video/frame_image.h"

#include <cmath>
#include <cstdlib>

extern "C" {
#include <libavformat/avformat.h>
#include <libavutil/frame.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

#include <opencv2/core.hpp>
#include <stdexcept>
#include <utility>

#include "geometry/base/check.h"
#include "render/image/image_mat.h"

namespace bodyloom {
namespace {

const int32_t* DisplayMatrixOf(const AVStream& stream) {
  size_t size = 0;
  const uint8_t* data = av_stream_get_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, &size);
  return size >= 9 * sizeof(int32_t) ? reinterpret_cast<const int32_t*>(data) : nullptr;
}

/// JPEG's formats, and grey by default, use all 256 values.
bool HasFullRange(const AVFrame& frame) {
  switch (frame.format) {
    case AV_PIX_FMT_YUVJ420P:
    case AV_PIX_FMT_YUVJ422P:
    case AV_PIX_FMT_YUVJ444P:
    case AV_PIX_FMT_YUVJ440P:
    case AV_PIX_FMT_YUVJ411P:
      return true;
    default:
      break;
  }
  if (frame.color_range != AVCOL_RANGE_UNSPECIFIED) return frame.color_range == AVCOL_RANGE_JPEG;
  const AVPixFmtDescriptor* format = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(frame.format));
  return format != nullptr && format->nb_components <= 2 && (format->flags & AV_PIX_FMT_FLAG_RGB) == 0;
}

/// Position of the chroma samples, in 1/256 of a luma pixel from the first one.
void SetChromaLocation(SwsContext* scaler, const AVPixFmtDescriptor& format, int location) {
  const bool centred =
      location == AVCHROMA_LOC_CENTER || location == AVCHROMA_LOC_TOP || location == AVCHROMA_LOC_BOTTOM;
  const bool top = location == AVCHROMA_LOC_TOPLEFT || location == AVCHROMA_LOC_TOP;
  const bool bottom = location == AVCHROMA_LOC_BOTTOMLEFT || location == AVCHROMA_LOC_BOTTOM;
  if (format.log2_chroma_w == 1) av_opt_set_int(scaler, "src_h_chr_pos", centred ? 128 : 0, 0);
  if (format.log2_chroma_h == 1) av_opt_set_int(scaler, "src_v_chr_pos", top ? 0 : bottom ? 256 : 128, 0);
}

/// Blue, green and red of a converted frame side by side.
void Interleave(const AVFrame& converted, cv::Mat* bgr) {
  const auto plane = [&](int index, int type) {
    return cv::Mat(converted.height, converted.width, type, converted.data[index], converted.linesize[index]);
  };
  if (converted.format == AV_PIX_FMT_GBRP) {
    const cv::Mat planes[] = {plane(1, CV_8UC1), plane(0, CV_8UC1), plane(2, CV_8UC1)};
    cv::merge(planes, 3, *bgr);
  } else {
    plane(0, CV_8UC3).copyTo(*bgr);
  }
}

void Flip(const DisplayOrientation& orientation, cv::Mat* image) {
  if (!orientation.flip_columns && !orientation.flip_rows) return;
  cv::flip(*image, *image, orientation.flip_columns && orientation.flip_rows ? -1 : orientation.flip_columns ? 1 : 0);
}

}  // namespace

FrameImage::FrameImage(const std::string& path, const AVStream& stream, double pixel_aspect, int turn_deg)
    : path_(path),
      pixel_aspect_(pixel_aspect),
      orientation_(Then(OrientationOf(DisplayMatrixOf(stream)), ClockwiseTurn(turn_deg))),
      converted_(NewLibavFrame()) {
  BODYLOOM_CHECK(pixel_aspect > 0, "FrameImage: pixels of ", pixel_aspect, " times their height, expected above 0");
}

FrameSize FrameImage::SquareSizeOf(const FrameSize& stored) const {
  const auto enlarged = [](int length, double factor) { return static_cast<int>(std::lround(length * factor)); };
  if (pixel_aspect_ >= 1) return {enlarged(stored.width, pixel_aspect_), stored.height};
  return {stored.width, enlarged(stored.height, 1 / pixel_aspect_)};
}

FrameSize FrameImage::Oriented(const FrameSize& size) const {
  return orientation_.transpose ? FrameSize{size.height, size.width} : size;
}

FrameSize FrameImage::SizeOf(const AVFrame& frame) const { return Oriented(SquareSizeOf({frame.width, frame.height})); }

FrameSize FrameImage::StoredSizeOf(const AVFrame& frame) const { return Oriented({frame.width, frame.height}); }

void FrameImage::Prepare(const Kind& kind) {
  const auto format = static_cast<AVPixelFormat>(kind.format);
  const AVPixFmtDescriptor* description = av_pix_fmt_desc_get(format);
  const char* name = description != nullptr ? description->name : "unknown";
  kind_ = Kind();
  scaler_.reset(sws_alloc_context());
  if (!scaler_) throw std::bad_alloc();
  if (description == nullptr || sws_isSupportedInput(format) == 0) {
    throw std::runtime_error(Concatenate(path_, ": pixels of the format ", name, ", which cannot be converted"));
  }
  SwsContext* scaler = scaler_.get();
  av_frame_unref(converted_.get());
  const FrameSize square = SquareSizeOf(kind.size);
  av_opt_set_int(scaler, "srcw", kind.size.width, 0);
  av_opt_set_int(scaler, "srch", kind.size.height, 0);
  av_opt_set_int(scaler, "dstw", square.width, 0);
  av_opt_set_int(scaler, "dsth", square.height, 0);
  av_opt_set_int(scaler, "src_format", format, 0);
  // From YUV to packed colours the library uses an approximation that is darker by 1 to 1.5 levels and repeats chroma,
  // or is slow; to planes it is fast and correct. RGB colours are only copied.
  const bool is_rgb = (description->flags & (AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_PAL)) != 0;
  converted_->format = is_rgb ? AV_PIX_FMT_BGR24 : AV_PIX_FMT_GBRP;
  av_opt_set_int(scaler, "dst_format", converted_->format, 0);
  av_opt_set_int(scaler, "sws_flags", SWS_BILINEAR | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT, 0);
  SetChromaLocation(scaler, *description, kind.chroma_location);
  converted_->width = square.width;
  converted_->height = square.height;
  if (sws_init_context(scaler, nullptr, nullptr) < 0 || av_frame_get_buffer(converted_.get(), 0) < 0) {
    throw std::runtime_error(Concatenate(path_, ": pixels of the format ", name, ", ", kind.size.width, "x",
                                         kind.size.height, ", which cannot be converted"));
  }
  constexpr int kOne = 1 << 16;
  sws_setColorspaceDetails(scaler, sws_getCoefficients(kind.colour_space), kind.full_range ? 1 : 0,
                           sws_getCoefficients(SWS_CS_DEFAULT), 1, 0, kOne, kOne);
  kind_ = kind;
}

void FrameImage::Convert(const AVFrame& frame, Image* image) {
  const Kind kind = {
      {frame.width, frame.height}, frame.format, frame.colorspace, frame.chroma_location, HasFullRange(frame)};
  if (kind != kind_) Prepare(kind);
  sws_scale(scaler_.get(), frame.data, frame.linesize, 0, frame.height, converted_->data, converted_->linesize);
  const FrameSize size = SizeOf(frame);
  if (image->width != size.width || image->height != size.height) *image = Image(size.width, size.height);
  cv::Mat shown = MatOf(image);
  if (orientation_.transpose) {
    if (as_stored_.width != converted_->width || as_stored_.height != converted_->height)
      as_stored_ = Image(converted_->width, converted_->height);
    cv::Mat stored = MatOf(&as_stored_);
    Interleave(*converted_, &stored);
    cv::transpose(stored, shown);
  } else {
    Interleave(*converted_, &shown);
  }
  Flip(orientation_, &shown);
}

Image Oriented(Image image, const DisplayOrientation& orientation) {
  if (orientation == DisplayOrientation()) return image;
  Image oriented = orientation.transpose ? Image(image.height, image.width) : std::move(image);
  cv::Mat shown = MatOf(&oriented);
  if (orientation.transpose) cv::transpose(MatOf(&image), shown);
  Flip(orientation, &shown);
  return oriented;
}

DisplayOrientation Then(const DisplayOrientation& first, const DisplayOrientation& second) {
  // A transposition exchanges the reversals before it.
  const bool columns = second.transpose ? first.flip_rows : first.flip_columns;
  const bool rows = second.transpose ? first.flip_columns : first.flip_rows;
  return {first.transpose != second.transpose, columns != second.flip_columns, rows != second.flip_rows};
}

DisplayOrientation ClockwiseTurn(int degrees) {
  switch (degrees) {
    case 0:
      return {};
    case 90:
      return {true, true, false};
    case 180:
      return {false, true, true};
    case 270:
      return {true, false, true};
    default:
      throw std::invalid_argument(Concatenate("a turn by ", degrees, " degrees, expected 0, 90, 180 or 270"));
  }
}

DisplayOrientation OrientationOf(const int32_t* matrix) {
  if (matrix == nullptr) return {};
  const int64_t a = matrix[0], b = matrix[1], c = matrix[3], d = matrix[4];
  if (std::abs(a) + std::abs(d) >= std::abs(b) + std::abs(c)) return {false, a < 0, d < 0};
  return {true, c < 0, b < 0};
}

}  // namespace bodyloom
