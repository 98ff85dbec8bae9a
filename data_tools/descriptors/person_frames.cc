// SPDX-License-Identifier: Apache-2.0
#include "data_tools/descriptors/person_frames.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>

#include "data_tools/descriptors/describe_track.h"
#include "data_tools/formats/ndarray.h"
#include "data_tools/formats/npy_stream.h"
#include "geometry/base/check.h"
#include "geometry/scene/observations.h"
#include "geometry/scene/track_edits.h"
#include "render/raster/resolve_pixels.h"
#include "render/raster/visibility_buffer.h"
#include "render/uv_maps/posed_track.h"

namespace bodyloom {
namespace {

namespace fs = std::filesystem;
using Eigen::Matrix3f;
using Eigen::Vector3f;

/// FloatFromHalf by table: every frame decodes half a million values.
class HalfTable {
 public:
  HalfTable() : values_(1 << 16) {
    for (uint32_t half = 0; half < values_.size(); ++half) values_[half] = FloatFromHalf(static_cast<uint16_t>(half));
  }
  float operator[](uint16_t half) const { return values_[half]; }

 private:
  std::vector<float> values_;
};

/// A file that is gone when this is.
struct ScratchFile {
  fs::path path;
  ~ScratchFile() {
    std::error_code ignored;
    fs::remove(path, ignored);
    fs::remove(DescriptorHeaderPath(path.string()), ignored);
  }
};

fs::path ScratchPath(const std::string& folder) {
  static std::atomic<int> count{0};
  const fs::path place = folder.empty() ? fs::temp_directory_path() : fs::path(folder);
  return place / ("motion_maps_" + std::to_string(getpid()) + "_" + std::to_string(count++) + ".npy");
}

/// Turns the vectors whose components are three planes of `count` values.
void TurnMap(const Matrix3f& turn, size_t count, float* planes) {
  for (size_t i = 0; i < count; ++i) {
    const Vector3f v = turn * Vector3f(planes[i], planes[count + i], planes[2 * count + i]);
    for (int c = 0; c < 3; ++c) planes[count * c + i] = v[c];
  }
}

}  // namespace

class PersonFrames::Impl {
 public:
  Impl(const BodyModel& body, const Track& track, const PersonFramesOptions& options)
      : body_(body),
        track_(track),
        options_(options),
        reordered_(options.shown.empty() ? std::nullopt : std::optional(FramesInOrder(track, options.shown))),
        shown_(reordered_ ? *reordered_ : track),
        posed_(body, shown_, options.yaw_deg) {
    BODYLOOM_CHECK(options.uv_size > 0 && options.past >= 0, "person frames: UV maps of ", options.uv_size, ", past ",
                   options.past);
    window_ =
        PlanPersonWindow(posed_.Extents(options.num_threads), track.camera.width, track.camera.height, options.window);
    Describe();
  }

  void MotionMaps(int t, std::span<float> maps) const {
    const size_t map = 3 * Texels();
    BODYLOOM_CHECK(maps.size() == map * (1 + options_.past), "person frames: room for ", maps.size(),
                   " values, expected ", map * (1 + options_.past));
    static const HalfTable half;
    std::fill(maps.begin(), maps.end(), 0.0F);
    if (!shown_.HasResult(t)) return;
    const int now = InTrack(t);
    const uint16_t* normals = Stored(now, 0);
    for (size_t i = 0; i < map; ++i) maps[i] = half[normals[i]];
    const Matrix3f turn = TurnOfAxes(t).cast<float>();
    const bool turned = posed_.turned() && options_.motion.frame != SurfaceFrame::kBody;
    if (turned) TurnMap(turn, Texels(), maps.data());
    for (int k = 0; k < options_.past; ++k) {
      const int s = now - k;
      if (s < 0 || segment_[s] < 0 || segment_[s] != segment_[now]) continue;
      float* to = &maps[map * (1 + k)];
      const uint16_t* from = Stored(s, 1);
      constexpr auto kScale = static_cast<float>(1 / kBodyLength);
      for (size_t i = 0; i < map; ++i) to[i] = kScale * half[from[i]];
      if (turned) TurnMap(turn, Texels(), to);
      for (size_t i = 0; i < map; ++i) to[i] = std::clamp(to[i], -kMaxSpeed, kMaxSpeed);
    }
  }

