// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "data_tools/video/image_file.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/scene/track.h"
#include "pipelines/render/render_track.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/python_callbacks.h"
#include "python/track_object.h"

namespace bodyloom::python {
namespace {

constexpr const char* kRendererDoc =
    R"(Draws frames of a track as its camera saw them, or from a camera that follows the person.

what           "overlay", "iuv", "parts", "normal", "depth", "texture" or "error"
view_yaw_deg   a camera that follows the person; 90: from its left when it faces the camera; None: the track's own
texture        for "texture": laid out in the body's atlas; uint8 (H, W, 3), red green blue, or a file
truth          for "error": the Track to compare with, in millimetres up to error_maximum (None: 50)
threads        0: one a core; images are the same for any number
Two threads may share it: the second waits. Raises ValueError for arguments that do not go together, RuntimeError when
the track is not the body's.)";

constexpr const char* kImageDoc = R"(One frame: (height, width, 3) uint8, red green blue.

background  uint8 of that shape under the body; None: a studio for overlays, else one colour
turn_deg    turns the camera of view_yaw_deg further
A frame that the track has lost shows no body. Raises ValueError for a frame that there is not, or another background.)";

constexpr const char* kRenderDoc = R"(Pictures of a track, in memory or in a file.

frames     one frame gives (height, width, 3) uint8, red green blue; (begin, end) gives (N, height, width, 3) of the
           frames before end; None: all
out        .mp4, .png (a contact sheet) or .npz (arrays, as `bodyloom render`): written whole or not at all, and
           nothing is returned
video      with out: what the person was filmed with, as background
turntable  with out: the camera makes one full turn over the frames
texture    with out: a file
Other arguments as of Renderer(). Raises ValueError, RuntimeError naming a file, KeyboardInterrupt on Ctrl-C.)";

using FramesArgument = std::variant<int, std::pair<int, int>>;
using TextureArgument = std::variant<py::array, Path>;

struct RendererArguments {
  std::string what;
  std::optional<double> view_yaw_deg;
  std::optional<TextureArgument> texture;
  std::optional<TrackArgument> truth;
  std::optional<double> error_maximum;
  int threads = 0;
};

class RendererObject {
 public:
  RendererObject(std::shared_ptr<TrackObject> track, std::shared_ptr<const BodyModel> body,
                 const RendererArguments& arguments)
      : track_(std::move(track)), body_(std::move(body)) {
    RequireTrackFitsBody(track_->track, *body_, track_->name);
    FrameRendererOptions options;
    options.kind = RenderKindFromString(arguments.what);
    BODYLOOM_CHECK((options.kind == RenderKind::kTexture) == arguments.texture.has_value(),
                   "texture: goes with what=\"texture\", and with nothing else");
    BODYLOOM_CHECK((options.kind == RenderKind::kError) == arguments.truth.has_value(),
                   "truth: goes with what=\"error\", and with nothing else");
    if (arguments.texture) {
      const auto* path = std::get_if<Path>(&*arguments.texture);
      const Image texture =
          path != nullptr ? ReadImage(path->string()) : ImageFrom(std::get<py::array>(*arguments.texture), "texture");
      texels_ = TexelsOf(texture);
      options.texture = {texels_, texture.width, texture.height, 3};
    }
    if (arguments.truth) {
      truth_ = TrackFrom(*arguments.truth);
      RequireTrackFitsBody(truth_->track, *body_, truth_->name);
      BODYLOOM_CHECK(truth_->track.num_frames() == track_->track.num_frames(), "truth: ", truth_->track.num_frames(),
                     " frames, expected the track's ", track_->track.num_frames());
      options.truth = &truth_->track;
    }
    options.error_maximum = arguments.error_maximum.value_or(50);
    BODYLOOM_CHECK(options.error_maximum > 0, "error_maximum: expected a number above 0, found ",
                   options.error_maximum);
    options.new_view = arguments.view_yaw_deg.has_value();
    options.view_yaw_deg = arguments.view_yaw_deg.value_or(0);
    options.turntable = options.new_view;
    CheckThreads(arguments.threads);
    options.num_threads = ThreadsFor(arguments.threads);
    has_new_view_ = options.new_view;
    renderer_ = std::make_unique<FrameRenderer>(*body_, track_->track, options, track_->name);
    if (options.kind == RenderKind::kDepth) SetDepthRange();
  }

