// SPDX-License-Identifier: Apache-2.0
#include "render/view/people_overlay.h"

#include <Eigen/Geometry>
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

/// Joints of one person by moment, no rows where the person is absent or lost.
std::vector<MatrixX3d> JointsByMoment(const PersonInOverlay& person, const std::vector<int>& frames) {
  const std::vector<MatrixX3d> joints = TrackJoints(*person.body, *person.track);
  std::vector<MatrixX3d> by_moment(frames.size());
  for (size_t t = 0; t < frames.size(); ++t) {
    if (frames[t] >= 0) by_moment[t] = joints[size_t(frames[t])];
  }
  return by_moment;
}

/// Levels of one person by moment; empty on the ground alone.
Eigen::VectorXd LevelsByMoment(const Track& track, const std::vector<int>& frames) {
  Eigen::VectorXd by_moment = Eigen::VectorXd::Zero(track.level_m.size() > 0 ? Eigen::Index(frames.size()) : 0);
  for (Eigen::Index t = 0; t < by_moment.size(); ++t) {
    if (frames[size_t(t)] >= 0) by_moment[t] = track.LevelAt(frames[size_t(t)]);
  }
  return by_moment;
}

/// Mean height in the image of a person's joints over all moments, pixels; 0 where it is absent or behind the camera.
double MeanHeightPx(const PersonInOverlay& person, const std::vector<int>& frames,
                    const std::vector<MatrixX3d>& joints) {
  double sum = 0;
  for (size_t t = 0; t < joints.size(); ++t) {
    if (joints[t].rows() == 0) continue;
    const Track& track = *person.track;
    const MatrixX3d seen =
        track.HasMovingCamera() ? MovedPoints(track.camera_from_scene[size_t(frames[t])], joints[t]) : joints[t];
    Eigen::AlignedBox1d rows;
    for (Eigen::Index j = 0; j < seen.rows(); ++j) {
      Eigen::Vector2d pixel;
      if (track.camera.Project(seen.row(j).transpose(), &pixel))
        rows.extend(Eigen::AlignedBox1d::VectorType(pixel.y()));
    }
    if (!rows.isEmpty()) sum += rows.sizes()[0];
  }
  return sum / double(joints.size());
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
  std::vector<std::vector<MatrixX3d>> joints;
  std::vector<MatrixX3d> all;
  std::vector<double> heights;
  for (size_t i = 0; i < people_.size(); ++i) {
    joints.push_back(JointsByMoment(people_[i], frames_[i]));
    all.insert(all.end(), joints[i].begin(), joints[i].end());
    heights.push_back(MeanHeightPx(people_[i], frames_[i], joints[i]));
    if (heights[i] > 0) in_panel_.push_back(i);
  }
  floor_ = ground ? ground : FloorUnder(all, options.up_in_camera);
  BODYLOOM_CHECK(floor_, "overlay: nobody has a pose in any frame");
  std::stable_sort(in_panel_.begin(), in_panel_.end(), [&](size_t a, size_t b) { return heights[a] > heights[b]; });
  if (!options.side_view || in_panel_.empty()) return;
  std::vector<SidePanelPerson> largest_first;
  for (const size_t i : in_panel_) {
    largest_first.push_back({std::move(joints[i]), {}, LevelsByMoment(*people_[i].track, frames_[i])});
  }
  side_.emplace(largest_first, timestamps_, options.SideView(camera().height), *floor_);
  in_panel_.resize(size_t(side_->num_cells()));
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
  Scene scene{{}, MatrixX3d(num_vertices, 3), MatrixX3i(num_faces, 3), {}};
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
  scene.bodies = std::move(bodies);
  return scene;
}

MeshStyle PeopleOverlay::Style() const {
  return {.samples = OverlaySamples(camera().height), .num_threads = options_.num_threads};
}

Image PeopleOverlay::Side(int moment, const Scene& scene) const {
  const double caption_height = OverlayCaptionHeight(camera().height);
  std::vector<SidePanel::Picture> pictures;
  for (int cell = 0; cell < side_->num_cells(); ++cell) {
    const size_t i = in_panel_[size_t(cell)];
    const Colour colour = PersonColour(people_[i].number);
    SidePanel::Picture picture = side_->At(cell, moment);
    MeshStyle style = Style();
    style.colour = colour;
    DrawInPanel({.vertices = scene.bodies[i], .faces = &people_[i].body->data().faces, .style = std::move(style)},
                caption_height, &drawer_, &picture);
    if (people_.size() > 1) {
      DrawCaption({{Concatenate("person ", people_[i].number), CaptionLine::Mark::kDisc, colour}}, Corner::kTopLeft,
                  caption_height, &picture.image);
    }
    pictures.push_back(std::move(picture));
  }
  Image panel = side_->Joined(pictures);
  DrawCaption({{"seen from the side"}}, Corner::kBottomRight, caption_height, &panel);
  return panel;
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
    MeshStyle style = Style();
    style.face_colours = scene.colours;
    style.alpha = background != nullptr ? options_.alpha : 1;
    drawer_.Draw(vertices, scene.faces, camera(), style, &view);
  }
  for (size_t i = 0; i < people_.size(); ++i) {
    const auto& [body, track, detected, hands_and_face, number] = people_[i];
    const int frame = frames_[i][size_t(moment)];
    if (frame >= 0 && hands_and_face != nullptr && hands_and_face->frames[size_t(frame)]) {
      DrawHandsAndFace(*hands_and_face->frames[size_t(frame)], options_.min_confidence, &view);
    }
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
  return Beside(view, Side(moment, scene));
}

}  // namespace bodyloom
