// SPDX-License-Identifier: Apache-2.0
#include "render/view/people_overlay.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/body/posed_body.h"
#include "geometry/scene/camera_path.h"
#include "render/image/palette.h"
#include "render/view/caption.h"
#include "render/view/overlay_landmarks.h"

namespace bodyloom {
namespace {

void CheckPeople(const std::vector<PersonInOverlay>& people) {
  BODYLOOM_CHECK(!people.empty(), "overlay: nobody to draw");
  const Camera& first = people[0].track->camera;
  BODYLOOM_CHECK(first.width > 0 && first.height > 0, "overlay: the tracks' camera has no image size");
  for (const PersonInOverlay& person : people) {
    const Camera& camera = person.track->camera;
    BODYLOOM_CHECK(camera.model == CameraModel::kPinhole,
                   "overlay: people of weak-perspective cameras have no space in common");
    BODYLOOM_CHECK(camera.width == first.width && camera.height == first.height, "overlay: tracks of images of ",
                   first.width, "x", first.height, " and ", camera.width, "x", camera.height, ", expected one camera");
    BODYLOOM_CHECK(person.track->num_frames() > 0, "overlay: the track of person ", person.number, " has no frames");
  }
}

std::vector<double> MomentsOf(const std::vector<PersonInOverlay>& people) {
  std::vector<double> times;
  for (const PersonInOverlay& person : people) {
    const std::vector<double>& own = person.track->motion.timestamps;
    times.insert(times.end(), own.begin(), own.end());
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

/// The person's frame at each of the moments; −1: none.
std::vector<int> FramesAt(const std::vector<double>& moments, const std::vector<double>& own) {
  std::vector<int> frames(moments.size(), -1);
  for (size_t t = 0; t < own.size(); ++t) {
    frames[size_t(std::lower_bound(moments.begin(), moments.end(), own[t]) - moments.begin())] = int(t);
  }
  return frames;
}

/// Joints of all people present, preceded by their common centre (the mean of the pelvises) for the camera to follow.
std::vector<MatrixX3d> JointsTogether(const std::vector<PersonInOverlay>& people,
                                      const std::vector<std::vector<int>>& frames, size_t num_moments) {
  std::vector<std::vector<MatrixX3d>> joints;
  joints.reserve(people.size());
  for (const PersonInOverlay& person : people) joints.push_back(TrackJoints(*person.body, *person.track));
  std::vector<MatrixX3d> together(num_moments);
  for (size_t t = 0; t < num_moments; ++t) {
    std::vector<const MatrixX3d*> present;
    Eigen::Index rows = 0;
    for (size_t i = 0; i < people.size(); ++i) {
      if (frames[i][t] < 0 || joints[i][size_t(frames[i][t])].rows() == 0) continue;
      present.push_back(&joints[i][size_t(frames[i][t])]);
      rows += present.back()->rows();
    }
    if (present.empty()) continue;
    MatrixX3d& all = together[t] = MatrixX3d::Zero(1 + rows, 3);
    Eigen::Index at = 1;
    for (const MatrixX3d* one : present) {
      all.row(0) += one->row(0) / double(present.size());
      all.middleRows(at, one->rows()) = *one;
      at += one->rows();
    }
  }
  return together;
}

}  // namespace

PeopleOverlay::PeopleOverlay(std::vector<PersonInOverlay> people, const OverlayOptions& options,
                             const std::optional<Floor>& ground)
    : people_(std::move(people)), options_(options) {
  std::string why;
  BODYLOOM_CHECK(options.IsValid(&why), why);
  CheckPeople(people_);
  timestamps_ = MomentsOf(people_);
  for (const PersonInOverlay& person : people_) {
    frames_.push_back(FramesAt(timestamps_, person.track->motion.timestamps));
  }
  backdrop_ = StudioBackdrop(camera().width, camera().height);
  const std::vector<MatrixX3d> joints = JointsTogether(people_, frames_, timestamps_.size());
  floor_ = ground ? ground : FloorUnder(joints, options.up_in_camera);
  BODYLOOM_CHECK(floor_, "overlay: nobody has a pose in any frame");
  if (options.side_view) side_.emplace(joints, timestamps_, options.SideView(camera().height));
}

PeopleOverlay::Scene PeopleOverlay::SceneAt(int moment) const {
  std::vector<MatrixX3d> bodies(people_.size());
  Eigen::Index num_vertices = 0, num_faces = 0;
  for (size_t i = 0; i < people_.size(); ++i) {
    const int frame = frames_[i][size_t(moment)];
    if (frame < 0) continue;
    bodies[i] = TrackVertices(*people_[i].body, *people_[i].track, frame);
    num_vertices += bodies[i].rows();
    if (bodies[i].rows() > 0) num_faces += people_[i].body->data().faces.rows();
  }
  Scene scene{MatrixX3d(num_vertices, 3), MatrixX3i(num_faces, 3), {}};
  scene.colours.reserve(size_t(num_faces));
  Eigen::Index vertex = 0, face = 0;
  for (size_t i = 0; i < people_.size(); ++i) {
    if (bodies[i].rows() == 0) continue;
    const MatrixX3i& faces = people_[i].body->data().faces;
    scene.vertices.middleRows(vertex, bodies[i].rows()) = bodies[i];
    scene.faces.middleRows(face, faces.rows()) = faces.array() + int(vertex);
    scene.colours.insert(scene.colours.end(), size_t(faces.rows()), PersonColour(people_[i].number));
    vertex += bodies[i].rows();
    face += faces.rows();
  }
  return scene;
}

MeshStyle PeopleOverlay::Style(const Scene& scene, double alpha) const {
  return {.face_colours = scene.colours,
          .alpha = alpha,
          .samples = OverlaySamples(camera().height),
          .num_threads = options_.num_threads};
}

Image PeopleOverlay::Side(int moment, const Scene& scene) const {
  SidePanel::Picture panel = side_->At(moment, *floor_);
  if (scene.vertices.rows() > 0) {
    const MatrixX3d vertices = panel.view.Apply(scene.vertices);
    DrawShadow(vertices, scene.faces, panel.floor, panel.view.camera, 0.3, &panel.image);
    drawer_.Draw(vertices, scene.faces, panel.view.camera, Style(scene, 1), &panel.image);
  }
  return std::move(panel.image);
}

void PeopleOverlay::DrawCaptions(int moment, Image* image) const {
  const double height = OverlayCaptionHeight(image->height);
  const double ms = std::round(1000 * timestamps_[size_t(moment)]);
  std::vector<CaptionLine> lines = {{Concatenate(ms / 1000, " s")}};
  bool any_detected = false;
  for (size_t i = 0; i < people_.size(); ++i) {
    const int frame = frames_[i][size_t(moment)];
    if (frame < 0) continue;
    any_detected = any_detected || people_[i].detected != nullptr;
    lines.push_back(
        {Concatenate("person ", people_[i].number, ", ", ToString(people_[i].track->frame_status[size_t(frame)])),
         CaptionLine::Mark::kDisc, PersonColour(people_[i].number)});
  }
  DrawCaption(lines, Corner::kTopLeft, height, image);
  if (any_detected) DrawCaption(LandmarkLegend(false), Corner::kBottomLeft, height, image);
}

std::optional<PeopleOverlay::Seen> PeopleOverlay::SeenFrom(int moment) const {
  for (size_t i = 0; i < people_.size(); ++i) {
    const int frame = frames_[i][size_t(moment)];
    if (frame >= 0 && people_[i].track->HasMovingCamera()) return Seen{people_[i].track, frame};
  }
  return std::nullopt;
}

Image PeopleOverlay::Render(int moment, const Image* background) const {
  BODYLOOM_CHECK(moment >= 0 && size_t(moment) < timestamps_.size(), "overlay: moment ", moment, " is outside the ",
                 timestamps_.size(), " of the clip");
  const Scene scene = SceneAt(moment);
  const std::optional<Seen> seen = SeenFrom(moment);
  const Floor floor = seen ? FloorInCamera(*floor_, *seen->track, seen->frame) : *floor_;
  const MatrixX3d vertices =
      seen ? MovedPoints(seen->track->camera_from_scene[size_t(seen->frame)], scene.vertices) : scene.vertices;
  const bool has_bodies = scene.vertices.rows() > 0;
  Image view = backdrop_;
  if (background != nullptr) {
    BODYLOOM_CHECK(background->width == camera().width && background->height == camera().height,
                   "overlay: the video is ", background->width, "x", background->height, ", the camera ",
                   camera().width, "x", camera().height);
    view = *background;
  } else if (options_.floor && has_bodies) {
    DrawFloorGrid(floor, vertices.colwise().mean().transpose(), {}, camera(), &view);
    DrawShadow(vertices, scene.faces, floor, camera(), 0.35, &view);
  }
  if (has_bodies) {
    drawer_.Draw(vertices, scene.faces, camera(), Style(scene, background != nullptr ? options_.alpha : 1), &view);
  }
  for (size_t i = 0; i < people_.size(); ++i) {
    const auto& [body, track, detected, number] = people_[i];
    const int frame = frames_[i][size_t(moment)];
    if (frame < 0 || detected == nullptr || !track->HasResult(frame)) continue;
    const Motion& motion = track->motion;
    DrawOverlayLandmarks({.body = body,
                          .betas = motion.betas,
                          .pose = *PoseInCamera(*body, *track, frame),
                          .camera = track->CameraAt(frame)},
                         detected, frame, {.min_confidence = options_.min_confidence}, &view);
  }
  DrawCaptions(moment, &view);
  if (!side_) return view;
  Image panel = Side(moment, scene);
  DrawCaption({{"seen from the side"}}, Corner::kBottomRight, OverlayCaptionHeight(view.height), &panel);
  return Beside(view, panel);
}

}  // namespace bodyloom
