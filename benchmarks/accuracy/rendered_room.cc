// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/accuracy/rendered_room.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "data_tools/synthesis/people/wardrobe.h"
#include "geometry/base/check.h"
#include "geometry/base/hash_random.h"
#include "geometry/base/percentile.h"
#include "geometry/body/posed_body.h"
#include "geometry/scene/camera_path.h"
#include "render/view/view_camera.h"

namespace bodyloom {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kTexel = 0.008;  ///< metres
constexpr int kSamples = 2;       ///< along each side of a pixel
constexpr double kMargin_m = 2.5, kHeight_m = 3.2;
constexpr double kFree_m = 0.8;  ///< from the person, the camera and the line between them to furniture
constexpr int kThings = 14;
constexpr double kCrowdShare = 0.6;
constexpr float kNoisePerBit = 0.5F;  ///< of 64 random bits, whose sum has a standard deviation of 4

Vector3d PelvisOf(const SynthClip& clip, int t) { return clip.truth.joints[size_t(t)].row(0).transpose(); }

/// Rows: room axes in the scene, y up.
Matrix3d RoomAxes(const SynthClip& clip) {
  const Vector3d up = clip.up_in_camera.normalized();
  const Vector3d right = (Vector3d::UnitX() - up.x() * up).normalized();
  Matrix3d axes;
  axes << right.transpose(), up.transpose(), right.cross(up).transpose();
  return axes;
}

/// Halves both sides by means of four.
std::vector<float> Halved(const std::vector<float>& level, int columns, int rows) {
  std::vector<float> half(size_t(columns / 2) * size_t(rows / 2));
  for (int r = 0; r < rows / 2; ++r) {
    for (int c = 0; c < columns / 2; ++c) {
      const auto at = [&](int row, int column) { return level[size_t(row) * size_t(columns) + size_t(column)]; };
      half[size_t(r) * size_t(columns / 2) + size_t(c)] =
          0.25F * (at(2 * r, 2 * c) + at(2 * r, 2 * c + 1) + at(2 * r + 1, 2 * c) + at(2 * r + 1, 2 * c + 1));
    }
  }
  return half;
}

/// Factors of a patterned surface.
std::vector<float> Pattern(int columns, int rows, uint64_t seed) {
  std::vector<float> values(size_t(columns) * size_t(rows));
  const std::array<std::pair<float, float>, 4> octaves = {
      {{1.0F, 0.25F}, {0.3F, 0.2F}, {0.08F, 0.2F}, {0.025F, 0.15F}}};
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      float value = 0.6F;
      for (size_t k = 0; k < octaves.size(); ++k) {
        const auto [metres, strength] = octaves[k];
        const float scale = static_cast<float>(kTexel) / metres;
        const Vector3f at(scale * float(c), scale * float(r), 0.5F);
        value += strength * (ValueNoise(at, seed + k) - 0.5F);
      }
      values[size_t(r) * size_t(columns) + size_t(c)] = value;
    }
  }
  HashRandom random(seed, {71});
  const auto rectangles = static_cast<int>(3 * kTexel * kTexel * columns * rows) + 2;  // three a square metre
  for (int n = 0; n < rectangles; ++n) {
    const int width = static_cast<int>(random.Uniform(0.06, 0.5) / kTexel);
    const int height = static_cast<int>(random.Uniform(0.06, 0.5) / kTexel);
    const int left = static_cast<int>(random.Uniform(0, columns)), top = static_cast<int>(random.Uniform(0, rows));
    const auto by = static_cast<float>(random.Uniform(0.5, 1.5));
    for (int r = top; r < std::min(rows, top + height); ++r) {
      for (int c = left; c < std::min(columns, left + width); ++c)
        values[size_t(r) * size_t(columns) + size_t(c)] *= by;
    }
  }
  for (float& value : values) value = std::clamp(value, 0.1F, 1.2F);
  return values;
}

/// Colour of a body by DensePose's chart.
Vector3f PartColour(int part) {
  if (part == 1 || part == 2 || (part >= 15 && part <= 22)) return {70, 95, 150};
  if (part >= 7 && part <= 14) return {60, 60, 65};
  if (part == 5 || part == 6) return {35, 30, 30};
  return {215, 170, 145};
}

