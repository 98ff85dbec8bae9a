// SPDX-License-Identifier: Apache-2.0
#include "pipelines/render/render_sinks.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "data_tools/video/image_file.h"
#include "geometry/base/callbacks.h"
#include "geometry/base/check.h"
#include "render/image/palette.h"
#include "render/raster/resolve_pixels.h"
#include "render/view/caption.h"
#include "render/view/contact_sheet.h"
#include "render/view/error_colours.h"

namespace bodyloom {
namespace {

void DrawCaptions(const RenderStep& step, const FrameRenderer& renderer, Image* image) {
  const double height = std::max(9.0, image->height / 48.0);
  DrawCaption({{renderer.Caption(step.frame, step.turn_deg)}}, Corner::kTopLeft, height, image);
  if (const std::optional<ErrorScale> scale = renderer.Scale()) {
    const int margin = static_cast<int>(height);
    const int width = std::min(image->width - 2 * margin, static_cast<int>(26 * height));
    DrawErrorLegend(*scale, margin, image->height - margin - ErrorLegendHeight(height), width, height, image);
  } else if (!renderer.Legend().empty()) {
    DrawCaption({{renderer.Legend()}}, Corner::kBottomLeft, height, image);
  }
}

class VideoSink : public RenderSink {
 public:
  VideoSink(const std::string& path, const Camera& camera, double fps)
      : writer_(path, camera.width, camera.height, fps) {}
  void Take(const RenderStep& step, const Image* background, FrameRenderer* renderer) override {
    Image image = renderer->Draw(step.frame, step.turn_deg, background);
    DrawCaptions(step, *renderer, &image);
    writer_.Write(image);
  }
  void Finish() override { writer_.Finish(); }

 private:
  VideoWriter writer_;
};

class SheetSink : public RenderSink {
 public:
  SheetSink(std::string path, std::vector<std::string> title) : path_(std::move(path)), title_(std::move(title)) {}
  [[nodiscard]] std::vector<int> Wanted(int num_steps) const override { return EvenlySpreadFrames(num_steps, 12); }
  void Take(const RenderStep& step, const Image* background, FrameRenderer* renderer) override {
    const Image image = renderer->Draw(step.frame, step.turn_deg, background);
    const int width = std::max(160, static_cast<int>(std::lround(double(kImageHeight) * image.width / image.height)));
    // The caption is above the image, so it covers nothing and stays readable at any image size.
    Image cell(width, kWords + kImageHeight, kInkColour);
    DrawCaption({{renderer->Caption(step.frame, step.turn_deg)}}, Corner::kTopLeft, 10, &cell);
    Paste(Resized(image, width, kImageHeight), 0, kWords, &cell);
    cells_.push_back(std::move(cell));
    scale_ = renderer->Scale();
    legend_ = scale_ ? "" : renderer->Legend();
  }
  void Finish() override {
    const Image cells = ContactSheet(cells_, {.cell_height_px = kWords + kImageHeight});
    std::vector<CaptionLine> head;
    for (const std::string& line : title_) {
      head.push_back({line});
    }
    if (!legend_.empty()) {
      head.push_back({legend_});
    }
    const int words_height = 30 + 25 * static_cast<int>(head.size());
    const int head_height = words_height + (scale_ ? ErrorLegendHeight(kLegendCap) + 10 : 0);
    Image sheet(std::max(cells.width, 560), cells.height + head_height, kInkColour);
    Paste(cells, 0, head_height, &sheet);
    DrawCaption(head, Corner::kTopLeft, 13, &sheet);
    if (scale_) DrawErrorLegend(*scale_, 14, words_height, 420, kLegendCap, &sheet);
    WriteImage(path_, sheet);
  }

 private:
  static constexpr int kImageHeight = 360, kWords = 36, kLegendCap = 11;
  std::string path_, legend_;
  std::optional<ErrorScale> scale_;
  std::vector<std::string> title_;
  std::vector<Image> cells_;
};

/// T×H×W×… arrays, filled image by image.
class ArraySink : public RenderSink {
 public:
  ArraySink(std::string path, RenderKind kind, const BodyModel& body, const Track& track,
            const std::vector<RenderStep>& steps, const FrameRendererOptions& options)
      : path_(std::move(path)), kind_(kind), body_(body), options_(options) {
    const int64_t T = static_cast<int64_t>(steps.size()), H = track.camera.height, W = track.camera.width;
    switch (kind) {
      case RenderKind::kIuv:
        Add("part", DType::kU8, 1, {T, H, W});
        Add("uv", DType::kF32, 4, {T, H, W, 2});
        break;
      case RenderKind::kParts:
        Add("part", DType::kU8, 1, {T, H, W});
        break;
      case RenderKind::kNormal:
        Add("normal", DType::kF32, 4, {T, H, W, 3});
        break;
      case RenderKind::kDepth:
        Add("depth", DType::kF32, 4, {T, H, W});
        break;
      case RenderKind::kTexture:
        Add("mask", DType::kU8, 1, {T, H, W});
        Add("rgb", DType::kU8, 1, {T, H, W, 3});
        break;
      case RenderKind::kError:
        Add("error", DType::kF32, 4, {T, H, W});
        break;
      case RenderKind::kOverlay:
        Add("rgb", DType::kU8, 1, {T, H, W, 3});
        break;
    }
    CheckSize(T, H, W);
    for (auto& [name, array] : arrays_) {
      array.bytes.assign(static_cast<size_t>(array.num_elements()) * array.item_size, '\0');
    }
    AddDescription(track, steps);
  }