  [[nodiscard]] int num_frames() const { return track_->track.num_frames(); }
  [[nodiscard]] int width() const { return track_->track.camera.width; }
  [[nodiscard]] int height() const { return track_->track.camera.height; }
  [[nodiscard]] std::string Legend() const { return renderer_->Legend(); }

  void RequireFrame(int frame) const {
    BODYLOOM_CHECK(frame >= 0 && frame < num_frames(), "frame ", frame, " is outside the track's ", num_frames(),
                   " frames");
  }

  py::array DrawFrame(int frame, const py::object& background, double turn_deg) {
    RequireFrame(frame);
    BODYLOOM_CHECK(turn_deg == 0 || has_new_view_, "turn_deg: turns the camera of view_yaw_deg, which was not given");
    std::optional<Image> behind;
    if (!background.is_none()) {
      behind = ImageFrom(background, "background");
      BODYLOOM_CHECK(behind->width == width() && behind->height == height(), "background: expected shape (", height(),
                     ", ", width(), ", 3), found shape (", behind->height, ", ", behind->width, ", 3)");
    }
    Image image;
    {
      const py::gil_scoped_release unlocked;
      image = Draw(frame, turn_deg, behind ? &*behind : nullptr);
    }
    return ArrayFromImage(std::move(image));
  }

  /// Without the interpreter's lock.
  Image Draw(int frame, double turn_deg, const Image* background) {
    const std::lock_guard<std::mutex> one_at_a_time(mutex_);
    return renderer_->Draw(frame, turn_deg, background);
  }

 private:
  void SetDepthRange() {
    std::vector<int> frames(static_cast<size_t>(num_frames()));
    for (int t = 0; t < num_frames(); ++t) frames[size_t(t)] = t;
    renderer_->SetDepthRange(frames);
  }

  std::shared_ptr<TrackObject> track_, truth_;
  std::shared_ptr<const BodyModel> body_;
  std::vector<float> texels_;
  bool has_new_view_ = false;
  std::mutex mutex_;
  std::unique_ptr<FrameRenderer> renderer_;
};

py::array RenderInMemory(RendererObject* renderer, std::pair<int, int> frames, const py::object& progress) {
  const auto [first, end] = frames;
  BODYLOOM_CHECK(first >= 0 && first < end && end <= renderer->num_frames(),
                 "frames: expected (begin, end) within (0, ", renderer->num_frames(), "), found (", first, ", ", end,
                 ")");
  const py::ssize_t row = py::ssize_t(3) * renderer->width() * renderer->height();
  py::array_t<uint8_t> images(
      {py::ssize_t(end - first), py::ssize_t(renderer->height()), py::ssize_t(renderer->width()), py::ssize_t(3)});
  uint8_t* out = images.mutable_data();
  PythonCallbacks(progress).Run([&, first = first, end = end](const PipelineCallbacks& callbacks) {
    for (int t = first; t < end; ++t) {
      callbacks.Update("draw", double(t - first) / (end - first));
      const Image image = renderer->Draw(t, 0, nullptr);
      uint8_t* rgb = out + (t - first) * row;
      for (py::ssize_t i = 0; i < row; i += 3) {
        rgb[i] = image.bgr[size_t(i) + 2], rgb[i + 1] = image.bgr[size_t(i) + 1], rgb[i + 2] = image.bgr[size_t(i)];
      }
    }
  });
  return images;
}

/// "a:b", or "" for all.
std::string RangeText(const std::optional<FramesArgument>& frames) {
  if (!frames) return "";
  if (const int* frame = std::get_if<int>(&*frames)) return std::to_string(*frame);
  const auto [first, end] = std::get<std::pair<int, int>>(*frames);
  return Concatenate(first, ":", end);
}

