// SPDX-License-Identifier: Apache-2.0
#include "pipelines/photo_avatar/animate_person.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <utility>

#include "data_tools/body/builtin_body.h"
#include "data_tools/motion/motion_tools.h"
#include "data_tools/motion/track_io.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/video_writer.h"
#include "geometry/base/check.h"
#include "geometry/base/parallel.h"
#include "geometry/base/percentile.h"
#include "geometry/body/hand_skeleton.h"
#include "geometry/cloth/body_with_garment.h"
#include "geometry/scene/rig.h"
#include "geometry/scene/track_edits.h"
#include "pipelines/animate/animation_limits.h"
#include "pipelines/animate/background.h"
#include "pipelines/animate/relight_frames.h"
#include "pipelines/body_of_track.h"
#include "pipelines/files.h"
#include "pipelines/photo_avatar/person_folder.h"
#include "pipelines/report_json.h"
#include "render/garment/person_cloth.h"
#include "render/photo_avatar/draw_person.h"
#include "render/photo_avatar/transfer_clothes.h"
#include "render/uv_maps/posed_track.h"
#include "render/view/view_camera.h"

namespace bodyloom {
namespace {

/// Throws std::runtime_error naming the file, also for what only the frames of a run can be asked.
ShownLight OtherLight(const std::string& path) {
  const RelightRequest request = ReadRelight(path);
  if (!request.estimate || request.encoding != PixelEncoding::kSrgb) {
    throw std::runtime_error(path +
                             ": has \"estimate\": false or \"encoding\": \"linear\", which a person from photos "
                             "cannot be given: photos are sRGB, and their light is taken away by itself");
  }
  return {request.light, ShadingLimits{}};
}

class PersonAnimation {
 public:
  PersonAnimation(const AnimatePersonRequest& request, const PipelineCallbacks& callbacks)
      : request_(request), callbacks_(callbacks), threads_(ThreadsFor(request.threads)) {}

  AnimatePersonSummary Run() {
    CheckRequest();
    if (!request_.track.empty())
      track_ = ReadTrack(request_.track, MovingCamera::kTake);  // before the person, who takes longer to make
    // Fingers of the motion move those of a person who is made now, but for one who wears what was kept without them.
    const bool chooses_body = request_.photos.fit.body.empty() && !std::filesystem::is_directory(request_.garment_from);
    if (request_.person.empty() && chooses_body && track_.motion.body == BuiltinBodyWithHands().name()) {
      request_.photos.fit.body = kBodyWithHands;
    }
    std::optional<ShownLight> light;
    if (!request_.relight.empty()) light = OtherLight(request_.relight);
    clock_.Begin("person");
    person_ = request_.person.empty() ? MakePhotoPerson(request_.photos, callbacks_)
                                      : ReadPhotoPerson(request_.person, request_.photos.fit.body);
    if (!request_.garment_from.empty()) {
      clock_.Begin("clothes");
      WearClothes();
    }
    if (!request_.keep.empty()) WritePhotoPerson(request_.keep, person_);
    if (light) person_.light = *light;
    if (!request_.track.empty()) {
      clock_.Begin("prepare");
      OpenTrack();
      if (Draws()) {
        clock_.Begin("draw");
        DrawFrames();
      }
    }
    return Finish();
  }

 private:
  [[nodiscard]] bool Draws() const { return !request_.out.empty() || !request_.pictures.empty(); }

