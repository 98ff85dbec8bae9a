// SPDX-License-Identifier: Apache-2.0
#include "pipelines/page/write_clip_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
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
#include "geometry/biomechanics/track_angles.h"
#include "geometry/body/hand_skeleton.h"
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

/// Angles that the page plots, those of the sides without "_r" and "_l".
constexpr std::array<const char*, 6> kPlottedMiddle = {"pelvis_tilt",      "pelvis_list",    "pelvis_rotation",
                                                       "lumbar_extension", "lumbar_bending", "lumbar_rotation"};
constexpr std::array<const char*, 8> kPlottedSides = {"hip_flexion", "hip_adduction", "hip_rotation", "knee_angle",
                                                      "ankle_angle", "arm_flex",      "arm_add",      "elbow_flex"};

/// Lays the plotted angles on the page's clock; none for a body without the joints.
void AddAngles(const PersonOnPage& person, const WorldFrame& world, const std::vector<double>& moments,
               ClipPagePerson* on_page) {
  if (!HasJointAngles(*person.body)) return;
  for (const char* name : kPlottedSides) {
    for (const char* side : {"_r", "_l"}) on_page->angle_names.push_back(std::string(name) + side);
  }
  on_page->angle_names.insert(on_page->angle_names.end(), kPlottedMiddle.begin(), kPlottedMiddle.end());
  const TrackAngles angles = AnglesOfTrack(*person.body, *person.track, world);
  std::vector<int> columns;
  for (const std::string& name : on_page->angle_names) columns.push_back(FindCoordinate(name));
  on_page->angles_deg.setConstant(Eigen::Index(moments.size()), Eigen::Index(on_page->angle_names.size()), kNaN);
  for (int t = 0; t < person.track->num_frames(); ++t) {
    const auto row = std::lower_bound(moments.begin(), moments.end(), angles.timestamps[size_t(t)]) - moments.begin();
    on_page->angles_deg.row(row) = angles.values(t, columns);
  }
}

std::vector<int> FingerJointsOf(const BodyModel& body) {
  std::vector<int> joints;
  for (const HandSide side : {HandSide::kLeft, HandSide::kRight}) {
    const std::optional<HandSkeleton> hand = FindHand(body, side);
    if (hand) joints.insert(joints.end(), hand->joint.begin(), hand->joint.end());
  }
  return joints;
}