void RenderToFile(const TrackObject& track, const BodyModel& body, const RendererArguments& arguments,
                  const py::object& progress, RenderTrackRequest request) {
  request.track = track.name;
  request.what = RenderKindFromString(arguments.what);
  request.view_yaw_deg = arguments.view_yaw_deg;
  if (arguments.texture) {
    BODYLOOM_CHECK(std::holds_alternative<Path>(*arguments.texture), "texture: with out it is a file, found an array");
    request.texture = std::get<Path>(*arguments.texture).string();
  }
  request.error_maximum = arguments.error_maximum.value_or(0);
  request.num_threads = arguments.threads;
  std::shared_ptr<TrackObject> truth;
  if (arguments.truth) {
    truth = TrackFrom(*arguments.truth);
    request.truth = truth->name;
  }
  PythonCallbacks(progress).Run([&](const PipelineCallbacks& callbacks) {
    RenderTrack(request, body, track.track, truth ? &truth->track : nullptr, callbacks);
  });
}

}  // namespace

void BindRendering(py::module_& module) {
  py::class_<RendererObject>(module, "Renderer", kRendererDoc)
      .def(py::init([](const TrackArgument& track_argument, const std::string& what,
                       const std::optional<BodyArgument>& body, std::optional<double> view_yaw_deg,
                       const std::optional<TextureArgument>& texture, const std::optional<TrackArgument>& truth,
                       std::optional<double> error_maximum, int threads) {
             std::shared_ptr<TrackObject> track = TrackFrom(track_argument);
             std::shared_ptr<const BodyModel> body_model = BodyOf(*track, body);
             return std::make_unique<RendererObject>(
                 std::move(track), std::move(body_model),
                 RendererArguments{what, view_yaw_deg, texture, truth, error_maximum, threads});
           }),
           py::arg("track"), py::arg("what") = "overlay", py::kw_only(), py::arg("body") = py::none(),
           py::arg("view_yaw_deg") = py::none(), py::arg("texture") = py::none(), py::arg("truth") = py::none(),
           py::arg("error_maximum") = py::none(), py::arg("threads") = 0)
      .def("image", &RendererObject::DrawFrame, py::arg("frame"), py::kw_only(), py::arg("background") = py::none(),
           py::arg("turn_deg") = 0.0, kImageDoc)
      .def_property_readonly("width", &RendererObject::width, "Of the images, pixels.")
      .def_property_readonly("height", &RendererObject::height, "Of the images, pixels.")
      .def_property_readonly("legend", &RendererObject::Legend, "What the colours mean; \"\" where they say it.")
      .def("__len__", &RendererObject::num_frames);
  module.def(
      "render",
      [](const TrackArgument& track_argument, const std::optional<FramesArgument>& frames,
         const std::optional<Path>& out, const std::string& what, const std::optional<BodyArgument>& body,
         const std::optional<Path>& video, std::optional<double> view_yaw_deg, bool turntable,
         const std::optional<TextureArgument>& texture, const std::optional<TrackArgument>& truth,
         std::optional<double> error_maximum, int threads, const py::object& progress) -> py::object {
        const std::shared_ptr<TrackObject> track = TrackFrom(track_argument);
        const std::shared_ptr<const BodyModel> body_model = BodyOf(*track, body);
        const RendererArguments arguments{what, view_yaw_deg, texture, truth, error_maximum, threads};
        if (out) {
          RenderTrackRequest request;
          request.out = out->string();
          request.video = TextOf(video);
          request.frames = RangeText(frames);
          request.turntable = turntable;
          RenderToFile(*track, *body_model, arguments, progress, request);
          return py::none();
        }
        BODYLOOM_CHECK(!video && !turntable, "video and turntable are of files: give out");
        RendererObject renderer(track, body_model, arguments);
        if (!frames) return RenderInMemory(&renderer, {0, renderer.num_frames()}, progress);
        if (const int* frame = std::get_if<int>(&*frames)) return renderer.DrawFrame(*frame, py::none(), 0);
        return RenderInMemory(&renderer, std::get<std::pair<int, int>>(*frames), progress);
      },
      py::arg("track"), py::arg("frames") = py::none(), py::kw_only(), py::arg("out") = py::none(),
      py::arg("what") = "overlay", py::arg("body") = py::none(), py::arg("video") = py::none(),
      py::arg("view_yaw_deg") = py::none(), py::arg("turntable") = false, py::arg("texture") = py::none(),
      py::arg("truth") = py::none(), py::arg("error_maximum") = py::none(), py::arg("threads") = 0,
      py::arg("progress") = py::none(), kRenderDoc);
}

}  // namespace bodyloom::python
