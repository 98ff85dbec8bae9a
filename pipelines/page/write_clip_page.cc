// SPDX-License-Identifier: Apache-2.0
#include "pipelines/page/write_clip_page.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>

#include "data_tools/export/glb_writer.h"
#include "data_tools/formats/atomic_file.h"
#include "data_tools/motion/bvh_writer.h"
#include "data_tools/video/image_file.h"
#include "data_tools/video/video_encoder.h"
#include "geometry/base/check.h"
#include "geometry/scene/camera_path.h"
#include "geometry/scene/track_edits.h"
#include "pipelines/page/clip_page.h"
#include "pipelines/video/track_video.h"
#include "render/image/image.h"
#include "render/texture/complete/person_texture.h"
#include "render/view/floor.h"

namespace bodyloom {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::string PersonName(const PersonOnPage& person) { return Concatenate("person_", person.number); }

/// All moments of all tracks, ascending.
std::vector<double> MomentsOf(const std::vector<PersonOnPage>& people) {
  std::vector<double> moments;
  for (const PersonOnPage& person : people) {
    const std::vector<double>& times = person.track->motion.timestamps;
    moments.insert(moments.end(), times.begin(), times.end());
  }
  std::sort(moments.begin(), moments.end());
  moments.erase(std::unique(moments.begin(), moments.end()), moments.end());
  return moments;
}

WorldFrame WorldOf(const std::vector<PersonOnPage>& people) {
  std::vector<const Track*> tracks;
  std::vector<MatrixX3d> joints;
  for (const PersonOnPage& person : people) {
    tracks.push_back(person.track);
    joints.insert(joints.end(), person.track->joints.begin(), person.track->joints.end());
  }
  return WorldOfTracks(tracks, joints);
}

ExportScene SceneOf(const std::vector<PersonOnPage>& people, const WorldFrame& world) {
  std::vector<const BodyModel*> bodies;
  std::vector<const Track*> tracks;
  for (const PersonOnPage& person : people) {
    bodies.push_back(person.body);
    tracks.push_back(person.track);
  }
  ExportScene scene = MakeExportScene(bodies, tracks, world);
  for (size_t i = 0; i < people.size(); ++i) scene.people[i].name = PersonName(people[i]);
  return scene;
}

/// The person's frames laid on the page's clock.
ClipPagePerson OnClock(const PersonOnPage& person, const std::vector<double>& moments) {
  const Track& track = *person.track;
  const size_t n = moments.size();
  const std::vector<std::string>& names = person.body->data().joint_names;
  ClipPagePerson on_page;
  on_page.name = PersonName(person);
  for (Eigen::Index j = 0; j < track.joint_sigma.cols(); ++j) {
    const std::vector<std::string>& known = names.empty() ? SmplJointNames() : names;
    on_page.joint_names.push_back(size_t(j) < known.size() ? known[size_t(j)] : Concatenate("joint_", j));
  }
  on_page.status.assign(n, FrameStatus::kLost);
  on_page.residual_px.assign(n, kNaN);
  on_page.joint_sigma_m.setConstant(Eigen::Index(n), track.joint_sigma.cols(), kNaN);
  const bool has_px = person.summary != nullptr && person.summary->frame_px.size() == size_t(track.num_frames());
  for (int t = 0; t < track.num_frames(); ++t) {
    const auto at = std::lower_bound(moments.begin(), moments.end(), track.motion.timestamps[size_t(t)]);
    const auto row = at - moments.begin();
    on_page.status[size_t(row)] = track.frame_status[size_t(t)];
    if (has_px) on_page.residual_px[size_t(row)] = person.summary->frame_px[size_t(t)];
    if (t < track.joint_sigma.rows()) on_page.joint_sigma_m.row(row) = track.joint_sigma.row(t);
  }
  if (person.summary != nullptr) {
    on_page.plan = person.summary->plan;
    on_page.costs = person.summary->costs;
    on_page.worst_stretch = person.summary->worst_stretch;
  }
  return on_page;
}

/// Textures of the people, from images in ascending order of time.
class PageTextures {
 public:
  PageTextures(const std::vector<PersonOnPage>& people, const TrackVideo& video) {
    PersonTextureOptions options;
    options.size = kPageTextureTexels;
    options.fill = TextureFill::kPyramid;
    for (const PersonOnPage& person : people) {
      tracks_.push_back(std::make_unique<const Track>(video.Moved(TrackInCameras(*person.body, *person.track))));
      people_.push_back(person.body->has_uv() ? std::make_unique<PersonTexture>(*person.body, *tracks_.back(), options)
                                              : nullptr);
    }
  }

  void Add(double moment, const Image& image) {
    for (size_t i = 0; i < people_.size(); ++i) {
      const std::vector<double>& times = tracks_[i]->motion.timestamps;
      const auto at = std::lower_bound(times.begin(), times.end(), moment);
      if (people_[i] != nullptr && at != times.end() && *at == moment) {
        people_[i]->Add(static_cast<int>(at - times.begin()), image);
      }
    }
  }

