// SPDX-License-Identifier: Apache-2.0
// A person of Gaussians, learned from a video and shown in any motion. docs/python.md.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "pipelines/gaussian_avatar/animate_avatar.h"
#include "pipelines/gaussian_avatar/shown_avatar.h"
#include "pipelines/gaussian_avatar/train_avatar.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/python_callbacks.h"
#include "python/track_object.h"
#include "render/gaussian_avatar/avatar_image.h"

namespace bodyloom::python {
namespace {

constexpr const char* kAvatarDoc =
    "A person learned from one video: small Gaussians on the body and on its garment, moved by any track.\n\n"
    "    people = bodyloom.run(\"clip.mp4\", out=\"people\", people=1, masks=True)\n"
    "    avatar = bodyloom.Avatar.train(\"clip.mp4\", track=\"people/person_0.npz\", mask=\"people/mask_0.npz\", "
    "out=\"run\")\n"
    "    image = avatar.show(\"dance.npz\", view_yaw=\"30\").image(0)";
constexpr const char* kTrainDoc =
    "Learns a person and leaves the run in a folder (`bodyloom train avatar`); needs no LibTorch.\n\n"
    "data: a video or folder of images with its track and the person's mask, or a single-person dataset. out: the\n"
    "folder of the run, where resume=True goes on, also after Ctrl-C or Cancelled. minutes: learn for so long in the\n"
    "place of steps. all_steps: do not end earlier where more no longer helps the frames held out. garment: look\n"
    "for a skirt, dress or coat. refine: correct the poses of the frames learned from; refined_track: file for the "
    "track with all poses corrected.\n"
    "Raises ValueError, RuntimeError naming a file, Cancelled, KeyboardInterrupt.";
constexpr const char* kShowDoc =
    "The person in a motion, to be drawn frame by frame; a garment is simulated along all of it first.\n\n"
    "view_yaw: degrees, \"30\", or \"0:360\" over the frames. freeze: where time stands still, FRAME:COUNT. size: "
    "pixels of\n"
    "the image's longer side; None: as the track's. keep_shape: the track's shape in the place of the person's.\n"
    "Raises ValueError, RuntimeError, Cancelled.";
constexpr const char* kAnimateDoc =
    "Files of the person in a motion (`bodyloom animate avatar`): out, a video; pictures, a folder of PNGs with\n"
    "transparency; report, a page in which the person turns; ply, the Gaussians at rest. background: an image, a\n"
    "video or a folder behind the person. The rest is as of show(). Files appear whole or not at all.";
constexpr const char* kShownDoc =
    "A person in a motion: Avatar.show() makes it. Two threads may share it: the second waits.";
constexpr const char* kShownImageDoc =
    "One frame: (height, width, 4) uint8, red green blue with straight alpha; a frame that the track has lost is\n"
    "transparent. Raises ValueError for a frame that there is not.";

class ShownObject {
 public:
  ShownObject(std::shared_ptr<const LearnedAvatar> avatar, ShownMotion motion, int threads,
              const PipelineCallbacks& callbacks)
      : avatar_(std::move(avatar)), shown_(*avatar_, std::move(motion), ThreadsFor(threads), callbacks) {}

  [[nodiscard]] const ShownAvatar& shown() const { return shown_; }

  py::array Draw(int frame) {
    BODYLOOM_CHECK(frame >= 0 && frame < shown_.num_frames(), "frame ", frame, " is outside the motion's ",
                   shown_.num_frames(), " frames");
    const int width = shown_.width(), height = shown_.height();
    std::vector<uint8_t> image(4 * size_t(width) * size_t(height), 0);
    if (shown_.HasResult(frame)) {
      const py::gil_scoped_release unlocked;
      const std::lock_guard<std::mutex> one_at_a_time(mutex_);
      image = WithAlpha(shown_.Draw(frame), width, height);
      for (size_t i = 0; i < image.size(); i += 4) std::swap(image[i], image[i + 2]);  // red first
    }
    return ArrayOwning(std::move(image), {height, width, 4});
  }

 private:
  std::shared_ptr<const LearnedAvatar> avatar_;
  ShownAvatar shown_;
  std::mutex mutex_;
};

class AvatarObject {
 public:
  explicit AvatarObject(LearnedAvatar avatar) : avatar_(std::make_shared<const LearnedAvatar>(std::move(avatar))) {}
  [[nodiscard]] const std::shared_ptr<const LearnedAvatar>& avatar() const { return avatar_; }
  [[nodiscard]] const AvatarFile& file() const { return avatar_->file; }

