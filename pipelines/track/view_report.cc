// SPDX-License-Identifier: Apache-2.0
#include "pipelines/track/view_report.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "geometry/base/check.h"
#include "geometry/base/units.h"
#include "geometry/math/rotation.h"
#include "geometry/scene/camera_path.h"
#include "pipelines/report_text.h"
#include "tracking/problem/camera_knowledge.h"
#include "tracking/rig/track_views.h"

namespace bodyloom {
namespace {

double DegreesFromFirst(const ViewReport& view) {
  return RotationAngleBetween(view.camera.camera_from_rig.camera_from_world_rotation, Eigen::Matrix3d::Identity()) /
         kDegree;
}

/// Distance of the cameras' centres.
double MetresFromFirst(const ViewReport& view) { return CentreOf(view.camera.camera_from_rig).norm(); }

/// " (within 0.5 deg, 0.05 m)" of standard deviations that are positive.
std::string WithinText(const std::vector<std::pair<double, std::string>>& sigmas) {
  std::string text;
  for (const auto& [sigma, shown] : sigmas) {
    if (sigma > 0) text += (text.empty() ? " (within " : ", ") + shown;
  }
  return text.empty() ? "" : text + ")";
}

}  // namespace

ViewReport ReportOnFirstView(const TrackSequenceSummary& joint, const Camera& camera, double middle_s) {
  ViewReport report;
  report.camera.camera = camera;
  report.camera.middle_s = middle_s;
  report.camera.focal_log_sigma = joint.focal_log_sigma;
  report.reprojection_median_px = joint.reprojection_median_px;
  return report;
}

ViewReport ReportOnView(const ViewSummary& found, const RigCamera& clock, double middle_s) {
  ViewReport report;
  RigCamera& camera = report.camera;
  if (clock.HasClock()) {
    camera = clock;
  } else {
    camera.offset_s = found.offset_s;
    camera.rate = found.rate;
    camera.middle_s = middle_s;
    camera.offset_sigma_s = found.offset_sigma_s;
    camera.rate_sigma = found.rate_sigma;
  }
  camera.camera = found.camera;
  camera.camera_from_rig = found.camera_from_scene;
  camera.rotation_sigma_rad = found.rotation_sigma_rad;
  camera.translation_sigma_m = found.translation_sigma_m;
  camera.focal_log_sigma = found.focal_log_sigma;
  report.frames = found.frames;
  if (!clock.HasClock()) report.repeat_s = found.repeat_s;
  report.reprojection_median_px = found.reprojection_median_px;
  return report;
}

std::string DoubtAbout(const ViewReport& view, const ViewReport& first) {
  constexpr double kMaxResidualRatio = 2, kMaxFocalSigmas = 3;
  const Camera& camera = view.camera.camera;
  const FocalPrior prior = FocalPrior::ForImage(camera.width, camera.height);
  if (view.camera.focal_log_sigma != 0 &&
      std::abs(std::log(camera.fx) - prior.log_mean) > kMaxFocalSigmas * prior.log_sigma) {
    return Concatenate("its focal length of ", std::lround(camera.fx), " px is unlikely in images of ", camera.width,
                       "x", camera.height);
  }
  if (view.reprojection_median_px > kMaxResidualRatio * first.reprojection_median_px) {
    return Concatenate("its residuals are ", std::lround(view.reprojection_median_px / first.reprojection_median_px),
                       " times those of the first view");
  }
  return "";
}

void WarnAboutViews(const std::vector<ViewReport>& views, const std::string& whom, const PipelineCallbacks& callbacks) {
  for (const ViewReport& view : views) {
    if (!view.doubt.empty()) {
      callbacks.Message("view " + view.camera.name + " may show another motion, or " + whom + ": " + view.doubt);
    }
    if (std::isfinite(view.repeat_s)) {
      callbacks.Message("view " + view.camera.name + ": the motion repeats itself, its clock may be " +
                        Fixed(std::abs(view.repeat_s), 2) + (view.repeat_s > 0 ? " s later" : " s earlier") +
                        "; a longer time in common, or --cameras with its clock, tells");
    }
  }
}

std::vector<RigCamera> RigOf(const std::vector<ViewReport>& views) {
  std::vector<RigCamera> rig;
  for (const ViewReport& view : views) {
    if (view.left_out.empty()) rig.push_back(view.camera);
  }
  return rig;
}

std::string ToText(const std::vector<ViewReport>& views) {
  size_t width = 0;
  for (const ViewReport& view : views) width = std::max(width, view.camera.name.size());
  std::string text;
  for (size_t v = 0; v < views.size(); ++v) {
    const ViewReport& view = views[v];
    const RigCamera& camera = view.camera;
    text += "view     " + camera.name + std::string(width - camera.name.size() + 2, ' ');
    if (!view.left_out.empty()) {
      text += "left out: " + view.left_out + "\n";
      continue;
    }
    const double rotation_sigma_deg = camera.rotation_sigma_rad / kDegree;
    text += v == 0
                ? "first"
                : Fixed(DegreesFromFirst(view), 1) + " deg, " + Fixed(MetresFromFirst(view), 2) + " m from the first" +
                      WithinText({{rotation_sigma_deg, Fixed(rotation_sigma_deg, 1) + " deg"},
                                  {camera.translation_sigma_m, Fixed(camera.translation_sigma_m, 2) + " m"}});
    text += "; focal length " + Fixed(camera.camera.fx, 1) + " px" +
            WithinText({{camera.focal_log_sigma, Fixed(100 * camera.focal_log_sigma, 1) + " %"}});
    if (v > 0 && camera.offset_sigma_s > kUntoldClock_s) {
      text += "; the motion does not tell its clock; " + std::to_string(view.frames) + " frames in common";
    } else if (v > 0) {
      text += "; clock " + Fixed(camera.offset_s, 3) + " s, " + Fixed(camera.offset_s * view.fps, 1) + " frames" +
              WithinText({{camera.offset_sigma_s, Fixed(camera.offset_sigma_s, 3) + " s"}}) + "; " +
              std::to_string(view.frames) + " frames in common";
    }
    text += "; median " + Fixed(view.reprojection_median_px, 2) + " px\n";
  }
  return text;
}

nlohmann::ordered_json ToJson(const ViewReport& view) {
  const RigCamera& camera = view.camera;
  nlohmann::ordered_json json = {
      {"name", camera.name}, {"detections", view.detections}, {"used", view.left_out.empty()}, {"fps", view.fps}};
  if (!view.video.empty()) json["video"] = view.video;
  if (!view.left_out.empty()) {
    json["left_out"] = view.left_out;
    return json;
  }
  if (!view.doubt.empty()) json["doubt"] = view.doubt;
  json["frames"] = view.frames;
  json["rotation_deg"] = DegreesFromFirst(view);
  json["rotation_sigma_deg"] = camera.rotation_sigma_rad / kDegree;
  json["distance_m"] = MetresFromFirst(view);
  json["translation_sigma_m"] = camera.translation_sigma_m;
  json["focal_px"] = camera.camera.fx;
  json["focal_log_sigma"] = camera.focal_log_sigma;
  json["offset_s"] = camera.offset_s;
  json["offset_frames"] = camera.offset_s * view.fps;
  json["offset_sigma_s"] = camera.offset_sigma_s;
  if (std::isfinite(view.repeat_s)) json["repeat_s"] = view.repeat_s;
  json["rate"] = camera.rate;
  json["rate_sigma"] = camera.rate_sigma;
  json["reprojection_median_px"] = view.reprojection_median_px;
  return json;
}

}  // namespace bodyloom