/// Ground distance of p from the segment between a and b.
double GroundDistance(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector2d at(p.x() - a.x(), p.z() - a.z()), way(b.x() - a.x(), b.z() - a.z());
  const double s = std::clamp(at.dot(way) / std::max(1e-9, way.squaredNorm()), 0.0, 1.0);
  return (at - s * way).norm();
}

}  // namespace

RoomKind RoomKindFromString(const std::string& text) {
  if (text == "furnished") return RoomKind::kFurnished;
  if (text == "blank") return RoomKind::kBlank;
  BODYLOOM_CHECK(text == "crowd", "room '", text, "', expected furnished, blank or crowd");
  return RoomKind::kCrowd;
}

RenderedRoom::RenderedRoom(const BodyModel& body, const SynthClip& clip, RoomKind kind, uint64_t seed)
    : body_(body), clip_(clip), kind_(kind), seed_(seed) {
  BODYLOOM_CHECK(body.has_parts(), "rendered room: a body without parts");
  room_from_scene_.camera_from_world_rotation = RoomAxes(clip);
  const Motion& motion = clip.truth.motion;
  std::vector<Vector3d> people, cameras;
  std::vector<double> lowest;
  for (int t = 0; t < motion.num_frames(); ++t) {
    people.push_back(MovedPoint(room_from_scene_, PelvisOf(clip, t)));
    cameras.push_back(CentreOf(CameraFromRoom(t)));
    lowest.push_back(BodyInRoom(t).col(1).minCoeff());
  }
  low_ = high_ = people.front();
  for (const std::vector<Vector3d>* places : {&people, &cameras}) {
    for (const Vector3d& place : *places) low_ = low_.cwiseMin(place), high_ = high_.cwiseMax(place);
  }
  low_.array() -= kMargin_m;
  high_.array() += kMargin_m;
  low_.y() = Percentile(lowest, 50);
  high_.y() = low_.y() + kHeight_m;
  const bool patterned = kind != RoomKind::kBlank;
  AddBox(low_, high_, patterned);
  AddFurniture(people, cameras);
  if (kind == RoomKind::kCrowd) AddCrowd();
}

CameraPose RenderedRoom::CameraFromRoom(int frame) const {
  const CameraPose scene_from_room = Inverse(room_from_scene_);
  const std::vector<CameraPose>& path = clip_.truth.camera_from_scene;
  return path.empty() ? scene_from_room : Compose(path[size_t(frame)], scene_from_room);
}

MatrixX3d RenderedRoom::BodyInRoom(int frame) const {
  const Motion& motion = clip_.truth.motion;
  const BodyPose pose =
      PoseFromAxisAngle(body_, motion.poses.row(frame).transpose(), motion.trans.row(frame).transpose());
  return MovedPoints(room_from_scene_, PoseVertices(body_, motion.betas, pose));
}

void RenderedRoom::AddSurface(const Vector3d& corner, const Vector3d& along, const Vector3d& across, bool patterned) {
  const auto number = static_cast<uint64_t>(surfaces_.size());
  Surface& surface = surfaces_.emplace_back();
  surface.corner = corner;
  surface.along = along;
  surface.across = across;
  HashRandom random(seed_, {70, number / 6, patterned ? number : 0});
  surface.colour = {static_cast<float>(random.Uniform(130, 250)), static_cast<float>(random.Uniform(130, 250)),
                    static_cast<float>(random.Uniform(130, 250))};
  surface.columns = std::max(2, static_cast<int>(along.norm() / kTexel));
  surface.rows = std::max(2, static_cast<int>(across.norm() / kTexel));
  if (patterned) {
    surface.levels.push_back(Pattern(surface.columns, surface.rows, MixBits(seed_ + 100 * number)));
  } else {
    surface.levels.emplace_back(size_t(surface.columns) * size_t(surface.rows), 0.8F);
  }
  int columns = surface.columns, rows = surface.rows;
  while (columns >= 4 && rows >= 4) {
    surface.levels.push_back(Halved(surface.levels.back(), columns, rows));
    columns /= 2, rows /= 2;
  }
}

void RenderedRoom::AddBox(const Vector3d& low, const Vector3d& high, bool patterned) {
  const Vector3d x(high.x() - low.x(), 0, 0), y(0, high.y() - low.y(), 0), z(0, 0, high.z() - low.z());
  AddSurface(low, x, z, patterned);
  AddSurface(low + y, x, z, patterned);
  AddSurface(low, x, y, patterned);
  AddSurface(low + z, x, y, patterned);
  AddSurface(low, z, y, patterned);
  AddSurface(low + x, z, y, patterned);
}