  void CheckRequest() const {
    if (request_.person.empty() == request_.photos.images.empty()) {
      throw RequestError("expected photos (--image) or a person who was kept (--kept), one of them");
    }
    const bool shows = Draws() || !request_.moved_track.empty();
    if (request_.track.empty() && shows) throw RequestError("--track is required: the motion");
    if (request_.track.empty() && request_.keep.empty()) {
      throw RequestError("expected --track, the motion, or --keep, a folder to keep the person in");
    }
    if (!request_.track.empty() && !shows) throw RequestError("expected --out, --pictures or --moved-track");
    std::vector<std::string> inputs = request_.photos.images;
    for (const std::string& image : inputs) RequireReadable(image, "image");
    inputs.insert(inputs.end(), {request_.track, request_.background, request_.relight, request_.photos.fit.body,
                                 request_.garment_from});
    RequireReadable(request_.track, "track");
    RequireReadable(request_.background, "background");
    RequireReadable(request_.relight, "light");
    RequireReadable(request_.garment_from, "clothes");
    std::vector<std::string> outputs = {request_.out, request_.moved_track, request_.json};
    for (const std::string& path : outputs) RequireWritable(path);
    if (!request_.keep.empty()) {
      const std::vector<std::string> kept =
          PhotoPersonFiles(request_.keep, static_cast<int>(request_.photos.images.size()));
      outputs.insert(outputs.end(), kept.begin(), kept.end());
    }
    RequireDistinct(inputs, outputs);
    if (!request_.keep.empty()) RequireWritableFolder(request_.keep);
    if (!request_.pictures.empty()) RequireWritableFolder(request_.pictures);
  }

  void WearClothes() {
    const std::string& from = request_.garment_from;
    PhotoPersonRequest photo = request_.photos;
    photo.images = {from};
    photo.fit.person = 0;
    if (photo.fit.body.empty() && HasFingers(*person_.bare)) photo.fit.body = kBodyWithHands;
    const PhotoPerson other = std::filesystem::is_directory(from) ? ReadPhotoPerson(from, photo.fit.body)
                                                                  : MakePhotoPerson(photo, callbacks_);
    try {
      person_ = TransferClothes(person_, other);
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(from + ": " + error.what());
    }
  }

  void OpenTrack() {
    try {
      track_ = MovedByPerson(person_, WithStillCamera(*person_.body, TrackOnBody(*person_.body, std::move(track_))),
                             request_.own_stature ? PersonPlacing::kInScene : PersonPlacing::kInImage);
      if (!person_.garment.empty() && Draws()) cloth_.emplace(*person_.clothed, person_.garment, track_);
      if (!request_.moved_track.empty()) WriteTrack(request_.moved_track, track_);
      int first = 0, last = track_.num_frames() - 1;
      if (!request_.freeze.empty()) {
        const Freeze freeze = ReadFreeze(request_.freeze, track_.num_frames());
        order_ = FrozenAt(track_.num_frames(), freeze.frame, freeze.count);
        track_ = FramesInOrder(track_, order_);
        first = freeze.frame, last = freeze.frame + freeze.count;
      }
      // A background may be the track's own video, whose straight lines the lens bends, too.
      if (request_.background.empty()) track_.camera.distortion = {};
      const int longer = std::max(track_.camera.width, track_.camera.height);
      scale_ = request_.size > 0 && longer > 0 ? static_cast<double>(request_.size) / longer : 1;
      posed_.emplace(*person_.body, track_, ViewAngles(request_.view_yaw, track_.num_frames(), first, last));
    } catch (const RequestError&) {
      throw;
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(request_.track + ": " + error.what());
    }
    const Camera camera = CameraAt(0);
    width_ = camera.width, height_ = camera.height;
    if (width_ < 2 || height_ < 2 || std::max(width_, height_) > kLongestImageSide) {
      throw std::runtime_error(Concatenate(request_.track, ": images of ", width_, "x", height_,
                                           ", expected sides of 2 to ", kLongestImageSide));
    }
    frames_.emplace(person_, std::min(threads_, std::max(1, track_.num_frames())));
  }

  [[nodiscard]] Camera CameraAt(int t) const {
    return scale_ == 1 ? track_.CameraAt(t) : ScaledCamera(track_.CameraAt(t), scale_);
  }