 private:
  std::shared_ptr<const LearnedAvatar> avatar_;
};

std::shared_ptr<AvatarObject> Load(const Path& run, const std::optional<Path>& body) {
  return std::make_shared<AvatarObject>(ReadLearnedAvatar(run.string(), TextOf(body)));
}

std::shared_ptr<AvatarObject> Train(const Path& data, const Path& out, const std::optional<Path>& track,
                                    const std::optional<Path>& mask, const std::optional<Path>& body, int64_t steps,
                                    std::optional<double> minutes, uint64_t seed, bool garment, bool all_steps,
                                    bool refine, const std::optional<Path>& refined_track, bool resume, int threads,
                                    const py::object& progress) {
  CheckThreads(threads);
  BODYLOOM_CHECK(steps > 0, "steps: expected a number above 0, found ", steps);
  TrainAvatarRequest request;
  request.clip.data = data.string();
  request.clip.track = TextOf(track), request.clip.mask = TextOf(mask), request.clip.body = TextOf(body);
  request.clip.threads = threads;
  request.out = out.string();
  request.steps = steps, request.minutes = PositiveOr0(minutes, "minutes"), request.seed = seed;
  request.garment = garment, request.all_steps = all_steps;
  request.refine = refine, request.refined_track = TextOf(refined_track), request.resume = resume;
  const TrainAvatarSummary summary = PythonCallbacks(progress).Run(
      [&](const PipelineCallbacks& callbacks) { return TrainAvatar(request, callbacks); });
  if (summary.stopped) throw Cancelled();
  return Load(out, body);
}

void CheckSize(std::optional<int> size) {
  BODYLOOM_CHECK(!size || *size >= 2, "size: expected at least 2 pixels, found ", size.value_or(0));
}

std::shared_ptr<ShownObject> Show(const AvatarObject& self, const TrackArgument& argument, const std::string& view_yaw,
                                  const std::string& freeze, std::optional<int> size, bool keep_shape, int threads,
                                  const py::object& progress) {
  CheckThreads(threads);
  CheckSize(size);
  const std::shared_ptr<TrackObject> track = TrackFrom(argument);
  ShownMotion motion{.track = track->track,
                     .where = track->name,
                     .keeps_shape = keep_shape,
                     .view_yaw = view_yaw,
                     .freeze = freeze,
                     .size = size.value_or(0)};
  return PythonCallbacks(progress).Run([&](const PipelineCallbacks& callbacks) {
    return std::make_shared<ShownObject>(self.avatar(), std::move(motion), threads, callbacks);
  });
}

void Animate(const AvatarObject& self, const TrackArgument& argument, const std::optional<Path>& out,
             const std::optional<Path>& images, const std::optional<Path>& report, const std::optional<Path>& ply,
             const std::optional<Path>& background, const std::string& view_yaw, const std::string& freeze,
             std::optional<int> size, bool keep_shape, int threads, const py::object& progress) {
  CheckThreads(threads);
  CheckSize(size);
  BODYLOOM_CHECK(out || images || report || ply, "out, pictures, report, ply: nothing is to be written");
  const std::shared_ptr<TrackObject> track = TrackFrom(argument);
  AnimateAvatarRequest request;
  request.motion = &track->track;
  request.track = track->name;
  request.out = TextOf(out), request.pictures = TextOf(images), request.report = TextOf(report);
  request.ply = TextOf(ply), request.background = TextOf(background);
  request.view_yaw = view_yaw, request.freeze = freeze, request.size = size.value_or(0);
  request.shape_of_track = keep_shape;
  request.threads = threads;
  PythonCallbacks(progress).Run(
      [&](const PipelineCallbacks& callbacks) { AnimateLearnedAvatar(*self.avatar(), request, callbacks); });
}

}  // namespace

void BindAvatar(py::module_& module) {
  py::class_<ShownObject, std::shared_ptr<ShownObject>>(module, "ShownAvatar", kShownDoc)
      .def("image", &ShownObject::Draw, py::arg("frame"), kShownImageDoc)
      .def_property_readonly(
          "width", [](const ShownObject& self) { return self.shown().width(); }, "Pixels.")
      .def_property_readonly(
          "height", [](const ShownObject& self) { return self.shown().height(); }, "Pixels.")
      .def("__len__", [](const ShownObject& self) { return self.shown().num_frames(); });
  py::class_<AvatarObject, std::shared_ptr<AvatarObject>>(module, "Avatar", kAvatarDoc)
      .def_static("train", &Train, py::arg("data"), py::kw_only(), py::arg("out"), py::arg("track") = py::none(),
                  py::arg("mask") = py::none(), py::arg("body") = py::none(),
                  py::arg("steps") = TrainAvatarRequest().steps, py::arg("minutes") = py::none(), py::arg("seed") = 1,
                  py::arg("garment") = true, py::arg("all_steps") = false, py::arg("refine") = false,
                  py::arg("refined_track") = py::none(), py::arg("resume") = false, py::arg("threads") = 0,
                  py::arg("progress") = py::none(), kTrainDoc)
      .def_static("load", &Load, py::arg("run"), py::kw_only(), py::arg("body") = py::none(),
                  "The person of a run's folder, or of its avatar.npz. Raises RuntimeError naming the file.")
      .def("show", &Show, py::arg("track"), py::kw_only(), py::arg("view_yaw") = "", py::arg("freeze") = "",
           py::arg("size") = py::none(), py::arg("keep_shape") = false, py::arg("threads") = 0,
           py::arg("progress") = py::none(), kShowDoc)
      .def("animate", &Animate, py::arg("track"), py::kw_only(), py::arg("out") = py::none(),
           py::arg("pictures") = py::none(), py::arg("report") = py::none(), py::arg("ply") = py::none(),
           py::arg("background") = py::none(), py::arg("view_yaw") = "", py::arg("freeze") = "",
           py::arg("size") = py::none(), py::arg("keep_shape") = false, py::arg("threads") = 0,
           py::arg("progress") = py::none(), kAnimateDoc)
      .def_property_readonly(
          "gaussians", [](const AvatarObject& self) { return self.file().body.size(); }, "How many there are.")
      .def_property_readonly(
          "has_garment", [](const AvatarObject& self) { return self.file().garment.has_value(); },
          "Whether a skirt, dress or coat is simulated.")
      .def_property_readonly(
          "betas",
          [](const py::object& self) { return MatrixView(self.cast<const AvatarObject&>().file().betas, self); },
          "(B,) view: the person's shape.")
      .def("__repr__", [](const AvatarObject& self) {
        return Concatenate("Avatar(", self.avatar()->run, ", ", self.file().body.size(), " Gaussians)");
      });
}

}  // namespace bodyloom::python
