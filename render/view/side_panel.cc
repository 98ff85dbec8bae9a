// SPDX-License-Identifier: Apache-2.0
#include "render/view/side_panel.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>

#include "geometry/base/check.h"
#include "render/image/image_mat.h"
#include "render/image/palette.h"
#include "render/view/caption.h"
#include "render/view/drawing_units.h"

namespace bodyloom {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kApartM = 0.12, kDiscRadiusM = 0.04;
constexpr size_t kMostDiscs = 12;
constexpr Colour kBelowFloorColour{214, 40, 40};

/// False where the camera does not see the point.
bool MarkPixel(const Vector3d& point, const Camera& camera, cv::Point* pixel) {
  Vector2d p;
  if (camera.model == CameraModel::kPinhole && point.z() < Camera::kMinDepth) return false;
  if (!camera.Project(point, &p) || !IsDrawable(p)) return false;
  *pixel = FixedPoint(p);
  return true;
}

void DrawDisc(const Vector3d& centre, const Vector3d& up, const Camera& camera, Image* image) {
  constexpr int kCorners = 20;
  const Vector3d across = up.unitOrthogonal();
  std::vector<cv::Point> rim(kCorners);
  for (int k = 0; k < kCorners; ++k) {
    const Vector3d spoke = Eigen::AngleAxisd(2 * M_PI * k / kCorners, up) * across;
    if (!MarkPixel(centre + kDiscRadiusM * spoke, camera, &rim[static_cast<size_t>(k)])) return;
  }
  cv::Mat target = MatOf(image);
  cv::polylines(target, rim, true, ScalarOf(kInkColour), 2, cv::LINE_AA, kDrawingShift);
  cv::fillConvexPoly(target, rim, ScalarOf(kDetectedColour), cv::LINE_AA, kDrawingShift);
}

// A metre of the person in panel heights: an adult of 1.7 m fills a quarter of it. (Three who stand and reach out, in
// cells side by side, fill 0.28.)
constexpr double kSmallestMetre = 0.25 / 1.7;
// The floor is kept in view down to this far below the lowest joint, metres: a larger error leaves the picture, and the
// number beside the line tells it.
constexpr double kFloorInViewM = 0.5;

/// The same person with the place of the floor below its lowest joint among what is kept in view.
SidePanelPerson WithFloor(SidePanelPerson person, const Floor& floor) {
  const Vector3d up = floor.up.normalized();
  person.others.resize(person.joints.size());
  for (size_t t = 0; t < person.joints.size(); ++t) {
    const MatrixX3d& joints = person.joints[t];
    if (joints.rows() == 0) continue;
    Eigen::Index lowest = 0;
    const double level = person.level_m.size() > 0 ? person.level_m[static_cast<Eigen::Index>(t)] : 0;
    const double height = ((joints.rowwise() - floor.point.transpose()) * up).minCoeff(&lowest) - level;
    MatrixX3d& others = person.others[t];
    others.conservativeResize(others.rows() + 1, 3);
    others.bottomRows<1>() = joints.row(lowest) - std::clamp(height, 0.0, kFloorInViewM) * up.transpose();
  }
  return person;
}

}  // namespace

std::vector<SidePanel::Cell> SidePanel::Arranged(const std::vector<SidePanelPerson>& people,
                                                 const std::vector<double>& timestamps,
                                                 const FollowViewOptions& options, bool stacked) {
  std::vector<Cell> cells;
  const int n = static_cast<int>(people.size());
  for (int k = 0; k < n; ++k) {
    const int whole = stacked ? options.height : options.width, begin = whole * k / n, end = whole * (k + 1) / n;
    FollowViewOptions own = options;
    (stacked ? own.height : own.width) = end - begin;
    const SidePanelPerson& person = people[static_cast<size_t>(k)];
    cells.push_back({stacked ? 0 : begin, stacked ? begin : 0,
                     FollowView(person.joints, timestamps, own, person.others), StudioBackdrop(own.width, own.height),
                     person.level_m});
  }
  return cells;
}

double SidePanel::SmallestScale(const std::vector<Cell>& cells) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const Cell& cell : cells) {
    const View view = cell.follow.At(0);
    const double depth = view.Apply(cell.follow.CentreAt(0).transpose())(0, 2);
    smallest = std::min(smallest, PixelsPerMetre(view.camera, depth));
  }
  return smallest;
}

SidePanel::SidePanel(const std::vector<SidePanelPerson>& people, const std::vector<double>& timestamps,
                     const FollowViewOptions& options, const Floor& floor)
    : width_(options.width), height_(options.height), floor_(floor) {
  BODYLOOM_CHECK(!people.empty(), "side panel: nobody to show");
  std::vector<SidePanelPerson> shown;
  for (const SidePanelPerson& person : people) {
    if (shown.size() == kMostPeople) break;
    BODYLOOM_CHECK(person.level_m.size() == 0 || size_t(person.level_m.size()) == person.joints.size(),
                   "side panel: levels of ", person.level_m.size(), " frames, joints of ", person.joints.size());
    shown.push_back(WithFloor(person, floor));
  }
  for (; cells_.empty(); shown.pop_back()) {
    std::vector<Cell> stacked = Arranged(shown, timestamps, options, true);
    std::vector<Cell> abreast = Arranged(shown, timestamps, options, false);
    const double above = SmallestScale(stacked), beside = SmallestScale(abreast);
    if (shown.size() == 1 || std::max(above, beside) >= kSmallestMetre * height_) {
      cells_ = above >= beside ? std::move(stacked) : std::move(abreast);
    }
  }
}