  /// None in a frame without a result.
  MatrixX3d VerticesAt(int t) {
    MatrixX3d vertices;
    if (track_.HasResult(t)) vertices = posed_->Vertices(t);
    if (!cloth_) return vertices;
    const std::vector<Eigen::Vector3d>& places = cloth_->At(order_.empty() ? t : order_[t]);
    if (vertices.rows() == 0) return vertices;
    PlaceGarment(person_.garment, places, &vertices);
    const auto drawn = static_cast<Eigen::Index>(person_.garment.drawn_from.size());
    vertices.bottomRows(drawn) = posed_->Turned(t, vertices.bottomRows(drawn));
    return vertices;
  }

  void DrawFrames() {
    const int count = track_.num_frames();
    Background background(request_.background, width_, height_);
    const double fps = FrameRateWithoutGaps(track_.motion);
    std::unique_ptr<VideoWriter> video;
    if (!request_.out.empty()) {
      video = std::make_unique<VideoWriter>(request_.out, width_, height_, fps > 0 ? fps : kFpsWithoutTimes);
    }
    std::vector<double> draw_ms;
    // The first frame alone: somebody waits for it.
    for (int first = 0, next = 1; first < count; first = next, next = std::min(count, next + frames_->at_once())) {
      callbacks_.Update("drawing", static_cast<double>(first) / count);
      const Stopwatch watch;
      std::vector<PersonPose> poses;
      for (int t = first; t < next; ++t) poses.push_back({VerticesAt(t), CameraAt(t)});
      const std::vector<DrawnPerson> drawn = frames_->Draw(poses);
      draw_ms.push_back(1e3 * watch.seconds() / (next - first));
      if (first == 0) summary_.first_frame_s = total_.seconds();
      clock_.Begin("write");
      for (int t = first; t < next; ++t) {
        if (!track_.HasResult(t)) ++summary_.frames_without_fit;
        if (video) {
          Image whole = background.Next();
          LayOver(drawn[t - first], &whole);
          video->Write(whole);
        }
      }
      if (!request_.pictures.empty()) {
        ParallelFor(next - first, threads_, [&](int i) {
          WriteAlphaPng(FrameFile(request_.pictures, first + i), width_, height_, BgraOf(drawn[i]));
        });
      }
      clock_.Begin("draw");
    }
    if (video) video->Finish();
    if (!draw_ms.empty()) summary_.draw_ms = Percentile(draw_ms, 50);
    summary_.frames = count;
  }

  AnimatePersonSummary Finish() {
    clock_.End();
    summary_.person = person_.report;
    summary_.width = width_, summary_.height = height_;
    summary_.seconds = clock_.seconds();
    summary_.total_seconds = total_.seconds();
    for (const std::string& path :
         {request_.keep, request_.out, request_.pictures, request_.moved_track, request_.json}) {
      if (!path.empty()) summary_.written.push_back(path);
    }
    nlohmann::ordered_json json = {{"frames", summary_.frames},
                                   {"frames_without_fit", summary_.frames_without_fit},
                                   {"picture", {summary_.width, summary_.height}},
                                   {"draw_ms_median", summary_.draw_ms},
                                   {"first_frame_s", summary_.first_frame_s},
                                   {"seconds", ToJson(summary_.seconds)}};
    if (!person_.report.photos.empty()) json["person"] = nlohmann::ordered_json::parse(ToJson(person_));
    WriteReport(request_.json, json);
    return summary_;
  }

  AnimatePersonRequest request_;
  const PipelineCallbacks& callbacks_;
  const int threads_;
  Stopwatch total_;
  StageClock clock_;
  PhotoPerson person_;
  Track track_;
  double scale_ = 1;
  int width_ = 0, height_ = 0;
  std::optional<PosedTrack> posed_;
  std::optional<PersonCloth> cloth_;
  std::vector<int> order_;  ///< the track's frames as they are shown; empty: in turn
  std::optional<PersonFramePainter> frames_;
  AnimatePersonSummary summary_;
};

}  // namespace

AnimatePersonSummary AnimatePerson(const AnimatePersonRequest& request, const PipelineCallbacks& callbacks) {
  return PersonAnimation(request, callbacks).Run();
}

}  // namespace bodyloom