  void BodyMaps(int t, std::span<float> uv, std::span<float> mask) const {
    const size_t area = size_t(window_.width) * window_.height;
    BODYLOOM_CHECK(uv.size() == 2 * area && mask.size() == area, "person frames: room for ", uv.size(), " and ",
                   mask.size(), " values, expected ", 2 * area, " and ", area);
    std::fill(uv.begin(), uv.end(), 0.0F);
    std::fill(mask.begin(), mask.end(), 0.0F);
    if (!shown_.HasResult(t)) return;
    ResolveRequest request;
    request.atlas_uv = true;
    VisibilityBuffer buffer;
    const ResolvedPixels pixels = Resolve(t, request, &buffer);
    ForSeenPixels(pixels, buffer, [&](size_t at, size_t from) {
      uv[at] = pixels.atlas_uv[2 * from];
      uv[area + at] = pixels.atlas_uv[2 * from + 1];
      mask[at] = 1;
    });
  }

  [[nodiscard]] BodySurface Surface(int t) const {
    const size_t area = size_t(window_.width) * window_.height;
    BodySurface surface = {window_.width, window_.height, std::vector<uint8_t>(area), std::vector<float>(3 * area)};
    if (!shown_.HasResult(t)) return surface;
    ResolveRequest request;
    request.part = request.normal = true;
    VisibilityBuffer buffer;
    const ResolvedPixels pixels = Resolve(t, request, &buffer);
    ForSeenPixels(pixels, buffer, [&](size_t at, size_t from) {
      surface.parts[at] = pixels.part[from];
      for (size_t c = 0; c < 3; ++c) surface.normals[area * c + at] = pixels.normal[3 * from + c];
    });
    return surface;
  }

  [[nodiscard]] Eigen::Matrix<double, Eigen::Dynamic, 2> Keypoints(int t) const {
    const std::vector<std::string>& names = CocoNames();
    Eigen::Matrix<double, Eigen::Dynamic, 2> pixels(names.size(), 2);
    pixels.fill(std::numeric_limits<double>::quiet_NaN());
    if (!shown_.HasResult(t)) return pixels;
    const MatrixX3d points = posed_.Landmarks(t, names);
    const Camera camera = CameraInWindow(shown_.CameraAt(t), window_, t);
    for (Eigen::Index k = 0; k < points.rows(); ++k) {
      Eigen::Vector2d pixel;
      if (camera.Project(points.row(k).transpose(), &pixel)) pixels.row(k) = pixel.transpose();
    }
    return pixels;
  }

  [[nodiscard]] const PersonWindow& window() const { return window_; }
  [[nodiscard]] const PersonFramesOptions& options() const { return options_; }
  [[nodiscard]] const Track& track() const { return shown_; }
  [[nodiscard]] int Segment(int t) const { return segment_.at(InTrack(t)); }

 private:
  /// Resolves the body's surface at the pixels of frame t's window.
  ResolvedPixels Resolve(int t, const ResolveRequest& request, VisibilityBuffer* buffer) const {
    const MatrixX3d vertices = posed_.Vertices(t);
    const Camera camera = CameraInWindow(shown_.CameraAt(t), window_, t);
    buffer->Render(vertices, body_.data().faces, camera);
    ResolvedPixels pixels;
    ResolvePixels(*buffer, body_, vertices, camera, request, &pixels);
    return pixels;
  }