  /// A PNG's bytes by person; empty for those of whom nothing was seen.
  [[nodiscard]] std::vector<std::string> Pngs() const {
    std::vector<std::string> pngs(people_.size());
    for (size_t i = 0; i < people_.size(); ++i) {
      const auto images = people_[i] != nullptr ? people_[i]->Merge() : std::nullopt;
      if (images) pngs[i] = EncodeImage(images->colours, Concatenate("texture of person_", i, ".png"));
    }
    return pngs;
  }

 private:
  std::vector<std::unique_ptr<const Track>> tracks_;
  std::vector<std::unique_ptr<PersonTexture>> people_;
};

struct Seen {
  std::string video_mp4;
  std::vector<std::string> textures;
};

/// The video's images at evenly spaced times (the last one is repeated where the video has none), and the people's
/// textures.
Seen SeenIn(const ClipPageRequest& request, const std::vector<double>& moments, double fps,
            const PipelineCallbacks& callbacks) {
  TrackVideo video(request.video, *request.people[0].track, request.video_px_from_camera_px, request.video_offset);
  const double longer = std::max(video.info().width, video.info().height), scale = std::min(1.0, kPageVideoPx / longer);
  const int width = std::max(2, int(std::lround(scale * video.info().width))),
            height = std::max(2, int(std::lround(scale * video.info().height)));
  const AtomicPath file(request.out + ".mp4");  // never committed: only its bytes are wanted
  VideoEncoder encoder(file.temporary(), request.out, width, height, fps);
  PageTextures textures(request.people, video);
  const size_t every = (moments.size() + kPageTextureImages - 1) / kPageTextureImages;
  Image image(width, height);
  for (size_t i = 0; i < moments.size(); ++i) {
    callbacks.Update("report", double(i) / double(moments.size()));
    if (const Image* shown = video.At(moments[i])) {
      if (i % every == 0) textures.Add(moments[i], *shown);
      image = Resized(*shown, width, height);
    }
    encoder.Write(image);
  }
  const std::string fault = encoder.Finish();
  if (!fault.empty()) throw std::runtime_error(request.out + ": " + fault);
  return {ReadFileBytes(file.temporary()), textures.Pngs()};
}

/// Empty where BVH cannot say what the track says.
std::string BvhOf(const PersonOnPage& person, const WorldFrame& world) {
  const auto [begin, end] = PosedSpan(person.track->motion);
  const Motion motion = FramesOfMotion(person.track->motion, begin, end);
  for (int t = 0; t < motion.num_frames(); ++t) {
    if (!motion.HasPose(t)) return "";
  }
  if (begin == end) return "";
  try {
    return BvhText(MotionInWorld(world, person.body->RestJoints(motion.betas).row(0).transpose(), motion),
                   *person.body);
  } catch (const std::invalid_argument&) {  // uneven time
    return "";
  }
}

std::vector<ClipPageFile> FilesOf(const std::vector<PersonOnPage>& people, const WorldFrame& world) {
  std::vector<ClipPageFile> files;
  for (const PersonOnPage& person : people) {
    const std::string name = PersonName(person);
    std::string bvh = BvhOf(person, world);
    if (!bvh.empty()) files.push_back({name + ".bvh", "text/plain", std::move(bvh)});
    if (!person.track_file.empty()) {
      files.push_back({name + ".npz", "application/octet-stream", ReadFileBytes(person.track_file)});
    }
  }
  return files;
}

}  // namespace

void WriteClipPage(const ClipPageRequest& request, const PipelineCallbacks& callbacks) {
  BODYLOOM_CHECK(!request.people.empty(), "a clip's page: nobody to show");
  const std::vector<double> moments = MomentsOf(request.people);
  ClipPageContent content;
  content.title = request.title;
  content.world = WorldOf(request.people);
  content.subtitle = content.world.BriefReport();
  content.fps = VideoFrameRate(moments);
  content.camera = request.people[0].track->camera;
  const ExportScene scene = SceneOf(request.people, content.world);
  for (const double moment : moments) content.seconds.push_back(moment - scene.start_s);
  for (const double second : content.seconds) {
    if (!scene.camera_keys.empty()) content.world_from_cameras.push_back(Inverse(scene.CameraAt(second)));
  }
  for (const PersonOnPage& person : request.people) content.people.push_back(OnClock(person, moments));
  GlbOptions options;
  options.correctives = request.correctives;
  GlbSummary exactness;
  if (!request.video.empty()) {
    Seen seen = SeenIn(request, moments, content.fps, callbacks);
    content.video_mp4 = std::move(seen.video_mp4);
    options.textures = std::move(seen.textures);
  }
  content.glb = GlbText(scene, options, &exactness);
  content.summary = request.summary;
  content.files = FilesOf(request.people, content.world);
  WriteFileAtomically(request.out, ClipPageHtml(content));
  callbacks.Update("report", 1);
}

}  // namespace bodyloom