  void Take(const RenderStep& step, const Image* background, FrameRenderer* renderer) override {
    const PlacedBody placed = renderer->Place(step.frame, step.turn_deg);
    const size_t pixels = size_t(placed.camera.width) * placed.camera.height;
    if (options_.new_view) {
      const CameraPose& pose = placed.view_from_camera;
      const RowMatrixXd R = pose.camera_from_world_rotation;
      std::memcpy(&arrays_.at("view_rotation").bytes[72 * count_], R.data(), 72);
      std::memcpy(&arrays_.at("view_translation").bytes[24 * count_], pose.camera_from_world_translation.data(), 24);
      if (count_ == 0) arrays_["K"] = NdArray::FromDoubles(RowMatrixXd(placed.camera.K()).data(), {3, 3});
    }
    if (kind_ == RenderKind::kOverlay || kind_ == RenderKind::kTexture) {
      const Image image = renderer->Draw(step.frame, step.turn_deg, background);
      uint8_t* rgb = reinterpret_cast<uint8_t*>(arrays_.at("rgb").bytes.data()) + 3 * pixels * count_;
      for (size_t i = 0; i < pixels; ++i) {
        for (int c = 0; c < 3; ++c) rgb[3 * i + c] = image.bgr[3 * i + 2 - c];
      }
    }
    if (kind_ == RenderKind::kError) errors_ = renderer->VertexErrors(step.frame);
    if (kind_ != RenderKind::kOverlay) Resolve(placed, pixels * count_);
    ++count_;
  }

  void Finish() override { WriteNpz(path_, arrays_); }

 private:
  void Add(const std::string& name, DType type, size_t item_size, std::vector<int64_t> shape) {
    NdArray array;
    array.dtype = type, array.item_size = item_size, array.shape = std::move(shape);
    arrays_[name] = std::move(array);
  }

  void CheckSize(int64_t T, int64_t H, int64_t W) const {
    constexpr double kLimit = 2.0 * (1 << 30);
    double bytes = 0;
    for (const auto& [name, array] : arrays_) {
      double size = static_cast<double>(array.item_size);
      for (const int64_t side : array.shape) size *= static_cast<double>(side);
      bytes += size;
    }
    if (bytes > kLimit) {
      throw std::runtime_error(Concatenate(path_, ": ", T, " images of ", W, "x", H, " would take ",
                                           std::lround(bytes / 1e6), " MB, at most ", std::lround(kLimit / 1e6),
                                           " MB fit; choose fewer frames with --frames a:b"));
    }
  }

  void AddDescription(const Track& track, const std::vector<RenderStep>& steps) {
    const auto T = static_cast<int64_t>(steps.size());
    std::vector<int32_t> frames;
    std::vector<double> times, turns;
    std::vector<uint8_t> status;
    for (const RenderStep& step : steps) {
      frames.push_back(step.frame);
      times.push_back(track.motion.timestamps[step.frame]);
      status.push_back(static_cast<uint8_t>(track.frame_status[step.frame]));
    }
    arrays_["frames"] = NdArray::FromInts32(frames.data(), {T});
    arrays_["timestamps"] = NdArray::FromDoubles(times.data(), {T});
    arrays_["frame_status"] = NdArray::FromUInt8(status.data(), {T});
    const int32_t size[2] = {track.camera.width, track.camera.height};
    arrays_["image_size"] = NdArray::FromInts32(size, {2});
    arrays_["camera_model"] = NdArray::FromString(options_.new_view ? "pinhole" : ToString(track.camera.model));
    arrays_["K"] = NdArray::FromDoubles(RowMatrixXd(track.camera.K()).data(), {3, 3});
    if (options_.new_view) {
      Add("view_rotation", DType::kF64, 8, {T, 3, 3});
      Add("view_translation", DType::kF64, 8, {T, 3});
      arrays_["view_rotation"].bytes.assign(72 * T, '\0');
      arrays_["view_translation"].bytes.assign(24 * T, '\0');
    }
  }