void RenderedRoom::AddFurniture(const std::vector<Vector3d>& people, const std::vector<Vector3d>& cameras) {
  HashRandom random(seed_, {72});
  int things = 0;
  const int wanted = kind_ == RoomKind::kBlank ? 2 : kThings;
  for (int tries = 0; tries < 400 && things < wanted; ++tries) {
    const double width = random.Uniform(0.3, 1.1), height = random.Uniform(0.3, 1.9), depth = random.Uniform(0.3, 0.9);
    const double x = random.Uniform(low_.x() + width, high_.x() - width);
    const double z = random.Uniform(low_.z() + depth, high_.z() - depth);
    const Vector3d middle(x, 0, z);
    bool is_free = true;
    for (size_t t = 0; t < people.size() && is_free; t += 5) {
      is_free = GroundDistance(middle, people[t], cameras[t]) > kFree_m + 0.5 * std::hypot(width, depth);
    }
    if (!is_free) continue;
    AddBox(Vector3d(x - width / 2, low_.y(), z - depth / 2), Vector3d(x + width / 2, low_.y() + height, z + depth / 2),
           true);
    ++things;
  }
}

void RenderedRoom::AddCrowd() {
  // Beside and behind the person as the first camera sees it, then nearer to the camera on both sides.
  const CameraPose camera = CameraFromRoom(0);
  const Vector3d person = MovedPoint(room_from_scene_, PelvisOf(clip_, 0)), eye = CentreOf(camera);
  Vector3d away = person - eye;
  away.y() = 0;
  const double distance = away.norm();
  away /= distance;
  const Vector3d side = away.cross(Vector3d::UnitY());
  const auto pixels = static_cast<double>(clip_.truth.camera.width) * clip_.truth.camera.height;
  for (const double back : {0.1, 0.9, -0.8, -1.4, 1.7}) {
    for (const double aside : {-0.8, 0.8, -1.5, 1.5, -2.2, 2.2}) {
      if (distance + back < 1.2) continue;
      const Vector3d place = back * away + aside * side;
      const Vector3d at = person + place;
      if ((at.array() < low_.array() + 0.5).any() || (at.array() > high_.array() - 0.5).any()) continue;
      crowd_.push_back(place);
      Image image;
      LabelImage people;
      Draw(0, &image, &people);
      const auto covered = static_cast<double>(std::count(people.labels.begin(), people.labels.end(), uint8_t{1}));
      if (covered > kCrowdShare * pixels) return;
    }
  }
}

Vector3f RenderedRoom::SurfaceColour(int face, const Vector3d& ray, const CameraPose& camera_from_room,
                                     double metres_per_pixel_at_1) const {
  const Surface& surface = surfaces_[size_t(face / 2)];
  const Matrix3d& R = camera_from_room.camera_from_world_rotation;
  const Vector3d eye = CentreOf(camera_from_room), direction = R.transpose() * ray;
  const Vector3d normal = surface.along.cross(surface.across).normalized();
  const double facing = normal.dot(direction);
  const double depth = normal.dot(surface.corner - eye) / (std::abs(facing) > 1e-12 ? facing : 1e-12);
  const Vector3d at = eye + depth * direction - surface.corner;
  const double c = at.dot(surface.along) / surface.along.norm() / kTexel,
               r = at.dot(surface.across) / surface.across.norm() / kTexel;
  // A pixel's footprint is longer by the slant; the mean of both lengths avoids most of blur and of noise.
  const double slant = std::clamp(std::abs(facing) / direction.norm(), 0.05, 1.0);
  const double texels = depth * metres_per_pixel_at_1 / std::sqrt(slant) / kTexel;
  const int level = std::clamp(static_cast<int>(std::lround(std::log2(std::max(1.0, texels)))), 0,
                               static_cast<int>(surface.levels.size()) - 1);
  const int columns = surface.columns >> level, rows = surface.rows >> level;
  const double u = std::clamp((c + 0.5) / (1 << level) - 0.5, 0.0, columns - 1.001),
               v = std::clamp((r + 0.5) / (1 << level) - 0.5, 0.0, rows - 1.001);
  const auto i = static_cast<size_t>(u), j = static_cast<size_t>(v);
  const auto a = static_cast<float>(u - double(i)), b = static_cast<float>(v - double(j));
  const std::vector<float>& texture = surface.levels[size_t(level)];
  const float* const row = &texture[j * size_t(columns) + i];
  const float* const next = row + columns;
  const float factor = (1 - b) * ((1 - a) * row[0] + a * row[1]) + b * ((1 - a) * next[0] + a * next[1]);
  return factor * surface.colour;
}