/// The person's frames laid on the page's clock.
ClipPagePerson OnClock(const PersonOnPage& person, const WorldFrame& world, const std::vector<double>& moments) {
  const Track& track = *person.track;
  const size_t n = moments.size();
  const std::vector<std::string>& names = person.body->data().joint_names;
  ClipPagePerson on_page;
  on_page.name = PersonName(person);
  const std::vector<int> fingers = FingerJointsOf(*person.body);
  std::vector<int> shown;  // thirty joints of fingers would hide the hands, and lead the mean of all
  for (int j = 0; j < int(track.joint_sigma.cols()); ++j) {
    if (std::find(fingers.begin(), fingers.end(), j) != fingers.end()) continue;
    shown.push_back(j);
    const std::vector<std::string>& known = names.empty() ? SmplJointNames() : names;
    on_page.joint_names.push_back(size_t(j) < known.size() ? known[size_t(j)] : Concatenate("joint_", j));
  }
  on_page.status.assign(n, FrameStatus::kLost);
  on_page.residual_px.assign(n, kNaN);
  on_page.joint_sigma_m.setConstant(Eigen::Index(n), Eigen::Index(shown.size()), kNaN);
  const bool has_px = person.summary != nullptr && person.summary->frame_px.size() == size_t(track.num_frames());
  for (int t = 0; t < track.num_frames(); ++t) {
    const auto at = std::lower_bound(moments.begin(), moments.end(), track.motion.timestamps[size_t(t)]);
    const auto row = at - moments.begin();
    on_page.status[size_t(row)] = track.frame_status[size_t(t)];
    if (has_px) on_page.residual_px[size_t(row)] = person.summary->frame_px[size_t(t)];
    for (size_t j = 0; t < track.joint_sigma.rows() && j < shown.size(); ++j) {
      on_page.joint_sigma_m(row, Eigen::Index(j)) = track.joint_sigma(t, shown[j]);
    }
  }
  if (person.summary != nullptr) {
    on_page.plan = person.summary->plan;
    on_page.costs = person.summary->costs;
    on_page.worst_stretch = person.summary->worst_stretch;
  }
  AddAngles(person, world, moments, &on_page);
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

/// The video's images at these times, of even steps on the page, as an .mp4's bytes; the last image is repeated where
/// the video has none. `use(i, image)` is called at each of them, with null where there is none.
std::string VideoBytes(const std::string& out, const std::vector<double>& times, double fps, TrackVideo* video,
                       const std::function<void(size_t, const Image*)>& use) {
  const double longer = std::max(video->info().width, video->info().height),
               scale = std::min(1.0, kPageVideoPx / longer);
  const int width = std::max(2, int(std::lround(scale * video->info().width))),
            height = std::max(2, int(std::lround(scale * video->info().height)));
  const AtomicPath file(out + ".mp4");  // never committed: only its bytes are wanted
  VideoEncoder encoder(file.temporary(), out, width, height, fps);
  Image image(width, height);
  for (size_t i = 0; i < times.size(); ++i) {
    const Image* shown = video->At(times[i]);
    use(i, shown);
    if (shown != nullptr) image = Resized(*shown, width, height);
    encoder.Write(image);
  }
  const std::string fault = encoder.Finish();
  if (!fault.empty()) throw std::runtime_error(out + ": " + fault);
  return ReadFileBytes(file.temporary());
}

struct Seen {
  std::string video_mp4;
  std::vector<std::string> textures;
};

/// The tracks' video on the page, and the people's textures.
Seen SeenIn(const ClipPageRequest& request, const std::vector<double>& moments, double fps,
            const std::function<void(size_t)>& update) {
  TrackVideo video(request.video, *request.people[0].track, request.video_px_from_camera_px, request.video_offset);
  PageTextures textures(request.people, video);
  const size_t every = (moments.size() + kPageTextureImages - 1) / kPageTextureImages;
  std::string bytes = VideoBytes(request.out, moments, fps, &video, [&](size_t i, const Image* shown) {
    update(i);
    if (shown != nullptr && i % every == 0) textures.Add(moments[i], *shown);
  });
  return {std::move(bytes), textures.Pngs()};
}

/// A further camera on the page, with its video at the same moments.
ClipPageView ViewOf(const ClipPageRequest& request, const ViewOnPage& view, const WorldFrame& world,
                    const std::vector<double>& moments, double fps, const std::function<void(size_t)>& update) {
  ClipPageView shown;
  shown.name = view.camera.name;
  shown.camera = view.camera.camera;
  shown.camera_from_world = Compose(view.camera.camera_from_rig, world.camera_pose());
  if (view.video.empty()) return shown;
  std::vector<double> times;
  for (const double moment : moments) times.push_back(view.camera.HasClock() ? view.camera.TimeAt(moment) : moment);
  const PersonOnPage& person = request.people[0];
  Track seen = TrackSeenBy(view.camera, *person.body, *person.track);
  seen.playback = view.playback;
  TrackVideo video(view.video, seen, view.video_px_from_camera_px);
  shown.video_mp4 = VideoBytes(request.out, times, fps, &video, [&](size_t i, const Image*) { update(i); });
  return shown;
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
  for (const PersonOnPage& person : request.people) {
    content.people.push_back(OnClock(person, content.world, moments));
  }
  GlbOptions options;
  options.correctives = request.correctives;
  SkinSummary exactness;
  size_t videos = 0;
  const auto update = [&](size_t i) {
    const double share = double(i) / double(moments.size());
    callbacks.Update("report", (double(videos) + share) / double(1 + request.views.size()));
  };
  if (!request.video.empty()) {
    Seen seen = SeenIn(request, moments, content.fps, update);
    content.video_mp4 = std::move(seen.video_mp4);
    options.textures = std::move(seen.textures);
  }
  content.view_name = request.view_name;
  for (const ViewOnPage& view : request.views) {
    ++videos;
    content.views.push_back(ViewOf(request, view, content.world, moments, content.fps, update));
  }
  content.glb = GlbText(scene, options, &exactness);
  content.summary = request.summary;
  content.files = FilesOf(request.people, content.world);
  WriteFileAtomically(request.out, ClipPageHtml(content));
  callbacks.Update("report", 1);
}

}  // namespace bodyloom