  void Resolve(const PlacedBody& placed, size_t first_pixel) {
    const bool has_depth = arrays_.contains("depth");
    const size_t pixels = size_t(placed.camera.width) * placed.camera.height;
    if (has_depth) {
      float* depth = reinterpret_cast<float*>(arrays_.at("depth").bytes.data()) + first_pixel;
      std::fill_n(depth, pixels, std::numeric_limits<float>::infinity());
    }
    if (kind_ == RenderKind::kError) {
      float* error = reinterpret_cast<float*>(arrays_.at("error").bytes.data()) + first_pixel;
      std::fill_n(error, pixels, std::numeric_limits<float>::quiet_NaN());
    }
    if (placed.vertices.rows() == 0) return;
    buffer_.Render(placed.vertices, body_.data().faces, placed.camera, {.num_threads = options_.num_threads});
    ResolveRequest request;
    request.num_threads = options_.num_threads;
    request.part = arrays_.contains("part");
    request.chart_uv = arrays_.contains("uv");
    request.normal = arrays_.contains("normal");
    if (request.normal) request.vertex_normals = &normals_.Compute(placed.vertices, body_.data().faces);
    request.depth = has_depth;
    if (kind_ == RenderKind::kError) request.vertex_attributes = {{errors_, 1}};
    ResolvePixels(buffer_, body_, placed.vertices, placed.camera, request, &resolved_);
    if (request.part) Copy(resolved_.part, 1, placed.camera, first_pixel, &arrays_.at("part"));
    if (request.chart_uv) Copy(resolved_.chart_uv, 2, placed.camera, first_pixel, &arrays_.at("uv"));
    if (request.normal) Copy(resolved_.normal, 3, placed.camera, first_pixel, &arrays_.at("normal"));
    if (has_depth) Copy(resolved_.depth_m, 1, placed.camera, first_pixel, &arrays_.at("depth"));
    if (kind_ == RenderKind::kError) {
      std::vector<float>& error = resolved_.vertex_attributes[0];
      for (size_t i = 0; i < error.size(); ++i) {
        if (buffer_.faces()[i] < 0) error[i] = std::numeric_limits<float>::quiet_NaN();
      }
      Copy(error, 1, placed.camera, first_pixel, &arrays_.at("error"));
    }
    if (arrays_.contains("mask")) {
      std::vector<uint8_t> mask;
      for (const int face : buffer_.faces()) mask.push_back(face >= 0 ? 1 : 0);
      Copy(mask, 1, placed.camera, first_pixel, &arrays_.at("mask"));
    }
  }

  /// Writes the buffer's box into the image that begins at first_pixel.
  template <class T>
  void Copy(const std::vector<T>& values, int channels, const Camera& camera, size_t first_pixel, NdArray* to) const {
    const PixelBox& box = buffer_.box();
    for (int y = box.y_begin; y < box.y_end; ++y) {
      const size_t from = channels * box.IndexOf(box.x_begin, y);
      const size_t at = channels * (first_pixel + size_t(y) * camera.width + box.x_begin);
      std::memcpy(to->bytes.data() + at * sizeof(T), values.data() + from, size_t(channels) * box.width() * sizeof(T));
    }
  }

  std::string path_;
  RenderKind kind_;
  const BodyModel& body_;
  FrameRendererOptions options_;
  NpzArrays arrays_;
  size_t count_ = 0;
  VisibilityBuffer buffer_;
  ResolvedPixels resolved_;
  VertexNormalsOfMesh normals_;
  std::vector<float> errors_;  // by vertex, of the current image
};

}  // namespace

std::vector<int> RenderSink::Wanted(int num_steps) const {
  std::vector<int> all(num_steps);
  std::iota(all.begin(), all.end(), 0);
  return all;
}

std::unique_ptr<RenderSink> MakeRenderSink(const std::string& path, RenderKind kind,
                                           const std::vector<std::string>& title, const BodyModel& body,
                                           const Track& track, const std::vector<RenderStep>& steps,
                                           const FrameRendererOptions& options, double fps) {
  if (path.ends_with(".mp4")) {
    return std::make_unique<VideoSink>(path, track.camera, fps);
  }
  if (path.ends_with(".png")) {
    return std::make_unique<SheetSink>(path, title);
  }
  if (path.ends_with(".npz")) {
    return std::make_unique<ArraySink>(path, kind, body, track, steps, options);
  }
  throw RequestError("--out " + path + ": expected a name that ends in .mp4, .png or .npz");
}

}  // namespace bodyloom