  /// take(place in the window, place in the resolved box) for every pixel that shows the body.
  template <typename Take>
  void ForSeenPixels(const ResolvedPixels& pixels, const VisibilityBuffer& buffer, const Take& take) const {
    const PixelBox& box = pixels.box;
    for (int y = box.y_begin; y < box.y_end; ++y) {
      for (int x = box.x_begin; x < box.x_end; ++x) {
        if (buffer.FaceAt(x, y) >= 0) take(size_t(y) * window_.width + x, box.IndexOf(x, y));
      }
    }
  }

  [[nodiscard]] size_t Texels() const { return size_t(options_.uv_size) * options_.uv_size; }

  [[nodiscard]] int InTrack(int t) const { return options_.shown.empty() ? t : options_.shown.at(t); }

  /// Frame t's rotation of the view in the axes of the maps, as a rotation of the body in front of a fixed camera.
  [[nodiscard]] Eigen::Matrix3d TurnOfAxes(int t) const {
    if (options_.motion.frame != SurfaceFrame::kWorld) return posed_.Turn(t);
    const Eigen::Matrix3d& camera_from_world = options_.motion.camera_pose.camera_from_world_rotation;
    return camera_from_world.transpose() * posed_.Turn(t) * camera_from_world;
  }

  /// The track's frame t: normals (0) or velocities (1), half precision.
  [[nodiscard]] const uint16_t* Stored(int t, int which) const {
    return &stored_->Values<uint16_t>()[3 * Texels() * (2 * static_cast<size_t>(t) + which)];
  }

  void Describe() {
    DescribeTrackOptions describe;
    static_cast<SurfaceMotion&>(describe) = options_.motion;
    describe.texels.width = describe.texels.height = options_.uv_size;
    describe.past = 1;  // earlier velocity maps are stored with their own frames and combined on request
    describe.half = true;
    describe.num_threads = options_.num_threads;
    const ScratchFile file{ScratchPath(options_.scratch_dir)};
    DescribeTrack(body_, track_, file.path.string(), describe);
    stored_.emplace(file.path.string(), DType::kF16);
    std::vector<char> usable(track_.num_frames());
    for (int t = 0; t < track_.num_frames(); ++t) usable[t] = track_.HasResult(t);
    for (const VelocityStencil& stencil : VelocityStencils(track_.motion.timestamps, usable, describe.velocity)) {
      segment_.push_back(stencil.segment);
    }
  }

  const BodyModel& body_;
  const Track& track_;
  PersonFramesOptions options_;
  std::optional<Track> reordered_;  ///< by options_.shown
  const Track& shown_;
  PosedTrack posed_;
  PersonWindow window_;
  std::optional<MappedNpy> stored_;  ///< normals and velocities of each frame; the file is unlinked
  std::vector<int> segment_;         ///< gap-free run of each frame of the track, −1: none
};

PersonFrames::PersonFrames(const BodyModel& body, const Track& track, const PersonFramesOptions& options)
    : impl_(std::make_unique<Impl>(body, track, options)) {}
PersonFrames::~PersonFrames() = default;

const Track& PersonFrames::track() const { return impl_->track(); }
int PersonFrames::num_frames() const { return impl_->track().num_frames(); }
int PersonFrames::Segment(int t) const { return impl_->Segment(t); }
int PersonFrames::channels() const { return 3 + 3 * impl_->options().past; }
const PersonWindow& PersonFrames::window() const { return impl_->window(); }
const PersonFramesOptions& PersonFrames::options() const { return impl_->options(); }
void PersonFrames::MotionMaps(int t, std::span<float> maps) const { impl_->MotionMaps(t, maps); }
Eigen::Matrix<double, Eigen::Dynamic, 2> PersonFrames::Keypoints(int t) const { return impl_->Keypoints(t); }
BodySurface PersonFrames::Surface(int t) const { return impl_->Surface(t); }
void PersonFrames::BodyMaps(int t, std::span<float> uv, std::span<float> mask) const { impl_->BodyMaps(t, uv, mask); }

}  // namespace bodyloom