void RenderedRoom::Draw(int frame, Image* image, LabelImage* people) {
  const Camera& camera = clip_.truth.camera;
  const CameraPose camera_from_room = CameraFromRoom(frame);
  const MatrixX3d bare = BodyInRoom(frame);
  const auto room_vertices = static_cast<Eigen::Index>(4 * surfaces_.size());
  const auto room_faces = static_cast<Eigen::Index>(2 * surfaces_.size());
  const auto bodies = static_cast<Eigen::Index>(1 + crowd_.size());
  MatrixX3d vertices(room_vertices + bodies * bare.rows(), 3);
  MatrixX3i faces(room_faces + bodies * body_.num_faces(), 3);
  for (size_t s = 0; s < surfaces_.size(); ++s) {
    const Surface& surface = surfaces_[s];
    const auto v = static_cast<int>(4 * s);
    vertices.row(v) = surface.corner.transpose();
    vertices.row(v + 1) = (surface.corner + surface.along).transpose();
    vertices.row(v + 2) = (surface.corner + surface.along + surface.across).transpose();
    vertices.row(v + 3) = (surface.corner + surface.across).transpose();
    const auto f = static_cast<Eigen::Index>(2 * s);
    faces.row(f) << v, v + 1, v + 2;
    faces.row(f + 1) << v, v + 2, v + 3;
  }
  for (Eigen::Index n = 0; n < bodies; ++n) {
    const Vector3d place = n == 0 ? Vector3d::Zero() : crowd_[size_t(n - 1)];
    const Eigen::Index first = room_vertices + n * bare.rows();
    vertices.middleRows(first, bare.rows()) = bare.rowwise() + place.transpose();
    faces.middleRows(room_faces + n * body_.num_faces(), body_.num_faces()) =
        body_.data().faces.array() + static_cast<int>(first);
  }
  vertices = MovedPoints(camera_from_room, vertices);
  const Camera fine = ScaledCamera(camera, kSamples);
  buffer_.Render(vertices, faces, fine, {.cull_back_faces = false});
  *image = Image(camera.width, camera.height);
  *people = {0, 0, camera.width, camera.height, std::vector<uint8_t>(size_t(camera.width) * size_t(camera.height), 0)};
  const Vector3d light = camera_from_room.camera_from_world_rotation * Vector3d(0.4, 0.8, 0.45).normalized();
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      Vector3f sum = Vector3f::Zero();
      bool is_body = false;
      for (int s = 0; s < kSamples * kSamples; ++s) {
        const int i = kSamples * x + s % kSamples, j = kSamples * y + s / kSamples;
        const int face = buffer_.FaceAt(i, j);
        if (face < 0) continue;
        if (face < room_faces) {
          const Vector3d ray((i - fine.cx) / fine.fx, (j - fine.cy) / fine.fy, 1);
          sum += SurfaceColour(face, ray, camera_from_room, 1 / camera.fx);
          continue;
        }
        is_body = true;
        const auto part = body_.data().face_part[size_t(face - room_faces) % size_t(body_.num_faces())];
        const Vector3d a = vertices.row(faces(face, 0)), b = vertices.row(faces(face, 1)),
                       c = vertices.row(faces(face, 2));
        const double lit = 0.55 + 0.45 * std::max(0.0, (b - a).cross(c - a).normalized().dot(light));
        sum += static_cast<float>(lit) * PartColour(part);
      }
      if (is_body) people->labels[size_t(y) * size_t(camera.width) + size_t(x)] = 1;
      uint8_t* const pixel = image->pixel(x, y);
      const uint64_t number =
          (uint64_t(frame) * uint64_t(camera.height) + uint64_t(y)) * uint64_t(camera.width) + uint64_t(x);
      const float noise = kNoisePerBit * float(std::popcount(MixBits(number ^ seed_)) - 32);
      for (int k = 0; k < 3; ++k) {
        pixel[2 - k] = NearestByte(std::clamp(sum[k] / (kSamples * kSamples) + noise, 0.0F, 255.0F));
      }
    }
  }
}

}  // namespace bodyloom