SidePanel::Picture SidePanel::At(int cell, int t) const {
  BODYLOOM_CHECK(cell >= 0 && cell < num_cells(), "side panel: cell ", cell, " of ", num_cells());
  const Cell& own = cells_[static_cast<size_t>(cell)];
  const View view = own.follow.At(t);
  const Eigen::Matrix3d& R = view.from_camera.camera_from_world_rotation;
  const Vector3d& translation = view.from_camera.camera_from_world_translation;
  const Floor floor = own.level_m.size() > 0 ? RaisedFloor(floor_, own.level_m[t]) : floor_;
  Picture picture{view, {R * floor.point + translation, R * floor.up}, own.backdrop};
  DrawFloorGrid(picture.floor, R * own.follow.CentreAt(t) + translation, {}, view.camera, &picture.image);
  return picture;
}

Image SidePanel::Joined(const std::vector<Picture>& pictures) const {
  BODYLOOM_CHECK(pictures.size() == cells_.size(), "side panel: ", pictures.size(), " pictures for ", cells_.size(),
                 " cells");
  if (pictures.size() == 1) return pictures[0].image;
  Image panel(width_, height_);
  for (size_t k = 0; k < cells_.size(); ++k) {
    const Cell& cell = cells_[k];
    Paste(pictures[k].image, cell.x, cell.y, &panel);
    // A thin line between cells.
    if (cell.x > 0) Paste(Image(1, height_, kInkColour), cell.x, 0, &panel);
    if (cell.y > 0) Paste(Image(width_, 1, kInkColour), 0, cell.y, &panel);
  }
  return panel;
}

void DrawInPanel(const BodyInPanel& body, double caption_height, MeshDrawer* drawer, SidePanel::Picture* picture) {
  if (body.vertices.rows() == 0) return;
  const MatrixX3d vertices = picture->view.Apply(body.vertices);
  const Camera& camera = picture->view.camera;
  DrawShadow(vertices, *body.faces, picture->floor, camera, 0.3, &picture->image, {0, 0});
  drawer->Draw(vertices, *body.faces, camera, body.style, &picture->image);
  if (!body.marks) return;
  DrawFloorContact(ContactWithFloor(vertices, picture->floor), picture->floor, camera, caption_height, &picture->image);
}

Image Beside(const Image& left, const Image& right) {
  Image both(left.width + right.width, left.height);
  Paste(left, 0, 0, &both);
  Paste(right, left.width, 0, &both);
  return both;
}

FloorContact ContactWithFloor(const MatrixX3d& vertices, const Floor& floor) {
  BODYLOOM_CHECK(vertices.rows() > 0, "floor contact: the body has no vertex");
  const Vector3d up = floor.up.normalized();
  const Eigen::VectorXd heights = (vertices.rowwise() - floor.point.transpose()) * up;
  std::vector<std::pair<double, Eigen::Index>> low;
  for (Eigen::Index v = 0; v < heights.size(); ++v) {
    if (heights[v] <= kTouchesFloorM) low.emplace_back(heights[v], v);
  }
  std::sort(low.begin(), low.end());
  FloorContact contact;
  Eigen::Index lowest = 0;
  contact.lowest_m = heights.minCoeff(&lowest);
  contact.lowest = vertices.row(lowest).transpose();
  std::vector<Vector3d> feet;  // on the floor, of the lowest vertex of each part
  for (const auto& [height, v] : low) {
    const Vector3d foot = vertices.row(v).transpose() - height * up;
    const bool apart =
        std::all_of(feet.begin(), feet.end(), [&](const Vector3d& other) { return (foot - other).norm() > kApartM; });
    if (!apart) continue;
    feet.push_back(foot);
    if (height >= -kTouchesFloorM && contact.touching.size() < kMostDiscs) contact.touching.push_back(foot);
  }
  return contact;
}

void DrawFloorContact(const FloorContact& contact, const Floor& floor, const Camera& camera, double cap_px,
                      Image* image) {
  const Vector3d up = floor.up.normalized();
  for (const Vector3d& point : contact.touching) DrawDisc(point, up, camera, image);
  if (std::abs(contact.lowest_m) <= kTouchesFloorM) return;
  cv::Point from, to;
  if (!MarkPixel(contact.lowest, camera, &from) || !MarkPixel(contact.lowest - contact.lowest_m * up, camera, &to)) {
    return;
  }
  const Colour colour = contact.lowest_m > 0 ? kInkColour : kBelowFloorColour;
  const int thickness = std::max(1, static_cast<int>(std::lround(cap_px / 8)));
  cv::Mat target = MatOf(image);
  const int middle = (from.y + to.y) / (2 << kDrawingShift), cap = static_cast<int>(std::ceil(cap_px));
  // Bars at its ends, and the number apart from it: a short line close to "5 cm" reads as "15 cm".
  const cv::Point bar((cap << kDrawingShift) / 3, 0);
  for (const auto& [a, b] : {std::pair(from, to), {from - bar, from + bar}, {to - bar, to + bar}}) {
    cv::line(target, a, b, ScalarOf(colour), thickness, cv::LINE_AA, kDrawingShift);
  }
  const std::string height = std::to_string(std::lround(100 * contact.lowest_m)) + " cm";
  const int width = static_cast<int>(std::ceil(WidthOfWords(height, cap_px)));
  const int x = std::clamp((to.x >> kDrawingShift) + cap + cap / 2, 0, std::max(0, image->width - width - cap));
  const int baseline = std::clamp(middle + cap / 2, 2 * cap, std::max(2 * cap, image->height - cap));
  DrawWords(height, x, baseline, cap_px, colour, image);
}

}  // namespace bodyloom
